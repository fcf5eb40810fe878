"""First law: what a mass loses is stored in the device or turned into heat, in every engine.

    m v^2 / 2 + k x^2 / 2 + stored + dissipated = constant

A mass on a spring to the ground, the device beside the spring, no force from outside. The plugin's
energy is also held to this in `tests/plugin/test_energy.py`, the reference's laws in
`tests/laws/test_reference_energy.py`; here the three heats have to be the same, too.
"""

from __future__ import annotations

import functools
from typing import Any

import mujoco
import numpy as np
import pytest
from inerter.reference import ReferenceDevice, Structure, Strut
from numpy.typing import NDArray

Array = NDArray[np.float64]

MASS, SPRING, INERTANCE, SPEED = 2.0, 800.0, 5.0, 1.0
STEP, STEPS_PER_SAMPLE = 1e-4, 50
TIMES = np.linspace(0, 1.0, 201)

LEVELS = {"coulomb_force": 10.0, "static_force": 15.0, "stribeck_velocity": 0.05}
DEVICES: dict[str, dict[str, Any]] = {
    "dampers": {"viscous": 3.0, "quadratic_damping": 4.0},
    "springs": {"stiffness": 200.0, "stiffness_cubic": 1e4},
    "brown_mcphee": {"friction": "brown_mcphee", **LEVELS},
    "dahl": {"friction": "dahl", "coulomb_force": 10.0, "bristle_stiffness": 2e3},
    "lugre": {"friction": "lugre", "bristle_stiffness": 2e3, "bristle_damping": 5.0, **LEVELS},
    "bouc_wen": {
        "friction": "bouc_wen", "bw_stiffness": 2e3, "bw_beta": 100.0, "bw_gamma": 50.0,
        "bw_ratio": 0.2,
    },
    "series": {"series_stiffness": 3e3, "series_damping": 20.0, "series_hardening": 1.0},
    "gas": {"gas_pressure": 1e5, "gas_area": 1e-3, "gas_volume": 4e-4, "flywheel_viscous": 2.0},
    "stops": {
        "stop_lower": -0.03, "stop_upper": 0.04, "stop_stiffness": 2e3, "stop_damping": 0.5,
    },
    "varying inertance": {"inertance_gradient": 3.0, "inertance_speed_gradient": 0.2},
}  # fmt: skip

# the corners of |v|, of stops, cost Runge-Kutta its order
CORNERS = ("dahl", "lugre", "bouc_wen", "stops")
WITHOUT_HEAT = ("springs", "varying inertance")


def in_mujoco(device: dict[str, Any]) -> Array:
    """Rows (x, v, stored, heat) under RK4."""
    given = {"inertance": INERTANCE, **device}
    states = ReferenceDevice(**given).nstate
    config = "".join(f'<config key="{key}" value="{value}"/>' for key, value in given.items())
    actdim = f'actdim="{states}"' if states else ""
    model = mujoco.MjModel.from_xml_string(f"""
    <mujoco>
      <extension>
        <plugin plugin="inerter.device"><instance name="device">{config}</instance></plugin>
      </extension>
      <option gravity="0 0 0" timestep="{STEP}" integrator="RK4"/>
      <worldbody>
        <body>
          <joint name="x" type="slide" axis="1 0 0" stiffness="{SPRING}"/>
          <inertial pos="0 0 0" mass="{MASS}" diaginertia="1 1 1"/>
        </body>
      </worldbody>
      <actuator>
        <plugin name="device" plugin="inerter.device" instance="device" joint="x" {actdim}/>
      </actuator>
      <sensor><plugin name="device" plugin="inerter.device" instance="device"/></sensor>
    </mujoco>""")
    data = mujoco.MjData(model)
    data.qvel[:] = SPEED
    if "flywheel_velocity" in ReferenceDevice(**given).state_names:
        data.act[-1] = SPEED
    rows = []
    for _ in TIMES:
        mujoco.mj_forward(model, data)
        rows.append((data.qpos[0], data.qvel[0], *data.sensordata[-2:]))
        mujoco.mj_step(model, data, STEPS_PER_SAMPLE)
    return np.array(rows)


