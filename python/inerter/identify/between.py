"""A motion between its samples."""

from __future__ import annotations

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import NDArray

Array = NDArray[np.float64]

# polynomials of the share of an interval for x, v, a at its beginning and at its end
_QUINTICS = [
    Polynomial(each)
    for each in (
        (1, 0, 0, -10, 15, -6), (0, 1, 0, -6, 8, -3), (0, 0, 0.5, -1.5, 1.5, -0.5),
        (0, 0, 0, 10, -15, 6), (0, 0, 0, -4, 7, -3), (0, 0, 0, 0.5, -1, 0.5),
    )
]  # fmt: skip


def between(
    spacing: float, motion: tuple[Array, Array, Array], instants: int
) -> tuple[Array, Array, Array]:
    """Displacement, velocity, acceleration (n,) at several instants per sample, (m,) each.

    Along the quintics through all three of two samples. What rests goes on resting.
    """
    x, v, a = motion
    h, share = spacing, np.arange(instants) / instants
    known = np.column_stack([x, h * v, h**2 * a])
    known = np.hstack([known[:-1], known[1:]])
    fine = []
    for order, last in enumerate((x[-1], v[-1], a[-1])):
        shapes = np.array([each.deriv(order)(share) for each in _QUINTICS]) / h**order
        fine.append(np.append((known @ shapes).ravel(), last))
    rests = np.append(np.repeat((v[:-1] == 0.0) & (v[1:] == 0.0), instants), v[-1] == 0.0)
    still = np.append(np.repeat(x[:-1], instants), x[-1])
    return np.where(rests, still, fine[0]), np.where(rests, 0.0, fine[1]), fine[2]
