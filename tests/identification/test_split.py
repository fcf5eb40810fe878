"""Which run is held out when nobody says so."""

from __future__ import annotations

import numpy as np
from inerter.identify.bench import Run
from inerter.identify.split import split


def run(name: str, low: float, high: float, rate: float = 3.0) -> Run:
    """A sine between two displacements [m]."""
    time = np.arange(0, 5, 0.01)
    middle, size = (low + high) / 2, (high - low) / 2
    x = middle + size * np.sin(rate * time)
    v, a = size * rate * np.cos(rate * time), -size * rate**2 * np.sin(rate * time)
    return Run(name, 0.0, 0.01, x, v, a, 2 * a, np.ones(time.size, bool), 0.0, np.inf)


def held(*runs: Run) -> str:
    return split(runs).description


def test_the_most_typical_run_is_held_out() -> None:
    sizes = {"small": 0.01, "middle": 0.02, "large": 0.04}
    assert held(*(run(name, -size, size) for name, size in sizes.items())) == "held out: middle"


def test_who_names_a_run_is_obeyed() -> None:
    runs = [run("a", -0.02, 0.02), run("b", -0.04, 0.04)]
    assert split(runs, ["b"]).description == "held out: b"
