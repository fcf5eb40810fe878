"""Brown and McPhee's smooth friction.

    F = level(x, v) [f_d tanh(4 |v| / v_s)
                     + (f_s - f_d) (|v| / v_s) / ((v / v_s)^2 / 4 + 3/4)^2] sign(v)

Symbols: f_d `coulomb_force` [N], f_s `static_force` [N], v_s `stribeck_velocity` [m/s],
level see `level.py`. Its viscous part c_d v is the device's `viscous`, counted there once.
Sign: tension positive; F v >= 0 for f_s >= 0.
Range: no smoothing parameter is needed: both terms vanish linearly at v = 0. At v = v_s the
second bracket is exactly f_s - f_d and the first f_d tanh 4.
Source: Brown and McPhee, J. Comput. Nonlinear Dyn. 11(5), 054502, 2016; used for the fluid
inerter with f_s = 50 N, f_d = 25 N, v_s = 0.013 m/s, c_d = 515 N s/m.
Not modelled: pre-sliding displacement, memory, sticking (it creeps at small loads).
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
    speed = abs(velocity) / parameters.stribeck_velocity
    excess = parameters.breakaway_force - parameters.coulomb_force
    peak = excess * speed / (speed * speed / 4.0 + 0.75) ** 2
    return level * (parameters.coulomb_force * np.tanh(4.0 * speed) + peak) * np.sign(velocity)


def dissipated_power(
    parameters: FrictionParameters,
    displacement: Quantity,
    velocity: Quantity,
    state: Quantity = 0.0,
) -> Quantity:
    """Dissipated power F v [W]: all of it, for nothing is stored."""
    return force(parameters, displacement, velocity, state) * velocity
