"""End stops: a spring with a damper that is as strong as the spring is compressed.

    upper:  F =  (k_e delta + k_e3 delta^3) max(0, 1 + e v),   delta = x - stop_upper > 0
    lower:  F = -(k_e delta + k_e3 delta^3) max(0, 1 - e v),   delta = stop_lower - x > 0

Symbols: x displacement from rest length [m], v velocity [m/s], `stop_lower`, `stop_upper` [m]
(NaN: no stop), k_e `stop_stiffness` [N/m], k_e3 `stop_stiffness_cubic` [N/m^3], e `stop_damping`
[s/m].
Sign: tension positive: the upper stop pulls the terminals together.
Range: any v; the force is continuous at contact, which a parallel damper's is not, and never
sticks (max).
Stored: k_e delta^2 / 2 + k_e3 delta^4 / 4. Dissipated: F v minus the rise of that, >= 0.
Source: Hunt and Crossley, J. Appl. Mech. 42(2), 1975, with exponents 1 and 3.
Not modelled: rubber's hysteresis at rest, wear of the contact.
"""

from __future__ import annotations

import numpy as np

from .device_parameters import DeviceParameters
from .parameters import Quantity


def _sides(parameters: DeviceParameters, displacement: Quantity) -> list[tuple[float, Quantity]]:
    """Each stop that is there: its direction and its compression [m]."""
    found: list[tuple[float, Quantity]] = []
    if not np.isnan(parameters.stop_upper):
        found.append((1.0, np.maximum(0.0, displacement - parameters.stop_upper)))
    if not np.isnan(parameters.stop_lower):
        found.append((-1.0, np.maximum(0.0, parameters.stop_lower - displacement)))
    return found


def _elastic(parameters: DeviceParameters, depth: Quantity) -> Quantity:
    """Elastic force of a stop [N] at a compression [m]."""
    return parameters.stop_stiffness * depth + parameters.stop_stiffness_cubic * depth**3


def force(parameters: DeviceParameters, displacement: Quantity, velocity: Quantity) -> Quantity:
    """Force of both stops [N], arguments broadcast together."""
    total: Quantity = 0.0
    for side, depth in _sides(parameters, displacement):
        rise = np.maximum(0.0, 1.0 + parameters.stop_damping * side * velocity)
        total = total + side * _elastic(parameters, depth) * rise
    return total


def stored_energy(parameters: DeviceParameters, displacement: Quantity) -> Quantity:
    """Energy in the stops [J]."""
    total: Quantity = 0.0
    for _, depth in _sides(parameters, displacement):
        total = total + parameters.stop_stiffness * depth**2 / 2.0
        total = total + parameters.stop_stiffness_cubic * depth**4 / 4.0
    return total


def dissipated_power(
    parameters: DeviceParameters, displacement: Quantity, velocity: Quantity
) -> Quantity:
    """Heat in the stops [W]."""
    elastic: Quantity = 0.0
    for side, depth in _sides(parameters, displacement):
        elastic = elastic + side * _elastic(parameters, depth)
    return (force(parameters, displacement, velocity) - elastic) * velocity
