"""The spring of the series element: elastic shaft or compressible fluid, with hardening.

    phi(d) = k_s (1 + q d) d

Symbols: d deflection of the spring [m], k_s `series_stiffness` [N/m],
q `series_hardening` [1/m].
Sign: tension positive; q > 0 is stiffer when the device is pulled, softer when it is pushed.
Range: the tangent k_s (1 + 2 q d) turns negative at d_c = -1 / (2 q). Beyond it phi stays at
phi(d_c), so that the law is monotone everywhere; results from there are outside the model.
Stored: U(d), the integral of phi. Nothing is dissipated.
Source: fluid inerter experiment, k_f = k0 [1 - k' (x2 - x1)] with q = k', d = x1 - x2; linear
(q = 0) in Wang and Su, "Inerter nonlinearities", ACC 2008.
Not modelled: cavitation, yielding.
"""

from __future__ import annotations

import numpy as np

from .device_parameters import DeviceParameters
from .parameters import Quantity


def corner(parameters: DeviceParameters) -> float:
    """Deflection d_c [m] beyond which the force is constant; infinite without hardening."""
    hardening = parameters.series_hardening
    return np.inf if hardening == 0.0 else -0.5 / hardening


def inside(parameters: DeviceParameters, deflection: Quantity) -> Quantity:
    """The deflection [m], limited to where the tangent is not negative."""
    hardening = parameters.series_hardening
    if hardening == 0.0:
        return deflection
    limit = np.maximum if hardening > 0.0 else np.minimum
    return limit(deflection, corner(parameters))


def force(parameters: DeviceParameters, deflection: Quantity) -> Quantity:
    """Spring force phi [N]."""
    within = inside(parameters, deflection)
    return parameters.series_stiffness * (1.0 + parameters.series_hardening * within) * within


def stored_energy(parameters: DeviceParameters, deflection: Quantity) -> Quantity:
    """Energy U [J]."""
    within = inside(parameters, deflection)
    cubic = parameters.series_hardening * within / 3.0
    quadratic = parameters.series_stiffness * within * within * (0.5 + cubic)
    return quadratic + force(parameters, deflection) * (deflection - within)
