"""Machines that run up and never turn back."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from inerter.catalogue.scales import size_of
from inerter.diagnose import diagnose_bench
from inerter.diagnose.cannot_tell import goes_one_way, hidden_by, runs_up
from inerter.identify.runs import scales, thin
from inerter.records import Record
from inerter.records.motion import smooth
from inerter.records.preparation import prepare

TIME = np.arange(0, 6, 1 / 100)
INERTANCE, VISCOUS, COULOMB = 0.05, 0.004, 0.03


def run_up(seed: int, steady: bool) -> Record:
    """A flywheel that gains speed evenly, or ever less, with friction and a damper."""
    draw = np.random.default_rng([seed, 5])
    if steady:
        angle, speed, rise = 2 * TIME + 0.5 * TIME**2, 2 + TIME, np.ones_like(TIME)
    else:
        fade = np.exp(-TIME / 1.5)
        angle, speed, rise = 9 * (TIME + 1.5 * fade), 9 * (1 - fade), 6 * fade
    torque = INERTANCE * rise + VISCOUS * speed + COULOMB
    return Record(
        name="run up", time=TIME, displacement=angle + 1e-5 * draw.standard_normal(TIME.size),
        force=torque + 1e-3 * draw.standard_normal(TIME.size), motion="rotation",
    )  # fmt: skip


@pytest.mark.parametrize("steady", [True, False])
def test_it_is_no_sine(steady: bool, effects_seed: int) -> None:
    run = thin(prepare([run_up(effects_seed, steady)]).motions[0])
    assert not scales([run]).one_tone
    assert goes_one_way([run])


def test_what_one_direction_hides_is_said(effects_seed: int) -> None:
    found = diagnose_bench([run_up(effects_seed, steady=True)])
    assert found.verdict.startswith("The motion never turns back.")
    assert "The speed only rises or only falls." in found.verdict
    assert "one sine" not in found.verdict
    assert {"coulomb_friction", "force_offset"} <= {*found.cannot_tell[0].effects}
    assert {"viscous_friction", "force_drift"} <= {*found.cannot_tell[1].effects}
    # the speed grows with the time: a damper is a force that drifts
    damper = next(each for each in found.findings if each.effect == "viscous_friction")
    assert damper.confidence < 0.9
    assert {"force_drift", "friction_drift"} <= {rival.effect for rival in damper.rivals}
    assert not found.unexplained.significant


def test_nothing_that_needs_a_turn_is_named(effects_seed: int) -> None:
    found = diagnose_bench([run_up(effects_seed, steady=False)])
    named = {each.effect for each in found.findings}
    assert named
    assert named <= {"coulomb_friction", "viscous_friction"}
    assert found.extended.rmse < 0.05 * found.baseline.rmse


def test_a_speed_that_ripples_tells_more() -> None:
    """Such a machine never turns back either; what gives is seen there."""
    run = run_up(1, steady=False)
    ripple = 0.02 * np.sin(30 * TIME)
    rippled = replace(run, displacement=run.displacement + ripple)
    for record, up in ((run, True), (rippled, False)):
        found = [thin(smooth(record, 12.0))]
        assert goes_one_way(found)
        assert runs_up(found) is up
        assert ("backlash" in hidden_by(found)) is up
        assert "hysteretic_friction" in hidden_by(found)
        assert "coulomb_friction" not in hidden_by(found)


def test_strokes_there_and_back_are_not_one_way(effects_seed: int) -> None:
    one, other = run_up(effects_seed, steady=True), run_up(effects_seed, steady=True)
    back = Record(
        name="back", time=TIME, displacement=-other.displacement, force=-other.force,
        motion="rotation",
    )  # fmt: skip
    runs = [thin(motion) for motion in prepare([one, back]).motions]
    assert not goes_one_way(runs)


def test_what_varies_about_zero_is_as_large_as_it_varies() -> None:
    values = np.array([-1.0, 3.0])
    assert size_of(values) == size_of(values, from_zero=True) == 2.0
    assert size_of(values + 9.0, from_zero=True) == 10.0
    assert size_of(np.empty(0)) == 1.0
