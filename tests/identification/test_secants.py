"""A Jacobian that follows a search: the same minimum, fewer derivatives, true ones where asked."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from inerter.estimation.least_squares import Tolerances, minimise
from inerter.estimation.secants import Secants

TIMES = np.linspace(0.0, 3.0, 80)
FREE = (np.full(3, -5.0), np.full(3, 5.0))
FINE = Tolerances(1e-12, 1e-12, 1e-12)


class Counted:
    """exp(v0) exp(-exp(v1) t) + v2 t less that at some values; counts derivatives."""

    def __init__(self, truth: np.ndarray, noise: float = 0.0) -> None:
        self.asked = 0
        self.measured = self.curve(truth) + noise * np.sin(37.0 * TIMES)

    @staticmethod
    def curve(v: np.ndarray) -> np.ndarray:
        return np.exp(v[0]) * np.exp(-np.exp(v[1]) * TIMES) + v[2] * TIMES

    def residual(self, v: np.ndarray) -> np.ndarray:
        return self.curve(v) - self.measured

    def jacobian(self, v: np.ndarray) -> np.ndarray:
        self.asked += 1
        decay = np.exp(v[0]) * np.exp(-np.exp(v[1]) * TIMES)
        return np.column_stack([decay, -np.exp(v[1]) * TIMES * decay, TIMES])


def test_of_a_linear_residual_one_jacobian_is_enough() -> None:
    asked = 0
    matrix = np.random.default_rng(4).normal(size=(50, 4))
    truth = np.array([1.0, -2.0, 0.5, 3.0])

    def jacobian(point: np.ndarray) -> np.ndarray:
        nonlocal asked
        asked += 1
        return matrix

    def residual(point: np.ndarray) -> np.ndarray:
        return matrix @ (point - truth)

    bounds = (np.full(4, -9.0), np.full(4, 9.0))
    secants = Secants(residual, jacobian, 1e-9, rough=True)
    found = minimise(residual, np.zeros(4), bounds, jacobian, secants=secants)
    np.testing.assert_allclose(found.variables, truth, atol=1e-7)
    assert asked == 1


@settings(deadline=None, max_examples=40)
@given(
    truth=st.tuples(st.floats(-1, 1), st.floats(-1, 1), st.floats(-1, 1)),
    start=st.tuples(st.floats(-1, 1), st.floats(-1, 1), st.floats(-1, 1)),
)
@example(truth=(0.0, 0.0, 0.0), start=(0.0, 0.0, 3.7e-116))
def test_the_end_is_that_of_true_derivatives(
    truth: tuple[float, float, float], start: tuple[float, float, float]
) -> None:
    plain, followed = (Counted(np.array(truth), noise=0.05) for _ in range(2))
    expected = minimise(plain.residual, np.array(start), FREE, plain.jacobian, tolerances=FINE)
    secants = Secants(followed.residual, followed.jacobian, FINE.cost)
    found = minimise(
        followed.residual, np.array(start), FREE, followed.jacobian, tolerances=FINE,
        secants=secants,
    )  # fmt: skip
    np.testing.assert_allclose(found.variables, expected.variables, atol=2e-5)
    assert found.cost == pytest.approx(expected.cost, rel=1e-8)


def test_fewer_derivatives_are_asked() -> None:
    asked = []
    for secant in (False, True):
        problem = Counted(np.array([0.5, -0.3, 0.2]), noise=0.02)
        follow = Secants(problem.residual, problem.jacobian, 1e-8, rough=True) if secant else None
        start = np.array([0.2, 0.1, 0.0])
        minimise(problem.residual, start, FREE, problem.jacobian, secants=follow)
        asked.append(problem.asked)
    assert asked[1] < asked[0] / 2


def test_derivatives_given_for_the_start_are_taken() -> None:
    problem = Counted(np.array([0.5, -0.3, 0.2]))
    start = np.array([0.45, -0.25, 0.2])
    first = problem.jacobian(start + 0.02)
    problem.asked = 0
    secants = Secants(problem.residual, problem.jacobian, 1e-8, rough=True, first=first)
    found = minimise(problem.residual, start, FREE, problem.jacobian, secants=secants)
    np.testing.assert_allclose(found.variables, [0.5, -0.3, 0.2], atol=1e-4)
    assert problem.asked == 0


def test_wrong_derivatives_are_not_followed_to_an_end() -> None:
    """Derivatives that lead nowhere end a search only after true ones had their say."""
    problem = Counted(np.array([0.5, -0.3, 0.2]))
    start = np.array([0.1, 0.4, -0.4])
    wrong = -problem.jacobian(start)
    secants = Secants(problem.residual, problem.jacobian, 1e-12, first=wrong)
    found = minimise(
        problem.residual, start, FREE, problem.jacobian, tolerances=FINE, secants=secants
    )
    np.testing.assert_allclose(found.variables, [0.5, -0.3, 0.2], atol=1e-6)


def test_columns_that_bend_are_asked_for_before_all_of_them() -> None:
    """A term beside a linear model whose columns are known: no other column is asked for again."""
    problem = Counted(np.array([0.5, -0.3, 0.2]))
    start = np.array([0.0, 0.6, -0.5])
    first, bent = problem.jacobian(start), 0
    problem.asked = 0

    def bending(point: np.ndarray) -> tuple[list[int], np.ndarray]:
        nonlocal bent
        bent += 1
        decay = np.exp(point[0]) * np.exp(-np.exp(point[1]) * TIMES)
        return [0, 1], np.column_stack([decay, -np.exp(point[1]) * TIMES * decay])

    secants = Secants(
        problem.residual, problem.jacobian, 1e-10, rough=True, first=first, bending=bending
    )
    found = minimise(problem.residual, start, FREE, problem.jacobian, secants=secants)
    np.testing.assert_allclose(found.variables, [0.5, -0.3, 0.2], atol=1e-4)
    alone = Counted(np.array([0.5, -0.3, 0.2]))
    secants = Secants(alone.residual, alone.jacobian, 1e-10, rough=True, first=first)
    minimise(alone.residual, start, FREE, alone.jacobian, secants=secants)
    assert bent > 0
    assert problem.asked < alone.asked
