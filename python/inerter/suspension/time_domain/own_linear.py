"""Exact J1, J1w, J3 and travel of a car file's linear part on the density of a random road.

Damper tables count by their mean slope; stops and lifting tyres do not. Transfer functions are
those of the linear study, not of the model that is stepped, so they check it.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inerter.cars.parts import AxleParts, CarParts, StrutParts
from inerter.suspension.car_options import linear_car
from inerter.suspension.indices import (
    INDICES,
    comfort_function,
    is_infinite,
    travel_function,
    tyre_function,
)
from inerter.suspension.layouts import LAYOUTS
from inerter.suspension.quarter_car import QuarterCar
from inerter.suspension.time_domain.linear import centring_of, plane_densities
from inerter.suspension.time_domain.road import PeriodicRoad
from inerter.suspension.time_domain.signals import gain_of, index_of, parts_of, signal_of
from inerter.suspension.vehicle.state_space import system
from inerter.suspension.vehicle.strut import Branch, branch
from inerter.suspension.vehicle.white_noise import is_white

Array = NDArray[np.float64]
_POINTS = 12_000


def linear_figures(
    car: CarParts, road: PeriodicRoad, more: tuple[str, ...] = (), *, on_sinusoids: bool = False
) -> dict[str, float]:
    """J1, J1w, J3, travel and `more` indices by name, SI units.

    `on_sinusoids`: of the road's own, not infinitely close ones.
    """
    parts = tuple(dict.fromkeys(("J1", "J1w", "J3", "travel", *parts_of(more))))
    low, high = road.limits
    f = road.frequencies
    weights = np.full(f.size, road.spacing)
    if not on_sinusoids:
        # Simpson over log f
        f = np.geomspace(max(low, 1e-3), high, 2 * _POINTS + 1)
        weights = np.tile([2.0, 4.0], _POINTS + 1)[: f.size]
        weights[[0, -1]] = 1.0
        weights *= f * np.log(f[-1] / f[0]) / (6.0 * _POINTS)
    gains = dict(_gains(car, road, f, tuple(dict.fromkeys(map(signal_of, parts)))))
    # the road's velocity has an even density
    found = {
        part: np.sqrt(road.strength * (weights @ (gains[signal_of(part)] * gain_of(part, f))))
        for part in parts
    }
    found = {part: np.asarray(2.0 * np.pi * root) for part, root in found.items()}
    names = dict.fromkeys(("J1", "J1w", "J3", "travel", *more))
    return {name: float(index_of(name, found)) for name in names}


def bound_by_band(car: CarParts, names: tuple[str, ...]) -> list[str]:
    """Which indices tyre damping makes infinite on a road without end."""
    linear = linear_car(car)
    if isinstance(linear, QuarterCar):
        k, values = _values(car.front.strut)
        network = LAYOUTS[car.front.strut.layout].stiffness(k, **values)
        return [name for name in names if is_infinite(name, linear, network)]
    assert car.rear is not None
    planes = [system(plane, (_branch(car.front), _branch(car.rear))) for plane in linear.planes]
    return [
        name
        for name in names
        if any(is_white(one, part) for one in planes for part in INDICES[name].parts or (name,))
    ]


def _gains(
    car: CarParts, road: PeriodicRoad, f: Array, names: tuple[str, ...]
) -> Iterator[tuple[str, Array]]:
    """Squared gain per velocity of the road, mean of the wheels, (n,)."""
    s = 2j * np.pi * f
    linear = linear_car(car)
    if isinstance(linear, QuarterCar):
        k, values = _values(car.front.strut)
        network = LAYOUTS[car.front.strut.layout].stiffness(k, **values)
        parts = {"J1": comfort_function, "J3": tyre_function, "travel": travel_function}
        for name, function in parts.items():
            yield name, np.abs(function(linear, network)(s)) ** 2
        return
    assert car.rear is not None
    branches = (_branch(car.front), _branch(car.rear))
    yield from plane_densities(linear, branches, road.speed, s, names).items()


def _branch(axle: AxleParts) -> Branch:
    k, values = _values(axle.strut)
    return branch(LAYOUTS[axle.strut.layout], k, **values)


def _values(s: StrutParts) -> tuple[float, dict[str, Any]]:
    """Stiffness of the whole strut, and the rest by the names of a layout, at the wheel."""
    square = s.motion_ratio**2
    values: dict[str, Any] = {"damping": square * s.mean_damping, "inertance": square * s.inertance}
    if s.relaxation_stiffness:
        values["relaxation_stiffness"] = square * s.relaxation_stiffness
    if LAYOUTS[s.layout].centred:
        values |= centring_of(s.stiffness, s.damper_stiffness, s.inerter_stiffness)
    return s.wheel_rate, values
