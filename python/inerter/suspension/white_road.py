"""Indices that a tyre's damper makes infinite on a road whose velocity is white noise.

Such a road moves at any speed within no time, so that the damper's force has no finite rms: the
tyre force never has one, the body's acceleration none where an inerter couples body and wheel
rigidly (S2). Which indices these are is told by relative degree, not by a list. What is filtered by
a strictly proper W(s), J1w for one, stays finite where the signal itself is not.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from inerter.suspension.indices import INDICES

if TYPE_CHECKING:
    from inerter.suspension.problem import SuspensionProblem
    from inerter.suspension.vehicle.problem import VehicleProblem


class InfiniteIndexError(ValueError):
    """An index that no design makes finite; one line."""


def refuse_infinite(problem: SuspensionProblem | VehicleProblem) -> None:
    """Refuse a problem whose index, or one of its limits, is infinite for tyre damping.

    Raises
    ------
    InfiniteIndexError
        Names the index, the layout, why, and what to do.
    """
    for name in (problem.index, *dict(problem.limits)):
        if not problem.infinite(name):
            continue
        own = INDICES[name]
        where = "the network" if hasattr(problem, "netlist") else f"layout {problem.layout}"
        signals = {INDICES[part].signal or part for part in own.parts or (name,)}
        what = "the tyre force" if "J3" in signals else "through its inerter the body"
        finite = [
            each for each in ("J1", "J1w", "travel") if each != name and not problem.infinite(each)
        ]
        raise InfiniteIndexError(
            f"index {name} of {where} is infinite: with tyre_damping {what} "
            "follows the road's velocity at once, which is white noise here; take "
            f"{', '.join(finite)}, leave tyre_damping out, or see `evaluate --layout own --road "
            "iso:C`, whose roads end at a shortest wave"
        )
