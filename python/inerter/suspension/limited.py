"""The best design within limits: an index as small as possible while others stay below a value.

Candidates are the best feasible designs of a grid, the designs that are best for the index and for
each of the limits, and those of a caller; each is polished by SLSQP with exact gradients over
logarithms. A limit of J5 holds at frequencies that are close together while a design is sought, and
at its certified peak where it is accepted.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.optimize import minimize

from inerter.suspension.h_infinity_norm import gain_squared
from inerter.suspension.indices import indices_of
from inerter.suspension.polish_peaks import local_peaks
from inerter.suspension.problem import Array, SuspensionProblem
from inerter.suspension.vehicle.load_peaks import peaks as vehicle_peaks
from inerter.suspension.vehicle.load_peaks import span
from inerter.suspension.vehicle.problem import VehicleProblem
from inerter.suspension.white_road import refuse_infinite

Problem = SuspensionProblem | VehicleProblem

_SLACK = 1e-6
_FREQUENCIES = 160
_PER_AXIS = {1: 400, 2: 60, 3: 18, 4: 8, 5: 5}
_SPREAD = 1500
_KEPT = 3
_ROUNDS = 4


class LimitError(ValueError):
    """Limits that no design keeps; one line."""


@dataclass(frozen=True)
class Limited:
    """`value` of the index at `point` of `problem`, and the limits that hold it back by name."""

    problem: Problem
    value: float
    point: Array
    reached: tuple[str, ...]


def best_within(problem: Problem, starts: Sequence[Array] = ()) -> Limited:
    """The best design of a problem with `limits`.

    Parameters
    ----------
    problem
        Its `limits` are pairs of an index and the highest value that it may have (SI).
    starts
        Points to begin from, beside the own ones.

    Raises
    ------
    LimitError
        No design was found that keeps the limits: says how low each index can be.
    InfiniteIndexError
        The index or one of the limits has no finite value, for tyre damping.
    """
    refuse_infinite(problem)
    best: Limited | None = None
    picked = [one for choice in problem.picked() for one in choice.variants()]
    # what is best without limits bounds what is best within them: most promising first, and where
    # that is no better than what is known, all that follow are not either
    alone = [_alone_or_inf(one) for one in picked]
    for i in sorted(range(len(picked)), key=lambda i: alone[i][0]):
        one, (bound, point) = picked[i], alone[i]
        if best is not None and bound >= best.value * (1.0 - 1e-9):
            break
        if not one.variables:
            found = _alone_within(one)
        elif not one.limits:
            found = Limited(one, bound, point, ())
        else:
            near = [x for x in starts if len(x) == len(one.variables)]
            found = _search(one, [*near, point])
        # a part that may be absent is, where that costs nothing
        if found is not None and (best is None or found.value < best.value * (1.0 - 1e-9)):
            best = found
    if best is None:
        lowest = []
        for index, most in problem.limits:
            least = _lowest(replace(problem, index=index, limits=()))
            lowest.append(f"{index} {most:g} (alone not below {least:.5g})")
        raise LimitError(
            f"layout {problem.layout}: no design keeps {', '.join(lowest)}; raise a limit"
        )
    return best


def values_of(problem: Problem, point: Array) -> dict[str, float]:
    """Every index of one design, the problem's own and those of its limits too."""
    sides = problem.car.sides if isinstance(problem, VehicleProblem) else None
    own = (problem.index, *(name for name, _ in problem.limits))
    shown = dict.fromkeys((*indices_of(sides), *own))
    found = {
        name: float(np.ravel(replace(problem, index=name, limits=()).value(point[None]))[0])
        for name in shown
    }
    # what tyre damping makes infinite is not told
    return {name: x for name, x in found.items() if name in own or np.isfinite(x)}


def _alone_or_inf(problem: Problem) -> tuple[float, Array]:
    """Value and point of the best design without limits; infinite where there is none."""
    bare, point = replace(problem, limits=()), np.empty(0)
    if bare.variables:
        value, point = _best_alone(bare)
    else:
        value = float(np.ravel(bare.value(point[None]))[0])
    return (value if np.isfinite(value) else np.inf), point


