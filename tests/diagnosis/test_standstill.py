"""Rests at the ends of a record that say nothing of friction are left out."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.diagnose import diagnose_bench
from inerter.diagnose.standstill import without_standstill
from inerter.records import Record

RATE = 500.0
MASS, SPRING, FRICTION, INERTANCE = 40.0, 12e3, 14.0, 60.0


def swing(seconds: float, at: float, wait: float = 0.0) -> Record:
    """A mass on a spring, let go with a device of 60 kg and 14 N of friction beside it.

    Between two turns it is a cosine about where friction takes the spring; it sticks where the
    spring no longer overcomes friction, which holds what the spring pulls from then on.
    """
    rate = np.sqrt(SPRING / (MASS + INERTANCE))
    time = np.arange(0, seconds, 1 / RATE)
    x, a, held = np.full(time.size, at), np.zeros(time.size), np.zeros(time.size)
    held[:] = -np.clip(SPRING * at, -FRICTION, FRICTION)
    half, start, begin = np.pi / rate, at, wait
    while SPRING * abs(start) > FRICTION:
        middle = np.sign(start) * FRICTION / SPRING
        inside = (time >= begin) & (time < begin + half)
        turn = (start - middle) * np.cos(rate * (time - begin))
        x[inside], a[inside] = middle + turn[inside], -(rate**2) * turn[inside]
        held[inside] = -np.sign(start) * FRICTION
        start, begin = 2 * middle - start, begin + half
        x[time >= begin] = start
        held[time >= begin] = -SPRING * start
        a[time >= begin] = 0.0
    random = np.random.default_rng([round(1e4 * at) + 1000, round(seconds)])
    force = INERTANCE * a + held + random.normal(0, 0.1, time.size)
    return Record(
        name=f"from {1e3 * at:g} mm", time=time, force=force,
        displacement=x + random.normal(0, 3e-7, time.size),
    )  # fmt: skip


@pytest.mark.parametrize("wait", [0.0, 3.0])
def test_what_rests_before_and_after_is_left_out(wait: float) -> None:
    record = swing(8.0, 0.012, wait)
    (cut,), told = without_standstill([record])
    assert cut.time[0] == pytest.approx(wait, abs=0.06)
    assert cut.time[-1] < wait + 1.5
    assert np.ptp(cut.displacement) == pytest.approx(np.ptp(record.displacement), rel=0.01)
    assert f"from 12 mm ({record.duration - cut.duration:.3g} s)" in told


def test_short_rests_and_rests_between_motions_stay() -> None:
    short = swing(2.0, 0.012)
    time = np.arange(0, 20, 1 / RATE)
    between = np.where((time < 2) | (time > 18), np.sin(2 * np.pi * time), 0.0)
    between = Record(name="b", time=time, displacement=between, force=between)
    still = Record(name="c", time=time, displacement=0 * time, force=np.sin(time))
    kept, told = without_standstill([short, between, still])
    assert [a is b for a, b in zip(kept, (short, between, still), strict=True)] == [True] * 3
    assert told == ""


def test_friction_is_found_in_swings_that_come_to_rest() -> None:
    """Seven of eight seconds are at rest, each run under another force that friction holds."""
    diagnosis = diagnose_bench([swing(8.0, at) for at in (0.012, -0.009, 0.0105)])
    levels = diagnosis.parameters["coulomb_force"]
    assert levels.value == pytest.approx(FRICTION, rel=0.02)
    assert diagnosis.extended.rmse < 0.15 * diagnosis.baseline.rmse
    assert "Most of the time nothing moves" in diagnosis.verdict


def test_of_one_free_swing_no_stiffness_takes_the_place_of_inertance() -> None:
    """Its motion follows from its force: b a + f is -(k/m) b x + f (1 - b/m) for any share of b."""
    diagnosis = diagnose_bench([swing(8.0, 0.02)])
    assert "parallel_stiffness" not in [finding.effect for finding in diagnosis.findings]
    assert diagnosis.parameters["coulomb_force"].value == pytest.approx(FRICTION, rel=0.02)
    assert diagnosis.parameters["inertance"].value == pytest.approx(INERTANCE, rel=0.02)


def test_small_cycles_of_a_protocol_are_no_rest() -> None:
    """Cycles that grow, as structures are loaded, a few samples each: the first ones move too."""
    cycles = np.repeat([0.08, 0.15, 0.3, 1.0], 4)
    wave = np.array([0.0, 0.7, 1.0, 0.6, 0.0, -0.7, -1.0, -0.6])
    x = 0.02 * np.concatenate([size * wave for size in cycles])
    grown = Record(name="grown", time=np.arange(float(x.size)), displacement=x, force=5e5 * x)
    (kept,), told = without_standstill([grown])
    assert kept.samples == grown.samples
    assert told == ""
