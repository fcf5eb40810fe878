"""Where a device is in a compiled model: its configuration, its sensor values, its states."""

from __future__ import annotations

import ctypes
import functools
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from inerter.core import Device, DeviceError, lists, parameters
from inerter.motion_units import ROTATION, TRANSLATION, Kind
from inerter.parameter_text import value_text
from inerter.plugin import plugin_path

PLUGIN = "inerter.device"
# what the compiled model calls it: the second name where no sensor reads the device
_COMPILED = (PLUGIN.encode(), f"{PLUGIN}.quiet".encode())
# level [N] of friction that a live one of 0 stands for, as in the plugin
_OPEN = 1e-30
# what states the inertance of a fluid in its channel
_CHANNEL = {"piston_area", "channel_area", "channel_length", "fluid_density"}


@dataclass(frozen=True)
class DeviceInModel:
    """One `inerter.device` of a compiled model.

    name: of its actuator ("" without). actuator: index of the actuator, instance: of the plugin
    instance. device: as configured. sensor: address in `sensordata` by name (total, inertance,
    friction [N], each state, stored_energy, dissipated_energy [J]); empty where no sensor reads the
    device. act: address in `mjData.act` by the state's name. live: address in
    `mjModel.numeric_data` of the parameters that the plugin reads there at every evaluation.
    """

    name: str
    actuator: int
    instance: int
    device: Device
    sensor: Mapping[str, int]
    act: Mapping[str, int]
    live: Mapping[str, int]

    def read(self, sensordata: ArrayLike) -> dict[str, NDArray[np.float64]]:
        """The device's share of sensor data, by name.

        Parameters
        ----------
        sensordata : array_like (..., nsensordata)
            `mjData.sensordata`, or that of many steps or many worlds.

        Returns
        -------
        dict of ndarray (...)
            Copies: total, inertance, friction [N], each state, stored_energy, dissipated_energy
            [J].

        Raises
        ------
        ValueError
            No sensor reads the device.
        """
        if not self.sensor:
            raise ValueError(
                f"no sensor reads device {self.name!r}; add <sensor><plugin "
                'plugin="inerter.device" instance="..."/></sensor>'
            )
        values = np.asarray(sensordata, dtype=float)
        return {name: values[..., address].copy() for name, address in self.sensor.items()}

    def now(self, model: mujoco.MjModel) -> Device:
        """The device with the values that the model holds at present, for displacements.

        Its rest length is 0, because a displacement is counted from it. The values are the live
        parameters, and `actuator_armature` and `actuator_damping` where the engine integrates the
        inertance and the viscous damping.

        Raises
        ------
        DeviceError
            The values cannot be; an armature that is edited where a channel states the inertance
            is among them, as no channel has that inertance and these losses.
        """
        edited: dict[str, Any] = self._edited(model)
        return self.device.replace(**{**edited, **self._held(model), "rest_length": 0.0})

    def _held(self, model: mujoco.MjModel) -> dict[str, Any]:
        """What the live parameters and lists are."""
        found = {}
        for key, place in self.live.items():
            size = int(model.numeric_size[np.flatnonzero(model.numeric_adr == place)[0]])
            values = model.numeric_data[place : place + size].tolist()
            found[key] = value_text(values) if key in lists() else values[0]
        if self.device.friction != "none" and found.get("coulomb_force") == 0.0:
            found["coulomb_force"] = _OPEN
            if found.get("static_force") == 0.0:
                found["static_force"] = _OPEN
        return found

    def _edited(self, model: mujoco.MjModel) -> dict[str, float]:
        """What the engine integrates, where it is not what is configured."""
        # the plugin's own mark (placement.c); behind a series element the flywheel is a state
        if model.actuator_gainprm[self.actuator, -1] <= 0:
            return {}
        damping = float(model.actuator_damping[self.actuator])
        # damping that bends is the plugin's as a whole
        held = {"viscous": damping} if damping or not self._bends() else {}
        series = self.device.series_stiffness > 0 or self.device.series_damping > 0
        # behind a leak it is one, too
        series |= "flywheel_velocity" in self.device.state_names
        if not (series or _CHANNEL & self.live.keys()):
            held["inertance"] = float(model.actuator_armature[self.actuator])
        return {
            key: value
            for key, value in held.items()
            if value != getattr(self.device, key) and key != self.device.control
        }

    def _bends(self) -> bool:
        known = self.device
        bends = (
            (known.damping_knee, known.damping_beyond),
            (known.damping_knee_back, known.damping_beyond_back),
        )
        return (
            known.damping_asymmetry != 0
            or known.damper_stiffness > 0
            or any(knee > 0 and beyond != 1 for knee, beyond in bends)
        )

    def stated(self, model: mujoco.MjModel) -> dict[str, float | str]:
        """What configuration and live parameters state, by name, SI units."""
        return {**self.device.given, **self._held(model)}

    def rest_length(self, model: mujoco.MjModel) -> float:
        """Length of the actuator at which the displacement is 0 [m] (a hinge: rad)."""
        if "rest_length" in self.live:
            return float(model.numeric_data[self.live["rest_length"]])
        return self.device.rest_length


