"""What columns of a device that turns are called and measured in."""

from __future__ import annotations

from typing import Any

from inerter.motion_units import ROTATION
from inerter.unit_text import parse_unit

UNITS = {
    "displacement": "rad",
    "force": "N*m",
    "velocity": "rad/s",
    "acceleration": "rad/s^2",
    "acceleration_1": "rad/s^2",
    "acceleration_2": "rad/s^2",
    "force_amplitude": "N*m",
    "acceleration_amplitude": "rad/s^2",
}
"""SI units of our quantities in rotation."""

OWN_NAMES = {
    "angle": "displacement",
    "torque": "force",
    "angular_velocity": "velocity",
    "angular_acceleration": "acceleration",
    "torque_amplitude": "force_amplitude",
    "angular_acceleration_amplitude": "acceleration_amplitude",
}
"""Names that the columns of a device that turns may have instead."""

WORDS = {
    "displacement": "angle winkel drehwinkel verdrehwinkel rotation theta twist angulo angolo "
    "hoek vinkel kulma угол 角度",
    "force": "torque moment drehmoment momento coppia koppel vridmoment момент トルク 扭矩",
}
"""Usual names, without accents, see `header`."""


def own_columns(record: Any) -> dict[str, Any]:
    """The channels of a record by the headers with which it can be read again."""
    channels: dict[str, Any] = record.channels()
    if record.motion != ROTATION:
        return channels
    return {f"{n}[{UNITS[n]}]" if n in UNITS else n: values for n, values in channels.items()}


def turns(name: str, parsed: Any) -> bool:
    """Whether a unit of pint is that of the quantity `name` of a device that turns."""
    if name not in UNITS or parsed is None:
        return False
    # pint counts radians and does not tell a torque from an energy: a joule is one word
    if UNITS[name] == "N*m" and len((1 * parsed).unit_items()) < 2:
        return False
    base = (1 * parsed).to_base_units().units
    return bool(base == (1 * parse_unit(UNITS[name])).to_base_units().units)
