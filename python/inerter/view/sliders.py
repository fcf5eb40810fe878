"""Which parameters of a device get a slider, and from where to where it goes."""

from __future__ import annotations

import math
from dataclasses import dataclass

from inerter.core import Device, parameters
from inerter.motion_units import TRANSLATION, Kind, parameter_unit

# always there, whatever the device states
USUAL = ("inertance", "viscous", "stiffness")
# a length that belongs to the model's geometry, and the width of sign(v)
LEFT_OUT = ("rest_length", "transition_velocity")
# end of the slider of a parameter that is 0: about that of a car's strut [SI units]
TYPICAL = {
    "inertance": 200.0,
    "viscous": 5e3,
    "stiffness": 1e5,
    "bristle_damping": 1e3,
    "friction_backlash": 2e-3,
}
TIMES = 3.0  # a slider ends at so many times the value


@dataclass(frozen=True)
class Slider:
    """A parameter with its present value and the ends of its slider, SI units."""

    key: str
    unit: str
    meaning: str
    value: float
    low: float
    high: float


def keys_of(device: Device) -> list[str]:
    """Parameters of a device that a slider changes: the usual, the friction law's, the stated."""
    keys = dict.fromkeys(USUAL)
    keys |= dict.fromkeys(p.name for p in parameters().values() if device.friction in p.laws)
    keys |= dict.fromkeys(key for key in device.given if key in parameters())
    if device.piston_area > 0:
        del keys["inertance"]  # follows from the channel
    return [
        key
        for key in keys
        if key not in LEFT_OUT
        and math.isfinite(value_of(device, key))
        and not (_is_numbered(key) and value_of(device, key) == 0)
    ]


def _is_numbered(key: str) -> bool:
    """Whether a parameter belongs to one of several alike parts, which needs all of its values."""
    return key[-1].isdigit()


def value_of(device: Device, key: str) -> float:
    """A parameter's value; for a breakaway level that is not stated the sliding one."""
    value = getattr(device, key)
    return device.coulomb_force if key == "static_force" and not math.isfinite(value) else value


def slider(key: str, stated: float, value: float, motion: Kind = TRANSLATION) -> Slider:
    """The slider of a parameter. Its ends lie within what the parameter may be."""
    parameter = parameters()[key]
    reach = TIMES * abs(stated) or TYPICAL.get(key, 1.0)
    low, high = max(parameter.lower, -reach), min(parameter.upper, reach)
    if (parameter.lower_open or _is_numbered(key)) and low == parameter.lower:
        low += 1e-3 * reach
    unit = parameter_unit(motion, key, parameter.unit)
    return Slider(key, unit, parameter.meaning, value, low, high)
