"""Bench tables: amplitudes at a list of frequencies."""

from __future__ import annotations

import numpy as np
import pytest
from inerter import Device
from inerter.diagnose import diagnose, diagnose_table
from inerter.diagnose.table import amplitude
from inerter.models import data_path
from inerter.records import BenchTable

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
