"""Which car the options ask for, and the refusal of options that are another car's."""

from __future__ import annotations

from collections.abc import Mapping

from inerter.model_parameters import QUARTER_CAR
from inerter.suspension.quarter_car import QuarterCar
from inerter.suspension.study import (
    StudyError,
    read_axle_stiffnesses,
    read_names,
    read_stiffnesses,
)
from inerter.suspension.vehicle.cars import Vehicle, full_car, half_car

CARS = ("quarter", "half", "full")


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
    names = read_names(name, CARS, "car")
    if len(names) != 1:
        raise StudyError(f"car {name!r}: choose one of {', '.join(CARS)}")
    given = {key: value for key, value in quarter.items() if value is not None}
    if names[0] == "quarter":
        if equal:
            raise StudyError("--equal is of cars with two axles: give --car half or --car full")
        _only_full(correlation)
        return QuarterCar(**given)
    if given:
        options = ", ".join("--" + key.replace("_", "-") for key in given)
        raise StudyError(
            f"{options}: of the quarter-car; --car {names[0]} is a published set, and another "
            "car is given in Python, see inerter.suspension.vehicle"
        )
    if names[0] == "half":
        _only_full(correlation)
        return half_car()
    return full_car() if correlation is None else full_car(correlation)


def chosen_stiffnesses(
    text: str | None, car: QuarterCar | Vehicle
) -> tuple[float, ...] | tuple[tuple[float, float], ...]:
    """Stiffnesses [N/m] of a car from the option, or its own."""
    if not isinstance(car, QuarterCar):
        return read_axle_stiffnesses(text, car)
    if text is not None and "/" in text:
        raise StudyError(
            f"stiffness {text!r}: KF/KR, front and rear, are of --car half and --car full"
        )
    return read_stiffnesses(f"{QUARTER_CAR.stiffness:g}" if text is None else text)


def _only_full(correlation: float | None) -> None:
    if correlation is not None:
        raise StudyError("--correlation is of a car with a left and a right track: give --car full")
