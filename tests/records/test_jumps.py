"""A displacement that jumps, as a laser's does that loses its target."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.records import Record
from inerter.records.jumps import find_displacement_jumps, jump_rows

RATE = 1000
TIME = np.arange(0, 6, 1 / RATE)
MOTION = 0.02 * np.sin(2 * np.pi * 0.8 * TIME) + 0.004 * np.sin(2 * np.pi * 3.1 * TIME)


def noisy(values: np.ndarray, size: float = 2e-6) -> np.ndarray:
    return values + size * np.random.default_rng(4).standard_normal(values.size)


def test_a_zero_that_is_set_anew_and_a_held_value_are_told() -> None:
    x = MOTION.copy()
    x[2000:] += 4e-4
    x[4000:4040] = x[4000]
    rows = jump_rows(noisy(x))
    assert 1999 in rows
    assert any(4035 < row < 4043 for row in rows)
    record = Record(name="laser", time=TIME, displacement=noisy(x), force=np.cos(TIME))
    (warning,) = find_displacement_jumps(record).warnings
    assert warning.code == "outliers"
    assert "jumps at" in warning.text
    assert "loses its target" in warning.text


@pytest.mark.parametrize("name", ["plain", "coarse", "corners", "spike", "quick", "rests"])
def test_nothing_is_told_of_what_devices_and_converters_do(name: str) -> None:
    x = {
        "plain": MOTION,
        "coarse": np.round(MOTION / 2e-5) * 2e-5,
        # strokes of even speed that turn in a corner
        "corners": 0.02 * np.abs((TIME * 1.3) % 2 - 1),
        "spike": MOTION + 0.003 * (np.arange(TIME.size) == 3000),
        # a tenth of the rate
        "quick": 0.002 * np.sin(2 * np.pi * 97.0 * TIME),
        "rests": np.clip(MOTION, -0.01, 0.01),
    }[name]
    assert jump_rows(x if name == "coarse" else noisy(x)).size == 0
    assert jump_rows(x[:40]).size == 0
