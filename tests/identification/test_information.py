"""Which run is held out: not the one that alone tells something."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.identify.information import least_missed, leverage, shares
from inerter.identify.runs import BenchRun, thin
from inerter.identify.split import split
from inerter.records import Record
from inerter.records.preparation import prepare

TIME = np.arange(0, 10, 1 / 500)


def sine(name: str, frequency: float, amplitude: float) -> Record:
    """60 kg along one sine."""
    w = 2 * np.pi * frequency
    return moved(name, amplitude * np.sin(w * TIME), -amplitude * w * w * np.sin(w * TIME))


def sweep(name: str) -> Record:
    """60 kg along a sweep from 0.5 to 8 Hz, 4 mm."""
    phase = 2 * np.pi * (0.5 * TIME + 7.5 / 20 * TIME**2)
    rate, bend = 2 * np.pi * (0.5 + 0.75 * TIME), 2 * np.pi * 0.75
    a = 4e-3 * (bend * np.cos(phase) - rate**2 * np.sin(phase))
    return moved(name, 4e-3 * np.sin(phase), a)


def moved(name: str, x: np.ndarray, a: np.ndarray) -> Record:
    """A record with noise of its own."""
    random = np.random.default_rng(len(name))
    noisy = x + random.normal(0, 1e-6, x.size)
    force = 60 * a + random.normal(0, 0.5, x.size)
    return Record(name=name, time=TIME, displacement=noisy, force=force)


def runs(*records: Record) -> list[BenchRun]:
    """In the band."""
    return [thin(motion) for motion in prepare(records).motions]


def test_the_only_sweep_is_learnt_from() -> None:
    found = runs(sine("1 Hz", 1.0, 0.01), sine("4 Hz", 4.0, 0.004), sweep("sweep"))
    known = leverage(found)
    assert known[2] > 0.95
    assert known[1] < 0.8
    assert split(found).description == "held out: 4 Hz"


def test_of_two_sweeps_one_may_be_held_out() -> None:
    found = runs(sine("1 Hz", 1.0, 0.01), sweep("sweep"), sweep("sweep again"))
    assert split(found).role(0) == "fit"
    assert leverage(found)[1:] == pytest.approx([0.5, 0.5], abs=0.1)


def test_where_each_run_takes_something_away_the_usual_one_is_held_out() -> None:
    """Two runs of different kinds: the one whose amplitudes are nearest to the median."""
    found = runs(sine("1 Hz", 1.0, 0.01), sweep("sweep"))
    known = leverage(found)
    assert known.min() > 0.8
    usual = runs(sine("1 Hz", 1.0, 0.01), sweep("sweep"), sweep("sweep again"))
    assert least_missed(found, [0, 1], 0) == 0
    assert least_missed(found, [0, 1], 1) == 1
    # where another one takes less away, it is held out
    assert least_missed(usual, [0, 1, 2], 0) != 0


def test_a_user_may_hold_out_what_he_likes() -> None:
    found = runs(sine("1 Hz", 1.0, 0.01), sine("4 Hz", 4.0, 0.004), sweep("sweep"))
    assert split(found, ["sweep"]).description == "held out: sweep"


def test_shares_of_all_runs_in_the_same_motion_are_equal() -> None:
    """Three times the same: a third of everything that is told at all, and none of the rest."""
    found = runs(*(sweep(name) for name in ("a", "bb", "ccc")))
    parts = shares(found)
    assert parts.shape[0] == 3
    assert parts[:, -1] == pytest.approx([1 / 3] * 3, abs=0.02)
    assert (parts >= 0).all()
    assert (parts <= 1).all()
