"""All tasks on several processes, each with its own engines."""

from __future__ import annotations

import multiprocessing
import os
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from contextlib import contextmanager

from inerter.validate import exudyn_engine
from inerter.validate.plan import Selection, plan
from inerter.validate.result import Validation
from inerter.validate.task import Row, Task, run_task

Progress = Callable[[float], None]

# BLAS threads would fight for the processors over matrices of seven rows
_THREADS = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}


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
    began, there = time.perf_counter(), exudyn_engine.is_installed()
    tasks = plan(chosen, there)
    workers = min(jobs or os.cpu_count() or 1, len(tasks))
    rows: dict[int, list[Row]] = {}
    for done, (number, found) in enumerate(_results(tasks, workers), 1):
        rows[number] = found
        progress(done / len(tasks))
    ordered = [row for number in sorted(rows) for row in rows[number]]
    return Validation(chosen, ordered, time.perf_counter() - began)


def _results(tasks: list[Task], workers: int) -> Iterator[tuple[int, list[Row]]]:
    """Rows of each task by its number, as they come."""
    if workers == 1:
        for number, task in enumerate(tasks):
            yield number, run_task(task)
        return
    with _environment(_THREADS):
        # a fresh interpreter each: engines do not outlive a fork
        context = multiprocessing.get_context("spawn")
        with ProcessPoolExecutor(workers, mp_context=context) as pool:
            waiting = {pool.submit(run_task, task): number for number, task in enumerate(tasks)}
            try:
                for future in as_completed(waiting):
                    yield waiting[future], future.result()
            except BaseException:
                pool.shutdown(cancel_futures=True)
                raise


@contextmanager
def _environment(values: dict[str, str]) -> Iterator[None]:
    before = {name: os.environ.get(name) for name in values}
    os.environ.update(values)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value
