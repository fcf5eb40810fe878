"""Two files of one test on two clocks: brought onto one by the motion that both have seen.

The lag is where the normalised correlation of the two velocities is highest, to a fraction of a
sample; its standard error is that of a least squares fit whose residual is correlated in time. A
motion that repeats fits at several lags: then the user is asked.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.fft import irfft, rfft
from scipy.fft import next_fast_len
from scipy.interpolate import make_interp_spline
from scipy.ndimage import gaussian_filter1d

from .integrate import integrated
from .record import Array, RecordError

LEAST = 0.8  # correlation of the same motion seen by two sensors
ALIKE = 0.98  # of the highest correlation: a lag that fits as well
LEAST_ENERGY = 0.6  # of the motion of either file that has to be in the overlap
_MOST = 1 << 21  # samples that are compared
_SHARED = ("displacement", "velocity", "acceleration")


@dataclass(frozen=True, kw_only=True)
class Lag:
    """By how much [s] the clock of one file is ahead: time = other's time + value.

    stderr [s]; correlation at that lag; ratio of the two motions; rate: by how much per second the
    lag grows, with its standard error.
    """

    value: float
    stderr: float
    correlation: float
    ratio: float
    rate: float
    rate_stderr: float


def joined(
    path: Path,
    values: dict[str, Array],
    other_path: Path,
    other: dict[str, Array],
    stated: float | None = None,
) -> tuple[dict[str, Array], slice, str]:
    """Channels of the other file on the clock of this one, the rows in both, what is to be told.

    Raises
    ------
    RecordError
        They share no motion, or several lags fit.
    """
    for place, columns in ((path, values), (other_path, other)):
        time = columns.get("time")
        if time is None:
            raise RecordError(
                f"{place}: no time is known, which two files of one test need; say --column "
                "time=NAME or time='every 1 ms'"
            )
        if not np.all(np.diff(time[np.isfinite(time)]) > 0):
            raise RecordError(f"{place}: time does not advance; sort the rows by time")
    mine, theirs = _without_gaps(values), _without_gaps(other)
    if stated is None and _one_clock(mine, theirs):
        value, told = 0.0, f"{other_path.name} joined: the same times in both files"
    elif stated is None:
        lag = find_lag(path, mine, other_path, theirs)
        told = (
            f"{other_path.name} joined: its clock {lag.value:+.6g} s ± {lag.stderr:.2g} s, by the "
            f"motion of both (correlation {lag.correlation:.3f})"
        )
        if abs(lag.ratio - 1) > 0.1:
            told += f"; its motion is {lag.ratio:.3g} times as large: check scales and units"
        if abs(lag.rate) > 4 * lag.rate_stderr and abs(lag.rate) > 1e-5:
            drift, error = 1e6 * lag.rate, 1e6 * lag.rate_stderr
            told += f"; the clocks drift apart by {drift:.3g} ± {error:.2g} ppm"
        value = lag.value
    else:
        value, told = stated, f"{other_path.name} joined: its clock {stated:+g} s, as stated"
    time, clock = values["time"], theirs["time"] + value
    inside = (time >= clock[0]) & (time <= clock[-1])
    if inside.sum() < 50:
        raise RecordError(f"{path}: no time is in both this file and {other_path}; check --lag")
    rows = np.flatnonzero(inside)
    made = {}
    for name, column in theirs.items():
        if name == "time" or name in values:
            continue
        spline = make_interp_spline(clock, column, k=3)
        made[name] = np.where(inside, spline(np.where(inside, time, clock[0])), np.nan)
    if len(rows) < len(time):
        told += f"; {len(rows)} of {len(time)} samples are in both"
    return made, slice(int(rows[0]), int(rows[-1]) + 1), told


def _one_clock(mine: dict[str, Array], theirs: dict[str, Array]) -> bool:
    """Whether two files that share no motion have the same times: channels of one recorder."""
    if set(_SHARED) & set(mine) and set(_SHARED) & set(theirs):
        return False
    a, b = mine["time"], theirs["time"]
    return len(a) == len(b) and bool(np.all(np.abs(a - b) <= 1e-3 * np.diff(a).min()))


def _without_gaps(values: dict[str, Array]) -> dict[str, Array]:
    whole = np.logical_and.reduce([np.isfinite(v) for v in values.values()])
    return {name: v[whole] for name, v in values.items()}


def find_lag(path: Path, mine: dict[str, Array], other: Path, theirs: dict[str, Array]) -> Lag:
    """The lag at which two files show one motion; RecordError where there is none, or several."""
    steps = [float(np.median(np.diff(c["time"]))) for c in (mine, theirs)]
    step = max(min(steps), max(np.ptp(c["time"]) for c in (mine, theirs)) / _MOST)
    width = max(steps) / step
    a, b = (_velocity(place, c, step, width) for place, c in ((path, mine), (other, theirs)))
    # the speed at which an accelerometer began is known to nobody
    began = any(_source(columns) == "acceleration" for columns in (mine, theirs))
    lags, r = _correlations(a, b, began)
    if not len(lags):
        raise RecordError(f"{path}: no motion that {other} has seen, too; give files of one test")
    # of a motion that repeats, half a period with the other sign is as good: the same sign is meant
    best = int(np.argmax(r))
    if r[best] < ALIKE * np.max(np.abs(r)):
        best = int(np.argmax(np.abs(r)))
    if abs(r[best]) < LEAST:
        raise RecordError(
            f"{path}: no motion that {other} has seen, too (highest correlation "
            f"{abs(r[best]):.2f}, {LEAST} is needed); give files of one test, or state --lag"
        )
    if r[best] < 0:
        raise RecordError(
            f"{path}: {other} shows the same motion with the opposite sign (correlation "
            f"{r[best]:.2f}); turn the sign of one, such as --column velocity='-1 * NAME', or "
            "-20 where '20 mm/turn * NAME' is stated"
        )
    offset = float(theirs["time"][0] - mine["time"][0])
    _refuse_several(path, other, lags, r, best, step, offset)
    lag, stderr, ratio = _refined(a, b, int(lags[best]))
    rate, rate_stderr = _rate(a, b, int(lags[best]))
    value = lag * step + float(mine["time"][0] - theirs["time"][0])
    return Lag(
        value=value, stderr=stderr * step, correlation=float(r[best]), ratio=ratio, rate=rate,
        rate_stderr=rate_stderr,
    )  # fmt: skip


def _velocity(path: Path, columns: dict[str, Array], step: float, width: float) -> Array:
    """The velocity on an even clock, behind a filter that is the same for both files."""
    name = _source(columns)
    if name is None:
        raise RecordError(
            f"{path}: no displacement, velocity or acceleration is known, by which two files of a "
            "test are brought together; say --column displacement=NAME or velocity=NAME"
        )
    time = columns["time"]
    values = columns[name]
    if name == "acceleration":
        values, name = integrated(time, values, 1)[0], "velocity"
    grid = np.arange(time[0], time[-1], step)
    even = np.interp(grid, time, values)
    order = 1 if name == "displacement" else 0
    return gaussian_filter1d(even, max(width, 1.0), order=order) / step**order


def _source(columns: dict[str, Array]) -> str | None:
    """The channel that the motion of a file is taken from."""
    return next((name for name in _SHARED if name in columns), None)


def _correlations(a: Array, b: Array, centred: bool = False) -> tuple[Array, Array]:
    """Lags in samples of b behind a, and the correlation in the overlap at each.

    centred: about the means there, for velocities that are known up to a constant.
    """
    if centred:
        a, b = a - a.mean(), b - b.mean()
    size = int(next_fast_len(len(a) + len(b), real=True) or 0)

    def slide(x: Array, y: Array) -> Array:
        full = irfft(rfft(x, size) * np.conj(rfft(y, size)), size)
        return np.concatenate([full[size - len(b) + 1 :], full[: len(a)]])

    ones = (np.ones(len(a)), np.ones(len(b)))
    cross, energy_a, energy_b = slide(a, b), slide(a**2, ones[1]), slide(ones[0], b**2)
    lags = np.arange(-len(b) + 1, len(a))
    if centred:
        samples = np.maximum(np.round(slide(*ones)), 1.0)
        sum_a, sum_b = slide(a, ones[1]), slide(ones[0], b)
        cross = cross - sum_a * sum_b / samples
        energy_a, energy_b = energy_a - sum_a**2 / samples, energy_b - sum_b**2 / samples
    enough = (energy_a > LEAST_ENERGY * np.sum(a**2)) & (energy_b > LEAST_ENERGY * np.sum(b**2))
    # b may have seen more or less than a: of one of them nearly all has to be there
    r = cross[enough] / np.sqrt(energy_a[enough] * energy_b[enough])
    return lags[enough].astype(float), r


def _refuse_several(
    path: Path, other: Path, lags: Array, r: Array, best: int, step: float, offset: float
) -> None:
    """RecordError where another peak is as high as the highest."""
    left, right = best, best
    while left > 0 and r[left] > 0.5 * r[best]:
        left -= 1
    while right < len(r) - 1 and r[right] > 0.5 * r[best]:
        right += 1
    rest = np.concatenate([r[:left], np.full(right - left, -1.0), r[right:]])
    second = int(np.argmax(rest))
    if rest[second] > ALIKE * r[best]:
        ways = " or ".join(f"--lag {lags[i] * step - offset:.4g}" for i in (best, second))
        raise RecordError(
            f"{path}: the motion repeats, and {other} fits at several lags alike (correlation "
            f"{r[best]:.3f} and {rest[second]:.3f}); say {ways}"
        )


def _overlap(a: Array, b: Array, lag: int) -> tuple[Array, Array]:
    start, stop = max(0, lag), min(len(a), len(b) + lag)
    return a[start:stop], b[start - lag : stop - lag]


def _refined(a: Array, b: Array, lag: int) -> tuple[float, float, float]:
    """Lag in samples with its standard error, and the ratio of b to a, by least squares."""
    first, second = _overlap(a, b, lag)
    shift = 0.0
    gain, stderr = 1.0, 0.0
    for _ in range(5):
        at = np.arange(len(second)) - shift
        moved = np.interp(at, np.arange(len(second)), second)
        slope = np.gradient(moved)
        matrix = np.column_stack([moved, -slope, np.ones(len(moved))])
        weights, *_ = np.linalg.lstsq(matrix, first, rcond=None)
        gain = float(weights[0])
        rest = first - matrix @ weights
        shift += float(np.clip(weights[1] / gain, -2, 2)) if gain else 0.0
        correlated = _correlation_time(rest)
        variance = float(np.mean(rest**2)) * correlated
        stderr = float(np.sqrt(variance / max(np.sum(slope**2) * gain**2, 1e-300)))
    return lag + shift, stderr, 1.0 / gain if gain else np.inf


def _correlation_time(rest: Array) -> float:
    """Samples that count as one, of a residual."""
    size = next_fast_len(2 * len(rest), real=True)
    auto = irfft(np.abs(rfft(rest - rest.mean(), size)) ** 2, size)[: len(rest)]
    if auto[0] <= 0:
        return 1.0
    auto = auto / auto[0]
    below = np.flatnonzero(auto < 0.05)
    end = int(below[0]) if len(below) else len(auto)
    return float(1 + 2 * np.sum(auto[1:end]))


def _rate(a: Array, b: Array, lag: int) -> tuple[float, float]:
    """By how much the lag grows per second, from its two halves, and the standard error."""
    first, second = _overlap(a, b, lag)
    middle = len(first) // 2
    halves = [(first[part], second[part]) for part in (slice(0, middle), slice(middle, None))]
    least = 0.05 * np.sum(first**2)
    if middle < 50 or any(np.sum(one**2) < least for one, _ in halves):
        return 0.0, np.inf
    found = [_refined(one, two, 0)[:2] for one, two in halves]
    # each half tells the lag where its motion is
    weights = [np.gradient(two) ** 2 for _, two in halves]
    centres = [float(np.average(np.arange(len(w)), weights=w)) for w in weights]
    apart = middle + centres[1] - centres[0]
    return (
        (found[1][0] - found[0][0]) / apart,
        float(np.hypot(found[0][1], found[1][1])) / apart,
    )
