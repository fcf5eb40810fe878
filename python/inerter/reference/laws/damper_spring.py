"""A spring in series with the dampers between the terminals: compressed oil, rubber mounts.

    F = D(w),   w' = k_d (v - w) / D'(w)

Symbols: w velocity over the dampers [m/s], v that of the terminals, D their force [N]
(`parallel.py`), D' its slope over the velocity [N s/m], k_d `damper_stiffness` [N/m].
Sign: tension positive.
Range: D rises; the spring is bent by D / k_d and linear.
Stored: D^2 / (2 k_d). Dissipated: D w.
Source: D = k_d e and e' = v - w, derived by time; Maxwell element with a damper of any law.
Not modelled: damping along the stroke or set by a control; damping that falls with the speed.
"""

from __future__ import annotations

from .device_parameters import DeviceParameters
from .parallel import damping_force, damping_slope
from .parameters import Quantity


def rate(parameters: DeviceParameters, velocity: Quantity, own: Quantity) -> Quantity:
    """W' [m/s^2]; `own` is w."""
    slope = damping_slope(own, *parameters.damper)
    return parameters.damper_stiffness * (velocity - own) / slope


def force(parameters: DeviceParameters, own: Quantity) -> Quantity:
    """F [N]."""
    return damping_force(own, *parameters.damper)


def stored_energy(parameters: DeviceParameters, own: Quantity) -> Quantity:
    """Energy in the spring [J]."""
    return 0.5 * force(parameters, own) ** 2 / parameters.damper_stiffness


def dissipated_power(parameters: DeviceParameters, own: Quantity) -> Quantity:
    """Heat in the dampers [W]."""
    return force(parameters, own) * own
