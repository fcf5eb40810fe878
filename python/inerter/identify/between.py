"""A motion between its samples, and what friction is about one."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import convolve1d

Array = NDArray[np.float64]


def quintics(spacing: float, x: Array, v: Array, a: Array) -> Array:
    """Coefficients of the quintics of time through x, v, a (n,) of two samples, (n - 1, 6)."""
    h = spacing
    rest = np.diff(x) / h - v[:-1] - 0.5 * h * a[:-1]
    turn, bend = np.diff(v) - h * a[:-1], 0.5 * h * np.diff(a)
    cubic = (10.0 * rest - 4.0 * turn + bend) / h**2
    quartic = (7.0 * turn - 15.0 * rest - 2.0 * bend) / h**3
    quintic = (6.0 * rest - 3.0 * turn + bend) / h**4
    return np.column_stack([x[:-1], v[:-1], 0.5 * a[:-1], cubic, quartic, quintic])


def between(
    spacing: float, motion: tuple[Array, Array, Array], instants: int
) -> tuple[Array, Array, Array]:
    """Displacement, velocity, acceleration (n,) at several instants per sample, (m,) each.

    Along the quintics through all three of two samples. What rests goes on resting.
    """
    x, v, a = motion
    rows, time = quintics(spacing, x, v, a), spacing * np.arange(instants) / instants
    fine = []
    for last in (x[-1], v[-1], a[-1]):
        powers = time ** np.arange(rows.shape[1])[:, None]
        fine.append(np.append((rows @ powers).ravel(), last))
        # of the derivative
        rows = rows[:, 1:] * np.arange(1, rows.shape[1])
    rests = np.append(np.repeat((v[:-1] == 0.0) & (v[1:] == 0.0), instants), v[-1] == 0.0)
    still = np.append(np.repeat(x[:-1], instants), x[-1])
    return np.where(rests, still, fine[0]), np.where(rests, 0.0, fine[1]), fine[2]


def about_samples(forces: Mapping[str, Array], instants: int) -> dict[str, Array]:
    """Total and friction (m,) at several instants per sample as samples show them, (n,) each.

    Friction is the mean over a sample's spacing about it: a low-pass has smoothed what it jumps by.
    """
    window = np.ones(instants + 1) / instants
    window[[0, -1]] *= 0.5
    if instants % 2:
        window = np.ones(instants) / instants
    smooth = (forces["total"] - forces["friction"])[::instants]
    friction = convolve1d(forces["friction"], window, mode="nearest")[::instants]
    return {"total": smooth + friction, "friction": friction}
