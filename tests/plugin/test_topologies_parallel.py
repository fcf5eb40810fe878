"""Is an inerter right beside springs, dampers, actuators, gravity: step by step?

Three slides side by side in the world and a fourth on the third of them, with everything at once.
The steps of every integrator, written out with the whole matrix M + sum b J'J, must come out to
rounding: what is left is the integrator's own error, at any damping.
"""

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np
import pytest
from plugin_models import INTEGRATORS
from topology_mechanisms import Array
from topology_models import linear_motion, mjcf, slide

MASS = np.array([25.0, 80.0, 40.0, 10.0])
GRAVITY, MOTOR, SERVO, SETPOINT = -9.81, 120.0, (4e3, 60.0), 0.02

# places of the bodies from the joints' coordinates: the fourth rides on the third
PLACES = np.array([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 1, 1.0]])

# where the engine's sparse matrices have entries: inside one branch of the tree
BRANCH = np.eye(4) + np.diag([0, 0, 1.0], 1) + np.diag([0, 0, 1.0], -1)

STRUT, CROSS, RIDE = np.array([-1, 1, 0, 0.0]), np.array([0, -1, 1, 1.0]), np.array([0, 0, 0, 1.0])
TWO = np.array([0, 1.0, 0, 0])


@dataclass(frozen=True)
class Scene:
    """What acts between the bodies [N/m, N*s/m, kg]."""

    joint_spring: tuple[float, ...] = (120e3, 2e3, 8e3, 5e3)
    joint_damper: tuple[float, ...] = (100.0, 0.0, 50.0, 20.0)
    tendon: tuple[float, float] = (6e3, 150.0)
    device_damper: tuple[float, float, float] = (200.0, 30.0, 40.0)
    device_spring: tuple[float, float, float] = (3e3, 500.0, 0.0)
    inertance: tuple[float, float, float] = (113.0, 40.0, 7.0)

    def xml(self) -> str:
        """The model; devices d0 (one-two), d1 (two-four), d2 (joint four, native)."""
        joints = [
            f'stiffness="{k}" damping="{c}"'
            for k, c in zip(self.joint_spring, self.joint_damper, strict=True)
        ]
        four = slide("four", MASS[3], 0.5, joints[3])
        world = slide("one", MASS[0], 0, joints[0]) + slide("two", MASS[1], 1, joints[1])
        world += slide("three", MASS[2], 2, joints[2], four)
        tendons = f"""
    <fixed name="strut" stiffness="{self.tendon[0]}" damping="{self.tendon[1]}">
      <joint joint="one" coef="-1"/><joint joint="two" coef="1"/></fixed>
    <fixed name="cross"><joint joint="two" coef="-1"/><joint joint="three" coef="1"/>
      <joint joint="four" coef="1"/></fixed>"""
        actuators = f"""
    <position joint="two" kp="{SERVO[0]}" kv="{SERVO[1]}"/><motor joint="three"/>"""
        targets = ('tendon="strut"', 'tendon="cross"', 'joint="four"')
        devices = [
            ({"inertance": b, "viscous": c, "stiffness": k}, target)
            for b, c, k, target in zip(
                self.inertance, self.device_damper, self.device_spring, targets, strict=True
            )
        ]
        return mjcf(
            world, tendons, devices, gravity=(0, 0, GRAVITY), actuators=actuators,
            option='tolerance="1e-14"',
        )  # fmt: skip

    def matrices(self) -> tuple[Array, Array, Array, Array]:
        """M with all inertances, D, K and the constant forces."""
        mass = PLACES.T @ np.diag(MASS) @ PLACES
        damping, stiffness = np.diag(self.joint_damper), np.diag(self.joint_spring)
        for i, row in enumerate((STRUT, CROSS, RIDE)):
            mass = mass + self.inertance[i] * np.outer(row, row)
            damping = damping + self.device_damper[i] * np.outer(row, row)
            stiffness = stiffness + self.device_spring[i] * np.outer(row, row)
        damping = damping + self.tendon[1] * np.outer(STRUT, STRUT)
        stiffness = stiffness + self.tendon[0] * np.outer(STRUT, STRUT)
        damping[1, 1] += SERVO[1]
        stiffness[1, 1] += SERVO[0]
        force = PLACES.T @ MASS * GRAVITY + np.array([0, SERVO[0] * SETPOINT, MOTOR, 0])
        return mass, damping, stiffness, force

    def implicit_part(self, integrator: str, h: float) -> tuple[Array, Array]:
        """What an integrator adds to M, and to f per velocity.

        The device's own dampers are implicit everywhere; Euler adds the joints', implicit and
        implicitfast all dampers as far as their matrices have entries, discrete all and springs.
        """
        d0, d1, d2 = self.device_damper
        devices = d0 * np.outer(STRUT, STRUT) + d1 * np.outer(CROSS, CROSS)
        joints = np.diag(self.joint_damper) + d2 * np.outer(RIDE, RIDE)
        if integrator == "Euler":
            return h * (joints + devices), np.zeros((4, 4))
        native = joints + self.tendon[1] * np.outer(STRUT, STRUT) + SERVO[1] * np.outer(TWO, TWO)
        if integrator == "discrete":
            springs = np.diag(self.joint_spring) + self.tendon[0] * np.outer(STRUT, STRUT)
            springs += SERVO[0] * np.outer(TWO, TWO)
            return h * (native + devices) + h * h * springs, -h * springs
        return h * (native * BRANCH + devices), np.zeros((4, 4))

    def step(self, integrator: str, h: float, q: Array, v: Array) -> tuple[Array, Array]:
        """One step written out."""
        mass, damping, stiffness, force = self.matrices()

        def slope(y: Array) -> Array:
            f = force - stiffness @ y[:4] - damping @ y[4:]
            return np.concatenate([y[4:], np.linalg.solve(mass, f)])

        if integrator == "RK4":
            y = np.concatenate([q, v])
            k1 = slope(y)
            k2 = slope(y + h / 2 * k1)
            k3 = slope(y + h / 2 * k2)
            k4 = slope(y + h * k3)
            y = y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
            return y[:4], y[4:]
        metric, ahead = self.implicit_part(integrator, h)
        f = force - stiffness @ q - (damping - ahead) @ v
        v = v + h * np.linalg.solve(mass + metric, f)
        return q + h * v, v

    def start(self, integrator: str, h: float) -> tuple[mujoco.MjModel, mujoco.MjData]:
        """The model in its first state."""
        option = f'integrator="{integrator}" timestep="{h}"'
        model = mujoco.MjModel.from_xml_string(self.xml().replace("{option}", option))
        data = mujoco.MjData(model)
        data.ctrl[:2] = SETPOINT, MOTOR
        data.qpos[:], data.qvel[:] = START[:4], START[4:]
        return model, data


