"""Indices of nonlinear cases with confidence intervals, c and b kept or sought anew.

J1 and J3 are means over roads of random phases, with the 95 % interval of Student's t, widened by
what the sinusoids of a finite road miss of its density (`resolution.py`). J5 has no road in it and
no interval. What a case costs against the ideal inerter is compared road by road,
which takes most of the chance out; its interval is that of the differences.

c and b are those of the linear optimum with the case's own inerter, ideal or elastic, without
friction and play, or sought anew (`Plan.reoptimise`, see `search.py`), or given. The ideal case is
compared at its own optimum in every case.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from inerter.parallel import run_all
from inerter.suspension.quarter_car import QuarterCar
from inerter.suspension.time_domain.cases import CASES, numbers_of
from inerter.suspension.time_domain.design import Design
from inerter.suspension.time_domain.evaluation import Evaluation
from inerter.suspension.time_domain.linear import damped_tyres, exact_index, spectrum
from inerter.suspension.time_domain.piece import NOTED, Found, Piece, linear_design, work
from inerter.suspension.time_domain.plan import Plan
from inerter.suspension.time_domain.resolution import (
    LONGEST,
    exact_on_road,
    on_sinusoids,
    resolution_of,
)
from inerter.suspension.time_domain.samples import interval
from inerter.suspension.time_domain.varied import Varied, varied_pieces

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
    asked = rows
    rows, ideals = zip(*_resolved(rows, ideals), strict=True)
    # what several rows need is done once
    pieces = {piece.key: piece for piece in [*ideals, *rows]}

    def done(share: float) -> None:
        tell(share, f"{round(share * len(pieces))} of {len(pieces)} evaluations")

    done(0.0)
    found = run_all(work, list(pieces.values()), jobs=1, scheduler=scheduler, progress=done)
    results = dict(zip(pieces, found, strict=True))
    answer = [
        _row(piece, results[piece.key], results[ideal.key])
        for piece, ideal in zip(rows, ideals, strict=True)
    ]
    if not plan.vary:
        return answer
    designs = {piece.key: results[piece.key].design for piece in rows}
    return _varied(answer, asked, designs, tell, scheduler)


def _varied(
    rows: list[Evaluation],
    pieces: list[Piece],
    designs: Mapping[Any, Design],
    tell: Progress,
    scheduler: str | None,
) -> list[Evaluation]:
    """The rows with what their designs do under each variation."""
    each = [varied_pieces(piece, designs[piece.key]) for piece in pieces]
    work_on = []
    for name, piece in (one for some in each for one in some):
        plan, notes = _plan_of([piece])
        work_on.append((name, replace(piece, plan=plan, notes=notes)))

    def done(share: float) -> None:
        tell(share, f"{round(share * len(work_on))} of {len(work_on)} variations")

    found = run_all(
        work, [piece for _, piece in work_on], jobs=1, scheduler=scheduler, progress=done
    )
    told = iter(zip(work_on, found, strict=True))
    answer = []
    for row, some in zip(rows, each, strict=True):
        varied, notes = [], list(row.notes)
        for (name, piece), one in (next(told) for _ in some):
            value, low, high, linear, missed = _measured(piece, one)
            exact = linear if math.isfinite(linear) else None
            varied.append(Varied(name, value, low, high, exact))
            said = (*piece.notes, *_lift_off(piece, one, missed))
            notes += [f"{name}: {note}" for note in said] if name != "as planned" else []
        answer.append(replace(row, variations=tuple(varied), notes=tuple(notes)))
    return answer


def _resolved(rows: list[Piece], ideals: list[Piece]) -> list[tuple[Piece, Piece]]:
    """Both on the road, and settling for as long, as the slowest of all that are compared needs.

    Rows of one layout, index and stiffness share their roads: losses are taken road by road.
    """
    groups: dict[tuple[float, str, str], list[Piece]] = {}
    for piece in [*rows, *ideals]:
        groups.setdefault((piece.stiffness, piece.index, piece.layout), []).append(piece)
    plans = {key: _plan_of(pieces) for key, pieces in groups.items()}
    answer = []
    for row, ideal in zip(rows, ideals, strict=True):
        plan, notes = plans[row.stiffness, row.index, row.layout]
        row, ideal = (replace(piece, plan=plan, notes=notes) for piece in (row, ideal))
        answer.append((row, ideal))
    return answer


def _plan_of(pieces: list[Piece]) -> tuple[Plan, tuple[str, ...]]:
    """The plan with a road and a settling time for all of them, and what there is to say of it."""
    plan = pieces[0].plan
    found = {
        resolution_of(p.index, p.layout, linear_design(p), p.case.pair, plan.car, plan.road)
        for p in pieces
    }
    settle = max(each.settle for each in found)
    notes = []
    if not all(each.enough for each in found):
        notes.append(
            f"{pieces[0].index} of {pieces[0].layout}: the slowest mode rings for more than "
            f"{LONGEST:g} s, the longest road and settling here"
        )
    if plan.keep_settle and plan.settings.settle < settle:
        notes.append(
            f"--settle {plan.settings.settle:g}: the slowest mode needs {settle:.3g} s; "
            "what is left of the start is in the means"
        )
    settings = plan.settings
    if not plan.keep_settle and settings.settle < settle:
        settings = replace(settings, settle=settle)
    road = plan.road.refined(max(each.refined for each in found))
    return replace(plan, road=road, settings=settings), tuple(notes)


def _lift_off(piece: Piece, found: Found, missed: float) -> list[str]:
    """What is to be said of a tyre that leaves the road."""
    off = 100.0 * found.samples.beside.get("lift_off", 0.0)
    row = f"{piece.layout} {piece.case.name}, {piece.index}"
    if found.pulling is None and off > 100.0 * NOTED:
        return [
            f"{row}: for {off:.2g} % of the time a tyre pulls on the road by more than its static "
            "load; --tyre one-sided has it leave the road"
        ]
    if found.pulling is None:
        return []
    value, low, high = interval(found.pulling.values)
    half = 0.5 * (high - low) + abs(missed) * value
    return [
        f"{row}: a tyre is off the road {off:.2g} % of the time; with tyres that pull, as in "
        f"exact, it would be {value:.5g} ± {half:.1g}"
    ]


def _measured(piece: Piece, found: Found) -> tuple[float, float, float, float, float]:
    """Value, its interval, linear value, and what the sinusoids miss of it, relative."""
    plan, case, index = piece.plan, piece.case, piece.index
    value, low, high = interval(found.samples.values)
    asked = (index, piece.layout, found.design, case.pair, plan.car)
    if index == "J5" or (plan.road.name == "paper" and not damped_tyres(plan.car)):
        linear = exact_index(*asked, spectrum(plan.road))
    else:
        linear = exact_on_road(*asked, plan.road)
    missed = 0.0
    if index != "J5":
        # what the sinusoids miss of the density they stand for
        missed = on_sinusoids(*asked, plan.road) / exact_on_road(*asked, plan.road) - 1.0
        low, high = low - abs(missed) * value, high + abs(missed) * value
    return value, low, high, linear, missed


def _row(piece: Piece, found: Found, ideal: Found) -> Evaluation:
    plan, case, index, design = piece.plan, piece.case, piece.index, found.design
    value, low, high, linear, missed = _measured(piece, found)
    ratio = found.samples.values / ideal.samples.values
    change, change_low, change_high = interval(ratio - 1.0)
    exact = linear if case.linear else None
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
        springs=design.springs,
        rear_springs={} if rear is None else rear.springs,
        numbers=numbers_of(piece.layout, case.name) if plan.car == QuarterCar() else "",
        value=value,
        low=low,
        high=high,
        exact=exact,
        linear=linear if math.isfinite(linear) else None,
        change=change,
        change_low=change_low,
        change_high=change_high,
        roads=0 if index == "J5" else plan.seeds,
        reoptimised=found.reoptimised or (plan.reoptimise and case.linear),
        road_period=None if index == "J5" else plan.road.period,
        settle=plan.settings.settle,
        peaks=found.samples.peaks,
        pulling=None if found.pulling is None else float(np.mean(found.pulling.values)),
        notes=(*piece.notes, *_lift_off(piece, found, missed)),
        variations=(),
        **found.samples.beside,
    )
