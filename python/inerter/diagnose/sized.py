"""Starting points at which what is added is as large as the residual asks for.

A damping that bends, a friction law or a gas has no size of its own before it is fitted. Begun as
large as the force, it is far above a residual of some per cent, and the fit spends its evaluations
on the way down. The force of each is in proportion to one coordinate: how large that is best, with
what is in the model already free, is told by one prediction.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.effects import EFFECTS
from inerter.catalogue.friction import FRICTION
from inerter.diagnose.candidate import Candidate
from inerter.diagnose.promise import Known
from inerter.identify.fit import Problem
from inerter.identify.model import Model

Array = NDArray[np.float64]

# what the force of an added effect is in proportion to; of a friction law its level is, too
_SIZES = ("gas_push", "stop_stiffness", *EFFECTS["viscoelasticity"].amplitudes)
# what comes with a damping of its own
_OF_DAMPERS = {n for each in EFFECTS.values() if each.kind == "damper" for n in each.coordinates}
# share of the size given that a start has at least and at most; choices: what has the other sign
# begins small, and not at none, where its shape has no derivative
_LEAST, _MOST = 0.02, 2.0


class Sized:
    """Candidates on top of a fitted model, each of their starting points with its best size."""

    def __init__(self, problem: Problem, known: Known) -> None:
        self.problem, self.known = problem, known

    def of(self, candidate: Candidate) -> Candidate:
        """The candidate with such starting points."""
        return replace(candidate, starts=tuple(map(self._sized, candidate.starts)))

    def _sized(self, start: Model) -> Model:
        names = self._sizes(start)
        if not names:
            return start
        added = self._beside(self.problem.masked(self.problem.residual(start)) - self._residual)
        size = float(added @ added)
        if not np.isfinite(size) or size == 0.0:
            return start
        share = float(np.clip(-(added @ self._left) / size, _LEAST, _MOST))
        return start.holding(**{name: share * start.values[name] for name in names})

    def _sizes(self, start: Model) -> list[str]:
        """Coordinates of a starting point that what it adds is in proportion to together."""
        model = self.known.model
        new = [name for name in start.free if name not in model.values]
        names = [name for name in _SIZES if name in new]
        if "viscous" in new and not _OF_DAMPERS.isdisjoint(new):
            names.append("viscous")
        if model.friction == "none" and start.friction != "none":
            level = FRICTION[start.friction].level
            names += [name for name in (level, "static_excess") if name in new]
        return names

    @cached_property
    def _residual(self) -> Array:
        return self.problem.masked(self.problem.residual(self.known.model))

    @cached_property
    def _directions(self) -> Array:
        """An orthonormal basis of what the model can do by itself, (n, p)."""
        return np.linalg.qr(self.known.columns[np.concatenate(self.problem.masks)])[0]

    @cached_property
    def _left(self) -> Array:
        return self._beside(self._residual)

    def _beside(self, values: Array) -> Array:
        """What the model cannot take of some values."""
        return values - self._directions @ (self._directions.T @ values)
