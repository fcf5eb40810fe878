"""What differs between strokes that repeat: what no function of the motion alone can predict.

Strokes are cut at the turning points. Two are the same where direction, duration and the courses of
displacement, velocity and acceleration agree. What a model leaves of them is compared sample by
sample: the device does the same, to first order whatever the model lacks, and what differs is noise
of the channels, and what is not settled by the motion. The variance is that about the mean of each
kind, with one degree of freedom less (the pure error of repeated measurements: Draper and Smith,
Applied Regression Analysis, 1.5).

Not compared: the surroundings of the turning points, where two strokes that turn a sample apart
differ by whatever friction does there; rests.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inerter.identify.runs import BenchRun

Array = NDArray[np.float64]

# a turn back by less than this share of the whole travel ends no stroke
LEAST_TURN = 0.03
# share of a stroke's largest speed from which on it is compared
MOVING = 0.1
# what two of a kind may differ by: of the duration; of size, largest speed and acceleration, rms
SAME_DURATION = 0.03
SAME_COURSE = (0.02, 0.04, 0.08)
# strokes that repeat an earlier one, and samples that are compared, below which nothing is said
FEWEST_REPEATS = 3
FEWEST_SAMPLES = 200


@dataclass(frozen=True)
class Repeats:
    """What repeats.

    Attributes
    ----------
    rmse : float
        Rms of what differs [N].
    strokes, kinds : int
        Strokes that have at least one of their kind beside them, and the number of kinds.
    """

    rmse: float
    strokes: int
    kinds: int


@dataclass(frozen=True)
class _Stroke:
    """Courses of one stroke between its turning points, and the sample `middle` to align by."""

    course: Array
    error: Array
    middle: int

    @property
    def size(self) -> int:
        return self.error.size

    @property
    def features(self) -> Array:
        """Direction, samples before and after the middle, place, and largest speed, (5,)."""
        x, v, _ = self.course
        way = np.sign(x[-1] - x[0])
        after = self.size - self.middle
        return np.array([way, self.middle, after, x[self.middle], np.abs(v).max()])


def repeats(runs: Sequence[BenchRun], errors: Sequence[Array]) -> Repeats | None:
    """What differs between the strokes of some runs that repeat; None where too few do.

    runs: at the measured rate; errors: measured minus predicted force of each (n_i,) [N].
    """
    travel = max((float(np.ptp(run.displacement[run.inner])) for run in runs if run.inner.any()),
                 default=0.0)  # fmt: skip
    strokes = [
        stroke
        for run, error in zip(runs, errors, strict=True)
        for stroke in _strokes(run, error, LEAST_TURN * travel)
    ]
    # a clock of another rate is another grid
    spacing = [run.spacing for run in runs]
    if not strokes or max(spacing) > 1.01 * min(spacing):
        return None
    kinds = [kind for kind in _kinds(strokes) if len(kind) > 1]
    again = sum(len(kind) - 1 for kind in kinds)
    square, freedom = 0.0, 0
    for kind in kinds:
        aligned = _aligned(kind)
        square += float(np.sum((aligned - aligned.mean(axis=0)) ** 2))
        freedom += (len(kind) - 1) * aligned.shape[1]
    if again < FEWEST_REPEATS or freedom < FEWEST_SAMPLES:
        return None
    return Repeats(float(np.sqrt(square / freedom)), sum(map(len, kinds)), len(kinds))


def turning_points(x: Array, least: float) -> list[int]:
    """Samples at which a displacement (n,) turns, back by at least `least` [m]."""
    found: list[int] = []
    low = high = 0
    way = 0
    for i, value in enumerate(x.tolist()):
        if value > x[high]:
            high = i
        if value < x[low]:
            low = i
        if way >= 0 and x[high] - value > least:
            found.append(high)
            way, low = -1, i
        elif way <= 0 and value - x[low] > least:
            found.append(low)
            way, high = 1, i
    return found


def _strokes(run: BenchRun, error: Array, least: float) -> list[_Stroke]:
    if not least > 0:
        return []
    turns = turning_points(run.displacement, least)
    found = []
    for begin, end in itertools.pairwise(turns):
        if not run.inner[begin : end + 1].all() or not np.isfinite(error[begin : end + 1]).all():
            continue
        speed = np.abs(run.velocity[begin : end + 1])
        moving = np.flatnonzero(speed > MOVING * speed.max())
        if moving.size < 8:
            continue
        part = slice(begin + int(moving[0]), begin + int(moving[-1]) + 1)
        course = np.array([run.displacement[part], run.velocity[part], run.acceleration[part]])
        x = course[0]
        middle = int(np.argmin(np.abs(x - 0.5 * (x[0] + x[-1]))))
        found.append(_Stroke(course, error[part], middle))
    return found


def _kinds(strokes: Sequence[_Stroke]) -> list[list[_Stroke]]:
    """Strokes that are the same as the first of their kind."""
    kinds: list[list[_Stroke]] = []
    known = np.empty((len(strokes), 5))
    for stroke in strokes:
        new = stroke.features
        old = known[: len(kinds)]
        duration = SAME_DURATION * stroke.size + 1
        near = (
            (old[:, 0] == new[0])
            & (np.abs(old[:, 1:3] - new[1:3]) <= duration).all(axis=1)
            & (np.abs(old[:, 3] - new[3]) <= 2 * SAME_COURSE[0] * np.ptp(stroke.course[0]))
            & (np.abs(old[:, 4] - new[4]) <= 2 * SAME_COURSE[1] * new[4])
        )
        same = next((i for i in np.flatnonzero(near) if _same(kinds[i][0], stroke)), None)
        if same is None:
            known[len(kinds)] = new
            kinds.append([stroke])
        else:
            kinds[same].append(stroke)
    return kinds


def _same(one: _Stroke, other: _Stroke) -> bool:
    before, after = _common([one, other])
    a, b = (s.course[:, s.middle - before : s.middle + after] for s in (one, other))
    apart = np.sqrt(np.mean((a - b) ** 2, axis=1))
    size = np.array([np.ptp(a[0]), np.abs(a[1]).max(), np.abs(a[2]).max()])
    return bool(np.all(apart <= np.array(SAME_COURSE) * size))


def _common(strokes: Sequence[_Stroke]) -> tuple[int, int]:
    """Samples before and after the middle that all of some strokes have."""
    return min(s.middle for s in strokes), min(s.size - s.middle for s in strokes)


def _aligned(kind: Sequence[_Stroke]) -> Array:
    """Errors of strokes of a kind, (strokes, samples) [N]."""
    before, after = _common(kind)
    return np.array([s.error[s.middle - before : s.middle + after] for s in kind])
