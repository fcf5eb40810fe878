"""One car file, three tellings: MuJoCo, Exudyn, and the equations by an adaptive solver."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import exudyn as exu
import numpy as np
import polars as pl
import pytest
from inerter.cars.equations import car_equations, heights
from inerter.cars.exudyn_model import build_car
from inerter.cars.mjcf import car_mjcf
from inerter.cars.parts import CarParts
from inerter.cars.read import SHIPPED, shipped_car
from inerter.exudyn.model_parts import simulate
from inerter.simulate.run import run_model
from inerter.suspension.commands import app
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
        return np.append(v, inverse @ equations.forces(q, v, heights(roads, equations.roads, t)))

    truth = solve_ivp(
        rates, (0.0, TIMES[-1]), np.zeros(2 * count), t_eval=TIMES, method="RK45", rtol=1e-8,
        atol=1e-10, max_step=1e-3,
    ).y  # fmt: skip
    at = {each: truth[n] for n, each in enumerate(equations.names)}

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
        place, kt, load = equations.tyres[n]
        under = np.array([roads[road](t) for t in TIMES])
        expected = np.maximum(kt * (under - truth[place]), -load)
        assert np.interp(TIMES, model.time, pressed) == pytest.approx(
            expected, abs=0.01 * np.abs(expected).max()
        )
        # it did leave the road
        assert expected.min() == -load or not name.startswith("quarter")


def test_a_damper_behind_a_spring_is_said_to_be_mujocos() -> None:
    with pytest.raises(ValueError, match="layout SR: its damper is behind a relaxation spring"):
        car_equations(changed("quarter", layout="SR", relaxation_stiffness=2e5, inertance=0.0))


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
    text = (SHIPPED / "quarter.toml").read_text().replace('"S2"', '"S5"')
    (tmp_path / "car.toml").write_text(text + "relaxation_stiffness_kN_per_m = 300\n")
    words = ["model", str(tmp_path / "car.toml"), "--out", str(tmp_path / "other")]
    written = CliRunner().invoke(app, words)
    assert written.exit_code == 0, written.output
    assert "No model.py" in written.output
    assert not (tmp_path / "other" / "model.py").exists()
