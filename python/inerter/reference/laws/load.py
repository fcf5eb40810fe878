"""Load-dependent friction: a share of the force that the mechanism transmits.

    f_c becomes f_c + l,   l = mu |N|,   mu = mu_f where N v >= 0, mu_b where N v < 0

    none, Coulomb, Stribeck:   F = F_law + l tanh(v / v_t)
    Brown-McPhee:              F = F_law + l tanh(4 v / v_s)
    rate-and-state:            F = F_law + l bracket tanh(v / v_t), mu_b bracket <= 0.999
    Dahl, LuGre, Bouc-Wen, Maxwell-slip:   the force at which the bristle yields, `load_level`

Symbols: mu_f `mu_forward`, mu_b `mu_backward` [-] (both `load_friction` where not given), N force
through the inertance branch [N], v_t `transition_velocity` [m/s]. For an ideal inertance N = b a.
Sign: tension positive; F v >= 0.
Range: 0 <= mu_b < 1, so that the acceleration still follows uniquely from the force; with the
damper of LuGre mu sigma1 |v| < level besides, else `acceleration` and `Structure.joint` refuse.
Efficiency: power forward 1 / (1 + mu_f), backward 1 - mu_b.
Energy: the stiffness of a bristle does not follow the load, so that a load that changes does no
work on it, and the law is passive whatever the load does.
Source: Coulomb's law with the screw's own load as normal force; efficiency of a ball screw.
Not modelled: load from other branches; LuGre behind a series element leaves its damper out of N.

Solving for the acceleration is exact, because the law is piecewise linear in a:

    G = N + mu |N| t,  t = tanh(v / v_t)   gives   N = G / (1 + mu t sign(G)).

With the damper of LuGre it is not, and the acceleration is found by iteration.
"""

from __future__ import annotations

import numpy as np

from . import rate_state
from .device_parameters import DeviceParameters
from .parameters import Quantity


def bends(parameters: DeviceParameters) -> bool:
    """Whether the load raises the level of a bristle, so that the rate of its state follows N."""
    return max(parameters.load_shares) > 0.0 and parameters.friction in BENT


BENT = ("dahl", "lugre", "bouc_wen", "maxwell_slip")


def level(parameters: DeviceParameters, carried: Quantity, velocity: Quantity) -> Quantity:
    """What the force N [N] through the inertance adds to the friction level, mu |N| [N]."""
    forward, backward = parameters.load_shares
    return np.where(carried * velocity < 0.0, backward, forward) * abs(carried)


def share(
    parameters: DeviceParameters, carried: Quantity, velocity: Quantity, state: Quantity = 0.0
) -> Quantity:
    """The factor [-] on |N| of laws without a bristle; of N [N] only the sign counts."""
    if bends(parameters):
        return 0.0 * velocity
    forward, backward = parameters.load_shares
    back = carried * velocity < 0.0
    mu = forward if forward == backward else np.where(back, backward, forward)
    if parameters.friction == "rate_state":
        mu = mu * rate_state.bracket(parameters, velocity, state)
        mu = np.where(back, np.minimum(0.999, mu), mu)
    return mu * np.tanh(velocity / parameters.sign_width)


def force(
    parameters: DeviceParameters, carried: Quantity, velocity: Quantity, state: Quantity = 0.0
) -> Quantity:
    """That part of the friction [N] for the branch force N [N], velocity [m/s], friction state."""
    return share(parameters, carried, velocity, state) * abs(carried)
