"""LuGre friction: a bristle with damping that slides on the Stribeck curve.

    z' = v - sigma0 |v| z / g
    g(x, v) = level(x, v) [f_c + (f_s - f_c) exp(-(|v| / v_s)^delta)] + l
    F  = sigma0 z + sigma1 z'

Symbols: z bristle deflection [m], sigma0 `bristle_stiffness` [N/m], sigma1 `bristle_damping`
[N s/m], f_c `coulomb_force` [N], f_s `static_force` [N], v_s `stribeck_velocity` [m/s],
delta `stribeck_exponent` [-], level see `level.py`,
l what the load adds, see `load.py` [N]. sigma2 is the device's `viscous`, counted
there once.
Sign: tension positive; z grows with x. Steady sliding: F = g(v) sgn v.
Range: g > 0. Constant g: |z| <= g / sigma0 for ever, once inside.
Stored: sigma0 z^2 / 2. Dissipated: sigma0 z (v - z') + sigma1 z' v. The first term is never
negative; the second can be while the bristle relaxes, so only the sum over a loop is a promise.
With `friction_backlash` z is the bristle behind its free play and F never pulls across it, see
`free_play.py`; the law then dissipates at every speed.
Source: Canudas de Wit, Olsson, Astrom, Lischinsky, IEEE TAC 40(3), 419-425, 1995.
"Modelling and identification of the hysteretic dynamics of inerters" prints z' = v - |v| z / g
without sigma0; its parameters become standard ones with g_standard = sigma0 g_printed.
Not modelled: memory within a bristle (no nonlocal hysteresis), sigma1 that fades with speed.
"""

from __future__ import annotations

import numpy as np

from . import free_play
from .level import friction_level
from .parameters import FrictionParameters, Quantity

STATES = 1


def sliding_level(
    parameters: FrictionParameters, displacement: Quantity, velocity: Quantity
) -> Quantity:
    """The Stribeck curve g(x, v) [N], positive; arguments [m, m/s] broadcast together."""
    shape = (abs(velocity) / parameters.stribeck_velocity) ** parameters.stribeck_exponent
    excess = parameters.breakaway_force - parameters.coulomb_force
    curve = parameters.coulomb_force + excess * np.exp(-shape)
    return friction_level(parameters, displacement, velocity) * curve + parameters.load_level


def rate(
    parameters: FrictionParameters, displacement: Quantity, velocity: Quantity, state: Quantity
) -> Quantity:
    """Rate of the bristle deflection z' [m/s]; arguments [m, m/s, m] broadcast together."""
    level = sliding_level(parameters, displacement, velocity)
    bristle = free_play.bristle(parameters, state)
    engaged = velocity - parameters.bristle_stiffness * abs(velocity) * bristle / level
    return free_play.state_rate(parameters, velocity, state, engaged)


def force(
    parameters: FrictionParameters, displacement: Quantity, velocity: Quantity, state: Quantity
) -> Quantity:
    """Friction force sigma0 z + sigma1 z' [N], tension positive."""
    spring = parameters.bristle_stiffness * free_play.bristle(parameters, state)
    bristle_rate = rate(parameters, displacement, velocity, state)
    damper = parameters.bristle_damping * bristle_rate
    engaged = free_play.is_engaged(parameters, velocity, state)
    return free_play.pressing(parameters, state, spring + np.where(engaged, damper, 0.0))


def stored_energy(
    parameters: FrictionParameters, displacement: Quantity, velocity: Quantity, state: Quantity
) -> Quantity:
    """Energy in the bristle sigma0 z^2 / 2 [J]."""
    bristle = free_play.bristle(parameters, state)
    return 0.5 * parameters.bristle_stiffness * bristle * bristle + 0.0 * velocity


def dissipated_power(
    parameters: FrictionParameters, displacement: Quantity, velocity: Quantity, state: Quantity
) -> Quantity:
    """Dissipated power sigma0 z (v - z') + sigma1 z' v [W]."""
    bristle_rate = rate(parameters, displacement, velocity, state)
    spring = parameters.bristle_stiffness * free_play.bristle(parameters, state)
    if parameters.friction_backlash > 0.0:
        return force(parameters, displacement, velocity, state) * velocity - spring * bristle_rate
    slip = spring * (velocity - bristle_rate)
    return slip + parameters.bristle_damping * bristle_rate * velocity
