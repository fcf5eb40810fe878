"""Polish of the smooth indices J1, J3: gradients are exact, so the optimum is too."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from scipy.optimize import minimize

from inerter.suspension.problem import Array

_HESSIAN_STEP = 1e-4
_NEWTON_STEPS = 4
_SAME = 1e-10


class Smooth(Protocol):
    """What is polished: a value and an exact gradient over logarithms within bounds."""

    @property
    def bounds(self) -> Array:
        """Lower and upper bound of each variable, shape (variables, 2)."""
        ...

    def value(self, points: Array) -> Array:
        """The value of each point, shape (n, variables)."""
        ...

    def logarithm(self, point: Array) -> tuple[float, Array]:
        """Logarithm of the value at one point and its gradient."""
        ...


def polish_smooth(problem: Smooth, start: Array, known: float) -> tuple[float, Array]:
    """Value and point of the local minimum that a start leads to, within the bounds.

    A minimum of value `known` has been found before: its last digits are not computed again.
    """
    low, high = problem.bounds.T
    answer = minimize(
        problem.logarithm, start, jac=True, method="L-BFGS-B", bounds=problem.bounds,
        options={"ftol": 1e-13, "gtol": 1e-8, "maxiter": 300},
    )  # fmt: skip
    point = np.clip(answer.x, low, high)
    best, slope = problem.logarithm(point)
    if abs(np.exp(best) / known - 1.0) < _SAME:
        return float(np.exp(best)), point
    # Newton's method takes the last digits, in what does not press on a bound
    for _ in range(_NEWTON_STEPS):
        free = ~(((point <= low) & (slope > 0.0)) | ((point >= high) & (slope < 0.0)))
        if not free.any():
            break
        hessian = _hessian(problem, point)[np.ix_(free, free)]
        if np.linalg.eigvalsh(hessian)[0] <= 0.0:
            break
        step = np.zeros(len(point))
        step[free] = np.linalg.solve(hessian, -slope[free])
        moved = np.clip(point + step, low, high)
        value, after = problem.logarithm(moved)
        # a value cannot tell the last digits, a gradient can
        if value > best + 1e-13 or np.abs(after[free]).max() >= np.abs(slope[free]).max():
            break
        point, best, slope = moved, value, after
    return float(problem.value(point[None])[0]), point


def _hessian(problem: Smooth, point: Array) -> Array:
    rows = [
        (problem.logarithm(point + step)[1] - problem.logarithm(point - step)[1])
        for step in np.eye(len(point)) * _HESSIAN_STEP
    ]
    matrix = np.array(rows) / (2.0 * _HESSIAN_STEP)
    return 0.5 * (matrix + matrix.T)
