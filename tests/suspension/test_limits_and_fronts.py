"""Optima within limits against brute force, and fronts that go on where they stood."""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from inerter.suspension.commands import app
from inerter.suspension.indices import INDICES
from inerter.suspension.layouts import LAYOUTS
from inerter.suspension.limited import LimitError, best_within, values_of
from inerter.suspension.optimum import optimise
from inerter.suspension.problem import SuspensionProblem
from inerter.suspension.quarter_car import QuarterCar, Road
from inerter.suspension.vehicle import VehicleStrut, half_car, vehicle_index
from inerter.suspension.vehicle.cars import Axle, HalfCar
from inerter.suspension.vehicle.optimum import optimise_vehicle
from inerter.suspension.vehicle.problem import VehicleProblem
from scipy.integrate import quad
from typer.testing import CliRunner

CAR, ROAD = QuarterCar(sprung_mass=320.0, unsprung_mass=42.0, tyre_stiffness=210e3), Road()


def problem(layout: str, index: str, k: float = 25e3, **more) -> SuspensionProblem:
    return SuspensionProblem(car=CAR, road=ROAD, layout=layout, index=index, stiffness=k, **more)


def test_travel_is_the_integral() -> None:
    strut = LAYOUTS["S5"].stiffness(25e3, 1500.0, 60.0, 200e3)

    def density(f: float) -> float:
        s = 2j * np.pi * f
        # by hand: ms s^2 zs = -D x, mu s^2 zu = D x - kt (zu - zr)
        d = strut(s)
        a = np.array([[320.0 * s**2 + d, -d], [-d, 42.0 * s**2 + d + 210e3]])
        zs, zu = np.linalg.solve(a, np.array([0.0, 210e3]))
        return float(abs((zs - zu) / s) ** 2)

    parts = [(1e-6, 0.8), (0.8, 2.0), (2.0, 15.0), (15.0, 5e3)]
    total = sum(quad(density, a, b, limit=500, epsrel=1e-11)[0] for a, b in parts)
    found = float(INDICES["travel"].evaluate(CAR, ROAD, strut))
    assert found == pytest.approx(ROAD.slope * np.sqrt(2.0 * total), rel=1e-6)


def test_travel_of_a_half_car_of_two_quarter_cars() -> None:
    axle = Axle(distance=1.3, wheel_mass=42.0, tyre_stiffness=210e3, stiffness=25e3)
    car = HalfCar(body_mass=640.0, pitch_inertia=640.0 * 1.69, front=axle, rear=axle)
    strut = VehicleStrut(25e3, 1500.0, 60.0, 200e3)
    single = INDICES["travel"].evaluate(CAR, ROAD, LAYOUTS["S5"].stiffness(25e3, 1500, 60, 200e3))
    assert vehicle_index("travel", car, "S5", (strut, strut)) == pytest.approx(
        float(single), rel=1e-8
    )


def test_one_variable_ends_on_the_limit() -> None:
    """S1: comfort asks for a softer damper than the travel allows."""
    found = best_within(problem("S1", "J1w", limits=(("travel", 0.0065),)))
    assert found.reached == ("travel",)
    assert values_of(problem("S1", "J1w"), found.point)["travel"] == pytest.approx(0.0065, rel=2e-6)


@pytest.mark.parametrize(
    ("index", "k", "limits"),
    [
        ("J1w", 25e3, (("travel", 0.0085), ("J3", 640.0))),
        ("J1", 60e3, (("J5", 2.3e-5),)),
        ("J5", 60e3, (("J1", 1.7),)),
    ],
)
def test_a_grid_finds_nothing_better(
    index: str, k: float, limits: tuple[tuple[str, float], ...]
) -> None:
    one = problem("S3", index, k, limits=limits)
    found = best_within(one)
    for name, most in limits:
        assert values_of(one, found.point)[name] <= most * (1.0 + 2e-6)
    count = 50 if "J5" in (index, *dict(limits)) else 160
    axes = [np.log(np.geomspace(5e2, 3e4, count)), np.log(np.geomspace(3.0, 3e5, count))]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 2)
    kept = np.ones(len(grid), dtype=bool)
    for name, most in limits:
        kept &= replace(one, index=name, limits=()).value(grid) <= most
    values = replace(one, limits=()).value(grid[kept])
    assert values.min() >= found.value * (1.0 - 1e-9)
    assert values.min() <= found.value * 1.1


def test_limits_that_are_wide_change_nothing() -> None:
    plain = optimise(problem("S3", "J1"))
    wide = optimise(problem("S3", "J1", limits=(("J3", 1e5), ("travel", 1.0))))
    assert wide.value == pytest.approx(plain.value, rel=1e-9)
    assert not wide.notes


def test_limits_that_no_design_keeps_are_refused() -> None:
    with pytest.raises(LimitError, match=r"S3: no design keeps J3 100 \(alone not below"):
        optimise(problem("S3", "J1", limits=(("J3", 100.0),)))


OWN = ["optimize", "--sprung-mass", "320", "--unsprung-mass", "42", "--tyre-stiffness", "210e3",
       "--stiffness", "25e3", "--index", "J1w"]  # fmt: skip


