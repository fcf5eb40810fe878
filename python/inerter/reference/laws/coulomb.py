"""Coulomb friction with a smoothed sign.

    F = f_c level(x, v) tanh(v / v_t)

Symbols: f_c `coulomb_force` [N], v_t `transition_velocity` [m/s], level see `level.py`.
Sign: tension positive; F opposes the motion, so F v >= 0.
Range: a good sign(v) where |v| > 3 v_t; below that it creeps like a damper f_c / v_t.
Source: Wang and Su, "Inerter nonlinearities and the impact on suspension control", ACC 2008,
eq. (9) `f_c sign(v)`; the tanh replaces the jump so that a solver can cross v = 0.
Not modelled: true sticking, break-away force, any memory (see Dahl and LuGre).
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
    return level * parameters.coulomb_force * np.tanh(velocity / parameters.transition_velocity)


def dissipated_power(
    parameters: FrictionParameters,
    displacement: Quantity,
    velocity: Quantity,
    state: Quantity = 0.0,
) -> Quantity:
    """Dissipated power F v [W]: all of it, for nothing is stored."""
    return force(parameters, displacement, velocity, state) * velocity
