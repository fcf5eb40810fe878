"""Water at atmospheric pressure, 0 to 95 degC.

    rho  = polynomial of the 5th degree / (1 + 0.01687985 t)      t in degC
    mu   = 1e-6 sum a_i (T / 300 K)^b_i
    p_v  = p_c exp(T_c / T sum a_i tau^b_i),  tau = 1 - T / T_c
    K    = rho c^2,  c a polynomial of the 5th degree in t

Sources: density: G. S. Kell, J. Chem. Eng. Data 20(1), 1975 (ITS-90 shifts it by less than 0.01
kg/m^3 here). Viscosity at 0.1 MPa: IAPWS SR6-08(2011). Vapour pressure: Wagner and Pruss, J. Phys.
Chem. Ref. Data 31(2), 2002, as in IAPWS SR1-86(1992). Speed of sound: W. Marczak, J. Acoust. Soc.
Am. 102(5), 1997, 0 to 95 degC. K is the isentropic modulus: vibration leaves no time for heat.
"""

from __future__ import annotations

import math

_ZERO = 273.15
LOWEST = _ZERO
HIGHEST = _ZERO + 95.0

_DENSITY = (999.83952, 16.945176, -7.9870401e-3, -46.170461e-6, 105.56302e-9, -280.54253e-12)
_VISCOSITY = ((280.68, -1.9), (511.45, -7.7), (61.131, -19.6), (0.45903, -40.0))
_VAPOUR = (
    (-7.85951783, 1.0), (1.84408259, 1.5), (-11.7866497, 3.0), (22.6807411, 3.5),
    (-15.9618719, 4.0), (1.80122502, 7.5),
)  # fmt: skip
_CRITICAL_TEMPERATURE, _CRITICAL_PRESSURE = 647.096, 22.064e6
_SOUND = (1.402385e3, 5.038813, -5.799136e-2, 3.287156e-4, -1.398845e-6, 2.787860e-9)


def density(temperature: float) -> float:
    """Density [kg/m^3] at a temperature [K]."""
    t = temperature - _ZERO
    return _polynomial(_DENSITY, t) / (1.0 + 16.879850e-3 * t)


def viscosity(temperature: float) -> float:
    """Dynamic viscosity [Pa s] at a temperature [K]."""
    return 1e-6 * sum(a * (temperature / 300.0) ** b for a, b in _VISCOSITY)


def vapour_pressure(temperature: float) -> float:
    """Vapour pressure [Pa] at a temperature [K]."""
    tau = 1.0 - temperature / _CRITICAL_TEMPERATURE
    exponent = sum(a * tau**b for a, b in _VAPOUR)
    return _CRITICAL_PRESSURE * math.exp(exponent * _CRITICAL_TEMPERATURE / temperature)


def bulk_modulus(temperature: float) -> float:
    """Isentropic bulk modulus [Pa] at a temperature [K]."""
    return density(temperature) * _polynomial(_SOUND, temperature - _ZERO) ** 2


def _polynomial(coefficients: tuple[float, ...], t: float) -> float:
    return sum(c * t**n for n, c in enumerate(coefficients))
