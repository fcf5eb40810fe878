"""Tyres with damping: exact where the road lets them, refused where it does not."""

from __future__ import annotations

import itertools
import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from inerter.cars.mjcf import car_mjcf
from inerter.cars.parts import CarParts
from inerter.cars.read import CarError, read_car, shipped_car
from inerter.diagnose.vehicle import diagnose_model
from inerter.suspension.comfort_weighting import weighting
from inerter.suspension.commands import app
from inerter.suspension.indices import INDICES, is_infinite
from inerter.suspension.layouts import LAYOUTS, SOFT
from inerter.suspension.optimum import optimise
from inerter.suspension.problem import SuspensionProblem
from inerter.suspension.quarter_car import QuarterCar, Road
from inerter.suspension.time_domain.cases import CASES
from inerter.suspension.time_domain.evaluate import evaluate
from inerter.suspension.time_domain.own_linear import linear_figures
from inerter.suspension.time_domain.own_struts import evaluate_own
from inerter.suspension.time_domain.plan import Plan
from inerter.suspension.time_domain.road import iso_road
from inerter.suspension.time_domain.simulate import RunSettings
from inerter.suspension.vehicle import VehicleStrut, full_car, half_car, vehicle_index
from inerter.suspension.vehicle.problem import VehicleProblem
from inerter.suspension.white_road import InfiniteIndexError
from scipy.integrate import quad
from typer.testing import CliRunner
from vehicle_oracle import rms

OWN = tuple(name for name, layout in LAYOUTS.items() if not layout.same_as)
RUNS = RunSettings(step=1e-3, settle=4.0, jobs=1)


def damped(car: Any, damping: float) -> Any:
    """A vehicle, or a car of a file, whose tyres have damping [N s/m], the rear ones less."""
    rear = car.rear and replace(car.rear, tyre_damping=0.6 * damping)
    return replace(car, front=replace(car.front, tyre_damping=damping), rear=rear)


def strut_of(layout: str, draw: np.random.Generator, **more: Any) -> Any:
    """A drawn strut's dynamic stiffness."""
    values = (draw.uniform(20e3, 80e3), draw.uniform(800, 4000), draw.uniform(20, 150))
    kb, share, ratio = draw.uniform(50e3, 300e3), draw.uniform(0.1, 0.5), draw.uniform(0.3, 3.0)
    return LAYOUTS[layout].stiffness(
        *values, kb, centring_share=share, centring_ratio=ratio, **more
    )


def gains(car: QuarterCar, strut: Any, s: complex) -> dict[str, complex]:
    """Of the two masses by hand: body's acceleration, tyre force, travel per road velocity."""
    d, tyre = complex(np.squeeze(strut(s))), car.tyre_stiffness + car.tyre_damping * s
    matrix = [[car.sprung_mass * s * s + d, -d], [-d, car.unsprung_mass * s * s + d + tyre]]
    body, wheel = np.linalg.solve(matrix, [0.0, tyre / s])
    return {"J1": body * s * s, "J3": tyre * (wheel - 1.0 / s), "travel": body - wheel}


@pytest.mark.parametrize("layout", OWN)
def test_what_is_finite_is_the_integral(layout: str, effects_seed: int) -> None:
    draw = np.random.default_rng([effects_seed, OWN.index(layout)])
    car, road = QuarterCar(tyre_damping=float(draw.uniform(50.0, 800.0))), Road()
    strut = strut_of(layout, draw)
    for name in ("J1", "J1w", "travel"):
        if is_infinite(name, car, strut):
            continue

        def density(x: float, name: str = name) -> float:
            s = 1j * math.exp(x)
            felt = gains(car, strut, s)[INDICES[name].signal or name]
            felt *= complex(weighting()(s)) if name == "J1w" else 1.0
            return abs(felt) ** 2 * abs(s)

        ends = np.log([1e-3, 3.0, 8.0, 15.0, 40.0, 120.0, 500.0, 1e4, 1e8])
        total = sum(
            quad(density, a, b, limit=400, epsrel=1e-10)[0] for a, b in itertools.pairwise(ends)
        )
        found = float(INDICES[name].evaluate(car, road, strut))
        assert found == pytest.approx(road.slope * math.sqrt(total / math.pi), rel=2e-6), name


@pytest.mark.parametrize("layout", OWN)
@pytest.mark.parametrize("pair", [None, SOFT])
def test_which_are_infinite_is_seen_at_high_frequency(
    layout: str, pair: Any, effects_seed: int
) -> None:
    """A gain per road velocity that does not fall, of the two masses by hand."""
    strut = strut_of(layout, np.random.default_rng([effects_seed, 9]), pair=pair)
    car = QuarterCar(tyre_damping=200.0)
    ends = [gains(car, strut, 1j * w) for w in (1e7, 1e9)]
    for name in ("J1", "J3", "travel"):
        stays = abs(ends[1][name]) > 0.5 * abs(ends[0][name])
        assert is_infinite(name, car, strut) == stays, name
        assert math.isinf(float(INDICES[name].evaluate(car, Road(), strut))) == stays
        assert not is_infinite(name, replace(car, tyre_damping=0.0), strut)
    assert is_infinite("J3", car, strut)
    assert is_infinite("J1", car, strut) == (layout == "S2" and pair is None)
    assert not is_infinite("J1w", car, strut)


