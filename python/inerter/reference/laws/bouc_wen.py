"""Bouc-Wen hysteresis: an elastic branch beside a branch that yields.

    z' = alpha v - beta |v| z |z|^(n-1) - gamma v |z|^n
    F  = A k0 x + (1 - A) k0 z

Symbols: z hysteretic displacement [m], alpha `bw_alpha` [-], beta `bw_beta` [m^-n],
gamma `bw_gamma` [m^-n], n `bw_exponent` [-], k0 `bw_stiffness` [N/m], A `bw_ratio` [-],
x the displacement itself. The paper's c0 is the device's `viscous`.
Sign: tension positive; z grows with x.
Range: n >= 1, alpha > 0. For beta + gamma > 0, z saturates at (alpha / (beta + gamma))^(1/n).
Stored: A k0 x^2 / 2 + (1 - A) k0 z^2 / (2 alpha).
Dissipated: (1 - A) k0 z (v - z' / alpha), never negative for 0 <= A <= 1, k0 >= 0 and
beta >= |gamma|; the published set with A = 341.81 is outside this and is not passive.
With `friction_backlash` z stands behind its free play (`free_play.py`), the elastic branch
does not.
Source: Bouc 1967 and Wen 1976, as in "Modelling and identification of the hysteretic dynamics
of inerters", eqs. (12)-(13), where the last term's exponent n is lost in print.
Along the stroke (`friction_curve` and its kin), and where a load adds to the force at which it
yields, |1 - A| k0 (alpha / (beta + gamma))^(1/n) (`load.py`), beta and gamma are divided by
level^n: z saturates at that share, with the same stiffness and energy. Where the level has fallen
below |z|, z comes back no slower than from the level: for gamma > beta it would run away.
Not modelled: degradation, pinching, rate dependence.
Only scale-free combinations can be identified: (alpha, beta, gamma, k0) may be rescaled with z.
"""

from __future__ import annotations

import numpy as np

from . import free_play
from .level import friction_level
from .parameters import FrictionParameters, Quantity

STATES = 1


def raised(parameters: FrictionParameters, level: Quantity) -> Quantity:
    """The level [-] with what the load adds to the force at which it yields."""
    if np.ndim(parameters.load_level) == 0 and parameters.load_level == 0.0:
        return level
    saturated = parameters.bw_alpha / (parameters.bw_beta + parameters.bw_gamma)
    bound = abs(1.0 - parameters.bw_ratio) * saturated ** (1.0 / parameters.bw_exponent)
    return level + parameters.load_level / (parameters.bw_stiffness * bound)


def rate(
    parameters: FrictionParameters, displacement: Quantity, velocity: Quantity, state: Quantity
) -> Quantity:
    """Rate of the hysteretic displacement z' [m/s]; arguments broadcast together."""
    bent = free_play.bristle(parameters, state)
    size = abs(bent)
    level = 1.0
    if "friction" in parameters.along or "friction_back" in parameters.along:
        level = friction_level(parameters, displacement, velocity)
    level = raised(parameters, level)
    narrowed = size**parameters.bw_exponent / level**parameters.bw_exponent
    saturation = parameters.bw_beta + parameters.bw_gamma
    if parameters.bw_gamma > parameters.bw_beta and saturation > 0.0:
        at_level = np.minimum(narrowed, parameters.bw_alpha / saturation)
        narrowed = np.where(velocity * bent < 0.0, at_level, narrowed)
    hardening = parameters.bw_beta * abs(velocity) * np.sign(bent) * narrowed
    shaping = parameters.bw_gamma * velocity * narrowed
    engaged = parameters.bw_alpha * velocity - hardening - shaping
    return free_play.state_rate(parameters, velocity, state, engaged)


def force(
    parameters: FrictionParameters, displacement: Quantity, velocity: Quantity, state: Quantity
) -> Quantity:
    """Hysteretic force A k0 x + (1 - A) k0 z [N], tension positive."""
    elastic = parameters.bw_ratio * displacement
    yielding = (1.0 - parameters.bw_ratio) * free_play.bristle(parameters, state)
    return parameters.bw_stiffness * (elastic + yielding) + 0.0 * velocity


def stored_energy(
    parameters: FrictionParameters, displacement: Quantity, velocity: Quantity, state: Quantity
) -> Quantity:
    """Stored energy A k0 x^2 / 2 + (1 - A) k0 z^2 / (2 alpha) [J]."""
    elastic = parameters.bw_ratio * displacement * displacement
    bent = free_play.bristle(parameters, state)
    yielding = (1.0 - parameters.bw_ratio) * bent * bent / parameters.bw_alpha
    return 0.5 * parameters.bw_stiffness * (elastic + yielding) + 0.0 * velocity


def dissipated_power(
    parameters: FrictionParameters, displacement: Quantity, velocity: Quantity, state: Quantity
) -> Quantity:
    """Dissipated power (1 - A) k0 z (v - z' / alpha) [W]."""
    bent = free_play.bristle(parameters, state)
    bound = (1.0 - parameters.bw_ratio) * parameters.bw_stiffness * bent
    slip = velocity - rate(parameters, displacement, velocity, state) / parameters.bw_alpha
    return bound * slip
