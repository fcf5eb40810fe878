"""What ends a search, and where it ended."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Bounds = tuple[Array, Array]


class NotFiniteError(ValueError):
    """A residual is not finite where a search starts."""


@dataclass(frozen=True)
class Tolerances:
    """What ends a search: relative change of the point and of the cost, size of the gradient."""

    point: float = 1e-8
    cost: float = 1e-8
    gradient: float = 1e-10


@dataclass(frozen=True, kw_only=True)
class Solution:
    """Where a search ended.

    Attributes
    ----------
    variables, residual, jacobian
        The point (p,), the residual there (n,) and its derivatives (n, p).
    cost
        Half the sum of what counts of the squared residuals.
    evaluations
        How often the residual was asked for.
    ended
        Whether no step lowered the cost any more, in place of too many.
    """

    variables: Array
    residual: Array
    jacobian: Array
    cost: float
    evaluations: int
    ended: bool

    @property
    def squares(self) -> float:
        """Sum of the squared residuals."""
        return float(np.sum(self.residual**2))
