"""Whether the residual is louder at some moments: bursts without a phase, such as squeal.

An oscillation that starts with a phase of its own each time has no mean that a regression could
find; its power has. The residual's rms over short cells is predicted from the time since the last
reversal, the speed, the place and the acceleration, out of sample as everything here.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.fft import rfft, rfftfreq
from numpy.typing import NDArray

from inerter.identify.runs import BenchRun

from . import columns as c
from .learning import gather, predict

Array = NDArray[np.float64]

# length of a cell [s], and classes of each quantity
CELL = 0.02
CLASSES = 5
# cells without which loudness cannot be judged
FEWEST = 16


@dataclass(frozen=True, kw_only=True)
class Bursts:
    """How the residual's loudness changes.

    Attributes
    ----------
    share, share_held_out : float
        Share of the variance of its rms over cells that is predicted.
    size : float
        Rms of what is louder than the quietest moments [N].
    frequency : float
        Where most of its power lies in the loudest cells [Hz].
    after_reversals : bool
        Whether the time since a reversal alone predicts most of that.
    """

    share: float
    share_held_out: float
    p: float
    size: float
    frequency: float
    after_reversals: bool


def bursts(
    runs: Sequence[BenchRun], residual: Sequence[Array], held: Sequence[NDArray], sizes: c.Sizes
) -> Bursts:
    """Look for bursts in residuals (n_i,) [N] at the rate of the records.

    held: held-out samples of each run.
    """
    loud, since, moments, masks, out, steps = [], [], [], [], [], []
    for run, r, mask in zip(runs, residual, held, strict=True):
        length = max(round(CELL / run.spacing), 4)
        count = r.size // length

        def cells(values: Array, n: int = length, m: int = count) -> Array:
            return values[: n * m].reshape(m, n)

        loud.append(np.sqrt(np.mean(cells(r) ** 2, axis=1)))
        clock, _ = c.since_reversal(run, sizes)
        since.append(cells(clock)[:, length // 2])
        channels = np.column_stack([run.displacement, run.velocity, run.acceleration])
        moments.append(channels[: length * count : length])
        masks.append(cells(run.inner.astype(float)).all(axis=1))
        out.append(cells(mask.astype(float)).any(axis=1))
        steps.append(length * run.spacing)
    if sum(int(mask.sum()) for mask in masks) < FEWEST:
        # short and fast runs
        return Bursts(
            share=0.0, share_held_out=0.0, p=1.0, size=0.0, frequency=0.0, after_reversals=False
        )
    mean = float(np.mean(np.concatenate([q[m] for q, m in zip(loud, masks, strict=True)])))
    data = gather([q - mean for q in loud], masks, out, steps, [1 / s for s in steps])
    clocks = _classes(data.flat(since), np.array(c.SINCE))
    x, v, a = data.flat(moments).T
    everything = [np.ones((x.size, 1)), clocks] + [
        _classes(q, np.unique(np.quantile(q, np.linspace(0, 1, CLASSES + 1)[1:-1])))
        for q in (x, np.abs(v), np.abs(a))
    ]
    full = predict(data, np.column_stack(everything))
    alone = predict(data, clocks)
    level = np.maximum(full.values + mean, 0)
    quiet = float(np.quantile(level, 0.1))
    size = float(np.sqrt(np.mean(np.maximum(level**2 - quiet**2, 0))))
    return Bursts(
        share=full.share,
        share_held_out=full.share_held_out,
        p=full.p,
        size=size,
        frequency=_pitch(runs, residual),
        after_reversals=alone.share > 0.6 * full.share,
    )


def _classes(values: Array, edges: Array) -> Array:
    """One column of 0 and 1 per class, (n, m)."""
    return (np.digitize(values, edges)[:, None] == np.arange(edges.size + 1)).astype(float)


def _pitch(runs: Sequence[BenchRun], residual: Sequence[Array]) -> float:
    """Frequency of most power in the run with the loudest residual [Hz]."""
    i = int(np.argmax([np.mean(r[run.inner] ** 2) for run, r in zip(runs, residual, strict=True)]))
    r = np.where(runs[i].inner, residual[i], 0)
    power = np.abs(rfft(r)) ** 2

    # smoothed over about a hertz: a burst is no line
    width = max(int(r.size * runs[i].spacing), 1)
    smooth = np.convolve(power, np.ones(width) / width, "same")
    return float(rfftfreq(r.size, runs[i].spacing)[int(np.argmax(smooth))])
