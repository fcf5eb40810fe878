"""The lowest of the local minima that the starting points lead to."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from inerter.suspension.polish_smooth import polish_smooth
from inerter.suspension.problem import Array
from inerter.suspension.vehicle.polish_peaks import polish_peaks
from inerter.suspension.vehicle.problem import VehicleProblem
from inerter.suspension.vehicle.starts import starting_points

# relative: what counts as equal to the lower bound of J5
EQUAL = 1e-9


@lru_cache(maxsize=256)
def best_point(problem: VehicleProblem, more: int = 1) -> tuple[float, Array]:
    """Value and point of the global minimum; `more` as in `starting_points`."""
    if not problem.variables:
        alone = np.empty(0)
        return float(problem.value(alone[None])[0]), alone
    polish = polish_peaks if problem.index == "J5" else polish_smooth
    best, at = np.inf, np.empty(0)
    # what a layout contains is a design of it: so it is never worse
    starts = [
        problem.embedded(inner.struts(best_point(inner)[1]), inner.layout)
        for inner in problem.inner()
    ]
    for start in [*starting_points(problem, more), *starts]:
        value, point = polish(problem, start, best)
        # of equal ones the first, which alone was followed to its last digits
        if value < best * (1.0 - 1e-8):
            best, at = value, point
        # nothing is below the lower bound
        if at_bound(problem, best):
            break
    return best, at


def at_bound(problem: VehicleProblem, value: float) -> bool:
    """Whether a value is the static one, below which no J5 is."""
    return problem.index == "J5" and value <= problem.static_compliance() * (1.0 + EQUAL)
