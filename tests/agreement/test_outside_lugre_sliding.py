"""LuGre friction where its equations can be solved: sliding at a constant speed, and break-away.

    z' = v - sigma0 |v| z / g,   F = sigma0 z + sigma1 z' + sigma2 v
    g = F_c + (F_s - F_c) exp(-(v / v_s)^2)

At constant v, from z = 0:  z = g / sigma0 (1 - e) sgn v,  e = exp(-sigma0 |v| t / g), so that
F = [g (1 - e) + sigma1 |v| e] sgn v + sigma2 v, which ends in F = g(v) sgn v + sigma2 v.
Source: Canudas de Wit, Olsson, Astrom, Lischinsky, IEEE TAC 40(3), 1995, section II (steady state)
and section IV with figure 4 (break-away), whose parameters these are.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
import pytest
from inerter.reference import ReferenceDevice, Structure, Strut
from numpy.typing import NDArray

Array = NDArray[np.float64]

BRISTLE, MICRO_DAMPING, VISCOUS = 1e5, 1e5**0.5, 0.4
COULOMB, STATIC, STRIBECK = 1.0, 1.5, 1e-3
LUGRE: dict[str, Any] = {
    "friction": "lugre",
    "bristle_stiffness": BRISTLE,
    "bristle_damping": MICRO_DAMPING,
    "viscous": VISCOUS,
    "coulomb_force": COULOMB,
    "static_force": STATIC,
    "stribeck_velocity": STRIBECK,
}
HEAVY = 1e12  # a body that friction does not slow down [kg]
STEPS_PER_SAMPLE = 20


@dataclass(frozen=True)
class Push:
    """A mass [kg] that starts with a velocity [m/s], under a force that grows by `rate` [N/s]."""

    mass: float
    velocity: float = 0.0
    rate: float = 0.0


def reference(push: Push, times: Array) -> Array:
    """Rows (bristle [m], friction with sigma2 [N]), by Radau."""
    device = ReferenceDevice(**LUGRE)
    structure = Structure(
        mass=np.array([[push.mass]]),
        damping=np.zeros((1, 1)),
        stiffness=np.zeros((1, 1)),
        directions=np.ones((1, 1)),
        struts=(Strut(layout="S2", device=device),),
    )
    run = structure.simulate(
        lambda t: np.array([push.rate * t]), times, initial=[0.0, push.velocity, 0.0], rtol=1e-10,
        atol=1e-16,
    )  # fmt: skip
    return np.array([run.device_states[0][:, 0], run.device_force[:, 0]]).T


def in_mujoco(
    push: Push, times: Array, integrator: str = "RK4", per_sample: int = STEPS_PER_SAMPLE
) -> Array:
    """The same from the plugin; the force is the activation of an integrator."""
    config = "".join(f'<config key="{key}" value="{value}"/>' for key, value in LUGRE.items())
    step = float(times[1]) / per_sample
    model = mujoco.MjModel.from_xml_string(
        f"""
    <mujoco>
      <extension>
        <plugin plugin="inerter.device"><instance name="device">{config}</instance></plugin>
      </extension>
      <option gravity="0 0 0" timestep="{step!r}" integrator="{integrator}"/>
      <worldbody>
        <body>
          <joint name="x" type="slide" axis="1 0 0"/>
          <inertial pos="0 0 0" mass="{push.mass}" diaginertia="1 1 1"/>
        </body>
      </worldbody>
      <actuator>
        <plugin name="device" plugin="inerter.device" instance="device" joint="x" actdim="1"/>
        <general name="push" joint="x" dyntype="integrator"/>
      </actuator>
      <sensor><plugin name="device" plugin="inerter.device" instance="device"/></sensor>
    </mujoco>""".replace("'lugre'", "lugre")
    )
    data = mujoco.MjData(model)
    data.qvel[:] = push.velocity
    data.actuator("push").ctrl = push.rate
    rows = []
    for _ in times:
        mujoco.mj_forward(model, data)
        rows.append((data.act[0], data.sensordata[0]))
        mujoco.mj_step(model, data, per_sample)
    return np.array(rows)


def in_exudyn(push: Push, times: Array) -> Array:
    """The same from the element, under RK44."""
    exu: Any = pytest.importorskip("exudyn")
    items: Any = pytest.importorskip("exudyn.itemInterface")
    from inerter.exudyn import CreateInerter

    mbs = exu.SystemContainer().AddSystem()
    node = mbs.AddNode(items.Node1D(referenceCoordinates=[0.0], initialVelocities=[push.velocity]))
    mbs.AddObject(items.Mass1D(nodeNumber=node, mass=push.mass))
    marker = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=0))
    mbs.AddLoad(
        items.LoadCoordinate(
            markerNumber=marker, load=push.rate, loadUserFunction=lambda mbs, t, load: load * t
        )
    )
    device = CreateInerter(mbs, name="device", itemNumbers=[None, node], **LUGRE)
    sensors = [device.AddSensor(quantity) for quantity in ("friction_state", "total")]
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = times[1]
    settings.timeIntegration.endTime = times[-1]
    settings.timeIntegration.numberOfSteps = STEPS_PER_SAMPLE * (times.size - 1)
    assert mbs.SolveDynamic(settings, solverType=exu.DynamicSolverType.RK44)
    stored = [np.array(mbs.GetSensorStoredData(sensor)) for sensor in sensors]
    assert stored[0][:, 0] == pytest.approx(times, rel=1e-9, abs=1e-12)
    return np.array([column[:, 1] for column in stored]).T


ENGINES: dict[str, Callable[[Push, Array], Array]] = {
    "reference": reference,
    "mujoco": in_mujoco,
    "exudyn": in_exudyn,
}
engines = pytest.mark.parametrize("engine", ENGINES)
speeds = pytest.mark.parametrize("speed", [-5 * STRIBECK, -0.3 * STRIBECK, STRIBECK, 0.1])


def level(speed: float) -> float:
    """The Stribeck curve g(v) [N]."""
    return COULOMB + (STATIC - COULOMB) * float(np.exp(-((speed / STRIBECK) ** 2)))


def sliding(speed: float) -> tuple[Array, Array]:
    """Times over 32 relaxation times, and the closed form's rows (bristle, friction)."""
    g = level(speed)
    left = np.linspace(0, 32, 101)
    e = np.exp(-left)
    z = np.sign(speed) * g / BRISTLE * (1 - e)
    force = np.sign(speed) * (g * (1 - e) + MICRO_DAMPING * abs(speed) * e) + VISCOUS * speed
    return left * g / (BRISTLE * abs(speed)), np.array([z, force]).T


