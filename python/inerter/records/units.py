"""Units in column headers: ``displacement[mm]`` -> ("displacement", "mm") -> factor 0.001."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from inerter.motion_units import ROTATION, TRANSLATION, Kind
from inerter.unit_text import parse_unit, unit_registry

from .header import split_header
from .record import RecordError
from .turning import UNITS, turns

__all__ = ["QUANTITIES", "Quantity", "motion_of_unit", "si_factor", "split_header"]

_LENGTH = "m, mm, um, cm, in, ft"
_FORCE = "N, kN, lbf, kgf"
_SPEED = "m/s, mm/s, km/h, in/s"
_ACCELERATION = "m/s^2, mm/s^2, g (standard gravity)"


@dataclass(frozen=True)
class Quantity:
    """What a column of this name holds: its SI unit and the units worth naming in an error."""

    meaning: str
    unit: str
    allowed: str


LENGTH = Quantity("a length", "m", _LENGTH)
FORCE = Quantity("a force", "N", _FORCE)
SPEED = Quantity("a velocity", "m/s", _SPEED)
ACCELERATION = Quantity("an acceleration", "m/s^2", _ACCELERATION)

QUANTITIES: dict[str, Quantity] = {
    "time": Quantity("a time", "s", "s, ms, us, min"),
    "displacement": LENGTH,
    "force": FORCE,
    "velocity": SPEED,
    "acceleration": ACCELERATION,
    # of terminal 1 and 2, whose difference is that of the device
    "acceleration_1": ACCELERATION,
    "acceleration_2": ACCELERATION,
    "frequency": Quantity("a frequency", "Hz", "Hz, kHz, rad/s, rpm"),
    "force_amplitude": FORCE,
    "acceleration_amplitude": ACCELERATION,
    "road": LENGTH,
    "body_acceleration": ACCELERATION,
    "wheel_acceleration": ACCELERATION,
    "suspension_travel": LENGTH,
    "tyre_force": FORCE,
}

ANGLE = Quantity("an angle", "rad", "rad, mrad, deg, rev")
TORQUE = Quantity("a torque", "N*m", "N*m, mN*m, kN*m, lbf*ft, lbf*in")
ANGULAR_SPEED = Quantity("an angular velocity", "rad/s", "rad/s, deg/s, rpm, rev/s")
ANGULAR_ACCELERATION = Quantity("an angular acceleration", "rad/s^2", "rad/s^2, deg/s^2, rev/s^2")

_OF_UNIT = {q.unit: q for q in (ANGLE, TORQUE, ANGULAR_SPEED, ANGULAR_ACCELERATION)}
TURNING: dict[str, Quantity] = {name: _OF_UNIT[unit] for name, unit in UNITS.items()}
"""What the columns of a device that turns hold."""

# what benches and seismographs call accelerations [m/s^2]; pint reads a gram, a gallon
_GRAVITIES = {
    "g": 1.0, "G": 1.0, "gn": 1.0, "g0": 1.0, "g_n": 1.0, "g's": 1.0, "mg": 1e-3, "ug": 1e-6,
    "%g": 1e-2,
}  # fmt: skip
ACCELERATIONS = {unit: 9.80665 * size for unit, size in _GRAVITIES.items()}
ACCELERATIONS |= {"Gal": 1e-2, "gal": 1e-2, "mGal": 1e-5, "mgal": 1e-5}


def quantity_in(motion: Kind, name: str) -> Quantity:
    """What a column of this name holds in a record of a motion."""
    return TURNING[name] if motion == ROTATION and name in TURNING else QUANTITIES[name]


def motion_of_unit(name: str, unit: str | None) -> Kind | None:
    """The motion that the unit of a column tells; None where it tells none."""
    if unit is None or name not in TURNING:
        return None
    if name.startswith("acceleration") and unit in ACCELERATIONS:
        return TRANSLATION
    parsed = parse_unit(unit)
    if parsed is None:
        return None
    if turns(name, parsed):
        return ROTATION
    along = parsed.dimensionality == parse_unit(QUANTITIES[name].unit).dimensionality
    return TRANSLATION if along else None


def si_factor(name: str, unit: str | None, where: str, column: str = "NAME") -> float:
    """Factor from `unit` to the SI unit of the quantity `name` (a key of `QUANTITIES`).

    Of a device that turns, units of angles and torques are as good, see `TURNING`.

    where: file and column as they should stand in the error text; column: its name alone.
    Raises RecordError for a unit that is unknown or belongs to another quantity.
    """
    quantity = QUANTITIES[name]
    if unit is None or unit == quantity.unit:
        return 1.0
    if quantity is ACCELERATION and unit in ACCELERATIONS:
        return ACCELERATIONS[unit]
    parsed = parse_unit(unit)
    if parsed is None:
        raise RecordError(
            f"{where}: unknown unit {unit!r}{_closest(unit, quantity)}; "
            f"{name} is {quantity.meaning}, write for example one of: {quantity.allowed}"
        )
    if parsed.dimensionality == parse_unit("V").dimensionality:
        raise RecordError(
            f"{where}: {name} is in {unit}; state its calibration, such as --column "
            f"{name}='200 {quantity.unit}/{unit} * {column}'"
        )
    if quantity is FORCE and parsed.dimensionality == parse_unit("A").dimensionality:
        raise RecordError(
            f"{where}: {name} is a current; state the motor's constant, such as --column "
            f"{name}='0.5 N*m/{unit} * {column}' for a torque, or N/{unit} for a force"
        )
    if turns(name, parsed):
        return float((1 * parsed).to_base_units().magnitude)
    if parsed.dimensionality != parse_unit(quantity.unit).dimensionality:
        raise RecordError(
            f"{where}: unit {unit!r} is not {quantity.meaning}{_mass_hint(unit, quantity)}; "
            f"write for example one of: {quantity.allowed}, or leave it out for {quantity.unit}"
            + (f"; of a device that turns: {TURNING[name].allowed}" if name in TURNING else "")
        )
    base = unit_registry().Quantity(1.0, parsed).to_base_units()
    factor = float(base.magnitude)
    # a frequency stated as an angle per time: pint counts radians, a hertz is a whole turn
    if name == "frequency" and "radian" in str(base.units):
        factor /= 2.0 * math.pi
    return factor


def _closest(unit: str, quantity: Quantity) -> str:
    """`` (did you mean 'kN'?)`` where only the case or a blank differs."""
    for known in re.split(r", ", quantity.allowed):
        known = known.split(" ")[0]
        if known.casefold() == unit.casefold().replace(" ", ""):
            return f" (did you mean {known!r}?)"
    return ""


def _mass_hint(unit: str, quantity: Quantity) -> str:
    """Masses are the usual slip in a force column."""
    if quantity is FORCE and unit in {"kg", "g", "lb", "t"}:
        return f" but a mass (did you mean {'lbf' if unit == 'lb' else 'kgf'!r}?)"
    return ""
