"""The hysteresis loop of Dahl's law, in closed form.

    dz/dx = 1 - z sgn(v) / z_c,  z_c = F_c / sigma0    so that along each monotone stroke
    z = s z_c + (z_0 - s z_c) exp(-|x - x_0| / z_c),   F = sigma0 z + b a + c v

with s = sgn(v) and (x_0, z_0) where the stroke began. Once it repeats, a loop of amplitude A has
the area 4 F_c (A - z_c tanh(A / z_c)) + pi c omega A^2: the heat of a cycle.
Source: Dahl, "A solid friction model", 1968; the device is the one that "Modelling and
identification of the hysteretic dynamics of inerters" identifies.

The motion x = A cos(omega t) is that of a body of 1e12 kg on its own spring, which the device
cannot disturb. Reversals fall on steps, so that Runge-Kutta keeps its order at the corners of |v|.
"""

from __future__ import annotations

import functools
from typing import Any

import mujoco
import numpy as np
import pytest
from inerter.reference import ReferenceDevice, response, sine_motion
from numpy.typing import NDArray
from scipy.integrate import cumulative_simpson

Array = NDArray[np.float64]

HEAVY = 1e12
AMPLITUDE, FREQUENCY, CYCLES = 5e-3, 2.0, 3
OMEGA = 2 * np.pi * FREQUENCY
LEVEL, BRISTLE, VISCOUS, INERTANCE = 62.0, 4.29e4, 10.2, 174.0
DEVICE: dict[str, Any] = {
    "inertance": INERTANCE,
    "viscous": VISCOUS,
    "friction": "dahl",
    "coulomb_force": LEVEL,
    "bristle_stiffness": BRISTLE,
}
PER_CYCLE, STEPS_PER_SAMPLE = 100, 20
TIMES = np.linspace(0, CYCLES / FREQUENCY, CYCLES * PER_CYCLE + 1)

ENGINES = ("reference", "mujoco", "exudyn")


