"""The columns of a vehicle record, where a model's sensors and inputs carry their names.

`road`: the control of an actuator, a joint, or the height of a mocap body of that name.
`body_acceleration`, `wheel_acceleration` [m/s^2], `suspension_travel` [m], `tyre_force` [N]:
sensors with one value, or `framelinacc`, whose vertical part is taken and from which the engine's
share of gravity is removed.

A model with several wheels has a road each, `road_WHEEL`, and then its channels carry the names of
the wheels: `tyre_force_WHEEL` [N], `suspension_travel_WHEEL` [m] from the tendon length
`strut_length_WHEEL` less that of the reference pose; of the body `heave` [m], `pitch`, `roll`
[rad], `body_acceleration` [m/s^2], and `pitch_acceleration`, `roll_acceleration` [rad/s^2] from
`frameangacc`, about the y and the x axis. WHEEL is front, rear, front_left and so on.
"""

from __future__ import annotations

from collections.abc import Callable

import mujoco
import numpy as np
from numpy.typing import NDArray

from inerter.records.record import VehicleRecord
from inerter.simulate.load import scalar_joints

_Reader = Callable[[mujoco.MjData], float]


class VehicleSensors:
    """Samples those columns; nothing where there is no road or none of the others."""

    def __init__(self, model: mujoco.MjModel, samples: int) -> None:
        readers = {"road": _road(model)}
        readers |= {name: _sensor(model, name) for name in VehicleRecord.optional}
        found = {name: reader for name, reader in readers.items() if reader is not None}
        found = found if "road" in found else _of_many_wheels(model)
        self.readers = found if len(found) > 1 else {}
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


def _of_many_wheels(model: mujoco.MjModel) -> dict[str, _Reader]:
    """Roads and channels by wheel; none where no road is named after one."""
    found: dict[str, _Reader] = {}
    names = [model.actuator(n).name for n in range(model.nu)]
    wheels = [name.removeprefix("road_") for name in names if name.startswith("road_")]
    for wheel in wheels:
        _put(found, f"road_{wheel}", _road(model, f"road_{wheel}"))
    for name in ("heave", "pitch", "roll", "body_acceleration"):
        _put(found, name, _sensor(model, name))
    turning = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SENSOR, "body_angular_acceleration")
    if turning >= 0 and model.sensor_type[turning] == mujoco.mjtSensor.mjSENS_FRAMEANGACC:
        address = int(model.sensor_adr[turning])
        for name, axis in (("roll", 0), ("pitch", 1)):
            if name in found:
                found[f"{name}_acceleration"] = _value(address + axis)
    for wheel in wheels:
        _put(found, f"suspension_travel_{wheel}", _travel(model, f"strut_length_{wheel}"))
        _put(found, f"tyre_force_{wheel}", _sensor(model, f"tyre_force_{wheel}"))
    return found if wheels else {}


def _put(found: dict[str, _Reader], name: str, reader: _Reader | None) -> None:
    if reader is not None:
        found[name] = reader


def _value(address: int, less: float = 0.0) -> _Reader:
    return lambda data: data.sensordata[address] - less


def _travel(model: mujoco.MjModel, name: str) -> _Reader | None:
    index = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SENSOR, name)
    if index < 0 or model.sensor_type[index] != mujoco.mjtSensor.mjSENS_TENDONPOS:
        return None
    tendon = int(model.sensor_objid[index])
    return _value(int(model.sensor_adr[index]), float(model.tendon_length0[tendon]))


def _road(model: mujoco.MjModel, name: str = "road") -> _Reader | None:
    objects = mujoco.mjtObj
    actuator = mujoco.mj_name2id(model, objects.mjOBJ_ACTUATOR, name)
    if actuator >= 0 and model.actuator_ctrlnum[actuator] == 1:
        control = int(model.actuator_ctrladr[actuator])
        return lambda data: data.ctrl[control]
    joint = mujoco.mj_name2id(model, objects.mjOBJ_JOINT, name)
    if joint in scalar_joints(model):
        position = int(model.jnt_qposadr[joint])
        return lambda data: data.qpos[position]
    body = mujoco.mj_name2id(model, objects.mjOBJ_BODY, name)
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
        return lambda data: data.sensordata[address]
    if model.sensor_type[index] == mujoco.mjtSensor.mjSENS_FRAMELINACC:
        return lambda data: data.sensordata[address + 2] + model.opt.gravity[2]
    return None
