"""Where a channel is cut off at the end of a range, and at which levels."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import label

from .record import Array, Record, TimeRecord

T = TypeVar("T", bound=TimeRecord)


def find_clipping(record: T) -> T:
    """`clipping`: a force or acceleration cut off at a level it reaches again and again.

    The rule, at the highest and at the lowest value: stretches of three or more samples within
    one quantisation step of it, on three peaks (both ends together), or two with five samples.
    Only stretches that the channel climbs into count: from a stretch of n samples it falls, over
    n more on either side, by 20 steps or more, and a single sample next to it makes less than 2/3
    of the fall over max(2, n/4). This spares rounded tops and the plateaus of dry friction. A
    force may rest while the displacement does. Displacement and velocity are not looked at:
    strokes dwell at their ends.
    """
    for name, values in record.channels().items():
        if not name.endswith(("force", "acceleration")):
            continue
        levels, peaks = cut_levels(
            values, record.displacement if isinstance(record, Record) else None
        )
        if levels:
            where = " and ".join(f"{level:.4g}" for level in levels.values())
            text = f"{name!r} is cut off at {where} on {peaks} peaks: range of the sensor?"
            record = record.warn("clipping", text)
    return record


def cut_levels(values: Array, x: Array | None = None) -> tuple[dict[str, float], int]:
    """Levels at which a channel is cut off, "upper" and "lower" where it is, and on how many peaks.

    values, x: the channel and the displacement of its samples [m], (n,); see `find_clipping`.
    """
    ends = {"upper": _cut_peaks(values, x), "lower": _cut_peaks(-values, x)}
    peaks = sum(map(len, ends.values()))
    pairs = [sorted(lengths)[-2] for lengths in ends.values() if len(lengths) > 1]
    if peaks < 3 and max(pairs, default=0) < 5:
        return {}, 0
    extreme = {"upper": float(values.max()), "lower": float(values.min())}
    return {end: extreme[end] for end, lengths in ends.items() if lengths}, peaks


def _cut_peaks(values: Array, x: Array | None) -> list[int]:
    """Lengths of the flat stretches at the maximum, the longest of each peak."""
    at_rest = 0.0 if x is None else 1e-4 * np.ptp(x)
    change = np.abs(np.diff(values))
    size = np.ptp(values)
    change = change[change > 1e-9 * size]
    if not len(change):
        return []
    # one step of the converter; of a channel that is not quantised it is tiny
    step = float(np.min(change))
    if step > 0.02 * size:
        return []
    flat = values >= values.max() - 1.01 * step
    # chatter near the limit: one peak lasts until the channel is down by a tenth of its range
    peak, _ = label(values >= values.max() - 0.1 * size)  # type: ignore[misc]
    lengths: dict[int, int] = {}
    for start, stop in stretches(flat):
        length = stop - start
        # without the samples on either side of a rest, where the stretch is long enough
        inner = slice(start + 1, stop - 1) if length >= 5 else slice(start, stop)
        if x is not None and np.ptp(x[inner]) < at_rest:
            continue
        if length >= 3 and _climbs(values, start, stop, step):
            lengths[int(peak[start])] = max(lengths.get(int(peak[start]), 0), length)
    return list(lengths.values())


def _climbs(values: Array, start: int, stop: int, step: float) -> bool:
    """Whether the channel climbs into a flat stretch steadily, and not over a rounded top."""
    length = stop - start
    level = values[start]
    sides = (values[:start][::-1], values[stop:])
    fall = [level - side[min(length, len(side)) - 1] for side in sides if len(side)]
    if not fall or min(fall) < 20.0 * step:
        return False
    lag = max(2, length // 4)
    return any(
        len(side) >= lag and level - side[lag - 1] > 1.5 * (level - side[0]) for side in sides
    )


def stretches(mask: NDArray[np.bool_]) -> Iterator[tuple[int, int]]:
    """Start and end (exclusive) of each run of True."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], mask.astype(np.int8), [0]))))
    return zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True)
