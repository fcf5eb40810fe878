"""Forces that repeat along the stroke or in time: the period is searched, then judged elsewhere.

A sine's period enters nonlinearly: it is chosen on the data learnt from, by the power that a sine
and cosine take out of them, and the sine is judged on the data left out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inerter.diagnose.waves import shortest, wave_sums

from .learning import FOLDS, LearntPart, Samples, chance, share

Array = NDArray[np.float64]

# wave numbers per period of the whole stroke
FINENESS = 5


@dataclass(frozen=True)
class Period:
    """A period along the stroke [m], and what a force of that period predicts."""

    length: float
    prediction: LearntPart


def along_stroke(data: Samples, x: Array, factor: Array) -> Period:
    """The force factor(x) times a sine of x that takes most out of the residual.

    Parameters
    ----------
    data : Samples
        The residual.
    x : ndarray (n,)
        Displacement [m] on the samples that count.
    factor : ndarray (n,)
        What the sine is multiplied by: ones, or the direction of motion.
    """
    stroke = float(np.ptp(x)) or 1.0
    finest = shortest(stroke, float(np.median(np.abs(np.diff(x)))))
    numbers = np.arange(FINENESS, FINENESS * stroke / finest) / (FINENESS * stroke)
    powers = _moments(data, x, factor, numbers)
    values = np.zeros(x.size)
    picked = []
    for k in range(FOLDS + 1):
        part = data.fold == k
        learnt = [j for j in range(1, FOLDS + 1) if j != k]
        if not part.any():
            continue
        best = _best(powers, learnt)
        number = numbers[best]
        rest = np.isin(data.fold, learnt)
        columns = _pair(x, factor, number)
        weights = np.linalg.lstsq(columns[rest], data.residual[rest], rcond=None)[0]
        values[part] = columns[part] @ weights
        picked.append((int(part.sum()), number))
    r, held = data.residual, data.fold == 0
    prediction = LearntPart(
        values,
        share(r, values),
        share(r[held], values[held]),
        chance(r, values, data.stretch),
    )
    return Period(1 / max(picked)[1], prediction)


def _pair(x: Array, factor: Array, number: float) -> Array:
    phase = 2 * np.pi * number * x
    return np.column_stack([factor * np.sin(phase), factor * np.cos(phase)])


def _moments(data: Samples, x: Array, factor: Array, numbers: Array) -> Array:
    """Per fold and wave number: sums of s s, s c, c c, s r, c r, shape (folds, numbers, 5)."""
    found = np.empty((FOLDS + 1, numbers.size, 5))
    step = float(numbers[1] - numbers[0])
    first = round(numbers[0] / step)
    for k in range(FOLDS + 1):
        part = data.fold == k
        weight, r = factor[part] ** 2, (factor * data.residual)[part]
        count, total = first + numbers.size, float(np.sum(weight))
        if not part.any():
            found[k] = 0.0
            continue
        single = wave_sums(x[part], r[None], step, count)[0, first:]
        double = wave_sums(x[part], weight[None], step, 2 * count)[0, 2 * first :: 2]
        found[k] = np.column_stack(
            [
                (total - double.real) / 2, double.imag / 2, (total + double.real) / 2,
                single.imag, single.real,
            ]
        )  # fmt: skip
    return found


def _best(moments: Array, learnt: Sequence[int]) -> int:
    ss, sc, cc, sr, cr = np.moveaxis(moments[list(learnt)].sum(axis=0), -1, 0)
    determinant = np.maximum(ss * cc - sc**2, 1e-9 * (ss + cc) ** 2 + 1e-300)
    return int(np.argmax((cc * sr**2 - 2 * sc * sr * cr + ss * cr**2) / determinant))
