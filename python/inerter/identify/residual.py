"""Of residuals: what counts how much, what their correlation does to an estimate, what decays."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from inerter.core import Device

Array = NDArray[np.float64]


# squared rms residual per squared size that a transient is expected to have
TIMID = 1e-2
# exponent of a decay that leaves nothing
_DECAYED = 60.0


def robust_weight(residual: Array, typical: float, loss: str) -> Array:
    """What each sample counts in a fit: 1 with the linear loss, less far off with others."""
    z = (residual / typical) ** 2
    return {
        "linear": np.ones_like(z),
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


def without_transient(
    device: Device, residual: Array, spacing: float, mask: NDArray[np.bool_]
) -> Array:
    """A residual without the decay of the series element's unknown first state, shape (n,).

    Nobody measures how fast the flywheel turns as a record begins. What that leaves is a decaying
    oscillation, exp(lambda t) with b lambda^2 + (c_s + c_w) lambda + k_s = 0; the share of the
    masked samples that has this form is taken out. Its size at the beginning is held near what the
    residual is large, for where the beginning is masked, its faint rest tells nothing of it.
    """
    b = device.inertance
    damping = device.series_damping + device.flywheel_viscous
    roots = _roots(b, damping, device.series_stiffness)
    if np.count_nonzero(mask) < 4 or not np.isfinite(roots).all():
        return residual
    # what is below rounding by then has no share
    slowest = float(np.max(roots.real)) * spacing
    count = residual.size if slowest >= 0 else min(residual.size, int(_DECAYED / -slowest) + 2)
    with np.errstate(under="ignore"):
        if abs(roots[0].imag) > 0:
            wave = _decay(roots[0] * spacing, count)
            basis = np.array([wave.real, wave.imag])
        else:
            basis = np.array([_decay(root * spacing, count).real for root in roots])
    basis /= np.max(np.abs(basis), axis=1, keepdims=True) + 1e-300
    if not np.isfinite(basis).all():
        return residual
    # normal equations do: what holds the size back keeps them well conditioned
    seen = basis * mask[:count]
    share = np.linalg.solve(seen @ basis.T + TIMID * np.eye(len(basis)), seen @ residual[:count])
    rest = residual.copy()
    rest[:count] -= share @ basis
    return rest


def _roots(b: float, damping: float, stiffness: float) -> NDArray[np.complex128]:
    """Both roots of b s^2 + damping s + stiffness; of damping >= 0, without cancellation."""
    far = -0.5 * (damping + np.emath.sqrt(damping**2 - 4 * b * stiffness))
    return np.array([far / b, stiffness / far], dtype=np.complex128)


def _decay(step: complex, count: int) -> NDArray[np.complex128]:
    """exp(step k) for k = 0 ... count - 1, as products of coarse and fine powers."""
    fine = math.isqrt(count) + 1
    coarse = np.exp(step * fine * np.arange(count // fine + 1))
    return np.multiply.outer(coarse, np.exp(step * np.arange(fine))).ravel()[:count]
