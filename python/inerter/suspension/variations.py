"""What may differ from what was planned: payload, tyres, speed, tolerances of the parts.

A `Scene` is a car on a road whose parts are off by some factors. The index of a problem with scenes
is the root of the mean of its squares over them: smooth, so that the derivative stays exact.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from inerter.suspension.quarter_car import QuarterCar, Road

OF_CAR = ("body_mass", "wheel_mass", "tyre_stiffness", "speed")
OF_PARTS = ("damping", "inertance", "relaxation_stiffness")
MOST = 64
"""Scenes that an optimum is sought over."""


@dataclass(frozen=True)
class Scene:
    """`car` on a `road`, parts that are off by `factors`; `name` says what differs."""

    car: Any
    road: Road
    factors: tuple[tuple[str, float], ...]
    name: str

    def fixed(self, values: tuple[tuple[str, float], ...]) -> tuple[tuple[str, float], ...]:
        """Held values, off by the factors."""
        factors = dict(self.factors)
        return tuple((name, value * factors.get(name, 1.0)) for name, value in values)

    def shift(self, name: str) -> float:
        """Logarithm of a part's factor."""
        return math.log(dict(self.factors).get(name, 1.0))


def scenes_of(car: Any, road: Road, factors: Mapping[str, tuple[float, ...]]) -> tuple[Scene, ...]:
    """Every combination of factors of the names in `OF_CAR` and `OF_PARTS`; none without any.

    Raises
    ------
    ValueError
        More than `MOST` of them.
    """
    found = []
    for name, own in combinations(factors):
        at = replace(road, velocity=road.velocity * own.get("speed", 1.0))
        parts = tuple((key, own[key]) for key in OF_PARTS if key in own)
        found.append(Scene(_changed(car, own), at, parts, name))
    return tuple(found)


def combinations(factors: Mapping[str, tuple[float, ...]]) -> list[tuple[str, dict[str, float]]]:
    """Every combination of factors by what it is called, "as planned" where all are 1; or none.

    Raises
    ------
    ValueError
        More than `MOST` of them.
    """
    if not factors:
        return []
    count = math.prod(map(len, factors.values()))
    if count > MOST:
        raise ValueError(f"vary: {count} combinations, at most {MOST}; leave values out")
    found = []
    for chosen in itertools.product(*factors.values()):
        own = dict(zip(factors, chosen, strict=True))
        name = ", ".join(f"{key} x {value:g}" for key, value in own.items() if value != 1.0)
        found.append((name or "as planned", own))
    return found


def scene_notes(problem: Any, point: Any) -> list[str]:
    """What a reader should know of the scenes of a design, a point of a problem with scenes."""
    if not problem.scenes:
        return []
    values = problem.in_scenes(point)
    order = sorted(range(len(values)), key=lambda n: values[n])
    ends = [f"{values[n]:.5g} ({problem.scenes[n].name})" for n in (order[0], order[-1])]
    return [f"root mean square over {len(values)} variations, from {ends[0]} to {ends[1]}"]


def _changed(car: Any, factors: Mapping[str, float]) -> Any:
    """The car with masses and tyres off; a payload adds to the inertias as to the mass."""
    body, wheel, tyre = (factors.get(name, 1.0) for name in OF_CAR[:3])
    if isinstance(car, QuarterCar):
        return QuarterCar(
            sprung_mass=car.sprung_mass * body,
            unsprung_mass=car.unsprung_mass * wheel,
            tyre_stiffness=car.tyre_stiffness * tyre,
            tyre_damping=car.tyre_damping,
        )
    values = {
        f"{name}": getattr(car, name) * body
        for name in ("body_mass", "pitch_inertia", "roll_inertia")
        if hasattr(car, name)
    }
    for name in ("front", "rear"):
        axle = getattr(car, name)
        values[name] = replace(
            axle, wheel_mass=axle.wheel_mass * wheel, tyre_stiffness=axle.tyre_stiffness * tyre
        )
    return replace(car, **values)
