"""A model file to run: compiled, every device with a sensor, options as wanted."""

from __future__ import annotations

from pathlib import Path

import mujoco
import numpy as np

from inerter.cars.spec import model_spec
from inerter.device_in_model import PLUGIN, devices_of
from inerter.engine_errors import (
    COMPILE_ERRORS,
    SimulationError,
    cannot_be_opened,
    engine_text,
    timestep_fault,
)
from inerter.model_bounds import refuse_not_a_number, refuse_unbounded
from inerter.plugin import load_plugin

INTEGRATORS = {
    "euler": mujoco.mjtIntegrator.mjINT_EULER,
    "rk4": mujoco.mjtIntegrator.mjINT_RK4,
    "implicit": mujoco.mjtIntegrator.mjINT_IMPLICIT,
    "implicitfast": mujoco.mjtIntegrator.mjINT_IMPLICITFAST,
    "discrete": mujoco.mjtIntegrator.mjINT_DISCRETE,
}


def load_model(
    path: Path, timestep: float | None = None, integrator: str | None = None
) -> mujoco.MjModel:
    """The model in an XML or MJB file, ready to run.

    A device that no sensor reads is given one, which changes nothing of the motion. The engine's
    habit of starting anew when a state is not finite is turned off.

    Parameters
    ----------
    path : Path
        MJCF (or URDF), or a compiled .mjb.
    timestep : float, optional
        [s], in place of the model's.
    integrator : str, optional
        A key of `INTEGRATORS`, in place of the model's.

    Raises
    ------
    SimulationError
        No such file, a model that does not compile (with the compiler's message), an unknown
        integrator, a time step that cannot be.
    """
    load_plugin()
    if timestep is not None and not 0 < timestep < 1e3:
        raise SimulationError(f"--timestep is {timestep:g}: give seconds above 0, below 1000")
    if integrator is not None and integrator.lower() not in INTEGRATORS:
        names = "Euler, RK4, implicit, implicitfast, discrete"
        raise SimulationError(f"--integrator is {integrator!r}; choose one of {names}")
    try:
        model = _binary(path) if path.suffix.lower() == ".mjb" else readable_spec(path).compile()
        refuse_not_a_number(model)
    except OSError as error:
        raise SimulationError(cannot_be_opened(path, error)) from None
    except (*COMPILE_ERRORS, mujoco.FatalError) as error:
        raise SimulationError(f"{path}: {engine_text(error, '.xml or .mjb')}") from None
    if timestep is not None:
        model.opt.timestep = timestep
    elif fault := timestep_fault(model.opt.timestep):
        raise SimulationError(f"{path}: {fault} in its <option>, or with --timestep")
    if integrator is not None:
        model.opt.integrator = INTEGRATORS[integrator.lower()]
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET
    return model


def integrator_name(model: mujoco.MjModel) -> str:
    """The integrator as MJCF spells it."""
    name = next(key for key, value in INTEGRATORS.items() if value == model.opt.integrator)
    return {"euler": "Euler", "rk4": "RK4"}.get(name, name)


def _binary(path: Path) -> mujoco.MjModel:
    refuse_unbounded(path)
    model = mujoco.MjModel.from_binary_path(str(path))
    for found in devices_of(model):
        if not found.sensor:
            raise SimulationError(
                f"no sensor reads device {found.name!r}, and a compiled model cannot be given one; "
                "run the XML, or save the .mjb with a sensor"
            )
    return model


def readable_spec(path: Path) -> mujoco.MjSpec:
    """The specification of an MJCF file, not compiled yet, in which a sensor reads every device.

    Raises
    ------
    ValueError
        The file is no model, it does not compile, or not within the bounds on memory and time.
    OSError
        It cannot be opened.
    """
    refuse_unbounded(path)
    # of a relative one the engine looks for attached models in the wrong place
    path = path.absolute()
    model = model_spec(path).compile()
    unread = {found.actuator for found in devices_of(model) if not found.sensor}

    # a specification that was compiled cannot be read back: start anew
    spec = model_spec(path)
    unnamed = [plugin for plugin in spec.plugins if not plugin.name]
    for index, actuator in enumerate(spec.actuators):
        # only a plugin actuator has a name of a plugin
        if actuator.plugin.plugin_name != PLUGIN:
            continue
        instance = actuator.plugin.name
        if not instance:
            # configured in the actuator: its instance has no name that a sensor could give
            instance = actuator.name or f"device_{index}"
            while spec.plugin(instance) is not None:
                instance += "_"
            config = dict(actuator.plugin.config)
            own = next(plugin for plugin in unnamed if dict(plugin.config) == config)
            unnamed.remove(own)
            own.name = instance
            actuator.plugin.name = instance
        if index in unread:
            sensor = spec.add_sensor(
                name=f"_inerter_sensor_{index}", type=mujoco.mjtSensor.mjSENS_PLUGIN
            )
            sensor.plugin.plugin_name = PLUGIN
            sensor.plugin.name = instance
            sensor.plugin.active = True
    return spec


def scalar_joints(model: mujoco.MjModel) -> list[int]:
    """Indices of the slide and hinge joints."""
    kinds = [int(mujoco.mjtJoint.mjJNT_SLIDE), int(mujoco.mjtJoint.mjJNT_HINGE)]
    return np.flatnonzero(np.isin(model.jnt_type, kinds)).tolist()


def start(model: mujoco.MjModel, keyframe: str | None) -> mujoco.MjData:
    """Data of the model at its initial state, or at a keyframe given by name or index.

    Raises
    ------
    SimulationError
        No such keyframe; the message lists what there is.
    """
    data = mujoco.MjData(model)
    if keyframe is not None:
        names = [model.key(i).name for i in range(model.nkey)]
        if keyframe in names:
            index = names.index(keyframe)
        elif keyframe.isdecimal() and int(keyframe) < model.nkey:
            index = int(keyframe)
        else:
            there = ", ".join(name or str(i) for i, name in enumerate(names)) or "none"
            raise SimulationError(f"no keyframe {keyframe!r} in the model; it has {there}")
        mujoco.mj_resetDataKeyframe(model, data, index)
    if not np.isfinite(data.qpos).all() or not np.isfinite(data.qvel).all():
        raise SimulationError("the initial state is not finite; correct the keyframe")
    return data
