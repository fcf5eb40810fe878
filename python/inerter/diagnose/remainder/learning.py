"""What a set of columns predicts of the residual, learnt and judged on different data.

Every sample is predicted from stretches that it is no part of: the held-out data from the data of
the fits, the latter from their other stretches (`FOLDS` interleaved parts). Ridge regression; how
much it shrinks is chosen within what it learns from.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.stats import t as student

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

FOLDS = 4
# length of the stretches that folds and sums are made of, in periods of the cut-off: residuals are
# correlated over about one
STRETCH_PERIODS = 8.0
SUM_PERIODS = 2.0
# ridge penalties tried, per mean square of a column
PENALTIES = (1e-6, 1e-3, 1e-2, 1e-1)


@dataclass(frozen=True)
class Samples:
    """The residual on the samples that count, in one column.

    Attributes
    ----------
    residual : ndarray (n,)
        Measured minus predicted force [N].
    fold : ndarray of int (n,)
        0 for held-out samples, else 1 .. `FOLDS`.
    stretch : ndarray of int (n,)
        Number of the short stretch that a sample belongs to, counted over all runs.
    chosen : list of ndarray of bool
        Which samples of each run these are.
    """

    residual: Array
    fold: NDArray[np.int64]
    stretch: NDArray[np.int64]
    chosen: list[Mask]

    def flat(self, channels: Sequence[Array]) -> Array:
        """Values per run, (n_i,) or (n_i, m), as one array over the samples that count."""
        return np.concatenate([c[m] for c, m in zip(channels, self.chosen, strict=True)])

    @property
    def power(self) -> float:
        """Mean square of the residual [N^2]."""
        return float(np.mean(self.residual**2))


@dataclass(frozen=True)
class LearntPart:
    """What columns predict of the residual, out of sample.

    Attributes
    ----------
    values : ndarray (n,)
        Predicted residual [N].
    share, share_held_out : float
        Share of the residual's power that it takes away, on all data and on held-out data.
    p : float
        Probability of as good a prediction of a residual that has nothing to do with the columns.
    """

    values: Array
    share: float
    share_held_out: float
    p: float


def gather(
    residual: Sequence[Array],
    masks: Sequence[Mask],
    held: Sequence[Mask],
    spacing: Sequence[float],
    cutoff: Sequence[float],
) -> Samples:
    """Arrange residuals of runs (n_i,) [N] into folds and stretches; `held`: held-out samples."""
    folds, stretches, count = [], [], 0
    for r, mask, out, step, limit in zip(residual, masks, held, spacing, cutoff, strict=True):
        length = max(int(STRETCH_PERIODS / limit / step), 8)
        number = np.arange(r.size) // length
        # neighbours in time go to different folds, and not in step with any period of the motion
        order = (number * 7 + number // FOLDS * 2 + count) % FOLDS
        folds.append(np.where(out, 0, 1 + order)[mask])
        short = np.arange(r.size) // max(int(SUM_PERIODS / limit / step), 4)
        stretches.append((count + short)[mask])
        count += int(short[-1]) + 1
    flat = np.concatenate([r[m] for r, m in zip(residual, masks, strict=True)])
    return Samples(flat, np.concatenate(folds), np.concatenate(stretches), list(masks))


def predict(data: Samples, columns: Array, target: Array | None = None) -> LearntPart:
    """Predict the residual, or another `target` (n,), from columns (n, m), out of sample."""
    y = data.residual if target is None else target
    sizes = np.sqrt(np.mean(columns**2, axis=0))
    matrix = columns[:, sizes > 0] / sizes[sizes > 0]
    parts = [data.fold == k for k in range(FOLDS + 1)]
    grams = [matrix[part].T @ matrix[part] for part in parts]
    rights = [matrix[part].T @ y[part] for part in parts]
    squares = [float(y[part] @ y[part]) for part in parts]
    values = np.zeros(y.size)
    for k, part in enumerate(parts):
        learnt = [j for j in range(1, FOLDS + 1) if j != k]
        if part.any():
            # nothing larger than what was learnt from is predicted
            limit = float(np.max(np.abs(y[np.isin(data.fold, learnt)]), initial=0.0))
            raw = matrix[part] @ _ridge(grams, rights, squares, learnt)
            values[part] = np.clip(raw, -limit, limit)
    return LearntPart(
        values,
        share(y, values),
        share(y[parts[0]], values[parts[0]]),
        chance(y, values, data.stretch),
    )


def share(residual: Array, predicted: Array) -> float:
    """Share of a residual's power that a prediction takes away."""
    power = float(np.sum(residual**2))
    return 1 - float(np.sum((residual - predicted) ** 2)) / power if power > 0 else 0.0


def chance(residual: Array, predicted: Array, stretch: NDArray[np.int64]) -> float:
    """Probability that a prediction goes with the residual so well by chance.

    Products of the two are summed over stretches and divided by the residual's rms there, so that
    a busy stretch does not decide alone. Where the residual has nothing to do with the prediction,
    these sums have either sign with the same probability, whatever their sizes and however the
    residual is correlated within a stretch; their total over its own root sum of squares is then
    close to Student's t with as many degrees of freedom as there are stretches that count.
    """
    power = np.bincount(stretch, residual**2)
    known = power > 0
    sums = np.bincount(stretch, residual * predicted)[known] / np.sqrt(power[known])
    square = float(np.sum(sums**2))
    if square == 0:
        return 1.0
    freedom = square**2 / float(np.sum(sums**4)) - 1
    if freedom < 2:
        return 1.0
    return float(student.sf(np.sum(sums) / np.sqrt(square), freedom))


def _ridge(
    grams: Sequence[Array], rights: Sequence[Array], squares: Sequence[float], learnt: Sequence[int]
) -> Array:
    """Coefficients (m,) from the folds `learnt`, at the penalty that predicts best among them."""
    gram = np.sum([grams[j] for j in learnt], axis=0)
    right = np.sum([rights[j] for j in learnt], axis=0)
    if not np.trace(gram) > 0:
        # nothing to learn from
        return np.zeros(len(gram))
    unit = np.trace(gram) / max(len(gram), 1) * np.eye(len(gram))
    best, chosen = np.inf, PENALTIES[-1]
    for penalty in PENALTIES:
        error = 0.0
        for j in learnt:
            w = np.linalg.solve(gram - grams[j] + penalty * unit, right - rights[j])
            error += squares[j] - 2 * float(w @ rights[j]) + float(w @ grams[j] @ w)
        if error < best:
            best, chosen = error, penalty
    return np.linalg.solve(gram + chosen * unit, right)
