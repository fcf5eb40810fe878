"""A force over displacement and velocity, on numbers and on expressions.

    F(x, v) = sum over rows i and columns j of c_ij B(s - i) B(t - j)
    B(d) = (q(2 - |d|)^3 - 4 q(1 - |d|)^3) / 6,   q(r) = max(0, r)

s and t count rows and columns, held within the first and the last; t is even in v, or in
asinh(v / scale) where a scale is given. The coefficients make F run through `force_map` with
slope 0 at its edges: c = K^-1 values K^-T, one mirrored row or column added at each end, K with
4/6 on its diagonal and 1/6 beside it, 2/6 in the first and the last row.
Each weight is a function of the whole axis, so that no cell has to be chosen in an expression.
`force_map_passive` leaves out what of F(x, v) - F(x, 0) goes along with v.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from inerter.exudyn import stroke
from inerter.exudyn.functions import NUMBERS, Functions, Value
from inerter.exudyn.parameters import Parameters


def force(f: Functions, p: Parameters, x: Value, v: Value) -> Value:
    """The force [N] at x [m] and v [m/s]."""
    still = _at(f, p, x, 0.0)
    return still + _moving(f, p, x, v, still)


def dissipated_power(f: Functions, p: Parameters, x: Value, v: Value) -> Value:
    """Heat [W]; below 0 where a map gives energy."""
    return _moving(f, p, x, v, _at(f, p, x, 0.0)) * v


def stored_energy(f: Functions, p: Parameters, x: Value) -> Value:
    """The integral of F(x, 0) from 0 to x [J]: that of a curve along the stroke."""
    lower, upper, rows = p.force_map_lower, p.force_map_upper, _shape(p)[0]
    places = (lower + (upper - lower) * i / (rows - 1) for i in range(rows))
    still = stroke.curve_moments(tuple(_at(NUMBERS, p, x, 0.0) for x in places), lower, upper)
    at_zero = stroke.spline_integral(NUMBERS, still, 0.0)
    return stroke.spline_integral(f, still, x) - at_zero


def _moving(f: Functions, p: Parameters, x: Value, v: Value, still: Value) -> Value:
    """F(x, v) - F(x, 0) [N], or what of it takes energy."""
    moving = _at(f, p, x, v) - still
    return f.choose(moving * v > 0.0, moving, 0.0) if p.force_map_passive else moving


def _at(f: Functions, p: Parameters, x: Value, v: Value) -> Value:
    rows, columns = _shape(p)
    edge = _stretched(NUMBERS, p, p.force_map_speed)
    s = (x - p.force_map_lower) * ((rows - 1) / (p.force_map_upper - p.force_map_lower))
    t = (_stretched(f, p, v) + edge) * ((columns - 1) / (2.0 * edge))
    down, across = _weights(f, s, rows), _weights(f, t, columns)
    total: Value = 0.0
    for weight, row in zip(down, _coefficients(p.force_map, columns), strict=True):
        # terms of numbers first, where v is one
        along: Value = 0.0
        for share, coefficient in zip(across, row, strict=True):
            along = along + share * float(coefficient)
        total = total + weight * along
    return total


def _shape(p: Parameters) -> tuple[int, int]:
    columns = int(p.force_map_columns)
    return len(p.force_map) // columns, columns


def _stretched(f: Functions, p: Parameters, v: Value) -> Value:
    """What is even from column to column."""
    if math.isnan(p.force_map_scale):
        return v
    size = f.abs(v) * (1.0 / p.force_map_scale)
    return f.sign(v) * f.log(size + f.sqrt(size * size + 1.0))


def _weights(f: Functions, at: Value, count: int) -> list[Value]:
    """Weights of the rows -1 to `count` at a place."""
    held = f.least(count - 1.0, f.greatest(0.0, at))
    found = []
    for i in range(-1, count + 1):
        far = f.abs(held - float(i))
        outer, inner = f.greatest(0.0, 2.0 - far), f.greatest(0.0, 1.0 - far)
        found.append((outer * outer * outer - 4.0 * inner * inner * inner) / 6.0)
    return found


@lru_cache(maxsize=64)
def _coefficients(values: tuple[float, ...], columns: int) -> NDArray[np.float64]:
    """Of the rows and columns, one more at each end, (rows + 2, columns + 2)."""
    grid: NDArray[np.float64] = np.array(values, dtype=np.float64).reshape(-1, columns)
    for _ in range(2):
        n = len(grid)
        matrix = (4.0 * np.eye(n) + np.eye(n, k=1) + np.eye(n, k=-1)) / 6.0
        matrix[0, 1] = matrix[-1, -2] = 2.0 / 6.0
        inner = np.linalg.solve(matrix, grid)
        grid = np.vstack([inner[1], inner, inner[-2]], dtype=np.float64).T
    return grid
