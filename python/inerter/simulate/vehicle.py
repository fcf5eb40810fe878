"""The columns of a vehicle record, where a model's sensors and inputs carry their names.

`road`: the control of an actuator, a joint, or the height of a mocap body of that name.
`body_acceleration`, `wheel_acceleration` [m/s^2], `suspension_travel` [m], `tyre_force` [N]:
sensors with one value, or `framelinacc`, whose vertical part is taken and from which the engine's
share of gravity is removed.
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
        self.readers = found if "road" in found and len(found) > 1 else {}
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


def _road(model: mujoco.MjModel) -> _Reader | None:
    objects = mujoco.mjtObj
    actuator = mujoco.mj_name2id(model, objects.mjOBJ_ACTUATOR, "road")
    if actuator >= 0 and model.actuator_ctrlnum[actuator] == 1:
        control = int(model.actuator_ctrladr[actuator])
        return lambda data: data.ctrl[control]
    joint = mujoco.mj_name2id(model, objects.mjOBJ_JOINT, "road")
    if joint in scalar_joints(model):
        position = int(model.jnt_qposadr[joint])
        return lambda data: data.qpos[position]
    body = mujoco.mj_name2id(model, objects.mjOBJ_BODY, "road")
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
