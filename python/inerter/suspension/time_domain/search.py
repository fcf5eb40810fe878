"""c and b sought anew for a nonlinear case: the exact linear index, corrected by simulations.

    J(x) = J_linear(x) exp(p(x))        J1, J3:  x logarithms of every c and b
    J(x) = max_f G_linear(x, f) exp(p(x, f))     J5

p is the quadratic through log(simulated / linear) at a few designs around the best one so far,
for J5 at each of some frequencies, with a spline between them. The linear study carries what is
sharp: the resonances, and the corner of J5's optimum where two peaks are equal, in which searches
of the maximum itself get stuck. What friction, elasticity and play add to it is smooth. The
corrected index is minimised within a box around the best design, the result is simulated, the box
moves there and shrinks. All designs of a round run at once (`mujoco.batch`). What is handed out is
the best design that was simulated, the linear optimum among them; the roads are the same for
every design.

J5: after Wang and Su's energy ratio, see `load_peaks`. Range: optima within a factor of `REACH` of
the linear one.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from inerter.suspension.layouts import SeriesPair
from inerter.suspension.time_domain.car_model import CarModel
from inerter.suspension.time_domain.design import Design
from inerter.suspension.time_domain.design_space import Space
from inerter.suspension.time_domain.load_search import LoadSearch
from inerter.suspension.time_domain.plan import Plan
from inerter.suspension.time_domain.road_search import RoadSearch

Array = NDArray[np.float64]
Values = Callable[[Array], Array]

REACH = 50.0
"""c and b stay within this factor of where they start."""

_FIRST_BOX, _LAST_BOX = 0.5, 0.02
_SHRINK = 0.3
_ROUNDS = 12


def reoptimised(
    plan: Plan,
    model: CarModel,
    index: str,
    start: Design,
    pair: SeriesPair | None = None,
    like_case: bool = True,
) -> Design:
    """The c and b of the smallest mean index, sought from `start`.

    Parameters
    ----------
    plan, model, index
        What is simulated, with `plan.search_seeds` roads.
    start
        Usually the linear optimum.
    pair, like_case
        Series pair of the linear study that is corrected: the case's own unless `like_case` is
        false.
    """
    space = Space(start, model.layout, plan.held)
    base = model.case.pair if like_case else pair
    search = (
        LoadSearch(plan=plan, model=model, space=space, base=base)
        if index == "J5"
        else RoadSearch(plan=plan, model=model, space=space, base=base, index=index)
    )
    origin, limit = space.origin, math.log(REACH)
    first = search.start(origin)
    best, value, size = origin, first, _FIRST_BOX
    for _ in range(_ROUNDS):
        corrected = search.around(best, size)
        gain = moved = 0.0
        if corrected is not None:
            low = np.maximum(best - size, origin - limit)
            high = np.minimum(best + size, origin + limit)
            point = _minimum(corrected, low, high)
            # both with the same net
            value, found = search.value(best, size), search.value(point, size)
            moved = float(np.max(np.abs(point - best)))
            gain = 1.0 - found / value if math.isfinite(value) else 1.0
            if found < value:
                best, value = point, found
        # a box whose edge is best is moved, not shrunk
        if not (gain > 1e-5 and moved > 0.95 * size):
            size *= _SHRINK
        if size < _LAST_BOX:
            break
    return space.design(best if search.start(best) < first else origin)


def _minimum(function: Values, low: Array, high: Array) -> Array:
    """The smallest value in a box: a grid around the best point, ever finer."""
    count = low.size
    number, zoom = {1: (41, 0.15), 2: (15, 0.35)}.get(count, (5, 0.7))
    grid = np.array(list(itertools.product(np.linspace(-1.0, 1.0, number), repeat=count)))
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    while np.max(half) > 1e-5 * np.max(high - low):
        points = np.clip(middle + half * grid, low, high)
        values = function(points)
        middle = points[int(np.argmin(np.where(np.isfinite(values), values, np.inf)))]
        half = half * zoom
    return middle
