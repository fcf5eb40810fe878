"""Parameters as texts for the core, and what is said of a name that it does not know."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any


def value_text(value: Any) -> str | None:
    """The text of a number or a word; None for what is neither."""
    if isinstance(value, str):
        # what ends a text in C, and what is half a character
        return value if "\0" not in value and value.isprintable() else None
    try:
        return None if isinstance(value, bytes) else repr(float(value))
    except (TypeError, ValueError, OverflowError):
        return None


def with_suggestion(name: str, message: str, known: Iterable[str]) -> str:
    """The message, and the names that an unknown one is like."""
    names = list(known)
    if name in names:
        return message
    import difflib

    close = difflib.get_close_matches(name, names, n=3)
    hint = f"did you mean {', '.join(close)}?" if close else "`inerter parameters` lists them"
    return f"{message}; {hint}"
