"""A value with its error in text, both to a digit of the error: "530 ± 30"."""

from __future__ import annotations

import math

NOTHING = 1e-6
"""Share of its error below which a value is told as 0."""


def decimals_told(value: float, error: float, digits: int = 1, least: int = 1) -> int:
    """Decimals to which a value is told, negative before the point.

    Parameters
    ----------
    value, error : float
        In one unit; the error above 0 and finite.
    digits : int
        Of the error.
    least : int
        Digits of the value at least; six at most, however small the error is.
    """
    top = math.floor(math.log10(max(abs(value), error)))
    last = math.floor(math.log10(float(f"{error:.{digits}g}")))
    return min(max(top - last + digits, least), 6) - 1 - top


def measured(value: float, error: float, digits: int = 1, least: int = 1) -> str:
    """Both in words, arguments as `decimals_told`; with powers of ten where they are far from 1."""
    if not (value and math.isfinite(value) and math.isfinite(error) and error > 0):
        return f"{value:.3g} ± {error:.1g}"
    if abs(value) < NOTHING * error:
        value = 0.0
    decimals = decimals_told(value, error, digits, least)
    top = math.floor(math.log10(max(abs(value), error)))
    if not -4 < top < 6:
        return f"{value:.{decimals + 1 + top}g} ± {error:.{digits}g}"
    seen = round(error, decimals)
    told = f"{seen:.{max(decimals, 0)}f}" if seen else f"{error:.{digits}g}"
    return f"{round(value, decimals):.{max(decimals, 0)}f} ± {told}"