START = np.array([0.01, -0.02, 0.03, 0.01, 0.3, -0.1, 0.2, 0.5])
H = 1e-3

# strong: h c / m = 100 for the lightest body that the damper holds
SCENES = {
    "moderate": Scene(),
    "light inerters": Scene(inertance=(0.5, 0.2, 0.1)),
    "heavy inerters": Scene(inertance=(3e4, 1e5, 1e4)),
    "strong joint dampers": Scene(joint_damper=(2.5e6, 8e6, 4e6, 1e6)),
    "one strong joint damper": Scene(joint_damper=(0, 0, 0, 1e6)),
    "strong devices": Scene(device_damper=(2.5e6, 1e6, 1e6)),
    "strong tendon damper": Scene(tendon=(6e3, 2.5e6)),
    "stiff tendon": Scene(tendon=(2.5e9, 150)),
}
STABLE = [
    (name, integrator)
    for name in SCENES
    for integrator in INTEGRATORS
    if not (
        ("strong" in name and integrator == "RK4")
        or ("strong tendon" in name and integrator == "Euler")
        or ("stiff" in name and integrator != "discrete")
    )
]


@pytest.mark.parametrize(("name", "integrator"), STABLE)
def test_every_step_is_that_of_the_whole_matrix(name: str, integrator: str) -> None:
    scene = SCENES[name]
    model, data = scene.start(integrator, H)
    q, v = START[:4], START[4:]
    for _ in range(300):
        mujoco.mj_step(model, data)
        q, v = scene.step(integrator, H, q, v)
        assert np.abs(data.qvel - v).max() < 1e-10 * np.abs(START).max()
        assert np.abs(data.qpos - q).max() < 1e-10 * np.abs(START).max()


@pytest.mark.parametrize(("name", "integrator"), STABLE)
def test_the_sensors_show_b_times_the_acceleration_of_the_step(name: str, integrator: str) -> None:
    scene = SCENES[name]
    model, data = scene.start(integrator, H)
    for _ in range(100):
        before = data.qvel.copy()
        mujoco.mj_step(model, data)
        if integrator == "RK4":
            mujoco.mj_forward(model, data)
        change = data.qacc if integrator == "RK4" else (data.qvel - before) / H
        for i, row in enumerate((STRUT, CROSS)):
            force = data.sensor(f"d{i}").data[1]
            expected = scene.inertance[i] * (row @ change)
            size = scene.inertance[i] * np.abs(row * change).sum()
            assert abs(force - expected) < 1e-9 * size


# the engine drops half of a tendon damper's derivative between branches, and an oscillation that h
# does not resolve has no right motion
RESOLVED = [
    (name, integrator)
    for name, integrator in STABLE
    if "stiff" not in name and ("strong tendon" not in name or integrator == "discrete")
]


@pytest.mark.parametrize(("name", "integrator"), RESOLVED)
def test_the_motion_goes_to_the_modal_solution(name: str, integrator: str) -> None:
    scene = SCENES[name]
    times = np.arange(1, 6) * 0.04
    truth = linear_motion(*scene.matrices(), START, times)[:, :4]
    errors = []
    for h in (1e-3, 5e-4, 2.5e-4):
        model, data = scene.start(integrator, h)
        rows = []
        for _ in times:
            mujoco.mj_step(model, data, round(0.04 / h))
            rows.append(data.qpos.copy())
        errors.append(np.abs(np.array(rows) - truth).max() / np.abs(truth).max())
    order = np.log2(errors[0] / errors[-1]) / 2
    assert order > (3.8 if integrator == "RK4" else 0.9), errors
    assert errors[0] < {"RK4": 2e-7, "discrete": 0.03}.get(integrator, 6e-3)
