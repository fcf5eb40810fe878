"""Devices without a control: an actuator plugin brings one, which a device hardly ever needs.

The engine gives every actuator of a plugin a control; a device's is a force beside it [N]. Marked
as a motor without inputs, which MJCF cannot say, the same actuator has none, and `nu` counts motors
alone. A device whose control sets a parameter (its key `control`) is a motor in this sense: it
keeps it.
"""

from __future__ import annotations

from typing import Any

import mujoco

PLUGIN = "inerter.device"
_NO_INPUT = 16  # mjINPUT_NONE of a motor's input signature


def without_controls(spec: mujoco.MjSpec) -> list[str]:
    """Take the control of every device in a model under construction; before it is compiled.

    A device whose control sets a parameter keeps it.

    Parameters
    ----------
    spec : mujoco.MjSpec
        The model, as from `mujoco.MjSpec.from_file("model.xml")`. Saved as XML it has the controls
        again. Keyframes that state controls have to state those of the motors alone.

    Returns
    -------
    list of str
        Names of the actuators that have none now.
    """
    found = [
        actuator
        for actuator in spec.actuators
        if _is_device(spec, actuator) and not _sets_parameter(spec, actuator)
    ]
    for actuator in found:
        remove_control(actuator)
    return [actuator.name for actuator in found]


def remove_control(actuator: Any) -> None:
    """Mark an actuator of a spec as one without inputs."""
    actuator.gaintype = mujoco.mjtGain.mjGAIN_DCMOTOR
    actuator.ctrlspec = _NO_INPUT


def device_controls(model: mujoco.MjModel) -> list[int]:
    """Places in `mjData.ctrl` of the devices' controls, for what cannot compile a spec itself.

    Those that set a parameter are left out.
    """
    from inerter.device_in_model import devices_of

    found = []
    for device in devices_of(model):
        if model.actuator_ctrlnum[device.actuator] and device.device.control == "force":
            found.append(int(model.actuator_ctrladr[device.actuator]))
    return found


def _sets_parameter(spec: mujoco.MjSpec, actuator: Any) -> bool:
    """Whether the device's control is another than a force."""
    holder = actuator.plugin
    # what refers to an instance has no configuration of its own: reading it ends the process
    owner = spec.plugin(holder.name) if holder.name else holder
    return owner is not None and owner.config.get("control", "force") != "force"


def _is_device(spec: mujoco.MjSpec, actuator: Any) -> bool:
    holder = actuator.plugin
    if not holder.active:
        return False
    instance = spec.plugin(holder.name) if holder.name else None
    return PLUGIN in (holder.plugin_name, instance.plugin_name if instance else "")
