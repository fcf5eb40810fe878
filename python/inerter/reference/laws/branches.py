"""Viscoelastic branches between the terminals: springs, each with a dashpot in series.

    F = sum of K_i e_i,   e_i' = v - K_i e_i / C_i

Symbols: e_i deflection of the spring of branch i [m], K_i `branch_stiffness_i` [N/m], C_i
`branch_damping_i` [N s/m], v velocity of the terminals [m/s]. At most three; a branch with
stiffness 0 is not there.
Sign: tension positive.
Range: linear. At an angular frequency w the stiffness is sum of K_i / (1 + K_i / (i w C_i)).
Stored: sum of K_i e_i^2 / 2. Dissipated: sum of C_i (v - e_i')^2.
Source: Maxwell elements in parallel (Wiechert body), Ferry, Viscoelastic Properties of Polymers.
Not modelled: amplitude and temperature dependence.

Deflections have the branches along their last axis.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .device_parameters import DeviceParameters
from .parameters import Quantity


def count(parameters: DeviceParameters) -> int:
    """How many branches there are."""
    return parameters.branches[0].size


def rates(
    parameters: DeviceParameters, velocity: Quantity, deflections: NDArray[np.float64]
) -> NDArray[np.float64]:
    """e_i' [m/s], of the shape of the deflections and the velocity's."""
    stiffness, damping = parameters.branches
    return np.asarray(velocity)[..., np.newaxis] - deflections * (stiffness / damping)


def force(parameters: DeviceParameters, deflections: NDArray[np.float64]) -> Quantity:
    """F [N]."""
    return deflections @ parameters.branches[0]


def stored_energy(parameters: DeviceParameters, deflections: NDArray[np.float64]) -> Quantity:
    """Energy in the springs [J]."""
    return 0.5 * deflections**2 @ parameters.branches[0]


def dissipated_power(
    parameters: DeviceParameters, velocity: Quantity, deflections: NDArray[np.float64]
) -> Quantity:
    """Heat in the dashpots [W]."""
    flow = np.asarray(velocity)[..., np.newaxis] - rates(parameters, velocity, deflections)
    return flow**2 @ parameters.branches[1]
