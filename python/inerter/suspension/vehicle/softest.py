"""Of all designs whose J5 is at most a limit, the one with the smallest J1.

The limit is asked for at many fixed frequencies, of which the lowest matter where the gain begins
to fall from its static value, and at the highest peak of each interval, as in `polish_peaks`.
SLSQP with exact gradients; intervals are divided anew until no peak exceeds the limit.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.optimize import minimize

from inerter.suspension.problem import Array
from inerter.suspension.vehicle.load_peaks import largest_gain, span
from inerter.suspension.vehicle.polish_peaks import Heights, edges_of
from inerter.suspension.vehicle.problem import VehicleProblem

_FREQUENCIES = 80
_ROUNDS = 5
_GAINED = 1e-9
# the body's frequency over the lowest looked at
_BODY = 100.0
# of what the limit leaves above the static value, relative: rounding does not decide
_MARGIN = 1e-10


def softest(problem: VehicleProblem, start: Array, limit: float) -> tuple[float, Array] | None:
    """The logarithm of J1 and the point; nothing where no design within the limit was reached."""
    comfort = replace(problem, index="J1")
    point, (low, high) = start, problem.bounds.T
    best = None
    for _ in range(_ROUNDS):
        point = np.clip(_solve(problem, comfort, point, limit), low, high)
        if not np.isfinite(point).all():
            break
        if largest_gain(problem.load(point)) <= limit:
            value = comfort.logarithm(point)[0]
            if best is not None and value > best[0] - _GAINED:
                break
            best = value, point
    return best


def _solve(problem: VehicleProblem, comfort: VehicleProblem, start: Array, limit: float) -> Array:
    load = problem.load(start)
    edges = edges_of(load)
    frequency = np.geomspace(*span(load), _FREQUENCIES)
    # close to w = 0 the gain leaves its static value with w^2: so does what is asked for
    weight = 1.0 + (_BODY * frequency[0] / frequency) ** 2
    weight = np.concatenate([weight, np.ones(len(edges) + 1)])
    top = np.log(limit) - _MARGIN
    heights = Heights(problem, edges)

    def levels(point: Array) -> Array:
        fixed = np.log(problem.load(point).gain(frequency))
        return weight * (top - np.concatenate([fixed, heights.levels(point)]))

    def slopes(point: Array) -> Array:
        fixed = problem.levels(point, frequency)[1]
        return -weight[:, None] * np.concatenate([fixed, heights.slopes(point)])

    answer = minimize(
        comfort.logarithm, start, jac=True, method="SLSQP", bounds=problem.bounds,
        constraints={"type": "ineq", "fun": levels, "jac": slopes},
        options={"ftol": 1e-11, "maxiter": 60},
    )  # fmt: skip
    return answer.x
