"""Units and quantities in texts, by pint. A text from a stranger is one of them or it is nothing.

What pint evaluates is looked at before: "9^9^9^9 m" is a text of ten characters that no machine
works out, and "1,5 kg" is no fifteen kilograms.
"""

from __future__ import annotations

import functools
import re
import tokenize
from typing import Any

# spellings of test benches that pint reads otherwise (mil is an angle) or not at all
_SPELLINGS = {"kp": "kgf", "mil": "thou", "mils": "thou", "sec": "s", "secs": "s", "lbs": "lbf"}
# torques written in one word or with a dash; mN stays a millinewton
_SPELLINGS |= {
    "Nm": "N*m", "kNm": "kN*m", "mNm": "mN*m", "uNm": "uN*m", "MNm": "MN*m", "Nmm": "N*mm",
    "Ncm": "N*cm", "N-m": "N*m", "kgfm": "kgf*m", "kgfcm": "kgf*cm", "kpm": "kgf*m",
    "lbfft": "lbf*ft", "lbf-ft": "lbf*ft", "ft-lbf": "lbf*ft", "ft-lb": "lbf*ft",
    "lb-ft": "lbf*ft", "lbft": "lbf*ft", "lbfin": "lbf*in", "lbf-in": "lbf*in",
    "in-lbf": "lbf*in", "in-lb": "lbf*in", "lb-in": "lbf*in", "oz-in": "ozf*in",
}  # fmt: skip
_LONGEST = 60
_ALLOWED = re.compile(r"[A-Za-zµμ°%Ω_0-9\s*/^().\-]+")
_EXPONENT = r"[+-]?\d{1,2}(?:\.\d)?(?![\d.])"
_POWER = re.compile(rf"\s*(?:\^|\*\*)\s*(?:\(\s*{_EXPONENT}\s*\)|{_EXPONENT})\s*")
_MOST_POWERS = 4
_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*?)\s*", re.S)


@functools.cache
def unit_registry() -> Any:
    """The pint registry, made on the first unit that is not SI (it takes 0.3 s)."""
    import pint

    return pint.get_application_registry()


def split_quantity(text: str) -> tuple[float, str] | None:
    """Number and unit of a text such as ``10 mm``; None where it does not begin with a number."""
    match = _NUMBER.fullmatch(text)
    return None if match is None else (float(match[1]), match[2])


@functools.cache
def parse_unit(unit: str) -> Any:
    """The pint unit, or None where pint knows none; ``m/s2``, ``m s-2`` and ``m·s^-2`` work."""
    text = _SPELLINGS.get(unit, unit)
    text = re.sub(r"\brevs?\b", "revolution", text)
    for sign in ("\u00b7", "\u22c5", "\u00d7"):
        text = text.replace(sign, "*")
    text = text.translate(str.maketrans("⁻⁰¹²³⁴", "-01234"))
    if not _ALLOWED.fullmatch(text) or len(text) > _LONGEST:
        return None
    text = re.sub(r"(?<=[A-Za-z])\.(?=[A-Za-z])", "*", text)
    # as written, then with the exponents that people leave unmarked
    for tried in (text, re.sub(r"(?<=[A-Za-z])(-?\d)(?!\d)", r"**\1", text)):
        if _evaluable(tried) and (found := _unit(tried)) is not None:
            return found
    return None


def _evaluable(text: str) -> bool:
    """Whether its powers are few and small, also where one stands within another."""
    if re.search(r"\)\s*(?:\^|\*\*)\s*\(?\s*[+-]?\d\d", text):
        return False
    left, powers = _POWER.subn("\0", text)
    return powers <= _MOST_POWERS and not any(sign in left for sign in ("^", "**", "\0\0"))


def _unit(text: str) -> Any:
    # whatever pint makes of a text that is no unit, it is not a unit
    known_failures = (ArithmeticError, AssertionError, AttributeError, KeyError, TypeError)
    try:
        return unit_registry().Unit(text)
    except (*known_failures, ValueError, SyntaxError, tokenize.TokenError):
        return None
