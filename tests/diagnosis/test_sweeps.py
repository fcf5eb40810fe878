"""A sweep, along which what goes with the time goes with the frequency."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.diagnose.cannot_tell import SWEEP, sweeps
from inerter.identify.runs import BenchRun, thin
from inerter.records import Record
from inerter.records.preparation import prepare

RATE, LENGTH = 200.0, 30.0
TIME = np.arange(int(RATE * LENGTH)) / RATE


def runs(*ends: tuple[float, float]) -> list[BenchRun]:
    """Of each a sweep from one frequency to another [Hz] of an inerter that rubs."""
    random = np.random.default_rng(3)
    records = []
    for i, (first, last) in enumerate(ends):
        angle = 2 * np.pi * (first * TIME + (last - first) * TIME**2 / (2 * LENGTH))
        speed = 2 * np.pi * (first + (last - first) * TIME / LENGTH)
        x = 0.02 * np.sin(angle)
        force = -30.0 * 0.02 * speed**2 * np.sin(angle) + 8.0 * np.sign(np.cos(angle))
        records.append(
            Record(
                name=f"run{i}", time=TIME, displacement=x + 1e-6 * random.normal(size=x.size),
                force=force + 0.3 * random.normal(size=x.size),
            )
        )  # fmt: skip
    return [thin(motion) for motion in prepare(records).motions]


@pytest.mark.parametrize(
    ("ends", "known"),
    [
        (((0.5, 3.0),), True),
        (((3.0, 0.5),), True),
        (((0.5, 3.0), (1.0, 3.0)), True),
        (((0.5, 3.0), (3.0, 0.5)), False),
        (((0.5, 3.0), (1.0, 1.0)), False),
        (((1.0, 1.0),), False),
        (((1.0, 1.2),), False),
    ],
)
def test_a_sweep_is_one_where_the_frequency_goes_one_way(
    ends: tuple[tuple[float, float], ...], known: bool
) -> None:
    assert sweeps(runs(*ends)) is known


def test_what_it_hides_are_drifts() -> None:
    assert set(SWEEP.effects) == {"friction_drift", "viscous_drift", "force_drift"}
    assert "frequency" in SWEEP.same_as
