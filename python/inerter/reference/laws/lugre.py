"""LuGre friction: a bristle with damping that slides on the Stribeck curve.

    z' = v - sigma0 |v| z / g,   g(x, v) = level(x, v) [f_c + (f_s - f_c) exp(-(|v| / v_s)^delta)]
    F  = sigma0 z + sigma1 z'

Symbols: z bristle deflection [m], sigma0 `bristle_stiffness` [N/m], sigma1 `bristle_damping`
[N s/m], f_c `coulomb_force` [N], f_s `static_force` [N], v_s `stribeck_velocity` [m/s],
delta `stribeck_exponent` [-], level see `level.py`. sigma2 is the device's `viscous`, counted
there once.
Sign: tension positive; z grows with x. Steady sliding: F = g(v) sgn v.
Range: g > 0. Constant g: |z| <= g / sigma0 for ever, once inside.
Stored: sigma0 z^2 / 2. Dissipated: sigma0 z (v - z') + sigma1 z' v. The first term is never
negative; the second can be while the bristle relaxes, so only the sum over a loop is a promise.
Source: Canudas de Wit, Olsson, Astrom, Lischinsky, IEEE TAC 40(3), 419-425, 1995.
"Modelling and identification of the hysteretic dynamics of inerters" prints z' = v - |v| z / g
without sigma0; its parameters become standard ones with g_standard = sigma0 g_printed.
Not modelled: memory within a bristle (no nonlocal hysteresis), sigma1 that fades with speed.
"""

from __future__ import annotations

import numpy as np

from .level import friction_level
from .parameters import FrictionParameters, Quantity

STATES = 1


def sliding_level(
    parameters: FrictionParameters, displacement: Quantity, velocity: Quantity
) -> Quantity:
    """The Stribeck curve g(x, v) [N], positive; arguments [m, m/s] broadcast together."""
    shape = (abs(velocity) / parameters.stribeck_velocity) ** parameters.stribeck_exponent
    excess = parameters.static_force - parameters.coulomb_force
    curve = parameters.coulomb_force + excess * np.exp(-shape)
    return friction_level(parameters, displacement, velocity) * curve


def rate(
    parameters: FrictionParameters, displacement: Quantity, velocity: Quantity, state: Quantity
) -> Quantity:
    """Rate of the bristle deflection z' [m/s]; arguments [m, m/s, m] broadcast together."""
    level = sliding_level(parameters, displacement, velocity)
    return velocity - parameters.bristle_stiffness * abs(velocity) * state / level


def force(
    parameters: FrictionParameters, displacement: Quantity, velocity: Quantity, state: Quantity
) -> Quantity:
    """Friction force sigma0 z + sigma1 z' [N], tension positive."""
    bristle_rate = rate(parameters, displacement, velocity, state)
    return parameters.bristle_stiffness * state + parameters.bristle_damping * bristle_rate


def stored_energy(
    parameters: FrictionParameters, displacement: Quantity, velocity: Quantity, state: Quantity
) -> Quantity:
    """Energy in the bristle sigma0 z^2 / 2 [J]."""
    return 0.5 * parameters.bristle_stiffness * state * state + 0.0 * velocity


def dissipated_power(
    parameters: FrictionParameters, displacement: Quantity, velocity: Quantity, state: Quantity
) -> Quantity:
    """Dissipated power sigma0 z (v - z') + sigma1 z' v [W]."""
    bristle_rate = rate(parameters, displacement, velocity, state)
    slip = parameters.bristle_stiffness * state * (velocity - bristle_rate)
    return slip + parameters.bristle_damping * bristle_rate * velocity
