"""`evaluate --layout own`: a car file over roads, against exact norms and an adaptive solver."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from inerter.cars.equations import car_equations, heights
from inerter.cars.parts import CarParts
from inerter.cars.read import shipped_car
from inerter.suspension.commands import app
from inerter.suspension.indices import INDICES
from inerter.suspension.layouts import LAYOUTS
from inerter.suspension.quarter_car import QuarterCar, Road
from inerter.suspension.time_domain.own_linear import linear_figures
from inerter.suspension.time_domain.own_struts import evaluate_own
from inerter.suspension.time_domain.profile import profile_named
from inerter.suspension.time_domain.road import iso_road, paper_road
from inerter.suspension.time_domain.simulate import RunSettings
from scipy.integrate import solve_ivp
from typer.testing import CliRunner

RUNS = RunSettings(jobs=2)
SPRINGS = {"relaxation_stiffness": 30e3}
CENTRED = {"damper_stiffness": 30e3, "inerter_stiffness": 20e3}
STRUTS = {
    "S1": {},
    "SR": {"relaxation_stiffness": 90e3, "inertance": 0.0},
    "S2": {"inertance": 30.0},
    "S3": {},
    "S4": {"relaxation_stiffness": 200e3, "inertance": 20.0},
    "S5": {"relaxation_stiffness": 200e3},
    "S6": SPRINGS,
    "SW7": CENTRED,
    "SW8": {**CENTRED, "relaxation_stiffness": 200e3},
}


def changed(kind: str, **values) -> CarParts:
    """A shipped car with other struts."""
    car = shipped_car(kind)
    front = replace(car.front, strut=replace(car.front.strut, **values))
    rear = car.rear and replace(car.rear, strut=replace(car.rear.strut, **values))
    return replace(car, front=front, rear=rear)


def struts(layout: str) -> dict:
    usual = {"layout": layout, "stiffness": 25e3, "damping": 1500.0, "inertance": 120.0}
    return usual | STRUTS[layout]


def figures(found) -> dict:
    return {each.name: each for each in found.figures}


@pytest.mark.parametrize(
    "layout",
    ["S2", "S4", "S5", "S6", *(pytest.param(n, marks=pytest.mark.long)
                               for n in ("S1", "SR", "S3", "SW7", "SW8"))],
)  # fmt: skip
def test_every_layout_meets_its_exact_value(layout: str) -> None:
    car = changed("quarter", motion_ratio=0.9, **struts(layout))
    found = figures(evaluate_own(car, iso_road("B"), 2, RUNS, one_sided=False))
    for name in ("J1", "J1w", "J3", "travel"):
        each = found[name]
        assert each.linear is not None
        # SW7's slow mode leaves 0.2 % on two roads, half of what its interval says
        assert each.value == pytest.approx(each.linear, rel=3e-3), name
        assert each.low <= each.linear * 1.0005, name
        assert each.high >= each.linear * 0.9995, name


@pytest.mark.parametrize(
    ("kind", "layout"),
    [("half", "S2"), ("full", "S2"), pytest.param("full", "S6", marks=pytest.mark.long)],
)
def test_cars_of_two_axles_meet_their_exact_values(kind: str, layout: str) -> None:
    car = changed(kind, **struts(layout))
    if kind == "full":
        car = replace(car, front=replace(car.front, anti_roll_stiffness=15e3), correlation=0.3)
    found = figures(evaluate_own(car, iso_road("B"), 2, RUNS, one_sided=False))
    for name in ("J1", "J1w", "J3", "travel"):
        assert found[name].value == pytest.approx(found[name].linear, rel=1.5e-3), name
    assert found["pitch"].value > 0.0
    assert ("roll" in found) == (kind == "full")


@pytest.mark.parametrize("kind", ["quarter", "full"])
def test_linear_values_are_the_norms_where_the_band_is_wide(kind: str) -> None:
    car = changed(kind, **struts("S6"))
    road = replace(paper_road(), first=1, last=500_000, band=(1e-3, 50_000.0))
    found = linear_figures(car, road)
    if kind == "quarter":
        strut = LAYOUTS["S6"].stiffness(25e3, 1500.0, 120.0, 30e3)
        own = QuarterCar(
            sprung_mass=car.body_mass,
            unsprung_mass=car.front.wheel_mass,
            tyre_stiffness=car.front.tyre_stiffness,
        )
        exact = {name: float(INDICES[name].evaluate(own, Road(), strut)) for name in found}
    else:
        from inerter.suspension.car_options import linear_car
        from inerter.suspension.vehicle.cars import FullCar
        from inerter.suspension.vehicle.indices import vehicle_index
        from inerter.suspension.vehicle.strut import VehicleStrut

        both = VehicleStrut(25e3, 1500.0, 120.0, 30e3)
        whole = linear_car(car)
        assert isinstance(whole, FullCar)
        exact = {name: vehicle_index(name, whole, "S6", (both, both)) for name in found}
    assert found == pytest.approx(exact, rel=2e-4)


@pytest.mark.parametrize("tables", [False, True])
def test_a_bump_agrees_with_an_adaptive_solver(tables: bool) -> None:
    more = {
        "damping": 0.0,
        "damper_bump": ((0.05, 60.0), (0.3, 300.0)),
        "damper_rebound": ((0.1, 300.0), (0.5, 900.0)),
        "bump_stop_gap": 0.015,
        "bump_stop_stiffness": 2e5,
    }
    car = changed("half", **{**struts("S6"), **(more if tables else {})})
    profile = profile_named("bump:0.05/0.5", 30.0 / 3.6)
    assert profile is not None
    assert car.rear is not None
    height = profile.height
    found = figures(evaluate_own(car, profile, 1, RUNS))
    equations = car_equations(car)
    base = car.front.distance + car.rear.distance
    roads = {
        name: (lambda t, late=base * ("rear" in name): float(height(np.array(t), late)))
        for name in equations.roads
    }
    count, inverse = len(equations.names), np.linalg.inv(equations.mass)

    def rates(t: float, state: np.ndarray) -> np.ndarray:
        q, v = state[:count], state[count:]
        return np.append(v, inverse @ equations.forces(q, v, heights(roads, equations.roads, t)))

    times = np.arange(0.0, 1.2, 1e-3)
    truth = solve_ivp(rates, (0.0, 1.2), np.zeros(2 * count), t_eval=times, rtol=1e-8,
                      atol=1e-10, max_step=1e-3).y.T  # fmt: skip
    forces = np.array([
        equations.tyre_forces(x[:count], heights(roads, equations.roads, t))
        for t, x in zip(times, truth, strict=True)
    ])  # fmt: skip
    at = {name: truth[:, n] for n, name in enumerate(equations.names)}
    travel = at["heave"] - car.front.distance * at["pitch"] - at["wheel_front"]
    rear = at["heave"] + car.rear.distance * at["pitch"] - at["wheel_rear"]
    largest = max(abs(travel).max(), abs(rear).max())
    assert found["tyre_peak"].value == pytest.approx(forces.max(), rel=2e-3)
    assert found["travel_peak"].value == pytest.approx(largest, rel=2e-3)
    loads = [car.static_loads["front"], car.static_loads["rear"]]
    assert (found["lift_off"].value > 0.0) == bool((forces <= -np.array(loads) * 0.999999).any())


def test_a_tyre_that_lifts_is_told_and_carries_less() -> None:
    car = changed("quarter", **struts("S1"))
    pulling = evaluate_own(car, iso_road("E"), 2, RUNS, one_sided=False)
    lifting = evaluate_own(car, iso_road("E"), 2, RUNS)
    assert figures(lifting)["J3"].value < 0.95 * figures(pulling)["J3"].value
    assert figures(lifting)["lift_off"].value > 0.05
    assert "off the road for" in lifting.notes[0]
    assert "pulled" in pulling.notes[0]


def test_the_command_writes_a_road_file_run(tmp_path: Path) -> None:
    road = tmp_path / "road.csv"
    x = np.linspace(0.0, 0.5, 2001)
    bump = 0.025 * (1.0 - np.cos(4.0 * np.pi * x))
    rows = [f"{a},{b},0" for a, b in zip(x, bump, strict=True)]
    road.write_text("\n".join(["distance,height_left,height_right", *rows]))
    words = ["evaluate", "--car", "full", "--layout", "own", "--speed", "8", "--json"]
    values = []
    for name in (str(road), "bump:0.05/0.5"):
        out = ["--road", name, "--out", str(tmp_path / "out")]
        answer = CliRunner().invoke(app, [*words, *out], catch_exceptions=False)
        assert answer.exit_code == 0, answer.output
        values.append(json.loads(answer.stdout)["figures"])
    # under one side alone the body rolls
    assert values[0]["roll"]["value"] > 0.1 > 1e3 * values[1]["roll"]["value"]
    assert {p.name for p in (tmp_path / "out").iterdir()} == {"evaluation.json", "evaluation.csv"}


@pytest.mark.parametrize(
    ("more", "told"),
    [
        (["--damping", "900"], "--damping: with --layout own"),
        (["--case", "friction"], "--case: with --layout own"),
        (["--road", "bump:0.05"], "give bump:HEIGHT/LENGTH"),
        (["--road", "none.csv"], "none.csv"),
        (["--road", "moon"], "'moon'"),
        (["--seeds", "1"], "seeds is 1"),
        (["--step", "0.003"], "no whole number of such steps"),
    ],
)
def test_bad_words_are_told(more: list[str], told: str, tmp_path: Path) -> None:
    words = ["evaluate", "--layout", "own", "--out", str(tmp_path), *more]
    answer = CliRunner().invoke(app, words, catch_exceptions=False)
    assert answer.exit_code != 0
    assert told in answer.output.replace("\n", " ")
    assert "Traceback" not in answer.output
