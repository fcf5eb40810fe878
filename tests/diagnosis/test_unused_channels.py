"""A measured velocity that a diagnosis does not use is said."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from bench_runs import measured
from inerter.diagnose import diagnose_bench
from inerter.reference import ReferenceDevice, sum_of_sines


@pytest.mark.parametrize(("late", "used"), [(0.0, True), (0.02, False)])
def test_a_velocity_that_is_not_used_is_said(late: float, used: bool) -> None:
    time = np.arange(2000, dtype=np.float64) / 500.0
    motion = sum_of_sines([0.01, 4e-3, 2e-3], [0.7, 1.9, 3.3], [0.3, 1.0, 2.0])
    (record,) = measured(
        ReferenceDevice(inertance=40.0, viscous=90.0), [motion], time, displacement_noise=2e-5
    )
    speed = np.asarray(motion.velocity(time - late))
    speed = speed + np.random.default_rng(2).normal(0.0, 1e-5, time.size)
    result = diagnose_bench([replace(record, velocity=speed)])
    assert ("velocity" in result.method["channels"]) is used
    said = [note for note in result.notes if note.startswith("The measured velocity was not used")]
    assert len(said) == (not used)
