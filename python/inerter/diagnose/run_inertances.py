"""Runs of which each has an inertance of its own: another flywheel, a pin that engages, a scale.

One device has one inertance. Where what is left of a run goes with its acceleration, and otherwise
in each run, the runs are not of one device in one state; no effect explains that.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from inerter.identify.model import Model
from inerter.identify.runs import BenchRun
from inerter.measured_text import measured
from inerter.motion_units import TRANSLATION, Kind, words

Array = NDArray[np.float64]

# inertances differ from so many standard errors on, by this share, and where what goes with the
# acceleration is this share of what is missed beyond the noise, in power
SURE, LEAST, SHARE = 8.0, 0.02, 0.5
# stretches of a run that count as independent
STRETCHES = 12


def run_inertances(
    runs: Sequence[BenchRun], errors: Sequence[Array], noise: float, model: Model
) -> dict[str, tuple[float, float]]:
    """Inertance of each run by itself and its standard error, where they differ; else empty.

    errors: measured minus predicted force of every run (n,) [N]; noise: rms [N].
    """
    inertance = model.device().inertance
    driven = {"series_frequency", "series_stiffness"}.isdisjoint(model.values)
    if len(runs) < 2 or not (inertance > 0 and driven):
        return {}
    if any(run.part or run.inner.sum() < 10 * STRETCHES for run in runs):
        return {}
    rows = [_more(run, error) for run, error in zip(runs, errors, strict=True)]
    more, stderrs, taken = np.array(rows).T
    apart = float(np.max(more) - np.min(more))
    pair = float(np.hypot(stderrs[np.argmax(more)], stderrs[np.argmin(more)]))
    missed = sum(float(np.sum(e[run.inner] ** 2)) for run, e in zip(runs, errors, strict=True))
    missed -= noise**2 * sum(int(run.inner.sum()) for run in runs)
    if apart < max(SURE * pair, LEAST * inertance) or float(np.sum(taken)) < SHARE * missed:
        return {}
    return {
        run.name: (float(inertance + value), float(error))
        for run, value, error in zip(runs, more, stderrs, strict=True)
    }


def inertances_in_words(
    found: Mapping[str, tuple[float, float]], motion: Kind = TRANSLATION
) -> str:
    """A sentence about the runs' inertances; empty where they do not differ."""
    if not found:
        return ""
    each = ", ".join(
        f"{measured(value, error)} {words(motion, 'kg')} in {name}"
        for name, (value, error) in found.items()
    )
    return (
        f"By itself each run has an inertance of its own: {each}. These are not runs of one device "
        "in one state, or not of one calibration: diagnose those apart that differ."
    )


def _more(run: BenchRun, error: Array) -> tuple[float, float, float]:
    """Inertance beyond the model's [kg], its standard error, and what it takes away [N^2]."""
    inner = run.inner
    matrix = np.column_stack([
        run.acceleration[inner], run.velocity[inner], run.displacement[inner],
    ])  # fmt: skip
    matrix = matrix - matrix.mean(axis=0)
    rest = error[inner] - error[inner].mean()
    scale = np.sqrt(np.mean(matrix**2, axis=0))
    matrix = matrix / np.where(scale > 0, scale, 1.0)
    solved, *_ = np.linalg.lstsq(matrix, rest, rcond=1e-9)
    left = rest - matrix @ solved
    bread = np.linalg.pinv(matrix.T @ matrix, rcond=1e-12)
    parts = np.array_split(np.arange(rest.size), STRETCHES)
    scores = np.array([matrix[part].T @ left[part] for part in parts])
    covariance = bread @ scores.T @ scores @ bread
    without = rest - matrix[:, 1:] @ np.linalg.lstsq(matrix[:, 1:], rest, rcond=1e-9)[0]
    taken = float(np.sum(without**2) - np.sum(left**2))
    size = float(scale[0]) or 1.0
    return float(solved[0]) / size, float(np.sqrt(max(covariance[0, 0], 0.0))) / size, taken
