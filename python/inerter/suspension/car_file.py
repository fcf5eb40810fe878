"""A car from a TOML file: quarter, half or full.

    [car]
    kind = "half"                       # quarter, half or full
    body_mass_kg = 640
    pitch_inertia_kg_m2 = 980
    [front]
    distance_m = 1.2                    # from the centre of mass
    wheel_mass_kg = 38
    tyre_stiffness_kN_per_m = 210
    spring_stiffness_N_per_mm = 28      # of the spring itself
    motion_ratio = 0.8                  # travel of the strut per travel of the wheel
    [rear]
    ...

A key carries its unit, or its value does ("28 N/mm"), or it is SI. A strut of motion ratio r is
felt at the wheel as r^2 times its spring, damper and inerter: the study works at the wheel, so that
c and b of an optimum are those at the wheel; divide by r^2 for the strut's own. Keys of a
quarter-car stand in [car]: sprung_mass, unsprung_mass, tyre_stiffness, spring_stiffness,
motion_ratio.

What a linear study cannot carry (anti-roll bars, bump stops, damper tables, tyre damping) is
refused by name rather than passed over.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from inerter.input_file import read_toml
from inerter.suspension.quarter_car import QuarterCar
from inerter.suspension.vehicle.cars import Axle, FullCar, HalfCar, Vehicle
from inerter.unit_text import parse_unit, split_quantity

_UNITS = {
    "kg": ("kg", 1.0), "t": ("kg", 1e3), "g": ("kg", 1e-3),
    "kg_m2": ("kg*m^2", 1.0),
    "m": ("m", 1.0), "mm": ("m", 1e-3),
    "N_per_m": ("N/m", 1.0), "kN_per_m": ("N/m", 1e3), "N_per_mm": ("N/m", 1e3),
    "kN_per_mm": ("N/m", 1e6),
}  # fmt: skip


@dataclass(frozen=True)
class _Key:
    """Unit, range in which a car's value lies, SI, and a value in place of none."""

    unit: str
    low: float
    high: float
    usual: float | None = None


_STIFFNESS = _Key("N/m", 1e3, 2e6)
_WHEEL = {
    "wheel_mass": _Key("kg", 1.0, 1500.0),
    "tyre_stiffness": _Key("N/m", 2e4, 5e6),
    "spring_stiffness": _STIFFNESS,
    "distance": _Key("m", 0.1, 10.0),
    "motion_ratio": _Key("", 0.1, 2.0, 1.0),
}
_CARS: Mapping[str, Mapping[str, _Key]] = {
    "quarter": {
        "sprung_mass": _Key("kg", 20.0, 20e3),
        "unsprung_mass": _Key("kg", 1.0, 1500.0),
        "tyre_stiffness": _WHEEL["tyre_stiffness"],
        "spring_stiffness": _STIFFNESS,
        "motion_ratio": _WHEEL["motion_ratio"],
    },
    "half": {
        "body_mass": _Key("kg", 40.0, 40e3),
        "pitch_inertia": _Key("kg*m^2", 10.0, 1e6),
    },
    "full": {
        "body_mass": _Key("kg", 80.0, 80e3),
        "pitch_inertia": _Key("kg*m^2", 20.0, 2e6),
        "roll_inertia": _Key("kg*m^2", 5.0, 1e6),
        "track": _Key("m", 0.3, 5.0),
        "correlation": _Key("", 0.0, 1.0, 0.5),
    },
}
_NOT_LINEAR = {
    "anti_roll_bar": "couples left and right, which no car here does yet",
    "bump_stop": "is not linear: state it in a device.toml as end stops for `evaluate --device`",
    "damper_table": "is not linear: give the slope of interest with --damping",
    "tyre_damping": "is left out by every car here",
}


@dataclass(frozen=True)
class CarFile:
    """A car, its springs at the wheel [N/m] (one, or front and rear), and what to ask about."""

    name: str
    car: QuarterCar | Vehicle
    stiffnesses: tuple[float, ...]
    motion_ratios: tuple[float, ...] = (1.0,)
    questions: tuple[str, ...] = field(default=())


