"""What is doubtful about records: one small detector per warning code, each with a stated rule.

Every detector takes a record and returns it, with a warning more where its rule applies. The
statistics are medians and quantiles, so that what is searched for does not move the threshold.
Rules prefer silence to a false alarm. Nothing is repaired here.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar, cast

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d, median_filter

from inerter.motion_units import ROTATION, words

from .clipping import find_clipping, stretches
from .duplicates import find_duplicate_records
from .even_clock import even_spacing
from .header import split_header
from .jumps import find_displacement_jumps
from .record import Array, Columns, Record, TimeRecord

R = TypeVar("R", bound=Columns)
T = TypeVar("T", bound=TimeRecord)


def check_records(records: Sequence[R]) -> list[R]:
    """The records with the warnings of every detector, in the same order."""
    return find_duplicate_records([_check(record) for record in records])


def _check(record: R) -> R:
    """The detectors that look at one record, as far as they apply to its kind."""
    checked = find_constant_channel(record)
    if isinstance(checked, TimeRecord):
        checked = find_missing_samples(checked)
        checked = find_nonuniform_sampling(checked)
        checked = find_outliers(checked)
        checked = find_clipping(checked)
        checked = find_unit_suspect(checked)
    if isinstance(checked, Record):
        checked = find_displacement_jumps(checked)
        checked = find_inconsistent_motion(checked)
        checked = find_sign_flip(checked)
    return cast(R, checked)


def find_constant_channel(record: R) -> R:
    """`constant_channel`: a measured column that never changes (to 1e-9 of its size)."""
    for name, values in record.channels().items():
        if record.samples > 1 and np.ptp(values) <= 1e-9 * np.max(np.abs(values)):
            text = f"{name!r} is {values[0]:g} throughout: a dead or unplugged sensor?"
            record = record.warn("constant_channel", text)
    return record


# --- clock -------------------------------------------------------------------------------------


def _gaps(time: Array) -> tuple[NDArray[np.bool_], bool]:
    """Intervals above 1.5 medians, and whether the clock is otherwise uniform.

    Uniform: at most 1 % of the other intervals are more than 10 % off the median, and at most
    5 % of all are gaps.
    """
    step = np.diff(time)
    if even_spacing(time) is not None:
        # rounded times may be half an interval apart, and one and a half
        return np.zeros(step.size, bool), True
    middle = np.median(step)
    gap = step > 1.5 * middle
    off = np.abs(step[~gap] / middle - 1.0) > 0.1
    return gap, bool(np.mean(off) <= 0.01 and np.mean(gap) <= 0.05)


def find_missing_samples(record: T) -> T:
    """`missing_samples`: an otherwise uniform clock that jumps ahead by 1.5 intervals or more."""
    gap, uniform = _gaps(record.time)
    if uniform and gap.any():
        step = np.diff(record.time)
        lost = int(np.sum(np.round(step[gap] / np.median(step)) - 1))
        worst = int(np.argmax(step))
        text = (
            f"about {lost} samples are missing in {int(gap.sum())} gaps, "
            f"the longest {step[worst]:.3g} s after t = {record.time[worst]:.6g} s"
        )
        record = record.warn("missing_samples", text)
    return record


def find_nonuniform_sampling(record: T) -> T:
    """`nonuniform_sampling`: intervals spread by more than 10 % for more than 1 % of them."""
    _, uniform = _gaps(record.time)
    if not uniform:
        low, middle, high = np.quantile(np.diff(record.time), (0.01, 0.5, 0.99))
        text = f"the sampling interval varies: {middle:.3g} s, 98 % in {low:.3g} to {high:.3g} s"
        record = record.warn("nonuniform_sampling", text)
    return record


# --- single channels ---------------------------------------------------------------------------


def outlier_rows(values: Array) -> NDArray[np.intp]:
    """Rows of isolated spikes of one to three samples in an evenly sampled channel.

    A spike leaves the median of seven neighbours by 3 % of the channel's range, by 20 times the
    median of such deviations and by 15 times the median change per sample (both over a hundred
    neighbours, and over the whole channel where it changes), and the channel is back where it was
    (to 30 % of the spike) beyond it. When more than 1 % of all rows spike, that is how this
    channel is, and none is returned.
    """
    none = np.empty(0, dtype=np.intp)
    if len(values) < 30:
        return none
    change = np.abs(np.diff(values, prepend=values[0]))
    away = np.abs(values - median_filter(values, 7, mode="mirror"))
    low, high = np.quantile(values, (0.01, 0.99))
    limit = np.full(len(values), 0.03 * (high - low))
    for factor, size in ((20.0, away), (15.0, change)):
        local = median_filter(size, 101, mode="mirror")
        overall = np.median(size[size > 0.0]) if size.any() else 0.0
        limit = np.maximum(limit, factor * np.maximum(local, overall))
    rows = [
        np.arange(start, stop)
        for start, stop in stretches(away > limit)
        if stop - start <= 3 and _returns(values, start, stop)
    ]
    found = np.concatenate(rows) if rows else none
    return found if len(found) <= 0.01 * len(values) else none


def _returns(values: Array, start: int, stop: int) -> bool:
    """Whether the levels before and behind a spike agree to 30 % of its height."""
    # at the very ends there is no level to return to
    if start < 3 or stop > len(values) - 3:
        return False
    before = np.median(values[max(start - 4, 0) : start])
    behind = np.median(values[stop : stop + 4])
    height = np.max(np.abs(values[start:stop] - 0.5 * (before + behind)))
    return bool(abs(behind - before) <= 0.3 * height)


def find_outliers(record: T) -> T:
    """`outliers`: a channel with spikes by the rule of `outlier_rows`.

    In a bench force, a spike within the usual range does not count where the motion all but
    stands still: dry friction dips like that when the velocity just touches zero.
    """
    for name, values in record.channels().items():
        rows = outlier_rows(values)
        if isinstance(record, Record) and name == "force" and len(rows):
            low, high = np.quantile(values, (0.01, 0.99))
            inside = (values[rows] >= low) & (values[rows] <= high)
            rows = rows[~(inside & _slow(record)[rows])]
        if len(rows):
            worst = rows[np.argmax(np.abs(values[rows] - np.median(values)))]
            text = (
                f"{name!r} has {len(rows)} samples in isolated spikes, "
                f"such as {values[worst]:.4g} at t = {record.time[worst]:.6g} s"
            )
            record = record.warn("outliers", text)
    return record


def _slow(record: Record) -> NDArray[np.bool_]:
    """Where the speed over ten samples is below 5 % of its 95 % quantile."""
    reach = np.arange(record.samples)
    before, behind = np.maximum(reach - 5, 0), np.minimum(reach + 5, record.samples - 1)
    x, time = record.displacement, record.time
    speed = np.abs((x[behind] - x[before]) / (time[behind] - time[before]))
    return speed < 0.05 * np.quantile(speed, 0.95)


def _says_its_clock(record: TimeRecord) -> bool:
    """Whether the unit of the time, or the time between samples, was given with a file."""
    header = record.headers.get("time")
    if header is None:
        return bool(record.headers)
    return split_header(header)[1] is not None


def find_unit_suspect(record: T) -> T:
    """`unit_suspect`: magnitudes no bench or vehicle has.

    Fewer than 5 samples per second, where no unit of the time was given, or more than a million; a
    displacement or a suspension travel over more than 5 m or faster than 30 m/s (95 % quantile); a
    force above 1e7 N; an acceleration above 1e5 m/s^2 (99 % quantiles). Where a device turns:
    faster than 1e4 rad/s, a torque above 1e7 N m, an acceleration above 1e7 rad/s^2.
    """
    rate = record.sample_rate
    if rate < 5.0 and not _says_its_clock(record):
        text = f"{rate:.3g} samples per second: is 'time' in ms? Then write time[ms]"
        record = record.warn("unit_suspect", text)
    elif rate > 1e6:
        text = f"{rate:.3g} samples per second: check the unit of 'time'"
        record = record.warn("unit_suspect", text)
    for name, values in record.channels().items():
        text = ""
        if record.motion == ROTATION:
            text = _strange_turn(name, values, record)
        elif name in ("displacement", "suspension_travel"):
            span = np.ptp(np.quantile(values, (0.005, 0.995)))
            speed = np.quantile(np.abs(np.diff(values) / np.diff(record.time)), 0.95)
            if span > 5.0:
                text = f"{name!r} spans {span:.3g} m: is it in mm? Then write {name}[mm]"
            elif speed > 30.0 and 5.0 <= rate <= 1e6:
                text = f"{name!r} moves at {speed:.3g} m/s: is it in mm? Then write {name}[mm]"
        else:
            size = np.quantile(np.abs(values), 0.99)
            if name.endswith("force") and size > 1e7:
                text = f"{name!r} reaches {size:.3g} N: check its unit"
            elif name.endswith("acceleration") and size > 1e5:
                text = f"{name!r} reaches {size:.3g} m/s^2: check its unit"
        if text:
            record = record.warn("unit_suspect", text)
    return record


def _strange_turn(name: str, values: Array, record: TimeRecord) -> str:
    """What is strange about the size of a channel of a device that turns; empty for nothing."""
    size = np.quantile(np.abs(values), 0.99)
    if name == "displacement":
        speed = np.quantile(np.abs(np.diff(values) / np.diff(record.time)), 0.95)
        if speed > 1e4 and 5.0 <= record.sample_rate <= 1e6:
            return f"{name!r} turns at {speed:.3g} rad/s: is it in deg? Then write {name}[deg]"
    elif name == "force" and size > 1e7:
        return f"{name!r} reaches {size:.3g} N m: check its unit"
    elif name == "acceleration" and size > 1e7:
        return f"{name!r} reaches {size:.3g} rad/s^2: check its unit"
    return ""


# --- channels against each other ---------------------------------------------------------------


def _smooth_motion(record: Record) -> tuple[int, Array, Array, Array] | None:
    """Filter width in samples and displacement, velocity, acceleration behind one Gaussian filter.

    The narrowest filter (1, 2, 4, ... samples) for which the noise of the displacement makes less
    than 0.5 % of the variance of its second derivative; None when there is none. The noise is
    estimated from sixth differences, and is at least that of one quantisation step.
    """
    time, x = _even(record, record.displacement)
    dt = (time[-1] - time[0]) / (len(time) - 1)
    change = np.abs(np.diff(x))
    change = change[change > 1e-12 * np.ptp(x)]
    if len(x) < 50 or not len(change):
        return None
    noise = max(1.4826 * np.median(np.abs(np.diff(x, 6))) / np.sqrt(924.0),
                float(np.min(change)) / np.sqrt(12.0))  # fmt: skip
    width = 1
    while 10 * width < len(x):
        # differences, as the filter's own derivatives let some of the displacement through
        smooth, inner = gaussian_filter1d(x, width), slice(4 * width, -4 * width)
        a = np.diff(smooth, 2, prepend=smooth[0], append=smooth[-1])[inner]
        expected = noise**2 * 3.0 / (8.0 * np.sqrt(np.pi)) * float(width) ** -5
        if np.var(a) > 200.0 * expected:
            return width, smooth[inner], np.gradient(smooth, dt)[inner], a / dt**2
        width *= 2
    return None


def _even(record: Record, values: Array) -> tuple[Array, Array]:
    """Time and a channel on an even grid of as many samples."""
    grid = np.linspace(record.time[0], record.time[-1], record.samples)
    return grid, np.interp(grid, record.time, values)


def _alike(record: Record, values: Array, width: int) -> Array:
    """A channel behind the filter of `_smooth_motion`."""
    _, even = _even(record, values)
    return gaussian_filter1d(even, width)[4 * width : -4 * width]


def find_inconsistent_motion(record: Record) -> Record:
    """Measured velocity and acceleration against the derivatives of the displacement.

    Where the two correlate by more than 0.9 in size: `sign_flip` when they are opposite, and
    `unit_suspect` when their ratio is outside 1/3 to 3. Delays and noise keep the correlation
    low, and then nothing is said.
    """
    motion = _smooth_motion(record)
    if motion is None:
        return record
    width, _, *derivatives = motion
    for name, derived in zip(("velocity", "acceleration"), derivatives, strict=True):
        measured = getattr(record, name)
        if measured is None:
            continue
        measured = _alike(record, measured, width)
        measured, derived = measured - measured.mean(), derived - derived.mean()
        power = float(np.sqrt(np.sum(measured**2) * np.sum(derived**2)))
        together = float(np.sum(measured * derived)) / power if power > 0.0 else 0.0
        if abs(together) < 0.9:
            continue
        ratio = float(np.std(measured) / np.std(derived))
        if together < 0.0:
            text = (
                f"{name!r} has the sign opposite to the change of 'displacement': give "
                f"{record.turned_round(name)}, or the displacement so"
            )
            record = record.warn("sign_flip", text)
        if not 1.0 / 3.0 < ratio < 3.0:
            text = (
                f"{name!r} is {ratio:.3g} times what 'displacement' says: "
                "check the units of both and of 'time'"
            )
            record = record.warn("unit_suspect", text)
    return record


def find_sign_flip(record: Record) -> Record:
    """`sign_flip`: the force pushes where an inerter pulls, or it feeds energy into the bench.

    Force is fitted by acceleration a, displacement x, velocity v, sign of v and a constant, all
    behind one Gaussian filter, over three strokes or more. `loss` is the mean power without the
    parts of a and x over the mean of abs(F v): near +1 for a damper, 0 for an inerter or a
    spring, -1 for a damper of the wrong sign. A warning needs loss < 0.1 and a negative
    coefficient of a which takes away 5 % of the variance beside x or, where a explains the force
    as well as x does, 20 % without x; or loss < -0.3 and no positive coefficient of that weight.
    Silent where the displacement does not resolve accelerations. One pure sine cannot tell a
    lossless spring from a flipped inerter and is taken for the latter.
    """
    motion = _smooth_motion(record)
    if motion is None:
        return record
    width, x, v, a = motion
    force = _alike(record, record.force, width)
    force = force - force.mean()
    if not np.any(force) or _strokes(v) < 3:
        return record
    friction = np.tanh(v / (0.05 * np.std(v)))

    # what acceleration adds with and without displacement in the fit
    rest_v, _ = _fit(force, v, friction)
    rest_x, _ = _fit(force, x, v, friction)
    rest_a, alone = _fit(force, a, v, friction)
    rest_ax, beside = _fit(force, a, x, v, friction)
    weights: list[float] = []
    if rest_x - rest_ax > 0.05:
        weights.append(float(beside[0]))
    elif rest_v - rest_a > 0.2 and rest_a <= 1.2 * rest_x + 0.01:
        weights.append(float(alone[0]))
    stored = beside[0] * (a - a.mean()) + beside[1] * (x - x.mean())
    loss = float(np.mean((force - stored) * v) / np.mean(np.abs(force * v)))

    negative = any(weight < 0.0 for weight in weights)
    positive = any(weight > 0.0 for weight in weights)
    if (negative and loss < 0.1) or (loss < -0.3 and not positive):
        how = (
            f"its best-fit inertance is {weights[0]:.3g} {words(record.motion, 'kg')}"
            if negative
            else f"it feeds energy into the bench (loss ratio {loss:.2f})"
        )
        text = (
            f"'force' or 'displacement' has the wrong sign: {how}; tension and longer are +: give "
            f"{record.turned_round('force')}, or the displacement so"
        )
        record = record.warn("sign_flip", text)
    return record


def _strokes(velocity: Array) -> int:
    """Number of stretches of one direction, counted above a tenth of the highest speed."""
    direction = np.sign(velocity[np.abs(velocity) > 0.1 * np.max(np.abs(velocity))])
    return 1 + int(np.sum(direction[1:] != direction[:-1]))


def _fit(force: Array, *columns: Array) -> tuple[float, Array]:
    """Share of the variance that a linear fit leaves, and the coefficients of the columns."""
    scale = np.array([float(np.std(c)) or 1.0 for c in columns])
    matrix = np.column_stack([(c - c.mean()) / s for c, s in zip(columns, scale, strict=True)])
    weights, *_ = np.linalg.lstsq(matrix, force, rcond=1e-6)
    rest = float(np.sum((force - matrix @ weights) ** 2) / np.sum(force**2))
    return rest, weights / scale
