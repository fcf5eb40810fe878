"""The indices of Wang and Su (after Smith and Walker 1997), exactly, for arrays of designs.

- J1, ride comfort: 2 pi sqrt(V kappa) || s zs/zr ||_2, the rms body acceleration [m/s^2]
- J3, tyre load: 2 pi sqrt(V kappa) || (1/s) Fr/zr ||_2, the rms dynamic tyre force [N]
- J5, load carrying: || zs/Fs ||_inf, the largest displacement per load on the body [m/N]

and for a designer, of the quarter-car:

- Wk, weighted comfort: rms body acceleration through the filter Wk of ISO 2631-1 [m/s^2]
- travel: rms elongation of the strut [m]
- load_ratio: J3 over the static load (ms + mu) g of the tyre; a tyre of Gaussian force lifts off
  for 0.1 % of the time at 0.32

Lower is better in each.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from numpy.typing import NDArray

from inerter.suspension.comfort_weighting import WK
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
    return road.slope * h2_norm(comfort_function(car, strut))


def tyre_load(car: QuarterCar, road: Road, strut: Rational) -> NDArray[Any]:
    """J3 [N] of each design; infinite where it is not stable."""
    return road.slope * h2_norm(tyre_function(car, strut))


def load_carrying(car: QuarterCar, road: Road, strut: Rational) -> NDArray[Any]:
    """J5 [m/N] of each stable design; the road has no part in it."""
    return largest_gain(car.body_per_load(strut))


def weighted_comfort(car: QuarterCar, road: Road, strut: Rational) -> NDArray[Any]:
    """Rms of the body's acceleration through Wk [m/s^2] of each design."""
    function = comfort_function(car, strut)
    return road.slope * h2_norm(
        Rational(
            multiply(function.numerator, WK.numerator),
            multiply(function.denominator, WK.denominator),
        )
    )


def travel_function(car: QuarterCar, strut: Rational) -> Rational:
    """Elongation of the strut per velocity of the road, (1/s) (zs - zu)/zr.

    ms s^2 zs = -D (zs - zu) gives (zs - zu)/zr = -ms s^2 P kt / A with zs/zr = kt N / A.
    """
    function = car.body_per_road(strut)
    top = -car.sprung_mass * car.tyre_stiffness * shift(strut.denominator, 1)
    return Rational(top, function.denominator)


def travel(car: QuarterCar, road: Road, strut: Rational) -> NDArray[Any]:
    """Rms elongation of the strut [m] of each design."""
    return road.slope * h2_norm(travel_function(car, strut))


def load_ratio(car: QuarterCar, road: Road, strut: Rational) -> NDArray[Any]:
    """J3 over the static load of the tyre, of each design."""
    return tyre_load(car, road, strut) / ((car.sprung_mass + car.unsprung_mass) * GRAVITY)


GRAVITY = 9.81
"""[m/s^2] of static loads."""

VEHICLE_INDICES = ("J1", "J3", "J5")
"""Those that half- and full cars have too."""

INDICES: Mapping[str, Index] = {
    "J1": Index("J1", "m/s^2", "ride comfort: rms body acceleration", ride_comfort, True),
    "J3": Index("J3", "N", "tyre load: rms dynamic tyre force", tyre_load, True),
    "J5": Index("J5", "m/N", "load carrying: largest displacement per load", load_carrying, False),
    "Wk": Index("Wk", "m/s^2", "comfort: body acceleration, ISO 2631 Wk", weighted_comfort, True),
    "travel": Index("travel", "m", "rms elongation of the strut", travel, True),
    "load_ratio": Index("load_ratio", "1", "rms tyre force over the static load", load_ratio, True),
}
"""Every index by its name."""
