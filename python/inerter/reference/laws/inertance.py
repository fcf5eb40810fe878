"""Inertance that varies along the stroke and with the speed of the flywheel.

    N = B(y, w) w' + R(y, w),   B = b X(y) V(w),   R = b X'(y) E(w)
    X(y) = max(0.01, 1 + q y + r y^2 + f(y))   (X' = 0 where the floor holds)
    V(w) = max(0.01, 1 + g |w|),        E(w) = integral from 0 to w of u V(u) du

Symbols: b inertance [kg], y [m], w [m/s] displacement and velocity of the flywheel (of the
terminals if the device has no series element), q `inertance_gradient` [1/m],
r `inertance_curvature` [1/m^2], g `inertance_speed_gradient` [s/m].
f is the curve `inertance` of `stroke.py` [-], for w < 0 `inertance_back` where that is given: B
jumps at w = 0, where the kinetic energy is 0 with either.
Sign: tension positive.
Range: both floors keep B above zero; a device that reaches one is outside its model.
Stored: b X(y) E(w), for g = 0 the familiar B w^2 / 2. Nothing is dissipated.
Source: Lagrange's equation with a kinetic co-energy whose momentum is b X P(w), P' = V.
Not modelled: slip between nut and flywheel, several flywheels.
"""

from __future__ import annotations

import numpy as np

from .device_parameters import DeviceParameters
from .parameters import Quantity

FLOOR = 0.01


def position_factor(
    parameters: DeviceParameters, displacement: Quantity, velocity: Quantity
) -> tuple[Quantity, Quantity]:
    """X [-] and its slope X' [1/m] at a displacement [m] and a velocity [m/s]."""
    gradient, curvature = parameters.inertance_gradient, parameters.inertance_curvature
    forth, back = (parameters.along.get(name) for name in ("inertance", "inertance_back"))
    if gradient == 0.0 and curvature == 0.0 and not forth and not back:
        return 1.0, 0.0
    factor = 1.0 + (gradient + curvature * displacement) * displacement
    slope = gradient + 2.0 * curvature * displacement
    rise, steepness = (forth(displacement), forth.slope(displacement)) if forth else (0.0, 0.0)
    if back:
        backward = np.asarray(velocity) < 0.0
        rise = np.where(backward, back(displacement), rise)
        steepness = np.where(backward, back.slope(displacement), steepness)
    factor, slope = factor + rise, slope + steepness
    return np.maximum(FLOOR, factor), np.where(factor < FLOOR, 0.0, slope)


def speed_factor(parameters: DeviceParameters, velocity: Quantity) -> Quantity:
    """V [-] at a velocity [m/s]."""
    gradient = parameters.inertance_speed_gradient
    return 1.0 if gradient == 0.0 else np.maximum(FLOOR, 1.0 + gradient * abs(velocity))


def speed_energy(parameters: DeviceParameters, velocity: Quantity) -> Quantity:
    """E [m^2/s^2], the kinetic energy per inertance, at a velocity [m/s]."""
    gradient = parameters.inertance_speed_gradient
    square = velocity * velocity
    smooth = 0.5 * square + gradient * abs(velocity) * square / 3.0
    if gradient >= 0.0:
        return smooth
    # above the speed at which the floor is reached
    corner = (1.0 - FLOOR) / -gradient
    at_corner = 0.5 * corner**2 + gradient * corner**3 / 3.0
    above = at_corner + 0.5 * FLOOR * (square - corner * corner)
    return np.where(abs(velocity) > corner, above, smooth)


def branch(
    parameters: DeviceParameters, inertance: float, displacement: Quantity, velocity: Quantity
) -> tuple[Quantity, Quantity]:
    """B [kg] and R [N]; `inertance` is b [kg], the others as above and broadcast together."""
    factor, slope = position_factor(parameters, displacement, velocity)
    mass = inertance * factor * speed_factor(parameters, velocity)
    return mass, inertance * slope * speed_energy(parameters, velocity)


def stored_energy(
    parameters: DeviceParameters, inertance: float, displacement: Quantity, velocity: Quantity
) -> Quantity:
    """Kinetic energy b X E [J]."""
    factor = position_factor(parameters, displacement, velocity)[0]
    return inertance * factor * speed_energy(parameters, velocity)
