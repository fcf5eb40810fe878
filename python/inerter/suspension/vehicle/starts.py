"""Where to start: what is good for the quarter-cars at the corners, and points spread over all.

A body with I = m lf lr is two quarter-cars, and those of passenger cars are near it. So every pair
of starting points of the two corners is a candidate. Cars far from that are covered by a sequence
of Halton over all designs, of which the best are kept. Nothing is random.
"""

from __future__ import annotations

import itertools
from functools import cache

import numpy as np
from scipy.stats.qmc import Halton

from inerter.suspension.coarse_search import starting_points as corner_points
from inerter.suspension.problem import Array
from inerter.suspension.vehicle.load_peaks import span
from inerter.suspension.vehicle.problem import VehicleProblem

_SPREAD = 512
_KEPT = 4
_PER_CORNER = 3
_MOST_PEAKS = 6
_WORTH_POLISHING = 1.1
_APART = 0.3
_FREQUENCIES = 120
_CHUNK = 256


def starting_points(problem: VehicleProblem, more: int = 1) -> Array:
    """Logarithms of the starting points, best first, shape (n, variables).

    Parameters
    ----------
    problem
        What is to be minimised.
    more
        Times as many points are spread and kept: to see that they find nothing new.
    """
    corners = _corner_pairs(problem)
    values = coarse_values(problem, corners)
    corners = corners[values <= _WORTH_POLISHING * values.min()]
    low, high = problem.bounds.T
    spread = low + _sequence(len(low), _SPREAD * more) * (high - low)
    spread = _best_apart(spread, coarse_values(problem, spread), _KEPT * more)
    every = np.concatenate([corners, spread])
    values = coarse_values(problem, every)
    # each polish of J5 takes long
    most = _MOST_PEAKS * more if problem.index == "J5" else len(every)
    return _best_apart(every, values, most)


def coarse_values(problem: VehicleProblem, points: Array) -> Array:
    """The index of each point; J5 from a grid of frequencies."""
    if problem.index != "J5":
        return problem.quick(points)
    parts = [points[i : i + _CHUNK] for i in range(0, len(points), _CHUNK)]
    return np.concatenate([_sampled_gain(problem, part) for part in parts])


def _corner_pairs(problem: VehicleProblem) -> Array:
    low, high = problem.bounds.T
    front, rear = (corner_points(corner)[:_PER_CORNER] for corner in problem.corners())
    if problem.equal:
        pairs = [*front, *rear, *(0.5 * (front[:1] + rear[:1]))]
    else:
        pairs = [np.concatenate(pair) for pair in itertools.product(front, rear)]
    return np.clip(np.array(pairs), low, high)


def _sampled_gain(problem: VehicleProblem, points: Array) -> Array:
    load = problem.load(points)
    grid = np.append(0.0, np.geomspace(*span(load), _FREQUENCIES))
    with np.errstate(all="ignore"):
        return np.nan_to_num(load.gain(grid).max(axis=-1), nan=np.inf)


def _best_apart(points: Array, values: Array, most: int) -> Array:
    """Best first, without what is close to a better one."""
    kept: list[Array] = []
    for place in np.argsort(values, kind="stable"):
        if all(np.abs(points[place] - other).max() > _APART for other in kept):
            kept.append(points[place])
        if len(kept) == most:
            break
    return np.array(kept)


@cache
def _sequence(variables: int, count: int) -> Array:
    """Points of the unit cube that leave no part of it out."""
    # the first point of the sequence is a corner of the cube
    return Halton(variables, scramble=False).random(count + 1)[1:]
