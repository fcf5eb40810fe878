"""Wheel and body side by side in the world: right with the device, wrong with native armature."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
import pytest
from inerter.models import model_path
from inerter.reference import QuarterCar, ReferenceDevice
from shipped_runs import Array, compiled, configuration, error, path

TIMES = np.arange(0, 1.0 + 1e-9, 0.01)
START = 0.3


def siblings(data) -> list[float]:
    return [data.joint("body").qpos[0], data.joint("wheel").qpos[0]]


def nested(data) -> list[float]:
    wheel = data.joint("wheel").qpos[0]
    return [wheel + data.joint("travel").qpos[0], wheel]


def simulated(integrator: str, step: float) -> Array:
    model = compiled("quarter_car", "model_siblings.xml", integrator, step)
    return path(model, TIMES, siblings, velocities={"wheel": START})


@pytest.fixture(scope="module")
def truth() -> Array:
    car = QuarterCar(damping=3705.4, device=ReferenceDevice(inertance=128.57))
    found = car.simulate(
        lambda t: 0.0, TIMES, initial=[0, 0, 0, START], method="DOP853", rtol=1e-11, atol=1e-14
    )
    return np.column_stack([found.body_displacement, found.wheel_displacement])


def test_it_is_the_same_car() -> None:
    assert configuration("quarter_car", "model_siblings.xml", "strut") == configuration(
        "quarter_car", "model.xml", "strut"
    )
    here, there = (
        mujoco.MjModel.from_xml_path(str(model_path("quarter_car", file)))
        for file in ("model_siblings.xml", "model.xml")
    )
    for body in ("sprung", "unsprung"):
        assert here.body(body).mass[0] == there.body(body).mass[0]
    assert here.actuator("road").gainprm[0] == there.actuator("road").gainprm[0]


def test_rk4(truth: Array) -> None:
    """Fourth order, 1e-6 at half a millisecond: the damper is fast against the wheel."""
    errors = [error(simulated("RK4", step), truth) for step in (1e-3, 5e-4)]
    assert errors[1] < 1e-6
    assert errors[0] / errors[1] > 13


@pytest.mark.parametrize("integrator", ["Euler", "implicit", "implicitfast", "discrete"])
def test_first_order(integrator: str, truth: Array) -> None:
    errors = [error(simulated(integrator, step), truth) for step in (5e-4, 2.5e-4, 1.25e-4)]
    assert errors[2] < 0.01
    assert 1.8 < errors[1] / errors[2] < 2.2


def test_the_nested_car_moves_alike() -> None:
    """The same equations in other coordinates, under a road."""

    def road(t: float) -> float:
        return 0.03 * float(np.exp(-(((t - 0.3) / 0.1) ** 2)))

    rows = [
        path(compiled("quarter_car", file, "RK4", 1e-3), TIMES, read, controls={"road": road})
        for file, read in (("model_siblings.xml", siblings), ("model.xml", nested))
    ]
    # two RK4 solutions of one linear system: alike up to their rounding
    assert error(rows[0], rows[1]) < 1e-9


def test_native_armature_converges_to_something_else(truth: Array) -> None:
    """The engine keeps b on the diagonal and drops it between the branches."""

    def native(step: float) -> Array:
        spec: Any = mujoco.MjSpec.from_file(str(model_path("quarter_car", "model_siblings.xml")))
        spec.delete(spec.actuator("strut"))
        spec.delete(spec.sensor("strut"))
        for plugin in spec.plugins:
            spec.delete(plugin)
        strut = spec.tendon("strut")
        strut.armature, strut.damping[0], strut.stiffness[0] = 128.57, 3705.4, 120e3
        strut.springlength = [0.5, 0.5]
        spec.option.timestep = step
        return path(spec.compile(), TIMES, siblings, velocities={"wheel": START})

    coarse, fine = native(1e-3), native(5e-4)
    assert error(coarse, fine) < 1e-4
    assert error(fine, truth) > 0.1
