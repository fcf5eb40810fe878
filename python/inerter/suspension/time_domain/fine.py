"""What a car needs of a road and of a settling time, and what is exact on a road of that band.

The mean square over a periodic road is a sum over lines in place of an integral over its density.
It errs where a resonance is narrower than the lines are apart: by about 2 exp(-sigma T) of the
resonance's share, sigma its decay [1/s] and T = 1/df the period. What is left of a start from rest
fades as exp(-sigma t). So both come from the slowest oscillatory mode of the linear car, as
`FADES` of its decay times: e^-8 = 3e-4. Modes that do not oscillate are left aside: their weight is
at f = 0, where acceleration and tyre force have none.

The linear value is the integral over the band of the road, each line standing for a width df.
Source: Poisson's summation formula on the autocorrelation.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from inerter.suspension.indices import comfort_function, tyre_function
from inerter.suspension.layouts import LAYOUTS, SeriesPair
from inerter.suspension.quarter_car import QuarterCar
from inerter.suspension.time_domain.design import Design
from inerter.suspension.time_domain.model import Car
from inerter.suspension.time_domain.road import PeriodicRoad
from inerter.suspension.vehicle.state_space import System, system
from inerter.suspension.vehicle.strut import branch

Array = NDArray[np.float64]

FADES = 8.0
"""Decay times of the slowest mode in a period and in a settling time."""

LONGEST = 150.0
"""[s]: longer periods are not taken; what they leave of an error is in the interval."""

_CHANGES_BELOW = 60.0
_CLOSE = 1e-6
_FINEST = 729


def slowest_decay(layout: str, design: Design, pair: SeriesPair | None, car: Car) -> float:
    """Decay [1/s] of the oscillatory mode of the linear car that rings longest."""
    if isinstance(car, QuarterCar):
        strut = LAYOUTS[layout].stiffness(
            design.stiffness, design.damping, design.inertance, pair=pair
        )
        poles = np.roots(comfort_function(car, strut).denominator[::-1])
    else:
        poles = np.linalg.eigvals(_system(layout, design, pair, car).matrix)
    ringing = poles[np.abs(poles.imag) > 0.1 * np.abs(poles.real)]
    return float(-ringing.real.max()) if ringing.size else math.inf


def parts_for(road: PeriodicRoad, decay: float) -> int:
    """How many times as close the lines have to be, an odd number."""
    wanted = min(FADES / decay, LONGEST) / road.period
    parts = max(1, math.ceil(wanted - 1e-9))
    return parts + 1 - parts % 2


def settling(decay: float) -> float:
    """[s] until what is left of the start is not felt."""
    return min(FADES / decay, LONGEST)


def line_value(
    index: str, layout: str, design: Design, pair: SeriesPair | None, car: Car, road: PeriodicRoad
) -> float:
    """J1 or J3 of the linear car on the lines of a road: what its simulation would give."""
    f = road.frequencies
    return _rms(_gains(index, layout, design, pair, car, f, road.speed), road)


def linear_value(
    index: str, layout: str, design: Design, pair: SeriesPair | None, car: Car, road: PeriodicRoad
) -> float:
    """J1 or J3 of the linear car over the road's band, the limit of ever finer lines."""
    # high lines are close enough as they are
    split = min(road.last, max(road.first, math.ceil(_CHANGES_BELOW / road.spacing)))
    parts, before = 1, -1.0
    high = 0.0
    if split < road.last:
        f = road.spacing * np.arange(split + 1, road.last + 1, dtype=float)
        high = _rms(_gains(index, layout, design, pair, car, f, road.speed), road) ** 2
    while True:
        low = PeriodicRoad(
            road.name, road.strength, road.first, split, road.speed, road.spacing
        ).finer(parts)
        gains = _gains(index, layout, design, pair, car, low.frequencies, road.speed)
        value = math.sqrt(_rms(gains, low) ** 2 + high)
        if abs(value - before) <= _CLOSE * value or parts >= _FINEST:
            return value
        parts, before = 3 * parts, value


def _rms(squares: Array, road: PeriodicRoad) -> float:
    """Of squared gains per velocity of the road; its velocity has a constant density."""
    return 2.0 * math.pi * math.sqrt(road.strength * road.spacing * float(np.sum(squares)))


def _gains(
    index: str,
    layout: str,
    design: Design,
    pair: SeriesPair | None,
    car: Car,
    f: Array,
    speed: float,
) -> Array:
    """Squared gains of acceleration or tyre force per velocity of the road, mean over points."""
    s = 2j * np.pi * f
    if isinstance(car, QuarterCar):
        strut = LAYOUTS[layout].stiffness(
            design.stiffness, design.damping, design.inertance, pair=pair
        )
        function = comfort_function if index == "J1" else tyre_function
        return np.abs(function(car, strut)(s)) ** 2
    found = _system(layout, design, pair, car)
    rows = np.asarray(found.acceleration if index == "J1" else found.tyre)
    values, vectors = np.linalg.eig(found.matrix)
    left, inverse = rows @ vectors, np.linalg.inv(vectors)
    late = np.exp(-s * car.wheelbase / speed)
    drive = (inverse @ found.front)[:, None] + (inverse @ found.rear)[:, None] * late
    answer = left @ (drive / (s - values[:, None]))
    return np.mean(np.abs(answer) ** 2, axis=0)


def _system(layout: str, design: Design, pair: SeriesPair | None, car: Car) -> System:
    assert not isinstance(car, QuarterCar)
    front, rear = (
        branch(LAYOUTS[layout], one.stiffness, one.damping, one.inertance, pair=pair)
        for one in design.struts
    )
    return system(car.planes[0], (front, rear))
