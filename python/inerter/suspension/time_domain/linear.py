"""What is exact: indices, gains and optimum of the linear cases, from the linear study."""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inerter.suspension.indices import INDICES, comfort_function, travel_function, tyre_function
from inerter.suspension.layouts import LAYOUTS, SeriesPair
from inerter.suspension.optimum import optimise
from inerter.suspension.problem import SuspensionProblem
from inerter.suspension.quarter_car import QuarterCar, Road
from inerter.suspension.time_domain.design import Design, both
from inerter.suspension.time_domain.model import Car
from inerter.suspension.time_domain.road import PeriodicRoad
from inerter.suspension.vehicle.cars import Vehicle
from inerter.suspension.vehicle.state_space import system
from inerter.suspension.vehicle.strut import Branch, VehicleStrut, branch
from inerter.suspension.vehicle.white_noise import feed_of, signals

Array = NDArray[np.float64]

SMALLEST_INERTANCE = 1e-3
"""[kg] in place of 0 where an inerter has to be there: too little to be felt."""


def spectrum(road: PeriodicRoad) -> Road:
    """The road of the linear study: a density of the same slope, at the same speed.

    Optima are those of that slope; norms are exact for the paper's own road.
    """
    return Road(velocity=road.speed, roughness=0.5 * road.strength / road.speed)


def damped_tyres(car: Car) -> bool:
    """Whether a tyre has damping."""
    axles = (car,) if isinstance(car, QuarterCar) else (car.front, car.rear)
    return any(axle.tyre_damping > 0.0 for axle in axles)


def stiffnesses_of(car: Car, stiffness: float) -> tuple[float, ...]:
    """Of every strut [N/m]: the rear one has the ratio to the front of the car's own."""
    if isinstance(car, QuarterCar):
        return (stiffness,)
    return stiffness, stiffness * car.rear.stiffness / car.front.stiffness


