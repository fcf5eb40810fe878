"""What unknown first states of series element, branches and bristle leave in a residual: decays."""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from inerter.core import Device

Array = NDArray[np.float64]


# squared rms residual per squared size that a transient is expected to have
TIMID = 1e-2
RELAXING = ("branch_time_1", "branch_time_2", "branch_time_3")
"""Coordinates that say how long branches relax."""
SETTLING = ("settling_time", "force_coupling")
"""Coordinates that say how long what the channel held before dies away."""
# how fast a flywheel may have turned as a record began, in largest speeds of the record
MOST_SPEEDS = 5.0
MOST_STROKES = 10.0
"""Strokes of a record by which a branch or a shaft may have been bent as it began."""
# exponent of a decay that leaves nothing
_DECAYED = 60.0
# lengths of a bristle's decay along which it is followed
_FORGOTTEN = 15.0
# lengths of a decay after which its rest tells nothing of its beginning (twice as many: nothing at
# all), and how far that goes where it tells itself
_TOLD, _BEGINNING = 2.0, 4.0
# samples of the quickest decay that is one, and its length in periods of a low-pass: one of more is
# hardly changed by that
_FEWEST, _PERIODS = 3, 0.5


def swings_freely(device: Device) -> bool:
    """Whether a flywheel is set going by whatever acts, and goes on by a linear equation.

    That is on a spring in series, behind a laminar leak, or behind both.
    """
    if device.backlash or device.clutch_force or device.leak_quadratic_damping:
        return False
    return bool(device.series_stiffness or device.leak_damping)


def without_transient(
    device: Device,
    residual: Array,
    spacing: float,
    mask: NDArray[np.bool_],
    speed: float = np.inf,
    first: int = 0,
) -> Array:
    """A residual without the decay of the series element's unknown first state, shape (n,).

    Nobody measures how fast the flywheel turns as a record begins. What that leaves is a decaying
    oscillation, exp(lambda t) with b lambda^2 + (c_s + c_w) lambda + k_s = 0, behind a leak alone
    lambda = -(c_l + c_w) / b, behind both see `_roots_of`; the share of the
    masked samples that has this form is taken out. Its size at the beginning is held near what the
    residual is large, for its faint rest tells nothing of it: where nothing is masked before it is
    that faint, the beginning from the sample `first` on tells it itself. Nor is
    it more than a flywheel carries that turned some times faster than the record's largest `speed`
    [m/s]: hardly any inertance has no such oscillation.
    """
    b = device.inertance
    damping = device.series_damping + device.flywheel_viscous + device.leak_damping
    stiffness = device.series_stiffness
    roots = _roots_of(device)
    if np.count_nonzero(mask) < 4 or not np.isfinite(roots).all():
        return residual
    # what is below rounding by then has no share
    slowest, weights = float(np.max(roots.real)) * spacing, mask.astype(np.float64)
    if slowest < 0:
        weights = _with_beginning(mask, -slowest * _since(first, mask.size), first)
    count = residual.size if slowest >= 0 else min(residual.size, int(_DECAYED / -slowest) + 2)
    with np.errstate(under="ignore"):
        if abs(roots[0].imag) > 0:
            wave = _decay(roots[0] * spacing, count)
            basis = np.array([wave.real, wave.imag])
        else:
            basis = np.array([_decay(root * spacing, count).real for root in roots])
    return _without(
        basis, residual, weights, MOST_SPEEDS * speed * (math.sqrt(b * stiffness) + damping)
    )


def relaxing(values: Mapping[str, float]) -> tuple[float, ...]:
    """Times [s] in which the branches of some coordinates relax, and the channel settles."""
    times = [values[name] for name in RELAXING if name in values]
    if "settling_time" in values:
        times.append(values["settling_time"])
    if "force_coupling" in values:
        times.append(1.0 / (2.0 * math.pi * values["force_coupling"]))
    return tuple(times)


def most_bent(values: Mapping[str, float], travel: float) -> tuple[float, ...]:
    """Forces [N] of these branches if they were bent by some strokes as a record began.

    Of a channel that settles any.
    """
    names = [name.replace("time", "stiffness") for name in RELAXING if name in values]
    settling = [math.inf for name in SETTLING if name in values]
    return (*(MOST_STROKES * travel * values[name] for name in names), *settling)


def without_relaxing(
    times: Sequence[float],
    residual: Array,
    spacing: float,
    mask: NDArray[np.bool_],
    first: int = 0,
    cutoff: float = np.inf,
    most: Sequence[float] = (),
) -> Array:
    """A residual without what branches were bent by as a record began, shape (..., n).

    A branch that was bent before goes on to relax, exp(-t / time) from the sample `first` on; the
    share of the masked samples that has this form is taken out, as above. Not of branches so quick
    that a low-pass of this `cutoff` [Hz] makes another form of it, and steadily less towards them.
    Of each branch `most` [N] at most, where that is given.
    """
    shortest = max(_PERIODS / cutoff, _FEWEST * spacing)
    limits = [limit for limit, time in zip(most, times, strict=False) if time > shortest]
    times = [time for time in times if time > shortest]
    count = min(residual.shape[-1] - first, int(_DECAYED * max(times, default=0.0) / spacing) + 1)
    if not times or np.count_nonzero(mask) < 4 or count < 1:
        return residual
    basis, share = _relaxing(tuple(times), spacing, first, first + count, mask.tobytes())
    slow = np.clip(2.0 * (np.array(times) / shortest - 1.0), 0.0, 1.0)
    sizes = slow * (residual[..., : first + count] @ share.T)
    if limits:
        sizes = np.clip(sizes, -np.array(limits), limits)
    rest = residual.copy()
    rest[..., : first + count] -= sizes @ basis
    return rest


