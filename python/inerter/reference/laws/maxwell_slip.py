"""Maxwell-slip friction: elements side by side, each an elastic spring that slips at its own force.

    F = sum of k_i z_i
    z_i' = v          as long as |k_i z_i| < f_i level(x, v), or v takes it away from its limit
    z_i' = v (1 - k_i z_i sgn(v) / (f_i level))     at the limit (where that is 0) and beyond

Symbols: z_i deflection of element i [m], k_i `slip_stiffness_i` [N/m], f_i `slip_force_i` [N],
level see `level.py`, to which a load l adds l / sum of f_i (`load.py`). Elements 1 to n; those
with stiffness 0 are not there.
Sign: tension positive; z_i grows with x.
Range: k_i, f_i > 0. Beyond its limit an element is only where the level has fallen under it.
Stored: sum of k_i z_i^2 / 2. Dissipated: sum of k_i z_i (v - z_i'), never negative.
Source: Iwan, "A distributed-element model for hysteresis", J. Appl. Mech. 33, 1966; Lampaert,
Al-Bender and Swevers, "A generalized Maxwell-slip friction model", 2003, in its quasi-static form.
Not modelled: Stribeck fall, sliding dynamics of an element, free play.

A state has the elements along its last axis; with one element, that axis may be missing.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .level import friction_level
from .parameters import FrictionParameters, Quantity

STATES = 8
"""At most."""


REACHED = 1e-12
"""Share of the limit within which an element counts as being at it: rounding does not free it."""


def elements(parameters: FrictionParameters) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Stiffnesses k_i [N/m] and slip forces f_i [N] of those that are there, shape (n,)."""
    pairs = [
        (getattr(parameters, f"slip_stiffness_{i}"), getattr(parameters, f"slip_force_{i}"))
        for i in range(1, STATES + 1)
    ]
    there = np.array([pair for pair in pairs if pair[0] > 0.0]).reshape(-1, 2)
    return there[:, 0], there[:, 1]


def count(parameters: FrictionParameters) -> int:
    """How many elements, and states, there are."""
    return elements(parameters)[0].size


def _wide(parameters: FrictionParameters, state: Quantity) -> NDArray[np.float64]:
    """The state with the axis of the elements."""
    array, n = np.asarray(state, dtype=np.float64), count(parameters)
    if array.ndim == 0 and array == 0.0:
        return np.zeros(n)
    return array[..., np.newaxis] if n == 1 else array


def rate(
    parameters: FrictionParameters, displacement: Quantity, velocity: Quantity, state: Quantity
) -> Quantity:
    """Rates of the deflections [m/s], in the form of the state."""
    stiffness, force_limit = elements(parameters)
    level = friction_level(parameters, displacement, velocity)
    level = level + parameters.load_level / force_limit.sum()
    level = np.asarray(level)[..., np.newaxis]
    speed, z = np.asarray(velocity)[..., np.newaxis], _wide(parameters, state)
    reached = stiffness * z * np.sign(speed) / (force_limit * level)
    if parameters.slip_knee > 0.0:
        left = 1.0 - reached
        rates = speed * np.where(left < 0.0, left, np.minimum(1.0, left / parameters.slip_knee))
    else:
        rates = np.where(reached < 1.0 - REACHED, speed, speed * (1.0 - reached))
    return rates[..., 0] if stiffness.size == 1 else rates


def force(
    parameters: FrictionParameters, displacement: Quantity, velocity: Quantity, state: Quantity
) -> Quantity:
    """Friction force [N], tension positive."""
    return _wide(parameters, state) @ elements(parameters)[0] + 0.0 * velocity


def stored_energy(
    parameters: FrictionParameters, displacement: Quantity, velocity: Quantity, state: Quantity
) -> Quantity:
    """Energy in the springs [J]."""
    return 0.5 * _wide(parameters, state) ** 2 @ elements(parameters)[0] + 0.0 * velocity


def dissipated_power(
    parameters: FrictionParameters, displacement: Quantity, velocity: Quantity, state: Quantity
) -> Quantity:
    """Heat of the slipping elements [W]."""
    rates = np.asarray(rate(parameters, displacement, velocity, state))
    slip = np.asarray(velocity)[..., np.newaxis] - (
        rates[..., np.newaxis] if count(parameters) == 1 else rates
    )
    return (_wide(parameters, state) * slip) @ elements(parameters)[0]
