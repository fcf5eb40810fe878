"""Every optimum of a study, on several processes or on a cluster."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from threadpoolctl import threadpool_limits

from inerter.parallel import Progress, run_all
from inerter.suspension.optimum import Optimum, optimise
from inerter.suspension.problem import Problem
from inerter.suspension.study import Case, Study

# below this, starting processes takes longer than the work
_WORTH_PROCESSES = 40


@dataclass(frozen=True)
class Row:
    """One optimum and what it was asked for."""

    case: Case
    optimum: Optimum

    def json(self) -> dict[str, Any]:
        """The row of the command's JSON."""
        row = {
            "layout": self.case.layout,
            "index": self.case.index,
            "stiffness": self.case.stiffness,
            "series": self.case.series,
            "value": self.optimum.value,
            "damping": self.optimum.damping,
            "inertance": self.optimum.inertance,
        }
        if self.optimum.relaxation_stiffness is not None:
            row["relaxation_stiffness"] = self.optimum.relaxation_stiffness
        return row


def sweep(
    study: Study,
    *,
    jobs: int | None = None,
    scheduler: str | None = None,
    progress: Progress = lambda share: None,
) -> list[Row]:
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

    Raises
    ------
    WorkError
        The scheduler cannot be reached, or its workers end.
    """
    cases = list(study.cases())
    problems = list(dict.fromkeys(case.problem for case in cases))
    if jobs is None and len(problems) < _WORTH_PROCESSES:
        jobs = 1
    optima = run_all(_optimum, problems, jobs=jobs, scheduler=scheduler, progress=progress)
    found = dict(zip(problems, optima, strict=True))
    return [Row(case, found[case.problem]) for case in cases]


def _optimum(problem: Problem) -> Optimum:
    # threads would fight over matrices of seven rows, and change the last digits
    with threadpool_limits(1):
        return optimise(problem)
