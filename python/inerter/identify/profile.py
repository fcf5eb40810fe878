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
from scipy.stats import chi2

from inerter.core import DeviceError
from inerter.estimation.least_squares import Tolerances, minimise
from inerter.estimation.secants import Secants
from inerter.identify.fit import Problem
from inerter.identify.kept import last_kept
from inerter.identify.model import Model

Array = NDArray[np.float64]
Quantity = Callable[[Model], float]

CONFIDENCE = 0.95
_LEVEL = math.sqrt(chi2.ppf(CONFIDENCE, 1))
_ROUNDS = 4
# an interval this many times wider than the parabola's is open
_OPEN = 8.0
# standard error per value from which on a positive parameter is known badly
_BADLY = 0.15
# the same from which on the value is as good as 0
_NOTHING = 50.0
# a parameter that can be this many times larger or smaller has no end there
_FAR = 10.0
# share of the largest slope of a quantity from which on a variable matters to it; distance of a
# search variable from its limit that is none
_MATTERS, _AT_LIMIT = 1e-9, 1e-6
# evaluations at most of a fit at a held value, and of one only asked whether it may be there
_EVALUATIONS, _ASKED = 30, 12
# rise of the cost beyond its least at a held value, per that at the interval's end, that is let be
_LEFT = 1e-3
_LEAST = 1e-8
# what takes the place of a residual that is none, per spread of the force
_BAD, _HUGE = 1e3, 1e100


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
    enough = float(np.clip(_LEFT * _LEVEL**2 * unit / (best + 1e-300), _LEAST, _LEFT))
    derivatives, slope = problem.jacobian(model), _slope(problem, model, quantity)

    value = quantity(model)
    # one that is known badly, and is positive, is followed in its logarithm, if it is not all but 0
    wide = _BADLY * value < error < _NOTHING * value
    unit_step = error / value if wide else error

    def target(side: int, distance: float) -> float:
        return value * math.exp(side * distance) if wide else value + side * distance

    def rise_at(
        side: int, distance: float, start: Model, evaluations: int = _EVALUATIONS
    ) -> tuple[Model, float]:
        here = _tied(
            problem, start, quantity, target(side, distance), enough, derivatives, evaluations
        )
        return here, math.sqrt(max(_squares(problem, here) - best, 0.0) / unit)

    def end(side: int) -> float | None:
        # where it costs nothing to go far, small bumps on the way are no end
        if wide:
            # many errors away too, where the value is small beside its error
            far = max(_FAR, 1 + _OPEN * _LEVEL * unit_step) if side > 0 else _FAR
            try:
                if rise_at(side, math.log(far), model, _ASKED)[1] < _LEVEL:
                    return None
            except (DeviceError, ValueError, np.linalg.LinAlgError):
                pass
        here, points = model, [(0.0, 0.0)]
        distance = min(_LEVEL * unit_step, math.log(_FAR)) if wide else _LEVEL * unit_step
        for _ in range(_ROUNDS):
            try:
                here, rise = rise_at(side, distance, here)
            except (DeviceError, ValueError, np.linalg.LinAlgError):
                # at the edge of what the parameter can be, or the force is no longer finite
                return None
            points.append((distance, rise))
            if abs(rise / _LEVEL - 1) < 0.03:
                break
            distance = _crossing(points)
            if distance > _OPEN * _LEVEL * unit_step:
                return None
        # beyond the limit of the search it would go on at no cost
        return None if _is_at_limit(problem, here, slope) else target(side, _crossing(points))

    return end(-1), end(1)


def _is_at_limit(problem: Problem, model: Model, slope: Array) -> bool:
    """Whether a variable on which a quantity depends (p,) is at the limit of its search."""
    search = problem.variables(model)
    here, (lower, upper) = search.encode(model.values), search.bounds
    matters = np.abs(slope) > _MATTERS * np.max(np.abs(slope))
    at = (here <= lower + _AT_LIMIT) | (here >= upper - _AT_LIMIT)
    return bool(np.any(matters & at))


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


