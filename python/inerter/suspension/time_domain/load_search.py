"""J5 for a search: exact linear gains, corrected around a design; see `search.py`."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from inerter.suspension.layouts import SeriesPair
from inerter.suspension.time_domain.car_model import CarModel
from inerter.suspension.time_domain.design import Design
from inerter.suspension.time_domain.design_space import Space, each_or_one_by_one
from inerter.suspension.time_domain.linear import linear_gains
from inerter.suspension.time_domain.load_peaks import CLOSE, SWEEP, load_peaks, vertex
from inerter.suspension.time_domain.plan import Plan
from inerter.suspension.time_domain.quadratic import fitted, stencil_of, terms_of
from inerter.suspension.time_domain.simulate import load_gains
from inerter.suspension.time_domain.stepping import StepError

Array = NDArray[np.float64]
Values = Callable[[Array], Array]

# frequencies of the correction, and beside each peak; points of the corrected gain
_NODES, _AROUND, _FINE = 15, (0.96, 1.0, 1.04), 400
# how far below the highest peak a gain still counts (logarithm)
_DEPTH = 0.3
# distance of the points around an expected peak, per size of the box
_NET = 0.1


@dataclass(kw_only=True)
class LoadSearch:
    """J5: the same over all frequencies. Peaks are simulated where the correction expects them."""

    plan: Plan
    model: CarModel
    space: Space
    base: SeriesPair | None
    tops: dict[bytes, tuple[float, ...]] = field(default_factory=dict)
    gains: Callable[[Array], tuple[Array, Array]] | None = None

    @property
    def rest(self) -> float:
        """The gain at rest [m/N], 0 where that is not known."""
        return self.model.static_compliance(self.space.start) or 0.0

    def start(self, point: Array) -> float:
        """J5 of the first design, with its peaks."""
        design = self.space.design(point)
        try:
            (found,) = load_peaks(self.model, [design], self.plan.amplitude, self.plan.settings)
        except StepError:
            return math.inf
        self.tops[point.tobytes()] = tuple(f for f, _ in found.peaks if f > 0.0)
        return found.value

    def value(self, point: Array, size: float) -> float:
        """J5 of a design, simulated around its expected peaks and at both ends.

        The larger the box, the less is known of where the peaks are.
        """
        assert self.gains is not None
        f, (level,) = self.gains(point[None])
        inner = (level[1:-1] >= level[:-2]) & (level[1:-1] > level[2:])
        tops = f[1:-1][inner]
        net = 1.0 + max(CLOSE, _NET * size) * np.arange(-2.0, 3.0)
        close = np.multiply.outer(tops, net)
        asked = np.concatenate([f[[0, -1]], close.ravel()])
        found = np.exp(self._simulated(point[None], asked)[0])
        if not np.isfinite(found).all():
            return math.inf
        each = [vertex(*pair) for pair in zip(close, found[2:].reshape(-1, 5), strict=True)]
        self.tops[point.tobytes()] = tuple(at for at, _ in each)
        return max([self.rest, *found[:2].tolist(), *(gain for _, gain in each)])

    def around(self, middle: Array, size: float) -> Values | None:
        """The corrected logarithm of J5 within a box."""
        f = self._frequencies(middle, size)
        stencil = stencil_of(middle.size)
        points = middle + size * stencil
        fit = fitted(stencil, self._simulated(points, f) - self._linear(points, f))
        if fit is None:
            return None
        fine = np.geomspace(f[0], f[-1], _FINE)
        spread = CubicSpline(np.log(f), fit, axis=1)(np.log(fine))

        def corrected(x: Array) -> tuple[Array, Array]:
            return fine, self._linear(x, fine) + terms_of((x - middle) / size) @ spread

        self.gains = corrected
        least = math.log(self.rest) if self.rest else -math.inf
        return lambda x: np.maximum(corrected(x)[1].max(axis=1), least)

    def _frequencies(self, middle: Array, size: float) -> Array:
        """Where the correction is simulated [Hz]: widely, closely at the peaks, not far below."""
        nodes = np.append(SWEEP[0], np.geomspace(2.0 * SWEEP[0], SWEEP[1], _NODES))
        close = np.ravel(np.multiply.outer(self.tops.get(middle.tobytes(), ()), _AROUND))
        close = np.unique(close[(close > SWEEP[0]) & (close < SWEEP[1])])
        far = np.array([bool(np.all(np.abs(close / f - 1.0) > 0.03)) for f in nodes])
        f = np.sort(np.concatenate([nodes[far], close]))
        f = f[np.append(True, np.diff(np.log(f)) > 0.005)]
        level = self._linear(middle[None], f)[0]
        return f[level > level.max() - (_DEPTH + 2.0 * size)]

    def _linear(self, points: Array, f: Array) -> Array:
        values = self.space.values(points)
        return np.log(
            linear_gains(self.model.layout, self.space.start, values, self.base, self.plan.car, f)
        )

    def _simulated(self, points: Array, f: Array) -> Array:
        def run(designs: list[Design]) -> Array:
            table = np.tile(f, (len(designs), 1))
            amplitude, settings = self.plan.amplitude, self.plan.settings
            return np.log(load_gains(self.model, designs, table, amplitude, settings))

        return each_or_one_by_one(run, [self.space.design(point) for point in points], f.size)
