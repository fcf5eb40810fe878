"""All cases of a blind test in parallel; a process that dies takes no other case with it."""

from __future__ import annotations

import multiprocessing
import pickle
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

from inerter.blind_test.case import Outcome, solve
from inerter.blind_test.plan import Task
from inerter.parallel import WorkError, run_all

Solve = Callable[[Task], Outcome]
Piece = tuple[Solve, Task, Path]


def run_tasks(
    tasks: Sequence[Task],
    workers: int | None = None,
    progress: Callable[[float], None] = lambda share: None,
    work: Solve = solve,
) -> list[Outcome]:
    """Every case's outcome, in the order of the tasks.

    Parameters
    ----------
    tasks
        The cases.
    workers
        Processes: as many as processors if not given; 1 stays in this one, where a crash of the
        interpreter ends everything.
    progress
        Called with the share that is done, 0 to 1.
    work
        What solves a case: a function at the top of a module.

    Raises
    ------
    WorkError
        Processes end before they take up a case.
    """
    with tempfile.TemporaryDirectory(prefix="blind-test-") as scratch:
        folder = Path(scratch)
        pieces = [(work, task, folder / str(number)) for number, task in enumerate(tasks)]
        left = pieces
        while left:
            done = len(pieces) - len(left)

            def report(share: float, done: int = done, left: int = len(left)) -> None:
                progress((done + share * left) / len(pieces))

            try:
                run_all(_solve_piece, left, jobs=workers, progress=report)
            except WorkError:
                # a process died: what it may have been at is tried again, each in its own
                suspects = _under_way(left)
                if not suspects:
                    raise
                for piece in suspects:
                    _solve_alone(piece)
            left = [piece for piece in pieces if not _result(piece).exists()]
        return [pickle.loads(_result(piece).read_bytes()) for piece in pieces]


def _result(piece: Piece) -> Path:
    return piece[2].with_suffix(".done")


def _under_way(pieces: Sequence[Piece]) -> list[Piece]:
    return [piece for piece in pieces if piece[2].exists() and not _result(piece).exists()]


def _solve_piece(piece: Piece) -> None:
    """Solve a case and leave its outcome in the scratch folder."""
    work, task, mark = piece
    mark.touch()
    _keep(piece, work(task))


def _solve_alone(piece: Piece) -> None:
    process = multiprocessing.get_context("spawn").Process(target=_solve_piece, args=(piece,))
    process.start()
    process.join()
    if not _result(piece).exists():
        text = f"the process ended without a result (exit status {process.exitcode})"
        _keep(piece, Outcome(piece[1], piece[1].law, error=text))


def _keep(piece: Piece, outcome: Outcome) -> None:
    partial = piece[2].with_suffix(".partial")
    partial.write_bytes(pickle.dumps(outcome))
    partial.replace(_result(piece))
