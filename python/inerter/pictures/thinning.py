"""Fewer points for a picture, without losing what is to be seen in it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


def extremes(y: Array, limit: int) -> NDArray[np.intp]:
    """Indices, ascending and at most `limit`, that keep every peak of a trace drawn over time.

    The trace is cut into limit / 2 equal pieces; each keeps its smallest and largest sample.
    """
    count = len(y)
    if count <= limit:
        return np.arange(count)
    size = -(-count // max(1, limit // 2))
    pieces = -(-count // size)
    # the last piece is filled up with its own last sample
    padded = np.concatenate([y, np.full(pieces * size - count, y[-1])]).reshape(pieces, size)
    first = np.arange(pieces) * size
    picked = np.concatenate([first + padded.argmin(axis=1), first + padded.argmax(axis=1)])
    return np.unique(np.minimum(picked, count - 1))


def evenly(count: int, limit: int) -> NDArray[np.intp]:
    """Indices, evenly spaced and at most `limit`."""
    if count <= limit:
        return np.arange(count)
    return np.unique(np.linspace(0, count - 1, limit).astype(np.intp))


def longest_stretch(mask: Mask) -> slice:
    """The longest run of true values (empty when there is none)."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], mask.astype(int), [0]])))
    starts, ends = edges[::2], edges[1::2]
    if not len(starts):
        return slice(0, 0)
    best = int(np.argmax(ends - starts))
    return slice(int(starts[best]), int(ends[best]))


def stretches(mask: Mask) -> list[tuple[int, int]]:
    """First and last index of every run of true values."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], mask.astype(int), [0]])))
    pairs = zip(edges[::2], edges[1::2], strict=True)
    return [(int(start), int(end) - 1) for start, end in pairs]


def some_cycles(velocity: Array, cycles: int) -> int:
    """Number of samples that hold at most so many cycles of a motion, from its beginning.

    A change of direction counts once the speed has passed a tenth of its largest value.
    """
    if not len(velocity):
        return 0
    fast = np.flatnonzero(np.abs(velocity) > 0.1 * np.max(np.abs(velocity)))
    turns = fast[1:][np.diff(np.sign(velocity[fast])) != 0]
    return int(turns[2 * cycles]) if len(turns) > 2 * cycles else len(velocity)


def bin_means(x: Array, y: Array, bins: int) -> tuple[Array, Array]:
    """Mean of y in bins of x of equal width, where at least 1 in 10 of a fair share lies."""
    if len(x) < 4 * bins or np.ptp(x) == 0:
        return np.empty(0), np.empty(0)
    place = np.minimum((bins * (x - x.min()) / np.ptp(x)).astype(int), bins - 1)
    counts = np.bincount(place, minlength=bins)
    keep = counts >= max(4, 0.1 * len(x) / bins)
    sums = [np.bincount(place, values, bins)[keep] for values in (x, y)]
    return sums[0] / counts[keep], sums[1] / counts[keep]