def test_a_layout_that_keeps_no_limit_leaves_the_others(tmp_path: Path) -> None:
    words = [*OWN, "--layout", "S1,SR", "--limit", "J3=560"]
    run = CliRunner().invoke(app, [*words, "--json", "--out", str(tmp_path)])
    assert run.exit_code == 0, run.output
    kept, missed = json.loads(run.stdout)
    alone = optimise(problem("SR", "J1w", limits=(("J3", 560.0),)))
    assert (kept["layout"], kept["value"]) == ("SR", pytest.approx(alone.value, rel=1e-9))
    assert (missed["layout"], missed["value"]) == ("S1", None)
    assert "no design keeps J3 560 (alone not below 572." in missed["told"]
    assert json.loads((tmp_path / "optimum.json").read_text())["missed"] == [missed]
    shown = CliRunner().invoke(app, words)
    assert shown.exit_code == 0, shown.output
    assert "layout S1: no design keeps J3 560" in shown.stdout
    # nothing left to show is an error
    none = CliRunner().invoke(app, [*OWN, "--layout", "S1", "--limit", "J3=560", "--json"])
    assert (none.exit_code, none.stdout) == (2, "")
    assert "layout S1: no design keeps J3 560" in none.stderr


@pytest.mark.long
def test_a_half_car_within_a_limit() -> None:
    one = VehicleProblem(
        car=half_car(), road=ROAD, layout="S3", index="J1", stiffnesses=(19960.0, 17500.0)
    )
    free = optimise_vehicle(one)
    held = optimise_vehicle(replace(one, limits=(("J3", 500.0),)))
    tyre = vehicle_index("J3", half_car(), "S3", held.struts)
    assert tyre == pytest.approx(500.0, rel=2e-6)
    assert held.value > free.value
    assert held.notes == ("held back by the limit of J3",)
    # along the valley between both optima nothing is better
    draw = np.random.default_rng(1)
    at = one.point(held.struts)
    for move in 0.02 * draw.standard_normal((60, len(at))):
        struts = one.struts(at + move)
        if vehicle_index("J3", half_car(), "S3", struts) <= 500.0:
            assert vehicle_index("J1", half_car(), "S3", struts) >= held.value * (1.0 - 1e-9)


def test_a_front_goes_on_where_it_stood(tmp_path: Path) -> None:
    words = ["pareto", "--layout", "S1,S3", "--stiffness", "60e3", "--points", "4", "--json",
             "--out", str(tmp_path)]  # fmt: skip
    run = CliRunner().invoke(app, words)
    assert run.exit_code == 0, run.output
    rows = json.loads(run.stdout)
    for name in ("S1", "S3"):
        line = [row["values"] for row in rows if row["layout"] == name]
        assert len(line) == 4
        first, second = ([row[index] for row in line] for index in ("J1w", "J3"))
        assert first == sorted(first, reverse=True)
        assert second == sorted(second)
    # S1 is inside S3: nothing of it is better in both
    for plain in (row["values"] for row in rows if row["layout"] == "S1"):
        assert not any(
            plain["J1w"] < 0.999 * rich["J1w"] and plain["J3"] < 0.999 * rich["J3"]
            for rich in (row["values"] for row in rows if row["layout"] == "S3")
        )
    table = list(csv.DictReader((tmp_path / "pareto.csv").read_text().splitlines()))
    assert [float(row["J3"]) for row in table] == [row["values"]["J3"] for row in rows]
    assert (tmp_path / "pareto.png").read_bytes()[:4] == b"\x89PNG"

    # half of it lost: the rest is sought, what is there is taken as it stands
    path = tmp_path / "pareto.json"
    content = json.loads(path.read_text())
    kept = content["rows"][:3]
    kept[0]["values"]["J5"] = 1.25
    path.write_text(json.dumps(content | {"rows": kept}))
    again = CliRunner().invoke(app, words)
    assert again.exit_code == 0, again.output
    found = json.loads(again.stdout)
    assert len(found) == len(rows)
    assert found[0]["values"]["J5"] == 1.25
    assert found[-1]["values"]["J1w"] == pytest.approx(rows[-1]["values"]["J1w"], rel=1e-7)
    other = CliRunner().invoke(app, [*words[:3], *words[3:], "--limit", "travel=0.02"])
    assert other.exit_code == 2
    assert "a front of another limits" in other.stderr


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--limit", "J3"], "limit 'J3': write NAME=VALUE"),
        (["--limit", "J9=3"], "limit 'J9' is not known: choose from J1, J3, J5"),
        (["--hold", "inertance=x"], "hold of inertance 'x' is not a number"),
    ],
)
def test_limits_in_words(words: list[str], said: str) -> None:
    run = CliRunner().invoke(app, ["optimize", *words])
    assert run.exit_code == 2
    assert said in run.stderr


def test_what_is_held_stays(tmp_path: Path) -> None:
    run = CliRunner().invoke(
        app, ["optimize", "--layout", "S2", "--index", "J1", "--hold", "inertance=60", "--json"]
    )
    assert run.exit_code == 0, run.output
    (row,) = json.loads(run.stdout)
    assert row["inertance"] == 60.0
