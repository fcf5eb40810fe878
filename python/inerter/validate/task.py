"""One task: a case in every engine and integrator that is wanted, against one truth."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout
from dataclasses import asdict, dataclass, field
from io import StringIO
from typing import Any

import numpy as np

from inerter.validate import bounds, exudyn_engine, mujoco_engine
from inerter.validate.case import Case
from inerter.validate.run import QUANTITIES, RunError, ValidationRun, errors
from inerter.validate.truth import truth


@dataclass(frozen=True)
class Wanted:
    """An engine and integrator; `model` is what the row calls the model (a file of it)."""

    engine: str
    integrator: str
    model: str


@dataclass(frozen=True)
class Task:
    """A case and what is to be run of it."""

    case: Case
    wanted: tuple[Wanted, ...]


@dataclass(kw_only=True)
class ValidationRow:
    """A line of the result; see `validation.json` in docs/accuracy.md."""

    model: str
    layout: str
    law: str
    kind: str
    input: str
    duration: float
    engine: str
    integrator: str
    step: float
    errors: dict[str, float | None]
    order: float | None
    bound: dict[str, float | None]
    within: bool
    note: str | None = None
    headline: bool = field(default=False)

    def json(self) -> dict[str, Any]:
        """For JSON: plain numbers and names."""
        return asdict(self)


def run_task(task: Task) -> list[ValidationRow]:
    """Run a task; an engine that fails makes a row with a note and without errors."""
    case = task.case
    with _quiet():
        runs = {wanted: _runs(case, wanted) for wanted in task.wanted}
    try:
        true = _Truth(case, runs)
    except RuntimeError as error:
        return [_failed(case, wanted, f"the reference: {error}") for wanted in task.wanted]
    fine = case.step / 2.0
    own = bounds.sensitivity(case, fine, true.at(case.times))
    return [_row(case, wanted, found, true, own) for wanted, found in runs.items()]


@contextmanager
def _quiet() -> Iterator[None]:
    """Exudyn prints to stdout, which may belong to JSON."""
    with redirect_stdout(StringIO()):
        yield


def _runs(case: Case, wanted: Wanted) -> list[ValidationRun] | str:
    """Runs at the step and at half of it (the long runs: only that), or what went wrong."""
    steps = [case.step / 2.0] if case.headline else [case.step, case.step / 2.0]
    try:
        if wanted.engine == "exudyn":
            return [exudyn_engine.run_exudyn(case, wanted.integrator, h) for h in steps]
        file = case.setup.files[wanted.model]
        return [mujoco_engine.run_mujoco(case, file, wanted.integrator, h) for h in steps]
    except RunError as error:
        return str(error)


class _Truth:
    """The reference at every time that a run of a task has samples at."""

    def __init__(self, case: Case, runs: dict[Wanted, list[ValidationRun] | str]) -> None:
        found = [case.times]
        for several in runs.values():
            found += [] if isinstance(several, str) else [run.time for run in several]
        self._times = np.unique(np.concatenate(found))
        self._run = truth(case, self._times)

    def at(self, times: np.ndarray) -> ValidationRun:
        """The reference at some of these times."""
        return self._run.at(np.searchsorted(self._times, times))


def _row(
    case: Case,
    wanted: Wanted,
    found: list[ValidationRun] | str,
    true: _Truth,
    own: dict[str, float],
) -> ValidationRow:
    if isinstance(found, str):
        return _failed(case, wanted, found)
    nominal, note = _nominal(case, wanted)
    figures = [errors(run, true.at(run.time)) for run in found]
    # what geometry and the truth itself cannot tell apart
    floor = 3e-9 if case.setup.scale == 1.0 else 2e-7
    order: float | None = None
    change: bounds.Figures = dict.fromkeys(QUANTITIES)
    if len(found) == 2 and nominal is not None:
        coarse, fine = (figure["displacement"] for figure in figures)
        order = bounds.observed_order(coarse, fine, floor)
        change = errors(*found)
    late = case.step / 2.0 if note == exudyn_engine.LATE else 0.0
    limits = bounds.bound(case, nominal, own, change, true.at(case.times), late)
    return ValidationRow(
        **_names(case, wanted),
        errors=figures[-1],
        order=order,
        bound=limits,
        within=bounds.is_within(case, figures[-1], limits, (order, nominal)),
        note=note,
    )


def _nominal(case: Case, wanted: Wanted) -> tuple[float | None, str | None]:
    """The order that is expected, None for adaptive steps, and a remark on it."""
    if wanted.engine == "mujoco":
        return mujoco_engine.ORDERS[wanted.integrator], None
    if exudyn_engine.is_late(case, wanted.integrator):
        return 1.0, exudyn_engine.LATE
    return exudyn_engine.ORDERS[wanted.integrator], None


def _failed(case: Case, wanted: Wanted, why: str) -> ValidationRow:
    nothing: dict[str, float | None] = dict.fromkeys(QUANTITIES)
    return ValidationRow(
        **_names(case, wanted), errors=nothing, order=None, bound={}, within=False, note=why
    )


def _names(case: Case, wanted: Wanted) -> dict[str, Any]:
    return {
        "model": wanted.model,
        "layout": case.setup.layout,
        "law": case.law,
        "kind": case.kind,
        "input": case.input,
        "duration": case.duration,
        "engine": wanted.engine,
        "integrator": wanted.integrator,
        "step": case.step / 2.0,
        "headline": case.headline,
    }