def _tied(
    problem: Problem,
    model: Model,
    quantity: Quantity,
    target: float,
    enough: float,
    derivatives: Array,
    evaluations: int,
) -> Model:
    """The best fit with the quantity held at a value.

    One search variable, the pivot, follows from the others, so that the value is met exactly.

    Parameters
    ----------
    problem, model
        The data, and where the search starts.
    quantity, target
        What is held, from a model, and at which value.
    enough
        Relative fall of the cost below which a step is the last one.
    derivatives
        Of the residual [N] by the search variables (n, p), near those at the start.
    evaluations
        Of the residual, at most.

    Raises
    ------
    DeviceError
        No variable brings the quantity to the value.
    """
    search = problem.variables(model)
    how, (lower, upper) = search.ranges, search.bounds
    slope = _slope(problem, model, quantity)
    # logarithmic ones first: they reach far
    order = sorted(range(len(how)), key=lambda i: (not how[i].logarithmic, -abs(slope[i])))
    order = [i for i in order if abs(slope[i]) > _MATTERS * np.max(np.abs(slope))]
    for pivot in order:
        start = _solved(problem, model, quantity, target, pivot)
        if start is not None:
            break
    else:
        raise DeviceError(f"the quantity cannot be {target:g}")
    if len(how) == 1:
        return start
    others = np.array([i for i in range(len(how)) if i != pivot])
    base, size = search.encode(start.values), problem.scales.force

    def at(variables: Array) -> Model | None:
        step = np.zeros(len(how))
        step[others] = variables - base[others]
        return _solved(problem, problem.moved(start, step), quantity, target, pivot)

    @last_kept
    def residual(variables: Array) -> Array:
        here = at(variables)
        if here is None:
            return np.full(count, _BAD)
        return _finite(problem.masked(problem.residual(here)) / size)

    def tied(whole: Array, here: Model) -> Array:
        slope = _slope(problem, here, quantity)
        along = -slope[others] / slope[pivot] if slope[pivot] else np.zeros(others.size)
        return _finite((whole[:, others] + np.outer(whole[:, pivot], along)) / size)

    def jacobian(variables: Array) -> Array:
        here = at(variables) or start
        return tied(problem.jacobian(here), here)

    count = sum(int(mask.sum()) for mask in problem.masks)
    first = tied(derivatives, start)
    found = minimise(
        residual, base[others], (lower[others], upper[others]), jacobian,
        tolerances=Tolerances(1e-8, enough, 1e-10), evaluations=evaluations,
        secants=Secants(residual, jacobian, enough, first=first),
    )  # fmt: skip
    return at(found.variables) or start


def _finite(values: Array) -> Array:
    return np.nan_to_num(values, nan=_BAD, posinf=_HUGE, neginf=-_HUGE)


def _slope(problem: Problem, model: Model, quantity: Quantity) -> Array:
    """Derivatives of the quantity by the search variables, shape (p,)."""
    here = quantity(model)
    steps = 1e-6 * np.eye(len(model.free))
    return np.array([(quantity(problem.moved(model, step)) - here) / 1e-6 for step in steps])


def _solved(
    problem: Problem, model: Model, quantity: Quantity, target: float, pivot: int
) -> Model | None:
    """The model with its pivot moved until the quantity is at the target; None if it cannot be."""
    step = np.zeros(len(model.free))
    positive = target > 0
    for _ in range(30):
        here = quantity(problem.moved(model, step))
        if abs(here - target) <= 1e-9 * abs(target):
            return problem.moved(model, step)
        more = step.copy()
        more[pivot] += 1e-6
        there = quantity(problem.moved(model, more))
        if positive and here > 0 and there > 0:
            slope, missing = math.log(there / here) / 1e-6, math.log(target / here)
        else:
            slope, missing = (there - here) / 1e-6, target - here
        if slope == 0 or not math.isfinite(slope):
            return None
        step[pivot] += missing / slope
    return None
