"""A fit over what is added to a fitted model alone, all that it had following linearly.

Beside a curve along the stroke a candidate adds one or two coordinates to dozens. What those can
take of a residual is told by their derivatives, which are known where they were fitted; a search is
left over what is new. The model that is found is one to compare: what all of it can do together is
told by a fit of everything from there.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import svd

from inerter.estimation.least_squares import minimise
from inerter.estimation.secants import Secants
from inerter.estimation.solution import Tolerances
from inerter.identify.kept import last_kept
from inerter.identify.model import Model
from inerter.identify.smoothness import smoothness

if TYPE_CHECKING:
    from inerter.identify.fit import Problem

Array = NDArray[np.float64]

# singular values below this share of the largest are none
_NONE = 1e-10


@dataclass(frozen=True, kw_only=True)
class Followers:
    """Coordinates that follow linearly.

    Attributes
    ----------
    names
        The coordinates.
    left, inverse
        An orthonormal basis (n, q) of what they do to what is counted, and the change of the search
        variables (p, q) per part of it.
    """

    names: tuple[str, ...]
    left: Array
    inverse: Array

    @classmethod
    def of(cls, names: tuple[str, ...], columns: Array) -> Followers:
        """Of derivatives (n, p) by their search variables."""
        left, values, right = svd(columns, full_matrices=False)
        kept = values > _NONE * values[0]
        return cls(names=names, left=left[:, kept], inverse=right[kept].T / values[kept])

    def rest(self, values: Array) -> Array:
        """What they cannot take of values (n,) or (n, k)."""
        # a prediction that runs away leaves nothing that is finite, which a search steps back from
        with np.errstate(invalid="ignore", over="ignore"):
            return values - self.left @ (self.left.T @ values)

    def change(self, values: Array) -> Array:
        """Search variables that take what they can of values (n,)."""
        return -self.inverse @ (self.left.T @ values)


def counted_columns(problem: Problem, model: Model, columns: Array) -> Array:
    """Derivatives (n, p) over masked samples with those of what holds curves below them, per rms.

    columns: by the search variables of the model's free coordinates [N].
    """
    return np.concatenate([columns / problem.scales.force, smoothness(model)])


def fit_beside(
    problem: Problem, start: Model, followers: Followers, evaluations: int, tolerance: float
) -> Model | None:
    """The best of what `start` has free beside the followers; None where no force is finite.

    evaluations: most steps; tolerance: relative fall of the cost below which a step is the last.
    The followers are where their derivatives tell, or where they were if that is nearer.
    """
    following = set(followers.names)
    inner = replace(start, free=tuple(n for n in start.free if n not in following))
    size, smooth = problem.scales.force, smoothness(start)
    which = [start.free.index(name) for name in inner.free]
    whole, at = problem.variables(start).encode(start.values), problem.residual_at(inner)

    @last_kept
    def counted(point: Array) -> Array:
        now = whole.copy()
        now[which] = point
        return np.concatenate([problem.masked(at(point)) / size, smooth @ now])

    def flat(point: Array) -> Array:
        return followers.rest(counted(point))

    def jacobian(point: Array) -> Array:
        columns = problem.columns_at(inner, point, at)
        return followers.rest(np.concatenate([columns / size, smooth[:, which]]))

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
    names = [start.free.index(name) for name in followers.names]
    step = np.zeros(len(start.free))
    step[names] = followers.change(counted(found))
    moved = problem.moved(held, step)
    errors = [np.sum(problem.masked(problem.residual(each)) ** 2) for each in (moved, held)]
    return moved if errors[0] < errors[1] else held
