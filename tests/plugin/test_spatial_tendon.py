"""Is an inerter whose direction moves in space right?

A double pendulum with hinges about different axes, an inerter from a site in the world to a site
on the second body; against Lagrange's equations from the kinetic energy
T = sum m |p'|^2 / 2 + sum w'I w / 2 + b l'^2 / 2, without a function of MuJoCo's.
"""

from __future__ import annotations

import mujoco
import numpy as np
from plugin_models import instance_actuator
from scipy.integrate import solve_ivp

B, GRAVITY = 3.0, 9.81
M1, M2, I1, I2 = 1.5, 0.8, 0.02, 0.01
ANCHOR = np.array([0.5, 0.4, 0.3])

MODEL = """
<mujoco>
  <extension><plugin plugin="inerter.device">{extension}</plugin></extension>
  <option timestep="{h}" integrator="RK4" gravity="0 0 -9.81"/>
  <worldbody>
    <site name="anchor" pos="0.5 0.4 0.3"/>
    <body name="one">
      <joint name="one" axis="0 1 0"/>
      <inertial pos="0.25 0 0" mass="1.5" diaginertia="0.02 0.02 0.02"/>
      <body name="two" pos="0.5 0 0">
        <joint name="two" axis="0 0 1"/>
        <inertial pos="0.2 0 0" mass="0.8" diaginertia="0.01 0.01 0.01"/>
        <site name="end" pos="0.4 0 0"/>
      </body>
    </body>
  </worldbody>
  <tendon><spatial name="strut"><site site="anchor"/><site site="end"/></spatial></tendon>
  <actuator>{actuator}</actuator>
  <sensor>{sensor}</sensor>
</mujoco>"""


def points(q: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Centres of mass of both bodies and the end site."""
    c, s = np.cos(q[0]), np.sin(q[0])
    turn = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    along = np.array([np.cos(q[1]), np.sin(q[1]), 0 * q[1]])
    elbow = np.array([0.5, 0, 0])
    return turn @ (elbow / 2), turn @ (elbow + 0.2 * along), turn @ (elbow + 0.4 * along)


def length(q: np.ndarray) -> np.ndarray:
    gap = points(q)[2] - ANCHOR
    return np.sqrt(gap @ gap)


def jacobian(function, q: np.ndarray) -> np.ndarray:
    """Derivative by complex steps, exact to rounding."""
    columns = []
    for k in range(2):
        shifted = q.astype(complex)
        shifted[k] += 1e-30j
        columns.append(np.imag(function(shifted)) / 1e-30)
    return np.array(columns).T


def mass(q: np.ndarray) -> np.ndarray:
    j1 = jacobian(lambda p: points(p)[0], q)
    j2 = jacobian(lambda p: points(p)[1], q)
    jl = jacobian(length, q)
    # angular velocities: body one about y, body two adds its own about an axis normal to y
    spin = np.diag([I1 + I2, I2])
    return M1 * j1.T @ j1 + M2 * j2.T @ j2 + spin + B * np.outer(jl, jl)


def slope(_: float, y: np.ndarray) -> np.ndarray:
    q, v = y[:2], y[2:]
    # Christoffel terms from central differences of the mass matrix
    d = 1e-5
    dm = [(mass(q + d * e) - mass(q - d * e)) / (2 * d) for e in np.eye(2)]
    bias = sum(dm[k] * v[k] for k in range(2)) @ v
    bias = bias - 0.5 * np.array([v @ dm[k] @ v for k in range(2)])
    weight = jacobian(lambda p: GRAVITY * (M1 * points(p)[0][2] + M2 * points(p)[1][2]), q)
    return np.concatenate([v, np.linalg.solve(mass(q), -bias - weight)])


def model(h: float) -> mujoco.MjModel:
    extension, actuator, sensor = instance_actuator({"inertance": B})
    return mujoco.MjModel.from_xml_string(
        MODEL.format(h=h, extension=extension, actuator=actuator, sensor=sensor)
    )


START = np.array([0.3, 0.5, 1.5, -2.0])


def test_a_double_pendulum_follows_lagrange() -> None:
    times = np.linspace(0, 1, 11)
    truth = solve_ivp(slope, (0, 1), START, "DOP853", times, rtol=1e-11, atol=1e-12).y.T
    m = model(1e-3)
    data = mujoco.MjData(m)
    data.qpos[:], data.qvel[:] = START[:2], START[2:]
    path = [START]
    for i in range(1000):
        mujoco.mj_step(m, data)
        if i % 100 == 99:
            path.append(np.concatenate([data.qpos, data.qvel]))
    assert np.abs(np.array(path) - truth).max() < 1e-7
    # the inerter is no trifle here
    assert B * np.abs(jacobian(length, START[:2])).max() ** 2 > 0.1 * mass(START[:2]).max()


def test_the_sensor_shows_b_times_the_second_derivative_of_the_length() -> None:
    m = model(1e-3)
    data = mujoco.MjData(m)
    data.qpos[:], data.qvel[:] = START[:2], START[2:]
    mujoco.mj_forward(m, data)
    # l'' = J q'' + dJ/dt q', by differences of l' along the motion
    a = slope(0, START)
    d = 1e-6

    def speed(t: float) -> float:
        y = START + t * a
        return float(jacobian(length, y[:2]) @ y[2:])

    second = (speed(d) - speed(-d)) / (2 * d)
    assert abs(data.sensordata[1] - B * second) < 1e-6 * abs(B * second)
    assert data.sensordata[0] == data.sensordata[1]
