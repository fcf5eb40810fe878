"""Liquids by name: density, viscosity, vapour pressure and bulk modulus at a temperature."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from inerter.design.fluid import oils, water
from inerter.design.inputs import DesignError

_ZERO = 273.15


@dataclass(frozen=True)
class Properties:
    """`density` [kg/m^3], `viscosity` [Pa s], `vapour_pressure` [Pa], `bulk_modulus` [Pa]."""

    density: float
    viscosity: float
    vapour_pressure: float
    bulk_modulus: float


@dataclass(frozen=True, kw_only=True)
class Liquid:
    """Functions of the temperature [K], valid between `lowest` and `highest`."""

    lowest: float
    highest: float
    density: Callable[[float], float]
    viscosity: Callable[[float], float]
    vapour_pressure: Callable[[float], float]
    bulk_modulus: Callable[[float], float]


def _oil(oil: oils.Oil) -> Liquid:
    return Liquid(
        lowest=oil.lowest,
        highest=oil.highest,
        density=oil.density,
        viscosity=oil.viscosity,
        vapour_pressure=lambda temperature: oil.vapour_pressure,
        bulk_modulus=lambda temperature: oil.bulk_modulus,
    )


LIQUIDS: Mapping[str, Liquid] = MappingProxyType(
    {
        "water": Liquid(
            lowest=water.LOWEST,
            highest=water.HIGHEST,
            density=water.density,
            viscosity=water.viscosity,
            vapour_pressure=water.vapour_pressure,
            bulk_modulus=water.bulk_modulus,
        ),
    }
    | {name: _oil(oil) for name, oil in oils.OILS.items()}
)


def properties(name: str, temperature: float) -> Properties:
    """Properties of a liquid at a temperature [K] and about atmospheric pressure.

    Raises
    ------
    DesignError
        The temperature is outside the range of the correlations.
    """
    liquid = LIQUIDS[name]
    if not liquid.lowest <= temperature <= liquid.highest:
        hint = ""
        if temperature < 200.0:
            hint = f'; a plain number is in kelvin, write "{temperature:g} degC"'
        raise DesignError(
            f"temperature is {temperature:g} K, out of the range of {name}: give "
            f"{liquid.lowest:g} to {liquid.highest:g} K "
            f"({liquid.lowest - _ZERO:g} to {liquid.highest - _ZERO:g} degC){hint}"
        )
    return Properties(
        liquid.density(temperature),
        liquid.viscosity(temperature),
        liquid.vapour_pressure(temperature),
        liquid.bulk_modulus(temperature),
    )
