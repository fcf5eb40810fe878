"""Every n-th row behind a low-pass, block by block: long files in the memory of short ones.

The filter is a symmetric FIR low-pass (Kaiser window of 80 dB, 20 n + 1 taps, gain 1 at rest), the
same for every column and without delay: of the new Nyquist frequency, half passes within 2e-4, and
beyond the whole of it 2e-4 are left. So all linear laws hold between the columns as before, and an
even clock stays exact. Half a filter is lost at each end.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.signal import firwin, upfirdn

from .record import Array

_SIDE = 10  # new samples on each side that a new one is made of
_CUT_OFF = 0.75  # of the new Nyquist frequency
_BETA = 7.86  # of the window: 80 dB
MOST = 10_000


class Decimator:
    """One column, of which more is given block by block."""

    def __init__(self, by: int) -> None:
        self.by = by
        self.half = _SIDE * by
        window: Any = ("kaiser", _BETA)
        taps = 2 * self.half + 1
        self.taps = firwin(taps, _CUT_OFF / by, window=window) if by > 1 else np.ones(1)
        self.rest: Array = np.empty(0)
        self.origin: float | None = None

    def add(self, values: Array) -> Array:
        """The new samples, shape (k,), that a block completes; NaN where a value is missing."""
        if self.by == 1:
            return values
        finite = values[np.isfinite(values)]
        if self.origin is None and len(finite):
            # a time since 1970 keeps its digits
            self.origin = float(finite[0])
        origin = self.origin or 0.0
        whole = np.concatenate([self.rest, values - origin])
        count = (len(whole) - len(self.taps)) // self.by + 1
        if count < 1:
            self.rest = whole
            return np.empty(0)
        used = whole[: (count - 1) * self.by + len(self.taps)]
        made = upfirdn(self.taps, used, down=self.by)[2 * _SIDE : 2 * _SIDE + count]
        self.rest = whole[count * self.by :]
        return made + origin


def told(by: int) -> str:
    """What was done, in words; empty where nothing was."""
    if by == 1:
        return ""
    return f"low-passed at {_CUT_OFF:g} of the new Nyquist frequency, every {by}th row kept"
