"""Compressible liquid in the chambers, trapped air, and the frequencies they give.

    1 / K_e = (1 - phi) / K + phi / (gamma p_0)      liquid with free bubbles (Wood)
    k_s = 2 K_e A1^2 / V                             both chambers at mid-stroke, channel blocked
    k_a = gamma p_0 A1^2 / V_0                       trapped air
    f_0 = sqrt((k_s + k_a) / b) / (2 pi)             anti-resonance of the driven piston

Symbols: K [Pa] isentropic bulk modulus, phi [-] volume share of bubbles, gamma polytropic exponent,
p_0 [Pa] absolute pressure at rest, A1 [m^2] piston area, V [m^3] volume of one chamber, V_0 [m^3]
volume of the trapped air, b [kg] inertance.
Sign: both stiffnesses are of the force that lengthens the device.
Not modelled: compression of the liquid in the channel itself (its first acoustic resonance
c / (2 l) is given beside, and should lie well above f_0), elastic walls and hoses (lower the bulk
modulus), volumes that change along the stroke (k_s grows towards its ends).
"""

from __future__ import annotations

import math


def effective_modulus(
    bulk_modulus: float, air_fraction: float, static_pressure: float, exponent: float
) -> float:
    """K_e [Pa]."""
    return 1.0 / ((1.0 - air_fraction) / bulk_modulus + air_fraction / (exponent * static_pressure))


def series_stiffness(modulus: float, area: float, chamber: float) -> float:
    """k_s [N/m] of two equal chambers of volume [m^3]."""
    return 2.0 * modulus * area**2 / chamber


def gas_stiffness(pressure: float, area: float, volume: float, exponent: float) -> float:
    """k_a [N/m] at rest."""
    return exponent * pressure * area**2 / volume


def frequency(stiffness: float, inertance: float) -> float:
    """Frequency [Hz] of an inertance [kg] on a stiffness [N/m]."""
    return math.sqrt(stiffness / inertance) / (2.0 * math.pi)
