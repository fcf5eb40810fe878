"""Load-dependent friction: a share of the force that the mechanism transmits.

    F = mu |N| tanh(v / v_t),   mu = mu_f where N v >= 0, mu_b where N v < 0

Symbols: mu_f `mu_forward`, mu_b `mu_backward` [-] (both `load_friction` where not given), N force
through the inertance branch [N], v_t `transition_velocity` [m/s]. For an ideal inertance N = b a.
Sign: tension positive; F v >= 0.
Range: 0 <= mu_b < 1, so that the acceleration still follows uniquely from the force.
Efficiency: power forward 1 / (1 + mu_f), backward 1 - mu_b.
Source: Coulomb's law with the screw's own load as normal force; efficiency of a ball screw.
Not modelled: memory of this friction, load from other branches.

Solving for the acceleration is exact, because the law is piecewise linear in a:

    G = N + mu |N| t,  t = tanh(v / v_t)   gives   N = G / (1 + mu t sign(G)).
"""

from __future__ import annotations

import numpy as np

from .device_parameters import DeviceParameters
from .parameters import Quantity


def share(parameters: DeviceParameters, carried: Quantity, velocity: Quantity) -> Quantity:
    """The factor mu tanh(v / v_t) [-] on |N|; of N [N] only the sign counts."""
    forward, backward = parameters.load_shares
    mu = forward if forward == backward else np.where(carried * velocity < 0.0, backward, forward)
    return mu * np.tanh(velocity / parameters.transition_velocity)


def force(parameters: DeviceParameters, carried: Quantity, velocity: Quantity) -> Quantity:
    """Load-dependent friction [N] for the branch force N [N] and velocity [m/s]."""
    return share(parameters, carried, velocity) * abs(carried)
