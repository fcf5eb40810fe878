"""What is exact: indices, gains and optimum of the linear cases, from the linear study."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from inerter.suspension.indices import INDICES
from inerter.suspension.layouts import LAYOUTS, SeriesPair
from inerter.suspension.optimum import optimise
from inerter.suspension.problem import SuspensionProblem
from inerter.suspension.quarter_car import QuarterCar, Road
from inerter.suspension.time_domain.design import Design
from inerter.suspension.time_domain.model import Car
from inerter.suspension.time_domain.road import PeriodicRoad
from inerter.suspension.vehicle.strut import VehicleStrut, branch

Array = NDArray[np.float64]

SMALLEST_INERTANCE = 1e-3
"""[kg] in place of 0 where an inerter has to be there: too little to be felt."""


def spectrum(road: PeriodicRoad) -> Road:
    """The road of the linear study: a density of the same slope, at the same speed.

    Optima are those of that slope; norms are exact for the paper's own road.
    """
    return Road(velocity=road.speed, roughness=0.5 * road.strength / road.speed)


def stiffnesses_of(car: Car, stiffness: float) -> tuple[float, ...]:
    """Of every strut [N/m]: a half-car's rear one has the ratio to the front of the car's own."""
    if isinstance(car, QuarterCar):
        return (stiffness,)
    return stiffness, stiffness * car.rear.stiffness / car.front.stiffness


def exact_index(
    index: str, layout: str, design: Design, pair: SeriesPair | None, car: Car, road: Road
) -> float:
    """An index of a design with an ideal or elastic inerter, as a norm of its transfer function."""
    if not isinstance(car, QuarterCar):
        from inerter.suspension.vehicle.indices import vehicle_index

        front, rear = (VehicleStrut(s.stiffness, s.damping, s.inertance) for s in design.struts)
        return float(vehicle_index(index, car, layout, (front, rear), pair, road))
    network = LAYOUTS[layout].stiffness(
        design.stiffness, design.damping, design.inertance, pair=pair
    )
    return float(np.squeeze(INDICES[index].evaluate(car, road, network)))


@lru_cache(maxsize=1024)
def linear_optimum(
    index: str, layout: str, stiffness: float, pair: SeriesPair | None, car: Car, road: Road
) -> Design:
    """The c and b of the smallest index, with an ideal or elastic inerter."""

    def inertance(found: float) -> float:
        return 0.0 if layout == "S1" else max(found, SMALLEST_INERTANCE)

    if not isinstance(car, QuarterCar):
        from inerter.suspension.vehicle import vehicle_optimum

        springs = (stiffness, stiffnesses_of(car, stiffness)[1])
        best = vehicle_optimum(index, car, layout, springs, pair, road)
        front, rear = best.struts
        return Design(
            front.stiffness,
            front.damping,
            inertance(front.inertance),
            rear=Design(rear.stiffness, rear.damping, inertance(rear.inertance)),
        )
    found = optimise(
        SuspensionProblem(
            car=car, road=road, layout=layout, index=index, stiffness=stiffness, pair=pair
        )
    )
    return Design(stiffness, found.damping, inertance(found.inertance))


def linear_indices(
    index: str,
    layout: str,
    start: Design,
    values: Array,
    pair: SeriesPair | None,
    car: Car,
    road: Road,
) -> Array:
    """J1 or J3 of many designs, good enough for a search.

    `values`: c and b of every strut, shape (designs, struts, 2); springs are those of `start`.
    Returns shape (designs,).
    """
    if not isinstance(car, QuarterCar):
        from inerter.suspension.vehicle.indices import quick_rms_index

        front, rear = _branches(layout, start, values, pair)
        return np.asarray(quick_rms_index(index, car, road, (front, rear)))
    network = LAYOUTS[layout].stiffness(
        start.stiffness, values[:, 0, 0], values[:, 0, 1], pair=pair
    )
    return np.asarray(INDICES[index].evaluate(car, road, network))


def linear_gains(
    layout: str, start: Design, values: Array, pair: SeriesPair | None, car: Car, f: Array
) -> Array:
    """Displacement of the body per load on it [m/N] at frequencies [Hz], (designs, n).

    Designs as in `linear_indices`.
    """
    if not isinstance(car, QuarterCar):
        from inerter.suspension.vehicle.load import Load

        front, rear = _branches(layout, start, values, pair)
        return np.asarray(Load(car, (front, rear)).gain(2.0 * np.pi * f))
    network = LAYOUTS[layout].stiffness(
        start.stiffness, values[:, None, 0, 0], values[:, None, 0, 1], pair=pair
    )
    return np.abs(car.body_per_load(network)(2j * np.pi * f))


def _branches(layout: str, start: Design, values: Array, pair: SeriesPair | None) -> list:
    return [
        branch(LAYOUTS[layout], strut.stiffness, values[:, i, 0], values[:, i, 1], pair=pair)
        for i, strut in enumerate(start.struts)
    ]
