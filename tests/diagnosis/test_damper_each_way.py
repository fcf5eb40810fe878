"""A damper whose valves open at another speed in each direction, with corners."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.diagnose import diagnose_bench
from inerter.records import Record
from sines import moved

TIME = np.arange(0, 10, 1 / 250)


def corner(v: np.ndarray, slope: float, knee: float, beyond: float) -> np.ndarray:
    """Straight up to the knee, straight beyond."""
    return slope * np.minimum(v, knee) + beyond * np.maximum(v - knee, 0.0)


def record(draw: np.random.Generator, name: str, size: float) -> Record:
    """30 kg; 2400 N s/m up to 0.12 m/s and then 600, the other way 1100 up to 0.08 and then 380."""
    x, v, a = moved(draw, TIME, (0.6, 1.1, 1.7, 2.6), size)
    damper = np.where(v > 0, corner(v, 2400, 0.12, 600), -corner(-v, 1100, 0.08, 380))
    return Record(
        name=name, time=TIME, displacement=x + 1e-6 * draw.standard_normal(TIME.size),
        force=30 * a + damper + 1.0 * draw.standard_normal(TIME.size),
    )  # fmt: skip


@pytest.mark.long
def test_both_valves_are_measured(effects_seed: int) -> None:
    draw = np.random.default_rng(effects_seed)
    found = diagnose_bench([record(draw, f"run {i}", 7e-3 + 1e-3 * i) for i in range(3)])
    assert {each.effect for each in found.findings} == {"digressive_damping", "asymmetric_damping"}
    assert not found.unexplained.significant
    values = {name: each.value for name, each in found.parameters.items()}
    assert values["inertance"] == pytest.approx(30.0, rel=0.01)
    assert values["damping_knee"] == pytest.approx(0.12, rel=0.03)
    assert values["damping_knee_back"] == pytest.approx(0.08, rel=0.05)
    assert values["damping_beyond"] == pytest.approx(0.25, abs=0.02)
    assert values["damping_beyond_back"] == pytest.approx(380 / 1100, abs=0.03)
    forth, back = (values["viscous"] * (1 + s * values["damping_asymmetry"]) for s in (1, -1))
    assert (forth, back) == pytest.approx((2400, 1100), rel=0.02)


def strut(draw: np.random.Generator, seconds: float = 12.0) -> Record:
    """Two valves with rounded corners, a gas of 150 N with 0.12 m below it, 20 N dry, 1.5 kg."""
    time = np.arange(0, seconds, 1 / 500)
    frequency = np.sort(draw.uniform(0.4, 6.0, 18))[:, None]
    size = draw.uniform(0.6, 1.4, frequency.shape) / frequency
    size *= 0.018 / np.sqrt((size**2).sum() / 2)
    speed = 2 * np.pi * frequency
    angle = speed * time + draw.uniform(0, 2 * np.pi, frequency.shape)
    x, v = (size * np.sin(angle)).sum(0), (size * speed * np.cos(angle)).sum(0)
    a = -(size * speed**2 * np.sin(angle)).sum(0)

    def valve(v: np.ndarray, slope: float, knee: float, beyond: float) -> np.ndarray:
        round_off = np.hypot(v - knee, 0.1 * knee) - np.hypot(knee, 0.1 * knee)
        return beyond * v + 0.5 * (slope - beyond) * (v - round_off)

    damper = np.where(v > 0, valve(v, 3000, 0.12, 700), -valve(-v, 1700, 0.15, 450))
    gas = -150 * (1 + x / 0.12) ** -1.3
    return Record(
        name="strut", time=time, displacement=x + 1e-5 * draw.standard_normal(time.size),
        force=1.5 * a + damper + gas + 20 * np.tanh(v / 2e-5) + 3 * draw.standard_normal(time.size),
    )  # fmt: skip


@pytest.mark.long
def test_both_valves_are_measured_beside_a_gas_and_dry_friction(effects_seed: int) -> None:
    """Dry friction has its place once the valves bend, where something else was before."""
    found = diagnose_bench([strut(np.random.default_rng(effects_seed))])
    assert {each.effect for each in found.findings} >= {
        "digressive_damping", "asymmetric_damping", "coulomb_friction", "force_offset",
    }  # fmt: skip
    assert found.extended.rmse < 1.2 * 3.0
    values = {name: each.value for name, each in found.parameters.items()}
    assert values["coulomb_force"] == pytest.approx(20.0, abs=1.5)
    assert values["damping_knee"] == pytest.approx(0.12, rel=0.03)
    assert values["damping_knee_back"] == pytest.approx(0.15, rel=0.03)
    forth, back = (values["viscous"] * (1 + s * values["damping_asymmetry"]) for s in (1, -1))
    assert (forth, back) == pytest.approx((3000, 1700), rel=0.03)
