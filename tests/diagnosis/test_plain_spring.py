"""A spring whose zero lies anywhere is a spring and a constant force, and no curve of the place."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.diagnose import diagnose_bench
from inerter.records import Record

TIME = np.arange(0, 10, 1 / 250)


@pytest.mark.parametrize("case", range(2))
def test_a_displaced_spring_is_named(case: int, effects_seed: int) -> None:
    draw = np.random.default_rng((effects_seed, case))
    stiffness = draw.uniform(800, 3000)
    zero = draw.choice([-1, 1]) * draw.uniform(0.005, 0.02)
    records = []
    for name in ("one", "other"):
        x, a = np.zeros((2, TIME.size))
        for hertz, size in ((0.4, 0.02), (1.7, 0.006), (4.3, 0.0015)):
            omega, phase = 2 * np.pi * hertz * draw.uniform(0.9, 1.1), draw.uniform(0, 6)
            x += size * np.sin(omega * TIME + phase)
            a -= size * omega**2 * np.sin(omega * TIME + phase)
        force = 60 * a + stiffness * (x - zero) + draw.normal(0, 0.5, TIME.size)
        measured = x + draw.normal(0, 2e-6, TIME.size)
        records.append(Record(name=name, time=TIME, displacement=measured, force=force))
    found = {each.effect: each for each in diagnose_bench(records).findings}
    assert set(found) == {"parallel_stiffness", "force_offset"}
    told = found["parallel_stiffness"].parameters["stiffness"]
    assert told.value == pytest.approx(stiffness, rel=0.01)
    offset = found["force_offset"].parameters["force_offset"].value
    assert offset == pytest.approx(-stiffness * zero, abs=0.2)
