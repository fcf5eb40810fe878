"""Which car the options ask for, and the refusal of options that are another car's."""

from __future__ import annotations

import math
from collections.abc import Mapping

from inerter.cars.keys import AXLE_KEYS, CAR_KEYS, STRUT_KEYS
from inerter.cars.parts import AxleParts, CarParts
from inerter.cars.read import read_car
from inerter.model_parameters import QUARTER_CAR
from inerter.suspension.indices import INDICES
from inerter.suspension.quarter_car import QuarterCar, Road
from inerter.suspension.study import (
    Study,
    StudyError,
    read_axle_stiffnesses,
    read_catalogue,
    read_layouts,
    read_names,
    read_pairs,
    read_series,
    read_stiffnesses,
)
from inerter.suspension.variations import OF_CAR, OF_PARTS
from inerter.suspension.vehicle.cars import Axle, FullCar, HalfCar, Vehicle, full_car, half_car

_HELD = ("damping", "inertance", "relaxation_stiffness")
CARS = ("quarter", "half", "full")
_KEYS = {
    "sprung_mass": ("car.body_mass", CAR_KEYS["body_mass"], "kg"),
    "unsprung_mass": ("front.wheel_mass", AXLE_KEYS["wheel_mass"], "kg"),
    "tyre_stiffness": ("front.tyre_stiffness", AXLE_KEYS["tyre_stiffness"], "N/m"),
}


def chosen_car(
    name: str,
    quarter: Mapping[str, float | None],
    *,
    equal: bool = False,
    correlation: float | None = None,
) -> QuarterCar | Vehicle:
    """The car of a name.

    Parameters
    ----------
    name
        "quarter", "half" or "full".
    quarter
        Parameters of the quarter-car by name; None where not given.
    equal, correlation
        Options of the other cars, as given.

    Raises
    ------
    StudyError
        The name is not known, or an option belongs to another car.
    ValueError
        A value is out of its range.
    """
    given = {key: value for key, value in quarter.items() if value is not None}
    if name.lower().endswith(".toml"):
        return _own_car(name, given, equal=equal, correlation=correlation)
    names = read_names(name, CARS, "car")
    if len(names) != 1:
        raise StudyError(f"car {name!r}: choose one of {', '.join(CARS)}, or a file car.toml")
    if names[0] == "quarter":
        if equal:
            raise StudyError("--equal is of cars with two axles: give --car half or --car full")
        _only_full(correlation)
        for key, value in given.items():
            _refuse_unusual(key, value)
        return QuarterCar(**given)
    if given:
        options = ", ".join("--" + key.replace("_", "-") for key in given)
        raise StudyError(
            f"{options}: of the quarter-car; --car {names[0]} is a published set; write another "
            "car into a file, --car car.toml"
        )
    if names[0] == "half":
        _only_full(correlation)
        return half_car()
    return full_car() if correlation is None else full_car(correlation)


def _refuse_unusual(name: str, value: float) -> None:
    """Raise StudyError for a value that a car's file would ask about: its unit may be another."""
    place, key, unit = _KEYS[name]
    # what is not positive is another error
    if not (math.isfinite(value) and value > 0.0) or key.low <= value <= key.high:
        return
    raise StudyError(
        f"--{name.replace('_', '-')} is {value:g} {unit}, {key.meaning}: usual is {key.low:g} to "
        f"{key.high:g} {unit}{_meant(value, key.low, key.high, unit)} If it is right, write the "
        f'car into a file, --car car.toml, with unusual = ["{place}"] under [car]'
    )


def refuse_faint_damping(value: float, what: str) -> None:
    """Raise StudyError for a damper so weak that it most likely is in another unit."""
    key = STRUT_KEYS["damping"]
    if 0.0 < value < key.low:
        raise StudyError(
            f"{what} is {value:g} N s/m: usual is {key.low:g} N s/m and more"
            f"{_meant(value, key.low, key.high, 'N s/m').rstrip('.')}"
        )


def _meant(value: float, low: float, high: float, unit: str) -> str:
    near = [f"{value * scale:g}" for scale in (1e3, 1e-3) if low <= value * scale <= high]
    return f"; did you mean {near[0]} {unit}?" if near else "."


