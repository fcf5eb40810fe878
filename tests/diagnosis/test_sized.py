"""Starting points are as large as what a model leaves."""

from __future__ import annotations

import numpy as np
import pytest
from inerter import Device
from inerter.diagnose.candidates import candidates
from inerter.diagnose.promise import Known
from inerter.diagnose.sized import Sized
from inerter.identify.fit import Problem
from inerter.identify.model import Model
from inerter.identify.runs import BenchRun

SPACING = 2e-3
IDEAL = Model("none", {"inertance": 60.0, "transition_velocity": 1e-3}, ("inertance",))
# far less than the inertance's force, each; and the coordinate that it is in proportion to
HIDDEN = {
    "coulomb_friction": ("coulomb_force", {"friction": "coulomb", "coulomb_force": 1.0}),
    "gas_spring": ("gas_push", {"gas_pressure": 2e5, "gas_area": 5e-5, "gas_volume": 2.5e-6}),
}


def problem(sign: float = 1.0, **hidden: float | str) -> Problem:
    """A run of 60 kg along three sines, with something hidden that may have the other sign."""
    time, speed = np.arange(0, 6, SPACING), 2 * np.pi * np.array([0.7, 1.9, 4.1])
    size = np.array([15e-3, 6e-3, 2e-3])
    x = size @ np.sin(np.outer(speed, time))
    v = (size * speed) @ np.cos(np.outer(speed, time))
    a = -(size * speed**2) @ np.sin(np.outer(speed, time))
    ideal, whole = (
        Device(inertance=60.0, transition_velocity=1e-3, **more).along(SPACING, x, v, a)["total"]
        for more in ({}, hidden)
    )
    force = ideal + sign * (whole - ideal)
    run = BenchRun(
        name="run", start=0.0, spacing=SPACING, displacement=x, velocity=v, acceleration=a,
        force=force, inner=np.ones(time.size, bool), first_force=float(force[0]), cutoff=np.inf,
    )  # fmt: skip
    return Problem([run], [np.ones(time.size, bool)])


def sized(run: Problem, effect: str) -> list[tuple[Model, Model]]:
    """Starting points of an effect's candidates, as they are and with the size that is best."""
    known = Known(run, run.fit(IDEAL).model)
    found = Sized(run, known)
    tried = [c for c in candidates(known.model, run.scales) if c.effect == effect]
    return [p for c in tried for p in zip(c.starts, found.of(c).starts, strict=True)]


def test_a_level_is_right_before_it_is_fitted() -> None:
    name, hidden = HIDDEN["coulomb_friction"]
    ((before, after),) = sized(problem(**hidden), "coulomb_friction")
    assert before.values[name] > 5.0
    # but for the width of sign(v), which is the candidate's own
    assert after.values[name] == pytest.approx(1.0, rel=0.05)
    assert after.free == before.free


@pytest.mark.parametrize("effect", HIDDEN)
def test_errors_are_smaller_there_and_nothing_else_moves(effect: str) -> None:
    name, hidden = HIDDEN[effect]
    run = problem(**hidden)
    for before, after in sized(run, effect):
        errors = [float(np.sum(run.residual(each)[0] ** 2)) for each in (before, after)]
        assert errors[1] < errors[0]
        assert {n for n, v in after.values.items() if v != before.values[n]} == {name}


def test_all_that_the_force_is_in_proportion_to_grows_together() -> None:
    """Stribeck's peak stays the same share of the level."""
    _, hidden = HIDDEN["coulomb_friction"]
    for before, after in sized(problem(**hidden), "stribeck_friction"):
        shares = [each.values["static_excess"] / each.values["coulomb_force"] for each in
                  (before, after)]  # fmt: skip
        assert shares[0] == pytest.approx(shares[1])
        assert after.values["coulomb_force"] < before.values["coulomb_force"]


def test_what_has_the_other_sign_begins_small_and_not_at_none() -> None:
    name, hidden = HIDDEN["coulomb_friction"]
    ((before, after),) = sized(problem(-1.0, **hidden), "coulomb_friction")
    assert 0 < after.values[name] < 0.05 * before.values[name]


@pytest.mark.parametrize("effect", ["digressive_damping", "asymmetric_damping", "viscous_drift"])
def test_a_damper_that_comes_with_its_damping_begins_as_large(effect: str) -> None:
    run = problem(viscous=8.0)
    for before, after in sized(run, effect):
        errors = [float(np.sum(run.residual(each)[0] ** 2)) for each in (before, after)]
        assert errors[1] < 0.3 * errors[0]
        assert {n for n, v in after.values.items() if v != before.values[n]} == {"viscous"}


def test_what_begins_at_none_stays_there() -> None:
    _, hidden = HIDDEN["gas_spring"]
    for effect in ("viscous_friction", "backlash", "parallel_stiffness"):
        assert all(before == after for before, after in sized(problem(**hidden), effect))


def test_a_level_that_is_known_is_not_touched() -> None:
    _, hidden = HIDDEN["coulomb_friction"]
    run = problem(**hidden)
    level = IDEAL.adding("coulomb", coulomb_force=1.0, transition_velocity=1e-3)
    known = Known(run, run.fit(level).model)
    found = Sized(run, known)
    tried = [c for c in candidates(known.model, run.scales) if c.effect == "stribeck_friction"]
    assert tried
    assert all(found.of(c) == c for c in tried)
