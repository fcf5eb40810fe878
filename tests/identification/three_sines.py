"""A motion of three sines, and runs along it as exact channels: the force alone has noise."""

from __future__ import annotations

import numpy as np
from inerter.identify.runs import BenchRun

H, N = 2e-3, 6000
TIME = H * np.arange(N)

Motion = tuple[np.ndarray, np.ndarray, np.ndarray]


def motion(scale: float = 1.0, late: float = 0.0) -> Motion:
    """Displacement, velocity, acceleration `late` [s] before the clock's times, (N,) each."""
    omega = 2 * np.pi * np.array([[0.4], [1.7], [4.3]])
    size = scale * np.array([[0.02], [0.006], [0.002]])
    s, c = np.sin(omega * (TIME - late)), np.cos(omega * (TIME - late))
    parts = (size * s, size * omega * c, -size * omega**2 * s)
    x, v, a = (part.sum(axis=0) for part in parts)
    return x, v, a


def run_of(force: np.ndarray, along: Motion, first_force: float | None = None) -> BenchRun:
    """A run of which every sample counts."""
    x, v, a = along
    return BenchRun(
        name="r",
        start=0.0,
        spacing=H,
        displacement=x,
        velocity=v,
        acceleration=a,
        force=force,
        inner=np.ones(force.size, bool),
        first_force=float(force[0]) if first_force is None else first_force,
        cutoff=np.inf,
    )
