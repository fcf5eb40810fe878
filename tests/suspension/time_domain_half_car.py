"""A half-car as complex equations of motion, written apart from the product: what tests compare.

Coordinates (z, theta, w_f, w_r); positive pitch lowers the front.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from inerter.model_parameters import HALF_CAR
from inerter.suspension.time_domain.road import PeriodicRoad
from numpy.typing import NDArray

Array = NDArray[np.float64]
Complex = NDArray[Any]
Strut = tuple[float, float, float]
"""k, c, b."""

LEVERS = (-HALF_CAR.front.distance, HALF_CAR.rear.distance)
TYRES = np.array([HALF_CAR.front.tyre_stiffness, HALF_CAR.rear.tyre_stiffness])


def strut_stiffness(
    s: Complex, layout: str, strut: Strut, pair: tuple[float, float] | None
) -> Complex:
    """Force per elongation at s."""
    k, c, b = strut
    if layout == "S1":
        return k + c * s
    inertance = b * s**2
    if pair is not None:
        shaft = pair[0] + pair[1] * s
        inertance = inertance * shaft / (inertance + shaft)
    if layout == "S2":
        return k + c * s + inertance
    return k + c * s * inertance / (c * s + inertance)


def _dynamic(
    f: Array, layout: str, struts: tuple[Strut, Strut], pair: tuple[float, float] | None
) -> Complex:
    """The dynamic stiffness at frequencies [Hz], shape (n, 4, 4)."""
    s = 2j * np.pi * f
    mass = [
        HALF_CAR.body_mass,
        HALF_CAR.pitch_inertia,
        HALF_CAR.front.wheel_mass,
        HALF_CAR.rear.wheel_mass,
    ]
    total = s[:, None, None] ** 2 * np.diag(mass) + np.diag([0.0, 0.0, *TYRES])
    for i, strut in enumerate(struts):
        row = np.array([1.0, LEVERS[i], -(i == 0), -(i == 1)])
        force = strut_stiffness(s, layout, strut, pair)
        total = total + force[:, None, None] * np.outer(row, row)
    return total


def half_car_indices(
    road: PeriodicRoad,
    layout: str,
    struts: tuple[Strut, Strut],
    pair: tuple[float, float] | None = None,
) -> Array:
    """J1 and J3 over a road, summed over its sinusoids."""
    f = road.frequencies
    lag = (LEVERS[1] - LEVERS[0]) / road.speed
    under = np.column_stack([np.ones(f.size), np.exp(-2j * np.pi * f * lag)])
    forces = np.column_stack([np.zeros((f.size, 2)), TYRES * under])
    x = np.linalg.solve(_dynamic(f, layout, struts, pair), forces[..., None])[..., 0]
    body = -((2 * np.pi * f[:, None]) ** 2) * (x[:, :1] + x[:, 1:2] * np.array(LEVERS))
    tyres = TYRES * (x[:, 2:] - under)
    power = 0.5 * road.amplitudes[:, None] ** 2
    return np.array([np.sqrt(0.5 * np.sum(power * abs(each) ** 2)) for each in (body, tyres)])


def centre_per_load(
    f: Array, layout: str, struts: tuple[Strut, Strut], pair: tuple[float, float] | None = None
) -> Array:
    """abs(z/F) [m/N] of the centre of mass at frequencies [Hz]."""
    load = np.array([1.0, 0.0, 0.0, 0.0])
    total = _dynamic(np.asarray(f), layout, struts, pair)
    return np.abs(np.linalg.solve(total, np.tile(load[:, None], (len(f), 1, 1)))[:, 0, 0])
