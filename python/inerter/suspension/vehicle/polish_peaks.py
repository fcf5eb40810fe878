"""Polish of J5: the smallest level that no peak exceeds.

As for the quarter-car, frequencies are divided into intervals, one for each peak of the start. The
logarithm of the largest gain in an interval is smooth, its gradient that at a fixed frequency, and
SLSQP solves `minimise t, peak_i <= t`. When peaks appear, merge or cross from one interval to
another the division is made anew, until nothing is gained.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from scipy.optimize import minimize

from inerter.suspension.problem import Array
from inerter.suspension.vehicle.load import Load
from inerter.suspension.vehicle.load_peaks import peaks
from inerter.suspension.vehicle.problem import VehicleProblem

_ROUNDS = 8
_GAINED = 1e-11
_SAME = 1e-6
_HOPELESS = 1.02


def polish_peaks(problem: VehicleProblem, start: Array, known: float) -> tuple[float, Array]:
    """Value and point of the local minimum that a start leads to, within the bounds.

    A minimum of value `known` has been found before: on the way to it, or where it is out of reach,
    there is no need to arrive.
    """
    point, best = start, float(problem.value(start[None])[0])
    for _ in range(_ROUNDS):
        moved = _lowest(problem, point)
        value = float(problem.value(moved[None])[0])
        if not value < best * (1.0 - _GAINED):
            break
        gained = best / value
        point, best = moved, value
        if abs(best / known - 1.0) < _SAME or (gained < _HOPELESS and best > known * _HOPELESS):
            break
    return best, point


def _lowest(problem: VehicleProblem, start: Array) -> Array:
    heights = Heights(problem, edges_of(problem.load(start)))
    last = np.append(np.zeros(len(start)), 1.0)

    def slope(variables: Array) -> Array:
        slopes = heights.slopes(variables[:-1])
        return np.column_stack([-slopes, np.ones(len(slopes))])

    answer = minimize(
        lambda v: (v[-1], last), np.append(start, heights.levels(start).max()), jac=True,
        method="SLSQP", bounds=[*problem.bounds, (None, None)],
        constraints={
            "type": "ineq", "fun": lambda v: v[-1] - heights.levels(v[:-1]), "jac": slope,
        },
        options={"ftol": 1e-15, "maxiter": 30},
    )  # fmt: skip
    found, (low, high) = answer.x[:-1], problem.bounds.T
    return np.clip(found, low, high) if np.isfinite(found).all() else start


class Heights:
    """Logarithm of the largest gain in each interval between `edges` [rad/s], over designs."""

    def __init__(self, problem: VehicleProblem, edges: Array) -> None:
        self.problem, self.edges = problem, edges
        self._found: dict[bytes, tuple[Array, Array]] = {}

    def levels(self, point: Array) -> Array:
        """One level for each interval."""
        return self._highest(point)[1]

    def slopes(self, point: Array) -> Array:
        """Gradients of the levels, shape (intervals, variables)."""
        return self.problem.levels(point, self._highest(point)[0])[1]

    def _highest(self, point: Array) -> tuple[Array, Array]:
        key = point.tobytes()
        if key not in self._found:
            load = self.problem.load(point)
            frequency, _ = peaks(load, self.edges)
            # an interval without a peak of its own is highest at an edge
            frequency = np.concatenate([[0.0], frequency, self.edges])
            gain = load.gain(frequency)
            place = np.searchsorted(self.edges, frequency, side="right")
            each = (np.flatnonzero(place == n) for n in range(len(self.edges) + 1))
            highest = [inside[np.argmax(gain[inside])] for inside in each]
            self._found[key] = frequency[highest], np.log(gain[highest])
        return self._found[key]


def edges_of(load: Load) -> Array:
    """Frequencies that part the peaks: the lowest point between each two."""
    frequency, _ = peaks(load)
    edges = []
    for left, right in pairwise(frequency):
        between = np.linspace(left, right, 66)[1:-1]
        edges.append(between[np.argmin(load.gain(between))])
    return np.array(edges)
