"""One optimisation: a car, a layout and an index; designs as logarithms of what is free.

Bounds are relative to the car, with m = ms + mu: damping 1e-3 ... 1e3 times sqrt(kt m), inertance
1e-3 ... 1e6 times m, relaxation stiffness 1e-3 ... 1e5 times kt, share of the centring springs
1e-6 ... 1, their ratio 1e-6 ... 1e6. Outside lies nothing but limits
(an inertance that is not felt or that holds still, a relaxation spring that is rigid).
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inerter.suspension.indices import INDICES, Index, is_infinite
from inerter.suspension.layouts import LAYOUTS, Layout, SeriesPair
from inerter.suspension.quarter_car import QuarterCar, Road
from inerter.suspension.rational import Rational
from inerter.suspension.variations import Scene

Array = NDArray[np.float64]

Catalogue = tuple[tuple[str, tuple[float, ...]], ...]

_COMPLEX_STEP = 1e-30
_LITTLE = 1e-3


def in_limit(name: str, value: float) -> tuple[tuple[str, float], ...]:
    """What is fixed where a variable is 0 or without limit: itself, and what then means nothing."""
    more = (("centring_ratio", 1.0),) if name == "centring_share" else ()
    return ((name, value), *more)


def without_inertance(network: Layout, free: Collection[str]) -> tuple[tuple[str, float], ...]:
    """What of the `free` variables means nothing more in a layout that has lost its inertance.

    Of centred layouts springs and damper are left: a damper behind one spring (SR) for any share.
    """
    if not network.centred:
        return ()
    values = {"centring_share": _LITTLE, "relaxation_stiffness": math.inf}
    return tuple((name, value) for name, value in values.items() if name in free)


@dataclass(frozen=True, kw_only=True)
class SuspensionProblem:
    """What is to be minimised over which designs.

    A point is the logarithms of `variables`; arrays of points have shape (n, variables).

    Attributes
    ----------
    layout, index
        Names in `LAYOUTS` and `INDICES`.
    stiffness
        k [N/m].
    pair
        Series pair of the inerter; ideal without.
    massless
        Only designs without inertance.
    fixed
        Variables that are not free, with their values [SI].
    limits
        Indices that may not be higher than a value, see `limited`.
    catalogue
        Variables that have one of some values [SI], see `picked`.
    scenes
        What the index is a root mean square over, see `variations`; without, of the car itself.
    """

    car: QuarterCar
    road: Road
    layout: str
    index: str
    stiffness: float
    pair: SeriesPair | None = None
    massless: bool = False
    fixed: tuple[tuple[str, float], ...] = ()
    limits: tuple[tuple[str, float], ...] = ()
    catalogue: Catalogue = ()
    scenes: tuple[Scene, ...] = ()

    @property
    def network(self) -> Layout:
        """The layout by its name."""
        return LAYOUTS[self.layout]

    @property
    def objective(self) -> Index:
        """The index by its name."""
        return INDICES[self.index]

    @property
    def variables(self) -> tuple[str, ...]:
        """What is free."""
        taken = {name for name, _ in self.fixed} | ({"inertance"} if self.massless else set())
        return tuple(name for name in self.network.variables if name not in taken)

    @property
    def held(self) -> dict[str, float]:
        """The fixed variables that the layout has, by name."""
        return {name: value for name, value in self.fixed if name in self.network.variables}

    @property
    def may_vanish(self) -> bool:
        """Without inertance the layout still is a strut, and the inertance is free."""
        return self.network.may_vanish and "inertance" in self.variables

    @property
    def bounds(self) -> Array:
        """Lower and upper bound of each variable, logarithms, shape (variables, 2)."""
        mass = self.car.sprung_mass + self.car.unsprung_mass
        ranges = {
            "damping": (math.sqrt(self.car.tyre_stiffness * mass), 1e-3, 1e3),
            "inertance": (mass, 1e-3, 1e6),
            "relaxation_stiffness": (self.car.tyre_stiffness, 1e-3, 1e5),
            "centring_share": (1.0, 1e-6, 1.0),
            "centring_ratio": (1.0, 1e-6, 1e6),
        }
        chosen = (ranges[name] for name in self.variables)
        return np.log([[unit * low, unit * high] for unit, low, high in chosen]).reshape(-1, 2)

    def without(self) -> SuspensionProblem:
        """The same without inertance."""
        more = without_inertance(self.network, self.variables)
        return replace(self, massless=True, fixed=(*self.fixed, *more))

    def picked(self) -> list[SuspensionProblem]:
        """The problem with each choice from its catalogue fixed; itself without a catalogue."""
        plain = replace(self, catalogue=())
        free = [(name, values) for name, values in self.catalogue if name in self.variables]
        names = [name for name, _ in free]
        return [
            replace(plain, fixed=(*self.fixed, *zip(names, chosen, strict=True)))
            for chosen in itertools.product(*(values for _, values in free))
        ]

    def infinite(self, index: str) -> bool:
        """Whether an index of (nearly) every design is infinite, see `indices.is_infinite`."""
        if not self.car.tyre_damping:
            return False
        return is_infinite(index, self.car, self.strut(self.bounds.mean(axis=1)))

    def variants(self) -> list[SuspensionProblem]:
        """The problem, then those in which what may be absent is."""
        found: list[SuspensionProblem] = [self, *([self.without()] if self.may_vanish else [])]
        more = [
            replace(one, fixed=(*one.fixed, *in_limit(name, value)))
            for name, value in self.network.limits
            for one in found
            if name in one.variables
        ]
        return found + [one for one in more if not one.infinite(self.index)]

    def inner(self) -> list[SuspensionProblem]:
        """The problems of the layouts that this one contains."""
        found = []
        for name in self.network.inner:
            names = LAYOUTS[name].variables
            fixed = tuple((n, value) for n, value in self.fixed if n in names)
            massless = self.massless and LAYOUTS[name].may_vanish
            found.append(replace(self, layout=name, fixed=fixed, massless=massless))
        return [one for one in found if not one.infinite(self.index)]

    def embedded(self, layout: str, values: Mapping[str, float]) -> Array:
        """The point that is most like a design of a layout that this one contains."""
        values = dict(values)
        if self.network.centred and not LAYOUTS[layout].centred:
            values["centring_share"] = 0.0
            spring = values.get("relaxation_stiffness")
            if LAYOUTS[layout].own == "S6" and spring:
                # k_1 is the relaxation spring of S6
                values["centring_ratio"] = 1e6 * spring / self.stiffness
            elif LAYOUTS[layout].own == "SR":
                # without inertance k_2 is the relaxation spring of SR
                values |= {"centring_ratio": 0.0, "inertance": 0.0}
            else:
                values["centring_ratio"] = 1.0
        low, high = np.exp(self.bounds.T)
        # an inertance beside the damper fades, one behind it holds still; a spring is rigid
        small = {"inertance"} if self.network.own in ("S2", "S4") else set()
        small |= {"relaxation_stiffness"} if self.network.own == "S6" else set()
        ends = [0.0 if name in small else math.inf for name in self.variables]
        chosen = [values.get(name, end) for name, end in zip(self.variables, ends, strict=True)]
        return np.log(np.clip(chosen, low, high))

    def strut(self, points: NDArray[Any]) -> Rational:
        """Dynamic stiffness of the strut of each point."""
        values = dict(zip(self.variables, np.moveaxis(np.exp(points), -1, 0), strict=True))
        return self.network.stiffness(self.stiffness, pair=self.pair, **self.held, **values)

    def value(self, points: NDArray[Any]) -> NDArray[Any]:
        """The index of each point."""
        if self.scenes:
            values = [self.at(scene).value(points + self._shift(scene)) for scene in self.scenes]
            return np.sqrt(sum(value**2 for value in values) / len(values))
        return self.objective.evaluate(self.car, self.road, self.strut(points))

    def at(self, scene: Scene) -> SuspensionProblem:
        """The problem in one scene; its points are shifted by what the free parts are off."""
        fixed = scene.fixed(self.fixed)
        return replace(self, car=scene.car, road=scene.road, fixed=fixed, scenes=())

    def _shift(self, scene: Scene) -> Array:
        return np.array([scene.shift(name) for name in self.variables])

    def in_scenes(self, point: Array) -> list[float]:
        """The index of one point in each scene."""
        return [
            float(np.ravel(self.at(scene).value((point + self._shift(scene))[None]))[0])
            for scene in self.scenes
        ]

    def logarithm(self, point: Array) -> tuple[float, Array]:
        """Logarithm of a smooth index at one point and its gradient, exact by a complex step."""
        values = np.log(self.value(self._perturbed(point)))
        return float(np.real(values[0])), np.imag(values[1:]) / _COMPLEX_STEP

    def load_function(self, points: NDArray[Any]) -> Rational:
        """zs/Fs of each point."""
        return self.car.body_per_load(self.strut(points))

    def load_function_perturbed(self, point: Array) -> Rational:
        """zs/Fs at the point, then with a complex step in each variable."""
        return self.load_function(self._perturbed(point))

    @staticmethod
    def step_gradient(values: NDArray[Any]) -> NDArray[Any]:
        """Gradient from values at the designs of a complex step, the first axis."""
        return np.imag(values[1:]) / _COMPLEX_STEP

    def _perturbed(self, point: Array) -> NDArray[np.complex128]:
        steps = np.vstack([np.zeros(len(point)), np.eye(len(point))])
        return point + 1j * _COMPLEX_STEP * steps
