"""Hydraulic and silicone oils at atmospheric pressure: typical values, not those of one product.

    mineral:  lg lg (nu + 0.7) = A - B lg T,  through nu at 40 and 100 degC
    silicone: lg nu = lg nu_25 + 763.1 / T - 2.559
    rho = rho_0 / (1 + beta (T - T_0)),  mu = rho nu

Symbols: nu [mm^2/s], T [K], rho [kg/m^3], beta [1/K].
Sources: ISO 3448 for nu at 40 degC of a viscosity grade, at 100 degC what a viscosity index of 100
gives; ASTM D341 (Walther) between them. Densities (860 to 890 kg/m^3 at 15 degC) and expansion are
usual data-sheet values. Silicone: the rule of Shin-Etsu's brochure on KF-96 (100 mm^2/s and more,
25 to 250 degC; extrapolated to 0 degC here), densities and expansion as data sheets have them. Bulk
moduli: 1.6 GPa is the middle of 1.4 to 1.8 GPa for mineral oil, 1.03 GPa is the value of 100 mm^2/s
silicone in the Lee Company's hydraulic handbook. The brochure and the sheets were not at hand:
compare with your product's before you rely on them. Vapour pressures are upper bounds; dissolved
air comes out well before.
Not modelled: pressure dependence, shear thinning of thick silicones.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

_ZERO = 273.15


@dataclass(frozen=True, kw_only=True)
class Oil:
    """What mineral and silicone oils share; `reference` [K] is where `reference_density` holds."""

    reference: float
    reference_density: float
    expansion: float
    vapour_pressure: float
    bulk_modulus: float
    lowest: float
    highest: float

    def kinematic(self, temperature: float) -> float:
        """Kinematic viscosity [mm^2/s] at a temperature [K]."""
        raise NotImplementedError

    def density(self, temperature: float) -> float:
        """Density [kg/m^3] at a temperature [K]."""
        return self.reference_density / (1.0 + self.expansion * (temperature - self.reference))

    def viscosity(self, temperature: float) -> float:
        """Dynamic viscosity [Pa s] at a temperature [K]."""
        return 1e-6 * self.kinematic(temperature) * self.density(temperature)


@dataclass(frozen=True, kw_only=True)
class MineralOil(Oil):
    """Walther's line through the viscosities [mm^2/s] at 40 and 100 degC."""

    at_40: float
    at_100: float

    def kinematic(self, temperature: float) -> float:
        """Kinematic viscosity [mm^2/s] at a temperature [K]."""
        cold, hot = math.log10(_ZERO + 40.0), math.log10(_ZERO + 100.0)
        high, low = (math.log10(math.log10(nu + 0.7)) for nu in (self.at_40, self.at_100))
        share = (math.log10(temperature) - cold) / (hot - cold)
        return 10.0**10.0 ** (high + (low - high) * share) - 0.7


@dataclass(frozen=True, kw_only=True)
class SiliconeOil(Oil):
    """Viscosity [mm^2/s] at 25 degC and the rule for dimethyl silicones."""

    at_25: float

    def kinematic(self, temperature: float) -> float:
        """Kinematic viscosity [mm^2/s] at a temperature [K]."""
        return self.at_25 * 10.0 ** (763.1 / temperature - 763.1 / (_ZERO + 25.0))


def _mineral(at_40: float, at_100: float, density: float) -> MineralOil:
    return MineralOil(
        reference=_ZERO + 15.0, reference_density=density, expansion=7e-4, vapour_pressure=100.0,
        bulk_modulus=1.6e9, lowest=_ZERO, highest=_ZERO + 100.0, at_40=at_40, at_100=at_100,
    )  # fmt: skip


def _silicone(at_25: float, density: float) -> SiliconeOil:
    return SiliconeOil(
        reference=_ZERO + 25.0, reference_density=density, expansion=9.5e-4, vapour_pressure=10.0,
        bulk_modulus=1.03e9, lowest=_ZERO, highest=_ZERO + 200.0, at_25=at_25,
    )  # fmt: skip


OILS: Mapping[str, Oil] = MappingProxyType(
    {
        "hydraulic_oil_32": _mineral(32.0, 5.4, 870.0),
        "hydraulic_oil_46": _mineral(46.0, 6.8, 875.0),
        "hydraulic_oil_68": _mineral(68.0, 8.7, 880.0),
        "silicone_oil_100": _silicone(100.0, 965.0),
        "silicone_oil_350": _silicone(350.0, 970.0),
        "silicone_oil_1000": _silicone(1000.0, 970.0),
    }
)
