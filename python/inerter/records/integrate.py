"""A displacement from what was measured in its place: velocity, acceleration, two accelerometers.

What is integrated drifts: an offset of the sensor grows into a ramp, its noise into a walk. Taken
out of the integral is a polynomial, and of an acceleration whatever is slower than a quarter of the
slowest motion: the cosines below that frequency, fitted by least squares. Slow changes of place
that were real go with it; the highest of what was taken out is told. A velocity whose noise walks
nowhere keeps them: an offset is taken out of it alone, where its integral has a trend.
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import make_interp_spline
from scipy.signal import welch

from inerter.motion_units import TRANSLATION, Kind, unit

from .motion import uniform_channels
from .record import Array
from .runs import Part

SLOWEST = 0.01  # share of a channel's power below its slowest motion
SHARE = 0.25  # of the slowest frequency: below it is drift
MOST_COSINES = 200
TREND = 2.0  # times what chance makes of a line through a motion, from which it is an offset
WALK = 0.02  # of the way that is moved: what noise may walk where slow motions are kept


def with_displacement(
    columns: dict[str, Array], part: Part, motion: Kind = TRANSLATION
) -> tuple[dict[str, Array], list[str]]:
    """Columns with a displacement and without what it was made of; what was done.

    Two accelerometers make one acceleration where there is a displacement.
    """
    columns = dict(columns)
    both = [columns.pop(name, None) for name in ("acceleration_1", "acceleration_2")]
    notes: list[str] = []
    if both[0] is not None and both[1] is not None and "acceleration" not in columns:
        columns["acceleration"] = both[1] - both[0]
        notes.append("acceleration = acceleration_2 - acceleration_1")
    if "displacement" in columns:
        return columns, notes
    source = "velocity" if "velocity" in columns else "acceleration"
    values = columns.pop(source)
    if not np.ptp(values) > 0:
        raise part.refuse(f"column {source!r} never changes; there is no motion in it")
    columns.pop("acceleration", None)
    order = 1 if source == "velocity" else 2
    made, drift, slowest = integrated(columns["time"], values, order)
    columns["displacement"] = made
    small = unit(motion, "mm")
    times = "once" if order == 1 else "twice"
    most, spans = (f"{1e3 * size:.3g} {small}" for size in (np.max(np.abs(drift)), np.ptp(made)))
    said = f"a drift of up to {most} was taken out"
    if slowest:
        said += f", and with it whatever moves slower than {SHARE * slowest:.2g} Hz"
    else:
        said += ", as of a constant offset" if drift.any() else ", as none is to be seen"
    notes.append(f"displacement = {source}, integrated {times}; {said} (the motion spans {spans})")
    ordered = {"time": columns["time"], "displacement": made}
    return ordered | columns, notes


def integrated(time: Array, values: Array, order: int) -> tuple[Array, Array, float]:
    """Integral of values (n,) at times (n,), once or twice, the drift taken out of it [SI].

    Also the drift (n,) and the frequency [Hz] of the slowest motion, 0 where slow motions stay.
    """
    slowest = slowest_motion(time, values)
    start = time - time[0]
    raw = np.asarray(
        make_interp_spline(start, values - values.mean(), k=3).antiderivative(order)(start)
    )
    span = start[-1]
    if order == 1 and _walk(values, span) < WALK * np.ptp(raw):
        slowest = 0.0
        plain = raw + values.mean() * start
        if not _has_trend(start, plain):
            return plain, np.zeros_like(plain), slowest
    count = min(MOST_COSINES, int(2 * span * SHARE * slowest))
    u = start / span
    basis = [u**k for k in range(order + 1)] + [np.cos(np.pi * k * u) for k in range(1, count + 1)]
    matrix = np.column_stack(basis)
    weights, *_ = np.linalg.lstsq(matrix, raw, rcond=1e-10)
    drift = matrix @ weights
    made = raw - drift
    # from the start on, as displacements are often told
    return made, drift - drift[0], slowest


def _walk(velocity: Array, span: float) -> float:
    """How far the noise of a velocity (n,), taken as white, walks in a time [s]: rms [m]."""
    noise = 1.4826 * float(np.median(np.abs(np.diff(velocity, 2)))) / np.sqrt(6.0)
    return noise * span / np.sqrt(velocity.size)


def _has_trend(time: Array, x: Array) -> bool:
    """Whether a displacement (n,) grows in time by more than a motion without a trend may do.

    Each way of it counts as one value: a line through so many is off by that much.
    """
    slope, middle = np.polyfit(time, x, 1)
    rest = x - (slope * time + middle)
    size = float(np.std(rest))
    sides = np.sign(rest[np.abs(rest) > 0.5 * size])
    ways = 1 + np.count_nonzero(np.diff(sides))
    chance = np.sqrt(12.0 / ways) * size
    return bool(abs(slope) * time[-1] > TREND * chance)


def slowest_motion(time: Array, values: Array) -> float:
    """The frequency [Hz] below which hardly anything of a channel's power lies.

    Never below one period in the record.
    """
    spacing, even = uniform_channels(time, {"v": values})
    v = even["v"]
    length = min(v.size, 1 << 16)
    frequency, power = welch(v - v.mean(), 1 / spacing, nperseg=length)
    share = np.cumsum(power) / max(float(power.sum()), 1e-300)
    found = float(frequency[int(np.argmax(share >= SLOWEST))])
    return max(found, 1.0 / float(time[-1] - time[0]))
