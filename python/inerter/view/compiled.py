"""A model file compiled so that its devices can be changed, and once more for who has no plugin."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import mujoco
import numpy as np

from inerter.core import Device, lists, parameters
from inerter.device_in_model import PLUGIN, DeviceInModel, devices_of
from inerter.engine_errors import SimulationError, cannot_be_opened, engine_text
from inerter.model_bounds import refuse_not_a_number
from inerter.simulate.load import readable_spec
from inerter.view.sliders import keys_of, value_of

# what a friction law begins with where the device states nothing of it
FORCE = 50.0  # [N]
STIFFNESS = 1e4  # [N/m]


@dataclass(frozen=True)
class Compiled:
    """A compilation. Each is made anew from the file.

    model: every parameter with a slider is live. shown: without the plugin, with a state of the
    same size. devices: by name. first: values of the live parameters as stated, by device and key.
    """

    model: mujoco.MjModel
    shown: mujoco.MjModel
    devices: Mapping[str, DeviceInModel]
    first: Mapping[str, Mapping[str, float]]


def compiled(path: Path, laws: Mapping[str, str]) -> Compiled:
    """Compile a model file, with other friction laws for some of its devices.

    Raises
    ------
    DeviceError
        A device cannot have that law.
    SimulationError
        The file is no model, does not compile, or has no device.
    """
    try:
        # parsed anew each time: a specification that was compiled cannot be read back
        places = devices_of(readable_spec(path).compile())
        if not places:
            raise SimulationError(f"{path}: the model has no {PLUGIN}; there is nothing to see")
        spec = readable_spec(path)
        first = _make_live(spec, places, laws)
        model = spec.compile()
        plain = readable_spec(path)
        _make_live(plain, places, laws)
        _take_plugin_out(plain, model.npluginstate)
        shown = plain.compile()
        refuse_not_a_number(model)
    except SimulationError:
        raise
    except OSError as error:
        raise SimulationError(cannot_be_opened(path, error)) from None
    except (ValueError, mujoco.FatalError) as error:
        raise SimulationError(f"{path}: {engine_text(error)}") from None
    return Compiled(model, shown, {place.name: place for place in devices_of(model)}, first)


def with_law(device: Device, law: str) -> Device:
    """A device with another friction law.

    What only the old law reads is left out. What the new one needs and the device does not state
    is `FORCE` and `STIFFNESS`.
    """
    table = {**parameters(), **lists()}
    kept = {
        key: value
        for key, value in device.given.items()
        if key not in table or not table[key].laws or law in table[key].laws
    }
    level = device.coulomb_force or FORCE
    needed: dict[str, float] = {}
    if law in table["coulomb_force"].laws:
        needed = {"coulomb_force": level}
    elif law == "bouc_wen":
        shape = STIFFNESS / (2 * level)
        needed = {"bw_stiffness": STIFFNESS, "bw_beta": shape, "bw_gamma": shape}
    elif law == "maxwell_slip":
        needed = {"slip_stiffness_1": STIFFNESS, "slip_force_1": level}
    return Device(**{**needed, **kept, "friction": law})


def _take_plugin_out(spec: mujoco.MjSpec, plugin_state: int) -> None:
    """Make each device an actuator that does nothing: a program without the plugin can load that.

    User data stand in for the states of the plugins: the state has the same size, and everything
    that is drawn lies at the same place in it.
    """
    for sensor in list(spec.sensors):
        if sensor.plugin.plugin_name == PLUGIN:
            spec.delete(sensor)
    instances = set()
    for actuator in spec.actuators:
        if actuator.plugin.plugin_name == PLUGIN:
            instances.add(actuator.plugin.name)
            actuator.plugin.active = False
            actuator.plugin.name = actuator.plugin.plugin_name = ""
            if actuator.actdim > 0:
                actuator.dyntype = mujoco.mjtDyn.mjDYN_USER
            actuator.gainprm = np.zeros(mujoco.mjNGAIN)
    # by name: one that was configured in its actuator does not say of which plugin it is, and one
    # that is left behind without an actuator ends the engine
    for instance in list(spec.plugins):
        if instance.name in instances:
            spec.delete(instance)
    spec.nuserdata = max(spec.nuserdata, 0) + plugin_state


def _make_live(
    spec: mujoco.MjSpec, places: Sequence[DeviceInModel], laws: Mapping[str, str]
) -> dict[str, dict[str, float]]:
    """Give devices their laws, and every parameter with a slider a numeric; the values."""
    first: dict[str, dict[str, float]] = {}
    for place in places:
        actuator = spec.actuators[place.actuator]
        name = actuator.name = actuator.name or f"device_{place.actuator}"
        device, instance = place.device, spec.plugin(actuator.plugin.name)
        if name in laws and laws[name] != device.friction:
            device = with_law(device, laws[name])
            instance.config = {key: str(value) for key, value in device.given.items()}
            actuator.actdim = device.nstate or -1
        first[name] = {key: value_of(device, key) for key in keys_of(device)}
        for key in parameters():
            numeric = spec.numeric(f"{name}.{key}")
            if numeric is not None and key in first[name]:
                first[name][key] = float(numeric.data[0])
            elif numeric is None and key in first[name]:
                spec.add_numeric(name=f"{name}.{key}", data=[first[name][key]], size=1)
            elif numeric is not None and name in laws:
                spec.delete(numeric)  # of the law that it had
    return first
