"""Where a motion rests."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

LEAKS = 1.0
"""Memories of a smoother by which what is not known of a rest spreads beyond it."""


def long_stretches(
    mask: NDArray[np.bool_], spacing: float, cutoff: float, around: float = 0.0
) -> NDArray[np.bool_]:
    """Those stretches of a mask (n,) that last longer than the memory of a smoother [Hz].

    With so many memories on either side of each.
    """
    edges = np.flatnonzero(np.diff(np.r_[False, mask, False].astype(int)))
    more = int(np.ceil(around / cutoff / spacing)) if around else 0
    found = np.zeros(mask.size, bool)
    for begin, end in edges.reshape(-1, 2):
        if (end - begin) * spacing > 1 / cutoff:
            found[max(begin - more, 0) : end + more] = True
    return found


def at_rest(velocity: Array, spacing: float) -> bool:
    """Whether a motion starts at rest: there its continuation is known and nothing is guessed."""
    first = max(int(0.01 / spacing), 3)
    return bool(np.max(np.abs(velocity[:first])) < 0.02 * np.std(velocity))
