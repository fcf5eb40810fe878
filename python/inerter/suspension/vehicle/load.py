"""Displacement of the centre of mass per vertical load on it, zc/F, over frequency.

Seen from the body, the strut and the wheel of an axle are one dynamic stiffness to the ground,
K = D W / (D + W) with the wheel's W = mu s^2 + ct s + kt. Then zc/F = g^T (M s^2 + diag(K))^-1 g
with the lever g, and d(zc/F) = -sum of (h_i)^2 dK_i for h = (M s^2 + diag(K))^-1 g.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inerter.suspension.vehicle.cars import HalfCar
from inerter.suspension.vehicle.strut import Branch

Array = NDArray[Any]


@dataclass(frozen=True)
class Load:
    """zc/F of a half-car with the struts of arrays of designs; frequencies along a last axis.

    `sides` is 2 where the half-car is one side of a car that bears the load on both.
    """

    car: HalfCar
    branches: tuple[Branch, Branch]
    sides: int = 1

    def gain(self, frequency: Array) -> Array:
        """|zc/F| [m/N] at frequencies w [rad/s] that broadcast against (designs, 1)."""
        return np.abs(self._values(1j * frequency)[0]) / self.sides

    def slope(self, frequency: Array) -> tuple[Array, Array]:
        """|zc/F| [m/N] and d log |zc/F| / d log w."""
        s = 1j * frequency
        value, h, dk = self._values(s)
        (m11, m12), (_, m22) = self.car.heave_pitch().inertia
        change = -2.0 * s * (m11 * h[0] ** 2 + 2.0 * m12 * h[0] * h[1] + m22 * h[1] ** 2)
        change = change - dk[0][1] * h[0] ** 2 - dk[1][1] * h[1] ** 2
        return np.abs(value) / self.sides, np.real(s * change / value)

    def sensitivity(self, frequency: Array, slopes: tuple[Array, Array]) -> tuple[Array, Array]:
        """Logarithm of |zc/F| of one design, and its gradient, shape (variables, frequencies).

        `slopes` are derivatives of D of each axle at the frequencies, of the gradient's shape.
        """
        value, h, dk = self._values(1j * frequency)
        change = -(h[0] ** 2 * dk[0][0] * slopes[0] + h[1] ** 2 * dk[1][0] * slopes[1])
        return np.log(np.abs(value) / self.sides), np.real(change / value)

    def _values(self, s: Array) -> tuple[Array, Array, list[tuple[Array, Array]]]:
        """zc/F, h, and for each axle dK/dD and dK/ds."""
        (m11, m12), (_, m22) = self.car.heave_pitch().inertia
        front, rear = self.car.lever
        stiffness, change = [], []
        for branch, axle in zip(self.branches, (self.car.front, self.car.rear), strict=True):
            strut, strut_slope = branch.dynamic_stiffness(s)
            wheel = axle.wheel_mass * s * s + axle.tyre_damping * s + axle.tyre_stiffness
            wheel_slope = 2.0 * axle.wheel_mass * s + axle.tyre_damping
            share, other = wheel / (strut + wheel), strut / (strut + wheel)
            stiffness.append(strut * share)
            change.append((share**2, share**2 * strut_slope + other**2 * wheel_slope))
        a, b = m11 * s * s + stiffness[0], m22 * s * s + stiffness[1]
        across = m12 * s * s
        determinant = a * b - across * across
        h = np.array([b * front - across * rear, a * rear - across * front]) / determinant
        return front * h[0] + rear * h[1], h, change
