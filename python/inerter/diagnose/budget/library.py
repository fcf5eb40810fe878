"""What a flexible predictor looks at: the motion, the place, what went before, all of it together.

Functions of the measured motion alone, none of the force. Groups of columns, from plain to rich;
the last is made of random waves over a state with memory (random Fourier features: Rahimi and
Recht, NIPS 2007), which a ridge regression makes any smooth function of.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from inerter.diagnose.remainder import columns as c
from inerter.identify.runs import BenchRun

Array = NDArray[np.float64]

# harmonics of the travel: as curves for force, friction, inertance and damping; finer ones for the
# first two alone
CURVES = 10
FINE = 24
# by how much the motion is looked at earlier, in periods of the cut-off
LAGS = (0.125, 0.25, 0.5, 1.0, 2.0)
WAVES = 150
SEED = 0
GROUPS = (
    ("motion",),
    ("motion", "place"),
    ("motion", "memory"),
    ("motion", "place", "memory"),
    ("motion", "place", "memory", "waves"),
)
"""What predictors may use, the plainest first."""


def library(runs: Sequence[BenchRun], cutoff: float) -> list[dict[str, Array]]:
    """Columns (n_i, m) of each run, at the measured rate, by the name of their group.

    cutoff: of the smoothed motion [Hz]; what lies within a period of it is one moment.
    """
    sizes = c.sizes_of(runs)
    inner = np.concatenate([run.displacement[run.inner] for run in runs])
    travel = (float(inner.min()), float(inner.max()))
    made = [_plain(run, sizes, travel, cutoff) for run in runs]
    for columns, waves in zip(made, _waves(runs, made, sizes), strict=True):
        columns["waves"] = waves
    return made


def _plain(
    run: BenchRun, sizes: c.Sizes, travel: tuple[float, float], cutoff: float
) -> dict[str, Array]:
    x, v, a = _scaled(run, sizes)
    way = c.direction(run, sizes)
    ways = [way, *(np.tanh(v / width) for width in (0.1, 0.4))]
    level = [*ways, way * np.abs(a), way * x, way * np.sqrt(np.abs(v))]
    motion = [np.ones(v.size), x, v, a, x**3, v**3, v * np.abs(v), np.abs(v), np.abs(a)]
    motion = [*motion, *c.powers(run, sizes).T, *level]
    waves = _harmonics(run.displacement, travel)
    curves = waves[:, : 2 * CURVES]
    place = [waves, *(curves * q[:, None] for q in (v, a, v * v)), waves * way[:, None]]
    late = [_earlier(q, lag / cutoff, run) - q for lag in LAGS for q in (v, a, way)]
    past = c.past(replace(run, cutoff=cutoff), sizes)
    memory = [past, c.after_reversals(run, sizes), np.column_stack(late)]
    return {
        "motion": np.column_stack(motion),
        "place": np.column_stack(place),
        "memory": np.column_stack(memory),
    }


def _scaled(run: BenchRun, sizes: c.Sizes) -> tuple[Array, Array, Array]:
    """Displacement, velocity and acceleration per their rms, (n,) each."""
    return (
        run.displacement / sizes.x,
        run.velocity / sizes.v,
        run.acceleration / sizes.a,
    )


def _harmonics(x: Array, travel: tuple[float, float]) -> Array:
    """Sines and cosines along the travel, (n, 2 FINE); their period is a little longer than it."""
    phase = 2 * np.pi * (x - travel[0]) / (1.2 * (travel[1] - travel[0]) or 1.0)
    return np.column_stack(
        [wave(k * phase) for k in range(1, FINE + 1) for wave in (np.sin, np.cos)]
    )


def _earlier(values: Array, lag: float, run: BenchRun) -> Array:
    """What a quantity was a time `lag` [s] ago, (n,)."""
    back = max(1, round(lag / run.spacing))
    return np.concatenate([np.full(min(back, values.size), values[0]), values[:-back]])[
        : values.size
    ]


def _waves(
    runs: Sequence[BenchRun], made: Sequence[Mapping[str, Array]], sizes: c.Sizes
) -> list[Array]:
    """Waves over place, motion and what went before, of random direction and length."""
    random = np.random.default_rng(SEED)
    states = []
    for run, columns in zip(runs, made, strict=True):
        x, v, a = _scaled(run, sizes)
        states.append(np.column_stack([x, v, a, np.tanh(v / 0.3), columns["memory"][:, :19]]))
    inside = np.concatenate([s[run.inner] for s, run in zip(states, runs, strict=True)])
    spread = inside.std(axis=0)
    count = inside.shape[1]
    # the motion itself counts in full, of the past each wave looks at a part
    part = (np.arange(count) < 4)[:, None] | (random.random((count, WAVES)) < 0.15)
    length = random.choice([0.3, 0.7, 1.5], WAVES)
    direction = (
        random.standard_normal((count, WAVES)) * part * length / np.maximum(spread, 1e-9)[:, None]
    )
    phase = random.uniform(0, 2 * np.pi, WAVES)
    return [np.cos(state @ direction + phase) for state in states]
