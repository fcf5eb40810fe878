"""Which run may be held out: one that does not take away what only it can tell.

Forces of the usual kinds (inertance, damping, friction, stiffness, what a delay, a shaft or a play
would add) are columns of a regression. The information of a run on a combination of them is the sum
of its squares, as noise is the same in all runs. A run's leverage is the largest share that it has
in the information of all runs on any combination that they tell at all: with a leverage of 1 it
alone tells something, and with it held out nothing could be learnt of that (leverage of groups of
rows: Belsley, Kuh and Welsch, Regression Diagnostics, 1980, chapter 2).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh

from inerter.identify.runs import BenchRun

Array = NDArray[np.float64]

# what a combination counts as told by, per mean square of a column: a hundredth of its rms
TOLD = 1e-4
# from this leverage on a run is not held out where another one can be
TOO_MUCH = 0.8
# weight of what the held-out run can judge against what it takes away
JUDGING = 0.3
# least share that counts
LEAST = 0.01
# widths of sign(v) and of the turn of a force, per rms velocity and acceleration
VELOCITY_WIDTH, FORCE_WIDTH = 0.02, 0.05
# samples per run that are looked at
SAMPLES = 4000


def shares(runs: Sequence[BenchRun]) -> Array:
    """Shares that each run has in what all tell, ascending, shape (runs, combinations)."""
    columns = _columns(runs)
    grams = [part.T @ part for part in columns]
    total = np.sum(grams, axis=0)
    count = sum(len(part) for part in columns)
    known = total + TOLD * count * np.eye(len(total))
    return np.array([np.clip(eigh(gram, known, eigvals_only=True), 0.0, 1.0) for gram in grams])


def leverage(runs: Sequence[BenchRun]) -> Array:
    """The largest share of each run in what all tell, shape (runs,)."""
    return shares(runs)[:, -1]


def least_missed(runs: Sequence[BenchRun], able: Sequence[int], usual: int) -> int:
    """Number of the run to hold out.

    Parameters
    ----------
    runs
        Every run.
    able
        Numbers of those that may be held out.
    usual
        The one to hold out where it takes nothing away that only it tells.
    """
    parts = shares(runs)
    fair = [i for i in able if parts[i, -1] <= TOO_MUCH]
    # where each takes something away, no other is better than the usual one
    if parts[usual, -1] <= TOO_MUCH or not fair:
        return usual
    # much left to learn from, and something of everything to judge by
    left = np.log(1 - parts + LEAST).sum(axis=1)
    told = np.log(parts + LEAST).sum(axis=1)
    score = left + JUDGING * told
    return int(max(fair, key=lambda i: score[i]))


def _columns(runs: Sequence[BenchRun]) -> list[Array]:
    """Columns of each run per their rms over all of them, (n_i, m)."""
    sizes = [
        _rms([getattr(run, name)[run.inner] for run in runs])
        for name in ("displacement", "velocity", "acceleration")
    ]
    made = [_forces(run, sizes) for run in runs]
    scale = np.array([_rms([part[:, j] for part in made]) for j in range(made[0].shape[1])])
    return [part / scale for part in made]


def _forces(run: BenchRun, sizes: Sequence[float]) -> Array:
    x, v, a = (
        values / size
        for values, size in zip(
            (run.displacement, run.velocity, run.acceleration), sizes, strict=True
        )
    )
    way = np.tanh(v / VELOCITY_WIDTH)
    jerk = np.gradient(a, run.spacing) if a.size > 1 else np.zeros(a.size)
    snap = np.gradient(jerk, run.spacing) if a.size > 1 else np.zeros(a.size)
    turn = np.tanh(a / FORCE_WIDTH)
    columns = [x, v, a, way, v * np.abs(v), x**3, np.abs(a) * way, x * way, jerk, snap, turn]
    found = np.column_stack(columns)[run.inner]
    return found[:: max(1, len(found) // SAMPLES)]


def _rms(parts: Sequence[Array]) -> float:
    values = np.concatenate(parts)
    return float(np.sqrt(np.mean(values**2))) if values.any() else 1.0
