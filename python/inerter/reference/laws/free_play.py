"""Free play before a friction law with a bristle, told by the one state that both share.

    z = 0 for |s| <= eps,   s - eps above,   s + eps below
    s' = v in the play,     s' = z'(x, v, z) where the bristle is engaged

Symbols: s place in the play plus deflection of the bristle [m], eps `friction_backlash` [m] (half
of the play), z deflection of the bristle [m]. At |s| = eps the bristle is engaged for a motion
outwards.
Sign: tension positive; s grows with x.
Range: eps >= 0; eps = 0 is the law itself. One state suffices because a friction force of zero and
a straight bristle are the same thing in these laws.
Stored: that of the law at z. Dissipated in the play: nothing.
Source: a dead zone in series with a bristle; a contact presses and never pulls, as in `series.py`.
Not modelled: damping or friction inside the play, impacts, a mass between play and bristle.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .parameters import FrictionParameters, Quantity


def bristle(parameters: FrictionParameters, state: Quantity) -> Quantity:
    """Deflection z [m] of the bristle at a state s [m], of its shape."""
    half = parameters.friction_backlash
    if half == 0.0:
        return state
    return np.sign(state) * np.maximum(0.0, abs(state) - half)


def is_engaged(
    parameters: FrictionParameters, velocity: Quantity, state: Quantity
) -> NDArray[np.bool_]:
    """Whether the bristle moves with the terminals; v [m/s] and s [m] broadcast together."""
    half = parameters.friction_backlash
    outwards = velocity * np.sign(state) > 0.0
    return np.asarray((abs(state) > half) | ((abs(state) == half) & outwards) | (half == 0.0))


def state_rate(
    parameters: FrictionParameters, velocity: Quantity, state: Quantity, engaged_rate: Quantity
) -> Quantity:
    """Rate of the state [m/s], given the law's z' [m/s] at `bristle(state)`."""
    if parameters.friction_backlash == 0.0:
        return engaged_rate
    return np.where(is_engaged(parameters, velocity, state), engaged_rate, velocity)


def pressing(parameters: FrictionParameters, state: Quantity, force: Quantity) -> Quantity:
    """A force [N] of the engaged bristle, without what would pull across the play."""
    if parameters.friction_backlash == 0.0:
        return force
    return np.sign(state) * np.maximum(0.0, np.sign(state) * force)
