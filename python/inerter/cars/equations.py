"""A car's equations of motion, readable: M q'' = f(q, q', roads).

Coordinates q: heave, roll and pitch of the body as far as it has them, the wheels, and in layouts
with a node between damper and inerter the displacement y of each inerter. With the rows e of the
struts' elongations x = e . q,

    M = diag(masses) + sum b e_b e_b^T
    f = - sum e_k k x_k - sum e_c F(x_c') - stops + sum e_w max(T, -static load)
    T = kt (road - w) + ct (road' - w')

A damper c behind a relaxation spring k_b (SR, S5, SW8; in SW8 with k_1 beside the damper) has no
mass between them: the spring's elongation r is a state, which the forces at that point give,

    k_b r = k_1 (x - r) + c (x' - r')

It stands among the coordinates as one whose velocity is r and whose mass is 1, so that the force on
it is r'; nothing else feels that coordinate. The spring pulls body and node with k_b r.

Sign: upward positive, positive roll lifts the left side, positive pitch lowers the front.
Not modelled: geometry that bends, friction, play and shafts of the inerter.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from inerter.cars.parts import AxleParts, CarParts, Table

Array = NDArray[np.float64]
Road = Callable[[float], float]

_NEAR = 1e-6
_NODES = ("S3", "S4", "S5", "S6", "SW7", "SW8")
_BEHIND_SPRING = ("SR", "S5", "SW8")
_CENTRED = ("SW7", "SW8")


@dataclass
class CarEquations:
    """`names` of the coordinates, `mass` matrix (n, n), and the forces.

    `roads`: names of the inputs, "road" or "road_front" ..., in the order of the wheels.
    `states`: the last of the names, "relaxation..."; their velocities are elongations of
    relaxation springs [m], see the module.
    """

    names: tuple[str, ...]
    mass: Array
    roads: tuple[str, ...]
    springs: list[tuple[Array, float]] = field(default_factory=list)
    dampers: list[tuple[Array, float, Table, Table]] = field(default_factory=list)
    stops: list[tuple[Array, float, float]] = field(default_factory=list)
    tyres: list[tuple[int, float, float]] = field(default_factory=list)
    tyre_dampings: list[float] = field(default_factory=list)
    states: tuple[str, ...] = ()
    relaxations: list[tuple[Array, int, float, float, float]] = field(default_factory=list)

    @property
    def relaxation_rate(self) -> float:
        """Fastest rate (k_b + k_1) / c of a relaxation spring [1/s], 0 without any.

        An explicit solver needs steps well below its inverse.
        """
        rates = [(kb + k1) / c for *_, kb, k1, c in self.relaxations]
        return max(rates, default=0.0)

    def forces(self, q: Array, v: Array, heights: Array, rates: Array | None = None) -> Array:
        """Generalised forces (n,) at positions, velocities and heights of the road [m].

        `rates` of the heights [m/s], 0 where not given; only damping of tyres feels them.
        """
        total = np.zeros(len(q))
        for row, k in self.springs:
            total -= row * (k * float(row @ q))
        for row, c, bump, rebound in self.dampers:
            speed = float(row @ v)
            table = rebound if speed > 0.0 else bump
            force = np.sign(speed) * _along(table, abs(speed)) if table else c * speed
            total -= row * force
        for row, gap, k in self.stops:
            # gap < 0: a bump stop, felt below it
            beyond = min(float(row @ q) - gap, 0.0) if gap < 0.0 else max(float(row @ q) - gap, 0.0)
            total -= row * (k * beyond)
        for row, state, kb, k1, c in self.relaxations:
            longer = v[state]
            pull = kb * longer
            total -= row * pull
            total[state] += float(row @ v) - (pull - k1 * (float(row @ q) - longer)) / c
        pressed = self.tyre_forces(q, heights, v, rates)
        for (place, *_), force in zip(self.tyres, pressed, strict=True):
            total[place] += force
        return total

    def tyre_forces(
        self, q: Array, heights: Array, v: Array | None = None, rates: Array | None = None
    ) -> Array:
        """Dynamic forces that press the tyres [N], (wheels,); velocities 0 where not given."""
        v = np.zeros(len(q)) if v is None else v
        rates = np.zeros(len(heights)) if rates is None else rates
        every = zip(self.tyres, self.tyre_dampings, heights, rates, strict=True)
        pressed = [
            max(kt * (height - q[place]) + ct * (rate - v[place]), -load)
            for (place, kt, load), ct, height, rate in every
        ]
        return np.array(pressed)


def _along(table: Table, speed: float) -> float:
    """Straight between the points, beyond the last with its last slope."""
    points = np.array([(0.0, 0.0), *table])
    if speed <= points[-1, 0]:
        return float(np.interp(speed, points[:, 0], points[:, 1]))
    (v0, f0), (v1, f1) = points[-2:]
    return float(f1 + (speed - v1) * (f1 - f0) / (v1 - v0))


def car_equations(car: CarParts) -> CarEquations:
    """The equations of a car.

    Raises
    ------
    ValueError
        An inerter with friction or play, or a damper table behind a relaxation spring.
    """
    corners = _corners(car)
    body = {"heave": car.body_mass}
    if car.kind == "full":
        body["roll"] = car.roll_inertia
    if car.kind != "quarter":
        body["pitch"] = car.pitch_inertia
    wheels = [f"wheel{place}" for place, *_ in corners]
    nodes = [f"device{place}" for place, axle, *_ in corners
             if axle.strut.layout in _NODES]  # fmt: skip
    states = tuple(f"relaxation{place}" for place, axle, *_ in corners
                   if axle.strut.layout in _BEHIND_SPRING)  # fmt: skip
    names = (*body, *wheels, *nodes, *states)
    unit = {name: np.eye(len(names))[n] for n, name in enumerate(names)}
    diagonal = [
        *body.values(),
        *(axle.wheel_mass for _, axle, *_ in corners),
        *(0.0 for _ in nodes),
        *(1.0 for _ in states),
    ]
    roads = tuple(f"road{place}" for place, *_ in corners)
    found = CarEquations(names, np.diag(diagonal), roads, states=states)
    travels: dict[str, Array] = {}
    for place, axle, x, y in corners:
        travel = unit["heave"] - unit[f"wheel{place}"]
        travel = travel - x * unit["pitch"] if "pitch" in unit else travel
        travel = travel + y * unit["roll"] if "roll" in unit else travel
        travels[place] = travel
        stroke = axle.strut.motion_ratio * travel
        _add_strut(found, axle, stroke, unit.get(f"device{place}", stroke), f"relaxation{place}")
        load = car.static_loads["rear" if "rear" in place else "front"]
        found.tyres.append((names.index(f"wheel{place}"), axle.tyre_stiffness, load))
        found.tyre_dampings.append(axle.tyre_damping)
    for name, axle in car.axles.items():
        if axle.anti_roll_stiffness:
            row = travels[f"_{name}_left"] - travels[f"_{name}_right"]
            found.springs.append((row, axle.anti_roll_stiffness / 2.0))
    return found


def _corners(car: CarParts) -> list[tuple[str, AxleParts, float, float]]:
    """Place with a leading "_", axle, position forward and to the left [m]."""
    if car.kind == "quarter":
        return [("", car.front, 0.0, 0.0)]
    found = []
    for name, axle in car.axles.items():
        x = axle.distance if name == "front" else -axle.distance
        sides = {"_left": 0.5, "_right": -0.5} if car.kind == "full" else {"": 0.0}
        found += [(f"_{name}{side}", axle, x, share * car.track) for side, share in sides.items()]
    return found


def _add_strut(found: CarEquations, axle: AxleParts, x: Array, y: Array, state: str) -> None:
    """`x`: elongation, `y`: that of the inerter; `state`: the relaxation spring's name."""
    s = axle.strut
    tables = (s.damper_bump, s.damper_rebound)
    if s.device:
        raise ValueError(
            "device: friction, play and shafts of the inerter are the plugin's; take the MuJoCo "
            "model, or leave device out"
        )
    damped = x - y if s.layout in _NODES and s.layout != "S4" else y
    if s.layout in ("S4", "S6"):
        found.springs.append((x - y, s.relaxation_stiffness))
    beside, k1 = s.stiffness, 0.0
    if s.layout in _CENTRED:
        k1, k2 = s.damper_stiffness, s.inerter_stiffness
        found.springs.append((y, k2))
        yields = 1.0 / k1 + 1.0 / k2
        yields += 1.0 / s.relaxation_stiffness if s.layout == "SW8" else 0.0
        beside -= 1.0 / yields
    found.springs.append((x, beside))
    found.mass += s.inertance * np.outer(y, y)
    if s.layout in _BEHIND_SPRING:
        if any(tables):
            raise ValueError(
                f"layout {s.layout}: its damper is behind a relaxation spring and has to be "
                "linear; give damping in place of the tables"
            )
        place = found.names.index(state)
        found.relaxations.append((damped, place, s.relaxation_stiffness, k1, s.damping))
    else:
        if s.layout == "SW7":
            found.springs.append((damped, k1))
        found.dampers.append((damped, s.damping, *tables))
    if s.bump_stop_stiffness:
        found.stops.append((x, -max(s.bump_stop_gap, 1e-300), s.bump_stop_stiffness))
    if s.rebound_stop_stiffness:
        found.stops.append((x, s.rebound_stop_gap, s.rebound_stop_stiffness))


def heights(roads: Mapping[str, Road], names: tuple[str, ...], t: float) -> Array:
    """Heights of the roads at an instant [m]; flat where there is none."""
    return np.array([float(roads[name](t)) if name in roads else 0.0 for name in names])


def rising(roads: Mapping[str, Road], names: tuple[str, ...], t: float) -> Array:
    """Rates of the heights at an instant [m/s], from the road a microsecond before and after."""
    after, before = (heights(roads, names, t + late) for late in (_NEAR, -_NEAR))
    return (after - before) / (2.0 * _NEAR)
