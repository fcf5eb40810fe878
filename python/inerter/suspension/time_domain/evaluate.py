"""Indices of nonlinear cases with confidence intervals, c and b kept or sought anew.

J1 and J3 are means over roads of random phases, with the 95 % interval of Student's t. J5 has no
road in it and no interval. What a case costs against the ideal inerter is compared road by road,
which takes most of the chance out; its interval is that of the differences.

c and b are those of the linear optimum with the case's own inerter, ideal or elastic, without
friction and play, or sought anew (`Plan.reoptimise`, see `search.py`), or given. The ideal case is
compared at its own optimum in every case.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from inerter.parallel import run_all
from inerter.suspension.time_domain.cases import CASES, numbers_of
from inerter.suspension.time_domain.evaluation import Evaluation
from inerter.suspension.time_domain.linear import exact_index, spectrum
from inerter.suspension.time_domain.piece import Found, Piece, work
from inerter.suspension.time_domain.plan import Plan
from inerter.suspension.time_domain.samples import interval

Progress = Callable[[float, str], None]


def evaluate(
    plan: Plan, progress: Progress | None = None, *, scheduler: str | None = None
) -> list[Evaluation]:
    """Every row of a plan, in its order, the same wherever it is worked on.

    Parameters
    ----------
    plan
        What is asked for.
    progress
        Called with the share that is done, and a text.
    scheduler
        Address of a Dask scheduler, see `inerter.parallel.run_all`; without, the rows run one
        after the other on the threads of the settings.

    Raises
    ------
    ValueError
        A design that cannot be simulated with the step of the settings.
    WorkError
        The scheduler cannot be reached, or its workers end.
    """
    tell = progress or (lambda share, text: None)
    if scheduler is not None and plan.settings.jobs == 0:
        # a worker of the cluster has as many pieces at once as it has threads
        plan = replace(plan, settings=replace(plan.settings, jobs=1))
    rows = [
        Piece(plan=plan, stiffness=stiffness, index=index, layout=layout, case=case)
        for stiffness, index, layout, case in plan.rows
    ]
    ideals = [
        Piece(
            plan=plan,
            stiffness=p.stiffness,
            index=p.index,
            layout=p.layout,
            case=CASES["ideal"],
            own=True,
        )
        for p in rows
    ]
    # what several rows need is done once
    pieces = {piece.key: piece for piece in [*ideals, *rows]}

    def done(share: float) -> None:
        tell(share, f"{round(share * len(pieces))} of {len(pieces)} evaluations")

    done(0.0)
    found = run_all(work, list(pieces.values()), jobs=1, scheduler=scheduler, progress=done)
    results = dict(zip(pieces, found, strict=True))
    return [
        _row(piece, results[piece.key], results[ideal.key])
        for piece, ideal in zip(rows, ideals, strict=True)
    ]


def _row(piece: Piece, found: Found, ideal: Found) -> Evaluation:
    plan, case, index = piece.plan, piece.case, piece.index
    design, values = found.design, found.samples.values
    value, low, high = interval(values)
    change, change_low, change_high = interval(values / ideal.samples.values - 1.0)
    exact = None
    if case.linear and (index == "J5" or plan.road.name == "paper"):
        road = spectrum(plan.road)
        exact = exact_index(index, piece.layout, design, case.pair, plan.car, road)
    rear = design.rear
    return Evaluation(
        car=plan.car_name,
        layout=piece.layout,
        case=case.name,
        index=index,
        road=None if index == "J5" else plan.road.name,
        stiffness=piece.stiffness,
        damping=design.damping,
        inertance=design.inertance,
        rear_stiffness=None if rear is None else rear.stiffness,
        rear_damping=None if rear is None else rear.damping,
        rear_inertance=None if rear is None else rear.inertance,
        numbers=numbers_of(piece.layout, case.name) if plan.car_name == "quarter" else "",
        value=value,
        low=low,
        high=high,
        exact=exact,
        change=change,
        change_low=change_low,
        change_high=change_high,
        roads=0 if index == "J5" else plan.seeds,
        reoptimised=found.reoptimised or (plan.reoptimise and case.linear),
        peaks=found.samples.peaks,
    )
