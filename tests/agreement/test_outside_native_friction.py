"""MuJoCo's own armature and motor friction against the Exudyn element and the reference.

`armature` on a tendon between nested bodies is an exact inerter, `dcmotor lugre` a LuGre friction
(MuJoCo 4.0, XML reference, actuator/dcmotor). Nothing of this project takes part in the MuJoCo run:
the two other tellings are held against what the engine's authors wrote. The plugin is held against
it in `tests/plugin/test_native_agreement.py`.
"""

from __future__ import annotations

import functools
from typing import Any

import mujoco
import numpy as np
import pytest
from inerter.reference import QuarterCar, ReferenceDevice
from numpy.typing import NDArray

Array = NDArray[np.float64]

SPRUNG, UNSPRUNG, TYRE = 181.75, 25.0, 120e3
SPRING, DAMPER, INERTANCE, VISCOUS = 60e3, 1500.0, 113.0, 300.0
LUGRE: dict[str, Any] = {
    "friction": "lugre",
    "bristle_stiffness": 5e4,
    "bristle_damping": 200.0,
    "coulomb_force": 80.0,
    "static_force": 120.0,
    "stribeck_velocity": 0.05,
}
DEVICES: dict[str, dict[str, Any]] = {"smooth": {}, "lugre": LUGRE}
KERB = 0.3  # the wheel's velocity at the start [m/s]
TIMES = np.linspace(0, 0.4, 101)


@functools.cache
def native(friction: str, step: float) -> Array:
    """Rows (z_u, z_s, z_u', z_s') of the engine's own elements under RK4."""
    force = ""
    if friction == "lugre":
        numbers = " ".join(str(value) for value in list(LUGRE.values())[1:])
        force = f'input="none" motorconst="0 0" resistance="1" lugre="{numbers}"'
    kind = "dcmotor" if force else "general"
    model = mujoco.MjModel.from_xml_string(f"""
    <mujoco>
      <option gravity="0 0 0" timestep="{step}" integrator="RK4"/>
      <worldbody>
        <body name="unsprung">
          <joint name="wheel" type="slide" axis="0 0 1" stiffness="{TYRE}"/>
          <inertial pos="0 0 0" mass="{UNSPRUNG}" diaginertia="1 1 1"/>
          <body name="sprung">
            <joint name="travel" type="slide" axis="0 0 1"/>
            <inertial pos="0 0 0" mass="{SPRUNG}" diaginertia="1 1 1"/>
          </body>
        </body>
      </worldbody>
      <tendon>
        <fixed name="strut" stiffness="{SPRING}" damping="{DAMPER + VISCOUS}">
          <joint joint="travel" coef="1"/>
        </fixed>
      </tendon>
      <actuator><{kind} tendon="strut" armature="{INERTANCE}" {force}/></actuator>
    </mujoco>""")
    assert model.nplugin == 0
    data = mujoco.MjData(model)
    data.qvel[:] = KERB, -KERB
    rows = [np.concatenate([data.qpos, data.qvel])]
    for _ in TIMES[1:]:
        mujoco.mj_step(model, data, round(TIMES[1] / step))
        rows.append(np.concatenate([data.qpos, data.qvel]))
    wheel, travel, speed, rate = np.array(rows).T
    return np.array([wheel, wheel + travel, speed, speed + rate]).T


