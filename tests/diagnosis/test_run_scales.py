"""One run of which the force has another scale: no cause in the device, and told as what it is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from inerter.diagnose import diagnose_bench
from inerter.records import Record

TIME = np.arange(0, 8, 1 / 250)


def record(draw: np.random.Generator, name: str) -> Record:
    """40 kg, 25 N of Coulomb friction and 120 N s/m along three sines."""
    x, v, a = np.zeros((3, TIME.size))
    for frequency in (0.5, 1.3, 2.4):
        w, phase = 2 * np.pi * frequency, draw.uniform(0, 6)
        size = draw.uniform(4e-3, 8e-3)
        x += size * np.sin(w * TIME + phase)
        v += size * w * np.cos(w * TIME + phase)
        a -= size * w**2 * np.sin(w * TIME + phase)
    force = 40 * a + 25 * np.tanh(v / 1e-3) + 120 * v
    return Record(
        name=name, time=TIME, displacement=x + 1e-6 * draw.standard_normal(TIME.size),
        force=force + 0.4 * draw.standard_normal(TIME.size),
    )  # fmt: skip


@pytest.mark.parametrize("scale", [1.0, 1.04])
def test_a_run_with_another_scale_is_told(scale: float, effects_seed: int) -> None:
    draw = np.random.default_rng([effects_seed, 7])
    runs = [record(draw, f"run {i}") for i in range(4)]
    runs[1] = replace(runs[1], force=scale * runs[1].force)
    found = diagnose_bench(runs)
    told = found.method["run_scales"]
    if scale == 1.0:
        assert not told
        assert "times what the other runs tell" not in found.verdict
        return
    ((name, (value, error)),) = told.items()
    assert name == "run 1"
    # what the fit makes of all runs together lies between them
    assert value == pytest.approx(scale, abs=max(3 * error, 0.004))
    assert "run 1 is 1.0" in found.verdict
    assert {each.effect for each in found.findings} >= {"coulomb_friction", "viscous_friction"}
