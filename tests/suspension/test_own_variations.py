"""A car as its file states it under payload, tyres, speed and tolerances of its parts."""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from inerter.cars.parts import GRAVITY, AxleParts, CarParts
from inerter.cars.read import shipped_car
from inerter.suspension.commands import app
from inerter.suspension.time_domain.own_struts import evaluate_own
from inerter.suspension.time_domain.own_varied import evaluate_varied, varied_cars
from inerter.suspension.time_domain.profile import profile_named
from inerter.suspension.time_domain.road import iso_road
from inerter.suspension.time_domain.simulate import RunSettings
from typer.testing import CliRunner

RUNS = RunSettings(step=1e-3, settle=4.0, jobs=1)
TABLES = {
    "damping": 0.0,
    "damper_bump": ((0.05, 60.0), (0.3, 300.0)),
    "damper_rebound": ((0.1, 300.0), (0.5, 900.0)),
}


def with_strut(car: CarParts, **values: Any) -> CarParts:
    """A car with other struts."""
    front, rear = (
        axle and replace(axle, strut=replace(axle.strut, **values))
        for axle in (car.front, car.rear)
    )
    assert front is not None
    return replace(car, front=front, rear=rear)


def test_a_variation_is_the_file_that_states_it() -> None:
    """To the last digit: the changed car on the changed road, and the planned one unchanged."""
    car = with_strut(shipped_car("quarter"), layout="S6", relaxation_stiffness=30e3, **TABLES)
    factors = {"body_mass": (1.0, 1.3), "damping": (0.8, 1.0), "inertance": (1.0, 1.1),
               "speed": (0.5, 1.0)}  # fmt: skip
    found = evaluate_varied(car, factors, lambda f: iso_road("C", 20.0 * f), 2, RUNS)
    plain = evaluate_own(car, iso_road("C", 20.0), 2, RUNS)
    strut = car.front.strut
    stated = replace(
        with_strut(
            car,
            inertance=1.1 * strut.inertance,
            damper_bump=((0.05, 48.0), (0.3, 240.0)),
            damper_rebound=((0.1, 240.0), (0.5, 720.0)),
        ),
        body_mass=1.3 * car.body_mass,
    )
    expected = evaluate_own(stated, iso_road("C", 10.0), 2, RUNS)
    assert {len(each) for each in found.figures.values()} == {16}
    told = "body_mass x 1.3, damping x 0.8, inertance x 1.1, speed x 0.5"
    for name, want in ((told, expected), ("as planned", plain)):
        for figure in want.figures:
            (one,) = (each for each in found.figures[figure.name] if each.name == name)
            for part in ("value", "low", "high", "linear"):
                value = getattr(figure, part)
                same = None if value is None else pytest.approx(value, rel=1e-12)
                assert getattr(one, part) == same, (name, figure.name)


@pytest.mark.parametrize("kind", ["half", "full"])
def test_each_factor_goes_where_it_belongs(kind: str) -> None:
    car = with_strut(
        shipped_car(kind), layout="SW8", relaxation_stiffness=60e3, damper_stiffness=9e3,
        inerter_stiffness=8e3, inertance=40.0,
    )  # fmt: skip
    names = ("body_mass", "wheel_mass", "tyre_stiffness", "stiffness", "damping", "inertance",
             "relaxation_stiffness", "damper_stiffness", "inerter_stiffness")  # fmt: skip
    factors = {name: (1.0 + 0.01 * (n + 1),) for n, name in enumerate(names)}
    ((_, changed, speed),) = varied_cars(car, factors)
    assert speed == 1.0
    assert changed.body_mass / car.body_mass == pytest.approx(1.01)
    assert changed.pitch_inertia / car.pitch_inertia == pytest.approx(1.01)
    assert changed.roll_inertia == pytest.approx(1.01 * car.roll_inertia)
    for place, now in changed.axles.items():
        was: AxleParts = car.axles[place]
        for n, name in enumerate(names[1:], start=2):
            one, other = (x if n < 4 else x.strut for x in (now, was))
            assert getattr(one, name) / getattr(other, name) == pytest.approx(1.0 + 0.01 * n), name
        assert now.distance == was.distance
        assert now.anti_roll_stiffness == was.anti_roll_stiffness


