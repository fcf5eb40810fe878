"""Texts from files on their way to a terminal or a page."""

from __future__ import annotations

import codecs
import re
import unicodedata

PLAIN = "inerter.plain"
"""Name of the error handler with which a stream shows another character for one that it has not."""

_TURNING = re.compile("[\u200e\u200f\u061c\u202a-\u202e\u2066-\u2069]")
_TURNING_ESCAPED = re.compile(r"\\u(?:200[ef]|061c|202[a-e]|206[6-9])")

_POWER = re.compile(r"(?<![\w.])\d(?:\.\d+)?e\+0[1-5](?!\d)")

# signs of ours for which a terminal may have no character
_OTHERWISE = {
    "\u2192": "->", "\u00d7": "x", "\u00b7": "*", "\u2212": "-", "\u2013": "-", "\u2014": "-",
    "\u00b1": "+/-", "\u2264": "<=", "\u2265": ">=", "\u00b5": "u", "\u03bc": "u", "\u00b0": "deg",
    "\u2026": "...", "\u2248": "~", "\u221a": "sqrt", "\u2022": "*", "\u00b2": "^2", "\u00b3": "^3",
    "\u2018": "'", "\u2019": "'", "\u201c": '"', "\u201d": '"',
}  # fmt: skip


def printable(text: str) -> str:
    """The text without control sequences; line breaks and the blanks of numbers stay."""
    return "".join(c if c.isprintable() or c in "\n\u00a0\u202f" else "\ufffd" for c in text)


def in_digits(sentence: str) -> str:
    """A sentence of ours with numbers below a million written out: 8840 for 8.84e+03."""
    return _POWER.sub(lambda found: f"{float(found[0]):.0f}", sentence)


def text_of(name: str) -> str:
    """A file's name as text: what of it is no UTF-8 is shown as U+FFFD, for pictures and files."""
    return name.encode("utf-8", "surrogateescape").decode("utf-8", "replace")


def upright(value: object) -> object:
    """What a template shows: of a text without the signs that turn the order of what follows.

    A name with U+202E would show what stands behind it from right to left. What is marked as safe
    is a program or data (`upright_json`), and stays.
    """
    if not isinstance(value, str) or hasattr(value, "__html__"):
        return value
    return _TURNING.sub("\ufffd", value)


def upright_json(text: str) -> str:
    """The same of a text in JSON, where those signs are escaped."""
    return _TURNING_ESCAPED.sub(r"\\ufffd", text)


def plain(text: str) -> str:
    """The text in ASCII, as near as that comes."""
    return "".join(c if c.isascii() else _plain_character(c) for c in text)


def _plain_character(character: str) -> str:
    if character in _OTHERWISE:
        return _OTHERWISE[character]
    if unicodedata.category(character) == "Zs":
        return " "
    parts = unicodedata.normalize("NFKD", character)
    return "".join(c for c in parts if c.isascii()) or "?"


def _shown(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return plain(error.object[error.start : error.end]), error.end


codecs.register_error(PLAIN, _shown)
