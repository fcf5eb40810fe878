"""One car file, three tellings: MuJoCo, Exudyn, and the equations by an adaptive solver."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import exudyn as exu
import numpy as np
import polars as pl
import pytest
from inerter.cars.equations import car_equations, heights, rising
from inerter.cars.exudyn_model import build_car
from inerter.cars.mjcf import car_mjcf
from inerter.cars.parts import CarParts
from inerter.cars.read import SHIPPED, shipped_car
from inerter.exudyn.model_parts import simulate
from inerter.simulate.run import run_model
from inerter.suspension.commands import app
from inerter.suspension.layouts import LAYOUTS
from inerter.suspension.quarter_car import QuarterCar
from scipy.integrate import solve_ivp
from typer.testing import CliRunner

TIMES = np.arange(0.0, 0.6, 2e-3)
BUMP = ((0.05, 60.0), (0.3, 300.0))
REBOUND = ((0.1, 300.0), (0.5, 900.0))


def bump(t: float, late: float = 0.0, height: float = 0.05) -> float:
    """50 mm by half a metre at 30 km/h."""
    x = 30.0 / 3.6 * (t - 0.05 - late)
    return 0.5 * height * (1.0 - np.cos(4.0 * np.pi * x)) if 0.0 <= x <= 0.5 else 0.0


def changed(kind: str, **values) -> CarParts:
    """A shipped car with other struts."""
    car = shipped_car(kind)
    front = replace(car.front, strut=replace(car.front.strut, **values))
    rear = car.rear and replace(car.rear, strut=replace(car.rear.strut, **values))
    return replace(car, front=front, rear=rear)


def tyres_damped(car: CarParts, damping: float) -> CarParts:
    """With damping of the front tyres [N s/m] and half of it at the rear."""
    rear = car.rear and replace(car.rear, tyre_damping=0.5 * damping)
    return replace(car, front=replace(car.front, tyre_damping=damping), rear=rear)


def cars() -> dict[str, CarParts]:
    tables = {"damping": 0.0, "damper_bump": BUMP, "damper_rebound": REBOUND}
    stops = {"bump_stop_gap": 0.015, "bump_stop_stiffness": 2e5}
    full = changed("full", motion_ratio=0.9, layout="S3", inertance=120.0)
    return {
        "quarter S2": shipped_car("quarter"),
        "quarter S6 tables": changed(
            "quarter", layout="S6", relaxation_stiffness=20e3, **tables, **stops
        ),
        "quarter SW7": changed(
            "quarter", layout="SW7", damper_stiffness=40e3, inerter_stiffness=20e3
        ),
        "quarter SR": changed(
            "quarter", layout="SR", relaxation_stiffness=90e3, inertance=0.0, **stops
        ),
        "quarter SW8": changed(
            "quarter",
            layout="SW8",
            relaxation_stiffness=120e3,
            damper_stiffness=40e3,
            inerter_stiffness=20e3,
        ),
        "half S5": changed("half", layout="S5", relaxation_stiffness=80e3, motion_ratio=0.8),
        "quarter S2 damped tyre": tyres_damped(shipped_car("quarter"), 400.0),
        "full S5 damped tyres": tyres_damped(
            changed("full", layout="S5", relaxation_stiffness=90e3), 600.0
        ),
        "half S4": changed("half", layout="S4", relaxation_stiffness=150e3, **stops),
        "full S3 bars": replace(full, front=replace(full.front, anti_roll_stiffness=20e3)),
    }


@pytest.mark.parametrize("name", list(cars()))
def test_three_tellings_of_a_car_agree(name: str, tmp_path: Path) -> None:
    car = cars()[name]
    equations = car_equations(car)
    roads = {
        road: (lambda t, late=0.2 * ("rear" in road), up=0.03 if "right" in road else 0.05:
               bump(t, late, up))
        for road in equations.roads
    }  # fmt: skip
    count, inverse = len(equations.names), np.linalg.inv(equations.mass)

    def rates(t: float, state: np.ndarray) -> np.ndarray:
        q, v = state[:count], state[count:]
        under = (each(roads, equations.roads, t) for each in (heights, rising))
        return np.append(v, inverse @ equations.forces(q, v, *under))

    truth = solve_ivp(
        rates, (0.0, TIMES[-1]), np.zeros(2 * count), t_eval=TIMES, method="RK45", rtol=1e-8,
        atol=1e-10, max_step=1e-3,
    ).y  # fmt: skip
    at = {each: truth[n] for n, each in enumerate(equations.names) if each not in equations.states}

    mbs = exu.SystemContainer().AddSystem()
    run = simulate(build_car(mbs, car, roads), float(TIMES[-1]), step=5e-4, write_period=2e-3)
    for each, values in at.items():
        found = np.interp(TIMES, run.time, run.displacement[each])
        assert found == pytest.approx(values, abs=1e-3 * np.abs(values).max()), each

    fine = np.arange(0.0, TIMES[-1] + 1e-3, 2e-4)
    table = {"time": fine} | {road: [drive(t) for t in fine] for road, drive in roads.items()}
    pl.DataFrame(table).write_csv(tmp_path / "road.csv")
    (tmp_path / "car.xml").write_text(car_mjcf(car))
    model = run_model(
        tmp_path / "car.xml", float(TIMES[-1]), control=tmp_path / "road.csv", timestep=2e-4,
        rate=500.0,
    )  # fmt: skip
    for each, values in at.items():
        found = np.interp(TIMES, model.time, model.joints[each])
        assert found == pytest.approx(values, abs=3e-3 * np.abs(values).max()), each
    for n, road in enumerate(equations.roads):
        pressed = model.vehicle[road.replace("road", "tyre_force")]
        _, _, load = equations.tyres[n]
        expected = np.array([
            equations.tyre_forces(
                truth[:count, i], heights(roads, equations.roads, t), truth[count:, i],
                rising(roads, equations.roads, t),
            )[n]
            for i, t in enumerate(TIMES)
        ])  # fmt: skip
        # the table has the road itself, whatever the tyre takes of its rate
        under = np.array([roads[road](t) for t in TIMES])
        assert np.interp(TIMES, model.time, model.vehicle[road]) == pytest.approx(under, abs=1e-6)
        assert np.interp(TIMES, model.time, pressed) == pytest.approx(
            expected, abs=0.01 * np.abs(expected).max()
        )
        # it did leave the road
        assert expected.min() == -load or not name.startswith("quarter")


def behind(layout: str, draw: np.random.Generator) -> dict[str, float]:
    """A drawn strut whose damper is behind a relaxation spring, by the keys of a car."""
    size = draw.uniform
    values = {"relaxation_stiffness": 1e3 * size(40, 300), "damping": size(800, 4000)}
    if layout != "SR":
        values["inertance"] = size(20, 300)
    if layout == "SW8":
        values |= {"damper_stiffness": 1e3 * size(5, 60), "inerter_stiffness": 1e3 * size(5, 40)}
    return values


def transfer(car: CarParts, s: complex) -> complex:
    """Body over road at s, from the networks of the linear study."""
    strut = car.front.strut
    more: dict[str, Any] = {}
    kb, k1, k2 = strut.relaxation_stiffness, strut.damper_stiffness, strut.inerter_stiffness
    if strut.layout == "SW8":
        # the share that both springs carry without k_b, and their ratio
        more = {"centring_share": k1 * k2 / (k1 + k2) / strut.stiffness, "centring_ratio": k1 / k2}
    network = LAYOUTS[strut.layout].stiffness(
        strut.stiffness, strut.damping, strut.inertance, kb, **more
    )
    linear = QuarterCar(
        sprung_mass=car.body_mass,
        unsprung_mass=car.front.wheel_mass,
        tyre_stiffness=car.front.tyre_stiffness,
    )
    return complex(np.squeeze(linear.body_per_road(network)(s)))


@pytest.mark.parametrize("layout", ["SR", "S5", "SW8"])
def test_a_damper_behind_a_spring_has_the_networks_transfer_function(
    layout: str, effects_seed: int
) -> None:
    """Of the equations exactly; of Exudyn over five periods of a sine, begun on its orbit."""
    draw = np.random.default_rng([effects_seed, len(layout)])
    car = changed("quarter", layout=layout, **{"inertance": 0.0, **behind(layout, draw)})
    equations = car_equations(car)
    count, none = len(equations.names), np.zeros(len(equations.names))
    road = np.zeros(len(equations.roads))

    def forces(q: np.ndarray, v: np.ndarray, height: float = 0.0) -> np.ndarray:
        return equations.forces(q, v, road + height)

    # linear as long as the tyre does not lift; its force is divided out of the small unit
    unit = 1e-4 * np.eye(count)
    k, c = (np.array([forces(*pair) for pair in pairs]).T / -1e-4 for pairs in (
        [(one, none) for one in unit], [(none, one) for one in unit],
    ))  # fmt: skip
    column = forces(none, none, 1e-4) / 1e-4
    for frequency in (1.0, 4.0, 12.0):
        s = 2j * np.pi * frequency
        orbit = np.linalg.solve(equations.mass * s**2 + c * s + k, column)
        expected = transfer(car, s)
        assert orbit[0] == pytest.approx(expected, rel=1e-9)

    # the last orbit again in Exudyn: begun on it, it stays on it
    height = 1e-3
    for solver, most in (("RK44", 1e-6), ("GeneralizedAlpha", 2e-3)):
        mbs = exu.SystemContainer().AddSystem()
        model = build_car(mbs, car, {"road": lambda t: height * float(np.sin(s.imag * t))})
        node = model.coordinates["heave"][0]
        mbs.SetNodeParameter(node, "initialCoordinates", list(height * orbit.imag))
        mbs.SetNodeParameter(node, "initialCoordinates_t", list(height * (s * orbit).imag))
        run = simulate(model, 5.0 / 12.0, step=2e-4, write_period=1e-3, solver=solver)
        assert "relaxation" not in run.displacement
        exact = height * (expected * np.exp(s * run.time)).imag
        assert run.displacement["heave"] == pytest.approx(exact, abs=most * height * abs(expected))


def test_a_damper_table_behind_a_spring_is_refused() -> None:
    tables = {"damping": 0.0, "damper_bump": BUMP, "damper_rebound": REBOUND}
    car = changed("quarter", layout="SR", relaxation_stiffness=2e5, inertance=0.0, **tables)
    for telling in (car_equations, car_mjcf):
        with pytest.raises(ValueError, match="layout SR: its damper is behind a relaxation spring"):
            telling(car)


def test_the_command_writes_models_that_run(tmp_path: Path) -> None:
    written = CliRunner().invoke(app, ["model", str(SHIPPED / "half.toml"), "--out", str(tmp_path)])
    assert written.exit_code == 0, written.output
    assert run_model(tmp_path / "model.xml", 0.05).vehicle["road_rear"].max() == 0.0
    done = subprocess.run(
        [sys.executable, str(tmp_path / "model.py")], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    lines = [line for line in done.stdout.splitlines() if line.startswith(("heave", "wheel_front"))]
    assert len(lines) == 2


@pytest.mark.parametrize("spring", [300, 300_000])
def test_the_command_writes_exudyns_model_of_a_relaxation_spring(
    spring: int, tmp_path: Path
) -> None:
    """Stiff ones too, which steps of 1 ms cannot follow explicitly; then it is as without."""
    peaks = {}
    for layout in ("S3", "S5"):
        text = (SHIPPED / "quarter.toml").read_text().replace('"S2"', f'"{layout}"')
        more = f"relaxation_stiffness_kN_per_m = {spring}\n" if layout == "S5" else ""
        (tmp_path / "car.toml").write_text(text + more)
        out = tmp_path / layout
        words = ["model", str(tmp_path / "car.toml"), "--out", str(out)]
        written = CliRunner().invoke(app, words)
        assert written.exit_code == 0, written.output
        done = subprocess.run(
            [sys.executable, str(out / "model.py")], capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stderr
        line = next(x for x in done.stdout.splitlines() if x.startswith("heave"))
        peaks[layout] = float(line.split()[-1])
    same = abs(peaks["S5"] / peaks["S3"] - 1.0) < 1e-3
    assert same == (spring > 300)


def test_the_command_says_what_exudyn_lacks(tmp_path: Path) -> None:
    (tmp_path / "device.toml").write_text('[device]\ninertance = "60 kg"\nfriction = "coulomb"\n'
                                          'coulomb_force = "8 N"\n')  # fmt: skip
    text = (SHIPPED / "quarter.toml").read_text()
    (tmp_path / "car.toml").write_text(text + 'device = "device.toml"\n')
    words = ["model", str(tmp_path / "car.toml"), "--out", str(tmp_path / "other")]
    written = CliRunner().invoke(app, words)
    assert written.exit_code == 0, written.output
    assert "No model.py: device: friction, play and shafts" in written.output
    assert not (tmp_path / "other" / "model.py").exists()