def in_exudyn(friction: str) -> Array:
    """The same rows from the element under RK67, on Node1D and Mass1D."""
    exu: Any = pytest.importorskip("exudyn")
    items: Any = pytest.importorskip("exudyn.itemInterface")
    from inerter.exudyn import CreateInerter

    mbs = exu.SystemContainer().AddSystem()
    nodes = [
        mbs.AddNode(items.Node1D(referenceCoordinates=[0.0], initialVelocities=[speed]))
        for speed in (KERB, 0.0)
    ]
    for node, mass in zip(nodes, (UNSPRUNG, SPRUNG), strict=True):
        mbs.AddObject(items.Mass1D(nodeNumber=node, mass=mass))
    ground, wheel, body = (
        mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=0))
        for node in (mbs.AddNode(items.NodePointGround()), *nodes)
    )
    tyre, strut = ([ground, wheel], TYRE, 0.0), ([wheel, body], SPRING, DAMPER)
    for markers, stiffness, damping in (tyre, strut):
        mbs.AddObject(
            items.CoordinateSpringDamper(
                markerNumbers=markers, stiffness=stiffness, damping=damping
            )
        )
    CreateInerter(
        mbs,
        name="strut",
        itemNumbers=nodes,
        inertance=INERTANCE,
        viscous=VISCOUS,
        **DEVICES[friction],
    )
    sensors = [
        mbs.AddSensor(
            items.SensorNode(
                nodeNumber=node,
                outputVariableType=getattr(exu.OutputVariableType, kind),
                storeInternal=True,
                writeToFile=False,
            )
        )
        for kind in ("Coordinates", "Coordinates_t")
        for node in nodes
    ]
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = TIMES[1]
    settings.timeIntegration.endTime = TIMES[-1]
    settings.timeIntegration.numberOfSteps = 4 * 1000
    settings.timeIntegration.automaticStepSize = False
    assert mbs.SolveDynamic(settings, solverType=exu.DynamicSolverType.RK67)
    stored = [np.array(mbs.GetSensorStoredData(sensor)) for sensor in sensors]
    assert stored[0][:, 0] == pytest.approx(TIMES, abs=1e-9)
    return np.array([column[:, 1] for column in stored]).T


def in_reference(friction: str) -> Array:
    """The same rows from the reference, whose state begins with z_s, z_u."""
    car = QuarterCar(
        sprung_mass=SPRUNG,
        unsprung_mass=UNSPRUNG,
        tyre_stiffness=TYRE,
        stiffness=SPRING,
        damping=DAMPER,
        layout="S2",
        device=ReferenceDevice(inertance=INERTANCE, viscous=VISCOUS, **DEVICES[friction]),
    )
    initial = np.zeros(car.nstate)
    initial[3] = KERB
    run = car.simulate(lambda t: 0.0, TIMES, initial=initial, rtol=1e-11, atol=1e-14)
    motions = (run.wheel_displacement, run.body_displacement, run.wheel_velocity, run.body_velocity)
    return np.array(motions).T


def error(found: Array, true: Array) -> float:
    """Largest error over the largest value, the worst of all columns."""
    return float((abs(found - true).max(axis=0) / abs(true).max(axis=0)).max())


TELLINGS = {"reference": in_reference, "exudyn": in_exudyn}


@pytest.mark.parametrize("telling", TELLINGS)
def test_armature(telling: str) -> None:
    """Inertance and damper: the engine's RK4 goes to the telling's motion in fourth order."""
    true = TELLINGS[telling]("smooth")
    errors = np.array([error(native("smooth", step), true) for step in (1e-3, 5e-4, 2.5e-4)])
    assert errors[-1] < 1e-9
    assert np.all(np.log2(errors[:-1] / errors[1:]) > 3.8), errors


@pytest.mark.often("mujoco", "exudyn")
@pytest.mark.parametrize("telling", TELLINGS)
def test_motor_friction(telling: str) -> None:
    """With LuGre: the engine's bristle is held over a step, so that it goes there in first order.

    Extrapolated over two steps (2 y(h/2) - y(h)) it is there to the order that is left.
    """
    true = TELLINGS[telling]("lugre")
    assert error(in_reference("smooth"), true) > 0.1, "the friction is to matter"
    steps = (4e-4, 2e-4, 1e-4)
    coarse, middle, fine = (native("lugre", step) for step in steps)
    errors = np.array([error(path, true) for path in (coarse, middle, fine)])
    assert errors[-1] < 1e-3
    orders = np.log2(errors[:-1] / errors[1:])
    assert np.all((orders > 0.9) & (orders < 1.1)), errors
    assert error(2 * fine - middle, true) < 5e-6


def test_exudyn_and_reference_with_friction() -> None:
    """The two tellings that the engine was held against, against each other."""
    assert error(in_exudyn("lugre"), in_reference("lugre")) < 1e-7
