"""J1, J3 and J5 of half- and full cars. The definitions are this project's: Wang and Su print no
half-car indices. Each becomes theirs where the car is two or four equal quarter-cars.

- J1: root of the mean over the points of the body above its 2 (4) wheels of the mean square of the
  vertical acceleration [m/s^2]
- J1w: the same, weighted by ISO 2631's Wk
- J3: root of the mean over the 2 (4) wheels of the mean square of the dynamic tyre force [N]
- travel: root of the mean over the 2 (4) struts of the mean square of the travel [m]
- pitch, roll: root of the mean square of the body's angular acceleration [rad/s^2]
- J5: largest displacement of the centre of mass per vertical load on it [m/N] over all frequencies

The rear wheels feel the road of their own side later by wheelbase / V. The density of the road is
that of `Road`; the load of J5 is the paper's, its A = 2000 N scales out.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inerter.suspension.indices import INDICES
from inerter.suspension.layouts import LAYOUTS, Layout, SeriesPair
from inerter.suspension.own_index import combined, is_own, slopes
from inerter.suspension.quarter_car import Road
from inerter.suspension.vehicle.cars import Vehicle
from inerter.suspension.vehicle.load import Load
from inerter.suspension.vehicle.load_peaks import largest_gain
from inerter.suspension.vehicle.state_space import system
from inerter.suspension.vehicle.strut import Branch, VehicleStrut, branch
from inerter.suspension.vehicle.white_noise import mean_square, quick_mean_square

Branches = tuple[Branch, Branch]


def vehicle_index(
    index: str,
    car: Vehicle,
    layout: str | Layout,
    struts: tuple[VehicleStrut, VehicleStrut],
    pair: SeriesPair | None = None,
    road: Road | None = None,
) -> float:
    """An index of a car with given struts, exactly.

    Parameters
    ----------
    index
        "J1" [m/s^2], "J3" [N] or "J5" [m/N], see the module.
    car
        `half_car()`, `full_car()` or any other.
    layout
        A name in `LAYOUTS`, or a layout.
    struts
        Front and rear; of a full car both of the axle's.
    pair
        Series pair of the inerters; ideal without.
    road
        Wang and Su's if not given.

    Raises
    ------
    ValueError
        The index or the layout is not known.
    """
    if index not in INDICES and not is_own(index):
        raise ValueError(f"index {index!r} is not known: choose from {', '.join(INDICES)}")
    if isinstance(layout, str) and layout not in LAYOUTS:
        raise ValueError(f"layout {layout!r} is not known: choose from {', '.join(LAYOUTS)}")
    network = LAYOUTS[layout] if isinstance(layout, str) else layout
    front, rear = (
        branch(
            network,
            strut.stiffness,
            **strut.layout_values(),
            pair=pair,
        )
        for strut in struts
    )
    if index == "J5":
        return largest_gain(load_of(car, (front, rear)))
    return rms_index(index, car, road or Road(), (front, rear))[0]


def load_of(car: Vehicle, branches: Branches) -> Load:
    """zc/F of a car."""
    return Load(car.side, branches, car.sides)


def rms_index(
    index: str, car: Vehicle, road: Road, branches: Branches, step: float | None = None
) -> tuple[float, NDArray[Any]]:
    """A smooth index of one design, with a complex `step` its gradient, see `mean_square`."""
    own = INDICES[index]
    if own.function is not None:
        parts = {part: rms_index(part, car, road, branches, step) for part in own.parts}
        values = {part: np.asarray(value) for part, (value, _) in parts.items()}
        found = float(combined(index, own.function, values))
        if not math.isfinite(found) or step is None:
            return found, 0.0 * parts[own.parts[0]][1]
        change = slopes(index, own.function, {part: value for part, (value, _) in parts.items()})
        return found, sum((change[part] * slope for part, (_, slope) in parts.items()), np.zeros(1))
    delay = car.wheelbase / road.velocity
    total, gradient = 0.0, np.zeros(0)
    for plane in car.planes:
        value, slope = mean_square(system(plane, branches), index, delay, step)
        total += plane.weight * value
        gradient = plane.weight * slope + (gradient if len(gradient) else 0.0)
    if not 0.0 < total < math.inf:
        return math.inf, 0.0 * gradient
    root = math.sqrt(total)
    return road.slope * root, road.slope * gradient / (2.0 * root)


def quick_rms_index(index: str, car: Vehicle, road: Road, branches: Branches) -> NDArray[Any]:
    """A smooth index of arrays of designs, good enough for a search."""
    own = INDICES[index]
    if own.function is not None:
        values = {part: quick_rms_index(part, car, road, branches) for part in own.parts}
        return np.asarray(combined(index, own.function, values))
    delay = car.wheelbase / road.velocity
    total = sum(
        plane.weight * quick_mean_square(system(plane, branches), index, delay)
        for plane in car.planes
    )
    return road.slope * np.sqrt(total)
