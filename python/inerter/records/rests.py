"""Where a motion rests."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# velocity of a rest per rms noise; memories that it lasts at least; noise of its displacement about
# a line, and of the line's slope, per what white noise makes
_FAINT, _MEMORIES, _STRAIGHT, _SLOPING = 4.0, 4, 1.5, 3.0
# velocity per rms noise without which nothing moves, and so nothing rests; share of the samples
# that do not count in this, of ends that are a guess
_MOVES, _BRIEF = 10.0, 0.02
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


def held_still(
    measured: Array,
    smoothed: tuple[Array, Array, Array],
    spacing: float,
    cutoff: float,
    velocity_noise: float,
) -> tuple[Array, Array, Array]:
    """Displacement, velocity and acceleration (n,) without their noise where the motion rests.

    What noise moves to and fro lets a bristle go: Dahl friction of 15 N that yields in 0.5 mm loses
    0.8 N in a rest of 0.75 s under 1 um of noise. A rest is where the velocity is that of noise for
    some memories of the smoother and the displacement a level or a straight line, to within noise;
    there it becomes this line, as smoothly as a memory at each end lets it.

    Parameters
    ----------
    measured, smoothed : ndarray (n,), three of them
        The displacement as it was measured, and displacement, velocity and acceleration.
    spacing, cutoff, velocity_noise : float
        Time between samples [s], the smoother's cut-off [Hz], rms noise of the velocity.
    """
    x, v, a = (values.copy() for values in smoothed)
    memory = max(int(np.ceil(1.0 / (cutoff * spacing))), 2)
    if not np.quantile(np.abs(v), 1.0 - _BRIEF) > _MOVES * velocity_noise:
        return x, v, a
    faint = np.abs(smoothed[1]) < _FAINT * velocity_noise
    edges = np.flatnonzero(np.diff(np.r_[False, faint, False].astype(int)))
    for first, last in edges.reshape(-1, 2):
        # what leaves a rest leaks into its ends
        rows = slice(first + memory // 2, last - memory // 2)
        if rows.stop - rows.start < _MEMORIES * memory:
            continue
        line, slope = _line(measured[rows], spacing)
        white = float(np.std(np.diff(measured[rows], 2))) / np.sqrt(6.0)
        off = x[rows] - line
        if np.std(off) > _STRAIGHT * white * np.sqrt(min(2.0 * cutoff * spacing, 1.0)):
            continue
        share, rate, bend = _ramps(line.size, memory, spacing)
        speed, gain = v[rows] - slope, a[rows].copy()
        x[rows] -= share * off
        v[rows] -= rate * off + share * speed
        a[rows] -= bend * off + 2.0 * rate * speed + share * gain
    return x, v, a


def _line(values: Array, spacing: float) -> tuple[Array, float]:
    """The straight line through values (n,), level where its slope is no more than noise."""
    times = spacing * (np.arange(values.size) - 0.5 * (values.size - 1))
    power = float(np.sum(times**2))
    slope = float(np.sum(times * values)) / power
    rest = values - values.mean() - slope * times
    if abs(slope) < _SLOPING * float(np.std(rest)) / np.sqrt(power):
        slope = 0.0
    return values.mean() + slope * times, slope


def _ramps(count: int, memory: int, spacing: float) -> tuple[Array, Array, Array]:
    """A share that rises from 0 to 1 at both ends within a memory, and its two derivatives."""
    place = np.arange(count, dtype=float)
    near = np.clip(np.minimum(place, place[::-1]) / memory, 0.0, 1.0)
    way = np.where(place < 0.5 * count, 1.0, -1.0) / (memory * spacing)
    share = near**3 * (10.0 - 15.0 * near + 6.0 * near**2)
    rate = 30.0 * near**2 * (1.0 - near) ** 2 * way
    bend = 60.0 * near * (1.0 - near) * (1.0 - 2.0 * near) * way**2
    return share, rate, bend


def at_rest(velocity: Array, spacing: float) -> bool:
    """Whether a motion starts at rest: there its continuation is known and nothing is guessed."""
    first = max(int(0.01 / spacing), 3)
    return bool(np.max(np.abs(velocity[:first])) < 0.02 * np.std(velocity))
