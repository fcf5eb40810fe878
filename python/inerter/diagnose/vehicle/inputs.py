"""What a record drives in a model: controls of actuators, and places of mocap bodies.

All inputs of a step stand in one vector, as `mujoco.batch` takes them: the controls, then position
x, y, z of each mocap body. A mocap body goes from where the model has it by what its column says.
MuJoCo gives it no velocity: a damper between it and a wheel feels the wheel's speed alone.
"""

from __future__ import annotations

import mujoco
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
AXES = ("x", "y", "z")
MOCAP = "mocap:"
"""Before the name of a mocap body, as in "mocap:table.z"; what has it not is an actuator."""
STATE = int(mujoco.mjtState.mjSTATE_CTRL) | int(mujoco.mjtState.mjSTATE_MOCAP_POS)
"""The inputs as a state of MuJoCo."""


def mocap_bodies(model: mujoco.MjModel) -> list[int]:
    """Bodies that are placed from outside, in the order of `mocap_pos`."""
    found = [i for i in range(model.nbody) if model.body_mocapid[i] >= 0]
    return sorted(found, key=lambda body: int(model.body_mocapid[body]))


def actuator_of(model: mujoco.MjModel, target: str) -> int:
    """The actuator that a target names; -1 for a mocap body."""
    return -1 if target.startswith(MOCAP) else int(model.actuator(target).id)


def mocap_of(model: mujoco.MjModel, target: str) -> int:
    """The mocap body that a target names; -1 for an actuator."""
    if not target.startswith(MOCAP):
        return -1
    return int(model.body(target.removeprefix(MOCAP).rpartition(".")[0]).id)


def place_of(model: mujoco.MjModel, target: str) -> int:
    """Where a target stands in the vector of inputs."""
    body = mocap_of(model, target)
    if body < 0:
        return int(model.actuator_ctrladr[actuator_of(model, target)])
    return model.nu + 3 * int(model.body_mocapid[body]) + AXES.index(target[-1])


def undriven(model: mujoco.MjModel) -> Array:
    """Inputs where nothing drives: of the first keyframe, else none and as the model has it."""
    if model.nkey:
        return np.concatenate([model.key_ctrl[0], model.key_mpos[0].ravel()])
    places = [model.body_pos[body] for body in mocap_bodies(model)]
    return np.concatenate([np.zeros(model.nu), *places])


def set_inputs(model: mujoco.MjModel, data: mujoco.MjData, values: Array) -> None:
    """Put a vector of inputs into a simulation."""
    data.ctrl[:] = values[: model.nu]
    data.mocap_pos[:] = values[model.nu :].reshape(-1, 3)