@pytest.mark.parametrize("index", ["J1", "J1w", "travel", "J5"])
def test_a_half_car_of_two_quarter_cars_has_what_they_have(index: str) -> None:
    quarter = QuarterCar(sprung_mass=250.0, unsprung_mass=35.0, tyre_stiffness=150e3,
                         tyre_damping=300.0)  # fmt: skip
    car = half_car()
    axle = replace(car.front, distance=1.3, wheel_mass=35.0, tyre_stiffness=150e3,
                   tyre_damping=300.0)  # fmt: skip
    car = replace(car, body_mass=500.0, pitch_inertia=500.0 * 1.69, front=axle, rear=axle)
    one = VehicleStrut(30e3, 1500.0, 60.0, 200e3)
    strut = LAYOUTS["S5"].stiffness(30e3, 1500.0, 60.0, 200e3)
    single = float(INDICES[index].evaluate(quarter, Road(), strut))
    found = vehicle_index(index, car, "S5", (one, one))
    assert found == pytest.approx(single * (0.5 if index == "J5" else 1.0), rel=1e-9)


def test_a_full_car_is_the_integral() -> None:
    car, road = damped(full_car(), 400.0), Road()
    struts = (VehicleStrut(25e3, 1500.0, 60.0), VehicleStrut(22e3, 1300.0, 80.0))
    delay = car.wheelbase / road.velocity
    exact = rms("J1", car, "S3", struts, None, delay=delay, correlation=car.correlation)
    assert vehicle_index("J1", car, "S3", struts) == pytest.approx(road.slope * exact, rel=2e-5)
    assert math.isinf(vehicle_index("J3", car, "S3", struts))
    assert math.isinf(vehicle_index("J1", car, "S2", struts))
    assert math.isfinite(vehicle_index("roll", car, "S3", struts))


@pytest.mark.parametrize(("layout", "index"), [("S5", "J1"), ("S2", "J1w"), ("S4", "travel")])
def test_the_gradient_is_exact(layout: str, index: str, effects_seed: int) -> None:
    draw = np.random.default_rng([effects_seed, 5])
    for car in (damped(half_car(), 500.0), damped(full_car(), 300.0)):
        problem = VehicleProblem(
            car=car, road=Road(), layout=layout, index=index, stiffnesses=(20e3, 18e3)
        )
        low, high = problem.bounds.T
        point = low + draw.uniform(0.4, 0.6, len(low)) * (high - low)
        slope, step = problem.logarithm(point)[1], 1e-5
        differences = [
            (problem.logarithm(point + e)[0] - problem.logarithm(point - e)[0]) / (2.0 * step)
            for e in step * np.eye(len(point))
        ]
        assert slope == pytest.approx(differences, abs=1e-6)
        assert problem.quick(point[None])[0] == pytest.approx(problem.value(point[None])[0])


def best(layout: str, index: str, **more: Any) -> float:
    """The best value with a tyre's damper."""
    car = QuarterCar(tyre_damping=200.0)
    return optimise(
        SuspensionProblem(car=car, road=Road(), layout=layout, index=index, stiffness=30e3, **more)
    ).value


def test_optima_go_by_what_is_finite() -> None:
    """S4 contains S2, which has no finite J1: its relaxation spring is not rigid then."""
    values = {name: best(name, "J1w") for name in ("S1", "S2", "S4", "S6")}
    assert values["S4"] <= values["S2"] * (1.0 + 1e-8) < values["S1"]
    assert best("S4", "J1") <= best("S1", "J1") * (1.0 + 1e-8)
    # damping of the tyre calms wheel and body
    undamped = SuspensionProblem(
        car=QuarterCar(), road=Road(), layout="S1", index="J1w", stiffness=30e3
    )
    assert values["S1"] != pytest.approx(optimise(undamped).value, rel=1e-3)


@pytest.mark.parametrize(
    ("layout", "index", "limits", "said"),
    [
        ("S1", "J3", (), "index J3 of layout S1 is infinite: with tyre_damping the tyre force"),
        (
            "S2",
            "J1",
            (),
            "index J1 of layout S2 is infinite: with tyre_damping through its inerter",
        ),
        ("S3", "J1", (("J3", 900.0),), "index J3 of layout S3 is infinite"),
    ],
)
def test_an_infinite_index_is_refused(layout: str, index: str, limits: Any, said: str) -> None:
    with pytest.raises(InfiniteIndexError) as told:
        best(layout, index, limits=limits)
    assert said in str(told.value)
    assert "evaluate --layout own" in str(told.value)
    assert "J1w" in str(told.value)


