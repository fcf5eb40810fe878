"""The indices of Wang and Su (after Smith and Walker 1997), exactly, for arrays of designs.

- J1, ride comfort: 2 pi sqrt(V kappa) || s zs/zr ||_2, the rms body acceleration [m/s^2]
- J1w, the same as felt by a seated person, || Wk s zs/zr ||_2 (`comfort_weighting`); this
  project's addition
- travel: 2 pi sqrt(V kappa) || (zs - zu)/(s zr) ||_2, the rms travel of the strut [m]
- J3, tyre load: 2 pi sqrt(V kappa) || (1/s) Fr/zr ||_2, the rms dynamic tyre force [N]
- J5, load carrying: || zs/Fs ||_inf, the largest displacement per load on the body [m/N]

Lower is better in each.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inerter.suspension.comfort_weighting import weighting
from inerter.suspension.h2_norm import h2_norm
from inerter.suspension.h_infinity_norm import largest_gain
from inerter.suspension.quarter_car import QuarterCar, Road
from inerter.suspension.rational import Rational, multiply, shift


@dataclass(frozen=True)
class Index:
    """`evaluate(car, road, strut)` gives the value of each design; `smooth` except J5."""

    name: str
    unit: str
    meaning: str
    evaluate: Callable[[QuarterCar, Road, Rational], NDArray[Any]]
    smooth: bool


def comfort_function(car: QuarterCar, strut: Rational) -> Rational:
    """Acceleration of the body per velocity of the road, s zs/zr."""
    function = car.body_per_road(strut)
    return Rational(shift(function.numerator, 1), function.denominator)


def tyre_function(car: QuarterCar, strut: Rational) -> Rational:
    """Tyre force per velocity of the road, (1/s) Fr/zr: of the s^2 above an s is left."""
    function = car.tyre_force_per_road(strut)
    return Rational(function.numerator[..., 1:], function.denominator)


def ride_comfort(car: QuarterCar, road: Road, strut: Rational) -> NDArray[Any]:
    """J1 [m/s^2] of each design; infinite where it is not stable."""
    return _times(road.slope, h2_norm(comfort_function(car, strut)))


def weighted_comfort(car: QuarterCar, road: Road, strut: Rational) -> NDArray[Any]:
    """J1w [m/s^2] of each design; infinite where it is not stable."""
    function, felt = comfort_function(car, strut), weighting()
    top = multiply(function.numerator, felt.numerator)
    below = multiply(function.denominator, felt.denominator)
    return _times(road.slope, h2_norm(Rational(top, below)))


def travel_function(car: QuarterCar, strut: Rational) -> Rational:
    """Travel of the strut per velocity of the road."""
    function = car.travel_per_road(strut)
    return Rational(function.numerator[..., 1:], function.denominator)


def rms_travel(car: QuarterCar, road: Road, strut: Rational) -> NDArray[Any]:
    """Rms travel [m] of each design; infinite where it is not stable."""
    return _times(road.slope, h2_norm(travel_function(car, strut)))


def tyre_load(car: QuarterCar, road: Road, strut: Rational) -> NDArray[Any]:
    """J3 [N] of each design; infinite where it is not stable."""
    return _times(road.slope, h2_norm(tyre_function(car, strut)))


def load_carrying(car: QuarterCar, road: Road, strut: Rational) -> NDArray[Any]:
    """J5 [m/N] of each stable design; the road has no part in it."""
    return largest_gain(car.body_per_load(strut))


def _times(slope: float, norm: NDArray[Any]) -> NDArray[Any]:
    # an infinite norm with an imaginary part has no product
    with np.errstate(invalid="ignore"):
        return slope * norm


INDICES: Mapping[str, Index] = {
    "J1": Index("J1", "m/s^2", "ride comfort: rms body acceleration", ride_comfort, True),
    "J3": Index("J3", "N", "tyre load: rms dynamic tyre force", tyre_load, True),
    "J5": Index("J5", "m/N", "load carrying: largest displacement per load", load_carrying, False),
    "J1w": Index("J1w", "m/s^2", "ride comfort weighted by ISO 2631's Wk", weighted_comfort, True),
    "travel": Index("travel", "m", "rms travel of the strut", rms_travel, True),
}
"""Every index by its name."""
