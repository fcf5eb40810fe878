"""A front of two indices by layouts: the smallest of one for each value of the other.

The value of the second index is lowered in steps from where the first has its optimum to its own
optimum, evenly in its logarithm. Every point is an optimum within limits (`within.py`), with the
neighbours as further starts; limits on other indices hold at every point. A front never rises:
where a point is worse than one with a tighter second index, that one is taken.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from inerter.suspension.problem import SuspensionProblem
from inerter.suspension.within import Limited, optimise_within


@dataclass(frozen=True)
class FrontPoint:
    """`layout` that was asked for, and the design; its own layout may be a limit of it."""

    layout: str
    found: Limited


def front_of(
    problem: SuspensionProblem,
    second: str,
    limits: Mapping[str, float],
    points: int,
    done: Callable[[float], None] = lambda share: None,
) -> list[FrontPoint]:
    """The front of `problem.index` and `second` of a layout, first index ascending.

    Parameters
    ----------
    problem
        The layout, the car, and the first index.
    second
        The other index.
    limits
        Largest values of further indices, SI units.
    points
        How many.
    done
        Called with the share that is done.

    Returns
    -------
    list of FrontPoint
        None where no design keeps the limits.
    """
    first_end = optimise_within(problem, limits)
    other_end = optimise_within(replace(problem, index=second), limits)
    if first_end is None or other_end is None:
        return []
    high, low = first_end.indices[second], other_end.indices[second]
    known, found = [first_end, other_end], [first_end]
    for n, level in enumerate(np.geomspace(high, low * (1.0 + 1e-6), points)[1:]):
        own = {name: value for name, value in limits.items() if name != second}
        own[second] = min(float(level), limits.get(second, np.inf))
        one = optimise_within(problem, own, known)
        if one is not None:
            known = [first_end, other_end, one]
            found.append(one)
        done((n + 2) / points)
    # seen from the tight end, nothing may be worse than what is tighter
    kept: list[Limited] = []
    best = None
    for one in reversed(found):
        first = one.indices[problem.index]
        if best is None or first < best * (1.0 - 1e-9):
            best = first
            kept.append(one)
    return [FrontPoint(problem.layout, one) for one in reversed(kept)]
