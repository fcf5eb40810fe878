"""Effects that act in few places, which the run held out may not reach."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.core import Device
from inerter.diagnose import Diagnosis, diagnose_bench
from inerter.records import Record

RATE = 500.0
DEVICE = Device(inertance=80.0, viscous=60.0, stop_upper=0.016, stop_stiffness=4e5,
                stop_damping=0.2)  # fmt: skip


def record(name: str, amplitude: float, seed: int) -> Record:
    random = np.random.default_rng(seed)
    t = np.arange(0, 10, 1 / RATE)
    x, v, a = np.zeros((3, t.size))
    for rate in random.uniform(3, 15, 5):
        phase, size = random.uniform(0, 2 * np.pi), amplitude / 5
        x += size * np.cos(rate * t + phase)
        v -= size * rate * np.sin(rate * t + phase)
        a -= size * rate**2 * np.cos(rate * t + phase)
    force = DEVICE.evaluate(x, v, a, 0.0)["total"] + 0.3 * random.standard_normal(t.size)
    return Record(name=name, time=t, displacement=x + 1e-6 * random.standard_normal(t.size),
                  force=force)  # fmt: skip


@pytest.fixture(scope="module")
def diagnosis() -> Diagnosis:
    sizes = {"small": 0.010, "large": 0.026, "middle": 0.012}
    runs = [record(name, size, seed) for seed, (name, size) in enumerate(sizes.items())]
    return diagnose_bench(runs, Device(inertance=80.0, viscous=60.0), holdout=["middle"])


@pytest.mark.long
def test_a_stop_that_one_run_alone_reaches_is_found(diagnosis: Diagnosis) -> None:
    assert [finding.effect for finding in diagnosis.findings] == ["end_stop"], diagnosis.verdict
    stop = diagnosis.findings[0].parameters
    assert stop["stop_upper"].value == pytest.approx(0.016, abs=1e-4)
    assert stop["stop_stiffness"].value == pytest.approx(4e5, rel=0.1)


@pytest.mark.long
def test_its_gain_is_that_on_blocks_left_out(diagnosis: Diagnosis) -> None:
    """As the run held out says nothing of it, which the finding tells."""
    stop = diagnosis.findings[0]
    assert stop.seen_in_blocks
    assert stop.rmse_after < 0.3 * stop.rmse_before
    assert "what is held out does not reach it" in stop.evidence
    # on the run held out both models say the same
    assert diagnosis.extended.rmse == pytest.approx(diagnosis.baseline.rmse, rel=1e-3)