def closed_form() -> Array:
    """Force [N] at the times, the bristle unloaded at the start."""
    yields = LEVEL / BRISTLE
    z = np.zeros(TIMES.size)
    half = PER_CYCLE // 2
    for begin in range(0, TIMES.size - 1, half):
        sign = -1.0 if (begin // half) % 2 == 0 else 1.0
        way = abs(AMPLITUDE * (np.cos(OMEGA * TIMES[begin : begin + half + 1]) + sign))
        z[begin : begin + half + 1] = sign * yields + (z[begin] - sign * yields) * np.exp(
            -way / yields
        )
    phase = OMEGA * TIMES
    acceleration = -AMPLITUDE * OMEGA**2 * np.cos(phase)
    velocity = -AMPLITUDE * OMEGA * np.sin(phase)
    return BRISTLE * z + INERTANCE * acceleration + VISCOUS * velocity


def reference() -> tuple[Array, Array]:
    """Force, and heat [J]: its power summed by Simpson's rule over steps like the others'."""
    device = ReferenceDevice(**DEVICE)
    motion = sine_motion(AMPLITUDE, FREQUENCY, np.pi / 2)
    fine = np.linspace(0, TIMES[-1], STEPS_PER_SAMPLE * (TIMES.size - 1) + 1)
    run = response(device, motion, fine)
    x, v, a = run.displacement, run.velocity, run.acceleration
    power = np.asarray(device.dissipated_power(x, v, a, device.state_argument(run.states)))
    heat = cumulative_simpson(power, x=fine, initial=0.0)
    return run.force[::STEPS_PER_SAMPLE], np.asarray(heat)[::STEPS_PER_SAMPLE]


def in_mujoco() -> tuple[Array, Array]:
    """Force and heat from the plugin's sensor, under RK4."""
    config = "".join(f'<config key="{key}" value="{value}"/>' for key, value in DEVICE.items())
    model = mujoco.MjModel.from_xml_string(f"""
    <mujoco>
      <extension>
        <plugin plugin="inerter.device"><instance name="device">{config}</instance></plugin>
      </extension>
      <option gravity="0 0 0" timestep="{float(TIMES[1]) / STEPS_PER_SAMPLE!r}" integrator="RK4"/>
      <worldbody>
        <body>
          <joint name="x" type="slide" axis="1 0 0" stiffness="{HEAVY * OMEGA**2!r}"/>
          <inertial pos="0 0 0" mass="{HEAVY}" diaginertia="1 1 1"/>
        </body>
      </worldbody>
      <actuator>
        <plugin name="device" plugin="inerter.device" instance="device" joint="x" actdim="1"/>
      </actuator>
      <sensor><plugin name="device" plugin="inerter.device" instance="device"/></sensor>
    </mujoco>""")
    data = mujoco.MjData(model)
    data.qpos[:] = AMPLITUDE
    rows = []
    for _ in TIMES:
        mujoco.mj_forward(model, data)
        rows.append(data.sensordata[[0, -1]])
        mujoco.mj_step(model, data, STEPS_PER_SAMPLE)
    force, heat = np.array(rows).T
    return force, heat


def in_exudyn() -> tuple[Array, Array]:
    """Force and heat from the element's sensors, under RK44."""
    exu: Any = pytest.importorskip("exudyn")
    items: Any = pytest.importorskip("exudyn.itemInterface")
    from inerter.exudyn import CreateInerter

    mbs = exu.SystemContainer().AddSystem()
    node = mbs.AddNode(items.Node1D(referenceCoordinates=[0.0], initialCoordinates=[AMPLITUDE]))
    mbs.AddObject(items.Mass1D(nodeNumber=node, mass=HEAVY))
    markers = [
        mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=end, coordinate=0))
        for end in (mbs.AddNode(items.NodePointGround()), node)
    ]
    mbs.AddObject(items.CoordinateSpringDamper(markerNumbers=markers, stiffness=HEAVY * OMEGA**2))
    strut = CreateInerter(
        mbs, name="device", itemNumbers=[None, node], dissipatedEnergy=True, **DEVICE
    )
    sensors = [strut.AddSensor(quantity) for quantity in ("total", "dissipated_energy")]
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = TIMES[1]
    settings.timeIntegration.endTime = TIMES[-1]
    settings.timeIntegration.numberOfSteps = STEPS_PER_SAMPLE * (TIMES.size - 1)
    assert mbs.SolveDynamic(settings, solverType=exu.DynamicSolverType.RK44)
    stored = [np.array(mbs.GetSensorStoredData(sensor)) for sensor in sensors]
    assert stored[0][:, 0] == pytest.approx(TIMES, abs=1e-9)
    return stored[0][:, 1], stored[1][:, 1]


@functools.cache
def run_of(engine: str) -> tuple[Array, Array]:
    return {"reference": reference, "mujoco": in_mujoco, "exudyn": in_exudyn}[engine]()


@pytest.mark.parametrize("engine", ENGINES)
def test_force_along_the_strokes(engine: str) -> None:
    """Six strokes, the first from an unloaded bristle: the closed form at every sample.

    Exudyn's explicit solvers know no acceleration before their first step: it is left out.
    """
    found, true = run_of(engine)[0][1:], closed_form()[1:]
    assert abs(found - true).max() < 1e-8 * abs(true).max()


@pytest.mark.parametrize("engine", ENGINES)
def test_heat_of_a_cycle(engine: str) -> None:
    """The area of the loop in the third cycle, which repeats to exp(-8 A / z_c) = 1e-12."""
    heat = run_of(engine)[1]
    yields = LEVEL / BRISTLE
    friction = 4 * LEVEL * (AMPLITUDE - yields * np.tanh(AMPLITUDE / yields))
    area = friction + np.pi * VISCOUS * OMEGA * AMPLITUDE**2
    assert heat[-1] - heat[-1 - PER_CYCLE] == pytest.approx(area, rel=1e-8)
