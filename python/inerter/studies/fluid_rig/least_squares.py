"""Bounded least squares of simulations that run in batches.

All simulations that one Jacobian needs are asked for in one call. Two stages: a search with a
trust region, from far, on the cheap problem (the first part of the tests); then steps on the whole
problem with its Jacobian held, each of which costs one evaluation, for near the end the Jacobian
hardly changes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import optimize

Array = NDArray[np.float64]
Residuals = Callable[[Array], Array]
"""Search variables (sets, p) to weighted residuals (sets, n)."""

_STEP = 2e-3
_FAILED = 1e3
_ROUNDS = 3
_CHORDS = 4
_PARTS = (0.5, 0.2, 0.05)


@dataclass(frozen=True)
class Solution:
    """variables (p,), residual (n,), jacobian (n, p) there; evaluations: sets that were run."""

    variables: Array
    residual: Array
    jacobian: Array
    evaluations: int

    @property
    def cost(self) -> float:
        """Sum of the squared residuals."""
        return float(np.sum(self.residual**2))


def search(
    residuals: Residuals, start: Array, bounds: tuple[Array, Array], evaluations: int = 15
) -> Solution:
    """From far: trust region reflective, a new Jacobian after every step that is taken.

    A set whose residuals are not finite counts as very bad.
    """
    known: dict[bytes, Array] = {}
    runs = 0

    def run(sets: Array) -> Array:
        nonlocal runs
        runs += len(sets)
        found = residuals(sets)
        return np.where(np.isfinite(found), found, _FAILED)

    def value(at: Array) -> Array:
        if at.tobytes() not in known:
            known[at.tobytes()] = run(at[None])[0]
        return known[at.tobytes()]

    def jacobian(at: Array) -> Array:
        return _jacobian(run, at, value(at), bounds)

    lower, upper = bounds
    found = optimize.least_squares(
        value, np.clip(start, lower + 1e-6, upper - 1e-6),
        jac=jacobian,  # pyright: ignore[reportArgumentType]
        bounds=bounds, ftol=1e-4, xtol=1e-4, gtol=1e-12, max_nfev=evaluations,
    )  # fmt: skip
    return Solution(found.x, found.fun, np.asarray(found.jac), runs)


def polish(
    residuals: Residuals, start: Array, bounds: tuple[Array, Array], tolerance: float = 5e-2
) -> Solution:
    """From near: Gauss-Newton steps with the Jacobian held, a new one where they do not help.

    Ends where a step is smaller than `tolerance` standard errors, for residuals of variance 1.
    """
    lower, upper = bounds
    here, runs = np.clip(start, lower, upper), 0
    jacobian = np.empty((0, here.size))

    def run(sets: Array) -> Array:
        nonlocal runs
        runs += len(sets)
        return residuals(sets)

    best = run(here[None])[0]
    if not np.isfinite(best).all():
        raise ValueError("the simulation does not reach its end where the search ended")
    for _ in range(_ROUNDS):
        jacobian = _jacobian(run, here, best, bounds)
        inverse = np.linalg.pinv(jacobian)
        errors = np.sqrt(np.diag(inverse @ inverse.T))
        for chord in range(_CHORDS):
            there = np.clip(here - inverse @ best, lower, upper)
            small = np.all(np.abs(there - here) < tolerance * errors)
            trial = run(there[None])[0]
            if not np.sum(trial**2) < np.sum(best**2) and not small:
                # along a curved valley a part of the way may help
                parts = here + np.outer(_PARTS, there - here)
                trials = run(parts)
                lowest = int(np.argmin(np.sum(trials**2, axis=1)))
                there, trial = parts[lowest], trials[lowest]
            if not np.sum(trial**2) < np.sum(best**2):
                # noise of the simulation is all that is left, or the Jacobian is out of date
                if small or chord == 0:
                    return Solution(here, best, jacobian, runs)
                break
            here, best = there, trial
            if small:
                return Solution(here, best, jacobian, runs)
    return Solution(here, best, jacobian, runs)


def _jacobian(residuals: Residuals, at: Array, value: Array, bounds: tuple[Array, Array]) -> Array:
    """Forward differences, inward at an upper bound; all sets in one call."""
    steps = np.where(at + _STEP > bounds[1], -_STEP, _STEP)
    return ((residuals(at + np.diag(steps)) - value) / steps[:, None]).T
