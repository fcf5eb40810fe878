"""Pitch, roll and a user's own indices, against hand-written equations and quadrature."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from inerter.suspension.commands import app
from inerter.suspension.indices import INDICES
from inerter.suspension.own_index import OwnIndexError
from inerter.suspension.quarter_car import QuarterCar, Road
from inerter.suspension.vehicle.cars import full_car
from inerter.suspension.vehicle.indices import vehicle_index
from inerter.suspension.vehicle.problem import VehicleProblem
from inerter.suspension.vehicle.strut import VehicleStrut
from typer.testing import CliRunner

STRUTS = (VehicleStrut(2e4, 1500.0, 5.0), VehicleStrut(17e3, 1300.0, 3.0))
SEAT = '[index]\nsignal = "J1"\nnumerator = [1.0, 0.02, 1e-4]\ndenominator = [1.0, 0.05, 2e-3]\n'
COST = "def cost(J1w, J3, travel):\n    return J1w + 1e-3 * J3 + 20.0 * travel\n"


def own(folder: Path) -> tuple[str, str]:
    """A filter and a function in files."""
    (folder / "seat.toml").write_text(SEAT)
    (folder / "mine.py").write_text(COST)
    return str(folder / "seat.toml"), f"{folder / 'mine.py'}:cost"


def run(words: str) -> object:
    answer = CliRunner().invoke(app, words.split(), catch_exceptions=False)
    assert answer.exit_code == 0, answer.output
    return json.loads(answer.stdout)


def test_a_full_car_turns_as_its_equations_say(tmp_path: Path) -> None:
    """Seven degrees of freedom by hand; two roads of that correlation, the rear later."""
    car, f = full_car(), np.geomspace(1e-3, 2e4, 150_001)
    s = 2j * np.pi * f
    x, y = np.array([1, 1, -1, -1]) * 1.0, np.array([1, -1, 1, -1]) * car.track / 2.0
    x[:2], x[2:] = car.front.distance, -car.rear.distance
    axles = (car.front, car.front, car.rear, car.rear)
    masses = [car.body_mass, car.roll_inertia, car.pitch_inertia, *(a.wheel_mass for a in axles)]
    total = s[:, None, None] ** 2 * np.diag(masses)
    drive = np.zeros((len(f), 7, 2), dtype=complex)
    late = np.exp(-s * (car.front.distance + car.rear.distance) / Road().velocity)
    for n, axle in enumerate(axles):
        row, strut = np.zeros(7), STRUTS[n // 2]
        row[[0, 1, 2, 3 + n]] = 1.0, y[n], -x[n], -1.0
        force = strut.stiffness + strut.damping * s + strut.inertance * s**2
        total = total + force[:, None, None] * np.outer(row, row)
        total[:, 3 + n, 3 + n] += axle.tyre_stiffness
        drive[:, 3 + n, n % 2] = axle.tyre_stiffness * (late if n > 1 else 1.0) / s
    turning = s[:, None, None] ** 2 * np.linalg.solve(total, drive)
    roads = np.array([[1.0, car.correlation], [car.correlation, 1.0]])

    def rms(signal: np.ndarray) -> float:
        power = np.einsum("ni,ij,nj->n", signal, roads, signal.conj()).real
        area = np.sum(0.5 * (power[1:] + power[:-1]) * np.diff(f))
        return float(Road().slope * np.sqrt(2.0 * area))

    for name, place in (("roll", 1), ("pitch", 2)):
        assert vehicle_index(name, car, "S2", STRUTS) == pytest.approx(
            rms(turning[:, place]), rel=1e-4
        )
    felt = (1.0 + 0.02 * s + 1e-4 * s**2) / (1.0 + 0.05 * s + 2e-3 * s**2)
    points = [
        turning[:, 0] + b * turning[:, 1] - a * turning[:, 2] for a, b in zip(x, y, strict=True)
    ]
    exact = np.sqrt(np.mean([rms(point * felt[:, None]) ** 2 for point in points]))
    seat, cost = own(tmp_path)
    assert vehicle_index(seat, car, "S2", STRUTS) == pytest.approx(exact, rel=1e-4)
    j = {name: vehicle_index(name, car, "S2", STRUTS) for name in ("J1w", "J3", "travel")}
    expected = j["J1w"] + 1e-3 * j["J3"] + 20.0 * j["travel"]
    assert vehicle_index(cost, car, "S2", STRUTS) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("which", ["pitch", "roll", 0, 1])
def test_gradients_are_those_of_differences(which: str | int, tmp_path: Path) -> None:
    index = which if isinstance(which, str) else own(tmp_path)[which]
    problem = VehicleProblem(
        car=full_car(), road=Road(), layout="S2", index=index, stiffnesses=(2e4, 17e3)
    )
    x = np.log([1500.0, 30.0, 1300.0, 20.0])
    value, slope = problem.logarithm(x)
    steps = 1e-5 * np.eye(4)
    numeric = [(problem.logarithm(x + d)[0] - problem.logarithm(x - d)[0]) / 2e-5 for d in steps]
    assert slope == pytest.approx(numeric, abs=1e-6)
    assert problem.quick(x[None])[0] == pytest.approx(np.exp(value), rel=1e-6)


def test_a_filter_that_is_wk_gives_j1w(tmp_path: Path) -> None:
    felt = INDICES["J1w"].filter
    assert felt is not None
    path = tmp_path / "wk.toml"
    path.write_text(
        f'[index]\nsignal = "J1"\nnumerator = {felt.numerator.tolist()}\n'
        f"denominator = {felt.denominator.tolist()}\n"
    )
    command = f"optimize --layout S2 --index J1w,{path} --stiffness 25e3 --json"
    first, second = run(command)  # type: ignore[misc]
    assert second["value"] == pytest.approx(first["value"], rel=1e-12)
    assert second["damping"] == pytest.approx(first["damping"], rel=1e-6)


def test_the_optimum_of_a_cost_is_no_worse_than_any_design(tmp_path: Path) -> None:
    _, cost = own(tmp_path)
    (row,) = run(f"optimize --layout S3 --index {cost} --stiffness 25e3 --json")  # type: ignore[misc]
    c, b = np.meshgrid(np.geomspace(200, 9e3, 60), np.geomspace(1, 5e3, 60))
    from inerter.suspension.layouts import LAYOUTS

    every = INDICES[cost].evaluate(QuarterCar(), Road(), LAYOUTS["S3"].stiffness(25e3, c, b))
    assert row["value"] <= every.min()
    assert row["value"] == pytest.approx(every.min(), rel=2e-3)


def test_a_front_of_an_own_index_goes_on(tmp_path: Path) -> None:
    _, cost = own(tmp_path)
    words = f"pareto --layout S1,S2 --index {cost},J3 --points 3 --out {tmp_path} --json"
    rows = run(words)
    assert all({cost, "J3"} <= set(row["values"]) for row in rows)  # type: ignore[attr-defined]
    assert run(words) == rows


@pytest.mark.parametrize(
    ("name", "text", "told"),
    [
        ("a.toml", "", "no table [index]"),
        ("a.toml", '[index]\nsignal = "J9"', "signal is 'J9': give one of J1, J3"),
        ("a.toml", '[index]\nsignal = "J1"\nnumerator = [1]\ndenominator = [1, -1]', "not stable"),
        ("a.toml", '[index]\nsignal = "J1"\nnumerator = [1, 2]\ndenominator = [1]', "higher power"),
        ("a.py:f", "def g(J1): return J1", "no function 'f'"),
        ("a.py:f", "def f(J7): return J7", "argument 'J7' is no index"),
        ("a.py:f", "def f(J1): return -J1", "positive and finite"),
        ("a.py:f", "def f(J1): return J1 / 0", "ZeroDivisionError"),
        ("a.py:f", "import nothing_of_that_name", "ModuleNotFoundError"),
        ("none.py:f", None, "there is no file"),
    ],
)
def test_what_is_wrong_is_one_line(name: str, text: str | None, told: str, tmp_path: Path) -> None:
    if text is not None:
        (tmp_path / name.partition(":")[0]).write_text(text)
    answer = CliRunner().invoke(
        app, ["optimize", "--layout", "S1", "--index", str(tmp_path / name)], catch_exceptions=False
    )
    assert answer.exit_code == 2
    assert told in answer.output.replace("\n", " ")


def test_a_car_that_does_not_turn_has_no_such_index() -> None:
    for words, told in (
        (["--index", "pitch"], "a quarter-car has none"),
        (["--car", "half", "--index", "roll"], "it takes a full car"),
    ):
        answer = CliRunner().invoke(app, ["optimize", *words], catch_exceptions=False)
        assert answer.exit_code == 2
        assert told in answer.output.replace("\n", " ")
    with pytest.raises(OwnIndexError, match=r"no such file|cannot be read|none\.toml"):
        INDICES["none.toml"]
