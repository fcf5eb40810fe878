"""Inverse dynamics with devices: what `mj_inverse` does not know."""

from __future__ import annotations

import copy
import ctypes
from collections.abc import Callable
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from inerter.device_in_model import devices_of, plugin_library

_MESSAGE_SIZE = 512


@dataclass(frozen=True)
class DeviceForces:
    """Forces of all devices of a model at a given acceleration.

    force: tension of each by the name of its actuator, as its sensor shows it [N] (a hinge: N m).
    qfrc: generalized forces (nv,) of them that `mj_inverse` does not know [N, N m].
    """

    force: dict[str, float]
    qfrc: NDArray[np.float64]


def _ask(
    function: Callable[..., int], model: mujoco.MjModel, data: mujoco.MjData,
    *arrays: NDArray[np.float64],
) -> None:  # fmt: skip
    message = ctypes.create_string_buffer(_MESSAGE_SIZE)
    addresses = (array.ctypes.data for array in arrays)
    if function(model._address, data._address, *addresses, message):
        raise ValueError(message.value.decode())


def device_force(model: mujoco.MjModel, data: mujoco.MjData, qacc: ArrayLike) -> DeviceForces:
    """The devices' forces at an acceleration, for inverse dynamics.

    `mj_inverse` knows what the engine's inertia matrix and passive forces hold of a device (inside
    a branch of the tree its inertance and viscous damping) and not what the plugin brings:
    friction, springs, and between two branches the inertance too. What motors have to bring is

        mujoco.mj_inverse(model, data)
        torque = data.qfrc_inverse - device_force(model, data, data.qacc).qfrc

    which `inverse_dynamics` does; in contact it takes more, since under Euler with joint damping,
    `implicit` and `implicitfast` constraints feel another force of a device between two branches
    than the step does. Under integrators other than RK4 the forces are those of the step that
    begins here, as the engine's own are.

    Parameters
    ----------
    model, data : MjModel, MjData
        `mj_forward` or `mj_inverse` has run at the present position, velocity and states. Nothing
        in them is changed.
    qacc : array_like (nv,)
        Acceleration of the dofs [m/s^2, rad/s^2].

    Returns
    -------
    DeviceForces

    Raises
    ------
    ValueError
        qacc has another length or is not finite; live parameters that cannot be.
    """
    given = np.ascontiguousarray(qacc, dtype=np.float64)
    if given.shape != (model.nv,) or not np.isfinite(given).all():
        finite = bool(np.isfinite(given).all())
        raise ValueError(
            f"qacc has shape {given.shape}, finite: {finite}; give {model.nv} finite numbers, one "
            "for each dof"
        )
    found = sorted(devices_of(model), key=lambda each: each.instance)
    force, qfrc = np.zeros(max(1, len(found))), np.zeros(model.nv)
    _ask(plugin_library().inerter_device_force, model, data, given, force, qfrc)
    names = [each.name or f"actuator {each.actuator}" for each in found]
    return DeviceForces(dict(zip(names, force.tolist(), strict=False)), qfrc)


def inverse_dynamics(
    model: mujoco.MjModel, data: mujoco.MjData, qacc: ArrayLike
) -> NDArray[np.float64]:
    """Forces of the dofs that give an acceleration, devices included: the computed torque.

    Parameters
    ----------
    model, data : MjModel, MjData
        Position, velocity, states; what else is in data is not looked at, and nothing is changed.
    qacc : array_like (nv,)
        The acceleration that is wanted [m/s^2, rad/s^2].

    Returns
    -------
    ndarray (nv,)
        What motors and applied forces have to bring together [N, N m]: with it in
        `data.qfrc_applied` and every control at 0, `mj_forward` gives qacc.

    Raises
    ------
    ValueError
        As `device_force`.
    """
    work = copy.copy(data)
    work.qacc[:] = given = np.array(qacc, dtype=np.float64)
    mujoco.mj_inverse(model, work)
    asked = work
    if model.opt.integrator == mujoco.mjtIntegrator.mjINT_DISCRETE:
        # how easily terminals give way over a step is in what only a forward pass builds
        asked = copy.copy(data)
        mujoco.mj_forward(model, asked)
    missing = device_force(model, asked, given).qfrc
    _ask(plugin_library().inerter_felt_acceleration, model, asked, given, work.qacc)
    inertia = np.zeros(model.nv)
    mujoco.mj_mulM(model, work, inertia, given - work.qacc)
    mujoco.mj_inverse(model, work)
    return work.qfrc_inverse + inertia - missing
