"""One optimisation of a half- or full car; designs as logarithms of what is free at each axle.

Bounds are those of the quarter-cars at the corners: damping 1e-3 ... 1e3 times sqrt(kt m),
inertance 1e-3 ... 1e6 times m, relaxation stiffness 1e-3 ... 1e5 times kt, with kt and m = ms + mu
of the axle; for equal struts geometric means of both.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inerter.suspension.indices import INDICES, Index
from inerter.suspension.layouts import LAYOUTS, Layout, SeriesPair
from inerter.suspension.problem import (
    Array,
    Catalogue,
    SuspensionProblem,
    in_limit,
    without_inertance,
)
from inerter.suspension.quarter_car import Road
from inerter.suspension.variations import Scene
from inerter.suspension.vehicle.cars import Vehicle
from inerter.suspension.vehicle.indices import Branches, load_of, quick_rms_index, rms_index
from inerter.suspension.vehicle.load import Load
from inerter.suspension.vehicle.load_peaks import largest_gain
from inerter.suspension.vehicle.state_space import system
from inerter.suspension.vehicle.strut import VehicleStrut, branch
from inerter.suspension.vehicle.white_noise import is_white

_COMPLEX_STEP = 1e-30


@dataclass(frozen=True, kw_only=True)
class VehicleProblem:
    """What is to be minimised over which designs.

    A point is the logarithms of the variables of the front, then of the rear; or of both at once
    where they are to be equal. Arrays of points have shape (n, variables).

    Attributes
    ----------
    layout, index
        Names in `LAYOUTS` and `INDICES`.
    stiffnesses
        k [N/m], front and rear.
    pair
        Series pair of the inerters; ideal without.
    equal
        The same damping, inertance and relaxation spring at both axles.
    massless
        Front, rear: only designs without inertance there.
    fixed
        Front, rear: variables that are not free, with their values [SI].
    limits
        Indices that may not be higher than a value, see `limited`.
    catalogue
        Variables that have one of some values [SI] at each axle, see `picked`.
    scenes
        What the index is a root mean square over, see `variations`; without, of the car itself.
    """

    car: Vehicle
    road: Road
    layout: str
    index: str
    stiffnesses: tuple[float, float]
    pair: SeriesPair | None = None
    equal: bool = False
    massless: tuple[bool, bool] = (False, False)
    fixed: tuple[tuple[tuple[str, float], ...], tuple[tuple[str, float], ...]] = ((), ())
    limits: tuple[tuple[str, float], ...] = ()
    catalogue: Catalogue = ()
    scenes: tuple[Scene, ...] = ()

    @property
    def network(self) -> Layout:
        """The layout by its name."""
        return LAYOUTS[self.layout]

    @property
    def objective(self) -> Index:
        """The index by its name, for its unit and meaning."""
        return INDICES[self.index]

    @property
    def variables(self) -> tuple[tuple[int, str], ...]:
        """What is free: axle (0 front, 1 rear) and name."""
        axles = (0,) if self.equal else (0, 1)
        return tuple(
            (axle, name)
            for axle in axles
            for name in self.network.variables
            if not (self.massless[axle] and name == "inertance")
            and name not in dict(self.fixed[axle])
        )

    @property
    def may_vanish(self) -> bool:
        """Without inertance the layout still is a strut, and the inertance is free."""
        return self.network.may_vanish and any(name == "inertance" for _, name in self.variables)

    def _held(self) -> tuple[dict[str, float], dict[str, float]]:
        """The fixed variables that the layout has, by axle."""
        names = self.network.variables
        front, rear = ({n: x for n, x in own if n in names} for own in self.fixed)
        return front, rear

    @property
    def bounds(self) -> Array:
        """Lower and upper bound of each variable, logarithms, shape (variables, 2)."""
        front, rear = (
            dict(zip(corner.variables, corner.bounds, strict=True)) for corner in self.corners()
        )
        if self.equal:
            front = rear = {name: 0.5 * (front[name] + rear[name]) for name in front}
        return np.array([(front, rear)[axle][name] for axle, name in self.variables]).reshape(-1, 2)

    def corners(self) -> tuple[SuspensionProblem, SuspensionProblem]:
        """The problems of the quarter-cars at the axles; where they turn, of their comfort."""
        cars = self.car.side.corners()
        own = self.objective
        turns = {"pitch", "roll"} & {self.index, own.signal, *own.parts}
        front, rear = (
            SuspensionProblem(
                car=car,
                road=self.road,
                layout=self.layout,
                index="J1" if turns else self.index,
                stiffness=k,
                pair=self.pair,
                massless=no_inerter,
                fixed=held,
            )
            for car, k, no_inerter, held in zip(
                cars, self.stiffnesses, self.massless, self.fixed, strict=True
            )
        )
        return front, rear

    def without(self, massless: tuple[bool, bool]) -> VehicleProblem:
        """The same without inertance in front, at the rear or at both."""
        front, rear = (
            (*own, *without_inertance(self.network, names)) if no_inerter else own
            for own, no_inerter, names in zip(self.fixed, massless, self._free(), strict=True)
        )
        return replace(self, massless=massless, fixed=(front, rear))

    def _free(self) -> tuple[list[str], list[str]]:
        """The names of the variables, by axle."""
        names: tuple[list[str], list[str]] = ([], [])
        for axle, name in self.variables:
            names[axle].append(name)
        return (names[0], names[0]) if self.equal else names

    def picked(self) -> list[VehicleProblem]:
        """The problem with each choice from its catalogue fixed; itself without a catalogue."""
        front, rear = (replace(each, catalogue=self.catalogue).picked() for each in self.corners())
        if self.equal:
            pairs = [(one.fixed, one.fixed) for one in front]
        else:
            pairs = [(one.fixed, other.fixed) for one in front for other in rear]
        return [replace(self, catalogue=(), fixed=pair) for pair in pairs]

    def infinite(self, index: str) -> bool:
        """Whether an index of (nearly) every design is infinite, see `white_road`."""
        own, car = INDICES[index], self.car
        if index == "J5" or not (car.front.tyre_damping or car.rear.tyre_damping):
            return False
        branches = self.branches(self.bounds.mean(axis=1))
        return any(
            is_white(system(plane, branches), part)
            for plane in car.planes
            for part in own.parts or (index,)
        )

    def variants(self) -> list[VehicleProblem]:
        """The problem, then those in which what may be absent at an axle or both is."""
        found: list[VehicleProblem] = [self]
        if self.may_vanish:
            axles = [(True, True)] if self.equal else [(True, False), (False, True), (True, True)]
            held = ["inertance" in dict(own) for own in self.fixed]
            found += [
                self.without(way)
                for way in axles
                if way != self.massless and not any(w and h for w, h in zip(way, held, strict=True))
            ]
        for name, value in self.network.limits:
            if any(name == free for _, free in self.variables):
                front, rear = (own + in_limit(name, value) for own in self.fixed)
                found.append(replace(self, fixed=(front, rear)))
        return [one for one in found if one is self or not one.infinite(self.index)]

    def inner(self) -> list[VehicleProblem]:
        """The problems of the layouts that this one contains."""
        found = []
        for name in self.network.inner:
            names = LAYOUTS[name].variables
            front, rear = (
                tuple((n, value) for n, value in own if n in names) for own in self.fixed
            )
            massless = self.massless if LAYOUTS[name].may_vanish else (False, False)
            found.append(replace(self, layout=name, fixed=(front, rear), massless=massless))
        return [one for one in found if not one.infinite(self.index)]

    def embedded(self, struts: tuple[VehicleStrut, VehicleStrut], layout: str) -> Array:
        """The point that is most like a design of a layout that this one contains."""
        low, high = self.bounds.T
        parts = [
            dict(zip(corner.variables, corner.embedded(layout, strut.layout_values()), strict=True))
            for corner, strut in zip(self.corners(), struts, strict=True)
        ]
        return np.clip([parts[axle][name] for axle, name in self.variables], low, high)

    def static_compliance(self) -> float:
        """What no strut can take J5 below [m/N]."""
        return self.car.side.static_compliance(self.stiffnesses) / self.car.sides

    def branches(self, points: NDArray[Any]) -> Branches:
        """The struts of each point."""
        values: tuple[dict[str, Any], dict[str, Any]] = self._held()
        for (axle, name), value in zip(
            self.variables, np.moveaxis(np.exp(points), -1, 0), strict=True
        ):
            values[axle][name] = value
            if self.equal:
                values[1][name] = value
        front, rear = (
            branch(self.network, k, pair=None if no_inerter else self.pair, **own)
            for k, own, no_inerter in zip(self.stiffnesses, values, self.massless, strict=True)
        )
        return front, rear

    def struts(self, point: Array) -> tuple[VehicleStrut, VehicleStrut]:
        """The design of a point."""
        own = self._held()
        for (axle, name), value in zip(self.variables, np.exp(point).tolist(), strict=True):
            # without what a logarithm and back leave in the last digits
            own[axle][name] = float(f"{value:.13g}")
        if self.equal:
            own[1].update(own[0])
        front, rear = (VehicleStrut(k, **one) for k, one in zip(self.stiffnesses, own, strict=True))
        return front, rear

    def point(self, struts: tuple[VehicleStrut, VehicleStrut]) -> Array:
        """The point of a design, the inverse of `struts`, or the nearest within the bounds."""
        low, high = np.exp(self.bounds.T)
        values = [getattr(struts[axle], name) for axle, name in self.variables]
        return np.log(np.clip(values, low, high))

    def value(self, points: NDArray[Any]) -> Array:
        """The index of each point, exactly, one after another."""
        if self.scenes:
            values = [self.at(scene).value(points + self._shift(scene)) for scene in self.scenes]
            return np.sqrt(np.mean(np.square(values), axis=0))
        if self.index == "J5":
            return np.array([largest_gain(self.load(point)) for point in points])
        return np.array(
            [
                rms_index(self.index, self.car, self.road, self.branches(point))[0]
                for point in points
            ]
        )

    def quick(self, points: Array) -> Array:
        """A smooth index of each point, good enough for a search."""
        if self.scenes:
            values = [self.at(scene).quick(points + self._shift(scene)) for scene in self.scenes]
            return np.sqrt(np.mean(np.square(values), axis=0))
        return quick_rms_index(self.index, self.car, self.road, self.branches(points))

    def logarithm(self, point: Array) -> tuple[float, Array]:
        """Logarithm of a smooth index at one point and its gradient, exact."""
        if self.scenes:
            found = [self.at(one).logarithm(point + self._shift(one)) for one in self.scenes]
            squares = np.exp(2.0 * np.array([value for value, _ in found]))
            slope = squares @ np.array([slope for _, slope in found]) / squares.sum()
            return 0.5 * float(np.log(squares.mean())), slope
        perturbed = self.branches(self._perturbed(point))
        value, slope = rms_index(self.index, self.car, self.road, perturbed, _COMPLEX_STEP)
        return float(np.log(value)), slope / value

    def at(self, scene: Scene) -> VehicleProblem:
        """The problem in one scene; its points are shifted by what the free parts are off."""
        front, rear = map(scene.fixed, self.fixed)
        return replace(self, car=scene.car, road=scene.road, fixed=(front, rear), scenes=())

    def _shift(self, scene: Scene) -> Array:
        return np.array([scene.shift(name) for _, name in self.variables])

    def in_scenes(self, point: Array) -> list[float]:
        """The index of one point in each scene."""
        return [
            float(self.at(scene).value((point + self._shift(scene))[None])[0])
            for scene in self.scenes
        ]

    def load(self, points: Array) -> Load:
        """zc/F of each point."""
        return load_of(self.car, self.branches(points))

    def levels(self, point: Array, frequency: Array) -> tuple[Array, Array]:
        """Logarithm of |zc/F| at each frequency [rad/s] and its gradient.

        The gradient has shape (frequencies, variables).
        """
        perturbed = self.branches(self._perturbed(point))
        slopes = [one.parameter_slopes(1j * frequency, _COMPLEX_STEP) for one in perturbed]
        logs, gradient = self.load(point).sensitivity(frequency, (slopes[0], slopes[1]))
        return logs, gradient.T

    @staticmethod
    def _perturbed(point: Array) -> NDArray[np.complex128]:
        steps = np.vstack([np.zeros(len(point)), np.eye(len(point))])
        return point + 1j * _COMPLEX_STEP * steps
