"""Friction and damping on the flywheel's side of a shaft, as of a device in a frame that gives."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from bench_runs import measured
from inerter.diagnose import diagnose_bench
from inerter.diagnose.candidates import candidates
from inerter.diagnose.result import Finding
from inerter.diagnose.where_losses_act import (
    damped_on_the_other_side,
    may_damp_behind,
    rubbing_on_the_other_side,
    with_side,
)
from inerter.identify.fit import Problem
from inerter.identify.model import Model
from inerter.identify.prediction import force_along
from inerter.identify.runs import BenchRun, thin
from inerter.records.preparation import prepare
from inerter.reference import ReferenceDevice, sum_of_sines
from inerter.report.page import render_report

TIME = np.arange(0, 8, 1 / 250)
SHAFT = {"inertance": 90.0, "series_stiffness": 4e5, "series_damping": 400.0}
# at rest in the beginning, and hardly accelerated: the flywheel stands where it is
QUARTER = np.pi / 2
MOTIONS = [
    sum_of_sines([0.008, 0.002, 4.59e-4], [0.9, 2.3, 6.1], [QUARTER, QUARTER, -QUARTER]),
    sum_of_sines([0.009, 0.003, 5.43e-4], [0.7, 1.9, 5.3], [-QUARTER, -QUARTER, QUARTER]),
]
FRICTION = {"friction": "coulomb", "coulomb_force": 40.0, "transition_velocity": 1e-3}


def bare(**values: float) -> Model:
    known = {"inertance": 90.0, "transition_velocity": 1e-3, **values}
    return Model("none", known, ("inertance", *values))


def test_its_force_is_that_of_the_flywheel_that_it_holds() -> None:
    """Behind a low-pass too: the force of the friction alone is not what it does."""
    device = ReferenceDevice(**SHAFT, **FRICTION, friction_side="flywheel")
    records = measured(device, MOTIONS, TIME, force_noise=0.3)
    runs = [thin(motion) for motion in prepare(records).motions]
    known = {"series_stiffness": 4e5, "series_damping": 400.0, "coulomb_force": 40.0}
    terminals = Model("coulomb", {"inertance": 90.0, "transition_velocity": 1e-3, **known}, ())
    (behind,) = rubbing_on_the_other_side(terminals, bare())
    assert behind.rubs_behind
    assert not terminals.rubs_behind
    problem = Problem(runs, [np.ones(run.force.size, dtype=bool) for run in runs])
    near, far = (problem.fit(model).rmse(problem.masks) for model in (behind, terminals))
    assert np.isfinite(force_along(behind, runs[0])).all()
    assert near < 1.0 < 5.0 < far


def test_it_goes_to_the_other_side_and_back() -> None:
    shaft = bare(series_frequency=10.0, series_loss=0.03)
    assert rubbing_on_the_other_side(shaft, bare()) == []
    assert rubbing_on_the_other_side(bare().adding("coulomb", coulomb_force=9.0), bare()) == []
    terminals = shaft.adding("coulomb", coulomb_force=9.0)
    (behind,) = rubbing_on_the_other_side(terminals, bare())
    (back,) = rubbing_on_the_other_side(behind, bare())
    assert not back.rubs_behind
    # a drift is known of the force of the friction, not of what that does to the flywheel
    assert rubbing_on_the_other_side(terminals.adding(friction_drift=0.01), bare()) == []
    # where the user says it stays
    stated = Model("none", dict(bare().values), (), {"friction_side": "terminals"})
    assert rubbing_on_the_other_side(terminals, stated) == []
    # without friction there is no side
    assert "friction_side" not in behind.without(("coulomb_force",), "none").stated()


def test_friction_is_asked_for_behind_a_shaft_that_has_none() -> None:
    """At the terminals it may take nothing, and then nobody would ask for its side."""
    shaft = bare(series_frequency=10.0, series_loss=0.03)
    sizes = Problem(*two_runs()).scales

    def behind(model: Model) -> list[Model]:
        found = [each for each in candidates(model, sizes) if each.law == "behind"]
        assert all(each.effect == "coulomb_friction" for each in found)
        return [start for each in found for start in each.starts]

    assert behind(shaft)
    assert all(start.rubs_behind for start in behind(shaft))
    assert behind(bare()) == behind(shaft.adding("coulomb", coulomb_force=9.0)) == []
    assert behind(replace(shaft, texts={"friction_side": "terminals"})) == []


def two_runs() -> tuple[list[BenchRun], list[np.ndarray]]:
    """Runs of a plain inerter, all of which count."""
    records = measured(ReferenceDevice(inertance=90.0), MOTIONS, TIME, force_noise=0.3)
    runs = [thin(motion) for motion in prepare(records).motions]
    return runs, [np.ones(run.force.size, dtype=bool) for run in runs]


def test_the_findings_say_where() -> None:
    behind = bare(series_frequency=10.0, series_loss=0.03).adding("coulomb", coulomb_force=9.0)
    (behind,) = rubbing_on_the_other_side(behind, bare())
    found = Finding(
        effect="coulomb_friction", law=None, confidence=1.0, parameters={}, rmse_before=2.0,
        rmse_after=1.0, evidence="It takes half.", rivals=[],
    )  # fmt: skip
    told = with_side(found, behind)
    assert told.evidence == "It takes half. It acts behind the elasticity, on the flywheel."
    assert told.remark == "It acts behind the elasticity, on the flywheel."
    assert told.side == told.json()["side"] == "flywheel"
    assert with_side(found, bare()) == replace(found, side="terminals")
    offset = replace(found, effect="force_offset")
    assert with_side(offset, behind) == offset
    assert "side" not in offset.json()


@pytest.mark.parametrize(
    ("free", "side"),
    [
        ({"viscous": 9.0}, "terminals"),
        ({"flywheel_viscous": 9.0}, "flywheel"),
        ({"viscous": 9.0, "flywheel_viscous": 9.0}, "both"),
    ],
)
def test_a_damper_says_where(free: dict[str, float], side: str) -> None:
    found = Finding(
        effect="viscous_friction", law=None, confidence=1.0, parameters={}, rmse_before=2.0,
        rmse_after=1.0, evidence="It takes half.", rivals=[],
    )  # fmt: skip
    model = bare(series_frequency=10.0, series_loss=0.03, **free)
    told = with_side(found, model)
    assert told.side == side
    assert bool(told.remark) == (side != "terminals")
    shaft = with_side(replace(found, effect="series_elasticity"), model)
    assert bool(shaft.remark) == (side != "terminals")
    assert not shaft.side


def test_damping_goes_to_the_other_side_and_back() -> None:
    shaft = bare(series_frequency=10.0, series_loss=0.03)
    assert damped_on_the_other_side(shaft, bare()) == []
    assert damped_on_the_other_side(bare(viscous=50.0), bare()) == []
    terminals = shaft.adding(viscous=50.0)
    (behind,) = damped_on_the_other_side(terminals, bare())
    assert behind.free == ("inertance", "series_frequency", "series_loss", "flywheel_viscous")
    assert behind.device().flywheel_viscous == 50.0
    assert behind.device().viscous == 0.0
    assert not may_damp_behind(behind)
    (back,) = damped_on_the_other_side(behind, bare())
    assert back == terminals
    # a bend, and a late channel, may have stood in for it
    assert damped_on_the_other_side(terminals.adding(damping_asymmetry=0.1), bare()) == [behind]
    late = terminals.adding(delay=1e-3)
    assert behind in damped_on_the_other_side(late, bare())
    assert damped_on_the_other_side(terminals.holding(damping_asymmetry=0.1), bare()) == []
    # what the user states stays
    assert damped_on_the_other_side(terminals, bare(viscous=40.0)) == []
    assert damped_on_the_other_side(behind.holding(viscous=40.0), bare(viscous=40.0)) == []
    # without a shaft it is damping as any other, beside what there is
    rigid = behind.adding(viscous=20.0).without(("series_frequency", "series_loss"))
    assert rigid.free == ("inertance", "viscous")
    assert rigid.values["viscous"] == 70.0
    bearing = behind.adding(viscous=20.0).without(("series_frequency", "series_loss", "viscous"))
    assert bearing.values["viscous"] == 50.0


@pytest.mark.parametrize("side", ["flywheel", pytest.param("both", marks=pytest.mark.long)])
def test_damping_behind_a_shaft_is_found(side: str, effects_seed: int) -> None:
    """And not told as a low-pass of the force and a damped shaft."""
    shaft = {"inertance": 40.0, "series_stiffness": 2e5, "series_damping": 60.0}
    between = {"viscous": 120.0} if side == "both" else {}
    known: dict[str, Any] = {**shaft, **between, "flywheel_viscous": 400.0}
    resonant = [
        sum_of_sines([0.004, 5e-4, 1.5e-4], [1.1, 5.3, 11.7], [QUARTER, QUARTER, -QUARTER]),
        sum_of_sines([0.003, 8e-4, 1.2e-4], [1.7, 6.1, 13.1], [-QUARTER, -QUARTER, QUARTER]),
    ]
    records = measured(ReferenceDevice(**known), resonant, TIME, effects_seed, force_noise=0.5)
    found = diagnose_bench(records)
    assert {each.effect for each in found.findings} == {"series_elasticity", "viscous_friction"}
    damping = next(each for each in found.findings if each.effect == "viscous_friction")
    assert damping.parameters.keys() == {"flywheel_viscous", *between}
    assert "behind the elasticity, on the flywheel" in damping.evidence
    for name, true in known.items():
        told = found.parameters[name]
        assert told.value == pytest.approx(true, abs=max(4 * told.stderr, 0.02 * true))
    assert found.extended.device["flywheel_viscous"] == damping.parameters["flywheel_viscous"].value


@pytest.mark.long
def test_a_device_in_a_frame_that_gives_is_found(effects_seed: int) -> None:
    device = ReferenceDevice(**SHAFT, **FRICTION, friction_side="flywheel")
    found = diagnose_bench(measured(device, MOTIONS, TIME, effects_seed, force_noise=0.5))
    assert {each.effect for each in found.findings} == {"series_elasticity", "coulomb_friction"}
    assert found.extended.device["friction_side"] == "flywheel"
    for name, true in (*SHAFT.items(), ("coulomb_force", 40.0)):
        told = found.parameters[name]
        assert told.value == pytest.approx(true, abs=max(4 * told.stderr, 0.02 * true))
    shaft = next(each for each in found.findings if each.effect == "series_elasticity")
    assert "a frame that gives" in shaft.evidence
    assert "a frame that gives" in render_report(found, "", "")
    told_by = [error for error in found.engines.values() if error is not None]
    assert told_by == pytest.approx([found.extended.rmse] * len(told_by), rel=0.05)
