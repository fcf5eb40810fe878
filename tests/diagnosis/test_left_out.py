"""Errors on folds left out: how far a refit without a fold may go."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from inerter.core import Device
from inerter.diagnose.decision import CRITERIA
from inerter.diagnose.left_out import left_out_errors
from inerter.identify.fit import Fit, Limits, Problem
from inerter.identify.model import Model
from inerter.identify.runs import BenchRun
from inerter.identify.split import spread_folds

RATE = 100.0
TIME = np.arange(0, 20, 1 / RATE)
TRUTH = {"inertance": 50.0, "stop_upper": 0.021, "stop_stiffness": 2e4, "stop_damping": 0.0}


def run() -> BenchRun:
    """A beat of two sines that reaches a stop at its height alone."""
    speed = 2 * np.pi * np.array([[1.0], [1.045]])
    phase = speed * (TIME - 10.0)
    size = 0.011
    x, v = size * np.cos(phase).sum(0), -size * (speed * np.sin(phase)).sum(0)
    a = -size * (speed**2 * np.cos(phase)).sum(0)
    force = Device(**TRUTH).evaluate(x, v, a, 0.0)["total"]
    force += 0.2 * np.random.default_rng(3).standard_normal(TIME.size)
    return BenchRun(
        name="run", start=0.0, spacing=1 / RATE, displacement=x, velocity=v, acceleration=a,
        force=force, inner=np.ones(TIME.size, bool), first_force=float(force[0]), cutoff=np.inf,
    )  # fmt: skip


@pytest.fixture(scope="module")
def problem() -> Problem:
    one = run()
    return Problem([one], [one.inner])


def folds(whole: Problem) -> list[tuple[Problem, list[Any]]]:
    masks = spread_folds(whole.masks)
    return [
        (whole.with_masks([m & ~f for m, f in zip(whole.masks, fold, strict=True)]), fold)
        for fold in masks
    ]


def test_what_shows_in_few_places_is_refitted_near_its_fit(
    problem: Problem, monkeypatch: pytest.MonkeyPatch
) -> None:
    fit = problem.fit(Model("none", {**TRUTH, "viscous": 1.0}, (*TRUTH, "viscous")))
    usual, refits = Problem.fit, []

    def seen(self: Problem, model: Model, *args: Any, within: Limits | None = None, **more: Any):
        refits.append((within, usual(self, model, *args, within=within, **more)))
        return refits[-1][1]

    monkeypatch.setattr(Problem, "fit", seen)
    left_out_errors(problem, folds(problem), [fit])
    assert len(refits) == 4
    errors = np.sqrt(np.diag(fit.covariance))
    free = fit.model.free
    for within, refit in refits:
        assert within is not None
        reach = (within[1] - within[0]) / 2 * problem.units(fit.model)
        for name, found, error in zip(free, reach, errors, strict=True):
            wanted = CRITERIA.refit_reach * error if name.startswith("stop") else np.inf
            assert found == pytest.approx(wanted), name
        at = free.index("stop_stiffness")
        moved = abs(np.log(refit.model.values[free[at]] / fit.model.values[free[at]]))
        assert moved < 1.01 * CRITERIA.refit_reach * errors[at] / fit.model.values[free[at]]


def test_all_else_is_refitted_freely(problem: Problem, monkeypatch: pytest.MonkeyPatch) -> None:
    fit = problem.fit(Model("none", {"inertance": 40.0, "viscous": 1.0}, ("inertance", "viscous")))
    usual = Problem.fit

    def seen(self: Problem, model: Model, *args: Any, within: Limits | None = None, **more: Any):
        assert within is None
        return usual(self, model, *args, **more)

    monkeypatch.setattr(Problem, "fit", seen)
    ((told, errors),) = left_out_errors(problem, folds(problem), [fit])
    assert isinstance(told, Fit)
    assert np.isfinite(errors[0]).all()
