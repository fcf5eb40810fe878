"""Along one sine much looks alike: what is simple is named, what only stands in for it is not."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.blind_test.case import records_of
from inerter.core import Device
from inerter.diagnose import diagnose_bench
from inerter.diagnose.stages import searched
from inerter.diagnose.start import Given, prepared
from inerter.records import Record
from inerter.reference import NoiseLevels, hide_effect
from inerter.reference.bench_channel import Channel, low_passed
from scipy.signal import bessel, sosfilt

RATE, FINE = 500.0, 4


def one_sine(
    draw: np.random.Generator,
    low_pass: Channel | None = None,
    noise: float = 1e-6,
    **device: float | str,
) -> Record:
    """Some 8 s of a device along 30 mm at about 1 Hz, its force behind a low-pass or not."""
    omega, ahead = 2 * np.pi * draw.uniform(0.8, 1.5), round(2 * RATE * FINE)
    time = np.arange(-ahead, round(8 * RATE * FINE)) / (RATE * FINE)
    x, v = 0.03 * np.sin(omega * time), 0.03 * omega * np.cos(omega * time)
    force = Device(**device).along(1 / (RATE * FINE), x, v, -(omega**2) * x)["total"]
    if low_pass is not None:
        force = low_passed(low_pass, time, force)
    rows = slice(ahead, None, FINE)
    count = time[rows].size
    return Record(
        name="one sine",
        time=time[rows],
        displacement=x[rows] + noise * draw.standard_normal(count),
        force=force[rows] + 0.5 * draw.standard_normal(count),
    )


def test_a_low_pass_of_a_jump_is_no_friction_with_memory(effects_seed: int) -> None:
    draw = np.random.default_rng(effects_seed)
    low_pass = Channel(force_filter=5.0, force_filter_order=2.0)
    level = float(draw.uniform(20, 40))
    made = one_sine(draw, low_pass, inertance=54.0, friction="coulomb", coulomb_force=level)
    found = diagnose_bench([made], carry="nothing")
    assert {each.effect for each in found.findings} == {"coulomb_friction", "sensor_filter"}
    assert found.parameters["force_filter"].value == pytest.approx(5.0, rel=0.02)
    assert found.parameters["coulomb_force"].value == pytest.approx(level, rel=0.02)
    assert found.parameters["inertance"].value == pytest.approx(54.0, rel=0.01)


def test_a_jump_that_filters_of_both_channels_round_off_is_dry_friction() -> None:
    """Along a quick sine, by as much of the speed as a filter of 50 Hz takes time."""
    draw, rate, fine = np.random.default_rng(4), 200.0, 20
    time = np.arange(-round(rate * fine), round(10 * rate * fine)) / (rate * fine)
    omega = 2 * np.pi * 6.0
    x, v = 7e-3 * np.sin(omega * time), 7e-3 * omega * np.cos(omega * time)
    force = -59.0 * omega**2 * x + 107.0 * np.sign(v)
    behind = bessel(3, 50.0, fs=rate * fine, norm="mag", output="sos")
    rows = slice(round(rate * fine), None, fine)
    channels = [np.asarray(sosfilt(behind, each))[rows] for each in (x, force)]
    noise = draw.standard_normal((2, channels[0].size))
    made = Record(
        name="quick", time=time[rows], displacement=channels[0] + 2e-6 * noise[0],
        force=channels[1] + 0.8 * noise[1],
    )  # fmt: skip
    found = diagnose_bench([made], carry="nothing")
    assert [each.effect for each in found.findings] == ["coulomb_friction"]
    assert found.parameters["coulomb_force"].value == pytest.approx(107.0, rel=0.03)


DAHL = {"friction": "dahl", "coulomb_force": 30.0, "bristle_stiffness": 15e3}


@pytest.mark.parametrize(
    "viscous", [0.0, pytest.param(80.0, marks=pytest.mark.long)], ids=["alone", "with a damper"]
)
def test_friction_with_memory_has_no_spring_that_is_an_inertance(
    viscous: float, effects_seed: int
) -> None:
    draw = np.random.default_rng(effects_seed)
    made = one_sine(draw, inertance=54.0, viscous=viscous, **DAHL)
    found = diagnose_bench([made], carry="nothing")
    named = {(each.effect, each.law) for each in found.findings}
    dampers = {("viscous_friction", None)} if viscous else set()
    assert named == {("hysteretic_friction", "dahl"), *dampers}
    assert found.parameters["inertance"].value == pytest.approx(54.0, rel=0.01)
    stiffness = found.parameters["bristle_stiffness"]
    assert stiffness.value == pytest.approx(15e3, rel=0.02)


def test_a_tone_at_a_harmonic_does_not_repeat_along_the_stroke() -> None:
    """It was taken for an inertance and a force that do, each of which took a little of it."""
    hidden = hide_effect(
        1880215208, "periodic_disturbance", noise=NoiseLevels(0.0, 0.01, 1e-6), realistic=True
    )
    found = diagnose_bench(records_of(hidden), carry="nothing")
    assert {each.effect for each in found.findings} <= {"periodic_disturbance"}


def test_a_force_that_repeats_along_the_stroke_has_its_length(effects_seed: int) -> None:
    """No other force has so many harmonics of one sine and no more."""
    draw = np.random.default_rng(effects_seed)
    length, size = 0.06 / float(draw.uniform(3.5, 9)), float(draw.uniform(10, 25))
    periods = f"{length:.6g} {size:.6g} {draw.uniform(-3, 3):.6g}"
    made = one_sine(draw, inertance=54.0, force_periods=periods)
    found = diagnose_bench([made], carry="nothing")
    assert [(each.effect, each.law) for each in found.findings] == [("position_force", "period")]
    untold = {name for each in found.json()["cannot_tell"] for name in each["effects"]}
    assert {"parallel_stiffness", "series_elasticity", "viscoelasticity"} <= untold
    assert found.parameters["force_period_1"].value == pytest.approx(length, rel=0.01)
    assert found.parameters["inertance"].value == pytest.approx(54.0, rel=0.02)


@pytest.mark.parametrize(
    ("effect", "name", "device"),
    [
        ("quadratic_damping", "quadratic_damping", {"quadratic_damping": 400.0}),
        ("asymmetric_damping", "damping_asymmetry", {"viscous": 60.0, "damping_asymmetry": 0.5}),
    ],
)
def test_what_bends_shows_in_harmonics_near_the_cut_off(
    effect: str, name: str, device: dict[str, float], effects_seed: int
) -> None:
    """A coarse displacement asks for a cut-off that takes a part of what the law makes."""
    draw = np.random.default_rng(effects_seed)
    made = one_sine(draw, None, 2e-4, inertance=54.0, friction="none", **device)
    found = diagnose_bench([made], carry="nothing")
    assert [each.effect for each in found.findings] == [effect]
    value = found.parameters[name]
    assert abs(value.value - device[name]) < max(3 * value.stderr, 0.03 * device[name])


def test_a_law_is_told_by_the_harmonics_of_one_sine() -> None:
    """In the motion's band most laws are the same; what they differ in lies above it."""
    made = one_sine(
        np.random.default_rng(5), noise=1.5e-5, inertance=54.0, friction="stribeck",
        coulomb_force=80.0, static_force=120.0, stribeck_velocity=0.05,
    )  # fmt: skip
    found = diagnose_bench([made], carry="nothing")
    assert [each.effect for each in found.findings] == ["stribeck_friction"]
    assert found.findings[0].confidence > 0.9
    assert found.parameters["coulomb_force"].value == pytest.approx(80.0, rel=0.05)


@pytest.mark.parametrize("level", [40.0, None])
def test_the_force_is_compared_in_its_harmonics_where_there_are_any(level: float | None) -> None:
    law = {"friction": "coulomb", "coulomb_force": level} if level else {}
    made = one_sine(np.random.default_rng(3), None, 3e-5, inertance=54.0, viscous=100.0, **law)
    start = prepared(Given(records=[made]))
    assert start.data.band.scales.one_tone
    assert start.weighed.force_band == 0.0
    band = searched(start).band.force_band
    if level is None:
        assert band == 0.0
    else:
        assert band > 3 * start.data.band.scales.frequency