# asked for once for each column of a fit, at the same times
@functools.lru_cache(maxsize=16)
def _relaxing(
    times: tuple[float, ...], spacing: float, first: int, count: int, masked: bytes
) -> tuple[Array, Array]:
    """Decays (m, count) of branches, and what tells their sizes of a residual's beginning."""
    mask = np.frombuffer(masked, dtype=np.bool_)
    decayed = spacing / max(times) * _since(first, mask.size)
    weights = _with_beginning(mask, decayed, first)[:count]
    basis = np.ones((len(times), count))
    with np.errstate(under="ignore"):
        for row, time in zip(basis, times, strict=True):
            row[first:] = _decay(-spacing / time, count - first).real
    return basis, _share(basis, weights)


def _since(first: int, count: int) -> Array:
    """Samples since the `first`, (count,); 0 before."""
    return np.maximum(np.arange(count, dtype=np.float64) - first, 0.0)


def _with_beginning(mask: NDArray[np.bool_], decayed: Array, first: int = 0) -> Array:
    """Weights of masked samples, and of those from the `first` on where none of these is near it.

    decayed: lengths of a decay that have gone by at each sample, (n,). What is left out of a fit
    has a beginning of its own, which nothing else tells. Its weight follows the length steadily: a
    jump of it would be the end of a search.
    """
    weights = mask.astype(np.float64)
    seen = np.flatnonzero(mask[first:])
    nearest = float(decayed[first + seen[0]]) if seen.size else np.inf
    share = min(max((nearest - _TOLD) / _TOLD, 0.0), 1.0)
    if share:
        own = share * np.clip(_BEGINNING - decayed[first:], 0.0, 1.0)
        weights[first:] = np.maximum(weights[first:], own)
    return weights


def without_bending(
    path: Array, reach: float, residual: Array, mask: NDArray[np.bool_], first: int = 0
) -> Array:
    """A residual without what a bristle was bent by as a record began, shape (..., n).

    The first force tells it within the noise of the motion alone. What is wrong of it dies away
    along the path slid since the sample `first` [m], shape (n,), as exp(-path / reach).
    """
    decay, share = bending(path, reach, mask, first)
    if not decay.size:
        return residual
    rest = residual.copy()
    rest[..., : decay.size] -= (residual[..., : decay.size] @ share)[..., None] * decay
    return rest


def bending(
    path: Array, reach: float, mask: NDArray[np.bool_], first: int = 0
) -> tuple[Array, Array]:
    """That decay, as long as it is something, and what tells its size of a residual's beginning.

    Both (k,) with k = 0 where there is none.
    """
    count = int(np.searchsorted(path, _FORGOTTEN * reach)) if reach > 0 else 0
    weights = _with_beginning(mask, path / reach, first)[:count] if count else np.zeros(0)
    if np.count_nonzero(weights) < 4:
        return np.zeros(0), np.zeros(0)
    with np.errstate(under="ignore"):
        decay = np.exp(-path[:count] / reach)
    seen = decay * weights
    return decay, seen / (seen @ decay + TIMID)


def _without(basis: Array, residual: Array, weights: Array, most: float = np.inf) -> Array:
    """A residual (n,) without the share of its weighted samples that a basis (m, k <= n) has.

    Of that `most` [N] at most, where the basis is largest.
    """
    basis = basis / (np.max(np.abs(basis), axis=1, keepdims=True) + 1e-300)
    if not np.isfinite(basis).all():
        return residual
    count = basis.shape[1]
    rest, form = residual.copy(), (_share(basis, weights[:count]) @ residual[:count]) @ basis
    largest = float(np.max(np.abs(form)))
    rest[:count] -= form if largest <= most else most / largest * form
    return rest


def _share(basis: Array, weights: Array) -> Array:
    """What tells the shares of a basis (m, k) of weighted values (k,), (m, k)."""
    # normal equations do: what holds the size back keeps them well conditioned
    seen = basis * weights
    found = np.linalg.solve(seen @ basis.T + TIMID * np.eye(len(basis)), seen)
    return np.asarray(found, dtype=np.float64)


def _roots_of(device: Device) -> NDArray[np.complex128]:
    """Rates lambda [1/s] at which a flywheel goes on that nothing drives.

    Behind a spring and a leak F g = k d + c_s (v - w), g = 1 + c_s / c_l, d' = v - w - F / c_l and
    b w' = F - c_w w.
    """
    b, c, own = device.inertance, device.series_damping, device.flywheel_viscous
    stiffness, leak = device.series_stiffness, device.leak_damping
    if not stiffness:
        return np.array([-(c + own + leak) / b], dtype=np.complex128)
    if not leak:
        return _roots(b, c + own, stiffness)
    g = 1.0 + c / leak
    relaxing, dragged = stiffness / (g * leak), (c / g + own) / b
    turning = (1.0 - c / (g * leak)) * stiffness / (g * b)
    return _roots(1.0, relaxing + dragged, relaxing * dragged + turning)


def _roots(b: float, damping: float, stiffness: float) -> NDArray[np.complex128]:
    """Both roots of b s^2 + damping s + stiffness; of damping >= 0, without cancellation."""
    far = -0.5 * (damping + np.emath.sqrt(damping**2 - 4 * b * stiffness))
    return np.array([far / b, stiffness / far], dtype=np.complex128)


def _decay(step: complex, count: int) -> NDArray[np.complex128]:
    """exp(step k) for k = 0 ... count - 1, as products of coarse and fine powers."""
    fine = math.isqrt(count) + 1
    coarse = np.exp(step * fine * np.arange(count // fine + 1))
    return np.multiply.outer(coarse, np.exp(step * np.arange(fine))).ravel()[:count]
