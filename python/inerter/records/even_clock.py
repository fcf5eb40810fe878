"""Whether a clock is even, also where its times were written with few digits."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

# shares of an interval by which times may be off an even clock, as they are and rounded; powers of
# ten that times are looked at for, and how near they have to be
_EVEN, _COARSEST, _DIGITS, _NEAR = 0.02, 0.4, range(10), 1e-3


def even_spacing(time: NDArray[np.float64]) -> float | None:
    """Interval [s] of an even clock with times (n,) [s], rounded or not; None where it is none.

    Of times 0.3328 ms apart that are written in steps of 0.1 ms intervals are 0.3 or 0.4 ms, and
    the median is 10 % off: none of them is farther from an even clock than what it is rounded by.
    """
    if time.size < 2:
        return None
    spacing = float((time[-1] - time[0]) / (time.size - 1))
    off = float(np.max(np.abs(time[0] + spacing * np.arange(time.size) - time)))
    if off < _EVEN * spacing:
        return spacing
    # of a coarser one a sample that is missing is no farther off
    rounding = _rounding(time) if off < _COARSEST * spacing else 0.0
    return spacing if off <= (1 + _NEAR) * rounding <= _COARSEST * spacing else None


def _rounding(time: NDArray[np.float64]) -> float:
    """The power of ten [s] of which the later times are multiples; 0 for none.

    Of figures with so many digits the later ones are the coarser.
    """
    later = time[time.size // 2 :] - time[time.size // 2]
    for digits in _DIGITS:
        units = later * 10.0**digits
        if np.all(np.abs(units - np.round(units)) < _NEAR):
            return float(10.0**-digits)
    return 0.0
