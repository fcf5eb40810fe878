"""A bristle that yields far within what a reversal is known to is none."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from bench_runs import measured
from inerter.diagnose.decision import CRITERIA
from inerter.diagnose.exchange import blurred_bristle
from inerter.identify.fit import Problem
from inerter.identify.model import Model
from inerter.identify.runs import thin
from inerter.records.preparation import prepare
from inerter.reference import ReferenceDevice, sum_of_sines

LEVEL = 40.0


def problem_of(device: ReferenceDevice) -> Problem:
    motion = sum_of_sines([0.01, 0.004, 0.002], [0.7, 1.9, 4.1], [0.3, 1.0, 2.0])
    runs = measured(device, [motion], np.arange(0, 6, 1e-3), force_noise=1.0)
    thinned = [thin(each) for each in prepare(runs).motions]
    return Problem(thinned, [np.ones(run.force.size, bool) for run in thinned])


def exchanged(problem: Problem, presliding: float) -> Any:
    """What takes the place of a bristle that yields within so many metres, if anything does."""
    values = {"inertance": 20.0, "coulomb_force": LEVEL, "presliding": presliding}
    model = Model("dahl", {**values, "transition_velocity": 1e-4}, tuple(values))
    fit = problem.fit(model, evaluations=1)
    search: Any = SimpleNamespace(
        problem=problem, may_be=lambda model: True, score=lambda effect, law, fit: fit
    )
    current: Any = SimpleNamespace(model=model, fit=fit)
    return blurred_bristle(search, current)


def test_it_is_plain_friction_below_what_is_seen_and_stays_above() -> None:
    device = ReferenceDevice(
        inertance=20.0, friction="coulomb", coulomb_force=LEVEL, transition_velocity=1e-5
    )
    problem = problem_of(device)
    least = CRITERIA.bristle_seen * problem.scales.place_resolution
    found = exchanged(problem, 0.5 * least)
    assert found.model.friction == "coulomb"
    assert found.model.values["coulomb_force"] == pytest.approx(LEVEL, rel=0.03)
    assert exchanged(problem, 3.0 * least) is None


def test_it_stays_where_plain_friction_is_worse_than_the_blur() -> None:
    """Of friction with memory that is seen, whatever a search says of its distance."""
    dahl = ReferenceDevice(
        inertance=20.0, friction="dahl", coulomb_force=LEVEL, bristle_stiffness=1e5
    )
    problem = problem_of(dahl)
    model = Model(
        "dahl",
        {"inertance": 20.0, "coulomb_force": 40.0, "presliding": 4e-4, "transition_velocity": 1e-4},
        ("inertance", "coulomb_force", "presliding"),
    )  # fmt: skip
    fit = problem.fit(model)
    tiny: Any = SimpleNamespace(model=model.holding(presliding=1e-9), fit=fit)
    search: Any = SimpleNamespace(
        problem=problem, may_be=lambda model: True, score=lambda effect, law, fit: fit
    )
    assert blurred_bristle(search, tiny) is None
