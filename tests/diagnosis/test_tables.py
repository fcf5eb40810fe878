"""Bench tables: amplitudes at a list of frequencies."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from inerter import Device
from inerter.diagnose import diagnose, diagnose_table
from inerter.diagnose.table import amplitude
from inerter.models import data_path
from inerter.records import BenchTable
from inerter.records.quality import check_records
from inerter.report.page import headline

FREQUENCY = np.linspace(0.5, 12, 16)


def table(noise: float, **added: float | str) -> BenchTable:
    """Amplitudes by harmonic balance in closed form, b = 40 kg, 2 mm strokes."""
    omega = 2 * np.pi * FREQUENCY
    x = 2e-3
    in_phase = (added.get("stiffness", 0.0) - 40.0 * omega**2) * x  # type: ignore[operator]
    quadrature = added.get("viscous", 0.0) * omega * x  # type: ignore[operator]
    quadrature = quadrature + 4 / np.pi * added.get("coulomb", 0.0)  # type: ignore[operator]
    random = np.random.default_rng(3)
    force = np.hypot(in_phase, quadrature) * (1 + noise * random.normal(size=omega.size))
    return BenchTable(
        name="table",
        frequency=FREQUENCY,
        force_amplitude=force,
        acceleration_amplitude=omega**2 * x,
    )


def test_amplitude_of_coulomb_friction_is_four_over_pi() -> None:
    device = Device(friction="coulomb", coulomb_force=5.0, transition_velocity=1e-9)
    assert amplitude(device, 2.0, 3.0) == pytest.approx(4 / np.pi * 5, rel=1e-4)


@pytest.mark.parametrize(
    ("added", "effect", "name", "value"),
    [
        ({"coulomb": 3.0}, "coulomb_friction", "coulomb_force", 3.0),
        ({"stiffness": 9e3}, "parallel_stiffness", "stiffness", 9e3),
        ({"viscous": 900.0}, "viscous_friction", "viscous", 900.0),
    ],
)
def test_hidden_term_is_found(added, effect: str, name: str, value: float) -> None:
    diagnosis = diagnose_table([table(0.01, **added)])
    assert [finding.effect for finding in diagnosis.findings] == [effect]
    assert diagnosis.parameters[name].value == pytest.approx(value, rel=0.1)
    assert diagnosis.engines["mujoco"] == pytest.approx(diagnosis.extended.rmse, rel=0.02)


def test_clean_table_brings_no_finding() -> None:
    diagnosis = diagnose_table([table(0.02)])
    assert diagnosis.findings == []
    assert diagnosis.parameters["inertance"].value == pytest.approx(40, rel=0.02)


def test_measured_table_of_the_ball_screw_paper() -> None:
    """F / a is level from 3 Hz on: 40 kg, as the paper's own table and the line 40.04 a + 0.32."""
    diagnosis = diagnose([data_path("ball_screw_table.csv")])
    assert diagnosis.parameters["inertance"].value == pytest.approx(40.04, rel=0.03)


def _swept(frequency: np.ndarray, seed: int, noise: float = 0.005) -> BenchTable:
    """An ideal inerter of 113 kg at 10 m/s^2 throughout."""
    random = np.random.default_rng(seed)
    return BenchTable(
        name="sweep",
        frequency=frequency,
        force_amplitude=1130.0 * (1 + noise * random.normal(size=frequency.size)),
        acceleration_amplitude=np.full(frequency.size, 10.0),
    )


def test_a_sweep_at_one_acceleration_is_judged_by_its_force() -> None:
    """All amplitudes are alike: their spread is noise, and no measure of what is missed."""
    diagnosis = diagnose_table([_swept(np.linspace(1, 12, 12), 1)])
    assert diagnosis.findings == []
    assert diagnosis.baseline.nrmse < 0.01
    assert diagnosis.verdict.startswith("The simulation is right")
    assert headline(diagnosis).startswith("No lack")


@pytest.mark.parametrize("seed", range(6))
def test_three_rows_name_nothing(seed: int) -> None:
    diagnosis = diagnose_table([_swept(np.array([2.0, 5.0, 9.0]), seed)])
    assert diagnosis.findings == []
    assert "no effect can be tried" in diagnosis.unexplained.summary


@pytest.mark.parametrize("frequency", [5.0, 10.0])
def test_amplitude_of_a_lightly_damped_shaft_is_its_steady_one(frequency: float) -> None:
    """Against the impedance; the resonance at 12 Hz takes many periods to die out."""
    b, damping = 100.0, 5.0
    stiffness = b * (2 * np.pi * 12.0) ** 2
    device = Device(inertance=b, series_stiffness=stiffness, series_damping=damping)
    s = 2j * np.pi * frequency
    shaft = stiffness + damping * s
    expected = abs(b * shaft / (b * s**2 + shaft)) * 10.0
    assert amplitude(device, frequency, 10.0) == pytest.approx(expected, rel=0.02)


