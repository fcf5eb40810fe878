"""Does an inerter between free bodies keep linear and angular momentum?

Momenta from the bodies' masses, inertias and motion, without a function of MuJoCo's.
"""

from __future__ import annotations

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from plugin_models import INTEGRATORS, RK4_TURNS
from topology_mechanisms import Array, Body, Device, FreeBodies, turn
from topology_models import ON_ONE, ON_THREE, ON_TWO, ONE, THREE, TWO, mjcf, model_of, spatial

# the engine integrates the frames' velocities: a centre off the origin costs momentum in the order
# of the integrator, with or without a device
A, B, C = (replace(body, centre=(0, 0, 0)) for body in (ONE, TWO, THREE))
SOFT = Device(2.0, 0.0, 80.0, 0.7)
PAIR = FreeBodies([A, B], [spatial(ON_ONE, ON_TWO)], [SOFT])
DAMPED = FreeBodies([A, B], [spatial(ON_ONE, ON_TWO)], [Device(0.5, 3.0, 80.0, 0.7)])
TRIANGLE = FreeBodies(
    [A, B, C],
    [spatial(ON_ONE, ON_TWO), spatial(ON_TWO, ON_THREE), spatial(ON_THREE, (0, (-0.1, 0, 0.1)))],
    [SOFT, Device(0.3, 1.0, 50.0, 0.8), Device(5.0, 0.0, 80.0, 0.9)],
)
SYSTEMS = {"pair": PAIR, "damped pair": DAMPED, "triangle": TRIANGLE}


def momenta(bodies: list[Body], qpos: Array, qvel: Array) -> tuple[Array, Array, float, float]:
    """Linear and angular momentum about the origin, and the sizes of their parts."""
    linear, angular, linear_size, angular_size = np.zeros(3), np.zeros(3), 0.0, 0.0
    for i, body in enumerate(bodies):
        rotation, spin = turn(qpos[7 * i + 3 : 7 * i + 7]), qvel[6 * i + 3 : 6 * i + 6]
        centre = np.array(body.centre, float)
        place = qpos[7 * i : 7 * i + 3] + rotation @ centre
        momentum = body.mass * (qvel[6 * i : 6 * i + 3] + rotation @ np.cross(spin, centre))
        own = rotation @ body.matrix() @ spin
        linear += momentum
        angular += np.cross(place, momentum) + own
        linear_size += float(np.linalg.norm(momentum))
        angular_size += float(np.linalg.norm(np.cross(place, momentum)) + np.linalg.norm(own))
    return linear, angular, linear_size, angular_size


def drift(system: FreeBodies, integrator: str, h: float, duration: float) -> tuple[float, float]:
    """Largest change of linear and angular momentum, relative."""
    topology = model_of(system, [False] * len(system.devices))
    model = topology.model(integrator, h)
    data = topology.data(model)
    bodies = list(system.bodies)
    linear, angular, p_size, l_size = momenta(bodies, data.qpos, data.qvel)
    worst = np.zeros(2)
    for _ in range(50):
        mujoco.mj_step(model, data, round(duration / 50 / h))
        p, spin, *_ = momenta(bodies, data.qpos, data.qvel)
        change = np.linalg.norm(p - linear) / p_size, np.linalg.norm(spin - angular) / l_size
        worst = np.maximum(worst, change)
    return worst[0], worst[1]


@pytest.mark.parametrize("name", SYSTEMS)
def test_rk4_keeps_both_momenta(name: str) -> None:
    linear, angular = drift(SYSTEMS[name], "RK4", 1e-3, 10)
    assert linear < 1e-12
    assert angular < (1e-10 if RK4_TURNS else 1e-5)


@pytest.mark.parametrize("integrator", INTEGRATORS[:-1])
@pytest.mark.parametrize("name", SYSTEMS)
def test_other_integrators_keep_the_linear_one(name: str, integrator: str) -> None:
    linear, coarse = drift(SYSTEMS[name], integrator, 1e-3, 2)
    _, fine = drift(SYSTEMS[name], integrator, 5e-4, 2)
    assert linear < 1e-12
    assert fine < 0.6 * coarse


def test_the_force_is_a_pair_of_forces_along_the_line() -> None:
    # generalized forces of the device: no resultant, no moment about the origin
    for system in SYSTEMS.values():
        topology = model_of(system, [False] * len(system.devices))
        model = topology.model("RK4")
        data = topology.data(model)
        mujoco.mj_step(model, data, 137)
        mujoco.mj_forward(model, data)
        force, moment = np.zeros(3), np.zeros(3)
        for i in range(len(system.bodies)):
            pull, torque = np.split(data.qfrc_actuator[6 * i : 6 * i + 6], 2)
            rotation = turn(data.qpos[7 * i + 3 : 7 * i + 7])
            force += pull
            moment += np.cross(data.qpos[7 * i : 7 * i + 3], pull) + rotation @ torque
        size = np.abs(data.qfrc_actuator).sum()
        assert size > 1
        assert np.abs(force).max() < 1e-13 * size
        assert np.abs(moment).max() < 1e-13 * size


def test_a_planar_pair_keeps_them_with_joints_too() -> None:
    # two discs on slides and a hinge each, sites on their rims
    body = """
    <body name="{n}" pos="{x} 0 0">
      <joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/>
      <joint axis="0 -1 0"/>
      <inertial pos="0 0 0" mass="{m}" diaginertia="0.05 0.05 0.05"/>
      <site name="{n}" pos="0 0 {z}"/>
    </body>"""
    world = body.format(n="a", x=0, m=1.5, z=0.2) + body.format(n="b", x=0.8, m=0.7, z=-0.15)
    tendon = '<spatial name="t"><site site="a"/><site site="b"/></spatial>'
    keys = {"inertance": 3.0, "stiffness": 60.0, "rest_length": 0.8}
    xml = mjcf(world, tendon, [(keys, 'tendon="t"')], option='integrator="RK4" timestep="1e-3"')
    model = mujoco.MjModel.from_xml_string(xml.replace("{option}", ""))
    data = mujoco.MjData(model)
    data.qvel[:] = 0.3, 0.4, 3.0, -0.2, 0.1, -2.0
    masses, start = np.array([1.5, 0.7]), np.array([0, 0.8])

    def momentum() -> Array:
        x, z = data.qpos[[0, 3]] + start, data.qpos[[1, 4]]
        u, w, spin = data.qvel[[0, 3]], data.qvel[[1, 4]], data.qvel[[2, 5]]
        return np.array([masses @ u, masses @ w, masses @ (x * w - z * u) + 0.05 * spin.sum()])

    first = momentum()
    for _ in range(20):
        mujoco.mj_step(model, data, 500)
        assert np.abs(momentum() - first).max() < 1e-10