def read_car(path: Path) -> CarFile:
    """The car of a file.

    Raises
    ------
    ValueError
        The file cannot be read, or a key is missing, unknown, without a number, in another unit, or
        far from that of any car: one sentence with the key, its value and what is allowed.
    """
    content = read_toml(path)
    try:
        return _car(path.stem, content)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def _car(stem: str, content: Mapping[str, Any]) -> CarFile:
    section = content.get("car")
    if not isinstance(section, Mapping):
        raise ValueError('section [car] is missing: begin with [car] and kind = "quarter"')
    kind = section.get("kind", "quarter")
    if kind not in _CARS:
        raise ValueError(f"kind = {kind!r}: give {', '.join(_CARS)}")
    name = str(section.get("name", stem))
    axles = () if kind == "quarter" else ("front", "rear")
    unknown = set(content) - {"car", *axles}
    if unknown:
        sections = ", ".join(f"[{x}]" for x in ("car", *axles))
        raise ValueError(f"[{sorted(unknown)[0]}]: a {kind} car has {sections}")
    plain = {key: x for key, x in section.items() if key not in ("kind", "name")}
    own = _values("car", plain, _CARS[kind])
    if kind == "quarter":
        ratio = own.pop("motion_ratio")
        spring = own.pop("spring_stiffness") * ratio**2
        quarter = QuarterCar(**own)
        corner = (spring, own["sprung_mass"], own["unsprung_mass"], own["tyre_stiffness"])
        return CarFile(name, quarter, (spring,), (ratio,), tuple(_questions("", *corner)))
    values: dict[str, dict[str, float]] = {}
    for axle in axles:
        part = content.get(axle)
        if not isinstance(part, Mapping):
            raise ValueError(f"section [{axle}] is missing: give its {', '.join(_WHEEL)}")
        values[axle] = _values(axle, part, _WHEEL)
    springs = tuple(one["spring_stiffness"] * one["motion_ratio"] ** 2 for one in values.values())
    front, rear = (
        Axle(
            distance=one["distance"],
            wheel_mass=one["wheel_mass"],
            tyre_stiffness=one["tyre_stiffness"],
            stiffness=k,
        )
        for one, k in zip(values.values(), springs, strict=True)
    )
    car = HalfCar(front=front, rear=rear, **own) if kind == "half" else FullCar(
        front=front, rear=rear, **own
    )  # fmt: skip
    questions: list[str] = []
    for axle, corner, k in zip(axles, car.side.corners(), springs, strict=True):
        masses = corner.sprung_mass, corner.unsprung_mass, corner.tyre_stiffness
        questions += _questions(f"{axle}: ", k, *masses)
    side = car.side
    ratio = side.pitch_inertia / (side.body_mass * side.front.distance * side.rear.distance)
    if not 0.4 < ratio < 2.5:
        questions.append(
            f"pitch inertia is {ratio:.2g} times m lf lr, of cars 0.7 to 1.3: is it in kg m^2?"
        )
    ratios = tuple(one["motion_ratio"] for one in values.values())
    return CarFile(name, car, springs, ratios, tuple(questions))


def _questions(where: str, spring: float, sprung: float, unsprung: float, tyre: float) -> list[str]:
    """What is possible but unlike a car."""
    found = []
    body = math.sqrt(1.0 / (1.0 / spring + 1.0 / tyre) / sprung) / (2.0 * math.pi)
    hop = math.sqrt((spring + tyre) / unsprung) / (2.0 * math.pi)
    if not 0.6 <= body <= 6.0:
        found.append(f"{where}body at {body:.3g} Hz, of cars 1 to 4: are spring and mass right?")
    if not 5.0 <= hop <= 25.0:
        found.append(f"{where}wheel at {hop:.3g} Hz, of cars 8 to 18: are tyre and mass right?")
    return found


def _values(where: str, given: Mapping[str, Any], keys: Mapping[str, _Key]) -> dict[str, float]:
    found: dict[str, float] = {}
    for text, value in given.items():
        name, factor = _named(where, text, keys)
        if name in found:
            raise ValueError(f"[{where}] {text}: {name} is given twice")
        found[name] = factor * _number(where, text, value, keys[name], factor)
    for name, key in keys.items():
        if name not in found:
            if key.usual is None:
                raise ValueError(f"[{where}] {name} is missing: give it in {key.unit}")
            found[name] = key.usual
        if not key.low <= found[name] <= key.high:
            raise ValueError(
                f"[{where}] {name} is {found[name]:g} {key.unit}: of vehicles it is "
                f"{key.low:g} to {key.high:g}; is the unit right?".replace("  ", " ")
            )
    return found


def _named(where: str, text: str, keys: Mapping[str, _Key]) -> tuple[str, float]:
    """The key of a text and the factor of the unit that it carries."""
    if text in keys:
        return text, 1.0
    for name, key in keys.items():
        suffix = text.removeprefix(f"{name}_")
        if suffix != text and suffix in _UNITS:
            unit, factor = _UNITS[suffix]
            if unit != key.unit:
                raise ValueError(f"[{where}] {text}: {name} is in {key.unit or 'no unit'}")
            return name, factor
    for name, why in _NOT_LINEAR.items():
        if text.startswith(name):
            raise ValueError(f"[{where}] {text} {why}; leave it out")
    raise ValueError(f"[{where}] {text} is not known: choose from {', '.join(keys)}")


def _number(where: str, text: str, value: Any, key: _Key, factor: float) -> float:
    if isinstance(value, str) and factor == 1.0 and (split := split_quantity(value)):
        number, unit = split
        known = parse_unit(unit) if unit else None
        if unit and key.unit and known is not None and known.is_compatible_with(key.unit):
            return float((number * known).to(key.unit).magnitude)
    elif isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value):
        return float(value)
    unit = f' in {key.unit}, as in {key.low:g} or "{key.low:g} {key.unit}"' if key.unit else ""
    raise ValueError(f"[{where}] {text} = {value!r}: give a number{unit}")
