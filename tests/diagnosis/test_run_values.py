"""Runs of which each has a value of its own, told apart by what is left of them."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.diagnose.run_values import run_values
from inerter.identify.model import Model
from inerter.identify.runs import BenchRun
from sines import moved

TIME = np.arange(0, 10, 1 / 200)
NOISE = 0.5
MODEL = Model(
    "coulomb",
    {"inertance": 60.0, "viscous": 90.0, "coulomb_force": 20.0, "transition_velocity": 1e-3},
    ("inertance",),
)


def run_of(name: str, x: np.ndarray, v: np.ndarray, a: np.ndarray) -> BenchRun:
    return BenchRun(
        name=name, start=0.0, spacing=1 / 200, displacement=x, velocity=v, acceleration=a,
        force=np.zeros_like(x), inner=np.ones(x.size, dtype=bool), first_force=0.0, cutoff=40.0,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("which", "values"),
    [
        ("run_levels", (27.0, 20.0, 18.0)),
        ("run_dampings", (150.0, 90.0, 70.0)),
        ("run_inertances", (60.0, 66.0, 58.0)),
        ("nothing", (20.0, 20.0, 20.0)),
    ],
)
def test_what_differs_between_runs_is_told(
    which: str, values: tuple[float, ...], effects_seed: int
) -> None:
    draw = np.random.default_rng([effects_seed, 17])
    runs, errors = [], []
    for i, value in enumerate(values):
        x, v, a = moved(draw, TIME, (0.6, 1.3, 2.7), draw.uniform(3e-3, 8e-3, 3))
        runs.append(run_of(f"run {i}", x, v, a))
        more = {
            "run_levels": (value - 20.0) * np.sign(v),
            "run_dampings": (value - 90.0) * v,
            "run_inertances": (value - 60.0) * a,
            "nothing": np.zeros_like(v),
        }[which]
        errors.append(more + NOISE * draw.standard_normal(TIME.size))
    found = run_values(runs, errors, NOISE, MODEL)
    told = {name: each for name, each in found.method.items() if each}
    if which == "nothing":
        assert not told
        assert found.in_words() == ""
        return
    assert told.keys() == {which}
    for i, value in enumerate(values):
        own, error = told[which][f"run {i}"]
        assert own == pytest.approx(value, abs=max(5 * error, 0.03 * value))
    words = {"run_levels": "a friction level", "run_dampings": "viscous damping"}
    assert (
        f"By itself each run has {words.get(which, 'an inertance')} of its own" in found.in_words()
    )


def test_one_run_differs_from_nothing(effects_seed: int) -> None:
    draw = np.random.default_rng([effects_seed, 18])
    x, v, a = moved(draw, TIME, (0.6, 1.3), (5e-3, 5e-3))
    run = run_of("alone", x, v, a)
    assert run_values([run], [9.0 * np.sign(v)], NOISE, MODEL).in_words() == ""


def test_along_one_speed_a_level_is_no_damping(effects_seed: int) -> None:
    """Of triangles: friction with memory that was more in the first run, as it turns slowly."""
    draw = np.random.default_rng([effects_seed, 19])
    v = 0.02 * np.tanh(np.sin(2 * np.pi * 0.5 * TIME) / 0.3)
    x, a = np.cumsum(v) / 200, np.gradient(v, 1 / 200)
    runs = [run_of(f"run {i}", x, v, a) for i in range(3)]
    errors = [
        (4.0 if i == 0 else 0.0) * v / 0.02 + NOISE * draw.standard_normal(TIME.size)
        for i in range(3)
    ]
    found = run_values(runs, errors, NOISE, MODEL)
    assert found.dampings == {}
    assert found.levels["run 0"][0] == pytest.approx(24.0, abs=1.0)
    # where nothing rubs it is a damping
    damped = Model("none", {"inertance": 60.0, "viscous": 90.0}, ("inertance",))
    assert run_values(runs, errors, NOISE, damped).dampings["run 0"][0] == pytest.approx(290, abs=9)
