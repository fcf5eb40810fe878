"""A force over displacement and velocity that has no law: a restoring-force surface.

    F(x, v) = S(x) + D(x, v),  S(x) = F(x, 0)

Symbols: x displacement [m]; v velocity [m/s]; F [N] a bicubic spline through `force_map`, rows at
evenly spaced x from `force_map_lower` to `force_map_upper`, columns at evenly spaced w(v) from
-`force_map_speed` to `force_map_speed`; w(v) = asinh(v / `force_map_scale`), or v without a scale.
The spline is level at its edges and constant beyond. `force_map_passive`: D counts only where
D v > 0.
Sign: tension positive.
Range: 2 to 24 rows, 2 to 16 columns.
Stored: the integral of S from 0 to x. Dissipated: D v, which may be below 0 where a map is not
passive.
Source: Masri and Caughey 1979; SciPy's clamped splines.
Not modelled: memory; jumps at v = 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BSpline, CubicSpline, NdBSpline, make_interp_spline

from .stroke import Quantity

MOST_ROWS, MOST_COLUMNS = 24, 16


@dataclass(frozen=True)
class ForceMap:
    """The surface of one device; see the parameters of the same names."""

    values: tuple[float, ...]
    lower: float
    upper: float
    speed: float
    scale: float
    columns: int
    passive: bool

    def force(self, x: Quantity, v: Quantity) -> Quantity:
        """F [N]."""
        return self._still(x) + self._moving(x, v)

    def stored_energy(self, x: Quantity) -> Quantity:
        """Energy [J]: the integral of S from 0 to x."""
        return self._integral(x) - self._integral(0.0)

    def dissipated_power(self, x: Quantity, v: Quantity) -> Quantity:
        """Heat [W]."""
        return self._moving(x, v) * v

    def _still(self, x: Quantity) -> Quantity:
        """S [N]."""
        return self._spline()(np.clip(x, self.lower, self.upper))

    def _integral(self, x: Quantity) -> Quantity:
        inside = np.clip(x, self.lower, self.upper)
        spline = self._spline()
        return spline.antiderivative()(inside) + spline(inside) * (x - inside)

    def _spline(self) -> CubicSpline:
        return _still(self)

    def _moving(self, x: Quantity, v: Quantity) -> Quantity:
        """D [N]."""
        place = np.clip(x, self.lower, self.upper) + 0.0 * np.asarray(v)
        moved = _surface(self)(np.stack(np.broadcast_arrays(place, self._stretched(v)), axis=-1))
        force = moved - self._still(place)
        return np.where(force * v > 0.0, force, 0.0) if self.passive else force

    def _stretched(self, v: Quantity) -> Quantity:
        inside = np.clip(v, -self.speed, self.speed)
        return inside if np.isnan(self.scale) else np.arcsinh(inside / self.scale)


@lru_cache(maxsize=64)
def _surface(of: ForceMap) -> NdBSpline:
    rows = len(of.values) // of.columns
    edge = float(of._stretched(of.speed))
    axes = np.linspace(of.lower, of.upper, rows), np.linspace(-edge, edge, of.columns)
    along, knots = np.reshape(of.values, (rows, of.columns)), []
    for axis, places in enumerate(axes):
        spline = _level(places, np.moveaxis(along, axis, 0))
        along = np.moveaxis(spline.c, 0, axis)
        knots.append(spline.t)
    return NdBSpline(tuple(knots), along, 3)


def _level(places: NDArray[np.float64], values: NDArray[np.float64]) -> BSpline:
    """The cubic spline through values along the first axis, with slope 0 at its ends."""
    flat = np.zeros(values.shape[1:])
    return make_interp_spline(places, values, bc_type=([(1, flat)], [(1, flat)]))


@lru_cache(maxsize=64)
def _still(of: ForceMap) -> CubicSpline:
    rows = len(of.values) // of.columns
    places = np.linspace(of.lower, of.upper, rows)
    points = np.stack([places, np.zeros(rows)], axis=-1)
    return CubicSpline(places, _surface(of)(points), bc_type="clamped")
