"""Intervals from the profile of the cost: how far a parameter can go while the others make up.

The interval ends where the cost, minimised over everything else, has risen by the 95 % quantile of
chi-squared with one degree of freedom, in units of the true variance. Where the cost is a parabola
this is 1.96 standard errors; where it is not, the two ends differ, and one may be missing: then the
data do not bound the parameter on that side.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares
from scipy.stats import chi2

from inerter.core import DeviceError
from inerter.identify.coordinates import coordinate
from inerter.identify.fit import Model, Problem

Array = NDArray[np.float64]
Quantity = Callable[[Model], float]

CONFIDENCE = 0.95
_LEVEL = math.sqrt(chi2.ppf(CONFIDENCE, 1))
_ROUNDS = 4
# an interval this many times wider than the parabola's is open
_OPEN = 8.0
_EVALUATIONS = 12


def profile_interval(
    problem: Problem, model: Model, quantity: Quantity, error: float, inflation: float
) -> tuple[float | None, float | None]:
    """Lowest and highest value of a quantity that the data allow; None where there is no end.

    Parameters
    ----------
    problem, model
        The data and the fit.
    quantity
        What the interval is of, from a model.
    error
        Its standard error, true to the correlation of the residuals.
    inflation
        True variance of the quantity per that of independent residuals.
    """
    best = _squares(problem, model)
    count = sum(int(mask.sum()) for mask in problem.masks)
    unit = best / max(count - len(model.free), 1) * max(inflation, 1e-12) + 1e-300

    def end(side: int) -> float | None:
        distance, here = _LEVEL * error, model
        points = [(0.0, 0.0)]
        for _ in range(_ROUNDS):
            target = quantity(model) + side * distance
            try:
                here = _tied(problem, here, quantity, target, error)
                reached = abs(quantity(here) - quantity(model))
                rise = math.sqrt(max(_squares(problem, here) - best, 0.0) / unit)
            except (DeviceError, ValueError, np.linalg.LinAlgError):
                # where the force is no longer finite nothing can be told
                return None
            points.append((reached, rise))
            if abs(rise / _LEVEL - 1) < 0.03:
                break
            if rise < _LEVEL and reached < 0.9 * distance:
                # at the edge of what the parameter can be
                return None
            distance = _crossing(points)
            if distance > _OPEN * _LEVEL * error:
                return None
        return quantity(model) + side * _crossing(points)

    return end(-1), end(1)


def _crossing(points: list[tuple[float, float]]) -> float:
    """Where the rise reaches its level, by straight lines; at most three times as far as seen."""
    ordered = sorted(points)
    for (x0, y0), (x1, y1) in itertools.pairwise(ordered):
        if y0 <= _LEVEL <= y1 and y1 > y0:
            return x0 + (x1 - x0) * (_LEVEL - y0) / (y1 - y0)
    farthest, rise = ordered[-1]
    return farthest * min(_LEVEL / max(rise, 1e-12), 3.0)


def _squares(problem: Problem, model: Model) -> float:
    residual = problem.residual(model)
    return sum(float(np.sum(r[m] ** 2)) for r, m in zip(residual, problem.masks, strict=True))


def _tied(problem: Problem, model: Model, quantity: Quantity, target: float, error: float) -> Model:
    """The best fit with the quantity held at a value."""
    how = [coordinate(name, problem.scales) for name in model.free]
    lower, upper = np.array([each.bounds for each in how]).T
    size = problem.scales.force
    count = sum(int(mask.sum()) for mask in problem.masks)
    # a deviation of a tenth of the error costs more than all residuals do
    weight = 10 * math.sqrt(count) / error

    def at(variables: Array) -> Model:
        return problem.moved(model, variables - start)

    def residual(variables: Array) -> Array:
        here = at(variables)
        parts = [r[m] / size for r, m in zip(problem.residual(here), problem.masks, strict=True)]
        return np.append(np.concatenate(parts), weight * (quantity(here) - target))

    def jacobian(variables: Array) -> Array:
        here = at(variables)
        row = np.empty(variables.size)
        for i in range(variables.size):
            step = np.zeros(variables.size)
            step[i] = 1e-6
            row[i] = (quantity(problem.moved(here, step)) - quantity(here)) / 1e-6
        return np.vstack([problem.jacobian(here) / size, weight * row])

    start = problem.variables(model)
    if not (np.isfinite(residual(start)).all() and np.isfinite(jacobian(start)).all()):
        raise DeviceError("the force is not finite there")
    inside = np.clip(start, lower + 1e-9, upper - 1e-9)
    found = least_squares(
        residual, inside, jac=jacobian,  # pyright: ignore[reportArgumentType]
        bounds=(lower, upper), xtol=1e-8, ftol=1e-8, gtol=1e-10, max_nfev=_EVALUATIONS,
    )  # fmt: skip
    return at(found.x)
