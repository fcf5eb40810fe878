"""The best design of a layout within limits on other indices.

    minimise log J(x)   subject to   log J_i(x) <= log limit_i,   x within its bounds

SLSQP with exact gradients of all indices, from the optimum of the index itself, from that of each
limited one, from points between, and from designs that the caller knows. Where the optimum without
limits keeps them, it is the answer. Layouts that this one has as a limit are solved too, so that it
is never worse than any of them. All indices but J5 can be limited, which is not smooth.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.optimize import minimize

from inerter.suspension.indices import INDICES
from inerter.suspension.optimum import limit_of, optimise
from inerter.suspension.problem import Array, SuspensionProblem

# relative: what a limit may be exceeded by
_SLACK = 1e-6
_BLENDS = (0.25, 0.5, 0.75)


@dataclass(frozen=True)
class Limited:
    """A design within limits: its `layout`, `value`, `indices` and `design` by name, SI units."""

    layout: str
    value: float
    indices: Mapping[str, float]
    design: Mapping[str, float]
    point: tuple[float, ...]


def optimise_within(
    problem: SuspensionProblem,
    limits: Mapping[str, float],
    known: Sequence[Limited] = (),
) -> Limited | None:
    """The best design whose other indices are at most their limits; None where there is none.

    Parameters
    ----------
    problem
        What is to be minimised over which designs; its index is smooth.
    limits
        Largest values of indices by name, SI units.
    known
        Designs of this layout or of those that it has as limits, to start from.

    Raises
    ------
    ValueError
        J5 is limited or minimised, or a limit is not positive.
    """
    for name in (problem.index, *limits):
        if not INDICES[name].smooth:
            raise ValueError(f"{name} is not smooth: it cannot be limited, nor found within limits")
    for name, value in limits.items():
        if not 0.0 < value < np.inf:
            raise ValueError(f"limit of {name} is {value:g}: give a positive number")
    best = _own(problem, limits, [one for one in known if one.layout == problem.layout])
    for name, ends in problem.network.limits.items():
        inner = limit_of(problem, name, ends)
        other = None if inner is None else optimise_within(inner, limits, known)
        if other is not None and (best is None or other.value < best.value * (1.0 - 1e-9)):
            best = other
    return best


def _own(
    problem: SuspensionProblem, limits: Mapping[str, float], known: Sequence[Limited]
) -> Limited | None:
    others = {name: replace(problem, index=name) for name in limits}
    starts = [_optimum(problem), *map(_optimum, others.values())]
    blends = [s * a + starts[0] * (1.0 - a) for s in starts[1:] for a in _BLENDS]
    found: list[tuple[float, Array]] = []
    near = [np.array(one.point) for one in known]
    # neighbours of a front are better starts than points between
    for start in [*starts, *(near or blends)]:
        point = _solve(problem, others, limits, start)
        for tried in (point, start):
            if _keeps(others, limits, tried):
                found.append((float(problem.value(tried[None])[0]), tried))
                break
        # nothing is better than the optimum without limits
        if start is starts[0] and _keeps(others, limits, start):
            found = [(float(problem.value(start[None])[0]), start)]
            break
    if not found:
        return None
    value, point = min(found, key=lambda one: one[0])
    return _described(problem, value, point)


_cache: dict[Any, Array] = {}


def _optimum(problem: SuspensionProblem) -> Array:
    """The point of the layout's own optimum."""
    if problem not in _cache:
        best = optimise(problem, limits=False)
        values = {"damping": best.damping, "inertance": best.inertance, **best.more}
        if best.relaxation_stiffness is not None:
            values["relaxation_stiffness"] = best.relaxation_stiffness
        low, high = np.exp(problem.bounds.T)
        sought = [values[name] for name in problem.variables]
        _cache[problem] = np.log(np.clip(_unscaled(problem, sought), low, high))
    return _cache[problem]


def _unscaled(problem: SuspensionProblem, sought: Sequence[float]) -> Array:
    """Sought values from actual ones: centring springs are scaled, see `Layout.values`."""
    values = dict(zip(problem.variables, sought, strict=True))
    network = problem.network
    if network.centring:
        beside = problem.stiffness - network.at_rest(values | dict(problem.fixed))
        share = max(beside, 1e-9 * problem.stiffness) / problem.stiffness
        values |= {name: values[name] / share for name in network.centring}
    return np.array([values[name] for name in problem.variables])


def _solve(
    problem: SuspensionProblem,
    others: Mapping[str, SuspensionProblem],
    limits: Mapping[str, float],
    start: Array,
) -> Array:
    tops = {name: float(np.log(value)) for name, value in limits.items()}
    constraints = [
        {
            "type": "ineq",
            "fun": lambda x, o=other, top=tops[name]: top - o.logarithm(x)[0],
            "jac": lambda x, o=other: -o.logarithm(x)[1],
        }
        for name, other in others.items()
    ]
    answer = minimize(
        problem.logarithm, start, jac=True, method="SLSQP", bounds=problem.bounds,
        constraints=constraints, options={"ftol": 1e-11, "maxiter": 200},
    )  # fmt: skip
    low, high = problem.bounds.T
    return np.clip(np.nan_to_num(answer.x, nan=0.0), low, high)


def _keeps(
    others: Mapping[str, SuspensionProblem], limits: Mapping[str, float], point: Array
) -> bool:
    return all(
        float(other.value(point[None])[0]) <= limits[name] * (1.0 + _SLACK)
        for name, other in others.items()
    )


def _described(problem: SuspensionProblem, value: float, point: Array) -> Limited:
    indices = {name: float(replace(problem, index=name).value(point[None])[0]) for name in INDICES}
    design = {name: float(x) for name, x in problem.parameters(point).items()}
    return Limited(problem.layout, value, indices, design, tuple(point.tolist()))
