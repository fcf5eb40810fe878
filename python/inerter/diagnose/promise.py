"""Whether a candidate is worth a fit."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.effects import EFFECTS
from inerter.diagnose.candidate import Candidate
from inerter.identify.fit import Near, Problem
from inerter.identify.model import Model

Array = NDArray[np.float64]


class Known:
    """Derivatives of a problem's residual at a model, which candidates on top of it begin with."""

    def __init__(self, problem: Problem, model: Model) -> None:
        self.problem, self.model = problem, model

    @cached_property
    def columns(self) -> Array:
        """By the model's free coordinates, over all samples, (n, p)."""
        return self.problem.derivatives(self.model, counted=True)

    def near(self, problem: Problem, start: Model) -> Near | None:
        """Derivatives of a problem near a start that adds to the model; None of another one.

        The problem may have the first parts of the runs.
        """
        same = all(start.values.get(name) == self.model.values[name] for name in self.model.free)
        if start.friction != self.model.friction or not set(self.model.free) <= set(start.free):
            return None
        if not same:
            return None
        sizes = [run.force.size for run in self.problem.runs]
        begins = np.cumsum([0, *sizes[:-1]])
        pairs = zip(begins, problem.runs, strict=True)
        rows = np.concatenate([begin + np.arange(run.force.size) for begin, run in pairs])
        added = tuple(name for name in start.free if name not in self.model.free)
        columns = np.empty((rows.size, len(start.free)))
        columns[:, [start.free.index(name) for name in self.model.free]] = self.columns[rows]
        columns[:, [start.free.index(name) for name in added]] = problem.derivatives(
            start, added, counted=True
        )
        return Near(columns, added)


class Promise:
    """To which error a candidate may lower that of a model, by the residual's derivatives.

    Most candidates add a term that is nearly linear in its size. What such a one can gain is told
    by one step of Gauss and Newton from its starting points, for much less than by a fit.
    """

    def __init__(self, problem: Problem, known: Known) -> None:
        self.problem, self.known = problem, known

    def foretold(self, candidate: Candidate) -> float:
        """The least error [N] after a step from a starting point; 0 of what no step tells.

        Infinite where no starting point has a force that is finite.
        """
        if EFFECTS[candidate.effect].far:
            return 0.0
        return min(map(self._error_after_a_step, candidate.starts))

    def _error_after_a_step(self, start: Model) -> float:
        added = [name for name in start.free if name not in self.known.model.free]
        flat = self.problem.masked(self.problem.residual(start))
        if not np.isfinite(flat).all():
            return np.inf
        known = self.known.columns[np.concatenate(self.problem.masks)]
        columns = np.concatenate([known, self.problem.jacobian(start, added)], axis=1)
        if not np.isfinite(columns).all():
            return np.inf
        columns = columns / (np.linalg.norm(columns, axis=0) + 1e-300)
        step = np.linalg.lstsq(columns, flat, rcond=1e-10)[0]
        return float(np.sqrt(np.mean((flat - columns @ step) ** 2)))
