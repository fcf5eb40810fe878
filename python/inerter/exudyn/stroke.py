"""What changes along the stroke, on numbers and on expressions.

    f(x) = S(x) + sum of A sin(2 pi x / L + phi)

S runs through values at evenly spaced places from `curve_lower` to `curve_upper`, two times
differentiable between them, level at both ends and beyond. Told here by what each interval adds:
with t_i the share of interval i that x has passed (0 before it, 1 after it),

    S = y_0 + sum over i of h s_i t_i + h^2 (m_i t_i^2 / 2 + (m_i+1 - m_i) t_i^3 / 6)
    S' = sum over i of h (m_i t_i + (m_i+1 - m_i) t_i^2 / 2)

y values, h their distance [m], s slopes and m second derivatives at them, so that no interval has
to be chosen and an expression is as smooth as the curve.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from inerter.exudyn.functions import NUMBERS, Functions, Value
from inerter.exudyn.parameters import Parameters


@dataclass(frozen=True)
class Moments:
    """Values, slopes and second derivatives at the places, and the distance of these [m]."""

    values: tuple[float, ...]
    slopes: NDArray[np.float64]
    curvatures: NDArray[np.float64]
    lower: float
    spacing: float


def there(p: Parameters, name: str) -> bool:
    """Whether a quantity changes along the stroke."""
    return bool(getattr(p, f"{name}_curve") or getattr(p, f"{name}_periods"))


def value(f: Functions, p: Parameters, name: str, x: Value) -> Value:
    """The quantity at x [m]."""
    total = 0.0
    if values := getattr(p, f"{name}_curve"):
        moments = curve_moments(values, p.curve_lower, p.curve_upper)
        total = total + _spline(f, moments, x)
    for wave, amplitude, phase in _waves(p, name):
        total = total + amplitude * f.sin(wave * x + phase)
    return total


def slope(f: Functions, p: Parameters, name: str, x: Value) -> Value:
    """Rate of f over x."""
    total = 0.0
    if values := getattr(p, f"{name}_curve"):
        m = curve_moments(values, p.curve_lower, p.curve_upper)
        for i, t in enumerate(_passed(f, m, x)):
            change = m.curvatures[i + 1] - m.curvatures[i]
            total = total + m.spacing * (float(m.curvatures[i]) + 0.5 * float(change) * t) * t
    for wave, amplitude, phase in _waves(p, name):
        total = total + amplitude * wave * f.cos(wave * x + phase)
    return total


def integral(f: Functions, p: Parameters, name: str, x: Value) -> Value:
    """Integral of f from 0 to x."""
    total: Value = 0.0
    if values := getattr(p, f"{name}_curve"):
        moments = curve_moments(values, p.curve_lower, p.curve_upper)
        from_zero = spline_integral(f, moments, x) - spline_integral(NUMBERS, moments, 0.0)
        total = total + from_zero
    for wave, amplitude, phase in _waves(p, name):
        total = total + amplitude / wave * (math.cos(phase) - f.cos(wave * x + phase))
    return total


def _waves(p: Parameters, name: str) -> list[tuple[float, float, float]]:
    """Wave number [rad/m], amplitude, phase [rad] of each period."""
    periods: Sequence[float] = getattr(p, f"{name}_periods")
    threes = (periods[i : i + 3] for i in range(0, len(periods), 3))
    return [(2.0 * math.pi / length, amplitude, phase) for length, amplitude, phase in threes]


def _passed(f: Functions, m: Moments, x: Value) -> list[Value]:
    """Shares of the intervals that x has passed."""
    place = (x - m.lower) / m.spacing
    return [f.least(1.0, f.greatest(0.0, place - i)) for i in range(len(m.values) - 1)]


def _spline(f: Functions, m: Moments, x: Value) -> Value:
    h, total = m.spacing, m.values[0]
    for i, t in enumerate(_passed(f, m, x)):
        first, second = float(m.curvatures[i]), float(m.curvatures[i + 1])
        cubic = 0.5 * first + (second - first) / 6.0 * t
        total = total + (h * float(m.slopes[i]) + h * h * cubic * t) * t
    return total


def spline_integral(f: Functions, m: Moments, x: Value) -> Value:
    """Integral from the first place to x."""
    h, before = m.spacing, f.least(0.0, x - m.lower)
    total = m.values[0] * before
    for i, t in enumerate(_passed(f, m, x)):
        first, second = float(m.curvatures[i]), float(m.curvatures[i + 1])
        quartic = first / 6.0 + (second - first) / 24.0 * t
        inside = (0.5 * h * float(m.slopes[i]) + h * h * quartic * t) * t
        total = total + h * (m.values[i] + inside) * t
    return total + m.values[-1] * f.greatest(0.0, x - m.lower - h * (len(m.values) - 1))


@lru_cache(maxsize=64)
def curve_moments(values: tuple[float, ...], lower: float, upper: float) -> Moments:
    """The slopes make the second derivatives meet; 0 at the ends."""
    n, y = len(values), np.array(values)
    h = (upper - lower) / (n - 1)
    slopes = np.zeros(n)
    if n > 2:
        matrix = 4.0 * np.eye(n - 2) + np.eye(n - 2, k=1) + np.eye(n - 2, k=-1)
        slopes[1:-1] = np.linalg.solve(matrix, 3.0 * (y[2:] - y[:-2]) / h)
    steps = np.diff(y) / h
    curvatures = np.empty(n)
    curvatures[:-1] = (6.0 * steps - 4.0 * slopes[:-1] - 2.0 * slopes[1:]) / h
    curvatures[-1] = (2.0 * slopes[-2] + 4.0 * slopes[-1] - 6.0 * steps[-1]) / h
    return Moments(values, slopes, curvatures, lower, h)
