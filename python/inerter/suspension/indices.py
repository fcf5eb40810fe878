"""The indices of Wang and Su (after Smith and Walker 1997), exactly, for arrays of designs.

- J1, ride comfort: 2 pi sqrt(V kappa) || s zs/zr ||_2, the rms body acceleration [m/s^2]
- J1w, the same as felt by a seated person, || Wk s zs/zr ||_2 (`comfort_weighting`); this
  project's addition
- travel: 2 pi sqrt(V kappa) || (zs - zu)/(s zr) ||_2, the rms travel of the strut [m]
- J3, tyre load: 2 pi sqrt(V kappa) || (1/s) Fr/zr ||_2, the rms dynamic tyre force [N]
- pitch, roll: rms angular acceleration of a half- or full car's body [rad/s^2]
- J5, load carrying: || zs/Fs ||_inf, the largest displacement per load on the body [m/N]

Lower is better in each.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inerter.suspension.comfort_weighting import weighting
from inerter.suspension.h2_norm import h2_norm
from inerter.suspension.h_infinity_norm import largest_gain
from inerter.suspension.own_index import combined, filter_in, function_in, is_own
from inerter.suspension.quarter_car import QuarterCar, Road
from inerter.suspension.rational import Rational, multiply, shift


@dataclass(frozen=True)
class Index:
    """`evaluate(car, road, strut)` gives the value of each design; `smooth` except J5.

    `signal` with a `filter` is an rms of another index's signal through W(s); `parts` are the
    indices that a `function` combines.
    """

    name: str
    unit: str
    meaning: str
    evaluate: Callable[[QuarterCar, Road, Rational], NDArray[Any]]
    smooth: bool
    signal: str = ""
    filter: Rational | None = None
    function: Callable[..., Any] | None = None
    parts: tuple[str, ...] = ()


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
    return _rms(road.slope, comfort_function(car, strut))


def travel_function(car: QuarterCar, strut: Rational) -> Rational:
    """Travel of the strut per velocity of the road."""
    function = car.travel_per_road(strut)
    return Rational(function.numerator[..., 1:], function.denominator)


def rms_travel(car: QuarterCar, road: Road, strut: Rational) -> NDArray[Any]:
    """Rms travel [m] of each design; infinite where it is not stable."""
    return _rms(road.slope, travel_function(car, strut))


def tyre_load(car: QuarterCar, road: Road, strut: Rational) -> NDArray[Any]:
    """J3 [N] of each design; infinite where it is not stable, or tyres have damping."""
    return _rms(road.slope, tyre_function(car, strut))


def load_carrying(car: QuarterCar, road: Road, strut: Rational) -> NDArray[Any]:
    """J5 [m/N] of each stable design; the road has no part in it."""
    return largest_gain(car.body_per_load(strut))


def _rms(slope: float, function: Rational) -> NDArray[Any]:
    if _follows(function):
        shape = np.broadcast_shapes(function.numerator.shape[:-1], function.denominator.shape[:-1])
        return np.full(shape, np.inf)
    norm = h2_norm(function)
    # an infinite norm with an imaginary part has no product
    with np.errstate(invalid="ignore"):
        return slope * norm


def _turning(car: QuarterCar, road: Road, strut: Rational) -> NDArray[Any]:
    raise ValueError("pitch and roll: a quarter-car does neither; take a half- or full car")


_FUNCTIONS = {"J1": comfort_function, "J3": tyre_function, "travel": travel_function}
_SIGNALS = ("J1", "J3", "travel", "pitch", "roll")


def _weighted(signal: str, felt: Rational, car: QuarterCar, road: Road, strut: Rational) -> Any:
    """Rms of a signal through W(s), of each design; infinite where it is not stable."""
    if signal not in _FUNCTIONS:
        return _turning(car, road, strut)
    function = _FUNCTIONS[signal](car, strut)
    top = multiply(function.numerator, felt.numerator)
    below = multiply(function.denominator, felt.denominator)
    return _rms(road.slope, Rational(top, below))


def _follows(function: Rational) -> bool:
    """Whether a signal follows white noise at once: its degrees are equal."""
    degrees = [
        max((n for n in range(p.shape[-1]) if p[..., n].any()), default=0)
        for p in (function.numerator, function.denominator)
    ]
    return degrees[0] >= degrees[1]


def is_infinite(name: str, car: QuarterCar, strut: Rational) -> bool:
    """Whether an index is infinite on a road whose velocity is white, by its relative degree.

    With tyre damping that of the tyre force is 0, as is that of the body where an inerter couples
    it to the wheel.
    """
    own = INDICES[name]
    if own.function is not None:
        return any(is_infinite(part, car, strut) for part in own.parts)
    signal = own.signal or name
    if signal not in _FUNCTIONS:
        return False
    function = _FUNCTIONS[signal](car, strut)
    if own.filter is not None:
        top = multiply(function.numerator, own.filter.numerator)
        function = Rational(top, multiply(function.denominator, own.filter.denominator))
    return _follows(function)


def _filtered(name: str, unit: str, meaning: str, signal: str, felt: Rational) -> Index:
    evaluate = partial(_weighted, signal, felt)
    return Index(name, unit, meaning, evaluate, True, signal=signal, filter=felt)


class _Indices(dict[str, Index]):
    """Indices by name; one that is missing may be a user's own, by its file."""

    def __missing__(self, name: str) -> Index:
        if not is_own(name):
            raise KeyError(name)
        found = self[name] = _own(name)
        return found

    def __iter__(self) -> Iterator[str]:
        return (name for name in self.keys() if not is_own(name))


def _own(name: str) -> Index:
    if ".py:" not in name:
        signal, felt, unit, meaning = filter_in(name, _SIGNALS)
        return _filtered(name, unit, meaning, signal, felt)
    smooth = tuple(each for each, index in INDICES.items() if index.smooth and not is_own(each))
    function, parts = function_in(name, smooth)

    def evaluate(car: QuarterCar, road: Road, strut: Rational) -> NDArray[Any]:
        values = {part: INDICES[part].evaluate(car, road, strut) for part in parts}
        return np.asarray(combined(name, function, values))

    meaning = (function.__doc__ or name).strip().splitlines()[0]
    return Index(name, "", meaning, evaluate, True, function=function, parts=parts)


INDICES: Mapping[str, Index] = _Indices(
    {
        index.name: index
        for index in (
            Index("J1", "m/s^2", "ride comfort: rms body acceleration", ride_comfort, True),
            Index("J3", "N", "tyre load: rms dynamic tyre force", tyre_load, True),
            Index(
                "J5", "m/N", "load carrying: largest displacement per load", load_carrying, False
            ),
            _filtered("J1w", "m/s^2", "ride comfort weighted by ISO 2631's Wk", "J1", weighting()),
            Index("travel", "m", "rms travel of the strut", rms_travel, True),
            Index("pitch", "rad/s^2", "rms pitch acceleration of the body", _turning, True),
            Index("roll", "rad/s^2", "rms roll acceleration of the body", _turning, True),
        )
    }
)
"""Every index by its name; by the name of its file a user's own, see `own_index`."""


def indices_of(sides: int | None) -> tuple[str, ...]:
    """Names of the indices that a car has: of one wheel (None), one side (1) or two (2)."""
    without = {None: ("pitch", "roll"), 1: ("roll",)}.get(sides, ())
    return tuple(name for name in INDICES if name not in without)