def _alone_within(problem: Problem) -> Limited | None:
    """The one design of a problem in which nothing is free, if it keeps the limits."""
    point = np.empty(0)
    values = {
        name: float(np.ravel(replace(problem, index=name, limits=()).value(point[None]))[0])
        for name in (problem.index, *dict(problem.limits))
    }
    if any(values[name] > most * (1.0 + _SLACK) for name, most in problem.limits):
        return None
    near = [name for name, most in problem.limits if values[name] >= most * (1.0 - 1e-4)]
    value = values[problem.index]
    return Limited(problem, value, point, tuple(near)) if np.isfinite(value) else None


def _lowest(problem: Problem) -> float:
    if problem.catalogue or not problem.variables:
        every = map(_bare, problem.picked())
        return min((found.value for found in every if found), default=np.inf)
    found = _search(problem, ())
    return np.inf if found is None else found.value


def _bare(problem: Problem) -> Limited | None:
    return _search(problem, ()) if problem.variables else _alone_within(problem)


def _search(problem: Problem, starts: Sequence[Array]) -> Limited | None:
    """The best within limits; starts: none, or with the best without limits among them."""
    bare = replace(problem, limits=())
    others = [replace(bare, index=index) for index, _ in problem.limits]
    most = np.array([value for _, value in problem.limits])
    best = None
    alone = [_alone(one) for one in ((bare, *others) if not len(starts) else others)]
    for start in [*starts, *alone, *_candidates(bare, others, most)]:
        point, extra = np.asarray(start), np.empty(0)
        # where a peak of J5 stands between the frequencies, it becomes one of them
        for _ in range(_ROUNDS):
            point = _solve(bare, others, most, point, extra)
            if all(one.index != "J5" for one in (bare, *others)):
                break
            extra = np.append(extra, _peaks(bare, point))
        limited = np.array([float(one.value(point[None])[0]) for one in others])
        if not np.all(limited <= most * (1.0 + _SLACK)):
            continue
        value = float(bare.value(point[None])[0])
        if best is None or value < best.value * (1.0 - 1e-10):
            near = limited >= most * (1.0 - 1e-4)
            names = [index for index, _ in problem.limits]
            reached = tuple(name for name, on in zip(names, near, strict=True) if on)
            best = Limited(problem, value, point, reached)
    return best


def _candidates(bare: Problem, others: list[Any], most: Array) -> list[Array]:
    """The best feasible points of a grid, or where limits are exceeded least."""
    low, high = bare.bounds.T
    count = len(low)
    if isinstance(bare, SuspensionProblem):
        axes = [np.linspace(a, b, _PER_AXIS[count]) for a, b in bare.bounds]
        points = np.array(list(itertools.product(*axes)))
    else:
        from scipy.stats.qmc import Halton

        points = low + Halton(count, scramble=False).random(_SPREAD + 1)[1:] * (high - low)
        # most of the corners of so many variables are no car: look closer about the middle
        centre = _alone(replace(bare, index="J1" if bare.index == "J5" else bare.index))
        points = np.vstack([points, centre + 0.25 * (points - 0.5 * (low + high))])
        points = np.clip(points, low, high)
    values = _quick(bare, points)
    excess = np.zeros(len(points))
    for one, limit in zip(others, most, strict=True):
        with np.errstate(invalid="ignore", divide="ignore"):
            over = np.log(_quick(one, points) / limit)
        excess = np.maximum(excess, np.nan_to_num(over, nan=np.inf, posinf=1e3))
    kept: list[Array] = []
    score = np.where(excess <= 0.0, values, np.inf)
    for order in (np.argsort(score), np.argsort(excess, kind="stable"), np.argsort(values)):
        taken = 0
        for place in order[:400]:
            point = points[place]
            if all(np.abs(point - other).max() > 0.5 for other in kept):
                kept.append(point)
                taken += 1
            if taken == _KEPT:
                break
    return kept


def _alone(problem: Problem) -> Array:
    """The design that is best without limits."""
    return _best_alone(problem)[1]


def _best_alone(problem: Problem) -> tuple[float, Array]:
    """Value and point of it."""
    if isinstance(problem, VehicleProblem):
        from inerter.suspension.vehicle.search import best_point

        return best_point(problem)
    from inerter.suspension.optimum import best_point as best_quarter

    return best_quarter(problem)


