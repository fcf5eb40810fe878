"""Rests in which a servo creeps: friction has its level there, whose direction nothing tells."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from inerter.diagnose import diagnose_bench
from inerter.records import Record
from inerter.records.motion import smooth
from inerter.records.rests import long_stretches
from scipy.integrate import solve_ivp

LEVEL, INERTANCE, NOISE = 25.0, 60.0, 0.5


def commanded(t: float) -> float:
    """A trapezoid [m]: to one side, a rest, to the other, a rest."""
    return 0.02 * float(np.clip(2.2 * (2.0 * abs((0.7 * t) % 1.0 - 0.5) - 0.5) * 2.0, -1.0, 1.0))


@pytest.fixture(scope="module")
def settling() -> Record:
    """A servo of 12 Hz that overshoots, with Coulomb friction that is sharp at 1 um/s."""
    rate, loss = 2.0 * np.pi * 12.0, 0.7
    t = np.arange(3000) / 500.0

    def moves(s: float, z: np.ndarray) -> list[float]:
        return [z[1], rate**2 * (commanded(s) - z[0]) - 2.0 * loss * rate * z[1]]

    x, v = solve_ivp(moves, (0, t[-1]), [0.02, 0.0], "RK45", t, rtol=1e-9, atol=1e-12,
                     max_step=1e-3).y  # fmt: skip
    a = np.array([moves(s, z)[1] for s, z in zip(t, np.column_stack([x, v]), strict=True)])
    random = np.random.default_rng(12)
    return Record(
        name="settling",
        time=t,
        displacement=x + random.normal(0.0, 1e-6, t.size),
        force=INERTANCE * a + LEVEL * np.tanh(v / 1e-6) + random.normal(0.0, NOISE, t.size),
    )


def test_stretches_are_long_or_none() -> None:
    mask = np.array([1, 1, 0, 1, 1, 1, 1, 1, 0, 1], bool)
    found = long_stretches(mask, 0.1, 1.0 / 0.35)
    assert found.tolist() == [False, False, False, *[True] * 5, False, False]
    wider = long_stretches(mask, 0.1, 1.0 / 0.35, 0.5)
    assert wider.tolist() == [False, True, True, *[True] * 5, True, True]


def test_rests_below_a_speed_do_not_count(settling: Record) -> None:
    counted = smooth(settling, 40.0).inner
    without = smooth(replace(settling, slowest=5e-4), 40.0)
    left = counted & ~without.inner
    assert 0.2 < np.mean(left) < 0.5
    # and what the smoother makes of them beside
    slow = np.abs(without.velocity) < 5e-4
    alone = long_stretches(slow, 0.002, 40.0) & counted
    assert np.all(left[alone])
    assert np.sum(left) > np.sum(alone)


def test_friction_is_found_where_the_rests_are_a_riddle(settling: Record) -> None:
    found = diagnose_bench([settling])
    assert [each.effect for each in found.findings] == ["coulomb_friction"]
    assert found.parameters["coulomb_force"].value == pytest.approx(LEVEL, rel=0.02)
    assert found.parameters["inertance"].value == pytest.approx(INERTANCE, rel=0.01)
    assert found.extended.nrmse < 0.05
    assert any("its direction is not told from noise" in note for note in found.notes)
    assert "settling" in found.verdict
