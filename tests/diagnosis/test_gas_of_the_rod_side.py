"""A gas that is compressed as the device lengthens is named as one, beside what else there is."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.diagnose import diagnose_bench
from inerter.records import Record

INERTANCE, VISCOUS, PUSH, REACH, EXPONENT = 80.0, 60.0, 150.0, 0.06, 1.3


def strut(name: str, swing: float, frequency: float) -> Record:
    """Force [N] of an inerter with a damper and a gas on the rod's side, mirrored by hand."""
    time = np.arange(0, 10, 1 / 400)
    turn = 2 * np.pi * frequency
    x, v, a = np.zeros((3, time.size))
    for share, ratio, phase in ((1.0, 1.0, 0.2), (0.4, 0.37, 1.0), (0.15, 2.6, 2.0)):
        rate = ratio * turn
        x += swing * share * np.sin(rate * time + phase)
        v += swing * share * rate * np.cos(rate * time + phase)
        a -= swing * share * rate**2 * np.sin(rate * time + phase)
    gas = -PUSH * (1.0 - (1.0 - x / REACH) ** -EXPONENT)
    random = np.random.default_rng(len(name))
    return Record(
        name=name, time=time, displacement=x + random.normal(0, 2e-6, time.size),
        force=INERTANCE * a + VISCOUS * v + gas + random.normal(0, 1.0, time.size),
    )  # fmt: skip


def test_it_is_named_and_measured() -> None:
    diagnosis = diagnose_bench([strut("a", 0.025, 1.2), strut("bb", 0.03, 1.9)])
    found = {finding.effect: finding for finding in diagnosis.findings}
    assert set(found) == {"gas_spring", "viscous_friction"}
    gas = found["gas_spring"].parameters
    area = diagnosis.extended.device["gas_area"]
    assert float(area) < 0
    assert gas["gas_pressure"].value * abs(float(area)) == pytest.approx(PUSH, rel=0.1)
    assert gas["gas_volume"].value / abs(float(area)) == pytest.approx(REACH, rel=0.1)
    assert diagnosis.extended.rmse < 1.05
