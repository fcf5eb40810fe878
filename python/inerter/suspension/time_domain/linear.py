"""What is exact: indices and optimum of the linear cases, from the linear study."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from inerter.suspension.indices import INDICES
from inerter.suspension.layouts import LAYOUTS, SeriesPair
from inerter.suspension.optimum import optimise
from inerter.suspension.problem import Problem
from inerter.suspension.quarter_car import QuarterCar, Road
from inerter.suspension.time_domain.model import Design

SMALLEST_INERTANCE = 1e-3
"""[kg] in place of 0 where an inerter has to be there: too little to be felt."""


def exact_index(
    index: str, layout: str, design: Design, pair: SeriesPair | None, car: QuarterCar, road: Road
) -> float:
    """An index of a design with an ideal or elastic inerter, as a norm of its transfer function."""
    network = LAYOUTS[layout].stiffness(
        design.stiffness, design.damping, design.inertance, pair=pair
    )
    return float(np.squeeze(INDICES[index].evaluate(car, road, network)))


@lru_cache(maxsize=1024)
def linear_optimum(
    index: str, layout: str, stiffness: float, pair: SeriesPair | None, car: QuarterCar, road: Road
) -> Design:
    """The c and b of the smallest index, with an ideal or elastic inerter."""
    found = optimise(Problem(car, road, layout, index, stiffness, pair))
    inertance = 0.0 if layout == "S1" else max(found.inertance, SMALLEST_INERTANCE)
    return Design(stiffness, found.damping, inertance)
