"""The friction laws again, compiled by Numba: what a user without this package would write.

The formulas are the core's (its C files have the equations and their sources), in the form that
these parameters leave of them: every function fills the total force of an inerter along a motion.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from inerter.benchmark.laws import INERTANCE, LAWS
from numba import njit  # pyright: ignore[reportMissingImports]
from numpy.typing import NDArray


@njit
def none(b, h, x, v, a, total):
    """F = b a."""
    for i in range(x.size):
        total[i] = b * a[i]


@njit
def coulomb(b, h, x, v, a, total, fc, width):
    """F = f_c tanh(v / width)."""
    for i in range(x.size):
        total[i] = b * a[i] + fc * math.tanh(v[i] / width)


@njit
def stribeck(b, h, x, v, a, total, fc, fs, slow, width):
    """F = (f_c + (f_s - f_c) exp(-(v / v_s)^2)) tanh(v / width)."""
    for i in range(x.size):
        level = fc + (fs - fc) * math.exp(-((v[i] / slow) ** 2))
        total[i] = b * a[i] + level * math.tanh(v[i] / width)


@njit
def dahl(b, h, x, v, a, total, fc, s0):
    """F = s0 z, z exact between samples."""
    z = 0.0
    total[0] = b * a[0]
    for i in range(1, x.size):
        mean = (x[i] - x[i - 1]) / h
        if mean != 0.0:
            end = math.copysign(fc / s0, mean)
            z -= math.expm1(-s0 * abs(mean) * h / fc) * (end - z)
        total[i] = b * a[i] + s0 * z


@njit
def lugre(b, h, x, v, a, total, fc, fs, slow, s0, s1):
    """F = s0 z + s1 z', z exact between samples."""
    z = 0.0
    for i in range(x.size):
        if i:
            mean = (x[i] - x[i - 1]) / h
            level = fc + (fs - fc) * math.exp(-((mean / slow) ** 2))
            if mean != 0.0:
                end = math.copysign(level / s0, mean)
                z -= math.expm1(-s0 * abs(mean) * h / level) * (end - z)
        level = fc + (fs - fc) * math.exp(-((v[i] / slow) ** 2))
        rate = v[i] - s0 * abs(v[i]) * z / level
        total[i] = b * a[i] + s0 * z + s1 * rate


@njit
def bouc_wen(b, h, x, v, a, total, k0, beta, gamma):
    """F = k0 z, z exact between samples for alpha = 1, n = 1, A = 0."""
    z = 0.0
    total[0] = b * a[0]
    for i in range(1, x.size):
        path = abs(x[i] - x[i - 1])
        s = np.sign(x[i] - x[i - 1])
        if z * s < 0.0:
            # |z| falls at the rate 1 + (beta - gamma) |z|, to 0 at most
            fall = beta - gamma
            back = math.log1p(fall * abs(z)) / fall
            if path < back:
                z += math.expm1(-fall * path) / -fall * (s + fall * abs(z) * s)
                path = 0.0
            else:
                path -= back
                z = 0.0
        rise = beta + gamma
        z -= math.expm1(-rise * path) * (s / rise - z) if path > 0.0 else 0.0
        total[i] = b * a[i] + k0 * z


@njit
def brown_mcphee(b, h, x, v, a, total, fc, fs, slow):
    """F = f_c tanh(4 v / v_s) + (f_s - f_c) (v / v_s) / ((v / v_s)^2 / 4 + 3 / 4)^2."""
    for i in range(x.size):
        ratio = v[i] / slow
        shape = 0.25 * ratio * ratio + 0.75
        total[i] = b * a[i] + fc * math.tanh(4.0 * ratio) + (fs - fc) * ratio / (shape * shape)


_ARGUMENTS: dict[str, tuple[Any, tuple[str, ...]]] = {
    "none": (none, ()),
    "coulomb": (coulomb, ("coulomb_force", "transition_velocity")),
    "stribeck": (
        stribeck,
        ("coulomb_force", "static_force", "stribeck_velocity", "transition_velocity"),
    ),
    "dahl": (dahl, ("coulomb_force", "bristle_stiffness")),
    "lugre": (
        lugre,
        ("coulomb_force", "static_force", "stribeck_velocity", "bristle_stiffness",
         "bristle_damping"),
    ),
    "bouc_wen": (bouc_wen, ("bw_stiffness", "bw_beta", "bw_gamma")),
    "brown_mcphee": (brown_mcphee, ("coulomb_force", "static_force", "stribeck_velocity")),
}  # fmt: skip


def along(law: str) -> Callable[[float, NDArray, NDArray, NDArray], NDArray]:
    """Total force (n,) [N] of the compared inerter: called with h [s], x, v, a (n,)."""
    function, names = _ARGUMENTS[law]
    values = [float(LAWS[law][name]) for name in names]

    def force(h: float, x: NDArray, v: NDArray, a: NDArray) -> NDArray:
        total = np.empty_like(x)
        function(INERTANCE, h, x, v, a, total, *values)
        return total

    return force
