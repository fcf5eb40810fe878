"""Outcomes of diagnoses that nobody made, and functions that solve cases badly."""

from __future__ import annotations

import os

from inerter.blind_test.case import Named, Outcome, ParameterError
from inerter.blind_test.plan import Task


def outcome(
    group: str,
    hidden: tuple[str, ...] = (),
    named: tuple[tuple[str, float], ...] = (),
    *,
    seed: int = 0,
    laws: tuple[str | None, str | None] = (None, None),
    kind: str | None = None,
    errors: tuple[ParameterError, ...] = (),
    unexplained: bool = False,
    gain: float | None = None,
    seconds: float = 1.0,
    error: str | None = None,
) -> Outcome:
    """An outcome; `named` are effects and confidences, `laws` the true one and the first's."""
    findings = tuple(
        Named(effect, laws[1] if i == 0 else None, confidence)
        for i, (effect, confidence) in enumerate(named)
    )
    return Outcome(
        task=Task(group=group, seed=seed, noise=0.01, effects=hidden, law=laws[0], kind=kind),
        law=laws[0],
        named=findings,
        parameters=errors,
        unexplained=unexplained,
        gain=gain,
        verdict="a verdict",
        seconds=seconds,
        processor_seconds=0.5 * seconds,
        share=0.2,
        error=error,
    )


def solve_or_die(task: Task) -> Outcome:
    """End the whole process at seed 2, as a crash in a library would."""
    if task.seed == 2:
        os._exit(9)
    return Outcome(task=task, verdict=str(task.seed))
