"""Friction level: how f_c and f_s change with direction and along the stroke.

    level(x, v) = (1 + p tanh(v / v_t)) max(0.001, 1 + q x + r x^2 + f(x))
    with f_back(x) for v < 0:  p = 0, and that of either direction by (1 +- tanh(v / v_t)) / 2

Symbols: x displacement [m] (itself, not minus the rest length), v velocity [m/s],
p `friction_asymmetry` [-], q `friction_gradient` [1/m], r `friction_curvature` [1/m^2],
v_t `transition_velocity` [m/s], f and f_back the curves `friction` and `friction_back` of
`stroke.py` [-].
Sign: p > 0 raises the level while the device lengthens; q > 0 raises it towards longer devices.
Range: |p| < 1. The floor keeps laws with a bristle (Dahl, LuGre), which divide by the level, from
dividing by zero.
Source: this project's definition; the smallest form that tells direction from position.
Not modelled: change with temperature, wear or load (load: see `load.py`). Of Bouc-Wen, curves alone
change the level.
"""

from __future__ import annotations

import numpy as np

from .parameters import FrictionParameters, Quantity


def friction_level(
    parameters: FrictionParameters, displacement: Quantity, velocity: Quantity
) -> Quantity:
    """Factor [-] on `coulomb_force` and `static_force`; shape of x and v broadcast together."""
    rise = parameters.friction_gradient + parameters.friction_curvature * displacement
    rise = rise * displacement
    along = parameters.along
    if "friction" in along or "friction_back" in along:
        forth = along["friction"](displacement) if "friction" in along else 0.0
        level = np.maximum(1e-3, 1.0 + rise + forth)
        if "friction_back" in along:
            back = np.maximum(1e-3, 1.0 + rise + along["friction_back"](displacement))
            side = 0.5 + 0.5 * np.tanh(velocity / parameters.transition_velocity)
            return side * level + (1.0 - side) * back
        direction = np.tanh(velocity / parameters.transition_velocity)
        return level * (1.0 + parameters.friction_asymmetry * direction)
    level = 1.0
    if parameters.friction_asymmetry != 0.0:
        direction = np.tanh(velocity / parameters.transition_velocity)
        level = 1.0 + parameters.friction_asymmetry * direction
    if parameters.friction_gradient != 0.0 or parameters.friction_curvature != 0.0:
        level = level * np.maximum(1e-3, 1.0 + rise)
    return level
