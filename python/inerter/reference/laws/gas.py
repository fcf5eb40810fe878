"""Gas spring: enclosed gas against the atmosphere.

    polytropic: F = p0 A (1 - (1 + A y / V0)^-gamma)
    expanded:   F = k_a (1 - (gamma + 1)/2 (A / V0) y) y,   k_a = gamma p0 A^2 / V0

Symbols: y displacement of the flywheel side [m], p0 `gas_pressure` [Pa] (also outside),
A `gas_area` [m^2] (NaN: `piston_area`), V0 `gas_volume` [m^3], gamma `gas_exponent` [-].
Sign: tension positive; a longer device holds more gas, volume V0 + A y, and with A < 0 less: the
gas is on the other side of the piston.
Range: polytropic: 1 + A y / V0 > 0.05, below that the law goes on along its tangent. Expanded:
y < y_c = V0 / ((gamma + 1) A), where its tangent turns negative; beyond it stays constant.
Stored: the integral of F from 0 to y. Nothing is dissipated.
Source: the expanded form is eq. (10) of the fluid inerter experiment, a second-order expansion of
the polytropic one, which is elementary thermodynamics.
Why both: the printed one is what was identified; its stiffness turns negative as the gas grows,
the polytropic one never does.
Not modelled: heat exchange (gamma is constant), condensation, gas dissolved in the liquid.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .device_parameters import DeviceParameters
from .parameters import Quantity

LEAST_VOLUME = 0.05


def area(parameters: DeviceParameters) -> float:
    """A [m^2]."""
    unset = np.isnan(parameters.gas_area)
    return parameters.piston_area if unset else parameters.gas_area


def limit(parameters: DeviceParameters) -> float:
    """The displacement [m] at which the law leaves its validity."""
    reach = parameters.gas_volume / area(parameters)
    if parameters.gas_law == "polytropic":
        return (LEAST_VOLUME - 1.0) * reach
    return reach / (parameters.gas_exponent + 1.0)


def valid(parameters: DeviceParameters, displacement: Quantity) -> bool | NDArray[np.bool_]:
    """Whether the displacement [m] is inside the law's validity; always without gas."""
    if parameters.gas_pressure == 0.0:
        return displacement == displacement
    if parameters.gas_law == "polytropic":
        return _side(parameters) * displacement > _side(parameters) * limit(parameters)
    return _side(parameters) * displacement < _side(parameters) * limit(parameters)


def force(parameters: DeviceParameters, displacement: Quantity) -> Quantity:
    """Gas force [N]."""
    if parameters.gas_pressure == 0.0:
        return 0.0 * displacement
    edge, gamma = limit(parameters), parameters.gas_exponent
    push, fill = _scales(parameters)
    if parameters.gas_law == "expanded":
        within = _at_most(parameters, displacement, edge)
        return gamma * push * fill * (1.0 - 0.5 * (gamma + 1.0) * fill * within) * within
    within = _at_least(parameters, displacement, edge)
    ratio = 1.0 + fill * within
    tangent = gamma * push * fill * LEAST_VOLUME ** (-gamma - 1.0)
    return push * (1.0 - ratio**-gamma) + tangent * (displacement - within)


def stored_energy(parameters: DeviceParameters, displacement: Quantity) -> Quantity:
    """Energy [J] in the gas and the atmosphere it pushes back; 0 at y = 0."""
    if parameters.gas_pressure == 0.0:
        return 0.0 * displacement
    edge, gamma = limit(parameters), parameters.gas_exponent
    push, fill = _scales(parameters)
    if parameters.gas_law == "expanded":
        within = _at_most(parameters, displacement, edge)
        bracket = 0.5 - (gamma + 1.0) * fill * within / 6.0
        inside = gamma * push * fill * within * within * bracket
        return inside + force(parameters, edge) * (displacement - within)

    # (r^(1 - gamma) - 1) / (1 - gamma) with its limit ln r
    within = _at_least(parameters, displacement, edge)
    log_ratio = np.log(1.0 + fill * within)
    power = 1.0 - gamma
    compression = log_ratio if power == 0.0 else np.expm1(power * log_ratio) / power
    beyond = displacement - within
    tangent = gamma * push * fill * LEAST_VOLUME ** (-gamma - 1.0)
    return (
        push * (within - compression / fill)
        + (force(parameters, within) + 0.5 * tangent * beyond) * beyond
    )


def _side(parameters: DeviceParameters) -> float:
    """The sign of displacements that make the gas grow."""
    return float(np.sign(area(parameters)))


def _at_most(parameters: DeviceParameters, displacement: Quantity, edge: float) -> Quantity:
    """Displacements [m] that let the gas grow no further than an edge does."""
    side = _side(parameters)
    return side * np.minimum(side * displacement, side * edge)


def _at_least(parameters: DeviceParameters, displacement: Quantity, edge: float) -> Quantity:
    """Displacements [m] that press the gas no further than an edge does."""
    side = _side(parameters)
    return side * np.maximum(side * displacement, side * edge)


def _scales(parameters: DeviceParameters) -> tuple[float, float]:
    """p0 A [N] and A / V0 [1/m]."""
    surface = area(parameters)
    return parameters.gas_pressure * surface, surface / parameters.gas_volume
