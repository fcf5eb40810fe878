"""The columns of a vehicle record, where a model's sensors and inputs carry their names.

`road`: the control of an actuator, a joint, or the height of a mocap body of that name.
`body_acceleration`, `wheel_acceleration` [m/s^2], `suspension_travel` [m], `tyre_force` [N]:
sensors with one value, or `framelinacc`, whose vertical part is taken and from which the engine's
share of gravity is removed.

A vehicle of several axles has them with what tells its wheels apart, `road_front`,
`tyre_force_rear_left`; beside them `heave` [m], `pitch`, `roll` [rad], `strut_length_...` [m] and,
of a sensor `body_angular_acceleration`, `roll_acceleration` and `pitch_acceleration` [rad/s^2].
"""

from __future__ import annotations

from collections.abc import Callable

import mujoco
import numpy as np
from numpy.typing import NDArray

from inerter.records.record import VehicleRecord
from inerter.simulate.load import scalar_joints

_Reader = Callable[[mujoco.MjData], float]
_ROAD = "road"
_BODY = ("heave", "pitch", "roll", "strut_length")
_TURNING = "body_angular_acceleration"


def column_unit(name: str) -> str:
    """The unit of a vehicle's column, by its name."""
    if name in ("pitch", "roll"):
        return "rad"
    if name in ("pitch_acceleration", "roll_acceleration"):
        return "rad/s^2"
    if "acceleration" in name:
        return "m/s^2"
    return "N" if name.startswith("tyre_force") else "m"


class VehicleSensors:
    """Samples those columns; nothing where there is no road or none of the others."""

    def __init__(self, model: mujoco.MjModel, samples: int) -> None:
        roads = _roads(model)
        others = {
            name: reader
            for name in _wanted(model, len(roads) > 1)
            if (reader := _sensor(model, name)) is not None
        }
        if len(roads) > 1:
            others |= _turning(model)
        self.readers = roads | others if roads and others else {}
        self.values = {name: np.empty(samples) for name in self.readers}
        self.count = 0

    def take(self, data: mujoco.MjData) -> None:
        """Sample data after a forward pass."""
        for name, reader in self.readers.items():
            self.values[name][self.count] = reader(data)
        self.count += 1

    def columns(self, time: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
        """The columns by name, with time [s]; empty where the model is no vehicle."""
        return {"time": time, **self.values} if self.readers else {}


def _roads(model: mujoco.MjModel) -> dict[str, _Reader]:
    """The road, or one for each wheel."""
    one = _road(model)
    if one is not None:
        return {_ROAD: one}
    return {
        model.actuator(i).name: _control(int(model.actuator_ctrladr[i]))
        for i in range(model.nactuator)
        if model.actuator(i).name.startswith(f"{_ROAD}_") and model.actuator_ctrlnum[i] == 1
    }


def _control(address: int) -> _Reader:
    return lambda data: data.ctrl[address]


def _wanted(model: mujoco.MjModel, several: bool) -> list[str]:
    """Names of sensors; of a vehicle with several wheels those that begin like them too."""
    kinds = (*VehicleRecord.optional, *_BODY)
    if not several:
        return list(VehicleRecord.optional)
    names = [model.sensor(i).name for i in range(model.nsensor)]
    return [n for n in names if n in kinds or any(n.startswith(f"{kind}_") for kind in kinds)]


def _turning(model: mujoco.MjModel) -> dict[str, _Reader]:
    """Angular accelerations of the body about x and y."""
    index = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SENSOR, _TURNING)
    if index < 0 or model.sensor_dim[index] != 3:
        return {}
    address = int(model.sensor_adr[index])
    joints = {model.joint(i).name for i in range(model.njnt)}
    axes = [(name, axis) for axis, name in enumerate(("roll", "pitch")) if name in joints]
    return {f"{name}_acceleration": _value(address + axis) for name, axis in axes}


def _value(address: int) -> _Reader:
    return lambda data: data.sensordata[address]


def _road(model: mujoco.MjModel) -> _Reader | None:
    objects = mujoco.mjtObj
    actuator = mujoco.mj_name2id(model, objects.mjOBJ_ACTUATOR, _ROAD)
    if actuator >= 0 and model.actuator_ctrlnum[actuator] == 1:
        return _control(int(model.actuator_ctrladr[actuator]))
    joint = mujoco.mj_name2id(model, objects.mjOBJ_JOINT, _ROAD)
    if joint in scalar_joints(model):
        position = int(model.jnt_qposadr[joint])
        return lambda data: data.qpos[position]
    body = mujoco.mj_name2id(model, objects.mjOBJ_BODY, _ROAD)
    if body >= 0 and model.body_mocapid[body] >= 0:
        mocap = int(model.body_mocapid[body])
        return lambda data: data.mocap_pos[mocap, 2]
    return None


def _sensor(model: mujoco.MjModel, name: str) -> _Reader | None:
    index = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SENSOR, name)
    if index < 0:
        return None
    address = int(model.sensor_adr[index])
    if model.sensor_dim[index] == 1:
        return _value(address)
    if model.sensor_type[index] == mujoco.mjtSensor.mjSENS_FRAMELINACC:
        return lambda data: data.sensordata[address + 2] + model.opt.gravity[2]
    return None
