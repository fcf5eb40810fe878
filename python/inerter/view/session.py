"""A run whose devices can be changed while it goes on.

Parameters are live: the model is compiled with a numeric NAME.key for each, which the plugin reads
at every evaluation, so a slider changes a number and nothing else. A friction law is configuration
and may bring a state: that model is compiled anew, and the run goes on from where it was.
Why not always compile anew: it takes longer than a frame, and a viewer has to load the model again.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import mujoco
import numpy as np

from inerter.core import Device, DeviceError, friction_laws, parameters
from inerter.device_in_model import DeviceInModel, motion_of
from inerter.engine_errors import SimulationError
from inerter.motion_units import Kind
from inerter.simulate.load import start
from inerter.view.compiled import Compiled, compiled
from inerter.view.sliders import Slider, slider

# what a run carries over to another compilation; the states of actuators go by name
_CARRIED = (
    "qpos", "qvel", "ctrl", "qfrc_applied", "xfrc_applied", "eq_active", "mocap_pos",
    "mocap_quat", "userdata", "qacc_warmstart",
)  # fmt: skip


class Session:
    """The model of a file, its run, and what was changed of its devices.

    Parameters
    ----------
    path : Path
        MJCF with at least one `inerter.device`.
    keyframe : str, optional
        Name or index of the keyframe to start from.

    Raises
    ------
    SimulationError
        No such file, a model that does not compile or has no device, no such keyframe.
    """

    def __init__(self, path: Path, keyframe: str | None = None) -> None:
        if not path.is_file() or path.suffix.lower() == ".mjb":
            raise SimulationError(f"{path}: give a model file (MJCF, .xml)")
        self.path = path
        self.keyframe = keyframe
        self._laws: dict[str, str] = {}
        self._values: dict[str, dict[str, float]] = {}
        self._compiled = compiled(path, {})
        self.data = start(self.model, keyframe)
        mujoco.mj_forward(self.model, self.data)

    @property
    def model(self) -> mujoco.MjModel:
        """The present compilation."""
        return self._compiled.model

    @property
    def shown(self) -> mujoco.MjModel:
        """The same for programs without the plugin (a browser), with a state of the same size."""
        return self._compiled.shown

    @property
    def devices(self) -> Mapping[str, DeviceInModel]:
        """The devices of the present model, by name."""
        return self._compiled.devices

    def device(self, name: str) -> Device:
        """A device as it is at present."""
        return self.devices[name].now(self.model)

    def sliders(self, name: str) -> list[Slider]:
        """The sliders of a device: present values, ends after the values as stated."""
        stated, motion = self._compiled.first[name], self.motion(name)
        return [slider(key, value, self._value(name, key), motion) for key, value in stated.items()]

    def motion(self, name: str) -> Kind:
        """Whether a device turns or moves along a line."""
        return motion_of(self.model, self.devices[name].actuator)

    def changes(self) -> dict[str, dict[str, float | str]]:
        """What differs from the model file, by device and key."""
        found: dict[str, dict[str, float | str]] = {}
        for name, place in self.devices.items():
            changed: dict[str, float | str] = {}
            if name in self._laws:
                # the law, and what of its own it began with
                own = {key for key in self._compiled.first[name] if parameters()[key].laws}
                given = {key: place.device.given[key] for key in place.device.given if key in own}
                changed = {"friction": self._laws[name], **given}
            changed |= self._values.get(name, {})
            if changed:
                found[name] = changed
        return found

    def set(self, name: str, key: str, value: float) -> None:
        """Change a parameter of a device; the run goes on.

        Raises
        ------
        DeviceError
            The value cannot be; nothing is changed.
        """
        place = self.devices[name]
        if key not in self._compiled.first[name]:
            raise DeviceError(f"{key} of device {name!r} has no slider")
        needed = self.device(name).replace(**{key: value}).nstate
        if needed != place.device.nstate:
            raise DeviceError(
                f"{key} = {value:g} needs {needed} states, the model has {place.device.nstate}; "
                "state it in the model file"
            )
        self.model.numeric_data[place.live[key]] = value
        self._values.setdefault(name, {})[key] = value

    def set_law(self, name: str, law: str) -> None:
        """Give a device another friction law: compiles anew, and the run goes on.

        Positions, velocities, controls and all other states are kept. A law with memory begins with
        the friction force that there was, as far as it can hold it.

        Raises
        ------
        DeviceError
            There is no such law, or the device cannot have it; nothing is changed.
        """
        if law not in friction_laws():
            raise DeviceError(f"friction is {law!r}; choose one of {', '.join(friction_laws())}")
        laws = {**self._laws, name: law}
        try:
            new = compiled(self.path, laws)
        except SimulationError as error:
            raise DeviceError(str(error)) from None
        for other, values in self._values.items():
            self._values[other] = {k: v for k, v in values.items() if k in new.first[other]}
            for key, value in self._values[other].items():
                new.model.numeric_data[new.devices[other].live[key]] = value
        self.data = carried_over(self._compiled, self.data, new)
        self._compiled, self._laws = new, laws

    def restart(self) -> None:
        """Begin the run anew at its keyframe, or at the initial state."""
        self.data = start(self.model, self.keyframe)
        mujoco.mj_forward(self.model, self.data)

    def _value(self, name: str, key: str) -> float:
        return float(self.model.numeric_data[self.devices[name].live[key]])


def carried_over(old: Compiled, data: mujoco.MjData, new: Compiled) -> mujoco.MjData:
    """Data of another compilation of the same file, at the state of a run."""
    moved = mujoco.MjData(new.model)
    moved.time = data.time
    for name in _CARRIED:
        getattr(moved, name)[:] = getattr(data, name)

    # states of actuators: those of devices by name, as a law may have one more
    devices = {place.actuator for place in old.devices.values()}
    for i in range(old.model.nactuator):
        if i not in devices and old.model.actuator_actnum[i] > 0:
            here, there = int(old.model.actuator_actadr[i]), int(new.model.actuator_actadr[i])
            count = int(old.model.actuator_actnum[i])
            moved.act[there : there + count] = data.act[here : here + count]
    for name, place in new.devices.items():
        before = old.devices[name]
        states = {key: float(data.act[at]) for key, at in before.act.items()}
        if place.device.friction != before.device.friction:
            force = float(data.sensordata[before.sensor["friction"]])
            states["friction_state"] = _friction_state(place.now(new.model), force)
        for key, at in place.act.items():
            moved.act[at] = states.get(key, 0.0)
    mujoco.mj_forward(new.model, moved)
    return moved


def _friction_state(device: Device, force: float) -> float:
    """State in which a device's friction is a force, as far as it can hold it."""
    if "friction_state" not in device.state_names:
        return 0.0
    table = parameters()
    own = [key for key in device.given if key in table and device.friction in table[key].laws]
    friction = Device(**{key: device.given[key] for key in own}, friction=device.friction)
    return float(np.asarray(friction.state_of_force(0.0, 0.0, 0.0, force)))
