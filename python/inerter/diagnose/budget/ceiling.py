"""What more could be predicted: a flexible predictor with memory on what a model leaves.

Ridge regression on the columns of `library`. Which groups of them and how much it shrinks is chosen
on folds left out of the fitted data (whole runs where there are several); then it is judged on the
held-out data, which had no say. It is a lower bound of what can be predicted, as another predictor
may do better, and an upper bound of the error that a model has to leave.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve

from inerter.diagnose.budget.library import GROUPS, library
from inerter.diagnose.statistics import advantage, block_squares
from inerter.identify.runs import BenchRun
from inerter.identify.split import Mask, Split, blocks

Array = NDArray[np.float64]
Index = NDArray[np.intp]

# per mean square of a column, the strongest first
PENALTIES = (1.0, 0.1, 1e-2, 1e-3, 1e-4, 1e-5)
# fewer teach nothing
FEWEST_SAMPLES = 200
# standard errors by which a predictor is better on held-out data, and the least that it takes away,
# rms: per noise, and per force. Smoothing leaves traces of every law with a corner, which are real,
# can be predicted and are no lack of the model
SURE = 3.0
NOISE_PART = 0.3
FORCE_PART = 0.006
# more samples are thinned: the regression has some hundred unknowns
MOST_SAMPLES = 40_000


@dataclass(frozen=True)
class Ceiling:
    """The held-out error that the best predictor leaves.

    Attributes
    ----------
    rmse : float
        Rms error on held-out data at the measured rate [N]; that of the model where nothing more
        was predictable.
    takes : float
        Rms of what it takes away [N]; 0 where nothing more was predictable.
    looks_at : tuple of str
        Groups of columns that it looks at.
    """

    rmse: float
    takes: float = 0.0
    looks_at: tuple[str, ...] = ()


def ceiling(
    runs: Sequence[BenchRun],
    split: Split,
    errors: Sequence[Array],
    cutoff: float,
    noise: float,
    motion: float = 0.0,
) -> Ceiling:
    """How well a flexible predictor does on top of a model.

    Parameters
    ----------
    runs, split
        At the measured rate, and how they are divided.
    errors
        Measured minus predicted force of each run (n_i,) [N].
    cutoff
        Of the smoothed motion [Hz].
    noise
        Of force and motion, rms [N].
    motion
        Of the motion alone [N]: the motion tells something of it, which is no lack of the model.
    """
    held = [m & run.inner for m, run in zip(split.holdout, runs, strict=True)]
    total = max(sum(int(mask.sum()) for mask in held), 1)
    counted = blocks(held)
    before = block_squares(errors, counted)
    own = float(np.sqrt(before.sum() / total))
    predicted, looks_at = predictor(runs, split, errors, cutoff)
    if not looks_at:
        return Ceiling(own)
    rest = [error - values for error, values in zip(errors, predicted, strict=True)]
    after = block_squares(rest, counted)
    takes = float(np.sqrt(max(before.sum() - after.sum(), 0.0) / total))
    if not matters(runs, held, takes, noise, motion) or advantage(before, after) < SURE:
        return Ceiling(own)
    return Ceiling(float(np.sqrt(after.sum() / total)), takes, looks_at)


def matters(
    runs: Sequence[BenchRun], held: Sequence[Mask], takes: float, noise: float, motion: float
) -> bool:
    """Whether an error that is taken away, rms [N], is of a size that smoothing does not leave.

    held: the samples that it is of; noise: of force and motion, rms [N]; motion: of that alone.
    """
    force = np.concatenate([run.force[mask] for run, mask in zip(runs, held, strict=True)])
    least = max(NOISE_PART * noise, FORCE_PART * float(np.sqrt(np.mean(force**2))))
    return takes >= float(np.hypot(least, motion))


def predictor(
    runs: Sequence[BenchRun], split: Split, errors: Sequence[Array], cutoff: float
) -> tuple[list[Array], tuple[str, ...]]:
    """What the best predictor makes of the errors of every run (n_i,) [N], and what it looks at.

    It learns from fitted samples alone, and predicts nothing larger than what it learnt from.
    """
    fit = fitted_masks(runs, split, errors)
    nothing: tuple[list[Array], tuple[str, ...]] = ([np.zeros(e.size) for e in errors], ())
    learnt = sum(int(mask.sum()) for mask in fit)
    if learnt < FEWEST_SAMPLES:
        return nothing
    made = library(runs, cutoff)
    names = list(made[0])
    owner = np.repeat(np.arange(len(names)), [made[0][name].shape[1] for name in names])
    matrix = [np.column_stack([columns[name] for name in names]) for columns in made]
    low, high, scale = _bounds(matrix, fit)
    matrix = [np.clip(m, low, high) / scale for m in matrix]
    parts = parts_of(split, fit)
    sums = Sums([_products(matrix, errors, part) for part in parts])

    best, chosen = sums.square, None
    for group in GROUPS:
        used: Index = np.flatnonzero(np.isin(owner, [names.index(name) for name in group]))
        last = np.inf
        for penalty in PENALTIES:
            error = sums.left_out(used, penalty * np.eye(used.size))
            if error < best:
                best, chosen = error, (used, penalty, group)
            # ever less shrinking only gets worse from here on
            if error > last:
                break
            last = error
    if chosen is None:
        return nothing
    used, penalty, group = chosen
    weights = sums.weights(used, penalty * np.eye(used.size))
    sizes = [np.max(np.abs(e[m]), initial=0.0) for e, m in zip(errors, fit, strict=True)]
    limit = float(max(sizes))
    return [np.clip(m[:, used] @ weights, -limit, limit) for m in matrix], group


def fitted_masks(runs: Sequence[BenchRun], split: Split, errors: Sequence[Array]) -> list[Mask]:
    """What of the errors of every run can be learnt from."""
    return [
        mask & run.inner & np.isfinite(error)
        for mask, run, error in zip(split.fit, runs, errors, strict=True)
    ]


class Sums:
    """Products of columns and errors over the parts of what is learnt from.

    A `penalty` is a square form of the coefficients, per mean square of a column.
    """

    def __init__(self, parts: Sequence[tuple[Array, Array, float]]) -> None:
        self.parts = parts
        self.gram = np.sum([gram for gram, _, _ in parts], axis=0)
        self.right = np.sum([right for _, right, _ in parts], axis=0)
        self.square = float(sum(square for _, _, square in parts))

    def weights(self, used: Index, penalty: Array) -> Array:
        """Coefficients of the columns `used`, learnt from everything."""
        return _ridge(self.gram[np.ix_(used, used)], self.right[used], penalty)

    def left_out(self, used: Index, penalty: Array) -> float:
        """Sum of squared errors on each part, learnt from the others."""
        at, total = np.ix_(used, used), 0.0
        whole, whole_right = self.gram[at], self.right[used]
        for gram, right, square in self.parts:
            there = gram[at]
            weights = _ridge(whole - there, whole_right - right[used], penalty)
            total += square - 2 * float(weights @ right[used]) + float(weights @ there @ weights)
        return total


def parts_of(split: Split, fit: Sequence[Mask]) -> list[list[Mask]]:
    """Fitted samples of each fold, and of none, thinned."""
    every = max(1, -(-sum(int(mask.sum()) for mask in fit) // MOST_SAMPLES))
    thinned = [mask & (np.arange(mask.size) % every == 0) for mask in fit]
    rest = [mask.copy() for mask in thinned]
    parts = []
    for fold in split.folds:
        part = [mask & left for mask, left in zip(rest, fold, strict=True)]
        rest = [mask & ~left for mask, left in zip(rest, fold, strict=True)]
        parts.append(part)
    return [part for part in (*parts, rest) if any(mask.any() for mask in part)]


def _bounds(matrix: Sequence[Array], fit: Sequence[Mask]) -> tuple[Array, Array, Array]:
    """Least and largest value of each column where it is learnt from, and its rms."""
    inside = np.concatenate([m[mask] for m, mask in zip(matrix, fit, strict=True)])
    size = np.sqrt(np.mean(inside**2, axis=0))
    return inside.min(axis=0), inside.max(axis=0), np.where(size > 0, size, 1.0)


def _products(
    matrix: Sequence[Array], errors: Sequence[Array], part: Sequence[Mask]
) -> tuple[Array, Array, float]:
    rows = np.concatenate([m[mask] for m, mask in zip(matrix, part, strict=True)])
    y = np.concatenate([e[mask] for e, mask in zip(errors, part, strict=True)])
    return rows.T @ rows, rows.T @ y, float(y @ y)


def _ridge(gram: Array, right: Array, penalty: Array) -> Array:
    """Coefficients that shrink by `penalty` per mean square of a column."""
    unit = np.trace(gram) / max(len(gram), 1)
    if not unit > 0:
        return np.zeros(len(gram))
    shrunk = gram + unit * penalty
    return cho_solve(cho_factor(shrunk, check_finite=False), right, check_finite=False)
