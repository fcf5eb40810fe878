"""How surely one model of a vehicle is better than another, on samples that it was not fitted to.

Residuals are those of `DrivenProblem.stacked`: rows by run, sample, then output.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.vehicle import KNOWN
from inerter.diagnose.decision import CRITERIA
from inerter.diagnose.statistics import APART, advantage
from inerter.diagnose.vehicle.problem import DrivenProblem, VehicleFit

Array = NDArray[np.float64]
Rows = NDArray[np.intp]

BLOCKS = 48
FOLDS = 4


def won(
    problem: DrivenProblem,
    simple: Array,
    rich: Array,
    effect: str,
    least: float = CRITERIA.local_gain,
) -> float:
    """`statistics.advantage` of two residuals, over the stretches where an effect may show.

    Over blocks of everything most say nothing of what shows in few places, such as a wheel that
    leaves the road, and their spread would count as doubt. There it has to take away at least a
    share of what is missed.
    """
    local = effect in KNOWN and KNOWN[effect].local
    blocks = stacked_blocks(problem, _where_apart(problem, simple - rich) if local else None)
    before, after = block_squares(simple, blocks), block_squares(rich, blocks)
    if local and not after.sum() < (1 - least) ** 2 * before.sum():
        return 0.0
    return advantage(before, after) if len(blocks) > 1 else 0.0


def _where_apart(problem: DrivenProblem, apart: Array) -> list[NDArray[np.bool_]]:
    """Samples of every run at which two residuals lie apart."""
    outputs, found, offset = len(problem.channels), [], 0
    sizes = []
    for mask in problem.masks:
        end = offset + outputs * mask.size
        sizes.append(np.linalg.norm(apart[offset:end].reshape(-1, outputs), axis=1))
        offset = end
    square = sum(float(np.sum(s[m] ** 2)) for s, m in zip(sizes, problem.masks, strict=True))
    limit = APART * np.sqrt(square / max(problem.count, 1))
    for size, mask in zip(sizes, problem.masks, strict=True):
        found.append(mask & (size > limit))
    return found


def stacked_blocks(
    problem: DrivenProblem, masks: Sequence[NDArray[np.bool_]] | None = None
) -> list[Rows]:
    """Rows of stretches of consecutive samples, about `BLOCKS` of them; by default of all."""
    masks = problem.masks if masks is None else masks
    length = max(sum(int(mask.sum()) for mask in masks) // BLOCKS, 8)
    outputs = len(problem.channels)
    found, offset = [], 0
    for mask in masks:
        index = np.flatnonzero(mask)
        if index.size:
            for part in np.array_split(index, max(1, round(index.size / length))):
                rows = offset + outputs * part[:, None] + np.arange(outputs)
                found.append(rows.ravel())
        offset += outputs * mask.size
    return found


def block_squares(residual: Array, blocks: Sequence[Rows]) -> Array:
    """Sum of squares over each block."""
    return np.array([float(np.sum(residual[rows] ** 2)) for rows in blocks])


def left_out(fit: VehicleFit, blocks: Sequence[Rows]) -> Array:
    """Residual of every sample under a fit that has not seen its fold (one linear step)."""
    residual, jacobian = fit.residual.copy(), fit.jacobian
    if not jacobian.shape[1]:
        return residual
    normal, gradient = jacobian.T @ jacobian, jacobian.T @ fit.residual
    for first in range(FOLDS):
        if len(blocks) <= first:
            continue
        rows = np.concatenate(blocks[first::FOLDS])
        own = jacobian[rows]
        inverse = np.linalg.pinv(normal - own.T @ own, rcond=1e-10)
        step = -inverse @ (gradient - own.T @ fit.residual[rows])
        residual[rows] += own @ step
    return residual
