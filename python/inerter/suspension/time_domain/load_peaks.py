"""J5 in the time domain: the largest energy ratio over all frequencies of a sinusoidal load.

A sweep from 0.5 to 30 Hz finds every local maximum of the gain. Each is swept again between its
neighbours, then by three points close to its top, through which a parabola goes (logarithms). The
ends of the sweep count as they are. The limit of frequency 0 is 1/k + 1/kt where nothing sticks
there: in S1, in S3, whose damper yields to a load that changes slowly, and in S2 without friction.
Range: peaks narrower than about 5 % of their frequency may be missed.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inerter.suspension.time_domain.car_model import CarModel
from inerter.suspension.time_domain.design import Design
from inerter.suspension.time_domain.simulate import RunSettings, load_gains

Array = NDArray[np.float64]

SWEEP = (0.5, 30.0, 29)
"""Lowest and highest frequency [Hz] and number of the first sweep."""

_REFINED = 7
CLOSE = 0.006
"""Relative distance of the points beside the top of a peak."""

_PEAKS = 4


@dataclass(frozen=True)
class LoadPeaks:
    """`value` J5 [m/N]; `peaks`: (frequency [Hz], gain [m/N]) of each local maximum."""

    value: float
    peaks: tuple[tuple[float, float], ...]


def load_peaks(
    car: CarModel,
    designs: Sequence[Design],
    amplitude: float = 1000.0,
    settings: RunSettings | None = None,
) -> list[LoadPeaks]:
    """J5 of every design under A sin(w t), A = `amplitude` [N].

    Raises
    ------
    ValueError
        As `load_gains`.
    """
    return peaks_of(
        lambda chosen, f: load_gains(car, [designs[i] for i in chosen], f, amplitude, settings),
        len(designs),
        [car.static_compliance(design) for design in designs],
    )


def peaks_of(
    gains: Callable[[Sequence[int], Array], Array],
    count: int,
    static: Sequence[float | None],
) -> list[LoadPeaks]:
    """The peaks of `count` gains.

    `gains` is called with indices and frequencies [Hz] of shape (indices, n), and gives that
    shape. `static` are the gains at frequency 0, None where that is not known.
    """
    grid = np.geomspace(*SWEEP)
    coarse = gains(range(count), np.tile(grid, (count, 1)))

    # every local maximum inside the sweep, the highest ones
    places = []
    for i, row in enumerate(coarse):
        inner = 1 + np.flatnonzero((row[1:-1] >= row[:-2]) & (row[1:-1] > row[2:]))
        best = sorted(inner, key=lambda j: -row[j])[:_PEAKS]
        places += [(i, int(j)) for j in sorted(best)]
    found: list[list[tuple[float, float]]] = [[] for _ in range(count)]
    if places:
        owners = [i for i, _ in places]
        f = np.array([np.geomspace(grid[j - 1], grid[j + 1], _REFINED + 2) for _, j in places])
        g = np.array([coarse[i, j - 1 : j + 2] for i, j in places])
        g = np.column_stack([g[:, 0], gains(owners, f[:, 1:-1]), g[:, 2]])
        tops = np.array([vertex(*each)[0] for each in zip(f, g, strict=True)])
        close = tops[:, None] * np.array([1.0 - CLOSE, 1.0, 1.0 + CLOSE])
        highest = g.max(axis=1)
        for i, f3, g3, seen in zip(owners, close, gains(owners, close), highest, strict=True):
            frequency, top = vertex(f3, g3)
            found[i].append((frequency, max(top, float(seen))))
    results = []
    for i in range(count):
        ends = [float(coarse[i, 0]), float(coarse[i, -1])]
        rest = static[i]
        if rest is not None:
            ends.append(rest)
            # a maximum at rest is a peak too
            if rest >= coarse[i, 0]:
                found[i].insert(0, (0.0, rest))
        results.append(LoadPeaks(max(ends + [g for _, g in found[i]]), tuple(found[i])))
    return results


def vertex(f: Array, g: Array) -> tuple[float, float]:
    """Frequency and gain of the maximum, by a parabola in logarithms."""
    k = int(np.clip(np.argmax(g), 1, g.size - 2))
    x, y = np.log(f[k - 1 : k + 2]), np.log(g[k - 1 : k + 2])
    a, b, c = np.polyfit(x - x[1], y - y[1], 2)
    at = np.clip(-0.5 * b / a, x[0] - x[1], x[2] - x[1]) if a < 0.0 else 0.0
    top = max(float(np.exp(y[1] + c + at * (b + a * at))), float(g.max()))
    return float(np.exp(x[1] + at)), top
