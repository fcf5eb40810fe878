"""A tyre presses and does not pull: the reference, MuJoCo and Exudyn on the same bump."""

from __future__ import annotations

import exudyn as exu
import numpy as np
import pytest
from inerter.exudyn.model_parts import simulate
from inerter.model_parameters import QUARTER_CAR
from inerter.models import exudyn_model, model_path
from inerter.reference import QuarterCar, ReferenceDevice
from inerter.simulate.run import run_model
from inerter.simulate.tyres import static_loads
from inerter.suspension.quarter_car import QuarterCar as LinearCar
from inerter.suspension.time_domain.cases import CASES
from inerter.suspension.time_domain.model import Design, compiled
from inerter.suspension.time_domain.road import PeriodicRoad, iso_road
from inerter.suspension.time_domain.simulate import RunSettings, road_indices
from inerter.suspension.vehicle.cars import half_car
from numpy.typing import NDArray

Array = NDArray[np.float64]
LOAD = 9.81 * (QUARTER_CAR.sprung_mass + QUARTER_CAR.unsprung_mass)
TIMES = np.arange(0.0, 0.6, 2e-3)
SPEED = 30.0 / 3.6


def bump(t: float) -> float:
    """50 mm high, half a metre long, at 30 km/h."""
    x = SPEED * t
    return 0.025 * (1.0 - np.cos(2.0 * np.pi * x / 0.5)) if 0.0 <= x <= 0.5 else 0.0


def reference(static_load: float = np.inf):
    strut = QUARTER_CAR.struts["S2"]
    car = QuarterCar(
        damping=strut.damping, device=ReferenceDevice(inertance=strut.inertance),
        static_load=static_load,
    )  # fmt: skip
    return car.simulate(bump, TIMES, method="DOP853", max_step=1e-3)


def test_a_car_in_the_air_falls_freely() -> None:
    """Off the road nothing but weight acts: the centre of mass falls with g, whatever the strut."""
    run, pulled = reference(LOAD), reference()
    assert pulled.tyre_force.max() > 1.5 * LOAD
    assert run.tyre_force.max() == LOAD
    air = run.tyre_force == LOAD
    assert 0.05 < air.mean() < 0.5
    ms, mu = QUARTER_CAR.sprung_mass, QUARTER_CAR.unsprung_mass
    centre = (ms * run.body_acceleration + mu * run.wheel_acceleration) / (ms + mu)
    assert centre[air] == pytest.approx(-9.81, rel=1e-9)
    assert centre[~air].min() > -9.81
    # on the ground it is the linear tyre
    before = TIMES < 0.03
    assert run.body_displacement[before] == pytest.approx(pulled.body_displacement[before])


def test_exudyn_leaves_the_road_as_the_reference_does() -> None:
    mbs = exu.SystemContainer().AddSystem()
    model = exudyn_model("quarter_car").build(mbs, inputs={"road": bump}, static_load=LOAD)
    run = simulate(model, float(TIMES[-1]), step=2e-4, write_period=2e-3)
    truth = reference(LOAD)
    for name, values in (("body", truth.body_displacement), ("wheel", truth.wheel_displacement)):
        found = np.interp(TIMES, run.time, run.displacement[name])
        assert found == pytest.approx(values, abs=1e-4 * np.abs(values).max())


def by_hand(layout: str, c: float, b: float, road: PeriodicRoad) -> tuple[Array, Array]:
    """Tyre force [N] and travel [m] over a period of the road, by Runge-Kutta steps of 1 ms."""
    ms, mu, kt, k = 181.75, 25.0, 120e3, 120e3
    fine = np.arange(-1.0, 10.0, 5e-4)
    heights = np.concatenate([road.at(part, 3) for part in np.array_split(fine, 40)])
    heights *= 0.5 - 0.5 * np.cos(np.pi * np.minimum(fine + 1.0, 1.0))

    def rates(x: Array, z: float) -> Array:
        zs, zu, vs, vu, w = x
        tyre = min(kt * (zu - z), LOAD)
        if layout == "S3":
            through = c * (vs - vu - w)
            u = k * (zs - zu) + through
            return np.array([vs, vu, -u / ms, (u - tyre) / mu, through / b])
        # u holds b times the relative acceleration that it causes
        known = k * (zs - zu) + c * (vs - vu)
        u = (known + b * tyre / mu) / (1.0 + b * (1.0 / ms + 1.0 / mu))
        return np.array([vs, vu, -u / ms, (u - tyre) / mu, 0.0])

    x, h, rows = np.zeros(5), 1e-3, []
    for n in range(0, fine.size - 2, 2):
        rows.append((min(kt * (x[1] - heights[n]), LOAD), x[0] - x[1]))
        r1 = rates(x, heights[n])
        r2 = rates(x + 0.5 * h * r1, heights[n + 1])
        r3 = rates(x + 0.5 * h * r2, heights[n + 1])
        r4 = rates(x + h * r3, heights[n + 2])
        x = x + h / 6.0 * (r1 + 2.0 * r2 + 2.0 * r3 + r4)
    force, travel = np.array(rows[1000:]).T
    return force, travel


@pytest.mark.parametrize("layout", ["S2", "S3"])
def test_evaluate_leaves_the_road_as_equations_by_hand_do(layout: str) -> None:
    strut = QUARTER_CAR.struts[layout]
    design = Design(120e3, strut.damping, strut.inertance)
    road, settings = iso_road("E", 10.0), RunSettings(settle=1.0, jobs=1)
    models = [compiled(layout, CASES["ideal"], one_sided=way) for way in (True, False)]
    found, pulled = (road_indices(car, [design], road, [3], settings) for car in models)
    assert found["lift_off"][0, 0] > 0.02
    assert pulled["lift_off"][0, 0] > 0.0
    assert found["J3"][0, 0] < 0.99 * pulled["J3"][0, 0]

    force, travel = by_hand(layout, strut.damping, strut.inertance, road)
    air = force >= LOAD
    assert found["J3"][0, 0] == pytest.approx(np.sqrt(np.mean(force**2)), rel=5e-3)
    assert found["tyre_peak"][0, 0] == pytest.approx(-force.min(), rel=0.02)
    assert found["lift_off"][0, 0] == pytest.approx(np.mean(air), abs=2e-3)
    assert found["travel_rms"][0, 0] == pytest.approx(np.sqrt(np.mean(travel**2)), rel=5e-3)
    assert found["travel_peak"][0, 0] == pytest.approx(np.abs(travel).max(), rel=0.01)


def test_static_loads_are_the_weight() -> None:
    quarter = run_model(model_path("quarter_car", "model.xml"), 0.01)
    assert static_loads(quarter.model) == pytest.approx({"road": LOAD})
    assert LinearCar().static_load == pytest.approx(LOAD)
    half = run_model(model_path("half_car", "model.xml"), 0.01)
    front, rear = half_car().static_loads
    assert static_loads(half.model) == pytest.approx({"road_front": front, "road_rear": rear})
    assert front + rear == pytest.approx(9.81 * (730.0 + 75.5))
    full = run_model(model_path("full_car", "model.xml"), 0.01)
    assert static_loads(full.model) == pytest.approx(
        {
            f"road_{axle}_{side}": load
            for axle, load in (("front", front), ("rear", rear))
            for side in ("left", "right")
        }
    )
