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
from inerter.suspension.time_domain.fine import (
    line_value,
    linear_value,
    parts_for,
    settling,
    slowest_decay,
)
from inerter.suspension.time_domain.linear import exact_index, spectrum
from inerter.suspension.time_domain.piece import Found, Piece, linear_design, work
from inerter.suspension.time_domain.plan import Plan
from inerter.suspension.time_domain.samples import interval

Progress = Callable[[float, str], None]


def evaluate(
    plan: Plan, progress: Progress | None = None, *, scheduler: str | None = None
) -> list[Evaluation]:
    """Every row of a plan, in its order, the same wherever it is worked on.

    The road's lines are as fine as the slowest mode of all designs needs; the settling time too,
    where the plan does not state one (`RunSettings.settle`).

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
    decay = min(_decay(piece) for piece in [*ideals, *rows])
    rows, ideals = ([_fine(piece, decay) for piece in some] for some in (rows, ideals))
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


def _decay(piece: Piece) -> float:
    return slowest_decay(piece.layout, linear_design(piece), piece.case.pair, piece.plan.car)


def _fine(piece: Piece, decay: float) -> Piece:
    """With the road and the settling time that a decay [1/s] asks for."""
    plan = piece.plan
    if all(index == "J5" for index in plan.indices):
        return piece
    settings = plan.settings
    if plan.auto_settle:
        settings = replace(settings, settle=max(settings.settle, settling(decay)))
    road = plan.road.finer(parts_for(plan.road, decay))
    return replace(piece, plan=replace(plan, road=road, settings=settings))


def _row(piece: Piece, found: Found, ideal: Found) -> Evaluation:
    plan, case, index = piece.plan, piece.case, piece.index
    design, values = found.design, found.samples.values
    value, low, high = interval(values)
    change, change_low, change_high = interval(values / ideal.samples.values - 1.0)
    linear = None
    if index != "J5":
        # the interval is of chance; what the road's own lines leave is added to it
        of = (index, piece.layout, design, case.pair, plan.car, plan.road)
        linear = linear_value(*of)
        error = value * abs(line_value(*of) / linear - 1.0)
        low, high = low - error, high + error
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
        linear=linear,
        period=None if index == "J5" else plan.road.period,
        settle=plan.settings.settle,
        lift_off=found.samples.lift_off,
        peak_tyre_force=found.samples.peak,
        peaks=found.samples.peaks,
    )
