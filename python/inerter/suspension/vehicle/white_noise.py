"""Mean squares of a plane on a road whose velocity is white noise, later at the rear, exactly.

With x' = A x + Bf w(t) + Br w(t - tau) and white noise of unit density the covariance P solves

    A P + P A^T + Bf Bf^T + Br Br^T + E Bf Br^T + Br Bf^T E^T = 0,    E = exp(A tau):

what the rear axle feels now entered at the front tau ago, and E Bf is what the states still
remember of it. Where there is a warp, p' = w(t - tau) - w(t), the states x + A^-1 a p are free of
it; p has the variance tau, and its covariance with them is -A^-1 (E - 1) (Bf - A^-1 a).

- `mean_square`: one design, by Schur forms, with the gradient by the adjoint equation.
- `quick_mean_square`: arrays of designs, by eigenvectors: for a search, not for digits.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm, get_lapack_funcs, schur

from inerter.suspension.indices import INDICES
from inerter.suspension.vehicle.state_space import System, balanced
from inerter.suspension.vehicle.weighting import weighted

Array = NDArray[Any]

_DAMPING = 1e-10


def mean_square(
    system: System, index: str, delay: float, step: float | None = None
) -> tuple[float, Array]:
    """Mean over both axles of the mean square of an index's signal, and its gradient.

    Parameters
    ----------
    system
        One design, or along the first axis the design and then one with an imaginary `step` in
        each variable.
    index
        "J1", acceleration of the body above the axles, "J3", tyre forces, "travel", elongations of
        the struts, "pitch", "roll" angular accelerations, or one of them filtered, as "J1w".
    delay
        tau [s].
    step
        Size of the complex step; without it no gradient.

    Returns
    -------
    value, gradient
        Infinite and zero where the design is not stable, or its least damped pole has a damping
        ratio below 1e-10, which leaves the covariance no digits; and where the signal follows the
        road's velocity at once, through a tyre's damper.
    """
    system, rows, by_warp, feed = _outputs(system, index)
    # states of like size
    a, scale = balanced(_now(system.matrix, step))
    c = _now(rows, step)
    c, front, rear = c * scale, system.front / scale, system.rear / scale
    if front.ndim > 1:
        front, rear = _now(front, step), _now(rear, step)
    front, rear = np.real(front), np.real(rear)
    none = np.zeros(0 if step is None else len(system.matrix) - 1)
    if feed is not None and feed.any():
        return np.inf, none
    both: Any = schur(a)
    form, vectors = both
    if _least_damping(form) < _DAMPING:
        return np.inf, none

    # the states without the warp, and what is left of it in the signals
    z, left = np.zeros(len(a)), np.zeros(2)
    if system.warp is not None and by_warp is not None:
        z = np.linalg.solve(a, _now(system.warp, step) / scale)
        left = _now(by_warp, step) - c @ z
    front, rear = front - z, rear + z
    # kappa and L do not know of the delay
    memory = np.linalg.solve(a.T, c.T @ left)
    reach = _lyapunov(form, vectors, c.T @ c, adjoint=True)
    weight = 2.0 * (reach @ rear - memory)
    if step is None:
        kept = expm(a * delay)
        bridge = kept
    else:
        n = len(a)
        doubled = np.zeros((2 * n, 2 * n))
        doubled[:n, :n] = doubled[n:, n:] = a * delay
        doubled[:n, n:] = np.outer(front, weight)
        doubled = expm(doubled)
        kept, bridge = doubled[:n, :n], doubled[:n, n:]
    remembered = kept @ front
    noise = np.outer(front, front) + np.outer(rear, rear) + np.outer(remembered, rear)
    noise += np.outer(rear, remembered)
    covariance = _lyapunov(form, vectors, noise, adjoint=False)
    with_warp = -np.linalg.solve(a, remembered - front)
    value = 0.5 * (
        np.einsum("ki,ij,kj->", c, covariance, c) + 2.0 * left @ c @ with_warp + delay * left @ left
    )
    if step is None:
        return float(value), np.zeros(0)

    da = _change(system.matrix, step) * scale / scale[:, None]
    dc = _change(rows, step) * scale
    slope = 2.0 * np.einsum("ij,njk,ki->n", covariance @ reach, da, np.eye(len(a)))
    slope += 2.0 * np.einsum("nki,ij,kj->n", dc, covariance, c)
    slope += delay * np.einsum("ij,nji->n", bridge, da)
    at_front = 2.0 * (reach @ front + kept.T @ (reach @ rear) - kept.T @ memory + memory)
    at_rear = 2.0 * (reach @ rear + reach @ remembered)
    if system.front.ndim > 1:
        slope += _change(system.front, step) / scale @ at_front
        slope += _change(system.rear, step) / scale @ at_rear
    if system.warp is not None and by_warp is not None:
        slope -= 2.0 * np.einsum("i,nij,j->n", memory, da, with_warp)
        dz = np.linalg.solve(a, (_change(system.warp, step) / scale - da @ z).T).T
        dleft = _change(by_warp, step) - dc @ z - dz @ c.T
        slope += 2.0 * (dleft @ (c @ with_warp) + dc @ with_warp @ left)
        slope += 2.0 * delay * dleft @ left
        slope += dz @ (at_rear - at_front)
    return float(value), 0.5 * slope


def quick_mean_square(system: System, index: str, delay: float) -> Array:
    """The value of `mean_square` for arrays of real designs, to about 1e-6."""
    system, c, c_warp, feed = _outputs(system, index)
    a = system.matrix
    eigen: Any = np.linalg.eig(a)
    values, vectors = eigen
    front, rear = system.front, system.rear
    z, left = np.zeros(a.shape[:-1]), np.zeros((*a.shape[:-2], 2))
    if system.warp is not None and c_warp is not None:
        z = np.linalg.solve(a, system.warp[..., None])[..., 0]
        left = c_warp - (c @ z[..., None])[..., 0]
    columns = np.stack([front - z, rear + z], axis=-1).astype(complex)
    with np.errstate(all="ignore"):
        inputs = np.linalg.solve(vectors, columns)
        front, rear = inputs[..., 0], inputs[..., 1]
        later = np.exp(values * delay) * front
        noise = (
            _outer(front, front) + _outer(rear, rear) + _outer(later, rear) + _outer(rear, later)
        )
        covariance = -noise / (values[..., :, None] + np.conj(values[..., None, :]))
        out = c @ vectors
        total = ((out @ covariance) * np.conj(out)).sum(axis=(-2, -1)).real
        with_warp = (out @ (-(later - front) / values)[..., None])[..., 0].real
        total = total + 2.0 * (left * with_warp).sum(axis=-1) + delay * (left * left).sum(axis=-1)
        # an index of the other plane has no signal here
        good = (values.real.max(axis=-1) < 0.0) & ((total > 0.0) | ~c.any(axis=(-2, -1)))
    if feed is not None:
        good &= ~feed.any(axis=(-2, -1))
    return np.where(good, 0.5 * np.maximum(total, 0.0), np.inf)


def _outputs(system: System, index: str) -> tuple[System, Array, Array | None, Array | None]:
    """The system, with a filter's states where the index has one, its signals and their feed."""
    own = INDICES[index]
    if own.filter is None:
        return system, *signals(system, index), feed_of(system, index)
    feed = feed_of(system, own.signal)
    return weighted(system, *signals(system, own.signal), own.filter, feed)


