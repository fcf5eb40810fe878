"""Damping that goes with a power of the speed: an eddy-current brake, a silicone damper."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from inerter.diagnose import diagnose_bench
from inerter.records import Record
from sines import moved

TIME = np.arange(0, 10, 1 / 250)


def record(
    draw: np.random.Generator, name: str, size: float, law: Callable[[np.ndarray], np.ndarray]
) -> Record:
    """20 kg beside a damper that follows a law of the speed [m/s]."""
    x, v, a = moved(draw, TIME, (0.4, 1.1, 1.7, 2.6), size)
    return Record(
        name=name, time=TIME, displacement=x + 1e-6 * draw.standard_normal(TIME.size),
        force=20 * a + law(v) + 0.5 * draw.standard_normal(TIME.size),
    )  # fmt: skip


@pytest.mark.long
@pytest.mark.parametrize("power", [-1.0, 0.4])
def test_the_power_is_measured(power: float, effects_seed: int) -> None:
    draw = np.random.default_rng([effects_seed, 5])
    knee = float(draw.uniform(0.06, 0.12))

    def law(v: np.ndarray) -> np.ndarray:
        if power < 0:
            return 900 * v / (1 + (v / knee) ** 2)
        return 120 * np.sign(v) * abs(v) ** power

    runs = [record(draw, f"run {i}", 7e-3 + 2e-3 * i, law) for i in range(3)]
    found = diagnose_bench(runs)
    assert [each.effect for each in found.findings] == ["digressive_damping"]
    assert not found.unexplained.significant
    values = {name: each.value for name, each in found.parameters.items()}
    assert values["inertance"] == pytest.approx(20.0, rel=0.01)
    assert values["damping_exponent"] == pytest.approx(power, abs=0.02)
    if power < 0:
        assert values["viscous"] == pytest.approx(900, rel=0.02)
        assert values["damping_knee"] == pytest.approx(knee, rel=0.02)
    else:
        beyond = values["viscous"] * values["damping_knee"] ** (1 - values["damping_exponent"])
        assert beyond == pytest.approx(120, rel=0.02)