def _quick(problem: Problem, points: Array) -> Array:
    if isinstance(problem, SuspensionProblem):
        if problem.index == "J5":
            from inerter.suspension.coarse_search import coarse_values

            return coarse_values(problem, points)
        return np.real(problem.value(points))
    from inerter.suspension.vehicle.starts import coarse_values as vehicle_values

    return vehicle_values(problem, points)


def _peaks(problem: Problem, point: Array) -> Array:
    """Frequencies [rad/s] of the peaks of J5."""
    if isinstance(problem, SuspensionProblem):
        found = local_peaks(problem.load_function(point))[0]
    else:
        found = vehicle_peaks(problem.load(point))[0]
    return found[found > 0.0]


def _solve(bare: Problem, others: list[Any], most: Array, start: Array, extra: Array) -> Array:
    """One local minimum within the limits, or the start where it fails."""
    tops = np.log(most).tolist()
    parts = [_constraint(one, top, extra) for one, top in zip(others, tops, strict=True)]
    if bare.index == "J5":
        # the smallest level that no frequency exceeds
        level = _gains(bare, extra)
        first = float(level(start)[0].max())
        n = len(start)
        answer = minimize(
            lambda x: (x[-1], np.append(np.zeros(n), 1.0)), np.append(start, first), jac=True,
            method="SLSQP", bounds=[*bare.bounds, (None, None)],
            constraints=[
                {"type": "ineq", "fun": lambda x: x[-1] - level(x[:-1])[0],
                 "jac": lambda x: np.column_stack([-level(x[:-1])[1],
                                                   np.ones(_FREQUENCIES + len(extra))])},
                *({"type": "ineq", "fun": lambda x, p=p: p(x[:-1])[0],
                   "jac": lambda x, p=p: np.column_stack([p(x[:-1])[1],
                                                          np.zeros(len(p(x[:-1])[0]))])}
                  for p in parts),
            ],
            options={"ftol": 1e-12, "maxiter": 80},
        )  # fmt: skip
        found = answer.x[:-1]
    else:
        answer = minimize(
            bare.logarithm, start, jac=True, method="SLSQP", bounds=bare.bounds,
            constraints=[{"type": "ineq", "fun": lambda x, p=p: p(x)[0],
                          "jac": lambda x, p=p: p(x)[1]} for p in parts],
            options={"ftol": 1e-12, "maxiter": 80},
        )  # fmt: skip
        found = answer.x
    low, high = bare.bounds.T
    return np.clip(found, low, high) if np.isfinite(found).all() else start


def _constraint(one: Problem, top: float, extra: Array) -> Any:
    """What has to be positive, and its gradient: room below a limit, in logarithms."""
    if one.index == "J5":
        gains = _gains(one, extra)

        def room(point: Array) -> tuple[Array, Array]:
            logs, slopes = gains(point)
            return top - 1e-8 - logs, -slopes

        return room

    def below(point: Array) -> tuple[Array, Array]:
        value, slope = one.logarithm(point)
        if not np.isfinite(value):
            return np.array([-10.0]), np.zeros((1, len(point)))
        return np.array([top - value]), -slope[None]

    return below


def _gains(problem: Problem, extra: Array) -> Any:
    """Logarithm of the gain of J5 over frequencies, and its gradient in the variables."""
    if isinstance(problem, SuspensionProblem):
        car, k = problem.car, problem.stiffness
        both = 1.0 / (1.0 / k + 1.0 / car.tyre_stiffness)
        low = 0.1 * np.sqrt(both / (car.sprung_mass + car.unsprung_mass))
        high = 3.0 * np.sqrt((k + car.tyre_stiffness) / car.unsprung_mass)
        x = np.append(np.geomspace(low, high, _FREQUENCIES), extra) ** 2

        def quarter(point: Array) -> tuple[Array, Array]:
            functions = problem.load_function_perturbed(point)
            one = replace(
                functions,
                numerator=functions.numerator[:, None, :],
                denominator=functions.denominator[:, None, :],
            )
            logs = 0.5 * np.log(gain_squared(one, x))
            return logs[0].real, problem.step_gradient(logs).T

        return quarter

    middle = 0.5 * problem.bounds.sum(axis=1)
    frequency = np.append(np.geomspace(*span(problem.load(middle)), _FREQUENCIES), extra)

    def vehicle(point: Array) -> tuple[Array, Array]:
        return problem.levels(point, frequency)

    return vehicle
