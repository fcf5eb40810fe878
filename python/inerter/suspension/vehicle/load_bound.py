"""Which design to give where J5 is at its lower bound, or comes near it in a limit.

The bound is the yielding of the centre of mass under a constant load. Where springs are soft a
whole region of designs has it: the one with the smallest J1 is given. Layouts without a damper
that is their own come to it only as their inertance grows without limit.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from inerter.suspension.problem import Array
from inerter.suspension.vehicle.polish_peaks import polish_peaks
from inerter.suspension.vehicle.problem import VehicleProblem
from inerter.suspension.vehicle.search import EQUAL, at_bound, best_point
from inerter.suspension.vehicle.softest import softest
from inerter.suspension.vehicle.strut import VehicleStrut

# relative: what counts as near the bound
NEAR = 1e-5
# there a search over all designs could not gain more than this
_CLOSE = 1e-4


def softest_at_bound(
    variants: list[VehicleProblem], reached: VehicleProblem, start: Array
) -> tuple[VehicleProblem, Array]:
    """Of all designs at the bound the one with the smallest J1, and whose problem it is.

    Parameters
    ----------
    variants
        The problem, then those without inertance at an axle or both.
    reached, start
        One of them and a point of it at the bound.
    """
    limit = reached.static_compliance() * (1.0 + EQUAL)
    struts = reached.struts(start)
    best, problem, point = np.inf, reached, start
    for one in variants:
        found = softest(one, one.point(struts), limit)
        if found is None:
            found = softest(one, best_point(replace(one, index="J1"))[1], limit)
        if found is not None and found[0] < best - 1e-12:
            best, problem, point = found[0], one, found[1]
        # where inertance helps there is no need to look without it
        if problem is variants[0] and (point > problem.bounds[:, 0] + 1e-6).all():
            break
    return problem, point


def in_the_limit(problem: VehicleProblem) -> tuple[float, Array] | None:
    """Value and point of a design near the bound, where spring and damper alone reach it.

    With a rigid inertance, or none, every layout is such a strut but for a rest that fades.
    """
    if problem.index != "J5" or not problem.network.has_inerter or problem.network.may_vanish:
        return None
    if any(name in ("damping", "inertance") for own in problem.fixed for name, _ in own):
        return None
    plain = replace(problem, layout="S1", pair=None, massless=(False, False), fixed=((), ()))
    value, point = best_point(plain)
    if not at_bound(plain, value):
        return None
    struts = plain.struts(softest_at_bound([plain], plain, point)[1])
    limit = problem.static_compliance() * (1.0 + NEAR)
    start = _like(problem, struts)
    found = softest(problem, start, limit)
    if found is not None:
        return float(problem.value(found[1][None])[0]), found[1]
    # a series pair can keep it a little off
    value, point = polish_peaks(problem, start, np.inf)
    return (value, point) if value <= problem.static_compliance() * (1.0 + _CLOSE) else None


def start_point(problem: VehicleProblem, more: int = 1) -> tuple[float, Array]:
    """Value and point of the best design, in the limit or found by search."""
    limit = in_the_limit(problem)
    if limit is not None and limit[0] <= problem.static_compliance() * (1.0 + _CLOSE):
        return limit
    found = best_point(problem, more)
    return found if limit is None or found[0] < limit[0] else limit


def _like(problem: VehicleProblem, struts: tuple[VehicleStrut, VehicleStrut]) -> Array:
    """The design that is most like one of springs and dampers alone."""
    # S4 is without inerter where it is small, the others where it is rigid
    ends = {
        "inertance": 0 if problem.network.own == "S4" else 1,
        "relaxation_stiffness": 0 if problem.network.own == "S6" else 1,
        "centring_share": 0,
        "centring_ratio": 0,
    }
    return np.array(
        [
            np.log(struts[axle].damping) if name == "damping" else problem.bounds[n, ends[name]]
            for n, (axle, name) in enumerate(problem.variables)
        ]
    )