def is_white(system: System, index: str) -> bool:
    """Whether a signal follows the road's velocity at once: its mean square is infinite."""
    feed = _outputs(system, index)[3]
    return feed is not None and bool(feed.any())


def feed_of(system: System, index: str) -> Array | None:
    """What of the roads' velocities is in a signal at once, (..., 2, 2); None without."""
    feed = system.acceleration_feed
    if feed is None or index == "travel":
        return None
    if index == "J1":
        return feed
    if index == "J3":
        assert system.tyre_feed is not None
        return system.tyre_feed
    if system.warp is None:
        row = (feed[..., 1:, :] - feed[..., :1, :]) * (system.turn if index == "pitch" else 0.0)
        return np.concatenate([row, row], axis=-2)
    return (system.turn if index == "roll" else 0.0) * feed


def signals(system: System, index: str) -> tuple[Array, Array | None]:
    """Output rows (..., 2, n) and outputs per warp (..., 2)."""
    if index == "J1":
        return system.acceleration, system.acceleration_warp
    if index in ("pitch", "roll"):
        return _turning(system, index)
    shape = system.matrix.shape[:-2]
    if index == "travel":
        rows = np.broadcast_to(system.travel, (*shape, *system.travel.shape))
        warped = np.broadcast_to(system.travel_warp, (*shape, 2))
        return rows, None if system.warp is None else warped
    rows = np.broadcast_to(system.tyre, (*shape, *system.tyre.shape))
    return rows, None if system.warp is None else np.zeros((*shape, 2))


def _turning(system: System, index: str) -> tuple[Array, Array | None]:
    """The body's angular acceleration, twice, so that the mean over the axles is its own."""
    a, warped = system.acceleration, system.acceleration_warp
    if warped is None:
        # heave and pitch
        row = (a[..., 1:, :] - a[..., :1, :]) * (system.turn if index == "pitch" else 0.0)
        return np.concatenate([row, row], axis=-2), None
    factor = system.turn if index == "roll" else 0.0
    return factor * a, factor * warped


def _now(x: Array, step: float | None) -> Array:
    return np.real(x if step is None else x[0])


def _change(x: Array, step: float) -> Array:
    return np.imag(x[1:]) / step


def _lyapunov(form: Array, vectors: Array, noise: Array, *, adjoint: bool) -> Array:
    """X of A X + X A^T + noise = 0, or of its adjoint, from the Schur form of A."""
    inner = -(vectors.T @ noise @ vectors)
    ways = ("T", "N") if adjoint else ("N", "T")
    solve: Any = get_lapack_funcs("trsyl", (form,))
    solution, scale, _ = solve(form, form, inner, trana=ways[0], tranb=ways[1])
    return vectors @ (solution / scale) @ vectors.T


def _least_damping(form: Array) -> float:
    """Damping ratio of the least damped pole, from the blocks of a real Schur form."""
    real = np.diag(form)
    squared = np.maximum(-np.diag(form, 1) * np.diag(form, -1), 0.0)
    imaginary = np.maximum(np.append(squared, 0.0), np.append(0.0, squared))
    with np.errstate(invalid="ignore"):
        return float((-real / np.sqrt(real**2 + imaginary)).min())


def _outer(x: Array, y: Array) -> Array:
    return x[..., :, None] * np.conj(y[..., None, :])
