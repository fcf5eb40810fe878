"""Dahl friction: an elastic bristle that yields gradually to the Coulomb level.

    z' = v sgn(u) |u|^n,   u = 1 - sigma0 z sgn(v) / (f_c level(x, v) + l),   z' = 0 at v = 0
    F  = sigma0 z

Symbols: z bristle deflection [m], sigma0 `bristle_stiffness` [N/m], f_c `coulomb_force` [N],
n `dahl_exponent` [-], level see `level.py`, l what the load adds, see `load.py` [N].
Sign: tension positive; z grows with x.
Range: f_c level > 0. For constant level and n = 1: |z| <= f_c / sigma0 for ever, once inside.
Stored: sigma0 z^2 / 2. Dissipated: sigma0 z (v - z'), never negative for n = 1.
With `friction_backlash` z is the bristle behind its free play, see `free_play.py`.
Source: Dahl, "A solid friction model", Aerospace Corp. TOR-0158(3107-18), 1968, with n = 1 as
in "Modelling and identification of the hysteretic dynamics of inerters", eqs. (4)-(6).
Not modelled: Stribeck fall, break-away, bristle damping (`bristle_damping` is not read here);
loops drift under small vibration about a constant load.
"""

from __future__ import annotations

import numpy as np

from . import free_play
from .level import friction_level
from .parameters import FrictionParameters, Quantity

STATES = 1


def rate(
    parameters: FrictionParameters, displacement: Quantity, velocity: Quantity, state: Quantity
) -> Quantity:
    """Rate of the bristle deflection z' [m/s]; arguments [m, m/s, m] broadcast together."""
    level = parameters.coulomb_force * friction_level(parameters, displacement, velocity)
    level = level + parameters.load_level
    bristle = free_play.bristle(parameters, state)
    gap = 1.0 - parameters.bristle_stiffness * bristle * np.sign(velocity) / level
    if parameters.dahl_exponent == 1.0:
        engaged = velocity * gap
    else:
        engaged = velocity * np.sign(gap) * abs(gap) ** parameters.dahl_exponent
    return free_play.state_rate(parameters, velocity, state, engaged)


def force(
    parameters: FrictionParameters, displacement: Quantity, velocity: Quantity, state: Quantity
) -> Quantity:
    """Friction force sigma0 z [N], tension positive; shape of z and v broadcast together."""
    return parameters.bristle_stiffness * free_play.bristle(parameters, state) + 0.0 * velocity


def stored_energy(
    parameters: FrictionParameters, displacement: Quantity, velocity: Quantity, state: Quantity
) -> Quantity:
    """Energy in the bristle sigma0 z^2 / 2 [J]."""
    bristle = free_play.bristle(parameters, state)
    return 0.5 * parameters.bristle_stiffness * bristle * bristle + 0.0 * velocity


def dissipated_power(
    parameters: FrictionParameters, displacement: Quantity, velocity: Quantity, state: Quantity
) -> Quantity:
    """Dissipated power sigma0 z (v - z') [W]."""
    slip = velocity - rate(parameters, displacement, velocity, state)
    return parameters.bristle_stiffness * free_play.bristle(parameters, state) * slip
