"""Units of a model's sensors."""

from __future__ import annotations

import mujoco

from inerter.diagnose.vehicle.mapping import Output
from inerter.records.units import QUANTITIES

_UNITS = {
    int(mujoco.mjtSensor.mjSENS_FRAMELINACC): "m/s^2",
    int(mujoco.mjtSensor.mjSENS_ACCELEROMETER): "m/s^2",
    int(mujoco.mjtSensor.mjSENS_FRAMEANGACC): "rad/s^2",
    int(mujoco.mjtSensor.mjSENS_TENDONPOS): "m",
    int(mujoco.mjtSensor.mjSENS_ACTUATORPOS): "m",
    int(mujoco.mjtSensor.mjSENS_TENDONVEL): "m/s",
    int(mujoco.mjtSensor.mjSENS_FRAMEPOS): "m",
    int(mujoco.mjtSensor.mjSENS_ACTUATORFRC): "N",
}


def unit_of(model: mujoco.MjModel, output: Output) -> str:
    """SI unit of an output, as far as the kind of its sensor tells."""
    if output.column in QUANTITIES:
        return QUANTITIES[output.column].unit
    sensor = model.sensor(output.sensor).id
    kind = int(model.sensor_type[sensor])
    position, rate = mujoco.mjtSensor.mjSENS_JOINTPOS, mujoco.mjtSensor.mjSENS_JOINTVEL
    if kind in (int(position), int(rate)):
        slide = model.jnt_type[model.sensor_objid[sensor]] == mujoco.mjtJoint.mjJNT_SLIDE
        length = "m" if slide else "rad"
        return length if kind == int(position) else f"{length}/s"
    if kind == int(mujoco.mjtSensor.mjSENS_PLUGIN):
        return "N" if output.component < 3 else ""
    return _UNITS.get(kind, "")
