"""All cases of a blind test in parallel; a process that dies takes no other case with it.

Each outcome is kept in a file of its own, with a fingerprint of the code that found it: a test that
was broken off goes on where it ended.
"""

from __future__ import annotations

import functools
import hashlib
import json
import multiprocessing
import os
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path

import inerter
from inerter.blind_test.case import Outcome, solve
from inerter.blind_test.plan import Task
from inerter.parallel import WorkError, deaf_children, run_all

Solve = Callable[[Task], Outcome]
Piece = tuple[Solve, Task, Path]


def run_tasks(
    tasks: Sequence[Task],
    workers: int | None = None,
    progress: Callable[[float], None] = lambda share: None,
    work: Solve = solve,
    folder: Path | None = None,
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
    folder
        Where the outcomes are kept, and taken from where the same code has found them before; by
        default nowhere.

    Raises
    ------
    WorkError
        Processes end before they take up a case.
    OSError
        The folder cannot be written.
    """
    if folder is None:
        with tempfile.TemporaryDirectory(prefix="blind-test-") as scratch:
            return run_tasks(tasks, workers, progress, work, Path(scratch))
    folder.mkdir(parents=True, exist_ok=True)
    pieces = [(work, task, folder / task.name) for task in tasks]
    left = [piece for piece in pieces if _found(piece) is None]
    for piece in left:
        piece[2].unlink(missing_ok=True)
        _result(piece).unlink(missing_ok=True)
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
        left = [piece for piece in left if _found(piece) is None]
    return [outcome for piece in pieces if (outcome := _found(piece))]


@functools.cache
def fingerprint() -> str:
    """Of this package's code: outcomes of another one say nothing about it."""
    root = Path(inerter.__file__).parent
    found = hashlib.sha256()
    for path in sorted([*root.rglob("*.py"), *root.rglob("*.so"), *root.rglob("*.dylib")]):
        found.update(path.relative_to(root).as_posix().encode() + path.read_bytes())
    return found.hexdigest()[:16]


def _result(piece: Piece) -> Path:
    return piece[2].with_name(piece[2].name + ".json")


def _found(piece: Piece) -> Outcome | None:
    """The outcome that is kept, if this code found it."""
    try:
        data = json.loads(_result(piece).read_text(encoding="utf-8"))
        if data.pop("code") != fingerprint():
            return None
        outcome = Outcome.of_json(data)
    except (FileNotFoundError, ValueError, KeyError, TypeError, AttributeError):
        return None
    return outcome if outcome.task == piece[1] else None


def _under_way(pieces: Sequence[Piece]) -> list[Piece]:
    return [piece for piece in pieces if piece[2].exists() and not _result(piece).exists()]


def _solve_piece(piece: Piece) -> None:
    """Solve a case and leave its outcome in the folder."""
    work, task, mark = piece
    mark.touch()
    _keep(piece, work(task))


def _solve_alone(piece: Piece) -> None:
    process = multiprocessing.get_context("spawn").Process(target=_solve_piece, args=(piece,))
    with deaf_children():
        process.start()
    try:
        process.join()
    finally:
        process.terminate()
    if _found(piece) is None:
        text = f"the process ended without a result (exit status {process.exitcode})"
        _keep(piece, Outcome(task=piece[1], law=piece[1].law, error=text))


def _keep(piece: Piece, outcome: Outcome) -> None:
    partial = piece[2].with_name(piece[2].name + ".partial")
    partial.write_text(json.dumps({"code": fingerprint(), **outcome.json()}), encoding="utf-8")
    os.replace(partial, _result(piece))
    piece[2].unlink(missing_ok=True)
