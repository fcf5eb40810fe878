"""Whether a candidate is worth a fit."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.effects import EFFECTS
from inerter.diagnose.candidate import Candidate
from inerter.identify.fit import Fit, Problem
from inerter.identify.model import Model

Array = NDArray[np.float64]


class Promise:
    """Whether a candidate may lower the error of a model, by the residual's derivatives.

    Most candidates add a term that is nearly linear in its size. What such a one can gain is told
    by one step of Gauss and Newton from its starting points, for much less than by a fit.
    """

    def __init__(self, problem: Problem, current: Fit, limit: float) -> None:
        self.problem, self.current, self.limit = problem, current, limit

    @cached_property
    def _known(self) -> Array:
        return self.problem.jacobian(self.current.model)

    def holds(self, candidate: Candidate) -> bool:
        """False where no starting point leads below the limit [N]."""
        if EFFECTS[candidate.effect].far:
            return True
        return any(self._error_after_a_step(start) < self.limit for start in candidate.starts)

    def _error_after_a_step(self, start: Model) -> float:
        free = self.current.model.free
        added = [name for name in start.free if name not in free]
        flat = self.problem.masked(self.problem.residual(start))
        columns = np.concatenate([self._known, self.problem.jacobian(start, added)], axis=1)
        columns = columns / (np.linalg.norm(columns, axis=0) + 1e-300)
        step = np.linalg.lstsq(columns, flat, rcond=1e-10)[0]
        return float(np.sqrt(np.mean((flat - columns @ step) ** 2)))
