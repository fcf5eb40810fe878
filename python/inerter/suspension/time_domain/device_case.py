"""A user's own device as a case: what of a device.toml the study carries, and what it refuses.

Carried as it stands: friction with its parameters, series element, backlash, flywheel friction,
viscous and quadratic damping, load friction, parallel stiffness, end stops, inertance that varies.
Displacements count from the ride height, so `rest_length` has no part. The inertance is the
design's. A sign(v) whose width is not stated has the study's, `TRANSITION_VELOCITY`: that of the
device model's default, a tenth of it, is not felt by a strut but asks for shorter steps.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from inerter.cars.strut_device import strut_device
from inerter.core import Device
from inerter.device_file import read_bench_device
from inerter.suspension.time_domain.cases import TRANSITION_VELOCITY, Case

NAME = "device"

# laws whose friction follows sign(v)
_SIGN = ("coulomb", "stribeck")
# speed of a strut on a rough road [m/s], and the rate at which RK4 ends
_SPEED, _RATE = 0.5, 2.5


def read_case(path: Path, step: float) -> tuple[Case, float]:
    """The case "device" of a file, and the inertance that the file states [kg].

    `step` [s] is that of the simulations.

    Raises
    ------
    ValueError
        The file cannot be read (`DeviceError`), or it has a key that the study cannot carry.
    """
    try:
        return case_of(read_bench_device(path), step)
    except ValueError as error:
        text = str(error)
        raise ValueError(text if text.startswith(str(path)) else f"{path}: {text}") from None


def case_of(device: Device, step: float) -> tuple[Case, float]:
    """The same of a device.

    Raises
    ------
    ValueError
        A key that the study cannot carry: named, with what to do.
    """
    values: dict[str, Any] = {
        key: value for key, value in strut_device(device).items() if key != "friction"
    }
    if device.friction in _SIGN or "load_friction" in values:
        values.setdefault("transition_velocity", TRANSITION_VELOCITY)
    meaning = f"the device: {', '.join([device.friction, *values])}"
    case = Case(NAME, meaning, device.friction, values, stiff=_stiff(device, values, step))
    return case, float(device.given.get("inertance", 0.0))


def _stiff(device: Device, values: dict[str, float], step: float) -> bool:
    """Whether bristles or the series element are faster than a step of RK4 can follow."""
    rate = 0.0
    level = values.get("coulomb_force", 0.0)
    if device.friction in ("dahl", "lugre") and level > 0.0:
        rate = device.bristle_stiffness * _SPEED / level
    if device.friction == "bouc_wen":
        rate = (abs(device.bw_beta) + abs(device.bw_gamma)) * _SPEED
    return rate * step > _RATE
