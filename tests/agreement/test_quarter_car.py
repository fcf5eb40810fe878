"""The MuJoCo quarter-car and the reference ODE, written apart, move alike."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree

import mujoco
import numpy as np
import pytest
from inerter.models import model_path
from inerter.reference import QuarterCar, ReferenceDevice

DURATION, START = 2.0, 0.3

# layout: damping [N s/m], inertance [kg] of the shipped models (Wang & Su, Table 1)
LAYOUTS = {"S1": (4981.0, 0.0), "S2": (3705.4, 128.57), "S3": (7544.2, 366.52)}
FRICTION = {
    "none": {},
    "coulomb": {"coulomb_force": 60.0, "transition_velocity": 2e-2},
    "stribeck": {"coulomb_force": 60.0, "static_force": 90.0, "stribeck_velocity": 0.1,
                 "transition_velocity": 2e-2},
    "brown_mcphee": {"coulomb_force": 60.0, "static_force": 90.0, "stribeck_velocity": 0.1},
    "dahl": {"coulomb_force": 60.0, "bristle_stiffness": 3e4},
    "lugre": {"coulomb_force": 60.0, "static_force": 90.0, "stribeck_velocity": 0.1,
              "bristle_stiffness": 3e4, "bristle_damping": 100.0},
    "bouc_wen": {"bw_stiffness": 3e4, "bw_beta": 400.0, "bw_gamma": 100.0},
}  # fmt: skip


def road(time: float) -> float:
    """A bump of 30 mm, smooth."""
    return 0.03 * np.exp(-(((time - 0.5) / 0.12) ** 2))


def simulated(file: str, integrator: str, step: float, **config: str | float) -> np.ndarray:
    """Body and wheel displacement [m] every 10 ms, shape (n, 2)."""
    root = ElementTree.parse(model_path("quarter_car", file)).getroot()
    option = root.find("option")
    assert option is not None
    option.attrib.update(timestep=repr(step), integrator=integrator)
    instance = root.find("extension/plugin/instance")
    if config and instance is not None:
        for key, value in config.items():
            ElementTree.SubElement(instance, "config", key=key, value=str(value))
        plugin = root.find("actuator/plugin")
        assert plugin is not None
        if config.get("friction") in ("dahl", "lugre", "bouc_wen"):
            plugin.set("actdim", "1")
    model = mujoco.MjModel.from_xml_string(ElementTree.tostring(root, encoding="unicode"))
    data = mujoco.MjData(model)
    data.joint("wheel").qvel = START
    data.joint("travel").qvel = -START  # the body is at rest
    every, rows = round(0.01 / step), []
    for i in range(round(DURATION / step) + 1):
        if i % every == 0:
            wheel = data.joint("wheel").qpos[0]
            rows.append([wheel + data.joint("travel").qpos[0], wheel])
        data.actuator("road").ctrl = road(data.time + 0.5 * step)
        mujoco.mj_step(model, data)
    return np.array(rows)


def reference(layout: str, **friction: str | float) -> np.ndarray:
    damping, inertance = LAYOUTS[layout]
    device = ReferenceDevice(inertance=inertance, **friction)  # type: ignore[arg-type]
    car = QuarterCar(layout=layout, damping=damping, device=device)
    state = np.zeros(car.nstate)
    state[3] = START
    times = np.arange(0, DURATION + 1e-9, 0.01)
    found = car.simulate(road, times, initial=state, rtol=1e-10, atol=1e-13)
    return np.column_stack([found.body_displacement, found.wheel_displacement])


def error(found: np.ndarray, true: np.ndarray) -> float:
    return float(np.max(np.abs(found - true)) / np.max(np.abs(true)))


@pytest.mark.often("S2")
@pytest.mark.parametrize("layout", LAYOUTS)
def test_layouts(layout: str) -> None:
    """RK4; the road is held over a step at its middle, which is an error of second order."""
    truth = reference(layout)
    file = "model.xml" if layout == "S2" else f"model_{layout.lower()}.xml"
    errors = [error(simulated(file, "RK4", step), truth) for step in (1e-3, 5e-4)]
    assert errors[1] < 1e-5
    assert errors[0] / errors[1] > 3.5


@pytest.mark.often("dahl")
@pytest.mark.parametrize("law", [law for law in FRICTION if law != "none"])
def test_laws(law: str) -> None:
    friction = {"friction": law, **FRICTION[law]}
    truth = reference("S2", **friction)
    assert error(simulated("model.xml", "RK4", 5e-4, **friction), truth) < 2e-5


@pytest.mark.often("implicitfast")
@pytest.mark.parametrize("integrator", ["Euler", "implicit", "implicitfast", "discrete"])
def test_single_step_integrators_converge_in_first_order(integrator: str) -> None:
    friction = {"friction": "lugre", **FRICTION["lugre"]}
    truth = reference("S2", **friction)
    errors = [
        error(simulated("model.xml", integrator, step, **friction), truth)
        for step in (5e-4, 2.5e-4, 1.25e-4)
    ]
    assert errors[2] < 0.03
    assert 1.7 < errors[0] / errors[1] < 2.4
    assert 1.7 < errors[1] / errors[2] < 2.4
