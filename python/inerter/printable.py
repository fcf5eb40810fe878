"""Texts from files on their way to a terminal."""

from __future__ import annotations


def printable(text: str) -> str:
    """The text without control sequences; line breaks and the blanks of numbers stay."""
    return "".join(c if c.isprintable() or c in "\n\u00a0\u202f" else "\ufffd" for c in text)
