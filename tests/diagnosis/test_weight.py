"""The weight of what is out of balance about an axis: one period a turn, by its known length."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.diagnose import diagnose_bench
from inerter.motion_units import ROTATION
from inerter.records import Record

WEIGHT, INERTIA, FRICTION = 3.3, 0.12, 0.4


def arm(name: str, middle: float, swing: float, frequency: float) -> Record:
    """Torque [N m] that moves an arm of 3.3 N m about a horizontal axis, some of a turn."""
    time = np.arange(0, 12, 1 / 250)
    turn = 2 * np.pi * frequency
    wave = np.sin(turn * time) + 0.5 * np.sin(0.37 * turn * time + 1)
    rate = turn * (np.cos(turn * time) + 0.5 * 0.37 * np.cos(0.37 * turn * time + 1))
    bend = -(turn**2) * (np.sin(turn * time) + 0.5 * 0.37**2 * np.sin(0.37 * turn * time + 1))
    q, v, a = middle + swing * wave, swing * rate, swing * bend
    random = np.random.default_rng(len(name))
    torque = INERTIA * a + FRICTION * np.tanh(v / 1e-3) + WEIGHT * np.sin(q)
    return Record(
        name=name, time=time, motion=ROTATION,
        displacement=q + random.normal(0, 1e-5, time.size),
        force=torque + random.normal(0, 0.02, time.size),
    )  # fmt: skip


def test_an_arm_that_swings_is_out_of_balance() -> None:
    diagnosis = diagnose_bench([arm("a", 0.3, 0.5, 0.8), arm("bb", 0.6, 0.4, 1.3)])
    found = {finding.effect: finding for finding in diagnosis.findings}
    assert set(found) == {"position_force", "coulomb_friction"}
    weight = found["position_force"].parameters
    assert weight["force_amplitude_1"].value == pytest.approx(WEIGHT, rel=0.01)
    assert abs(weight["force_phase_1"].value) < 0.01
    assert "once a turn: a weight that is out of balance" in found["position_force"].evidence
    level = found["coulomb_friction"].parameters["coulomb_force"]
    assert level.value == pytest.approx(FRICTION, rel=0.02)
    device = diagnosis.extended.device
    periods = str(device["force_periods"]).split()
    assert float(periods[0]) == pytest.approx(2 * np.pi)


def test_along_one_slow_sine_too() -> None:
    """As a joint of a robot is swung: its weight is no damping that differs, and no friction."""
    time = np.arange(0, 40, 1 / 50)
    turn = 2 * np.pi * 0.1
    q, v, a = (size * wave(turn * time) for size, wave in (
        (1.2, np.sin), (1.2 * turn, np.cos), (-1.2 * turn**2, np.sin),
    ))  # fmt: skip
    random = np.random.default_rng(4)
    torque = 2.0 * a + 3.0 * v + 6.0 * np.tanh(v / 1e-3) + 40.0 * np.sin(q - 0.6)
    swung = Record(
        name="joint", time=time, motion=ROTATION,
        displacement=q + random.normal(0, 1e-5, time.size),
        force=torque + random.normal(0, 0.3, time.size),
    )  # fmt: skip
    diagnosis = diagnose_bench([swung])
    found = {finding.effect: finding for finding in diagnosis.findings}
    assert set(found) == {"position_force", "coulomb_friction", "viscous_friction"}
    weight = found["position_force"].parameters
    assert weight["force_amplitude_1"].value == pytest.approx(40.0, rel=0.03)
    assert diagnosis.extended.rmse < 0.4
