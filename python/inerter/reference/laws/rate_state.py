"""Rate-and-state friction: ages at rest, falls with the logarithm of speed.

    F  = level(x, v) f_c [1 + A ln(V / v_0) + B z] tanh(v / v_t),   V = sqrt(v^2 + v_t^2)
    z' = (v_0 / L) exp(-z) - |v| / L

Symbols: z = ln(v_0 theta / L) [-] with theta the age of the contacts [s],
theta' = 1 - |v| theta / L; f_c `coulomb_force` [N], A `rate_effect` [-], B `age_effect` [-],
v_0 `rate_velocity` [m/s], L `age_distance` [m], v_t `transition_velocity` [m/s], level see
`level.py`. The bracket does not fall below 0.001.
Sign: tension positive; F v >= 0.
Range: steady sliding f_c (1 + (A - B) ln(|v| / v_0)) for |v| well above v_t.
Stored: nothing. Dissipated: F v.
Source: Dieterich, J. Geophys. Res. 84, 1979; Ruina, J. Geophys. Res. 88, 1983 (aging law); the
logarithm ends at v_t.
Not modelled: pre-sliding displacement, changes of the normal force.
"""

from __future__ import annotations

import numpy as np

from .level import friction_level
from .none import stored_energy
from .parameters import FrictionParameters, Quantity

__all__ = ["STATES", "dissipated_power", "force", "rate", "stored_energy"]

STATES = 1


def rate(
    parameters: FrictionParameters, displacement: Quantity, velocity: Quantity, state: Quantity
) -> Quantity:
    """Rate of the logarithm of the age z' [1/s]; arguments [m, m/s, -] broadcast together."""
    # an age of exp(-300) is none
    aging = parameters.rate_velocity * np.exp(-np.maximum(state, -300.0)) - abs(velocity)
    return aging / parameters.age_distance


def bracket(parameters: FrictionParameters, velocity: Quantity, state: Quantity) -> Quantity:
    """What speed and age make of the level [-]."""
    speed = np.hypot(velocity, parameters.transition_velocity) / parameters.rate_velocity
    found = 1.0 + parameters.rate_effect * np.log(speed) + parameters.age_effect * state
    return np.maximum(1e-3, found)


def force(
    parameters: FrictionParameters, displacement: Quantity, velocity: Quantity, state: Quantity
) -> Quantity:
    """Friction force [N], tension positive."""
    level = parameters.coulomb_force * friction_level(parameters, displacement, velocity)
    size = level * bracket(parameters, velocity, state)
    return size * np.tanh(velocity / parameters.transition_velocity)


def dissipated_power(
    parameters: FrictionParameters, displacement: Quantity, velocity: Quantity, state: Quantity
) -> Quantity:
    """Dissipated power F v [W]."""
    return force(parameters, displacement, velocity, state) * velocity
