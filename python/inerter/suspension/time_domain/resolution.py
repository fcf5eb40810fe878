"""How close the sinusoids of a road have to be, how long a car settles, and what is exact on it.

A mean square over sinusoids df apart is that of the whole density plus what the signal remembers of
itself after one period T = 1/df (Poisson's sum; R is the autocorrelation of the signal):

    sum_i S(f_i) df = R(0) + 2 R(T) + 2 R(2 T) + ...

So T is enough where R has faded, and so has, after half as long, what a start from rest leaves in
the means; under a sinusoidal load after T itself. R is the transform of S; its highest value at and
beyond T counts, so that no zero of an oscillation deceives. A case of friction takes the linear car
with the same design: friction only adds damping.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inerter.suspension.indices import INDICES
from inerter.suspension.layouts import SeriesPair
from inerter.suspension.time_domain.design import Design
from inerter.suspension.time_domain.linear import linear_gains, road_density
from inerter.suspension.time_domain.model import Car
from inerter.suspension.time_domain.road import PeriodicRoad
from inerter.suspension.time_domain.signals import index_of

Array = NDArray[np.float64]

LONGEST = 400.0
"""Longest period of a road that is chosen [s]."""

ERROR = 1e-3
"""What the distance of the sinusoids may leave in a mean square, relative."""

_FADE = 1.0
_HIGHEST = 60.0
_POINTS = 6000


@dataclass(frozen=True)
class Resolution:
    """Factor by which a road has to be `refined`, [s] to `settle`; `enough` if that will do."""

    refined: int
    settle: float
    enough: bool


def resolution_of(
    index: str, layout: str, design: Design, pair: SeriesPair | None, car: Car, road: PeriodicRoad
) -> Resolution:
    """What an index of a design needs of a road; J5, which has none, of settling alone.

    A function of several indices needs what the most demanding of them does.
    """
    if INDICES[index].parts:
        each = [resolution_of(p, layout, design, pair, car, road) for p in INDICES[index].parts]
        return Resolution(
            max(one.refined for one in each),
            max(one.settle for one in each),
            all(one.enough for one in each),
        )
    count = round(2.0 * LONGEST * _HIGHEST)
    f = np.arange(count + 1) / (2.0 * LONGEST)
    if index == "J5":
        values = np.array([[[strut.damping, strut.inertance] for strut in design.struts]])
        density = linear_gains(layout, design, values, pair, car, f[None, 1:])[0] ** 2
    else:
        density = road_density(index, layout, design, pair, car, road.speed, f[1:])
    # the end of the band is no edge that rings
    fall = np.clip(2.0 - 2.0 * f[1:] / _HIGHEST, 0.0, 1.0)
    memory = np.fft.irfft(np.append(0.0, density * np.sin(0.5 * np.pi * fall) ** 2))
    memory = np.abs(memory[: count // 2 + 1]) / memory[0]
    times = np.arange(memory.size) / (2.0 * _HIGHEST)
    times, memory = times[times <= LONGEST], memory[times <= LONGEST]
    left = 2.0 * np.maximum.accumulate(memory[::-1])[::-1]
    enough = np.flatnonzero(left <= ERROR)
    faded = float(times[enough[0]]) if enough.size else LONGEST
    if index == "J5":
        # a transient is seen beside a sinusoid by its height, not by its square
        return Resolution(1, _FADE + faded, bool(enough.size))
    refined = max(1, int(np.ceil(faded / road.period - 1e-9)))
    return Resolution(refined, _FADE + 0.5 * faded, bool(enough.size))


def exact_on_road(
    index: str, layout: str, design: Design, pair: SeriesPair | None, car: Car, road: PeriodicRoad
) -> float:
    """An index of a linear car on the density of a road, sinusoids infinitely close."""
    if INDICES[index].parts:
        return _combined(exact_on_road, index, layout, design, pair, car, road)
    low, high = road.limits
    f = np.geomspace(max(low, 1e-3), high, 2 * _POINTS + 1)
    density = road_density(index, layout, design, pair, car, road.speed, f) * f
    # Simpson over log f
    weights = np.tile([2.0, 4.0], _POINTS + 1)[: f.size]
    weights[[0, -1]] = 1.0
    step = np.log(f[-1] / f[0]) / (2 * _POINTS)
    return _rms(road, float(weights @ density) * step / 3.0)


def on_sinusoids(
    index: str, layout: str, design: Design, pair: SeriesPair | None, car: Car, road: PeriodicRoad
) -> float:
    """An index of a linear car on the sinusoids of a road: what a long simulation gives."""
    if INDICES[index].parts:
        return _combined(on_sinusoids, index, layout, design, pair, car, road)
    density = road_density(index, layout, design, pair, car, road.speed, road.frequencies)
    return _rms(road, float(density.sum()) * road.spacing)


def _combined(each: Callable[..., float], index: str, *asked: Any) -> float:
    """A function of several indices, `each` of them as asked."""
    return float(index_of(index, {p: np.asarray(each(p, *asked)) for p in INDICES[index].parts}))


def _rms(road: PeriodicRoad, integral: float) -> float:
    """From the integral of the squared gain over f: the road's velocity has an even density."""
    return float(2.0 * np.pi * np.sqrt(road.strength * integral))
