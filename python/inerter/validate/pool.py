"""All tasks on several processes, each with its own engines."""

from __future__ import annotations

import time

from inerter.exudyn.engine import installed
from inerter.parallel import Progress, run_all
from inerter.validate.plan import Selection, plan
from inerter.validate.result import Validation
from inerter.validate.task import run_task


def validate(
    selection: Selection | None = None,
    *,
    jobs: int | None = None,
    progress: Progress = lambda share: None,
) -> Validation:
    """Run every case that is selected.

    Parameters
    ----------
    selection
        What to run; everything if not given.
    jobs
        Processes; as many as processors if not given, 1 stays in this one.
    progress
        Called with the share that is done, 0 to 1.

    Raises
    ------
    SelectionError
        The selection leaves nothing to run.
    """
    chosen = selection or Selection()
    began = time.perf_counter()
    tasks = plan(chosen, installed())
    rows = run_all(run_task, tasks, jobs=jobs, progress=progress)
    return Validation(chosen, [row for found in rows for row in found], time.perf_counter() - began)
