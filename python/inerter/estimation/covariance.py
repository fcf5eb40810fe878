"""Of residuals: what counts how much, and what their correlation does to an estimate."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# residuals beyond this many standard deviations count less in robust fits
ROBUST = 1.345


def usual_size(flat: Array) -> float:
    """Size of a residual from which on a robust fit lets it count less, in its unit."""
    return ROBUST * 1.4826 * float(np.median(np.abs(flat))) + 1e-300


def robust_weight(residual: Array, typical: float, loss: str) -> Array:
    """What each sample counts in a fit: 1 with the linear loss, less far off with others."""
    if loss == "linear":
        return np.ones_like(residual)
    z = (residual / typical) ** 2
    return {
        "soft_l1": 1 / np.sqrt(1 + z),
        "huber": 1 / np.sqrt(np.maximum(z, 1)),
        "cauchy": 1 / (1 + z),
        "arctan": 1 / (1 + z**2),
    }[loss]


def sandwich(jacobian: Array, residual: Array, weight: Array) -> Array:
    """Covariance of a least-squares estimate, robust against correlated residuals, shape (p, p).

    Residuals of neighbouring samples are correlated, so the scores are summed over blocks before
    their spread is taken (a cluster-robust estimate).

    Parameters
    ----------
    jacobian, residual, weight : ndarray (n, p), (n,), (n,)
        Derivatives of the residual, the residual, and what each sample counts.
    """
    blocks = np.array_split(np.arange(residual.size), min(60, max(residual.size // 20, 2)))
    weighted = weight * residual
    scores = np.array([jacobian[block].T @ weighted[block] for block in blocks])
    bread = np.linalg.pinv(jacobian.T @ (weight[:, None] * jacobian))
    count = len(blocks)
    return bread @ (scores.T @ scores) @ bread * count / max(count - 1, 1)