def study_asked(
    *,
    car: str,
    layout: str,
    indices: tuple[str, ...],
    stiffness: str | None,
    series: str,
    road: Road,
    equal: bool,
    hold: str | None,
    limit: str | None,
    quarter: Mapping[str, float | None] | None = None,
    correlation: float | None = None,
    catalogue: str | None = None,
    vary: str | None = None,
) -> Study:
    """The study that options ask for, in their words; `quarter`, `correlation`: see `chosen_car`.

    Raises
    ------
    StudyError
        A word that cannot be used.
    ValueError
        A value is out of its range.
    """
    which = chosen_car(car, quarter or {}, equal=equal, correlation=correlation)
    fixed, choices = read_pairs(hold, _HELD, "hold"), read_catalogue(catalogue, _HELD)
    refuse_faint_damping(dict(fixed).get("damping", 0.0), "--hold: damping")
    for value in dict(choices).get("damping", ()):
        refuse_faint_damping(value, "--catalogue: damping")
    return Study(
        layouts=read_layouts(layout),
        indices=indices,
        stiffnesses=chosen_stiffnesses(stiffness, which, own_stiffness(car)),
        series=read_series(series),
        car=which,
        road=road,
        equal=equal,
        fixed=fixed,
        catalogue=choices,
        vary=read_catalogue(vary, (*OF_CAR, *OF_PARTS), "vary"),
        limits=read_pairs(limit, INDICES, "limit"),
    )


def linear_car(parts: CarParts) -> QuarterCar | Vehicle:
    """The car of a file as the linear study has it; springs and dampers count at the wheel."""
    if parts.rear is None:
        return QuarterCar(
            sprung_mass=parts.body_mass,
            unsprung_mass=parts.front.wheel_mass,
            tyre_stiffness=parts.front.tyre_stiffness,
            tyre_damping=parts.front.tyre_damping,
        )
    front, rear = _axle(parts.front), _axle(parts.rear)
    if parts.kind == "half":
        return HalfCar(
            body_mass=parts.body_mass, pitch_inertia=parts.pitch_inertia, front=front, rear=rear
        )
    return FullCar(
        body_mass=parts.body_mass,
        pitch_inertia=parts.pitch_inertia,
        roll_inertia=parts.roll_inertia,
        track=parts.track,
        front=front,
        rear=rear,
        correlation=parts.correlation,
    )


def _axle(axle: AxleParts) -> Axle:
    return Axle(
        distance=axle.distance,
        wheel_mass=axle.wheel_mass,
        tyre_stiffness=axle.tyre_stiffness,
        stiffness=axle.strut.wheel_rate,
        anti_roll_stiffness=axle.anti_roll_stiffness,
        tyre_damping=axle.tyre_damping,
    )


def _own_car(
    name: str, given: Mapping[str, float], *, equal: bool, correlation: float | None
) -> QuarterCar | Vehicle:
    """The car of a file; what the file states is no option."""
    if given:
        options = ", ".join("--" + key.replace("_", "-") for key in given)
        raise StudyError(f"{options}: {name} states it; change it there")
    parts = read_car(name)
    if correlation is not None:
        if parts.kind != "full":
            _only_full(correlation)
        raise StudyError(f"--correlation: {name} states it; change it there")
    if equal and parts.rear is None:
        raise StudyError("--equal is of cars with two axles")
    return linear_car(parts)


def own_stiffness(name: str) -> float | None:
    """Stiffness at the wheel [N/m] of a quarter-car's file; None of a car by name."""
    return read_car(name).front.strut.wheel_rate if name.lower().endswith(".toml") else None


def chosen_stiffnesses(
    text: str | None, car: QuarterCar | Vehicle, own: float | None = None
) -> tuple[float, ...] | tuple[tuple[float, float], ...]:
    """Stiffnesses [N/m] of a car from the option, or its own (`own` of a quarter-car's file)."""
    if not isinstance(car, QuarterCar):
        return read_axle_stiffnesses(text, car)
    if text is not None and "/" in text:
        raise StudyError(
            f"stiffness {text!r}: KF/KR, front and rear, are of --car half and --car full"
        )
    usual = QUARTER_CAR.stiffness if own is None else own
    return read_stiffnesses(repr(usual) if text is None else text)


def _only_full(correlation: float | None) -> None:
    if correlation is not None:
        raise StudyError("--correlation is of a car with a left and a right track: give --car full")
