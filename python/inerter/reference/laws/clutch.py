"""What slips in series with the inertance: a clutch, or a fluid that leaks past its piston.

    S(u) = sign(u) (F_c(u) + c_l |u| + q_l u^2),   F_c = clutch_force (1 + clutch_asymmetry sign(u))
    held, u = 0:  -F_c(-) <= F_s <= F_c(+);   slipping:  F_s = S(u)
    with the spring and the damper before it:  F_s = phi(d) + c_s (s' - u),   d' = s' - u

Symbols: u velocity of the slip [m/s], c_l `leak_damping` [N s/m], q_l `leak_quadratic_damping`
[N s^2/m^2], s' rate of the series deflection [m/s], phi(d) see `series_spring.py`.
Sign: tension positive; u > 0 lets the terminals part.
Range: without spring and damper before it u = s', and there is no clutch. A clutch needs one of the
three dampers c_s, c_l, q_l: what slips would else have no rate.
Stored: nothing. Dissipated: F_s u >= 0.
Source: Coulomb's torque limiter; of a leak, laminar or turbulent, the flow adds to that through
the channel of a fluid inerter at the same pressure.
Not modelled: a breakaway force above the sliding one.
"""

from __future__ import annotations

import numpy as np

from .device_parameters import DeviceParameters
from .parameters import Quantity


def limits(parameters: DeviceParameters) -> tuple[float, float]:
    """The forces [N] between which it holds, in compression (not positive) and in tension."""
    level, asymmetry = parameters.clutch_force, parameters.clutch_asymmetry
    return -level * (1.0 - asymmetry), level * (1.0 + asymmetry)


def law(parameters: DeviceParameters, speed: Quantity) -> Quantity:
    """S(u) [N] of a slip that is not 0."""
    lower, upper = limits(parameters)
    level = np.where(speed > 0.0, upper, np.where(speed < 0.0, lower, 0.0))
    leak = parameters.leak_damping + parameters.leak_quadratic_damping * np.abs(speed)
    return level + leak * speed


def rate(parameters: DeviceParameters, spring: Quantity, series_rate: Quantity) -> Quantity:
    """U [m/s] where the spring bears `spring` [N] and the element lengthens at s' [m/s]."""
    damping, (lower, upper) = parameters.series_damping, limits(parameters)
    if parameters.series_stiffness == 0.0 and damping == 0.0:
        return series_rate + 0.0
    held = spring + damping * series_rate
    # what is beyond the limits, shared by the dampers: (c_s + c_l) u + q u |u|
    beyond = np.maximum(held - upper, 0.0) + np.minimum(held - lower, 0.0)
    linear, quadratic = damping + parameters.leak_damping, parameters.leak_quadratic_damping
    # the root of q u^2 + c u = |beyond|, without the difference of two large numbers
    root = np.hypot(linear, 2.0 * np.sqrt(quadratic * np.abs(beyond)))
    share = 0.5 * linear + 0.5 * root
    return beyond / np.where(share > 0.0, share, 1.0)


def force(parameters: DeviceParameters, spring: Quantity, series_rate: Quantity) -> Quantity:
    """F_s [N] there."""
    damping = parameters.series_damping
    if parameters.series_stiffness == 0.0 and damping == 0.0:
        return law(parameters, series_rate)
    return spring + damping * (series_rate - rate(parameters, spring, series_rate))
