"""Half- and full cars once more, as complex linear systems solved at each frequency.

Nothing of `inerter.suspension.vehicle` but the numbers of a car is used: absolute coordinates, one
strut after the other, roads as inputs with their delay, and integrals by quadrature.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
from inerter.suspension.layouts import LAYOUTS, SeriesPair
from inerter.suspension.vehicle import FullCar, HalfCar, VehicleStrut
from numpy.polynomial.legendre import leggauss

# up to this frequency [rad/s] the quadrature follows the turning of a delay
RESOLVED = 3e4

Struts = tuple[VehicleStrut, VehicleStrut]


def dynamic_stiffness(layout: str, strut: VehicleStrut, pair: SeriesPair | None, s: Any) -> Any:
    """D(s) of a strut."""
    kb = strut.relaxation_stiffness or 1.0
    return LAYOUTS[layout].stiffness(
        strut.stiffness, strut.damping, strut.inertance, kb, pair=pair
    )(s)


def corners(car: HalfCar | FullCar) -> list[tuple[Any, list[float], int]]:
    """Axle, its place in body coordinates (heave, pitch[, roll]) and side of each wheel."""
    lf, lr = -car.front.distance, car.rear.distance
    if isinstance(car, HalfCar):
        return [(car.front, [1.0, lf], 0), (car.rear, [1.0, lr], 0)]
    half = car.track / 2.0
    return [
        (car.front, [1.0, lf, half], 0), (car.rear, [1.0, lr, half], 0),
        (car.front, [1.0, lf, -half], 1), (car.rear, [1.0, lr, -half], 1),
    ]  # fmt: skip


def responses(
    car: HalfCar | FullCar,
    layout: str,
    struts: Struts,
    pair: SeriesPair | None,
    frequency: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Accelerations and tyre forces per road velocity, (w, wheels, wheels), and zc/F (w,).

    Entry [:, i, j] is the answer at wheel i to the road under wheel j.
    """
    s = 1j * frequency
    wheels = corners(car)
    modes = len(wheels[0][1])
    inertias = [car.body_mass, car.pitch_inertia]
    if isinstance(car, FullCar):
        inertias.append(car.roll_inertia)
    count = modes + len(wheels)
    matrix = np.zeros((len(s), count, count), dtype=complex)
    for mode, inertia in enumerate(inertias):
        matrix[:, mode, mode] += inertia * s * s
    for n, (axle, place, _) in enumerate(wheels):
        strut = struts[0 if axle is car.front else 1]
        ends = np.zeros(count)
        ends[:modes], ends[modes + n] = place, -1.0
        force = np.broadcast_to(dynamic_stiffness(layout, strut, pair, s), s.shape)
        matrix += force[:, None, None] * np.outer(ends, ends)
        matrix[:, modes + n, modes + n] += axle.wheel_mass * s * s
        matrix[:, modes + n, modes + n] += axle.tyre_stiffness + axle.tyre_damping * s
    # the road's displacement is its velocity over s
    stiffness = np.array([np.diag([axle.tyre_stiffness + axle.tyre_damping * one
                                   for axle, _, _ in wheels]) for one in s])  # fmt: skip
    push = np.zeros((len(s), count, len(wheels)), dtype=complex)
    push[:, modes:] = stiffness / s[:, None, None]
    found = np.linalg.solve(matrix, push)
    places = np.array([place for _, place, _ in wheels])
    acceleration = places @ found[:, :modes] * (s * s)[:, None, None]
    tyre = stiffness @ found[:, modes:] - stiffness / s[:, None, None]
    unit = np.zeros((count, 1))
    unit[0] = 1.0
    load = np.linalg.solve(matrix, np.broadcast_to(unit, (len(s), count, 1)))
    return acceleration, tyre, load[:, 0, 0]


def quadrature() -> tuple[np.ndarray, np.ndarray]:
    """Frequencies [rad/s] and weights from 0 to far above everything."""
    nodes, weights = leggauss(20)
    edges = np.concatenate(
        [[0.0], np.geomspace(1e-4, 20.0, 400), np.arange(22.0, 1e3, 4.0),
         np.arange(1e3, RESOLVED, 25.0), np.geomspace(RESOLVED, 1e9, 80)]
    )  # fmt: skip
    middle, half = 0.5 * (edges[1:] + edges[:-1]), 0.5 * np.diff(edges)
    return (middle[:, None] + half[:, None] * nodes).ravel(), (half[:, None] * weights).ravel()


@cache
def _signals(
    car: HalfCar | FullCar, layout: str, struts: Struts, pair: SeriesPair | None
) -> tuple[np.ndarray, np.ndarray]:
    return responses(car, layout, struts, pair, quadrature()[0])[:2]


def rms(
    index: str,
    car: HalfCar | FullCar,
    layout: str,
    struts: Struts,
    pair: SeriesPair | None,
    *,
    delay: float | None,
    correlation: float = 1.0,
) -> float:
    """J1 or J3 over the root of the road's density; tracks of a given correlation.

    Without a delay the roads of front and rear know nothing of each other.
    """
    frequency, weight = quadrature()
    if isinstance(car, FullCar):
        # the car does not know how its tracks are correlated
        car = replace(car, correlation=0.0)
    acceleration, tyre = _signals(car, layout, struts, pair)
    signal = acceleration if index == "J1" else tyre
    wheels = corners(car)
    power = np.zeros(len(frequency))
    for j, (axle, _, side) in enumerate(wheels):
        for k, (other, _, beside) in enumerate(wheels):
            both = (signal[:, :, j] * np.conj(signal[:, :, k])).mean(axis=1)
            share: Any = 1.0 if side == beside else correlation
            if axle is not other:
                # what turns faster than can be resolved has no mean
                later = 0.0 if delay is None else delay * (1.0 if axle is car.rear else -1.0)
                phase = np.exp(-1j * frequency * later)
                seen = (delay is not None) and ((frequency < RESOLVED) | (delay == 0.0))
                share = share * phase * seen
            power += (both * share).real
    return float(np.sqrt(weight @ power / np.pi))
