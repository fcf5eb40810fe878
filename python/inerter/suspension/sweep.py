"""Every optimum of a study, on several processes or on a cluster."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from threadpoolctl import threadpool_limits

from inerter.parallel import Progress, run_all
from inerter.suspension.limited import LimitError
from inerter.suspension.optimum import Optimum, optimise
from inerter.suspension.problem import SuspensionProblem
from inerter.suspension.study import Case, Study
from inerter.suspension.vehicle.optimum import VehicleOptimum, optimise_vehicle
from inerter.suspension.vehicle.problem import VehicleProblem

# below this, starting processes takes longer than the work; vehicles take about ten times as long
_WORTH_PROCESSES = 40
_WORTH_PROCESSES_VEHICLE = 4


@dataclass(frozen=True)
class SweepRow:
    """One optimum and what it was asked for."""

    case: Case
    optimum: Optimum | VehicleOptimum

    def json(self) -> dict[str, Any]:
        """The row of the command's JSON."""
        return {**_asked(self.case), "value": self.optimum.value, **self.optimum.design()}


@dataclass(frozen=True)
class Missed:
    """What was asked for within limits that no design keeps, and the sentence on it."""

    case: Case
    told: str

    def json(self) -> dict[str, Any]:
        """The row of the command's JSON: it has no value."""
        return {**_asked(self.case), "value": None, "told": self.told}


def _asked(case: Case) -> dict[str, Any]:
    """What a row of the JSON says of what was asked for."""
    problem = case.problem
    car = {"car": problem.car.name} if isinstance(problem, VehicleProblem) else {}
    return {
        **car,
        "layout": case.layout,
        "index": case.index,
        "stiffness": case.stiffness,
        "series": case.series,
    }


def sweep(
    study: Study,
    *,
    jobs: int | None = None,
    scheduler: str | None = None,
    progress: Progress = lambda share: None,
    missed: list[Missed] | None = None,
) -> list[SweepRow]:
    """Every optimum of a study, in the order of its cases, the same wherever it is sought.

    Parameters
    ----------
    study
        What is asked for.
    jobs
        Processes; if not given as many as processors, or this one alone for a few optima.
    scheduler
        Address of a Dask scheduler, see `inerter.parallel.run_all`.
    progress
        Called with the share that is done, 0 to 1.
    missed
        Gets the cases whose limits no design keeps, beside others whose limits one keeps.

    Raises
    ------
    LimitError
        No design of any case keeps the limits, or of one without `missed`.
    WorkError
        The scheduler cannot be reached, or its workers end.
    """
    cases = list(study.cases())
    problems = list(dict.fromkeys(case.problem for case in cases))
    vehicles = any(isinstance(problem, VehicleProblem) for problem in problems)
    if jobs is None and len(problems) < (
        _WORTH_PROCESSES_VEHICLE if vehicles else _WORTH_PROCESSES
    ):
        jobs = 1
    optima = run_all(_optimum, problems, jobs=jobs, scheduler=scheduler, progress=progress)
    found = dict(zip(problems, optima, strict=True))
    rows, without = [], []
    for case in cases:
        one = found[case.problem]
        if isinstance(one, LimitError):
            without.append(Missed(case, str(one)))
        else:
            rows.append(SweepRow(case, one))
    if without and (missed is None or not rows):
        raise LimitError("; ".join(dict.fromkeys(each.told for each in without)))
    if missed is not None:
        missed += without
    return rows


def _optimum(
    problem: SuspensionProblem | VehicleProblem,
) -> Optimum | VehicleOptimum | LimitError:
    # threads would fight over matrices of seven rows, and change the last digits
    with threadpool_limits(1):
        try:
            if isinstance(problem, VehicleProblem):
                return optimise_vehicle(problem)
            return optimise(problem)
        except LimitError as error:
            # others may keep the limits
            return error
