"""A car as its file states it under payload, tyres, speed and tolerances: each figure again.

A variation is the car of a file that states the changed values, on roads of the same seeds.
`stiffness` is that of the whole strut at rest, `damping` goes through damper tables as well. What
moves the static load against the springs moves the ride height, and with it the stops: a payload
takes from the gap of the bump stop what it presses the strut together, and adds it to the rebound
stop's.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from inerter.cars.parts import GRAVITY, AxleParts, CarParts, StrutParts, Table
from inerter.suspension.time_domain.own_struts import TYRE, OwnEvaluation, evaluate_own
from inerter.suspension.time_domain.profile import Profile
from inerter.suspension.time_domain.road import PeriodicRoad
from inerter.suspension.time_domain.simulate import RunSettings
from inerter.suspension.time_domain.varied import Varied
from inerter.suspension.variations import OF_CAR, combinations

OF_STRUT = (
    "stiffness", "damping", "inertance", "relaxation_stiffness", "damper_stiffness",
    "inerter_stiffness",
)  # fmt: skip
"""Factors of the struts; those of car and road are `variations.OF_CAR`."""


@dataclass(frozen=True)
class OwnVaried:
    """`figures`: each figure's name with its value in every variation; `notes` of these."""

    figures: Mapping[str, tuple[Varied, ...]]
    notes: tuple[str, ...]


def varied_cars(
    car: CarParts, factors: Mapping[str, tuple[float, ...]]
) -> list[tuple[str, CarParts, float]]:
    """Name, car and factor of the speed of every combination.

    Raises
    ------
    ValueError
        Too many combinations, a part that no strut of the car has, or a strut that would rest on
        its bump stop.
    """
    for name in factors:
        if name not in OF_CAR and not any(_has(axle.strut, name) for axle in car.axles.values()):
            layouts = ", ".join(dict.fromkeys(axle.strut.layout for axle in car.axles.values()))
            raise ValueError(f"vary {name}: no strut of the car has it (layout {layouts})")
    return [
        (name, _changed(car, own, name), own.get("speed", 1.0))
        for name, own in combinations(factors)
    ]


def evaluate_varied(
    car: CarParts,
    factors: Mapping[str, tuple[float, ...]],
    road_at: Callable[[float], PeriodicRoad | Profile],
    seeds: int,
    settings: RunSettings,
    *,
    progress: Callable[[float], None] = lambda share: None,
    **more: Any,
) -> OwnVaried:
    """Every figure under every combination of factors.

    Parameters
    ----------
    car, seeds, settings, more
        As of `evaluate_own`.
    factors
        Names of `OF_CAR` and `OF_STRUT`, with the values each is multiplied by.
    road_at
        The road at a factor of the speed.
    progress
        Called with the share that is done.

    Raises
    ------
    ValueError
        As of `varied_cars` and `evaluate_own`; of the latter with the variation's name.
    """
    cars = varied_cars(car, factors)
    figures: dict[str, list[Varied]] = {}
    notes: list[str] = []
    for n, (name, changed, speed) in enumerate(cars):
        found = _evaluated(name, changed, road_at(speed), seeds, settings, more)
        for each in found.figures:
            one = Varied(name, each.value, each.low, each.high, each.linear)
            figures.setdefault(each.name, []).append(one)
        # how long tyres are off the road is a figure of its own
        notes += [f"{name}: {note}" for note in found.notes if not note.startswith(TYRE)]
        progress((n + 1) / len(cars))
    return OwnVaried({name: tuple(each) for name, each in figures.items()}, tuple(notes))


def _evaluated(
    name: str, car: CarParts, road: PeriodicRoad | Profile, seeds: int, settings: RunSettings,
    more: Mapping[str, Any],
) -> OwnEvaluation:  # fmt: skip
    try:
        return evaluate_own(car, road, seeds, settings, **more)
    except ValueError as error:
        raise ValueError(f"vary, {name}: {error}") from None


def _has(strut: StrutParts, name: str) -> bool:
    return bool(strut.mean_damping if name == "damping" else getattr(strut, name))


def _changed(car: CarParts, own: Mapping[str, float], name: str) -> CarParts:
    body, wheel, tyre = (own.get(key, 1.0) for key in OF_CAR[:3])
    front, rear = (
        axle
        and replace(
            axle,
            wheel_mass=axle.wheel_mass * wheel,
            tyre_stiffness=axle.tyre_stiffness * tyre,
            strut=_strut(axle.strut, own),
        )
        for axle in (car.front, car.rear)
    )
    assert front is not None
    changed = replace(
        car,
        body_mass=car.body_mass * body,
        # a payload adds to the inertias as to the mass
        pitch_inertia=car.pitch_inertia * body,
        roll_inertia=car.roll_inertia * body,
        front=front,
        rear=rear,
    )
    front, rear = (
        axle and replace(axle, strut=_on_stops(changed, car, place, name))
        for place, axle in (("front", front), ("rear", rear))
    )
    return replace(changed, front=front, rear=rear)


def _strut(strut: StrutParts, own: Mapping[str, float]) -> StrutParts:
    values = {key: getattr(strut, key) * own[key] for key in OF_STRUT if key in own}
    stronger = own.get("damping", 1.0)

    def scaled(table: Table) -> Table:
        return tuple((speed, force * stronger) for speed, force in table)

    tables = (scaled(strut.damper_bump), scaled(strut.damper_rebound))
    return replace(strut, damper_bump=tables[0], damper_rebound=tables[1], **values)


def _on_stops(car: CarParts, planned: CarParts, place: str, name: str) -> StrutParts:
    """A strut with its stops where the ride height now is."""
    strut = car.axles[place].strut
    shorter = strut.motion_ratio * (_sag(car, place) - _sag(planned, place))
    if strut.bump_stop_stiffness and shorter >= strut.bump_stop_gap > 0.0:
        raise ValueError(
            f"vary, {name}: the {place} strut sinks by {1e3 * shorter:.3g} mm, onto its bump stop "
            f"after {1e3 * strut.bump_stop_gap:.3g} mm; give a smaller factor or a larger gap"
        )
    return replace(
        strut,
        bump_stop_gap=max(strut.bump_stop_gap - shorter, 0.0),
        rebound_stop_gap=max(strut.rebound_stop_gap + shorter, 0.0),
    )


def _sag(car: CarParts, place: str) -> float:
    """How far the body's weight moves the wheel [m]."""
    axle: AxleParts = car.axles[place]
    weight = car.static_loads[place] - GRAVITY * axle.wheel_mass
    return weight / axle.strut.wheel_rate
