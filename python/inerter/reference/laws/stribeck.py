"""Stribeck friction: the level falls from f_s to f_c as the speed grows.

    F = level(x, v) [f_c + (f_s - f_c) exp(-(|v| / v_s)^delta)] tanh(v / v_t)

Symbols: f_c `coulomb_force` [N], f_s `static_force` [N], v_s `stribeck_velocity` [m/s],
delta `stribeck_exponent` [-], v_t `transition_velocity` [m/s], level see `level.py`.
Sign: tension positive; F v >= 0.
Range: v_t << v_s, else the peak at break-away is rounded off.
Source: the curve of Canudas de Wit et al., IEEE TAC 40(3), 1995, eq. (5), taken memoryless.
Not modelled: pre-sliding displacement, rate-dependent break-away (see LuGre).
"""

from __future__ import annotations

import numpy as np

from .level import friction_level
from .none import rate, stored_energy
from .parameters import FrictionParameters, Quantity

__all__ = ["STATES", "dissipated_power", "force", "rate", "stored_energy"]

STATES = 0


def force(
    parameters: FrictionParameters,
    displacement: Quantity,
    velocity: Quantity,
    state: Quantity = 0.0,
) -> Quantity:
    """Friction force [N], tension positive; arguments [m, m/s, -] broadcast together."""
    level = friction_level(parameters, displacement, velocity)
    shape = (abs(velocity) / parameters.stribeck_velocity) ** parameters.stribeck_exponent
    excess = parameters.breakaway_force - parameters.coulomb_force
    magnitude = parameters.coulomb_force + excess * np.exp(-shape)
    return level * magnitude * np.tanh(velocity / parameters.transition_velocity)


def dissipated_power(
    parameters: FrictionParameters,
    displacement: Quantity,
    velocity: Quantity,
    state: Quantity = 0.0,
) -> Quantity:
    """Dissipated power F v [W]: all of it, for nothing is stored."""
    return force(parameters, displacement, velocity, state) * velocity
