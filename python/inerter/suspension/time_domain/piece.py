"""One piece of work of a plan: a design of a case, chosen and simulated.

A piece knows everything that it needs and gives the same digits wherever it is worked on.
"""

from __future__ import annotations

from dataclasses import dataclass

from inerter.suspension.layouts import LAYOUTS, Layout
from inerter.suspension.time_domain.cases import Case
from inerter.suspension.time_domain.design import Design, both
from inerter.suspension.time_domain.linear import linear_optimum, spectrum, stiffnesses_of
from inerter.suspension.time_domain.model import compiled
from inerter.suspension.time_domain.plan import Plan
from inerter.suspension.time_domain.samples import Samples, samples
from inerter.suspension.time_domain.search import reoptimised

NOTED = 1e-3
"""Share of time off the road above which a reader is told."""


@dataclass(frozen=True, kw_only=True)
class Piece:
    """`case` of a layout; `own`: at its own linear optimum, whatever the plan says of designs.

    `notes` on the road and the settling of its plan. `design`: the one to take, whatever else.
    """

    plan: Plan
    stiffness: float
    index: str
    layout: str
    case: Case
    own: bool = False
    notes: tuple[str, ...] = ()
    design: Design | None = None

    @property
    def key(self) -> tuple[float, str, str, str, bool]:
        """What tells it from the other pieces of the plan."""
        chosen = self.plan.given or (self.plan.reoptimise and not self.case.linear)
        return self.stiffness, self.index, self.layout, self.case.name, self.own or not chosen


@dataclass(frozen=True)
class Found:
    """The design of a piece, and what it did; `pulling`: with tyres that pull on the road.

    The latter where a tyre was off the road for more than `NOTED` of the time.
    """

    design: Design
    samples: Samples
    reoptimised: bool
    pulling: Samples | None = None


def work(piece: Piece) -> Found:
    """Choose the design and simulate it on every road.

    Raises
    ------
    ValueError
        A design that cannot be simulated with the step of the settings.
    """
    plan, index, layout, case = piece.plan, piece.index, piece.layout, piece.case
    searched = plan.reoptimise and not case.linear and not piece.own and piece.design is None
    design = linear_design(piece)
    step = plan.settings.step
    leaves = plan.leaves and index != "J5"
    model = compiled(layout, case, plan.car, one_sided=leaves, design=design, step=step)
    if searched:
        design = reoptimised(plan, model, index, design)
    found = samples(plan, model, index, design, plan.seeds)
    pulling = None
    if plan.leaves and found.beside.get("lift_off", 0.0) > NOTED:
        never = compiled(layout, case, plan.car, design=design, step=step)
        pulling = samples(plan, never, index, design, plan.seeds)
    return Found(design, found, searched, pulling)


def linear_design(piece: Piece) -> Design:
    """The design of a piece as far as the linear study chooses it.

    Raises
    ------
    ValueError
        A layout cannot have the inertance that is given.
    """
    if piece.design is not None:
        return piece.design
    plan = piece.plan
    given = () if piece.own else plan.given
    layout = LAYOUTS[piece.layout]
    known: list[dict[str, float | None]] = [
        dict(zip(("damping", "inertance"), pair, strict=True)) for pair in given
    ]
    if known and all(pair.get(name) is not None for pair in known for name in layout.variables):
        return _given(plan, layout, piece.stiffness)
    if layout.has_inerter and any(b == 0.0 for _, b in given):
        raise ValueError(f"{piece.layout}: inertance is 0; give one, or take a layout without")
    road, pair = spectrum(plan.road), piece.case.pair
    return linear_optimum(piece.index, piece.layout, piece.stiffness, pair, plan.car, road, given)


def _given(plan: Plan, layout: Layout, stiffness: float) -> Design:
    """The design that the plan states, without inertance where there is no inerter."""
    springs = stiffnesses_of(plan.car, stiffness)
    pairs = plan.given * (len(springs) if len(plan.given) == 1 else 1)
    return both(
        [
            Design(k, c or 0.0, (b or 0.0) if layout.has_inerter else 0.0)
            for k, (c, b) in zip(springs, pairs, strict=True)
        ]
    )
