"""Vehicle records with hidden effects: vehicle, road, sensors, effect and its size are drawn.

    drawn_vehicle.py    the equations      vehicle_roads.py    the roads
    vehicle_draws.py    what each effect changes, and by how much
    vehicle_unknown.py  what has no name
Everything follows from a seed. An effect that changes the channels by less than twice their noise
is drawn anew, larger. Not modelled: coloured noise, sensors that run at rates of their own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.signal import lfilter

from .drawn_vehicle import DrawnCorner, DrawnVehicle, Signal
from .sizes import rms, rounded
from .vehicle_draws import (
    ACTIVE_EFFECTS,
    LEANING,
    VEHICLE_EFFECTS,
    Making,
    Sizes,
    compatible_in_vehicles,
    draw_vehicle_effect,
)
from .vehicle_roads import RoadRun, draw_run
from .vehicle_unknown import VEHICLE_UNKNOWN, draw_vehicle_unknown

Array = NDArray[np.float64]
RUNS, SECONDS, SPACING = 3, 6.0, 0.004
_TRIES = 5


@dataclass(frozen=True, kw_only=True)
class HiddenVehicle:
    """A vehicle as it is stated, its records, and what was hidden.

    Attributes
    ----------
    stated
        The vehicle that a user would state.
    active
        Whether a recorded force acts on the first strut, column "actuator_force".
    roads
        Column by corner.
    runs
        Columns by name, "time" among them, of each run.
    truth
        By run the channels without noise.
    names, places
        Of each effect: its parameters with their values; the corner, column or "" where it is.
    share
        Rms of what the effects change over the channels, each per its spread.
    """

    seed: int
    effects: tuple[str, ...]
    law: str | None
    stated: DrawnVehicle
    active: bool
    roads: tuple[str, ...]
    runs: tuple[dict[str, Array], ...]
    truth: tuple[dict[str, Array], ...] = field(repr=False)
    names: dict[str, dict[str, float]]
    places: dict[str, str]
    share: float
    kind: str | None = None

    @property
    def parameters(self) -> dict[str, float]:
        """All true values."""
        return {name: v for values in self.names.values() for name, v in values.items()}


def hide_in_vehicle(
    seed: int,
    effects: Sequence[str] = (),
    *,
    law: str | None = None,
    noise: float = 0.01,
    unknown: str | None = None,
    vehicle: str | None = None,
) -> HiddenVehicle:
    """Draw a vehicle on its roads with effects, or with one that has no name.

    Parameters
    ----------
    seed
        Everything follows from it.
    effects
        Of `VEHICLE_EFFECTS`; none: nothing is hidden.
    law
        Of hysteretic friction: "dahl" or "lugre"; drawn if not given.
    noise
        White, as a share of each channel's spread.
    unknown
        One of `VEHICLE_UNKNOWN` in place of the effects.
    vehicle
        One of `KINDS`; drawn if not given.

    Raises
    ------
    ValueError
        Effects that are not known or do not go together.
    """
    for name in effects:
        if name not in VEHICLE_EFFECTS:
            raise ValueError(f"effect: '{name}' is not one of {', '.join(VEHICLE_EFFECTS)}")
    if not compatible_in_vehicles(tuple(effects)):
        raise ValueError(f"effects: {', '.join(effects)} do not go together")
    if unknown is not None and unknown not in VEHICLE_UNKNOWN:
        raise ValueError(f"kind: '{unknown}' is not one of {', '.join(VEHICLE_UNKNOWN)}")
    choose, draw, move, shake = (
        np.random.default_rng(child) for child in np.random.SeedSequence([seed, 2]).spawn(4)
    )
    kind = vehicle or _kind(choose, tuple(effects), unknown)
    stated = draw_vehicle(draw, kind)
    needs = any(name in ACTIVE_EFFECTS for name in effects)
    active = needs or (kind in ("quarter", "arm") and choose.uniform() < 0.15)
    situation = _Situation(
        tuple(draw_run(move, SECONDS) for _ in range(RUNS)), int(move.integers(2**31)), active
    )
    bare = [situation.drive(Making(stated), i) for i in range(RUNS)]
    sizes = _sizes(stated, bare)
    columns = _sensors(choose, list(bare[0]))
    if "mounting_angle" in effects and LEANING not in columns:
        columns.append(LEANING)
    law = law or str(choose.choice(["dahl", "lugre"])) if "hysteretic_friction" in effects else None
    strength = 1.0
    for _ in range(_TRIES):
        making = Making(stated)
        for name in effects:
            draw_vehicle_effect(making, name, law, draw, sizes, strength, columns, SPACING)
        if unknown is not None:
            draw_vehicle_unknown(making, unknown, draw, sizes, strength, SECONDS)
        truth = bare
        if effects or unknown:
            truth = [situation.drive(making, i) for i in range(RUNS)]
        share = _share(bare, truth, columns)
        if share > max(2.0 * noise, 0.02) or not (effects or unknown):
            break
        strength *= 1.7
    levels = {
        name: noise * float(np.std(np.concatenate([one[name] for one in truth])))
        for name in columns
    }
    runs = [situation.recorded(stated, i, one, levels, shake) for i, one in enumerate(truth)]
    return HiddenVehicle(
        seed=seed, effects=tuple(effects), law=law, stated=stated, active=active,
        roads=tuple(f"road{name}" for name in stated.names), runs=tuple(runs),
        truth=tuple({name: one[name] for name in columns} for one in truth),
        names=making.names, places=making.places, share=share, kind=unknown,
    )  # fmt: skip


@dataclass(frozen=True)
class _Situation:
    """Roads, and the force that an active strut is commanded."""

    roads: tuple[RoadRun, ...]
    seed: int
    active: bool

    @property
    def times(self) -> Array:
        return np.asarray(SPACING * np.arange(round(SECONDS / SPACING)), dtype=np.float64)

    def command(self, run: int, size: float) -> Array:
        """The recorded force [N]: a sum of sines up to 8 Hz that grows from rest."""
        random = np.random.default_rng([self.seed, run])
        t = self.times
        tones = np.linspace(0.4, 8.0, 12)
        phases = random.uniform(0, 2 * np.pi, tones.size)
        sines = np.sin(2 * np.pi * np.multiply.outer(t, tones) + phases)
        return size * np.sqrt(2 / tones.size) * sines.sum(axis=1) * (1 - np.exp(-((t / 0.3) ** 2)))

    def drive(self, making: Making, number: int) -> dict[str, Array]:
        """The channels of a run as its sensors would show them without noise."""
        vehicle, road = making.built(), self.roads[number]
        first = max(corner.x for corner in vehicle.corners)
        tracks = [road.track(int(c.y < 0), first - c.x, making.patch) for c in vehicle.corners]
        active: Signal | None = None
        if self.active:
            t = self.times
            force = making.gain * self.command(number, _force_size(making.stated))
            if making.lag:
                fine = np.arange(0.0, t[-1], 2e-4)
                keep = np.exp(-2e-4 / making.lag)
                lagged = np.asarray(
                    lfilter([1.0 - keep], [1.0, -keep], CubicSpline(t, force)(fine))
                )
                active = _signal(fine, lagged)
            else:
                active = _signal(t, force)
        signals = [
            _signal(self.times, each(self.times, number)) if each else None
            for each in (making.on_body, making.on_wheel)
        ]
        found = vehicle.drive(tracks, self.times, active, *signals)
        return {name: making.felt(name, self.times, values) for name, values in found.items()}

    def recorded(
        self,
        stated: DrawnVehicle,
        number: int,
        channels: dict[str, Array],
        levels: dict[str, float],
        shake: Generator,
    ) -> dict[str, Array]:
        """What is written down of a run: the roads as they lie there, the force as commanded."""
        found = {"time": self.times}
        found["speed"] = np.full(self.times.size, self.roads[number].speed)
        first, road = max(corner.x for corner in stated.corners), self.roads[number]
        for corner, name in zip(stated.corners, stated.names, strict=True):
            track = road.track(int(corner.y < 0), first - corner.x)
            found[f"road{name}"] = np.array([track(t) for t in self.times])
        if self.active:
            found["actuator_force"] = self.command(number, _force_size(stated))
        for name, level in levels.items():
            values = channels[name]
            found[name] = values + level * shake.standard_normal(values.size)
        return found


def _signal(times: Array, values: Array) -> Signal:
    spline = CubicSpline(times, values)
    return lambda t: float(spline(min(t, float(times[-1]))))


def _force_size(vehicle: DrawnVehicle) -> float:
    return 0.02 * 9.81 * vehicle.body_mass


def _kind(choose: Generator, effects: tuple[str, ...], unknown: str | None) -> str:
    """A kind of vehicle in which the effects can be hidden."""
    kinds, odds = ["quarter", "half", "full", "arm"], np.array([0.45, 0.2, 0.1, 0.25])
    allowed = np.ones(4, bool)
    if any(name in ACTIVE_EFFECTS for name in effects):
        allowed &= np.array([True, False, False, True])
    if "backlash" in effects or unknown == "rider":
        # the arm's equations have no contacts and no one on the body
        allowed &= np.array([True, True, True, False])
    if "mounting_angle" in effects:
        # bodies on corners move up and down alone
        allowed &= np.array([False, False, False, True])
    odds = odds * allowed
    return str(choose.choice(kinds, p=odds / odds.sum()))


def draw_vehicle(draw: Generator, kind: str) -> DrawnVehicle:
    """Numbers of a light bench to a car, with ratios as vehicles have them."""

    def near(value: float, share: float) -> float:
        return rounded(value * draw.uniform(1 - share, 1 + share))

    quarter = near(250.0, 0.5)

    def corner(x: float, y: float) -> DrawnCorner:
        wheel = quarter * draw.uniform(0.1, 0.18)
        stiffness = quarter * (2 * np.pi * draw.uniform(1.1, 1.8)) ** 2
        damping = 2 * draw.uniform(0.15, 0.35) * np.sqrt(stiffness * quarter)
        return DrawnCorner(
            wheel_mass=rounded(wheel), stiffness=rounded(stiffness), damping=rounded(damping),
            tyre_stiffness=rounded(wheel * (2 * np.pi * draw.uniform(9.0, 12.5)) ** 2),
            inertance=rounded(quarter * draw.uniform(0.05, 0.3)), x=x, y=y,
        )  # fmt: skip

    if kind in ("quarter", "arm"):
        arm = near(0.5, 0.2)
        only = corner(0.0, 0.0)
        return DrawnVehicle(
            kind=kind, body_mass=quarter, corners=(only,), arm_length=arm,
            arm_inertia=rounded(only.wheel_mass * 0.06), strut_reach=rounded(arm * 0.8),
            strut_height=near(0.45, 0.15),
            arm_angle=_inclined(draw) if kind == "arm" else 0.0,
        )  # fmt: skip
    front, rear, track = near(1.1, 0.15), near(1.5, 0.15), near(1.5, 0.05)
    ends = {"front": front, "rear": -rear}
    if kind == "half":
        return DrawnVehicle(
            kind=kind, body_mass=2 * quarter, pitch_inertia=rounded(2 * quarter * front * rear),
            corners=tuple(corner(x, 0.0) for x in ends.values()),
            names=tuple(f"_{name}" for name in ends),
        )  # fmt: skip
    corners, names = [], []
    for name, x in ends.items():
        one = corner(x, track / 2)
        corners += [one, replace(one, y=-track / 2)]
        names += [f"_{name}_left", f"_{name}_right"]
    return DrawnVehicle(
        kind=kind, body_mass=4 * quarter, pitch_inertia=rounded(4 * quarter * front * rear),
        roll_inertia=rounded(4 * quarter * 0.3), corners=tuple(corners), names=tuple(names),
    )  # fmt: skip


def _inclined(draw: Generator) -> float:
    """Where an arm stands, up or down [rad]."""
    return rounded(float(draw.choice([-1.0, 1.0]) * draw.uniform(0.15, 0.4)))


def _sizes(vehicle: DrawnVehicle, bare: list[dict[str, Array]]) -> list[Sizes]:
    """Of every corner, along its roads."""
    found = []
    for corner, name in zip(vehicle.corners, vehicle.names, strict=True):
        x = np.concatenate([run[f"suspension_travel{name}"] for run in bare])
        runs = [np.gradient(run[f"suspension_travel{name}"], SPACING) for run in bare]
        v = np.concatenate(runs)
        a = np.concatenate([np.gradient(run, SPACING) for run in runs])
        guided = "body_acceleration" if vehicle.kind == "arm" else f"wheel_acceleration{name}"
        own = [run[guided] for run in bare]
        rate = np.concatenate([np.cumsum(a - a.mean()) * SPACING for a in own])
        tyre = np.concatenate([run[f"tyre_force{name}"] for run in bare])
        found.append(
            Sizes(
                x=rms(x), v=rms(v), a=rms(a), force=rms(corner.inertance * a + corner.damping * v),
                largest=float(x.max()), smallest=float(x.min()), guide_rate=float(np.std(rate)),
                pull=float(-tyre.min()),
            )
        )  # fmt: skip
    return found


def _sensors(choose: Generator, channels: list[str]) -> list[str]:
    """Which channels are recorded: the body's, and of the wheels' groups two or three."""
    groups = ["wheel_acceleration", "suspension_travel", "tyre_force"]
    count = int(choose.choice([1, 2, 3], p=[0.15, 0.4, 0.45]))
    kept = set(choose.choice(groups, count, replace=False))
    return [
        name for name in channels
        if name.startswith("body_") or any(name.startswith(group) for group in kept)
    ]  # fmt: skip


def _share(bare: list[dict[str, Array]], truth: list[dict[str, Array]], names: list[str]) -> float:
    squares = []
    for name in names:
        before = np.concatenate([run[name] for run in bare])
        after = np.concatenate([run[name] for run in truth])
        difference = after - before
        squares.append(np.var(difference) / np.var(before))
    return float(np.sqrt(np.mean(squares)))