def test_a_payload_sinks_the_car_towards_its_bump_stops() -> None:
    """By its weight over the spring: 250 kg more on four springs, by hand."""
    stops = {"bump_stop_gap": 0.08, "bump_stop_stiffness": 1e5, "rebound_stop_gap": 0.05,
             "rebound_stop_stiffness": 1e5, "motion_ratio": 0.9}  # fmt: skip
    car = with_strut(shipped_car("full"), **stops)
    assert car.rear is not None
    factor = 1.0 + 250.0 / car.body_mass
    ((_, laden, _),) = varied_cars(car, {"body_mass": (factor,)})
    base = car.front.distance + car.rear.distance
    for axle, other, now in ((car.front, car.rear, laden.front), (car.rear, car.front, laden.rear)):
        assert now is not None
        more = 0.5 * 250.0 * GRAVITY * other.distance / base
        stroke = 0.9 * more / (axle.strut.stiffness * 0.81)
        assert now.strut.bump_stop_gap == pytest.approx(0.08 - stroke, rel=1e-12)
        assert now.strut.rebound_stop_gap == pytest.approx(0.05 + stroke, rel=1e-12)
    with pytest.raises(ValueError, match=r"body_mass x 3: the front strut sinks by .* bump stop"):
        varied_cars(car, {"body_mass": (3.0,)})
    # and over a bump the stop is met earlier
    profile = profile_named("bump:0.1/2", 8.0)
    assert profile is not None
    soft = with_strut(
        shipped_car("quarter"), layout="S1", inertance=0.0, stiffness=25e3, damping=900.0,
        bump_stop_gap=0.025, bump_stop_stiffness=4e5,
    )  # fmt: skip
    found = evaluate_varied(soft, {"body_mass": (1.0, 1.2)}, lambda _: profile, 1, RUNS)
    level = replace(soft, body_mass=1.2 * soft.body_mass)
    levelled = {each.name: each.value for each in evaluate_own(level, profile, 1, RUNS).figures}
    assert found.figures["tyre_peak"][1].value > 1.2 * levelled["tyre_peak"]


def test_what_a_variation_cannot_have_is_told_with_its_name() -> None:
    car = with_strut(
        shipped_car("quarter"), layout="SW7", stiffness=20e3, damper_stiffness=40e3,
        inerter_stiffness=38e3,
    )  # fmt: skip
    with pytest.raises(ValueError, match=r"vary, stiffness x 0.9: layout SW7: its inner springs"):
        evaluate_varied(car, {"stiffness": (0.9,)}, lambda _: iso_road("C"), 2, RUNS)


def test_the_command_tells_each_figure(tmp_path: Path) -> None:
    words = ["evaluate", "--car", "quarter", "--layout", "own", "--road", "iso:C", "--seeds", "2",
             "--jobs", "1", "--out", str(tmp_path), "--vary",
             "body_mass=1/1.3,tyre_stiffness=0.9/1.1"]  # fmt: skip
    shown = CliRunner().invoke(app, words, catch_exceptions=False)
    assert shown.exit_code == 0, shown.output
    assert "worst when" in shown.output
    document = json.loads((tmp_path / "evaluation.json").read_text())
    assert document["vary"] == {"body_mass": [1.0, 1.3], "tyre_stiffness": [0.9, 1.1]}
    assert set(document["variations"]) == set(document["figures"])
    told = document["variations"]["J3"]
    values = [each["value"] for each in told["each"]]
    assert told["nominal"] == document["figures"]["J3"]["value"]
    assert (told["worst"], told["best"]) == (max(values), min(values))
    assert told["mean"] == pytest.approx(np.mean(values))
    assert told["worst_when"] == "body_mass x 1.3, tyre_stiffness x 1.1"
    # the exact value stands beside each
    assert [each["linear"] for each in told["each"]] == pytest.approx(values, rel=5e-3)
    with (tmp_path / "variations.csv").open() as file:
        lines = [line for line in csv.DictReader(file) if line["figure"] == "J3"]
    assert [float(line["value"]) for line in lines] == values
    assert {line["unit"] for line in lines} == {"N"}
