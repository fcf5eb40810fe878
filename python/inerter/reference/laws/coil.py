"""Friction in a coiled channel: what the secondary flow of the bends adds.

    f  = [(64 c / Re)^12 + f_t^12]^(1/12),   f_t = 8 (P + Q)^(-1/8) + 0.03 sqrt(D / D_c)
    c  = 1 / (1 - (1 - (11.6 / De)^0.45)^2.2)   for De > 11.6, else 1
    De = Re sqrt(D / D_c),   P, Q as in `channel.py`

Symbols: Re Reynolds number [-], De Dean number [-], D channel's diameter [m], D_c `coil_diameter`
[m], f Darcy's friction factor [-].
Range: c for De up to 2000; D < D_c. With D_c to infinity this is the straight channel's formula.
Source: laminar: C. M. White, Proc. R. Soc. A 123, 1929; turbulent: P. Mishra and S. N. Gupta, Ind.
Eng. Chem. Process Des. Dev. 18, 1979, four times their Fanning factor's 0.0075 sqrt(D / D_c).
Not modelled: pitch of the coil, entrance length, unsteady wall friction.
"""

from __future__ import annotations

import numpy as np

from .stroke import Quantity


def friction_product(reynolds: Quantity, relative_roughness: float, curvature: float) -> Quantity:
    """The product f Re [-] at the Reynolds number, r / D [-] and D / D_c [-]."""
    number = np.maximum(reynolds, 1e-6)
    dean = np.maximum(number * np.sqrt(curvature), 11.6)
    laminar = 64.0 / (1.0 - (1.0 - (11.6 / dean) ** 0.45) ** 2.2)

    # Re^2 times Q^(-1/8) is finite at rest
    bracket = (7.0 / number) ** 0.9 + 0.27 * relative_roughness
    rough = (2.457 * np.log(bracket)) ** 16
    straight = 8.0 * number**2 / (rough * number**16 + 37530.0**16) ** 0.125
    turbulent = number * (straight + 0.03 * np.sqrt(curvature))
    return laminar * (1.0 + (turbulent / laminar) ** 12) ** (1.0 / 12.0)
