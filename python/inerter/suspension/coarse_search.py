"""Where to start: the good regions of an index on a logarithmic grid over all designs.

Local minima of the grid alone are not enough: minima a per mille apart lie in one flat, oblique
valley, and a grid that cuts it at an angle shows one of them. So the best point of every half
decade of every variable is a candidate too; all of them are moved on finer and finer grids, and
those that end together are one.

J5 is read on a grid of frequencies here. A resonance between two of them is broad enough to be seen
from its flanks (2 % away from an undamped one the gain still is 25 times the static one, several
times that of a good design), so no design looks good because its peak fell through; the polish
works with exact peaks.
"""

from __future__ import annotations

import itertools
import math

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import minimum_filter

from inerter.suspension.h_infinity_norm import squared_polynomials
from inerter.suspension.problem import Array, SuspensionProblem

_PER_DECADE = {1: 24, 2: 7, 3: 3, 4: 1.5, 5: 0.8}
_SLICE = 0.5
_WORTH_POLISHING = 1.01
_MOST = {True: 6, False: 3}
_CHUNK = 1024
_FREQUENCIES = 160


def starting_points(problem: SuspensionProblem) -> Array:
    """Logarithms of the starting points, best first, shape (n, variables).

    Those left out are 1 % worse than the best after looking closer, or close to a better one.
    """
    axes = _axes(problem)
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    values = coarse_values(problem, grid.reshape(-1, len(axes))).reshape(grid.shape[:-1])
    points = _closer(problem, grid[_candidates(values, axes)], axes)
    chosen = _distinct(points, coarse_values(problem, points))
    return chosen[: _MOST[problem.objective.smooth]]


def coarse_values(problem: SuspensionProblem, points: Array) -> Array:
    """The index of each point; J5 from a grid of frequencies."""
    if problem.objective.smooth:
        return problem.value(points)
    powers = _squared_frequencies(problem)
    parts = [points[i : i + _CHUNK] for i in range(0, len(points), _CHUNK)]
    return np.concatenate([_sampled_gain(problem, part, powers) for part in parts])


def _axes(problem: SuspensionProblem) -> list[Array]:
    bounds = problem.bounds
    per_decade = _PER_DECADE[len(bounds)]
    decades = (bounds[:, 1] - bounds[:, 0]) / math.log(10.0)
    counts = np.rint(decades * per_decade).astype(int) + 1
    return [np.linspace(low, high, n) for (low, high), n in zip(bounds, counts, strict=True)]


def _candidates(values: Array, axes: list[Array]) -> NDArray[np.bool_]:
    """Local minima of the grid that are not far off, and the best point of each slice."""
    lowest = minimum_filter(values, size=3, mode="nearest") == values
    chosen = lowest & (values <= 2.0 * values.min())
    for axis, places in enumerate(axes):
        width = max(1, round(_SLICE * math.log(10.0) / (places[1] - places[0])))
        moved = np.moveaxis(values, axis, 0)
        for first in range(0, len(places), width):
            part = moved[first : first + width]
            at = list(np.unravel_index(np.argmin(part), part.shape))
            at[0] += first
            place = at.pop(0)
            at.insert(axis, place)
            if values[tuple(at)] <= 2.0 * values.min():
                chosen[tuple(at)] = True
    return chosen


def _closer(problem: SuspensionProblem, points: Array, axes: list[Array]) -> Array:
    """Each point moved to the best of finer and finer grids around it."""
    size = np.array([axis[1] - axis[0] for axis in axes])
    low, high = problem.bounds.T
    number = 7 if len(axes) < 4 else 3
    stencil = np.array(list(itertools.product(np.linspace(-1.0, 1.0, number), repeat=len(axes))))
    for _ in range(5):
        around = np.clip(points[:, None, :] + stencil * size, low, high)
        values = coarse_values(problem, around.reshape(-1, len(axes)))
        best = values.reshape(len(points), -1).argmin(axis=1)
        points, size = around[np.arange(len(points)), best], size / 2.5
    return points


def _distinct(points: Array, values: Array) -> Array:
    """Best first, without what is close to a better one or much worse than the best."""
    order = np.argsort(values, kind="stable")
    kept: list[Array] = []
    for point in points[order][values[order] <= _WORTH_POLISHING * values.min()]:
        if all(np.abs(point - other).max() > 0.2 for other in kept):
            kept.append(point)
    return np.array(kept)


def _squared_frequencies(problem: SuspensionProblem) -> NDArray[np.float64]:
    """Squared frequencies [(rad/s)^2] from far below the body mode to far above wheel hop."""
    car, k = problem.car, problem.stiffness
    both = 1.0 / (1.0 / k + 1.0 / car.tyre_stiffness)
    low = 0.03 * math.sqrt(both / (car.sprung_mass + car.unsprung_mass))
    high = 5.0 * math.sqrt((k + car.tyre_stiffness) / car.unsprung_mass)
    return np.concatenate([[0.0], np.geomspace(low, high, _FREQUENCIES) ** 2])


def _sampled_gain(problem: SuspensionProblem, points: Array, x: NDArray[np.float64]) -> Array:
    top, below = squared_polynomials(problem.load_function(points))
    unit = x[-1]
    order = max(top.shape[-1], below.shape[-1])
    powers = (x / unit) ** np.arange(order)[:, None]
    scale = unit ** np.arange(order)
    above = (top * scale[: top.shape[-1]]) @ powers[: top.shape[-1]]
    under = (below * scale[: below.shape[-1]]) @ powers[: below.shape[-1]]
    # rounding can take a vanishing denominator below zero: there the gain is without limit
    with np.errstate(all="ignore"):
        square = np.where(under > 0.0, np.abs(above) / under, np.inf).max(axis=-1)
    return np.sqrt(square)
