"""Load-dependent friction: a share of the force that the mechanism transmits.

    F = mu |N| tanh(v / v_t)

Symbols: mu `load_friction` [-], N force through the inertance branch [N],
v_t `transition_velocity` [m/s]. For an ideal inertance N = b a.
Sign: tension positive; F v >= 0.
Range: 0 <= mu < 1, so that the acceleration still follows uniquely from the force.
Source: Coulomb's law with the screw's own load as normal force; efficiency of a ball screw.
Not modelled: different losses when driving and when back-driven, load from other branches.

Solving for the acceleration is exact, because the law is piecewise linear in a:

    G = N + mu |N| t,  t = tanh(v / v_t)   gives   N = G / (1 + mu t sign(G)).
"""

from __future__ import annotations

import numpy as np

from .parameters import Quantity


def force(
    inertance_force: Quantity,
    velocity: Quantity,
    *,
    load_friction: float,
    transition_velocity: float,
) -> Quantity:
    """Load-dependent friction [N] for the branch force N [N] and velocity [m/s]."""
    return load_friction * abs(inertance_force) * np.tanh(velocity / transition_velocity)


def share(velocity: Quantity, *, load_friction: float, transition_velocity: float) -> Quantity:
    """The factor mu tanh(v / v_t) [-], so that the force is share |N|."""
    return load_friction * np.tanh(velocity / transition_velocity)