def test_a_stated_breakaway_does_not_stand_in_the_way() -> None:
    """The sliding level found is above the breakaway level stated."""
    stated = Device(
        inertance=40.0, friction="stribeck", coulomb_force=10.0, static_force=14.0,
        stribeck_velocity=0.005,
    )  # fmt: skip
    diagnosis = diagnose_table([table(0.01, coulomb=30.0)], stated)
    assert diagnosis.extended.rmse < diagnosis.baseline.rmse


def test_a_copy_of_a_table_is_left_out() -> None:
    one = table(0.01, viscous=900.0)
    copied = check_records([one, replace(one, name="copy")])
    assert [w.code for w in copied[1].warnings] == ["duplicate_record"]
    both, alone = diagnose_table(copied), diagnose_table([one])
    assert both.extended == alone.extended
    assert [record.role for record in both.records] == ["fit", "unused"]


@pytest.mark.parametrize(
    ("effect", "stated"),
    [
        ("parallel_stiffness", {"stiffness": 3000.0}),
        ("coulomb_friction", {"friction": "coulomb", "coulomb_force": 5.0}),
    ],
)
def test_what_is_stated_and_not_there(effect: str, stated: dict[str, float | str]) -> None:
    random, frequency = np.random.default_rng(0), np.linspace(1, 12, 14)
    a = 3e-3 * (2 * np.pi * frequency) ** 2
    force = 50.0 * a * (1 + 0.003 * random.standard_normal(a.size))
    points = BenchTable(
        name="table", frequency=frequency, force_amplitude=force, acceleration_amplitude=a
    )
    diagnosis = diagnose_table([points], Device(inertance=50.0, **stated))
    assert [finding.effect for finding in diagnosis.findings] == [effect]
    assert "The data contradict what is stated" in diagnosis.verdict


def dahl_table(level: float, bristle: float, noise: float, seed: int = 5) -> BenchTable:
    """50 kg and Dahl friction by the closed form of its loop, strokes of 0.5 to 6 mm.

    From the left end on f = level - (level + f0) exp(-bristle (x + X) / level), with f0 at both
    ends; back the same with the other sign.
    """
    random = np.random.default_rng(seed)
    frequency, stroke = np.linspace(0.6, 4, 12), np.tile([0.5e-3, 2e-3, 6e-3, 1e-3], 3)
    phase = 2 * np.pi * (np.arange(4000) + 0.5) / 4000
    omega, size = 2 * np.pi * frequency[:, None], stroke[:, None]
    x, way = size * np.sin(phase), np.sign(np.cos(phase))
    end = level * np.tanh(bristle * size / level)
    friction = way * (level - (level + end) * np.exp(-bristle * (way * x + size) / level))
    wave = np.exp(1j * phase)
    force = 2 * np.abs(np.mean((friction - 50.0 * omega**2 * x) * wave, axis=1))
    return BenchTable(
        name="table",
        frequency=frequency,
        force_amplitude=force * (1 + noise * random.standard_normal(force.size)),
        acceleration_amplitude=(2 * np.pi * frequency) ** 2 * stroke,
    )


def test_a_soft_bristle_swings_steadily_from_the_start() -> None:
    """By the closed form; from rest this one takes hundreds of periods."""
    points = dahl_table(12.0, 900.0, 0.0)
    device = Device(inertance=50.0, friction="dahl", coulomb_force=12.0, bristle_stiffness=900.0)
    found = [
        amplitude(device, f, a)
        for f, a in zip(points.frequency, points.acceleration_amplitude, strict=True)
    ]
    assert found == pytest.approx(points.force_amplitude, rel=1e-6)


def test_a_stated_law_is_contradicted_as_a_whole() -> None:
    """The level is right; the bristle, left to its default, is ten times as stiff as there."""
    points = dahl_table(12.0, 9e3, 0.003)
    default = Device(inertance=50.0, friction="dahl", coulomb_force=12.0)
    assert default.bristle_stiffness > 9e4
    diagnosis = diagnose_table([points], default)
    assert [(f.effect, f.law) for f in diagnosis.findings] == [("hysteretic_friction", "dahl")]
    assert diagnosis.findings[0].json()["side"] == "terminals"
    assert diagnosis.parameters["bristle_stiffness"].value == pytest.approx(9e3, rel=0.05)
    assert diagnosis.parameters["coulomb_force"].value == pytest.approx(12.0, rel=0.05)
