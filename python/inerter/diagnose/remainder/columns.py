"""Columns that a residual may go with: bases of what is happening and of what happened before.

All are functions of the measured motion and of the clock, none of the residual. Columns with steps
pass the low-pass of the fitted force, as the friction of a device does.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BSpline
from scipy.signal import lfilter

from inerter.identify.runs import BenchRun
from inerter.records.motion import band_response, filtered

Array = NDArray[np.float64]

# knots of the splines along a quantity
KNOTS = 10
# width of sign(v), per rms velocity
TRANSITION = 0.02
# times over which a motion is remembered, from the band's own to this one [s]
LONGEST_MEMORY = 2.0
MEMORIES = 5
# widths of play operators, per rms displacement
PLAYS = (0.03, 0.1, 0.3, 1.0)
# ends of the classes of time since a reversal [s]
SINCE = (0.02, 0.05, 0.1, 0.2, 0.5)


@dataclass(frozen=True)
class Sizes:
    """Rms of displacement, velocity, acceleration and force over all runs, SI units."""

    x: float
    v: float
    a: float
    force: float


def sizes_of(runs: Sequence[BenchRun]) -> Sizes:
    """Rms of the channels over the samples that count."""

    def rms(name: str) -> float:
        values = np.concatenate([getattr(run, name)[run.inner] for run in runs])
        return float(np.sqrt(np.mean(values**2))) or 1.0

    return Sizes(rms("displacement"), rms("velocity"), rms("acceleration"), rms("force"))


def through_band(run: BenchRun, columns: Array) -> Array:
    """Columns (n, m) through the low-pass of the fitted force."""
    gain = band_response(len(columns), run.spacing, run.cutoff)
    return np.column_stack([filtered(column, gain) for column in columns.T])


def direction(run: BenchRun, sizes: Sizes) -> Array:
    """Sign of the velocity, smooth where it is small, (n,)."""
    return np.tanh(run.velocity / (TRANSITION * sizes.v))


def spline(values: Array, edges: Array) -> Array:
    """Cubic B-splines along a quantity, (n, m); beyond the outermost edges as at them."""
    knots = np.r_[[edges[0]] * 3, edges, [edges[-1]] * 3]
    inside = np.clip(values, edges[0], edges[-1] - 1e-9 * (edges[-1] - edges[0]))
    return BSpline.design_matrix(inside, knots, 3).toarray()


def edges_of(values: Array, count: int = KNOTS) -> Array:
    """Edges for `spline`: quantiles, so that every spline has data, (count,) or fewer."""
    found = np.unique(np.quantile(values, np.linspace(0.003, 0.997, count)))
    return found if found.size > 1 else np.array([found[0] - 1.0, found[0] + 1.0])


def powers(run: BenchRun, sizes: Sizes) -> Array:
    """Products of x, v and a up to the third degree that are no powers of one alone, (n, 13)."""
    x, v, a = run.displacement / sizes.x, run.velocity / sizes.v, run.acceleration / sizes.a
    pairs = [x * v, x * a, v * a, x * x * v, x * x * a, v * v * x, v * v * a, a * a * x, a * a * v]
    speed = np.abs(v)
    return np.column_stack([*pairs, x * v * a, x * speed, a * speed, np.abs(a) * v])


def filtered_past(values: Array, spacing: float, memory: float) -> Array:
    """Exponentially fading mean of the past of a quantity, (n,)."""
    keep = np.exp(-spacing / memory)
    return lfilter([1 - keep], [1, -keep], values, zi=[keep * values[0]])[0]


def memories(cutoff: float, duration: float) -> Array:
    """Times over which to remember [s]."""
    first = 1 / (2 * np.pi * cutoff) * 2
    return np.geomspace(first, max(min(LONGEST_MEMORY, duration / 3), 2 * first), MEMORIES)


def play(x: Array, half: float) -> Array:
    """Output of a play (backlash) operator of half-width `half` [m], (n,)."""
    out = np.empty(x.size)
    y = x[0]
    for i, value in enumerate(x.tolist()):
        if value - y > half:
            y = value - half
        elif y - value > half:
            y = value + half
        out[i] = y
    return out


def past(run: BenchRun, sizes: Sizes) -> Array:
    """What went before: fading means of velocity and direction, and plays of the displacement."""
    way = direction(run, sizes)
    columns = []
    for memory in memories(run.cutoff, run.force.size * run.spacing):
        columns += [
            filtered_past(run.velocity / sizes.v, run.spacing, memory),
            filtered_past(way, run.spacing, memory),
            filtered_past(np.abs(run.velocity) / sizes.v, run.spacing, memory) * way,
        ]
    columns += [
        (play(run.displacement, share * sizes.x) - run.displacement) / (share * sizes.x)
        for share in PLAYS
    ]
    return np.column_stack(columns)


def since_reversal(run: BenchRun, sizes: Sizes) -> tuple[Array, Array]:
    """Time since the velocity last changed sign, and how long it had rested then [s], (n,) each."""
    slow = 0.02 * sizes.v
    sign = np.where(np.abs(run.velocity) > slow, np.sign(run.velocity), 0.0)
    since, rested = np.empty(sign.size), np.empty(sign.size)
    last, clock, rest, still = 0.0, 10.0, 0.0, 0.0
    for i, way in enumerate(sign.tolist()):
        if way == 0:
            still += run.spacing
            clock += run.spacing
        else:
            if way != last or still > 0.05:
                clock, rest, last = 0.0, still, way
            still = 0.0
            clock += run.spacing
        since[i], rested[i] = clock, rest
    return since, rested


def after_reversals(run: BenchRun, sizes: Sizes) -> Array:
    """Direction within classes of time since a reversal, alone and with the rest before, (n, m)."""
    since, rested = since_reversal(run, sizes)
    way = direction(run, sizes)
    classes = np.digitize(since, SINCE)
    columns = []
    for k in range(len(SINCE)):
        inside = way * (classes == k)
        columns += [inside, inside * np.log1p(rested / 0.02)]
    return through_band(run, np.column_stack(columns))


def amplitude(run: BenchRun, sizes: Sizes) -> Array:
    """Rms velocity over about the second around a sample, per rms of all runs, (n,)."""
    square = (run.velocity / sizes.v) ** 2
    ahead = filtered_past(square[::-1], run.spacing, 0.5)[::-1]
    return np.sqrt((filtered_past(square, run.spacing, 0.5) + ahead) / 2)
