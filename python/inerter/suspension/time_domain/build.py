"""What the MuJoCo cars share while they are made: devices that live in fields, tendons, sensors."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import mujoco

from inerter.core import Device
from inerter.suspension.time_domain.cases import Case

Keys = tuple[str, ...]
Laws = tuple[str, Keys]
"""Friction law and keys of the parameters: what a compiled model depends on."""

# a force that no tyre reaches [N]
_NO_LIMIT = 1e9

_SENSORS = {
    "joint": (mujoco.mjtSensor.mjSENS_JOINTPOS, mujoco.mjtObj.mjOBJ_JOINT),
    "tendon": (mujoco.mjtSensor.mjSENS_TENDONPOS, mujoco.mjtObj.mjOBJ_TENDON),
}


# of the others 1 is a value that can be
_PLACEHOLDERS = {"stop_lower": -1.0, "friction_asymmetry": 0.5}


def laws_of(case: Case) -> Laws:
    """What of a case cannot be changed in a compiled model."""
    return case.friction, tuple(sorted(case.parameters))


def switch_off_contacts(spec: Any) -> None:
    """There are none; looking for them takes time."""
    flags = mujoco.mjtDisableBit
    spec.option.disableflags = int(flags.mjDSBL_CONTACT | flags.mjDSBL_CONSTRAINT)


def configuration(laws: Laws) -> dict[str, str]:
    """Of a device's instance: not 0, so that every state is there; designs overwrite it."""
    friction, keys = laws
    values = {key: repr(_PLACEHOLDERS.get(key, 1.0)) for key in keys}
    return {"inertance": "1", "friction": friction} | values


def number_of_states(laws: Laws) -> int:
    """Of the device of such a configuration."""
    return Device(**configuration(laws)).nstate


def carried_by_plugin(laws: Laws) -> bool:
    """Whether the inertance is no armature of the engine's even inside one branch."""
    series = Case("", "", "none", dict.fromkeys(laws[1], 1.0)).has_series
    return series or any(key.startswith("inertance_") for key in laws[1])


def add_live(spec: Any, name: str, keys: Sequence[str]) -> None:
    """Parameters of device `name` that can be changed without compiling."""
    for key in keys:
        spec.add_numeric(name=f"{name}.{key}", data=[_PLACEHOLDERS.get(key, 1.0)], size=1)


def keep_sensors(spec: Any, kept: Sequence[str], added: Sequence[tuple[str, str, str]]) -> None:
    """Only what is read; `added`: name, "joint" or "tendon", and which."""
    for sensor in list(spec.sensors):
        if sensor.name not in kept:
            spec.delete(sensor)
    for name, of, target in added:
        kind, type_of = _SENSORS[of]
        spec.add_sensor(name=name, type=kind, objtype=type_of, objname=target)


def add_load(spec: Any, target: str, transmission: Any) -> None:
    """A force on the body."""
    load = spec.add_actuator(
        name="load", target=target, trntype=transmission, gear=[1, 0, 0, 0, 0, 0]
    )
    load.set_to_motor()


def set_tyre(road: Any, stiffness: float, static_load: float | None) -> None:
    """Stiffness [N/m] of a tyre; with its static load [N] it cannot pull by more than that."""
    road.gainprm[0], road.biasprm[1] = stiffness, -stiffness
    if static_load is not None:
        road.forcelimited = True
        road.forcerange = [-static_load, _NO_LIMIT]


def control_of(model: mujoco.MjModel, actuator: str) -> int:
    """Address of an actuator's control."""
    return int(model.actuator_ctrladr[model.actuator(actuator).id])
