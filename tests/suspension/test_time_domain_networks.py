"""Devices in every layout and car, against exact values and an adaptive solver."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from inerter.cars.read import CarError, read_car
from inerter.suspension.commands import app
from inerter.suspension.quarter_car import QuarterCar
from inerter.suspension.time_domain.cases import CASES
from inerter.suspension.time_domain.linear import linear_gains
from inerter.suspension.time_domain.model import Car, Design, car_parts, compiled
from inerter.suspension.time_domain.resolution import on_sinusoids
from inerter.suspension.time_domain.road import iso_road, paper_road
from inerter.suspension.time_domain.simulate import RunSettings, load_gains, road_indices
from inerter.suspension.vehicle.cars import full_car, half_car
from scipy.integrate import solve_ivp
from typer.testing import CliRunner

LONG = pytest.mark.long
STRUT = {
    "S4": Design(120e3, 3705.4, 128.57, relaxation_stiffness=1e6),
    "S5": Design(120e3, 7544.2, 366.52, relaxation_stiffness=3e5),
    "S6": Design(120e3, 4000.0, 300.0, relaxation_stiffness=3e4),
    "SR": Design(120e3, 4000.0, relaxation_stiffness=3e5),
    "SW7": Design(120e3, 6000.0, 300.0, centring_share=0.1, centring_ratio=0.5),
    "SW8": Design(
        120e3, 6000.0, 300.0, relaxation_stiffness=5e5, centring_share=0.1, centring_ratio=0.5
    ),
}
RUNS = RunSettings(settle=12.0, jobs=2)


def against_exact(layout: str, case: str, design: Design, car: Car) -> np.ndarray:
    """J1 and J3 on two roads over what the same sinusoids give exactly."""
    model = compiled(layout, CASES[case], car, design=design)
    road = paper_road().refined(2)
    found = road_indices(model, [design], road, [1, 2], RUNS)
    pair = CASES[case].pair
    exact = [on_sinusoids(name, layout, design, pair, car, road) for name in ("J1", "J3")]
    return np.array([found[n].mean() / x for n, x in zip(("J1", "J3"), exact, strict=True)])


@pytest.mark.parametrize("layout", STRUT)
def test_every_network_is_the_exact_one(layout: str) -> None:
    found = against_exact(layout, "ideal", STRUT[layout], QuarterCar())
    # the slow mode of SW7 and SW8 rings longest
    assert found == pytest.approx(1.0, rel=4e-3 if layout.startswith("SW") else 1e-3)


@pytest.mark.parametrize("layout", ["S6", *(pytest.param(n, marks=LONG) for n in ("S4", "S5"))])
def test_a_shaft_inside_a_network_is_exact(layout: str) -> None:
    assert against_exact(layout, "elastic", STRUT[layout], QuarterCar()) == pytest.approx(
        1.0, rel=3e-3
    )


@pytest.mark.parametrize("layout", STRUT)
def test_loads_are_carried_exactly(layout: str) -> None:
    f, design = np.array([[0.7, 1.9, 4.1, 9.0]]), STRUT[layout]
    model = compiled(layout, CASES["ideal"], design=design)
    found = load_gains(model, [design], f, settings=RunSettings(settle=25.0, jobs=2))
    values = np.array([[[design.damping, design.inertance]]])
    exact = linear_gains(layout, design, values, None, QuarterCar(), f)
    assert found == pytest.approx(exact, rel=2e-3)
    still = model.static_compliance(design)
    slow = linear_gains(layout, design, values, None, QuarterCar(), np.array([[1e-4]]))[0, 0]
    assert still == pytest.approx(slow, rel=1e-4)


@pytest.mark.parametrize(
    ("make", "layout"),
    [(half_car, "S6"), (full_car, "S2"), pytest.param(full_car, "S5", marks=LONG)],
)
def test_cars_of_two_axles_are_exact(make, layout: str) -> None:
    own = {"S2": (1500.0, 30.0, None), "S5": (1500.0, 250.0, 2e5), "S6": (1300.0, 150.0, 8e3)}
    c, b, kb = own[layout]
    front = Design(2e4, c, b, relaxation_stiffness=kb)
    design = replace(front, rear=replace(front, stiffness=17e3, damping=0.8 * c))
    assert against_exact(layout, "ideal", design, make()) == pytest.approx(1.0, rel=1.5e-3)


@pytest.mark.parametrize("level", [0.0, 100.0])
def test_friction_inside_s6_against_an_adaptive_solver(level: float) -> None:
    """Friction beside the inertance of S6: b y'' + f(y') = c (x' - y') + k_b (x - y)."""
    design = replace(STRUT["S6"], parameters={"coulomb_force": max(level, 1e-9)})
    model = compiled("S6", CASES["friction"], design=design)
    car, frequency, amplitude = QuarterCar(), 2.3, 300.0
    found = load_gains(
        model, [design], [[frequency]], amplitude, RunSettings(step=5e-4, settle=12.0, jobs=1)
    )[0, 0]
    k, c, b, kb = design.stiffness, design.damping, design.inertance, 3e4
    width = CASES["friction"].parameters["transition_velocity"]
    turn = 2.0 * np.pi * frequency

    def rates(t: float, s: np.ndarray) -> list[float]:
        zs, zu, y, vs, vu, w = s
        inner = c * (vs - vu - w) + kb * (zs - zu - y)
        force = k * (zs - zu) + inner
        drive = amplitude * np.sin(turn * t)
        return [
            vs, vu, w,
            (drive - force) / car.sprung_mass,
            (force - car.tyre_stiffness * zu) / car.unsprung_mass,
            (inner - level * np.tanh(w / width)) / b,
        ]  # fmt: skip

    end = 30.0 / frequency
    times = np.linspace(end - 6.0 / frequency, end, 6001)
    truth = solve_ivp(rates, (0.0, end), np.zeros(6), "LSODA", times, rtol=1e-8, atol=1e-11)
    expected = np.sqrt(np.mean(truth.y[0, :-1] ** 2) / (0.5 * amplitude**2))
    assert found == pytest.approx(expected, rel=1e-3)
    if level:
        frictionless = linear_gains(
            "S6", design, np.array([[[c, b]]]), None, car, np.array([[frequency]])
        )
        assert abs(found / frictionless[0, 0] - 1.0) > 4e-3, "it is felt"


def test_springs_that_are_rigid_or_absent_leave_a_smaller_layout() -> None:
    s2 = Design(120e3, 3705.4, 128.57)
    rigid = replace(s2, relaxation_stiffness=float("inf"))
    case = CASES["friction"]
    assert car_parts(QuarterCar(), "S4", case, rigid) == car_parts(QuarterCar(), "S2", case, s2)
    bare = replace(s2, centring_share=0.0, centring_ratio=1.0)
    assert car_parts(QuarterCar(), "SW7", case, bare) == car_parts(QuarterCar(), "S3", case, s2)


def test_the_full_car_without_correlation_is_its_two_sides() -> None:
    """Roads of both sides alike: the half-car of a side, whatever the roll inertia."""
    full = replace(full_car(), correlation=1.0)
    front = Design(2e4, 1500.0, 30.0)
    design = replace(front, rear=replace(front, stiffness=17e3))
    settings = RunSettings(settle=2.0, jobs=2)
    case, road = CASES["friction"], iso_road("B")
    one = road_indices(compiled("S2", case, full.side), [design], road, [1, 2], settings)
    both = road_indices(compiled("S2", case, full), [design], road, [1, 2], settings)
    for name in ("J1", "J3", "travel_rms"):
        assert both[name] == pytest.approx(one[name], rel=1e-6), name


def test_the_command_puts_a_device_into_any_network(tmp_path: Path) -> None:
    (tmp_path / "device.toml").write_text(
        '[device]\ninertance = "60 kg"\nfriction = "coulomb"\ncoulomb_force = "20 N"\n'
    )
    (tmp_path / "car.toml").write_text(CAR)
    answer = CliRunner().invoke(
        app,
        f"evaluate --car {tmp_path / 'car.toml'} --layout S3,S6 --index J1 --road iso:B --seeds 2 "
        f"--device {tmp_path / 'device.toml'} --case device --json --out {tmp_path}",
        catch_exceptions=False,
    )
    assert answer.exit_code == 0, answer.output
    rows = json.loads(answer.stdout)["rows"]
    assert [row["inertance"] for row in rows] == [60.0, 60.0]
    assert rows[1]["relaxation_stiffness"] > 0.0
    # a network that contains another is no worse by much, and friction is felt
    assert rows[1]["value"] < 1.01 * rows[0]["value"]
    assert all(row["value"] != pytest.approx(row["linear"], rel=1e-4) for row in rows)


CAR = """
[car]
kind = "quarter"
body_mass_kg = 320
[front]
wheel_mass_kg = 42
tyre_stiffness_kN_per_m = 210
[front.strut]
stiffness_kN_per_m = 25
damping_N_s_per_m = 1700
"""


def test_a_car_file_names_the_device_of_its_strut(tmp_path: Path) -> None:
    (tmp_path / "rack.toml").write_text(
        '[device]\ninertance = "60 kg"\nfriction = "dahl"\ncoulomb_force = "20 N"\n'
        'bristle_stiffness = "1e5 N/m"\n'
    )
    path = tmp_path / "car.toml"
    path.write_text(CAR + 'layout = "S2"\ndevice = "rack.toml"\n')
    strut = read_car(path).front.strut
    assert strut.inertance == 60.0
    assert dict(strut.device)["coulomb_force"] == 20.0
    values = []
    for more in ('device = "rack.toml"', "inertance_kg = 60"):
        path.write_text(CAR + f'layout = "S2"\n{more}\n')
        answer = CliRunner().invoke(
            app,
            f"evaluate --car {path} --layout own --road iso:B --seeds 2 --json --out {tmp_path}",
            catch_exceptions=False,
        )
        assert answer.exit_code == 0, answer.output
        values.append(json.loads(answer.stdout)["figures"]["J1"]["value"])
    assert values[0] != pytest.approx(values[1], rel=1e-3)
    path.write_text(CAR + 'layout = "SR"\nrelaxation_stiffness_kN_per_m = 90\ndevice = "rack.toml"')
    with pytest.raises(CarError, match="layout SR has no inerter"):
        read_car(path)
    path.write_text(CAR + 'layout = "S2"\ndevice = "none.toml"')
    with pytest.raises(CarError, match=r"device = 'none.toml'.*none\.toml"):
        read_car(path)
