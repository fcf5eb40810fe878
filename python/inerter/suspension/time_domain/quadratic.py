"""Quadratics through values at as few points as they have coefficients."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def stencil_of(count: int) -> Array:
    """As many points as a quadratic has coefficients: middle, axes, pairs of axes."""
    eye = np.eye(count)
    pairs = [eye[i] + eye[j] for i, j in itertools.combinations(range(count), 2)]
    return np.vstack([np.zeros(count), eye, -eye, *pairs])


def terms_of(u: Array) -> Array:
    """1, u_i, u_i^2, u_i u_j of points (n, count)."""
    count = u.shape[1]
    pairs = [u[:, i] * u[:, j] for i, j in itertools.combinations(range(count), 2)]
    return np.column_stack([np.ones(len(u)), u, u**2, *pairs])


def fitted(stencil: Array, values: Array) -> Array | None:
    """Coefficients of the quadratic; None where a design could not be simulated."""
    if not np.isfinite(values).all():
        return None
    return np.asarray(np.linalg.solve(terms_of(stencil), values), dtype=np.float64)
