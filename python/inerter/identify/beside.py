"""A fit over what is added to a fitted model alone, all that it had following linearly.

Beside a curve along the stroke a candidate adds one or two coordinates to dozens. What those can
take of a residual is told by their derivatives, which are known where they were fitted; a search is
left over what is new. The model that is found is one to compare: what all of it can do together is
told by a fit of everything from there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from inerter.estimation.least_squares import minimise
from inerter.estimation.secants import Secants
from inerter.estimation.solution import Tolerances
from inerter.identify.apart import Basis
from inerter.identify.kept import last_kept
from inerter.identify.model import Model
from inerter.identify.smoothness import smoothness

if TYPE_CHECKING:
    from inerter.identify.fit import Problem

Array = NDArray[np.float64]


def fit_beside(
    problem: Problem,
    start: Model,
    names: Sequence[str],
    basis: Basis,
    evaluations: int,
    tolerance: float,
) -> Model | None:
    """The best of what `start` has free beside the `names` of it, whose basis is given.

    evaluations: most steps; tolerance: relative fall of the cost below which a step is the last.
    The coordinates are where their derivatives tell, or where they were if that is nearer. None
    where no force is finite.
    """
    inner = replace(start, free=tuple(n for n in start.free if n not in names))
    size, smooth = problem.scales.force, smoothness(start)
    which = [start.free.index(name) for name in inner.free]
    whole, at = problem.variables(start).encode(start.values), problem.residual_at(inner)

    @last_kept
    def counted(point: Array) -> Array:
        now = whole.copy()
        now[which] = point
        return np.concatenate([problem.masked(at(point)) / size, smooth @ now])

    def flat(point: Array) -> Array:
        return basis.rest(counted(point))

    def jacobian(point: Array) -> Array:
        columns = problem.columns_at(inner, point, at)
        return basis.rest(np.concatenate([columns / size, smooth[:, which]]))

    begin = problem.variables(inner).encode(inner.values)
    if not np.isfinite(flat(begin)).all():
        return None
    if inner.free:
        found = minimise(
            flat, begin, problem.variables(inner).bounds, jacobian,
            tolerances=Tolerances(1e-7, tolerance, 1e-10), evaluations=evaluations,
            secants=Secants(flat, jacobian, tolerance, rough=True),
        ).variables  # fmt: skip
    else:
        found = begin
    held = replace(problem.decoded(inner, found), free=start.free)
    step = np.zeros(len(start.free))
    following = [start.free.index(name) for name in names]
    step[following] = -basis.inverse @ (basis.left.T @ counted(found))
    moved = problem.moved(held, step)
    errors = [np.sum(problem.masked(problem.residual(each)) ** 2) for each in (moved, held)]
    return moved if errors[0] < errors[1] else held
