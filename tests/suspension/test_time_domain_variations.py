"""What a design does under payload, tyres, speed and tolerances of its parts."""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from inerter.suspension.commands import app
from inerter.suspension.quarter_car import QuarterCar
from inerter.suspension.time_domain.cases import CASES
from inerter.suspension.time_domain.design import Design
from inerter.suspension.time_domain.evaluate import evaluate
from inerter.suspension.time_domain.linear import exact_index, spectrum
from inerter.suspension.time_domain.plan import Plan
from inerter.suspension.time_domain.road import iso_road, paper_road
from inerter.suspension.time_domain.simulate import RunSettings
from inerter.suspension.vehicle.cars import half_car
from typer.testing import CliRunner

PLAN = Plan(
    layouts=("S2",),
    cases=(CASES["friction100"],),
    indices=("J1w",),
    road=iso_road("C"),
    seeds=3,
    given=((4000.0, 80.0),),
    settings=RunSettings(step=2e-3, jobs=2),
)


def test_a_variation_is_that_car_with_those_parts_at_that_speed() -> None:
    """The same digits as a plan that states the changed car, and the planned one unchanged."""
    factors = {"body_mass": (1.0, 1.3), "damping": (0.8, 1.0), "speed": (0.6, 1.0)}
    (row,) = evaluate(replace(PLAN, vary=tuple(factors.items())))
    (plain,) = evaluate(PLAN)
    assert replace(row, variations=(), notes=()) == replace(plain, notes=())
    named = {each.name: each for each in row.variations}
    assert len(named) == 8
    assert named["as planned"].value == row.value
    assert (named["as planned"].low, named["as planned"].high) == (row.low, row.high)
    assert named["as planned"].linear == row.linear
    heavy = QuarterCar(sprung_mass=1.3 * QuarterCar().sprung_mass)
    stated = replace(PLAN, car=heavy, road=iso_road("C", 15.0), given=((3200.0, 80.0),))
    (expected,) = evaluate(stated)
    found = named["body_mass x 1.3, damping x 0.8, speed x 0.6"]
    for name in ("value", "low", "high", "linear"):
        assert getattr(found, name) == pytest.approx(getattr(expected, name), rel=1e-12)


def test_two_axles_and_inner_springs_vary() -> None:
    """Linear, so every value has its transfer function; by hand the payload turns, too."""
    car = half_car()
    plan = replace(
        PLAN,
        layouts=("S4",),
        cases=(CASES["ideal"],),
        indices=("J1",),
        stiffnesses=(80e3,),
        car=car,
        road=paper_road(),
        seeds=2,
        given=(),
        vary=(("body_mass", (1.2,)), ("relaxation_stiffness", (0.1,)), ("inertance", (2.0,))),
    )
    (row,) = evaluate(plan)
    (each,) = row.variations
    assert row.rear_stiffness is not None
    assert row.rear_damping is not None
    assert row.rear_inertance is not None
    kb = [0.1 * some["relaxation_stiffness"] for some in (row.springs, row.rear_springs)]
    rear = Design(
        row.rear_stiffness, row.rear_damping, 2.0 * row.rear_inertance, relaxation_stiffness=kb[1]
    )
    design = Design(
        row.stiffness, row.damping, 2.0 * row.inertance, rear=rear, relaxation_stiffness=kb[0]
    )
    laden = replace(car, body_mass=1.2 * car.body_mass, pitch_inertia=1.2 * car.pitch_inertia)
    exact = exact_index("J1", "S4", design, None, laden, spectrum(plan.road))
    assert each.linear == pytest.approx(exact, rel=1e-9)
    assert each.value == pytest.approx(exact, rel=5e-3)


def run(words: str) -> Any:
    return CliRunner().invoke(app, words.split(), catch_exceptions=False)


def test_the_command_tells_nominal_mean_and_worst(tmp_path: Path) -> None:
    words = (
        f"evaluate --layout S1,S2 --case ideal --damping 4000 --inertance 80 --seeds 2 "
        f"--index J3 --road iso:B --step 2e-3 --out {tmp_path}"
    )
    answer = run(f"{words} --vary body_mass=1/1.3,tyre_stiffness=0.9/1.1 --json")
    assert answer.exit_code == 0, answer.output
    document = json.loads(answer.stdout)
    assert document["vary"] == {"body_mass": [1.0, 1.3], "tyre_stiffness": [0.9, 1.1]}
    for row in document["rows"]:
        told, each = row["variations"], row["variations"]["each"]
        values = [one["value"] for one in each]
        assert told["nominal"] == row["value"]
        assert told["worst"] == max(values)
        assert told["best"] == min(values)
        assert told["mean"] == pytest.approx(np.mean(values))
        assert told["mean_low"] < told["mean"] < told["mean_high"]
        assert told["root_mean_square"] == pytest.approx(np.sqrt(np.mean(np.square(values))))
        assert told["worst_when"] == "body_mass x 1.3, tyre_stiffness x 1.1"
    with (tmp_path / "variations.csv").open() as file:
        lines = list(csv.DictReader(file))
    assert [float(line["value"]) for line in lines[4:]] == values
    shown = run(f"{words} --vary body_mass=1.3")
    assert "worst when" in shown.output
    assert "body_mass x 1.3" in shown.output
    assert "vary" not in json.loads(run(f"{words} --json").stdout)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("--vary weight=1.3", "vary 'weight' is not known: choose from body_mass"),
        ("--vary body_mass=0", "body_mass"),
        (f"--vary speed={'/'.join(map(str, range(1, 70)))}", "69 combinations, at most 64"),
        ("--layout own --vary weight=1.2", "vary 'weight' is not known: choose from body_mass"),
        ("--layout own --vary inerter_stiffness=1.2", "vary inerter_stiffness: no strut of the"),
        ("--layout own --vary speed=0", "speed"),
    ],
)
def test_bad_variations_are_one_line(tmp_path: Path, words: str, said: str) -> None:
    answer = run(f"evaluate {words} --out {tmp_path}")
    assert answer.exit_code == 2
    assert said in answer.stderr
