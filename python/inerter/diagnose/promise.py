"""Whether a candidate is worth a fit."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.effects import EFFECTS
from inerter.diagnose.candidate import Candidate
from inerter.identify.apart import Basis
from inerter.identify.beside import fit_beside
from inerter.identify.fit import Near, Problem
from inerter.identify.model import Model
from inerter.identify.smoothness import smoothness

Array = NDArray[np.float64]

# coordinates that a candidate adds at most for a search over them alone
MOST_NEW = 8


class Known:
    """Derivatives of a problem's residual at a model, which candidates on top of it begin with."""

    def __init__(self, problem: Problem, model: Model) -> None:
        self.problem, self.model = problem, model
        self._bases: dict[tuple[object, ...], Basis] = {}

    def __getstate__(self) -> dict[str, object]:
        """What another process is told: bases are soon worked out again."""
        return {**self.__dict__, "_bases": {}}

    @cached_property
    def columns(self) -> Array:
        """By the model's free coordinates, over all samples, (n, p)."""
        return self.problem.derivatives(self.model, counted=True)

    def _rows(self, problem: Problem) -> NDArray[np.intp]:
        """Which of the samples a problem has that may have the first parts of the runs."""
        sizes = [run.force.size for run in self.problem.runs]
        begins = np.cumsum([0, *sizes[:-1]])
        pairs = zip(begins, problem.runs, strict=True)
        return np.concatenate([begin + np.arange(run.force.size) for begin, run in pairs])

    def beside(
        self, problem: Problem, start: Model, evaluations: int, tolerance: float
    ) -> Model | None:
        """A fit of what a start adds to the model, all else following as is known here.

        The problem may have the first parts of the runs. None where much is new, where what is not
        new is not as it was, or where no force is finite. Of another friction law than the model's
        all but its level along the stroke is new.
        """
        common = tuple(name for name in start.free if name in self.model.free)
        same = all(start.values[name] == self.model.values[name] for name in common)
        new = len(start.free) - len(common)
        if not same or not common or new > MOST_NEW:
            return None
        # what holds a curve counts too
        smooth = smoothness(start)[:, [start.free.index(name) for name in common]]
        key = (id(problem), common, smooth.tobytes())
        if key not in self._bases:
            rows = self._rows(problem)[np.concatenate(problem.masks)]
            known = [self.model.free.index(name) for name in common]
            self._bases[key] = Basis.of(
                np.concatenate([self.columns[rows][:, known] / problem.scales.force, smooth])
            )
        basis = self._bases[key]
        return fit_beside(problem, start, common, basis, evaluations, tolerance)

    def near(self, problem: Problem, start: Model, loosely: bool = False) -> Near | None:
        """Derivatives of a problem near a start that adds to the model; None of another one.

        The problem may have the first parts of the runs. Loosely also of a start that has come some
        way from the model, or whose friction law is another: what is not known is worked out.
        """
        common = [name for name in start.free if name in self.model.free]
        same = all(start.values.get(name) == self.model.values[name] for name in self.model.free)
        adds = start.friction == self.model.friction and len(common) == len(self.model.free)
        if not (loosely or (same and adds)):
            return None
        added = tuple(name for name in start.free if name not in common)
        columns = np.empty((sum(run.force.size for run in problem.runs), len(start.free)))
        known = [self.model.free.index(name) for name in common]
        rows = self.columns[self._rows(problem)]
        columns[:, [start.free.index(name) for name in common]] = rows[:, known]
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
