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


def sandwich(jacobian: Array, residual: Array, weight: Array, held: Array | None = None) -> Array:
    """Covariance of a least-squares estimate, robust against correlated residuals, shape (p, p).

    Residuals of neighbouring samples are correlated, so the scores are summed over blocks before
    their spread is taken (a cluster-robust estimate).

    Parameters
    ----------
    jacobian, residual, weight : ndarray (n, p), (n,), (n,)
        Derivatives of the residual, the residual, and what each sample counts.
    held : ndarray (k, p), optional
        Rows, in the residual's unit, whose squares the fit counted besides: what it was held to.
        The bias by that counts as large as the fit takes it to be, which is what a smoothing
        spline's intervals cover with (Nychka 1988).
    """
    blocks = np.array_split(np.arange(residual.size), min(60, max(residual.size // 20, 2)))
    weighted = weight * residual
    scores = np.array([jacobian[block].T @ weighted[block] for block in blocks])
    information = jacobian.T @ (weight[:, None] * jacobian)
    count = len(blocks)
    spread = scores.T @ scores * count / max(count - 1, 1)
    if held is not None:
        prior = held.T @ held
        information = information + prior
        spread = spread + np.mean(weighted**2) * prior
    bread = np.linalg.pinv(information)
    return bread @ spread @ bread
