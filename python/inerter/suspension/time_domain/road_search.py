"""An index over roads for a search: the linear one, corrected around a design; see `search.py`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from inerter.suspension.layouts import SeriesPair
from inerter.suspension.time_domain.car_model import CarModel
from inerter.suspension.time_domain.design import Design
from inerter.suspension.time_domain.design_space import Space, each_or_one_by_one
from inerter.suspension.time_domain.linear import linear_indices, spectrum
from inerter.suspension.time_domain.plan import Plan
from inerter.suspension.time_domain.quadratic import fitted, stencil_of, terms_of
from inerter.suspension.time_domain.simulate import road_indices

Array = NDArray[np.float64]
Values = Callable[[Array], Array]


@dataclass(kw_only=True)
class RoadSearch:
    """Any index but J5."""

    plan: Plan
    model: CarModel
    space: Space
    base: SeriesPair | None
    index: str

    known: dict[bytes, float] = field(default_factory=dict)

    def start(self, point: Array) -> float:
        """The index of the first design."""
        return self.value(point, 0.0)

    def value(self, point: Array, size: float) -> float:
        """The mean index of a design, simulated; the same in boxes of every size."""
        key = point.tobytes()
        if key not in self.known:
            self.known[key] = float(np.exp(self._simulated(point[None])[0]))
        return self.known[key]

    def around(self, middle: Array, size: float) -> Values | None:
        """The corrected logarithm of the index within a box."""
        stencil = stencil_of(middle.size)
        points = middle + size * stencil
        fit = fitted(stencil, self._simulated(points) - self._linear(points))
        if fit is None:
            return None
        return lambda x: self._linear(x) + terms_of((x - middle) / size) @ fit

    def _linear(self, points: Array) -> Array:
        plan, road = self.plan, spectrum(self.plan.road)
        values = self.space.values(points)
        return np.log(
            linear_indices(
                self.index, self.model.layout, self.space.start, values, self.base, plan.car, road
            )
        )

    def _simulated(self, points: Array) -> Array:
        plan = self.plan
        seeds = range(min(plan.search_seeds, plan.seeds))

        def run(designs: list[Design]) -> Array:
            found = road_indices(
                self.model, designs, plan.road, seeds, plan.settings, indices=(self.index,)
            )
            return np.log(found[self.index].mean(axis=1))

        return each_or_one_by_one(run, [self.space.design(point) for point in points], 1)