@engines
@speeds
def test_sliding_at_constant_speed(speed: float, engine: str) -> None:
    """Bristle and friction from the first contact to the steady state, at 101 times."""
    times, true = sliding(speed)
    found = ENGINES[engine](Push(HEAVY, speed), times)
    errors = abs(found - true).max(axis=0) / abs(true).max(axis=0)
    assert errors.max() < 1e-8
    steady = level(speed) * np.sign(speed) + VISCOUS * speed
    assert found[-1, 1] == pytest.approx(steady, rel=1e-9)


@speeds
@pytest.mark.parametrize("integrator", ["Euler", "implicit", "implicitfast", "discrete"])
def test_sliding_at_coarse_steps(integrator: str, speed: float) -> None:
    """Steps of 3.2 relaxation times: the plugin's own step of a bristle is exact at constant v."""
    times, true = (part[:50:10] for part in sliding(speed))
    found = in_mujoco(Push(HEAVY, speed), times, integrator, per_sample=1)
    assert found[:, 0] == pytest.approx(true[:, 0], rel=1e-9)


@functools.cache
def break_away(engine: str) -> Array:
    """Largest friction [N] of a mass of 1 kg that is pushed by R t, for each rate."""
    peaks = []
    for rate in RATES:
        times = np.linspace(0, STATIC / rate, 3001)
        friction = ENGINES[engine](Push(1.0, rate=rate), times)[:, 1]
        assert friction.argmax() < times.size - 1, "it is to break away before F_s"
        peaks.append(friction.max())
    return np.array(peaks)


RATES = np.array([8.0, 1.0, 0.125])  # [N/s]


@pytest.mark.often("mujoco", "exudyn")
@engines
def test_break_away(engine: str) -> None:
    """Break-away comes nearer to F_s the slower the force grows, in the power 2/3 of its rate R.

    Before it the mass creeps with R / sigma0 = v (1 - F / g(v)), g = F_s (1 - a v^2). No v solves
    that above F_s (1 - d), d = 3 (R sqrt(a) / (2 sigma0))^(2/3): there break-away begins.
    """
    peaks = break_away(engine)
    a = (STATIC - COULOMB) / (STATIC * STRIBECK**2)
    begin = STATIC * (1 - 3 * (RATES * np.sqrt(a) / (2 * BRISTLE)) ** (2 / 3))
    assert np.all((begin < peaks) & (peaks < STATIC))
    missing = STATIC - peaks
    orders = np.log(missing[:-1] / missing[1:]) / np.log(RATES[:-1] / RATES[1:])
    assert np.all((orders > 0.6) & (orders < 0.7)), orders
    assert peaks == pytest.approx(break_away("reference"), rel=1e-9)
