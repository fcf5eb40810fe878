"""A force channel whose clock runs slower or faster than that of the displacement.

Two loggers, put together by their first sample: what is a delay grows through the record, to tens
of milliseconds. No effect is like that, and everything that goes with the velocity is wrong by it.
In stretches of each run it is asked by how much the force is late, with a force that is any linear
one there; where that grows evenly, at one rate in all runs, the force is put on the other clock.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from inerter.measured_text import measured
from inerter.records import Record
from inerter.records.even_clock import even_spacing
from inerter.records.motion import Motion
from inerter.records.preparation import prepare

Array = NDArray[np.float64]

# stretches of a run; samples of one, at least; delays that are tried [s], and how many
STRETCHES, FEWEST, LATEST, TRIED = 10, 60, 0.08, 81
# a rate is one from so many standard errors on, where it shifts the end of a run by so many
# samples, and where what is left of all stretches is so much less with it
SURE, SHIFTED, BETTER = 8.0, 3.0, 0.7
# samples of all runs together, at most: smoothing more of them takes its time
MOST = 200_000
# samples of a smoothed motion that are one independent one: a guess, on which only the least error
# rests, for what the stretches lie off a line by counts too
_ALIKE = 10.0
# stretches that it takes, of all runs; how often it is asked again of what was put right
_TELLING, _AGAIN = 5, 2


@dataclass(frozen=True)
class ClockRate:
    """By which share the clock of the force runs slower than that of the displacement.

    Attributes
    ----------
    value, stderr
        The rate [1], and its standard error.
    most
        By how much it shifts the end of the longest run [s].
    """

    value: float
    stderr: float
    most: float

    def in_words(self) -> str:
        """A sentence for the verdict."""
        how = "slow" if self.value > 0 else "fast"
        percent = measured(100 * abs(self.value), 100 * self.stderr)
        return (
            f"The clock of the force channel runs {percent} % {how} against that of the "
            f"displacement, up to {1e3 * self.most:.3g} ms at the end of a run: the force was put "
            "on the clock of the displacement."
        )


def on_one_clock(records: Sequence[Record]) -> tuple[Sequence[Record], ClockRate | None]:
    """Records with the force on the clock of the displacement, and the rate, where there is one."""
    whole = not any(record.part for record in records)
    short = sum(record.samples for record in records) <= MOST
    if not (whole and short and all(even_spacing(record.time) for record in records)):
        return records, None
    try:
        motions = prepare(records).motions
    except ValueError:
        # too little to tell motion from noise: said where it is asked for
        return records, None
    rate = clock_rate(motions)
    if rate is None:
        return records, None
    right = [_put_right(record, rate.value) for record in records]
    # a motion is smoothed as its force tells, and that better now
    for _ in range(_AGAIN):
        more, error = _what_is_left(prepare(right).motions)
        value = (1.0 + rate.value) * (1.0 + more) - 1.0
        rate = ClockRate(value, error, rate.most * abs(value / rate.value))
        right = [_put_right(record, value) for record in records]
    return right, rate


def clock_rate(motions: Sequence[Motion]) -> ClockRate | None:
    """The rate at which the force comes early in some runs; None where none is sure."""
    value, error, better = _rate(motions)
    shifted = abs(value) * max(float(m.spacing * m.displacement.size) for m in motions)
    little = shifted < SHIFTED * max(m.spacing for m in motions)
    if little or abs(value) < SURE * error or better > BETTER**2:
        return None
    return ClockRate(value, error, shifted)


def _rate(motions: Sequence[Motion]) -> tuple[float, float, float]:
    """The rate, its standard error, and the share of the squares that it leaves, in most stretches.

    The error is infinite where too few stretches tell their delay.
    """
    rows = [row for k, motion in enumerate(motions) for row in _stretches(motion, k)]
    if len(rows) < _TELLING:
        return 0.0, np.inf, 1.0
    run, time, late, weight = np.array([row[:4] for row in rows]).T
    # a delay of its own for each run, and one rate
    own = (run[:, np.newaxis] == np.unique(run)).astype(float)
    matrix, root = np.column_stack([time, own]), np.sqrt(weight)
    scaled, asked = matrix * root[:, np.newaxis], late * root
    solved, held = (
        np.linalg.lstsq(columns, asked, rcond=None)[0] for columns in (scaled, scaled[:, 1:])
    )
    # what lies about the line, or what each stretch knows of its own, whichever is more
    free = max(len(rows) - matrix.shape[1], 1)
    spread = max(float(np.sum((asked - scaled @ solved) ** 2)) / free, 1.0)
    error = float(np.sqrt(np.linalg.pinv(scaled.T @ scaled)[0, 0] * spread))
    along, fixed = (
        np.array([row[4](float(at)) for row, at in zip(rows, each, strict=True)])
        for each in (matrix @ solved, matrix[:, 1:] @ held)
    )
    # in most stretches, for in one alone something else may be missed
    better = float(np.median(along / np.maximum(fixed, 1e-300)))
    # a force that is ever earlier is on a slow clock: it shows t when (1 + r) t has gone
    return -float(solved[0]), error, better


def _what_is_left(motions: Sequence[Motion]) -> tuple[float, float]:
    """The small rate that is left in runs, and its standard error, of all their samples together.

    F(t + r t + d) = F + (r t + d) F', beside one linear force for all runs.
    """
    parts, rests, groups = [], [], []
    for k, motion in enumerate(motions):
        rows = np.flatnonzero(motion.inner)
        times = motion.spacing * np.arange(motion.displacement.size)
        rise = CubicSpline(times, motion.force)(times[rows], 1)
        own = np.zeros((rows.size, len(motions)))
        own[:, k] = 1.0
        parts.append(np.column_stack([
            times[rows] * rise, rise, *_linear(motion, rows).T, own,
        ]))  # fmt: skip
        rests.append(motion.force[rows])
        groups += [k * STRETCHES + part for part in range(STRETCHES) for _ in _share(rows, part)]
    matrix, force = np.concatenate(parts), np.concatenate(rests)
    scale = np.sqrt(np.mean(matrix**2, axis=0)) + 1e-300
    matrix = matrix / scale
    solved, *_ = np.linalg.lstsq(matrix, force, rcond=1e-12)
    left, which = force - matrix @ solved, np.array(groups)
    scores = np.array([
        matrix[which == group].T @ left[which == group] for group in np.unique(which)
    ])  # fmt: skip
    bread = np.linalg.pinv(matrix.T @ matrix, rcond=1e-12)
    covariance = bread @ scores.T @ scores @ bread
    return float(solved[0] / scale[0]), float(np.sqrt(max(covariance[0, 0], 0.0)) / scale[0])


def _share(rows: NDArray[np.intp], part: int) -> NDArray[np.intp]:
    return np.array_split(rows, STRETCHES)[part]


def _linear(motion: Motion, rows: NDArray[np.intp]) -> Array:
    """What a linear force and dry friction are made of, (n, 4)."""
    v = motion.velocity[rows]
    return np.column_stack([motion.acceleration[rows], v, motion.displacement[rows], np.sign(v)])


def _stretches(motion: Motion, run: int) -> list[tuple]:
    """Of each stretch the run, its middle [s], by how much the force is late there [s], weight, and
    the squares that a delay leaves.

    A stretch that does not tell its delay is left out.
    """
    found, times = [], motion.spacing * np.arange(motion.displacement.size)
    force = CubicSpline(times, motion.force)
    delays = np.linspace(-LATEST, LATEST, TRIED)
    inner = np.flatnonzero(motion.inner)
    for rows in np.array_split(inner, STRETCHES):
        if rows.size < FEWEST or np.any(np.diff(rows) > 1):
            continue
        columns = np.column_stack([_linear(motion, rows), np.ones(rows.size)])
        basis, _ = np.linalg.qr(columns / (np.linalg.norm(columns, axis=0) + 1e-300))
        asked = np.clip(times[rows][:, np.newaxis] + delays, times[0], times[-1])
        shifted = force(asked)
        squares = np.sum((shifted - basis @ (basis.T @ shifted)) ** 2, axis=0)
        squares = squares / (np.sum((shifted - shifted.mean(axis=0)) ** 2, axis=0) + 1e-300)
        best = int(np.argmin(squares))
        if not 0 < best < TRIED - 1:
            continue
        curve = np.polyfit(delays[best - 1 : best + 2], squares[best - 1 : best + 2], 2)
        if not curve[0] > 0:
            continue
        late, least = -curve[1] / (2 * curve[0]), max(float(squares[best]), 1e-12)
        # where the delay is off by one error the squares rise by their mean per independent sample
        weight = curve[0] * rows.size / (least * _ALIKE)
        found.append((
            run, float(np.mean(times[rows])), float(late), float(weight),
            CubicSpline(delays, squares),
        ))  # fmt: skip
    return found


def _put_right(record: Record, rate: float) -> Record:
    """A record with its force where the clock of the displacement has it, as far as it reaches."""
    time = record.time
    asked = time[0] + (time - time[0]) / (1.0 + rate)
    kept = asked <= time[-1]
    force = CubicSpline(time, record.force)(np.minimum(asked, time[-1]))
    if kept.all():
        return replace(record, force=force)
    channels = {"time": time, **record.channels(), "force": force}
    extra = {name: values[kept] for name, values in record.extra.items()}
    return replace(record, **{n: values[kept] for n, values in channels.items()}, extra=extra)
