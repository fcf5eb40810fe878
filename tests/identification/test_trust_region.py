"""The trust region against SciPy's on problems with and without bounds that matter."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from inerter.estimation.solution import Tolerances
from inerter.estimation.trust_region import trust_region
from scipy.optimize import least_squares

FINE, MOST = Tolerances(1e-10, 1e-12, 1e-12), 500
TIME = np.linspace(0.0, 3.0, 200)
Array = np.ndarray


def rosenbrock(p: Array) -> tuple[Array, Array]:
    """Of two variables, a curved valley to (1, 1)."""
    residual = np.array([10.0 * (p[1] - p[0] ** 2), 1.0 - p[0]])
    return residual, np.array([[-20.0 * p[0], 10.0], [-1.0, 0.0]])


def decays(p: Array) -> tuple[Array, Array]:
    """Two decays, fitted to those of other sizes and rates."""
    truth = 2.0 * np.exp(-0.7 * TIME) + np.exp(-3.0 * TIME)
    one, two = np.exp(-p[1] * TIME), np.exp(-p[3] * TIME)
    columns = [one, -p[0] * TIME * one, two, -p[2] * TIME * two]
    return p[0] * one + p[2] * two - truth, np.column_stack(columns)


def idle(p: Array) -> tuple[Array, Array]:
    """A line, and a variable that does nothing."""
    return p[0] * TIME - 2.0 * TIME + 1.0, np.column_stack([TIME, 0.0 * TIME])


CASES: dict[str, tuple[Callable[[Array], tuple[Array, Array]], list[float], float, float]] = {
    "valley": (rosenbrock, [-1.2, 1.0], -np.inf, np.inf),
    "valley below": (rosenbrock, [-1.2, -1.0], -2.0, 0.8),
    "valley above": (rosenbrock, [2.5, 2.8], 1.5, 3.0),
    "decays": (decays, [1.0, 1.0, 1.0, 2.0], -np.inf, np.inf),
    "decays held": (decays, [1.0, 1.0, 1.0, 2.0], 0.0, 2.5),
    "idle": (idle, [0.5, 0.3], -1.0, 1.5),
}


@pytest.mark.parametrize("case", CASES)
def test_it_ends_where_scipy_does(case: str) -> None:
    problem, start, lower, upper = CASES[case]
    begin, asked = np.array(start), []

    def residual(point: Array) -> Array:
        assert np.all(point > lower)
        assert np.all(point < upper)
        asked.append(point)
        return problem(point)[0]

    bounds = np.full(begin.size, lower), np.full(begin.size, upper)
    found = trust_region(residual, lambda p: problem(p)[1], begin, bounds, FINE, MOST)
    known = least_squares(
        lambda p: problem(p)[0], begin,
        lambda p: problem(p)[1],  # pyright: ignore[reportArgumentType]
        bounds, xtol=1e-10, ftol=1e-12, gtol=1e-12,
    )  # fmt: skip
    assert found.ended
    assert found.evaluations == len(asked)
    assert found.evaluations <= 1.2 * known.nfev + 3
    assert found.cost <= known.cost * (1 + 1e-8) + 1e-15
    free = 1 if case == "idle" else begin.size
    np.testing.assert_allclose(found.variables[:free], known.x[:free], rtol=0, atol=2e-5)
    np.testing.assert_array_equal(found.residual, problem(found.variables)[0])
    np.testing.assert_array_equal(found.jacobian, problem(found.variables)[1])


def test_it_backs_off_where_there_is_no_residual() -> None:
    def residual(p: Array) -> Array:
        return np.where(p < 2.0, p - 1.5, np.nan)

    bounds = np.array([-np.inf]), np.array([np.inf])
    found = trust_region(
        residual, lambda p: np.array([[0.05]]), np.array([1.0]), bounds, FINE, MOST
    )
    assert found.variables[0] == pytest.approx(1.5, abs=1e-3)
    with pytest.raises(ValueError, match="not finite where the search starts"):
        trust_region(residual, lambda p: np.eye(1), np.array([3.0]), bounds, FINE, MOST)


def test_it_stops_when_told_and_when_all_is_spent() -> None:
    told: list[int] = []

    def watch(done: int, here: Array) -> bool:
        told.append(done)
        return len(told) == 3

    bounds = np.full(2, -np.inf), np.full(2, np.inf)
    begin = np.array([-1.2, 1.0])

    def search(most: int, watch: Callable[[int, Array], bool] | None = None) -> tuple[int, bool]:
        found = trust_region(
            lambda p: rosenbrock(p)[0], lambda p: rosenbrock(p)[1], begin, bounds, FINE, most, watch
        )
        return found.evaluations, found.ended

    assert search(MOST, watch) == (told[-1], False)
    assert len(told) == 3
    assert search(7) == (7, False)


def test_a_variable_at_its_bound_does_not_hold_the_others_back() -> None:
    """As an inertance of nothing beside a constant force: a few evaluations are enough."""
    time = np.linspace(0.0, 1.0, 50)
    columns = np.column_stack([np.sin(9 * time), np.ones_like(time)])
    truth = columns @ np.array([-0.01, 200.0])
    bounds = (np.array([0.0, -np.inf]), np.array([np.inf, np.inf]))
    found = trust_region(
        lambda p: columns @ p - truth, lambda p: columns, np.array([1e-9, 0.0]), bounds,
        Tolerances(1e-7, 1e-9, 1e-10), 12,
    )  # fmt: skip
    assert found.variables[1] == pytest.approx(200.0, rel=1e-3)


@pytest.mark.parametrize("apart", [1.0, 1e-3, 1e-6])
@pytest.mark.parametrize("size", [1.0, 1e6])
def test_columns_that_are_nearly_alike_are_told_apart(apart: float, size: float) -> None:
    columns = np.column_stack([TIME, size * (TIME + apart * TIME**2), 0.0 * TIME])
    truth = columns @ np.array([1.0, 2.0 / size, 0.0])
    free = np.full(3, np.inf)
    found = trust_region(
        lambda p: columns @ p - truth, lambda p: columns, np.array([3.0, 1.0 / size, 0.5]),
        (-free, free), Tolerances(1e-14, 1e-14, 1e-14), 60,
    )  # fmt: skip
    np.testing.assert_allclose(found.variables, [1.0, 2.0 / size, 0.5], rtol=1e-6)


def test_numbers_whose_squares_dwarf_the_rest_end_it_in_peace() -> None:
    """What runs away on the way of a fit: a step below the smallest number was divided by."""
    large = 1e100

    def residual(p: Array) -> Array:
        return np.array([large * (p[0] - 1.0), 1e-3 * np.sin(p[1])])

    bounds = np.full(2, -5.0), np.full(2, 5.0)
    columns = np.diag([large, 1e-3])
    begin = np.array([0.3, 0.2])
    with np.errstate(over="ignore", invalid="ignore"):
        found = trust_region(residual, lambda p: columns, begin, bounds, FINE, 50)
    assert np.isfinite(found.variables).all()
    assert np.all(np.abs(found.variables) < 5.0)
