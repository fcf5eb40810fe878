"""Parameters as texts for the core, and what is said of a name that it does not know."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any


def value_text(value: Any) -> str | None:
    """The text of a number, a word or a sequence of numbers; None for what is none of them."""
    if isinstance(value, str):
        # what ends a text in C, and what is half a character
        return value if "\0" not in value and value.isprintable() else None
    try:
        return None if isinstance(value, bytes) else repr(float(value))
    except (TypeError, ValueError, OverflowError):
        return _list_text(value)


def _list_text(value: Any) -> str | None:
    """Numbers separated by blanks; one level of nesting, as of periods, is taken out."""
    if isinstance(value, (bytes, Mapping)) or not isinstance(value, Iterable):
        return None
    texts = []
    for each in value:
        if isinstance(each, (str, bytes)):
            return None
        text = value_text(each)
        if text is None:
            return None
        texts.append(text)
    return " ".join(texts)


def with_suggestion(name: str, message: str, known: Iterable[str]) -> str:
    """The message, and the names that an unknown one is like."""
    names = list(known)
    if name in names:
        return message
    import difflib

    close = difflib.get_close_matches(name, names, n=3)
    hint = f"did you mean {', '.join(close)}?" if close else "`inerter parameters` lists them"
    return f"{message}; {hint}"
