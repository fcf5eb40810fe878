"""What one run alone reaches is kept, though what is held out does not show it."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.diagnose import diagnose_bench
from inerter.records import Record

INERTANCE, STOP, STIFFNESS = 80.0, 0.016, 85e3


def moved(name: str, size: float, seed: int) -> Record:
    """80 kg, a stop at 16 mm, 1 N of noise; a motion that is twice `size` wide at most."""
    time = np.arange(0, 8, 1 / 300)
    random = np.random.default_rng(seed)
    turns = 2 * np.pi * random.uniform(0.5, 3.0, 8)
    phases, shares = random.uniform(0, 6, 8), random.uniform(0.5, 1.0, 8)
    waves = shares[:, None] * np.sin(turns[:, None] * time + phases[:, None])
    scale = size / np.abs(waves.sum(axis=0)).max()
    x = scale * waves.sum(axis=0)
    a = -scale * (turns[:, None] ** 2 * waves).sum(axis=0)
    force = INERTANCE * a + STIFFNESS * np.maximum(x - STOP, 0.0)
    return Record(
        name=name, time=time, displacement=x + random.normal(0, 3e-6, time.size),
        force=force + random.normal(0, 1.0, time.size),
    )  # fmt: skip


def test_a_stop_that_what_is_held_out_does_not_reach_is_kept() -> None:
    """Without it the inertance makes up for it, and that shows in what is held out."""
    runs = [moved("far", 0.024, 3), moved("near", 0.012, 4)]
    diagnosis = diagnose_bench(runs, holdout=["near"])
    (stop,) = diagnosis.findings
    assert stop.effect == "end_stop"
    assert stop.seen_in_blocks
    assert stop.parameters["stop_upper"].value == pytest.approx(STOP, rel=0.01)
    assert stop.parameters["stop_stiffness"].value == pytest.approx(STIFFNESS, rel=0.05)
    assert diagnosis.parameters["inertance"].value == pytest.approx(INERTANCE, rel=0.01)
