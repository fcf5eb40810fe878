"""Motions of a bench that are sums of sines with phases that are drawn."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from inerter.reference import sum_of_sines
from numpy.typing import ArrayLike


def moved(
    draw: np.random.Generator,
    time: np.ndarray,
    frequencies: Sequence[float],
    sizes: ArrayLike,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Displacement [m], velocity and acceleration; frequencies [Hz], sizes [m]."""
    amplitudes = np.broadcast_to(sizes, len(frequencies))
    motion = sum_of_sines(amplitudes, frequencies, draw.uniform(0, 6, len(frequencies)))
    found = motion.displacement(time), motion.velocity(time), motion.acceleration(time)
    return np.asarray(found[0]), np.asarray(found[1]), np.asarray(found[2])
