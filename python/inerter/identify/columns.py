"""Derivatives of a problem's residual by the search variables of its model, one column each.

Most are differences. A coordinate that enters the force in proportion to a function of the motion
has that function as its column, which the model does not change: it is weighted once. Where the
device has a state, this begins where the first force puts it; a coordinate acts on that through the
share of the first force that it takes, so that one difference by the first force serves all.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.coordinates import COORDINATES, ENTANGLED, search_range
from inerter.identify.channel import clips, delayed
from inerter.identify.model import Model
from inerter.identify.runs import BenchRun

if TYPE_CHECKING:
    from inerter.identify.fit import Problem

Array = NDArray[np.float64]

# difference of a search variable, and of the first force per its size
_STEP = 1e-4
# with one of these a column is no longer that of the motion as it is
_FILTERS = ("force_filter", "displacement_filter")


class Columns:
    """Columns of one problem; what no model changes is kept."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self._kept: dict[tuple[object, ...], Array] = {}

    def __getstate__(self) -> Mapping[str, Any]:
        """What another process is told: what is kept is soon worked out again."""
        return {**self.__dict__, "_kept": {}}

    def of(
        self,
        model: Model,
        point: Array,
        names: Sequence[str],
        residual: Callable[[Array], list[Array]],
    ) -> list[Array]:
        """Derivative of the residual by each named variable, over all samples of all runs, (n,).

        `residual` gives it at a point, the variables of the model's free coordinates.
        """
        base: list[Array] = []
        by_first_force: list[Array] = []
        columns = []
        for name in names:
            if self._in_proportion(name, model):
                column = self._weighted(name, model)
                if model.device().nstate and COORDINATES[name].belongs_to == "device":
                    base = base or residual(point)
                    by_first_force = by_first_force or self._by_first_force(model, base)
                    column = column - self._taken(name, model, by_first_force)
                columns.append(column * search_range(name, self.problem.scales).size)
            else:
                base = base or residual(point)
                columns.append(self._difference(name, model, point, base, residual))
        return columns

    def _in_proportion(self, name: str, model: Model) -> bool:
        """Whether a coordinate enters the force times its column."""
        device = model.device()
        return bool(
            COORDINATES[name].column
            # a flywheel on its spring is set going by whatever acts
            and not (device.nstate and (device.series_stiffness or device.series_damping))
            and not clips(model.values)
            and not any(each in model.values for each in (*_FILTERS, *ENTANGLED.get(name, ())))
            and all(np.isinf(run.far) for run in self.problem.runs)
        )

    def _difference(
        self,
        name: str,
        model: Model,
        point: Array,
        base: Sequence[Array],
        residual: Callable[[Array], list[Array]],
    ) -> Array:
        index = model.free.index(name)
        step = _STEP
        if point[index] + step > search_range(name, self.problem.scales).bounds[1]:
            step = -step
        moved = point.copy()
        moved[index] += step
        return (np.concatenate(residual(moved)) - np.concatenate(base)) / step

    def _weighted(self, name: str, model: Model) -> Array:
        """Minus a column as it counts."""
        key = (name, model.delay, model.values.get("rest_length", 0.0))
        if key not in self._kept:
            if len(self._kept) > 4 * len(COORDINATES):
                self._kept.clear()
            columns = [
                -delayed(_column(name, model, run), model.delay, run.spacing)
                for run in self.problem.runs
            ]
            self._kept[key] = np.concatenate(self.problem.weighted(columns))
        return self._kept[key]

    def _by_first_force(self, model: Model, base: Sequence[Array]) -> list[Array]:
        """Derivative of the residual by the first force, of every run."""
        step = _STEP * self.problem.scales.force
        there = self.problem.residual(model, step)
        return [(each - here) / step for each, here in zip(there, base, strict=True)]

    def _taken(self, name: str, model: Model, by_first_force: Sequence[Array]) -> Array:
        """What a coordinate does by the share of each run's first force that it takes."""
        runs = self.problem.runs
        shares = [float(_column(name, model, run)[run.first]) for run in runs]
        pairs = zip(shares, by_first_force, strict=True)
        return np.concatenate([share * column for share, column in pairs])


def _column(name: str, model: Model, run: BenchRun) -> Array:
    column = COORDINATES[name].column
    if column is None:
        raise ValueError(f"{name} does not enter the force in proportion")
    stretch = run.displacement - model.values.get("rest_length", 0.0)
    return column(stretch, run.velocity, run.acceleration, run.elapsed)