def in_exudyn(device: dict[str, Any]) -> Array:
    """The same under RK44."""
    exu: Any = pytest.importorskip("exudyn")
    items: Any = pytest.importorskip("exudyn.itemInterface")
    from inerter.exudyn import CreateInerter

    mbs = exu.SystemContainer().AddSystem()
    node = mbs.AddNode(items.Node1D(referenceCoordinates=[0.0], initialVelocities=[SPEED]))
    mbs.AddObject(items.Mass1D(nodeNumber=node, mass=MASS))
    markers = [
        mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=end, coordinate=0))
        for end in (mbs.AddNode(items.NodePointGround()), node)
    ]
    mbs.AddObject(items.CoordinateSpringDamper(markerNumbers=markers, stiffness=SPRING))
    given = {"inertance": INERTANCE, **device}
    spinning = "flywheel_velocity" in ReferenceDevice(**given).state_names
    strut = CreateInerter(
        mbs,
        name="device",
        itemNumbers=[None, node],
        dissipatedEnergy=True,
        initialStates={"flywheel_velocity": SPEED} if spinning else None,
        **given,
    )
    quantities = ("displacement", "velocity", "stored_energy", "dissipated_energy")
    sensors = [strut.AddSensor(quantity) for quantity in quantities]
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = TIMES[1]
    settings.timeIntegration.endTime = TIMES[-1]
    settings.timeIntegration.numberOfSteps = STEPS_PER_SAMPLE * (TIMES.size - 1)
    assert mbs.SolveDynamic(settings, solverType=exu.DynamicSolverType.RK44)
    stored = [np.array(mbs.GetSensorStoredData(sensor)) for sensor in sensors]
    assert stored[0][:, 0] == pytest.approx(TIMES, abs=1e-9)
    return np.array([column[:, 1] for column in stored]).T


def reference(given: dict[str, Any]) -> Array:
    """The same, except that the heat is what the other energies have lost."""
    device = ReferenceDevice(inertance=INERTANCE, **given)
    structure = Structure(
        mass=np.array([[MASS]]),
        damping=np.zeros((1, 1)),
        stiffness=np.array([[SPRING]]),
        directions=np.ones((1, 1)),
        struts=(Strut(layout="S2", device=device),),
    )
    own = [SPEED if name == "flywheel_velocity" else 0.0 for name in device.state_names]
    run = structure.simulate(
        lambda t: np.zeros(1), TIMES, initial=[0.0, SPEED, *own], rtol=1e-10, atol=1e-13,
        max_step=1e-2,
    )  # fmt: skip
    x, v = run.position[:, 0], run.velocity[:, 0]
    states = device.state_argument(run.device_states[0])
    stored = np.broadcast_to(device.stored_energy(x, v, states), x.shape)
    kept = 0.5 * MASS * v**2 + 0.5 * SPRING * x**2 + stored
    return np.array([x, v, stored, kept[0] - kept]).T


ENGINES = {"reference": reference, "mujoco": in_mujoco, "exudyn": in_exudyn}


@functools.cache
def run_of(engine: str, device: str) -> Array:
    return ENGINES[engine](DEVICES[device])


@pytest.mark.parametrize("engine", ["mujoco", "exudyn"])
@pytest.mark.parametrize("device", DEVICES)
def test_energy_is_kept(device: str, engine: str) -> None:
    """Kinetic, elastic, stored energy and heat add up to the energy at the start.

    Bound: rounding where the forces are smooth, and what a corner costs in one step otherwise.
    """
    x, v, stored, heat = run_of(engine, device).T
    total = 0.5 * MASS * v**2 + 0.5 * SPRING * x**2 + stored + heat
    assert heat[-1] > 0.05 * total[0] or device in WITHOUT_HEAT
    assert abs(total / total[0] - 1).max() < (1e-6 if device == "stops" else 1e-10)


@pytest.mark.rarely(
    "dahl-mujoco",
    "bouc_wen-mujoco",
    "brown_mcphee-mujoco",
    "series-mujoco",
    "varying inertance-mujoco",
)
@pytest.mark.parametrize("engine", ["mujoco", "exudyn"])
@pytest.mark.parametrize("device", DEVICES)
def test_heat_is_what_the_reference_loses(device: str, engine: str) -> None:
    """Heat added up by the engine against the energy that is gone from the reference's run."""
    heat, gone = run_of(engine, device)[:, 3], run_of("reference", device)[:, 3]
    start = 0.5 * (MASS + INERTANCE) * SPEED**2
    assert abs(heat - gone).max() < start * (1e-6 if device in CORNERS else 1e-9)