def evaluate(
    device: Device,
    x: NDArray[np.float64],
    v: NDArray[np.float64],
    a: NDArray[np.float64],
    states: Mapping[str, NDArray[np.float64]],
    command: ArrayLike = np.nan,
) -> dict[str, NDArray[np.float64]]:
    """Forces and energies of a device at given displacement, velocity, acceleration and states.

    Parameters
    ----------
    device : Device
        The device.
    x, v, a : ndarray (n,)
        [m], [m/s], [m/s^2].
    states : mapping of ndarray (n,)
        By name, every state of the device.
    command : array_like (n,)
        Of a control that sets a parameter, in its unit.

    Returns
    -------
    dict of ndarray (n,)
        total, inertance, friction [N], stored_energy [J].
    """
    z = np.column_stack([states[name] for name in device.state_names]) if states else 0.0
    found = device.evaluate(x, v, a, z, command)
    return {name: found[name] for name in ("total", "inertance", "friction", "stored_energy")}


def sensor_names(device: Device) -> tuple[str, ...]:
    """Names of what a device's sensor shows, in order."""
    forces = ("total", "inertance", "friction")
    return (*forces, *device.state_names, "stored_energy", "dissipated_energy")


def motion_of(model: mujoco.MjModel, actuator: int) -> Kind:
    """Whether an actuator turns a joint or moves along a line."""
    if model.actuator_trntype[actuator] == mujoco.mjtTrn.mjTRN_TENDON:
        return TRANSLATION
    joint = model.jnt_type[model.actuator_trnid[actuator, 0]]
    return ROTATION if joint == mujoco.mjtJoint.mjJNT_HINGE else TRANSLATION


def devices_of(model: mujoco.MjModel) -> list[DeviceInModel]:
    """Every `inerter.device` of a compiled model, in the order of the actuators.

    Raises
    ------
    DeviceError
        A configuration that the installed core does not know (a model saved by another version).
    """
    found = []
    for actuator in range(model.nactuator):
        instance = int(model.actuator_plugin[actuator])
        if instance >= 0 and _plugin(int(model.plugin[instance])).name in _COMPILED:
            found.append(_device(model, actuator, instance))
    return found


def device_of(model: mujoco.MjModel, name: str) -> DeviceInModel:
    """The `inerter.device` on an actuator, by the actuator's name.

    Raises
    ------
    ValueError
        There is none; the message lists the devices of the model.
    """
    devices = {found.name: found for found in devices_of(model)}
    if name not in devices:
        listed = ", ".join(map(repr, devices)) or "none"
        raise ValueError(f"no device {name!r} in the model; its devices: {listed}")
    return devices[name]


def _device(model: mujoco.MjModel, actuator: int, instance: int) -> DeviceInModel:
    name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_ACTUATOR, actuator) or ""
    try:
        device = Device(**_configuration(model, instance))
    except DeviceError as error:
        raise DeviceError(f"device {name!r}: {error}") from None

    # the first sensor that reads the instance
    readers = np.flatnonzero(model.sensor_plugin == instance)
    start = int(model.sensor_adr[readers[0]]) if readers.size else 0
    sensor = {key: start + i for i, key in enumerate(sensor_names(device))}
    first = int(model.actuator_actadr[actuator])
    return DeviceInModel(
        name=name,
        actuator=actuator,
        instance=instance,
        device=device,
        sensor=sensor if readers.size else {},
        act={key: first + i for i, key in enumerate(device.state_names)},
        live=_live(model, instance),
    )


def _live(model: mujoco.MjModel, instance: int) -> dict[str, int]:
    """Addresses of the numerics that hold parameters of an instance, as the plugin finds them."""
    found = {}
    # one place between them, that of gas_law (no number that could be live)
    keys = (*parameters(), "", *lists())
    for i, key in enumerate(keys if model.nnumeric else ()):
        address = plugin_library().inerter_live_address(model._address, instance, i)
        if address >= 0:
            found[key] = address
    return found


@functools.cache
def plugin_library() -> ctypes.CDLL:
    """The plugin, for what it tells of a model."""
    library = ctypes.CDLL(str(plugin_path()))
    at = ctypes.c_void_p
    library.inerter_live_address.argtypes = [at, ctypes.c_int, ctypes.c_int]
    library.inerter_device_force.argtypes = [at, at, at, at, at, ctypes.c_char_p]
    library.inerter_felt_acceleration.argtypes = [at, at, at, at, ctypes.c_char_p]
    return library


# --- what the Python binding of the engine leaves out -------------------------------------------


class _Plugin(ctypes.Structure):
    # the first fields of mjpPlugin (mujoco/mjplugin.h)
    _fields_ = [
        ("name", ctypes.c_char_p),
        ("nattribute", ctypes.c_int),
        ("attributes", ctypes.POINTER(ctypes.c_char_p)),
    ]


@functools.cache
def _engine() -> ctypes.CDLL:
    folder = Path(mujoco.__file__).parent
    for pattern in ("libmujoco.so*", "libmujoco*.dylib", "mujoco.dll"):
        for path in folder.glob(pattern):
            engine = ctypes.CDLL(str(path))
            engine.mj_getPluginConfig.restype = ctypes.c_char_p
            engine.mj_getPluginConfig.argtypes = [ctypes.c_void_p, ctypes.c_int, ctypes.c_char_p]
            engine.mjp_getPluginAtSlot.restype = ctypes.POINTER(_Plugin)
            return engine
    raise ImportError(f"no MuJoCo library in {folder}; run `pip install --force-reinstall mujoco`")


def _plugin(slot: int) -> Any:
    return _engine().mjp_getPluginAtSlot(slot).contents


def _configuration(model: mujoco.MjModel, instance: int) -> dict[str, str]:
    """Keys and texts of a plugin instance; what was not stated is left out."""
    plugin = _plugin(int(model.plugin[instance]))
    found = {}
    for key in plugin.attributes[: plugin.nattribute]:
        text = _engine().mj_getPluginConfig(model._address, instance, key)
        if text:
            found[key.decode()] = text.decode()
    return found
