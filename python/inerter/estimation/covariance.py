"""Of residuals: what counts how much, and what their correlation does to an estimate."""

from __future__ import annotations

from collections.abc import Sequence

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


# shares of the information along any direction that one block counts as having at most: what one
# block alone tells no other can contradict
_MOST_LEVERAGE = 0.9
# blocks from which on their neighbours tell of a memory
_FEWEST = 30


def sandwich(
    jacobian: Array,
    residual: Array,
    weight: Array,
    held: Array | None = None,
    left_out: bool = False,
) -> Array:
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
    left_out : bool
        Take each block's residuals as a fit without the block would leave them, a jackknife
        (MacKinnon and White 1985; Bell and McCaffrey 2002). A fit draws what it leaves towards
        itself, most where few blocks tell something, and two standard errors hold in 91 % of short
        records in the place of 95 %. It takes longer. What neighbouring blocks have in common
        counts, too: what no effect explains often lasts longer than a block.
    """
    blocks = np.array_split(np.arange(residual.size), min(60, max(residual.size // 20, 2)))
    weighted = weight * residual
    scores = np.array([jacobian[block].T @ weighted[block] for block in blocks])
    information = jacobian.T @ (weight[:, None] * jacobian)
    prior = np.zeros_like(information) if held is None else held.T @ held
    count = len(blocks)
    bread = np.asarray(np.linalg.pinv(information + prior), dtype=np.float64)
    if left_out:
        roots = np.sqrt(weight)[:, None] * jacobian
        scores = _without_own(scores, [roots[block] for block in blocks], bread)
        spread = scores.T @ scores * (count - 1) / count
    else:
        spread = scores.T @ scores * count / max(count - 1, 1)
    if held is not None:
        spread = spread + np.mean(weighted**2) * prior
    covariance = bread @ spread @ bread
    if left_out:
        longer = _of_neighbours(scores @ bread)
        covariance *= np.outer(longer, longer)
    return covariance


def _of_neighbours(moved: Array) -> Array:
    """Factors (p,) on standard errors, at least 1, for blocks that move an estimate alike.

    moved: by how much each block moves each parameter (blocks, p). The variance of their sum is
    that of a series with a memory (Newey and West 1987, with the bandwidth of Andrews 1991).
    """
    count = len(moved)
    if count < _FEWEST:
        return np.ones(moved.shape[1])
    apart = moved - moved.mean(axis=0)
    own = np.sum(apart**2, axis=0) + 1e-300
    near = np.clip(np.sum(apart[1:] * apart[:-1], axis=0) / own, -0.97, 0.97)
    wide = 1.1447 * (4.0 * near**2 / (1.0 - near**2) ** 2 * count) ** (1.0 / 3.0)
    reach = np.minimum(np.floor(wide), count // 4)
    ratio = np.ones(moved.shape[1])
    for lag in range(1, int(reach.max(initial=0.0)) + 1):
        share = np.clip(1.0 - lag / (reach + 1.0), 0.0, None)
        ratio += 2.0 * share * np.sum(apart[lag:] * apart[:-lag], axis=0) / own
    return np.sqrt(np.maximum(ratio, 1.0))


def _without_own(scores: Array, blocks: Sequence[Array], bread: Array) -> Array:
    """Scores (blocks, p) as the residuals of fits without each block make them.

    blocks: weighted derivatives (m, p) of each; bread: inverse of the information of all (p, p).
    """
    sizes, directions = np.linalg.eigh(bread)
    known = sizes > 1e-14 * sizes[-1]
    roots = np.sqrt(sizes[known])
    there, back = directions[:, known] * roots, directions[:, known] / roots
    found = []
    for score, rows in zip(scores, blocks, strict=True):
        shares, turns = np.linalg.eigh((rows @ there).T @ (rows @ there))
        shares = np.clip(shares, 0.0, _MOST_LEVERAGE)
        found.append(back @ (turns @ ((turns.T @ (there.T @ score)) / (1 - shares))))
    return np.array(found)
