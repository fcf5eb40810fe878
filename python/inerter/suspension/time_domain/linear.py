"""What is exact: indices, gains and optimum of the linear cases, from the linear study."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from inerter.suspension.indices import INDICES, comfort_function, tyre_function
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
    index: str,
    layout: str,
    stiffness: float,
    pair: SeriesPair | None,
    car: Car,
    road: Road,
    given: tuple[tuple[float | None, float | None], ...] = (),
) -> Design:
    """The c and b of the smallest index, with an ideal or elastic inerter.

    `given`: (c, b) of every strut that are not free, None where they are.
    """
    fixed = tuple(
        tuple(
            (name, x)
            for name, x in zip(("damping", "inertance"), pair_given, strict=True)
            if x is not None and (layout != "S1" or name == "damping")
        )
        for pair_given in given
    )

    def inertance(found: float) -> float:
        return 0.0 if layout == "S1" else max(found, SMALLEST_INERTANCE)

    if not isinstance(car, QuarterCar):
        from inerter.suspension.vehicle.optimum import optimise_vehicle
        from inerter.suspension.vehicle.problem import VehicleProblem

        springs = (stiffness, stiffnesses_of(car, stiffness)[1])
        best = optimise_vehicle(
            VehicleProblem(
                car=car,
                road=road,
                layout=layout,
                index=index,
                stiffnesses=springs,
                pair=pair,
                fixed=(fixed[0], fixed[-1]) if fixed else ((), ()),
            )
        )
        front, rear = best.struts
        return Design(
            front.stiffness,
            front.damping,
            inertance(front.inertance),
            rear=Design(rear.stiffness, rear.damping, inertance(rear.inertance)),
        )
    found = optimise(
        SuspensionProblem(
            car=car,
            road=road,
            layout=layout,
            index=index,
            stiffness=stiffness,
            pair=pair,
            fixed=fixed[0] if fixed else (),
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


def road_density(
    index: str,
    layout: str,
    design: Design,
    pair: SeriesPair | None,
    car: Car,
    speed: float,
    f: Array,
) -> Array:
    """Squared gain of J1's or J3's signal per velocity of the road, at frequencies [Hz], (n,).

    Of a half-car the mean over both axles, the rear one on the same road later.
    """
    s = 2j * np.pi * f
    if isinstance(car, QuarterCar):
        network = LAYOUTS[layout].stiffness(
            design.stiffness, design.damping, design.inertance, pair=pair
        )
        signal = comfort_function if index == "J1" else tyre_function
        return np.abs(signal(car, network)(s)) ** 2
    from inerter.suspension.vehicle.state_space import system

    front, rear = (
        branch(LAYOUTS[layout], x.stiffness, x.damping, x.inertance, pair=pair)
        for x in design.struts
    )
    (plane,) = car.planes
    matrices = system(plane, (front, rear))
    rows = matrices.acceleration if index == "J1" else matrices.tyre
    later = np.exp(-s * car.wheelbase / speed)
    drive = matrices.front + later[:, None] * matrices.rear
    inverse = s[:, None, None] * np.eye(len(matrices.front)) - matrices.matrix
    states = np.linalg.solve(inverse, drive[:, :, None])
    return np.mean(np.abs(rows @ states)[:, :, 0] ** 2, axis=1)


def _branches(layout: str, start: Design, values: Array, pair: SeriesPair | None) -> list:
    return [
        branch(LAYOUTS[layout], strut.stiffness, values[:, i, 0], values[:, i, 1], pair=pair)
        for i, strut in enumerate(start.struts)
    ]
