"""The steps in which a converter wrote a channel down.

All values of such a channel are multiples of one step apart, up to the rounding of a text. Two
things look alike and are none: an even motion without noise, which grows by the same amount with
every sample, and numbers with so many digits each, whose steps grow with their size.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

MOST_VALUES = 200_000
FINEST = 1e-6  # of the range: a converter of 20 bits; finer steps tell nothing
FEW = 30  # different values from which on their distances tell by themselves
ROUNDED = 0.12  # of a step, by which distances may be off it, rounded as texts are
ALL = 0.9  # share of the values that have to be on the steps
MANIFOLD = 0.8  # share of the distances that may be 2, 3 or 5 times as large a step
EVEN = 0.99  # share of the changes of one size from which on a motion counts as even


def converter_step(values: NDArray[np.floating]) -> float | None:
    """The step of a channel (n,), in its unit; None where it has none.

    Steps below 1e-6 of the range and channels of fewer than four values are not judged.
    """
    some = np.asarray(values[:MOST_VALUES], dtype=np.float64)
    size = float(np.ptp(some))
    if not size > 0:
        return None
    levels = np.unique(some)
    # what differs in its last bits is one value
    levels = levels[np.r_[True, np.diff(levels) > FINEST * size]]
    if len(levels) < 4 or (len(levels) < FEW and len(levels) > len(some) / 2):
        return None
    smallest = np.diff(levels)
    # of few values among many levels no two may be neighbours
    smallest = float(np.quantile(smallest, min(0.02, 20 / len(smallest)), method="lower"))
    for part in (1, 2, 3):
        step = _fitted(levels, smallest / part)
        if step is not None and not _grows_evenly(some, step):
            return step
    return None


def _fitted(levels: Array, step: float) -> float | None:
    """The step near this one that fits the levels best; None where they are on no such steps."""
    distances = np.diff(levels)
    # longer and longer distances tell the step more and more exactly
    for longest in (2.5, 6.5, 20.5, 60.5):
        near = distances[distances < longest * step]
        if len(near):
            step = float(np.sum(near) / np.sum(np.maximum(np.round(near / step), 1.0)))
    counts = distances / step
    whole = np.abs(counts - np.round(counts)) < ROUNDED
    if np.mean(whole) < ALL:
        return None
    # nearly all of them on steps that are larger still: a part of the true step
    parts = (np.mean(np.round(counts[whole]) % several == 0) for several in (2, 3, 5))
    return step if max(parts) < MANIFOLD else None


def _grows_evenly(values: Array, step: float) -> bool:
    """Whether the channel moves by one size with every sample, as a motion without noise does."""
    changes = np.abs(np.round(np.diff(values) / step))
    moves = changes > 0
    sizes, counts = np.unique(changes[moves], return_counts=True)
    if not len(sizes) or counts.max() < EVEN * counts.sum():
        return False
    # of a slow motion in steps most changes stand alone
    return bool(np.mean(moves[1:][moves[:-1]]) > ALL)
