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
