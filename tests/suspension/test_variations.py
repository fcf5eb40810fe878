"""The best over payloads, tyres, speeds and tolerances."""

from __future__ import annotations

import itertools
import json
import subprocess
import sys

import numpy as np
import pytest
from inerter.suspension.commands import app
from inerter.suspension.indices import INDICES
from inerter.suspension.layouts import LAYOUTS
from inerter.suspension.quarter_car import QuarterCar, Road
from inerter.suspension.variations import scenes_of
from inerter.suspension.vehicle import half_car
from inerter.suspension.vehicle.problem import VehicleProblem
from typer.testing import CliRunner

VARY = "--vary body_mass=1/1.4,tyre_stiffness=0.8/1.2,speed=0.5/1.5,damping=0.7/1.3"
FACTORS = ((1.0, 1.4), (0.8, 1.2), (0.5, 1.5), (0.7, 1.3))


def run(words: str) -> list[dict]:
    answer = CliRunner().invoke(app, [*words.split(), "--json"], catch_exceptions=False)
    assert answer.exit_code == 0, answer.output
    return json.loads(answer.stdout)


def by_hand(c: float, b: float) -> float:
    usual, squares = QuarterCar(), []
    for body, tyre, speed, damping in itertools.product(*FACTORS):
        car = QuarterCar(
            sprung_mass=body * usual.sprung_mass, tyre_stiffness=tyre * usual.tyre_stiffness
        )
        strut = LAYOUTS["S3"].stiffness(40e3, damping * c, b)
        squares.append(float(INDICES["J1w"].evaluate(car, Road(velocity=speed * 25.0), strut)) ** 2)
    return float(np.sqrt(np.mean(squares)))


def test_the_value_is_the_root_mean_square_and_no_design_beats_it() -> None:
    words = f"optimize --layout S3 --index J1w --stiffness 40e3 {VARY}"
    (row,) = run(words)
    c, b = row["damping"], row["inertance"]
    assert row["value"] == pytest.approx(by_hand(c, b), rel=1e-10)
    near = [by_hand(c * x, b * y) for x, y in itertools.product((0.98, 1.0, 1.02), repeat=2)]
    assert min(near) == near[4]
    far = [by_hand(x, y) for x in np.geomspace(200, 2e4, 25) for y in np.geomspace(3, 3e4, 25)]
    assert min(far) >= row["value"]
    # the design that is best as planned is worse over all
    (planned,) = run("optimize --layout S3 --index J1w --stiffness 40e3")
    (held,) = run(f"{words} --hold damping={planned['damping']},inertance={planned['inertance']}")
    assert held["value"] == pytest.approx(by_hand(planned["damping"], planned["inertance"]))
    assert held["value"] > row["value"] * (1.0 + 1e-6)


def test_a_vehicle_s_gradient_is_that_of_differences() -> None:
    scenes = scenes_of(half_car(), Road(), {"body_mass": (1.0, 1.3), "inertance": (0.8, 1.2)})
    assert len(scenes) == 4
    problem = VehicleProblem(
        car=half_car(), road=Road(), layout="S2", index="J1", stiffnesses=(2e4, 17e3), scenes=scenes
    )
    x = np.log([1500.0, 30.0, 1300.0, 20.0])
    value, slope = problem.logarithm(x)
    steps = 1e-5 * np.eye(4)
    numeric = [(problem.logarithm(x + d)[0] - problem.logarithm(x - d)[0]) / 2e-5 for d in steps]
    assert slope == pytest.approx(numeric, abs=1e-7)
    assert problem.value(x[None])[0] == pytest.approx(np.exp(value), rel=1e-10)
    assert problem.quick(x[None])[0] == pytest.approx(np.exp(value), rel=1e-6)
    assert np.sqrt(np.mean(np.square(problem.in_scenes(x)))) == pytest.approx(np.exp(value))


def test_the_table_says_what_is_best_and_worst() -> None:
    answer = CliRunner().invoke(
        app, ["optimize", "--layout", "S1", "--index", "J1w", "--vary", "body_mass=1/1.3"]
    )
    text = " ".join(answer.output.split())
    assert "root mean square over 2 variations, from" in text
    assert "(as planned)" in text
    assert "(body_mass x 1.3)" in text


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--vary", "mass=1/2"], "vary 'mass' is not known: choose from body_mass"),
        (["--vary", "speed"], "vary 'speed': write NAME=VALUE/VALUE"),
        (["--vary", "speed=0/1"], "vary of speed is 0"),
        (["--vary", "speed=0.5/1.5", "--index", "J5"], "J5 with --vary"),
        (["--vary", "speed=" + "/".join(map(str, range(1, 67)))], "66 combinations, at most 64"),
    ],
)
def test_bad_words_are_told(words: list[str], told: str) -> None:
    answer = CliRunner().invoke(app, ["optimize", "--index", "J1", *words], catch_exceptions=False)
    assert answer.exit_code == 2
    assert told in answer.output.replace("\n", " ")


@pytest.mark.parametrize("first", ["limited", "optimum", "vehicle.problem", "problem"])
def test_a_worker_may_import_any_module_first(first: str) -> None:
    """A process that is handed a problem imports what it is made of, in no order of ours."""
    subprocess.run([sys.executable, "-c", f"import inerter.suspension.{first}"], check=True)
