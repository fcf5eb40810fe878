"""No friction: F = 0, no state, nothing stored, nothing dissipated."""

from __future__ import annotations

import numpy as np

from .parameters import FrictionParameters, Quantity

STATES = 0


def rate(
    parameters: FrictionParameters, displacement: Quantity, velocity: Quantity, state: Quantity
) -> Quantity:
    """Rate of the state [m/s]: zero."""
    return np.zeros(np.shape(velocity)) if np.ndim(velocity) else 0.0


def force(
    parameters: FrictionParameters, displacement: Quantity, velocity: Quantity, state: Quantity
) -> Quantity:
    """Friction force [N]: zero."""
    return rate(parameters, displacement, velocity, state)


def stored_energy(
    parameters: FrictionParameters, displacement: Quantity, velocity: Quantity, state: Quantity
) -> Quantity:
    """Stored energy [J]: zero."""
    return rate(parameters, displacement, velocity, state)


def dissipated_power(
    parameters: FrictionParameters, displacement: Quantity, velocity: Quantity, state: Quantity
) -> Quantity:
    """Dissipated power [W]: zero."""
    return rate(parameters, displacement, velocity, state)
