"""One piece of work of a plan: a design of a case, chosen and simulated.

A piece knows everything that it needs and gives the same digits wherever it is worked on.
"""

from __future__ import annotations

from dataclasses import dataclass

from inerter.suspension.time_domain.cases import Case
from inerter.suspension.time_domain.design import Design
from inerter.suspension.time_domain.linear import linear_optimum, spectrum, stiffnesses_of
from inerter.suspension.time_domain.model import compiled
from inerter.suspension.time_domain.plan import Plan
from inerter.suspension.time_domain.samples import Samples, samples
from inerter.suspension.time_domain.search import reoptimised


@dataclass(frozen=True, kw_only=True)
class Piece:
    """`case` of a layout; `own`: at its own linear optimum, whatever the plan says of designs."""

    plan: Plan
    stiffness: float
    index: str
    layout: str
    case: Case
    own: bool = False

    @property
    def key(self) -> tuple[float, str, str, str, bool]:
        """What tells it from the other pieces of the plan."""
        chosen = self.plan.given or (self.plan.reoptimise and not self.case.linear)
        return self.stiffness, self.index, self.layout, self.case.name, self.own or not chosen


@dataclass(frozen=True)
class Found:
    """The design of a piece, and what it did."""

    design: Design
    samples: Samples
    reoptimised: bool


def work(piece: Piece) -> Found:
    """Choose the design and simulate it on every road.

    Raises
    ------
    ValueError
        A design that cannot be simulated with the step of the settings.
    """
    plan, index, layout, case = piece.plan, piece.index, piece.layout, piece.case
    model = compiled(layout, case, plan.car)
    searched = plan.reoptimise and not case.linear and not piece.own
    if plan.given and not piece.own:
        design = _given(plan, layout, piece.stiffness)
    else:
        design = linear_optimum(
            index, layout, piece.stiffness, case.pair, plan.car, spectrum(plan.road)
        )
    if searched:
        design = reoptimised(plan, model, index, design)
    return Found(design, samples(plan, model, index, design, plan.seeds), searched)


def _given(plan: Plan, layout: str, stiffness: float) -> Design:
    """The design that the plan states, without inertance in S1."""
    springs = stiffnesses_of(plan.car, stiffness)
    pairs = plan.given * (len(springs) if len(plan.given) == 1 else 1)
    struts = [
        Design(k, c, 0.0 if layout == "S1" else b) for k, (c, b) in zip(springs, pairs, strict=True)
    ]
    rear = struts[1] if len(struts) == 2 else None
    return Design(struts[0].stiffness, struts[0].damping, struts[0].inertance, rear=rear)
