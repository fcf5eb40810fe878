"""The tape: values are those of plain numbers, slopes those of differences; what is made of it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

pytest.importorskip("exudyn.itemInterface")

from element_systems import bodies, exu, settings, solve
from inerter.exudyn import CreateInerter
from inerter.exudyn.functions import NUMBERS, Functions
from inerter.exudyn.tape import Tape

INPUTS = 5


def mixed(f: Functions, x: Any) -> list[Any]:
    """Expressions with every operation, signs in all places, and what is used twice."""
    a = -2.0 * (x[0] * -x[1]) + x[2] / 3.0 - (-x[3])
    b = f.sqrt(f.abs(a) + 1.0) * -1.0 + f.exp(-x[1]) * f.sin(x[2]) * (x[1] * x[0])
    c = f.choose(a < b, f.greatest(a, x[4]), f.least(b, -x[4])) + f.tanh(f.cos(x[3]))
    d = f.power(f.abs(x[0]) + 0.5, 1.7) * f.log(f.abs(x[3]) + 2.0) + f.arctan2(a, b)
    e = f.sign(x[4]) * f.choose(x[0] >= x[1], -a, -b) + f.round(x[2]) * 0.25
    g = f.log1p(f.abs(x[1])) * f.expm1(0.5 * x[4])
    less = -a
    return [a, b, c, d, e, g, -less, (-a) * (-b) - b * less]


def recorded(sloped: bool) -> tuple[Any, list[int]]:
    tape = Tape(INPUTS)
    keys = [tape.key(each) for each in mixed(tape.functions, tape.inputs)]
    finished = tape.finish(keys if sloped else None)
    return finished, [finished.place(key) for key in keys]


@pytest.mark.parametrize("sloped", [False, True])
def test_values_and_slopes(sloped: bool) -> None:
    """Values bit for bit: an order of steps and a sign moved change no rounding."""
    finished, places = recorded(sloped)
    rng = np.random.default_rng(7)
    step = 1e-6
    for x in rng.normal(size=(40, INPUTS)).tolist():
        values = finished.run(x)[places].copy()
        np.testing.assert_array_equal(values, mixed(NUMBERS, x))
        slopes = finished.run_slopes()[places]
        for k in range(INPUTS):
            ahead, behind = list(x), list(x)
            ahead[k] += step
            behind[k] -= step
            found = np.subtract(mixed(NUMBERS, ahead), mixed(NUMBERS, behind)) / (2.0 * step)
            # of smooth terms of size 10, differences of second order and rounding
            np.testing.assert_allclose(slopes[:, k], found, rtol=1e-6, atol=1e-7)


def test_a_slope_that_nobody_wants_is_not_worked_out() -> None:
    tape = Tape(2)
    wanted, other = (tape.key(tape.inputs[0] * each) for each in (3.0, 5.0))
    finished = tape.finish(sloped=[wanted])
    finished.run([1.0, 1.0])
    slopes = finished.run_slopes()
    np.testing.assert_array_equal(slopes[finished.place(wanted)], [3.0, 0.0])
    np.testing.assert_array_equal(slopes[finished.place(other)], [0.0, 0.0])


@pytest.mark.parametrize("kind", ["Point", "RigidBodyRxyz"])
def test_mass_matrix_is_b_times_its_row(kind: str) -> None:
    """The mass matrix, each number of it made once, is b J'J; J by differences of the length."""
    system = bodies(kind)
    local = [[0.0, 0.0, 0.0]] * 2 if kind == "Point" else [[0.1, 0.2, 0.0], [0.0, -0.1, 0.3]]
    strut = CreateInerter(system.mbs, "strut", system.parts, *local, inertance=3.0)
    n = strut.element.size
    q = (0.1 * np.sin(np.arange(n) + 1.0)).tolist()
    found = np.array(
        strut.functions.parameters["massMatrixUserFunction"](system.mbs, 0.0, 0, q, [0.0] * n)
    )

    def length(k: int, step: float) -> float:
        moved = list(q)
        moved[k] += step
        return strut.element.kinematics.at(NUMBERS, moved, [0.0] * n).length

    row = np.array([(length(k, 1e-6) - length(k, -1e-6)) / 2e-6 for k in range(n)])
    np.testing.assert_array_equal(found, found.T)
    np.testing.assert_allclose(found, 3.0 * np.outer(row, row), rtol=1e-7, atol=1e-8)


def test_many_devices_ask_of_every_object_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Before an explicit run; once for each device made the start of a hundred take seconds."""
    system = bodies("Point")
    for number in range(12):
        CreateInerter(system.mbs, f"d{number}", system.parts, inertance=1.0, show=False)
    asked: list[int] = []
    original = exu.MainSystem.GetObject

    def get(mbs: Any, number: Any, *others: Any) -> Any:
        asked.append(int(number))
        return original(mbs, number, *others)

    system.mbs.Assemble()
    monkeypatch.setattr(exu.MainSystem, "GetObject", get)
    solve(system.mbs, settings(0.002, 1e-3))
    assert len(asked) >= 12
    assert len(asked) <= 2 * system.mbs.systemData.NumberOfObjects()
