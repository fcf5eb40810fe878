"""A control that sets a parameter: semi-active dampers and inerters.

    p = p0 + z limited to [lower, upper],   z' = (u - p0 - z) / T,   u limited as p is
    without lag (T = 0):  p = u

Symbols: p the parameter that `control` names, in its unit; u `command`; p0 the value that is
stated, where none is the default within the bounds; T `control_lag` [s]; lower, upper
`control_lower`, `control_upper`; z "control_change", the state, 0 at the value that is stated.
Energy: the laws hold at the value of the moment, so that the actuator gives dE/dp p' [W], E the
stored energy: p' v^2 / 2 of an inertance, p' x^2 / 2 of a spring; nothing of dampers and friction.
Source: Hu, Chen, Shu, Huang 2014 (semi-active inerter, F = b(t) a); first-order lag.
Not modelled: what the actuator itself needs.
"""

from __future__ import annotations

import numpy as np

from .device_parameters import DeviceParameters
from .parameters import Quantity


def count(parameters: DeviceParameters) -> int:
    """How many states the control has."""
    return int(parameters.control != "force" and parameters.control_lag > 0.0)


def rest(parameters: DeviceParameters) -> float:
    """The value that is stated."""
    return float(getattr(parameters, parameters.control))


def commanded(parameters: DeviceParameters) -> float:
    """The value that is commanded, within the bounds; without a command the one that is stated."""
    if np.isnan(parameters.command):
        return rest(parameters)
    return float(np.clip(parameters.command, parameters.control_lower, parameters.control_upper))


def value(parameters: DeviceParameters, change: Quantity) -> Quantity:
    """The parameter now, of the shape of its change."""
    if not count(parameters):
        return commanded(parameters)
    present = rest(parameters) + change
    return np.clip(present, parameters.control_lower, parameters.control_upper)


def rate(parameters: DeviceParameters, change: Quantity) -> Quantity:
    """Rate of the change [1/s times its unit]."""
    return (commanded(parameters) - rest(parameters) - change) / parameters.control_lag


def value_rate(parameters: DeviceParameters, change: Quantity) -> Quantity:
    """Rate of the parameter itself: 0 while it is held at a bound."""
    present = rest(parameters) + change
    free = (present >= parameters.control_lower) & (present <= parameters.control_upper)
    return np.where(free, rate(parameters, change), 0.0)
