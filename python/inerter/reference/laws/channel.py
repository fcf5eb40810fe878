"""Fluid in a channel: its inertance, and what it loses to the walls and at the ends.

    b    = rho l A1^2 / A2
    pipe = A1 (f l / D + K) rho u^2 / 2 sign(w),   u = (A1 / A2) |w|,   Re = rho u D / mu
    f    = 8 [(8 / Re)^12 + (P + Q)^-1.5]^(1/12)
    P    = [2.457 ln(1 / ((7 / Re)^0.9 + 0.27 r / D))]^16,   Q = (37530 / Re)^16

Symbols: w piston velocity [m/s], u channel velocity [m/s], A1 `piston_area`, A2 `channel_area`
[m^2], l `channel_length` [m], D = sqrt(4 A2 / pi) [m], rho `fluid_density` [kg/m^3],
mu `fluid_viscosity` [Pa s], r `channel_roughness` [m], K `minor_loss` [-], f Darcy's friction
factor [-].
Sign: tension positive; the loss opposes the motion.
Range: all regimes in one smooth formula. Laminar: f = 64 / Re, pipe = 32 mu l A1 u / D^2. With
mu = 0 only K acts.
Dissipated: pipe w. The stored energy is the inertance's.
Source: inertance: Swift et al., "Design and modelling of a fluid inerter", Int. J. Control 86(11),
2013. Friction: Churchill, "Friction-factor equation spans all fluid-flow regimes", Chem. Eng.
84(24), 1977; the product f Re stays finite at rest, so that is what is computed.
A coil (`coil_diameter`) has another f: `coil.py`.
Not modelled: entrance length, unsteady wall friction.
"""

from __future__ import annotations

import numpy as np

from . import coil
from .device_parameters import DeviceParameters
from .parameters import Quantity


def inertance(parameters: DeviceParameters) -> float:
    """Inertance b [kg] of the fluid; 0 without a channel."""
    if parameters.channel_area == 0.0:
        return 0.0
    column = parameters.fluid_density * parameters.channel_length
    return column * parameters.piston_area**2 / parameters.channel_area


def friction_product(reynolds: Quantity, relative_roughness: float) -> Quantity:
    """The product f Re [-] at the Reynolds number and the roughness r / D [-]."""
    # below this the flow is laminar to the last digit, and the logarithm would fail at rest
    number = np.maximum(reynolds, 1e-6)
    bracket = (7.0 / number) ** 0.9 + 0.27 * relative_roughness
    rough = (2.457 * np.log(bracket)) ** 16

    # Re^12 (P + Q)^-1.5, multiplied out so that no power of 1 / Re is left
    turbulent = (number**24 / (rough * number**16 + 37530.0**16)) ** 1.5
    return 8.0 * (8.0**12 + turbulent) ** (1.0 / 12.0)


def force(parameters: DeviceParameters, velocity: Quantity) -> Quantity:
    """Loss [N] at the piston velocity [m/s]."""
    if parameters.channel_area == 0.0:
        return 0.0 * velocity
    flow = velocity * parameters.piston_area / parameters.channel_area
    total = 0.5 * parameters.fluid_density * parameters.minor_loss * abs(flow) * flow
    viscosity = parameters.fluid_viscosity
    if viscosity > 0.0:
        width = np.sqrt(4.0 * parameters.channel_area / np.pi)
        reynolds = parameters.fluid_density * abs(flow) * width / viscosity
        roughness = parameters.channel_roughness / width
        if parameters.coil_diameter > 0.0:
            curvature = float(width / parameters.coil_diameter)
            product = coil.friction_product(reynolds, roughness, curvature)
        else:
            product = friction_product(reynolds, roughness)
        total = total + product * viscosity * flow * parameters.channel_length / (2.0 * width**2)
    return parameters.piston_area * total


def dissipated_power(parameters: DeviceParameters, velocity: Quantity) -> Quantity:
    """Dissipated power pipe w [W]."""
    return force(parameters, velocity) * velocity
