"""Derivatives of the force by the nodes of a friction curve: two differences for all of them.

A law with memory remembers the level at the places that it slid through a moment ago. What one of
a node does to the force is therefore what one of all nodes does, g(t), times the node's share of
the curve at the place that is remembered, x'(t):

    dF / dnode_i = g(t) phi_i(x'(t))

One difference with all nodes raised alike gives g. One with nodes raised as they lie along the
curve, psi(x) = sum_i place_i phi_i(x), gives h = g psi(x'), and so x' = psi^-1(h / g). That is
exact for a law without memory, and to second order in memory over distance of nodes else.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.along_stroke import QUANTITIES, curves_of_nodes
from inerter.catalogue.friction import FRICTION
from inerter.identify.channel import clips
from inerter.identify.model import Model
from inerter.identify.prediction import begin, with_late_motion
from inerter.identify.runs import BenchRun, forces_along

Array = NDArray[np.float64]

_FRICTION = next(quantity for quantity in QUANTITIES if quantity.name == "friction")
# relative rise of the level, and share of the largest response below which it is none
_STEP, _NONE = 1e-4, 1e-6
# points at which a curve is looked up
_POINTS = 4000


def nodes_of(names: Sequence[str], model: Model) -> list[str]:
    """Those of some coordinates that are nodes of a friction curve and may be told like this."""
    if (
        not FRICTION[model.friction].varies
        or clips(model.values)
        or model.values.get("friction_drift")
        or model.has_series
    ):
        return []
    known = set(_FRICTION.nodes)
    return [name for name in names if name in known]


class Response:
    """What a rise of a run's friction level does to the friction force."""

    def __init__(self, model: Model, run: BenchRun) -> None:
        nodes = [name for name in _FRICTION.nodes if name in model.values]
        lower, upper = model.values["curve_lower"], model.values["curve_upper"]
        grid = np.linspace(lower, upper, _POINTS)
        self._curves = _curves(lower, upper, len(nodes))
        run, shown = with_late_motion(model, run)
        fine = run.measured is not None and np.isfinite(run.cutoff)

        def friction(rise: Array) -> Array:
            values = {n: model.values[n] + r for n, r in zip(nodes, rise.tolist(), strict=True)}
            device = replace(model, values={**model.values, **values}).device()
            state = begin(device, run, shown)
            if fine:
                return run.at_measured_rate(device, state)["friction"]
            along = forces_along(device, run.spacing, run.followed, state, run.force.size)
            return along["friction"]

        places = np.linspace(-1.0, 1.0, len(nodes))
        was = friction(np.zeros(len(nodes)))
        self.alike = (friction(np.full(len(nodes), _STEP)) - was) / _STEP
        tilted = (friction(_STEP * places) - was) / _STEP
        told = np.abs(self.alike) > _NONE * np.max(np.abs(self.alike), initial=0.0)
        share = np.divide(tilted, self.alike, out=np.zeros_like(tilted), where=told)
        displacement = run.measured[0] if fine and run.measured else run.displacement
        along = np.maximum.accumulate(places @ self._curves)
        place = np.where(told, np.interp(share, along, grid), displacement)
        # between two points of the grid
        self._numbers = {name: i for i, name in enumerate(nodes)}
        steps = (place.clip(lower, upper) - lower) / (grid[1] - grid[0])
        self._before = np.minimum(steps.astype(int), _POINTS - 2)
        self._beyond = steps - self._before

    def of(self, name: str) -> Array:
        """Derivative of the friction force by a node, shape (m,)."""
        curve = self._curves[self._numbers[name]]
        here = curve[self._before]
        return self.alike * (here + self._beyond * (curve[self._before + 1] - here))


@lru_cache(maxsize=8)
def _curves(lower: float, upper: float, nodes: int) -> Array:
    """The curves of nodes on a grid of places, (nodes, points)."""
    grid = np.linspace(lower, upper, _POINTS)
    return np.ascontiguousarray(curves_of_nodes(lower, upper, nodes)(grid).T)
