"""The shipped cars in the time domain; contacts, of which they have none, are switched off."""

from __future__ import annotations

from inerter.suspension.quarter_car import QuarterCar
from inerter.suspension.time_domain.car_model import CarModel
from inerter.suspension.time_domain.cases import Case
from inerter.suspension.time_domain.design import Design
from inerter.suspension.time_domain.half_car_model import half_car_model
from inerter.suspension.time_domain.quarter_car_model import quarter_car_model
from inerter.suspension.vehicle.cars import HalfCar

__all__ = ["LAYOUTS", "Car", "CarModel", "Design", "compiled"]

Car = QuarterCar | HalfCar

LAYOUTS = ("S1", "S2", "S3")
"""Layouts of which there is a MuJoCo model."""


def compiled(
    layout: str, case: Case, car: Car | None = None, *, one_sided: bool = False
) -> CarModel:
    """The model of a layout with the law of a case, the quarter-car if not told; compiled once.

    `one_sided`: a tyre leaves the road where it would have to pull by more than its static load;
    else it pulls, as in the linear study.

    Raises
    ------
    ValueError
        A layout without a MuJoCo model, or S1 (no device) with anything but the ideal case.
    """
    if layout not in LAYOUTS:
        raise ValueError(f"layout {layout!r} has no MuJoCo model: take {', '.join(LAYOUTS)}")
    if layout == "S1" and not case.ideal:
        raise ValueError(f"layout S1 has no inerter, so case {case.name!r} is not one of it")
    car = car or QuarterCar()
    if isinstance(car, HalfCar):
        return half_car_model(layout, case, car, one_sided)
    return quarter_car_model(layout, case, car, one_sided)