def test_tyre_load_grows_with_the_band_of_the_road() -> None:
    """Beyond the wheel's mode the damper alone presses: J3^2 grows by 4 pi^2 strength ct^2 df."""
    car, road = damped(shipped_car("quarter"), 300.0), iso_road("C")
    ends = (2000.0, 3000.0)
    short, long = (
        linear_figures(car, replace(road, last=10 * int(end), band=(0.25, end)))["J3"]
        for end in ends
    )
    expected = 4.0 * math.pi**2 * road.strength * 300.0**2 * (ends[1] - ends[0])
    assert long**2 - short**2 == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize(("kind", "layout"), [("quarter", "S2"), ("half", "S4"), ("full", "S1")])
def test_the_own_car_meets_its_exact_values(kind: str, layout: str) -> None:
    car: CarParts = damped(shipped_car(kind), 300.0)
    values: dict[str, Any] = {"layout": layout}
    values |= {"relaxation_stiffness": 80e3} if layout == "S4" else {}
    values |= {"inertance": 0.0} if layout == "S1" else {}
    assert car.rear is None or kind != "quarter"
    front, rear = (
        axle and replace(axle, strut=replace(axle.strut, **values))
        for axle in (car.front, car.rear)
    )
    assert front is not None
    car = replace(car, front=front, rear=rear)
    found = evaluate_own(car, iso_road("B"), 2, RUNS, one_sided=False)
    for each in found.figures:
        if each.linear is not None:
            assert each.value == pytest.approx(each.linear, rel=3e-3), each.name
    (note,) = (note for note in found.notes if "tyre_damping" in note)
    assert note.startswith("J1, J3:" if layout == "S2" else "J3:")
    assert "ends, here at 250 Hz" in note


def test_designs_meet_their_exact_values() -> None:
    for car, layout, index in (
        (QuarterCar(tyre_damping=300.0), "S2", "J1w"),
        (damped(half_car(), 400.0), "S3", "J1"),
    ):
        plan = Plan(
            layouts=(layout,), cases=(CASES["ideal"],), indices=(index,), road=iso_road("B"),
            seeds=2, car=car, stiffnesses=(80e3,), settings=RUNS, one_sided=False,
        )  # fmt: skip
        (row,) = evaluate(plan)
        assert row.exact is not None
        assert row.value == pytest.approx(row.exact, rel=3e-3)


def car_file(folder: Path, tyre: str) -> Path:
    """The shipped quarter-car with a line more for its tyre."""
    text = Path(__file__).parents[2] / "python/inerter/data/cars/quarter.toml"
    path = folder / "car.toml"
    path.write_text(text.read_text().replace("[front.strut]", f"{tyre}\n[front.strut]"))
    return path


def test_the_file_states_it(tmp_path: Path) -> None:
    assert read_car(car_file(tmp_path, "tyre_damping_kN_s_per_m = 0.2")).front.tyre_damping == 200.0
    assert shipped_car("quarter").front.tyre_damping == 0.0
    assert "lead_" not in car_mjcf(shipped_car("half"))
    for line, said in (
        ("tyre_damping = 200", "tyre_damping has no unit: write tyre_damping_N_s_per_m"),
        ("tyre_damping_N_s_per_m = -3", "give a positive number"),
        ("tyre_damping_kN_s_per_m = 200", "did you mean tyre_damping_N_s_per_m = 200?"),
    ):
        with pytest.raises(CarError) as told:
            read_car(car_file(tmp_path, line))
        assert said in str(told.value).replace("\n", " ")


def test_the_commands_say_it_in_one_line(tmp_path: Path) -> None:
    path = str(car_file(tmp_path, "tyre_damping_N_s_per_m = 200"))
    (tmp_path / "strut.net").write_text("spring k body wheel 25e3\ndamper c body wheel ?\n")
    words = (
        ["optimize", "--car", path, "--layout", "S1", "--index", "J3", "--json"],
        ["pareto", "--car", path, "--layout", "S1", "--out", str(tmp_path / "front")],
        ["network", str(tmp_path / "strut.net"), "--car", path, "--index", "J3"],
        ["evaluate", "--car", path, "--layout", "S2", "--index", "J1", "--case", "ideal",
         "--out", str(tmp_path / "out")],
    )  # fmt: skip
    for each in words:
        answer = CliRunner().invoke(app, each, catch_exceptions=False)
        told = " ".join(answer.output.split())
        assert answer.exit_code != 0, told
        assert "is infinite: with tyre_damping" in told
        assert "Traceback" not in told
    own = ["optimize", "--car", path, "--layout", "S1,S2", "--index", "J1w", "--json"]
    answer = CliRunner().invoke(app, own, catch_exceptions=False)
    rows = json.loads(answer.stdout)
    assert rows[1]["value"] < rows[0]["value"]


def test_a_diagnosis_says_that_it_does_not_drive_it(tmp_path: Path) -> None:
    path = car_file(tmp_path, "tyre_damping_N_s_per_m = 200")
    times = np.arange(0.0, 4.0, 2e-3)
    rows = [f"{t:.3f},{0.01 * math.sin(9 * t):.6g},{math.cos(5 * t):.6g}" for t in times]
    record = tmp_path / "run.csv"
    record.write_text("\n".join(["time,road,body_acceleration", *rows]))
    with pytest.raises(ValueError, match="its tyre has damping"):
        diagnose_model([record], path)
