"""A leak past the inertance, and a clutch that slips before it, told from what does nearly that."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from inerter.catalogue.scales import Scales
from inerter.diagnose import Diagnosis, diagnose_bench
from inerter.diagnose.candidates import candidates
from inerter.diagnose.composition import effects_of, without_effect
from inerter.diagnose.stated import stated_candidates
from inerter.identify.fit import Problem
from inerter.identify.model import Model
from inerter.identify.runs import BenchRun, whole
from inerter.identify.transient import swings_freely
from inerter.records import Record
from inerter.records.preparation import prepare
from inerter.reference import ReferenceDevice, response
from inerter.reference.motion import Motion
from scipy.interpolate import CubicSpline

TONES = ((0.9, 0.02, 0.3), (1.9, 0.008, 1.1), (3.7, 0.003, 2.0))


def moving(shift: float) -> Motion:
    """Three tones."""

    def of(order: int) -> Any:
        def at(t: Any) -> Any:
            return sum(
                size * (2 * np.pi * f) ** order
                * np.sin(2 * np.pi * f * t + phase + shift * f + 0.5 * np.pi * order)
                for f, size, phase in TONES
            )  # fmt: skip

        return at

    return Motion(of(0), of(1), of(2))


def recorded(noise: float = 0.5, seconds: float = 8.0, **device: Any) -> list[Record]:
    """Two runs of a device at 250 Hz, by the reference."""
    random, found = np.random.default_rng(3), []
    for i, shift in enumerate((0.0, 1.7)):
        motion, t = moving(shift), np.arange(round(250 * seconds)) / 250.0
        force = response(ReferenceDevice(**device), motion, t, rtol=1e-8).force
        found.append(
            Record(
                name=f"run{i}", time=t,
                displacement=np.asarray(motion.displacement(t)) + random.normal(0, 1e-6, t.size),
                force=force + random.normal(0, noise, t.size),
            )
        )  # fmt: skip
    return found


def named(found: Diagnosis) -> set[str]:
    return {each.effect for each in found.findings if each.confidence >= 0.9}


LAMINAR: dict[str, Any] = {
    "inertance": 120.0, "leak_damping": 2500.0, "friction": "coulomb", "coulomb_force": 20.0,
    "transition_velocity": 1e-4,
}  # fmt: skip


def test_a_leak_beside_friction_is_found() -> None:
    found = diagnose_bench(recorded(**LAMINAR))
    assert named(found) == {"leak", "coulomb_friction"}, found.verdict
    known = found.parameters
    for name in ("inertance", "leak_damping", "coulomb_force"):
        true = LAMINAR[name]
        assert known[name].value == pytest.approx(true, rel=0.01)
        assert abs(known[name].value - true) < 4.0 * (known[name].stderr or 0.0) + 2e-3 * true
    assert found.engines["mujoco"] == pytest.approx(found.extended.rmse, rel=0.02)
    assert found.engines["reference"] == pytest.approx(found.extended.rmse, rel=0.02)


def test_an_inertance_alone_does_not_tell_a_leak_from_a_low_pass() -> None:
    """F = b a / (1 + s b / c) is both."""
    found = diagnose_bench(recorded(inertance=120.0, leak_damping=2500.0))
    (leak,) = found.findings
    assert set(leak.members) == {"leak", "sensor_filter"}
    corner = 2500.0 / 240.0 / np.pi
    assert leak.parameters["force_filter"].value == pytest.approx(corner, rel=0.02)
    assert leak.parameters["leak_damping"].value == pytest.approx(2500.0, rel=0.01)
    assert f"a low-pass of the force, such as one of order 1 at {corner:.3g} Hz" in found.verdict
    assert "another record would (state the filter" in found.verdict


def test_nor_behind_a_channel_that_is_late() -> None:
    """What is late beside a low-pass of the first order is so beside a leak."""
    records = [
        replace(each, force=CubicSpline(each.time, each.force)(each.time - 6e-3))
        for each in recorded(inertance=120.0, leak_damping=5000.0)
    ]
    found = diagnose_bench(records)
    (first,) = (each for each in found.findings if "leak" in (each.effect, *each.members))
    assert {"leak", "sensor_filter"} <= {first.effect, *first.members}, found.verdict
    assert first.parameters["leak_damping"].value == pytest.approx(5000.0, rel=0.02)
    assert found.parameters["delay"].value == pytest.approx(6e-3, rel=0.05)


@pytest.mark.long
def test_a_leak_that_is_laminar_and_turbulent_is_found() -> None:
    device = {"inertance": 120.0, "leak_damping": 500.0, "leak_quadratic_damping": 3e4,
              "viscous": 200.0}  # fmt: skip
    found = diagnose_bench(recorded(**device))
    assert named(found) == {"leak", "viscous_friction"}, found.verdict
    for name, true in device.items():
        assert found.parameters[name].value == pytest.approx(true, rel=0.03)


@pytest.mark.long
def test_a_clutch_that_slips_is_found() -> None:
    device = {"inertance": 60.0, "series_stiffness": 6e5, "series_damping": 500.0,
              "clutch_force": 90.0, "viscous": 120.0}  # fmt: skip
    found = diagnose_bench(recorded(**device))
    assert {"clutch_slip", "viscous_friction"} <= named(found), found.verdict
    assert found.parameters["clutch_force"].value == pytest.approx(90.0, rel=0.02)
    assert found.parameters["inertance"].value == pytest.approx(60.0, rel=0.02)


PLAIN = Model("none", {"inertance": 100.0, "transition_velocity": 1e-3}, ("inertance",))


def runs() -> list[BenchRun]:
    return [whole(motion) for motion in prepare(recorded(seconds=3.0, **LAMINAR)).motions]


def sizes() -> Scales:
    found = runs()
    return Problem(found, [run.inner for run in found]).scales


def test_a_leak_is_tried_as_laminar_as_turbulent_and_as_both() -> None:
    scales = sizes()
    plain = PLAIN
    forms = {c.law for c in candidates(plain, scales) if c.effect == "leak"}
    assert forms == {"leak_corner", "leak_quadratic_damping"}
    leaking = plain.adding(None, leak_corner=3.0)
    assert leaking.device().leak_damping == pytest.approx(2 * np.pi * 3.0 * 100.0)
    tried = list(candidates(leaking, scales))
    assert {c.law for c in tried if c.effect == "leak"} == {"leak_quadratic_damping"}
    # a clutch and a play have a shaft; what leaks already has none of them
    assert not {"clutch_slip", "backlash"} & {c.effect for c in tried}
    both = leaking.adding(None, leak_quadratic_damping=1e3)
    assert effects_of(both, plain) == [("leak", None)]
    simpler = without_effect(both, "leak", plain)
    assert [each.shape for each in simpler[1:]] == [leaking.shape, plain.shape]
    # along one sine it is an inertance of another size and a damper
    one = replace(scales, one_tone=True)
    assert "leak" not in {c.effect for c in candidates(plain, one)}


def test_a_clutch_has_its_shaft_in_it() -> None:
    plain = PLAIN
    (tried,) = (c for c in candidates(plain, sizes()) if c.effect == "clutch_slip")
    model = tried.starts[0]
    assert effects_of(model, plain) == [("clutch_slip", None)]
    shaft, without = without_effect(model, "clutch_slip", plain)
    assert effects_of(shaft, plain) == [("series_elasticity", None)]
    assert without.shape == plain.shape


def test_how_a_flywheel_turned_at_first_is_read_off_where_it_goes_on_by_itself() -> None:
    plain = PLAIN
    assert swings_freely(plain.adding(None, leak_corner=3.0).device())
    shaft = plain.adding(None, series_frequency=20.0, series_loss=0.1)
    assert swings_freely(shaft.device())
    assert not swings_freely(shaft.adding(None, clutch_force=10.0).device())
    assert not swings_freely(plain.adding(None, leak_quadratic_damping=10.0).device())
    assert not swings_freely(plain.device())
    both = shaft.adding(None, leak_corner=3.0)
    assert swings_freely(both.device())


# a leak alone, behind a spring, and with a damper beside that
@pytest.mark.parametrize("shaft", [{}, {"series_stiffness": 3e5},
                                   {"series_stiffness": 3e5, "series_damping": 800.0}])  # fmt: skip
def test_what_a_flywheel_did_before_the_record_leaves_nothing(shaft: dict[str, float]) -> None:
    device = {"inertance": 120.0, "leak_damping": 2500.0, **shaft}
    (record, _) = recorded(noise=0.05, seconds=6.0, **device)
    late = record.time > 1.0
    cut = replace(
        record, time=record.time[late], displacement=record.displacement[late],
        force=record.force[late],
    )  # fmt: skip
    (run,) = (whole(motion) for motion in prepare([cut]).motions)
    values = {"inertance": 120.0, "leak_corner": 2500.0 / 240.0 / np.pi}
    if shaft:
        damping = shaft.get("series_damping", 0.0)
        values["series_frequency"] = np.sqrt(3e5 / 120.0) / 2.0 / np.pi
        values["series_loss"] = damping / 2.0 / np.sqrt(3e5 * 120.0)
    (left,) = Problem([run], [run.inner]).residual(Model("none", values, ()))
    # of some hundred newtons
    assert np.sqrt(np.mean(left[run.inner] ** 2)) < 0.3
    assert np.std(run.force) > 100.0


def test_what_a_user_states_of_a_leak_and_of_a_clutch_may_be_contradicted() -> None:
    scales = sizes()
    stated = Model("none", {**PLAIN.values, "leak_damping": 2000.0}, PLAIN.free)
    (leak,) = (c for c in stated_candidates(stated, scales) if c.effect == "leak")
    (freed,) = leak.starts
    assert "leak_damping" not in freed.values
    assert freed.device().leak_damping == pytest.approx(2000.0)
    assert effects_of(freed, stated) == [("leak", None)]
    shaft = {"series_stiffness": 1e5, "series_damping": 100.0, "clutch_force": 50.0}
    stated = Model("none", {**PLAIN.values, **shaft}, PLAIN.free)
    found = {c.effect: c.starts[0] for c in stated_candidates(stated, scales)}
    assert effects_of(found["clutch_slip"], stated) == [("clutch_slip", None)]
    assert found["clutch_slip"].values["series_stiffness"] == 1e5


def sliding() -> list[Record]:
    """Friction alone, which differs with the direction: nothing turns."""
    return recorded(
        friction="coulomb", coulomb_force=60.0, friction_asymmetry=0.3, transition_velocity=1e-4,
        viscous=300.0,
    )  # fmt: skip


def test_what_has_no_inertance_is_diagnosed_to_its_end() -> None:
    """A leak before a flywheel of next to nothing is no device: such a start is none."""
    found = diagnose_bench(sliding())
    assert {"leak", "clutch_slip", "backlash"}.isdisjoint(named(found))
    assert found.parameters["coulomb_force"].value == pytest.approx(60.0, rel=0.02)


@pytest.mark.parametrize("inertance", [0.0, 8.7e-15])
def test_before_no_inertance_one_of_a_usual_size_is_begun_with(inertance: float) -> None:
    prepared = prepare(sliding())
    runs = [whole(motion) for motion in prepared.motions]
    problem = Problem(runs, [np.ones(run.force.size, bool) for run in runs])
    values = {"inertance": inertance, "viscous": 100.0, "transition_velocity": 1e-4}
    tried = ("leak", "clutch_slip", "backlash")
    for model, starts_there in (
        (Model("none", values, ("inertance", "viscous")), True),
        (Model("none", values, ("viscous",)), False),
    ):
        own = [c for c in candidates(model, problem.scales) if c.effect in tried]
        assert {c.effect for c in own} == (set(tried) if starts_there else set())
        for start in (start for each in own for start in each.starts):
            assert start.is_possible
            assert np.isfinite(problem.masked(problem.residual(start))).all()
        assert {c.effect for c in candidates(model, problem.scales)} - set(tried)


@pytest.mark.long
def test_oil_and_a_leak_are_no_low_pass_with_a_delay() -> None:
    """Within what the motion tells a low-pass that needs a delay beside it stands for both."""
    found = diagnose_bench(
        recorded(
            noise=0.3, inertance=120.0, series_stiffness=4e5, leak_damping=4000.0, viscous=300.0
        )
    )
    assert {"sensor_delay", "sensor_filter"}.isdisjoint(named(found))
    assert {"leak", "series_elasticity", "viscous_friction"} <= named(found)
    for name, true in (
        ("leak_damping", 4000.0), ("series_stiffness", 4e5), ("viscous", 300.0),
        ("inertance", 120.0),
    ):  # fmt: skip
        assert found.parameters[name].value == pytest.approx(true, rel=0.02)
