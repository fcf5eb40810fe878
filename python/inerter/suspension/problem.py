"""One optimisation: a car, a layout and an index; designs as logarithms of what is free.

Bounds are relative to the car, with m = ms + mu: damping 1e-3 ... 1e3 times sqrt(kt m), inertance
1e-3 ... 1e6 times m, relaxation stiffness 1e-3 ... 1e5 times kt. Outside lies nothing but limits
(an inertance that is not felt or that holds still, a relaxation spring that is rigid).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inerter.suspension.indices import INDICES, Index
from inerter.suspension.layouts import LAYOUTS, Layout, SeriesPair
from inerter.suspension.quarter_car import QuarterCar, Road
from inerter.suspension.rational import Rational

Array = NDArray[np.float64]

_COMPLEX_STEP = 1e-30


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
    """

    car: QuarterCar
    road: Road
    layout: str
    index: str
    stiffness: float
    pair: SeriesPair | None = None
    massless: bool = False

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
        names = self.network.variables
        return tuple(name for name in names if not (self.massless and name == "inertance"))

    @property
    def bounds(self) -> Array:
        """Lower and upper bound of each variable, logarithms, shape (variables, 2)."""
        mass = self.car.sprung_mass + self.car.unsprung_mass
        ranges = {
            "damping": (math.sqrt(self.car.tyre_stiffness * mass), 1e-3, 1e3),
            "inertance": (mass, 1e-3, 1e6),
            "relaxation_stiffness": (self.car.tyre_stiffness, 1e-3, 1e5),
        }
        chosen = (ranges[name] for name in self.variables)
        return np.log([[unit * low, unit * high] for unit, low, high in chosen])

    def without(self) -> SuspensionProblem:
        """The same without inertance."""
        return replace(self, massless=True)

    def strut(self, points: NDArray[Any]) -> Rational:
        """Dynamic stiffness of the strut of each point."""
        values = dict(zip(self.variables, np.moveaxis(np.exp(points), -1, 0), strict=True))
        return self.network.stiffness(self.stiffness, pair=self.pair, **values)

    def value(self, points: NDArray[Any]) -> NDArray[Any]:
        """The index of each point."""
        return self.objective.evaluate(self.car, self.road, self.strut(points))

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