def exact_index(
    index: str, layout: str, design: Design, pair: SeriesPair | None, car: Car, road: Road
) -> float:
    """An index of a design with an ideal or elastic inerter, as a norm of its transfer function."""
    if not isinstance(car, QuarterCar):
        from inerter.suspension.vehicle.indices import vehicle_index

        struts = [
            VehicleStrut(s.stiffness, s.damping, s.inertance, **s.more) for s in design.struts
        ]
        return float(vehicle_index(index, car, layout, (struts[0], struts[1]), pair, road))
    network = LAYOUTS[layout].stiffness(
        design.stiffness, design.damping, design.inertance, **design.more, pair=pair
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
    names = LAYOUTS[layout].variables
    fixed = tuple(
        tuple(
            (name, x)
            for name, x in zip(("damping", "inertance"), pair_given, strict=True)
            if x is not None and name in names
        )
        for pair_given in given
    )
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
        return both([_design(layout, s.stiffness, s.layout_values()) for s in best.struts])
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
    values = {"damping": found.damping, "inertance": found.inertance}
    if found.relaxation_stiffness is not None:
        values["relaxation_stiffness"] = found.relaxation_stiffness
    if found.springs:
        k1, k2 = found.springs["damper_stiffness"], found.springs["inerter_stiffness"]
        values |= centring_of(stiffness, k1, k2)
    return _design(layout, stiffness, values)


def centring_of(stiffness: float, k1: float, k2: float) -> dict[str, float]:
    """Share and ratio of centring springs k_1, k_2 in a strut of that stiffness [N/m]."""
    if k1 == 0.0 or k2 == 0.0:
        return {"centring_share": 0.0, "centring_ratio": 1.0}
    return {"centring_share": k1 * k2 / (k1 + k2) / stiffness, "centring_ratio": k1 / k2}


def _design(layout: str, stiffness: float, values: Mapping[str, float]) -> Design:
    own: dict[str, Any] = {
        name: values[name] for name in LAYOUTS[layout].variables if name in values
    }
    if LAYOUTS[layout].has_inerter:
        own["inertance"] = max(values.get("inertance", 0.0), SMALLEST_INERTANCE)
    return Design(stiffness, **own)


def linear_indices(
    index: str,
    layout: str,
    start: Design,
    values: Array,
    pair: SeriesPair | None,
    car: Car,
    road: Road,
) -> Array:
    """An index, not J5, of many designs, good enough for a search.

    `values`: c and b of every strut, shape (designs, struts, 2); springs are those of `start`.
    Returns shape (designs,).
    """
    if not isinstance(car, QuarterCar):
        from inerter.suspension.vehicle.indices import quick_rms_index

        front, rear = _branches(layout, start, values, pair)
        return np.asarray(quick_rms_index(index, car, road, (front, rear)))
    network = LAYOUTS[layout].stiffness(
        start.stiffness, values[:, 0, 0], values[:, 0, 1], **start.more, pair=pair
    )
    return np.asarray(INDICES[index].evaluate(car, road, network))


def linear_gains(
    layout: str, start: Design, values: Array, pair: SeriesPair | None, car: Car, f: Array
) -> Array:
    """Displacement of the body per load on it [m/N] at frequencies [Hz], (designs, n).

    Designs as in `linear_indices`.
    """
    if not isinstance(car, QuarterCar):
        from inerter.suspension.vehicle.indices import load_of

        front, rear = _branches(layout, start, values, pair)
        return np.asarray(load_of(car, (front, rear)).gain(2.0 * np.pi * f))
    network = LAYOUTS[layout].stiffness(
        start.stiffness, values[:, None, 0, 0], values[:, None, 0, 1], **start.more, pair=pair
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
    """Squared gain of an index's signal per velocity of the road, at frequencies [Hz], (n,).

    Of an rms, filtered or not, not of a function of several; of several wheels the mean, the rear
    ones on the same road later.
    """
    s = 2j * np.pi * f
    own = INDICES[index]
    weight = 1.0 if own.filter is None else np.abs(own.filter(s)) ** 2
    signal = own.signal or index
    if isinstance(car, QuarterCar):
        network = LAYOUTS[layout].stiffness(
            design.stiffness, design.damping, design.inertance, **design.more, pair=pair
        )
        function = {"J1": comfort_function, "J3": tyre_function, "travel": travel_function}[signal]
        return weight * np.abs(function(car, network)(s)) ** 2
    front, rear = (
        branch(LAYOUTS[layout], x.stiffness, x.damping, x.inertance, **x.more, pair=pair)
        for x in design.struts
    )
    return weight * plane_densities(car, (front, rear), speed, s, (signal,))[signal]


def plane_densities(
    car: Vehicle,
    branches: tuple[Branch, Branch],
    speed: float,
    s: NDArray[Any],
    names: tuple[str, ...] = ("J1", "J3", "travel"),
) -> dict[str, Array]:
    """J1, J3, travel, pitch, roll of a half- or full car, as far as they are in `names`.

    Squared gains, means over its wheels, (n,) each.
    """
    later = np.exp(-s * car.wheelbase / speed)
    warp = (later - 1.0) / s
    total = {name: np.zeros(len(s)) for name in names}
    for plane in car.planes:
        m = system(plane, branches)
        roads = np.stack([np.ones_like(later), later], axis=-1)
        drive = m.front + later[:, None] * m.rear
        if m.warp is not None:
            drive = drive + warp[:, None] * m.warp
        inverse = s[:, None, None] * np.eye(len(m.front)) - m.matrix
        x = np.linalg.solve(inverse, drive[:, :, None])[:, :, 0]
        for name in names:
            rows, bent = signals(m, name)
            signal = x @ rows.T + (0.0 if bent is None else warp[:, None] * bent)
            feed = feed_of(m, name)
            if feed is not None:
                signal = signal + roads @ feed.T
            total[name] += plane.weight * np.mean(np.abs(signal) ** 2, axis=1)
    return total


def _branches(layout: str, start: Design, values: Array, pair: SeriesPair | None) -> list:
    return [
        branch(
            LAYOUTS[layout],
            strut.stiffness,
            values[:, i, 0],
            values[:, i, 1],
            **strut.more,
            pair=pair,
        )
        for i, strut in enumerate(start.struts)
    ]
