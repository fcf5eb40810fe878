"""Polish of J5: the smallest level t that no peak of the gain exceeds.

At the optimum two or more peaks are equal, and the largest of them has a corner there. Each peak by
itself is smooth: frequencies are divided into intervals, one for each peak of the start, and
`minimise t, log peak_i <= t` is a smooth problem (SLSQP with exact gradients, which at a peak are
those at its fixed frequency). When peaks appear, merge or cross from one interval to another the
division is made anew, until nothing is gained.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from inerter.suspension.h_infinity_norm import gain_squared, peaks
from inerter.suspension.problem import Array, SuspensionProblem
from inerter.suspension.rational import Rational

_ROUNDS = 6
_GAINED = 1e-11
_SAME = 1e-8


def polish_peaks(problem: SuspensionProblem, start: Array, known: float) -> tuple[float, Array]:
    """Value and point of the local minimum that a start leads to, within the bounds.

    A minimum of value `known` has been found before: on the way to it there is no need to arrive.
    """
    point, best = start, float(problem.value(start[None])[0])
    for _ in range(_ROUNDS):
        moved = _solve(problem, point)
        value = float(problem.value(moved[None])[0])
        if not value < best * (1.0 - _GAINED):
            break
        point, best = moved, value
        if abs(best / known - 1.0) < _SAME:
            break
    return best, point


def local_peaks(function: Rational) -> tuple[Array, Array]:
    """Local maxima of the gain of one design: frequency [rad/s] and gain, ascending frequency."""
    x, gain = peaks(function)
    order = np.argsort(x, kind="stable")
    x, gain = x[order], gain[order]
    # a maximum is higher than the curve close by; w = 0 needs its right side only
    near = np.sqrt([gain_squared(function, x * (1.0 + d)) for d in (-1e-4, 1e-4)])
    near[:, 0] = np.sqrt(gain_squared(function, 1e-8 * x[x > 0.0].min(initial=1.0)))
    top = (gain >= near[0] * (1.0 - 1e-15)) & (gain >= near[1] * (1.0 - 1e-15))
    # one maximum can have been found more than once: the highest of each is it
    frequency = np.sqrt(x[top])
    groups = np.cumsum(np.diff(frequency, prepend=0.0) > 5e-3 * frequency)
    best = [
        members[np.argmax(gain[top][members])]
        for members in (np.flatnonzero(groups == g) for g in np.unique(groups))
    ]
    return frequency[best], gain[top][best]


def _solve(problem: SuspensionProblem, start: Array) -> Array:
    function = problem.load_function(start)
    edges = _edges(function)
    level = float(np.log(peaks(function)[1].max()))
    cache: dict[bytes, tuple[Array, Array]] = {}

    def constraint(variables: Array) -> tuple[Array, Array]:
        key = variables[:-1].tobytes()
        if key not in cache:
            cache[key] = _levels(problem, variables[:-1], edges)
        levels, slopes = cache[key]
        return variables[-1] - levels, np.column_stack([-slopes, np.ones(len(levels))])

    count = len(start)
    low, high = problem.bounds.T
    last = np.concatenate([np.zeros(count), [1.0]])
    answer = minimize(
        lambda v: (v[-1], last), np.append(start, level), jac=True, method="SLSQP",
        bounds=[*problem.bounds, (None, None)],
        constraints={
            "type": "ineq",
            "fun": lambda v: constraint(v)[0],
            "jac": lambda v: constraint(v)[1],
        },
        options={"ftol": 1e-15, "maxiter": 40},
    )  # fmt: skip
    found = answer.x[:-1]
    return np.clip(found, low, high) if np.isfinite(found).all() else start


def _edges(function: Rational) -> NDArray[np.float64]:
    """Squared frequencies that part the peaks: the lowest point between each two."""
    frequency, _ = local_peaks(function)
    edges = []
    for left, right in pairwise(frequency):
        between = np.linspace(left, right, 66)[1:-1] ** 2
        edges.append(between[np.argmin(gain_squared(function, between))])
    return np.array(edges)


def _levels(
    problem: SuspensionProblem, point: Array, edges: NDArray[np.float64]
) -> tuple[Array, Array]:
    """Logarithm of the largest gain in each interval, and its gradient."""
    function = problem.load_function(point)
    x, gain = peaks(function, refine=False)
    # an interval without a peak of its own is highest at an edge
    x = np.concatenate([x, edges])
    gain = np.concatenate([gain, np.sqrt(gain_squared(function, edges))])
    place = np.searchsorted(edges, x, side="right")
    places = range(len(edges) + 1)
    highest = [np.flatnonzero(place == n)[np.argmax(gain[place == n])] for n in places]
    one = problem.load_function_perturbed(point)
    perturbed = Rational(one.numerator[:, None, :], one.denominator[:, None, :])
    logs = 0.5 * np.log(gain_squared(perturbed, x[highest]))
    return logs[0].real, problem.step_gradient(logs).T
