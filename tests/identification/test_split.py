"""Which run is held out when nobody says so."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from inerter.identify.runs import BenchRun
from inerter.identify.split import split


def run(name: str, low: float, high: float, rate: float = 3.0, seconds: float = 5.0) -> BenchRun:
    """A sine between two displacements [m]."""
    time = np.arange(0, seconds, 0.01)
    middle, size = (low + high) / 2, (high - low) / 2
    x = middle + size * np.sin(rate * time)
    v, a = size * rate * np.cos(rate * time), -size * rate**2 * np.sin(rate * time)
    return BenchRun(
        name=name,
        start=0.0,
        spacing=0.01,
        displacement=x,
        velocity=v,
        acceleration=a,
        force=2 * a,
        inner=np.ones(time.size, bool),
        first_force=0.0,
        cutoff=np.inf,
    )


def held(*runs: BenchRun) -> str:
    return split(runs).description


def test_the_most_typical_run_is_held_out() -> None:
    sizes = {"small": 0.01, "middle": 0.02, "large": 0.04}
    assert held(*(run(name, -size, size) for name, size in sizes.items())) == "held out: middle"


def test_who_names_a_run_is_obeyed() -> None:
    runs = [run("a", -0.02, 0.02), run("b", -0.04, 0.04)]
    assert split(runs, ["b"]).description == "held out: b"


@pytest.mark.parametrize(
    ("lengths", "held"),
    [([300.0, 3.0, 20.0], 2), ([300.0, 6.1], 1), ([300.0, 3.0, 3.0], 1)],
)
def test_a_run_of_nearly_all_data_is_not_held_out(lengths: list[float], held: int) -> None:
    runs = [run(str(i), -0.02, 0.02, seconds=seconds) for i, seconds in enumerate(lengths)]
    found = split(runs)
    assert [found.role(i) for i in range(len(runs))].index("holdout") == held


@pytest.mark.parametrize(("count", "whole"), [(3, False), (4, False), (5, True), (7, True)])
def test_few_runs_are_left_out_in_blocks_and_many_as_they_are(count: int, whole: bool) -> None:
    """What one of three or four runs tells alone is not taken away whole."""
    runs = [run(str(i), -0.02, 0.02 + 0.001 * i) for i in range(count + 1)]
    found = split(runs, [str(count)])
    assert len(found.folds) == (5 if whole else 4)
    left = np.array([[mask.sum() for mask in fold] for fold in found.folds])
    all_of_it = np.array([mask.sum() for mask in found.fit])
    assert left.sum(axis=0).tolist() == all_of_it.tolist()
    assert not left[:, count].any()
    shares = left[:, :count] / all_of_it[:count]
    if whole:
        assert set(np.unique(shares)) == {0.0, 1.0}
    else:
        assert shares == pytest.approx(0.25, abs=0.01)


def test_of_two_runs_of_one_frequency_each_blocks_of_both_are_held_out() -> None:
    """With one of them held out a shaft and a stiffness would be an inertance of another size."""
    slow, quick = run("slow", -0.02, 0.02, seconds=30.0), run("quick", -0.01, 0.01, 4.0, 30.0)
    found = split([slow, quick])
    assert found.in_blocks
    assert found.description == "held out: blocks 4, 7, 9 of 10 of every run"
    assert [found.role(i) for i in (0, 1)] == ["fit", "fit"]
    assert all(0.25 < mask.mean() < 0.35 for mask in found.holdout)
    # of one and the same frequency, of three, and where the user or a command says so, a whole run
    again, third = run("again", -0.01, 0.01, seconds=30.0), run("third", -0.015, 0.015, 5.0, 30.0)
    for runs, holdout, in_blocks in (
        ([slow, again], (), None),
        ([slow, quick, third], (), None),
        ([slow, quick], ("quick",), None),
        ([slow, quick], (), False),
    ):
        assert not split(runs, holdout, in_blocks).in_blocks


def triangle(name: str, speed: float, stroke: float = 0.04) -> BenchRun:
    """To and fro at one speed [m/s], the corners rounded over 20 ms."""
    time = np.arange(0, 8.0, 0.01)
    phase = speed * time / stroke
    way = np.convolve(np.where(phase % 2.0 < 1.0, 1.0, -1.0), np.full(2, 0.5), "same")
    v = speed * way
    x = np.cumsum(v) * 0.01
    return replace(
        run(name, -0.02, 0.02, seconds=8.0), displacement=x, velocity=v,
        acceleration=np.gradient(v, 0.01),
    )  # fmt: skip


def test_of_two_runs_of_one_speed_each_blocks_of_both_are_held_out() -> None:
    """With one of them held out a damper would be a friction, and how it bends not told."""
    slow, quick = triangle("slow", 0.12), triangle("quick", 0.25)
    assert split([slow, quick]).in_blocks
    # of one and the same speed, of three, where one changes it, and where somebody says so, a run
    assert not split([slow, triangle("again", 0.125)]).in_blocks
    assert not split([slow, quick, triangle("third", 0.18)]).in_blocks
    assert not split([slow, quick], ["quick"]).in_blocks
    assert not split([slow, quick], in_blocks=False).in_blocks
