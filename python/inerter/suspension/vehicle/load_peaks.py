"""Peaks of |zc/F| of one design, none of them missed.

Where the slope of the gain changes from up to down between two frequencies lies a peak; the
frequencies are a grid and those of all poles, next to which peaks stand. Whether the highest found
is the highest there is decides the Hamiltonian matrix of its level: an eigenvalue on the imaginary
axis would be a frequency at which the gain crosses that level (Boyd, Balakrishnan and Kabamba 1989;
Bruinsma and Steinbuch 1990), and then the search goes on from there.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inerter.suspension.vehicle.load import Load
from inerter.suspension.vehicle.state_space import System, balanced, system

Array = NDArray[np.float64]

_GRID = 120
_ABOVE = 1e-11
_STEPS = 60
# the gain is flat at a peak: what this slope leaves of it is beyond its digits
_LEVEL = 1e-10


def peaks(load: Load, extra: Array | None = None) -> tuple[Array, Array]:
    """Local maxima of one design: frequency [rad/s] and gain [m/N], ascending frequency.

    w = 0 is the first of them where the gain falls from its static value.

    Parameters
    ----------
    load
        One stable design.
    extra
        Frequencies to look between as well.
    """
    matrix = system(load.car.heave_pitch(), load.branches).matrix
    return _peaks(load, _places(load, np.linalg.eigvals(matrix), extra))


def largest_gain(load: Load) -> float:
    """H-infinity norm of zc/F [m/N] of one design, certain; infinite where it is not stable."""
    whole = system(load.car.heave_pitch(), load.branches)
    poles = np.linalg.eigvals(whole.matrix)
    if poles.real.max() >= 0.0:
        return math.inf
    places = _places(load, poles)
    level = float(_peaks(load, places)[1].max())
    while True:
        crossings = _crossings(load, whole, level * (1.0 + 2.0 * _ABOVE))
        # whether one is on the axis rounding cannot tell; one that is not costs an evaluation
        between = 0.5 * (crossings[:-1] + crossings[1:])
        looked = np.concatenate([crossings, between])
        found = float(load.gain(looked).max(initial=0.0))
        if found <= level * (1.0 + _ABOVE):
            return max(found, level)
        places = np.unique(np.concatenate([places, looked]))
        level = max(found, float(_peaks(load, places)[1].max()))


def span(load: Load) -> tuple[float, float]:
    """Frequencies [rad/s] from far below the body's modes to far above wheel hop."""
    car = load.car
    low, high = math.inf, 0.0
    for branch, axle in zip(load.branches, (car.front, car.rear), strict=True):
        k = np.real(branch.stiffness)
        one = 1.0 / (1.0 / k.min() + 1.0 / axle.tyre_stiffness)
        low = min(low, math.sqrt(one / car.body_mass))
        high = max(high, math.sqrt((k.max() + axle.tyre_stiffness) / axle.wheel_mass))
    return 0.01 * low, 5.0 * high


def _places(load: Load, poles: NDArray[Any], extra: Array | None = None) -> Array:
    grid = np.geomspace(*span(load), _GRID)
    near = [np.abs(poles), np.abs(np.imag(poles))]
    places = np.concatenate([grid, *near, [] if extra is None else extra])
    return np.unique(places[places > 1e-3 * grid[0]])


def _peaks(load: Load, places: Array) -> tuple[Array, Array]:
    _, slope = load.slope(places)
    still = float(load.gain(np.zeros(1))[0])
    turns = np.flatnonzero((slope[:-1] > 0.0) & (slope[1:] <= 0.0))
    frequency = _between(load, places[turns], places[turns + 1], slope[turns], slope[turns + 1])
    height = load.gain(frequency)
    if slope[0] <= 0.0 or not len(turns):
        frequency, height = np.append(0.0, frequency), np.append(still, height)
    return frequency, height


def _between(load: Load, low: Array, high: Array, at_low: Array, at_high: Array) -> Array:
    """Zeros of the slope in brackets, over log w: secant steps, kept inside by bisection."""
    a, b = np.log(low), np.log(high)
    if not len(a):
        return low
    # the two latest points, the better one last
    swap = np.abs(at_low) < np.abs(at_high)
    before, now = np.where(swap, b, a), np.where(swap, a, b)
    was, value = np.where(swap, at_high, at_low), np.where(swap, at_low, at_high)
    for n in range(_STEPS):
        with np.errstate(all="ignore"):
            step = now - value * (now - before) / (value - was)
        # now and then the middle, so that every bracket shrinks
        inside = (step > a) & (step < b) & (n % 8 != 7)
        before, was = now, value
        now = np.where(inside, step, 0.5 * (a + b))
        value = load.slope(np.exp(now))[1]
        up = value > 0.0
        a, b = np.where(up, now, a), np.where(up, b, now)
        if np.all((b - a < 1e-13) | (np.abs(value) < _LEVEL)):
            break
    return np.exp(now)


def _crossings(load: Load, whole: System, level: float) -> Array:
    """Imaginary parts of the eigenvalues of the Hamiltonian matrix, ascending from 0."""
    matrix, scale = balanced(whole.matrix)
    column = (whole.load @ load.car.lever) / scale / load.sides
    row = (load.car.lever @ whole.height) * scale
    # input and output share the gain evenly
    share = math.sqrt(np.abs(row).max() / np.abs(column).max() / level)
    column, row = column * share, row / (share * level)
    hamiltonian = np.block([[matrix, np.outer(column, column)], [-np.outer(row, row), -matrix.T]])
    values = np.linalg.eigvals(hamiltonian)
    return np.unique(np.append(np.abs(values.imag), 0.0))
