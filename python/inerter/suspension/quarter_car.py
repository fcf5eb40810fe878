"""Quarter-car over a road: transfer functions as polynomials, exactly.

`ms s^2 zs = Fs - u`, `mu s^2 zu = u - Fr`, `Fr = kt (zu - zr)`, `u = D(s) (zs - zu)` with the
strut's dynamic stiffness D = N / P. Eliminating zu,

    A     = ms s^2 (mu s^2 + kt) P + ((ms + mu) s^2 + kt) N
    zs/zr = kt N / A
    (zs - zu)/zr = -kt ms s^2 P / A
    Fr/zr = -kt s^2 (ms mu s^2 P + (ms + mu) N) / A
    zs/Fs = ((mu s^2 + kt) P + N) / A

so the powers of s that make the indices finite are there by structure, not by cancellation.
Source: Wang and Su, ACC 2008, eqs. (2), (3). Not modelled: tyre damping, loss of contact.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from inerter.model_parameters import QUARTER_CAR
from inerter.suspension.rational import (
    Coefficients,
    Rational,
    add,
    multiply,
    polynomial,
    shift,
)

GRAVITY = 9.81
"""[m/s^2]."""


@dataclass(frozen=True, kw_only=True)
class QuarterCar:
    """`sprung_mass` ms, `unsprung_mass` mu [kg], `tyre_stiffness` kt [N/m].

    Raises
    ------
    ValueError
        A value is not positive.
    """

    sprung_mass: float = QUARTER_CAR.sprung_mass
    unsprung_mass: float = QUARTER_CAR.unsprung_mass
    tyre_stiffness: float = QUARTER_CAR.tyre_stiffness

    def __post_init__(self) -> None:
        positive(self, ("sprung_mass", "unsprung_mass", "tyre_stiffness"))

    def body_per_road(self, strut: Rational) -> Rational:
        """zs/zr."""
        top = self.tyre_stiffness * strut.numerator
        return Rational(top, self._denominator(strut))

    def tyre_force_per_road(self, strut: Rational) -> Rational:
        """Fr/zr [N/m], up to the sign that no index sees."""
        both = self.sprung_mass + self.unsprung_mass
        top = add(
            shift(self.sprung_mass * self.unsprung_mass * strut.denominator, 2),
            both * strut.numerator,
        )
        return Rational(shift(self.tyre_stiffness * top, 2), self._denominator(strut))

    def travel_per_road(self, strut: Rational) -> Rational:
        """(zs - zu)/zr."""
        top = -self.tyre_stiffness * self.sprung_mass * shift(strut.denominator, 2)
        return Rational(top, self._denominator(strut))

    def body_per_load(self, strut: Rational) -> Rational:
        """zs/Fs [m/N]."""
        wheel = polynomial(self.tyre_stiffness, 0.0, self.unsprung_mass)
        top = add(multiply(wheel, strut.denominator), strut.numerator)
        return Rational(top, self._denominator(strut))

    @property
    def static_load(self) -> float:
        """Weight on the tyre [N]."""
        return GRAVITY * (self.sprung_mass + self.unsprung_mass)

    def static_compliance(self, stiffness: float) -> float:
        """1/k + 1/kt [m/N]: zs/Fs at rest, whatever the layout."""
        return 1.0 / stiffness + 1.0 / self.tyre_stiffness

    def _denominator(self, strut: Rational) -> Coefficients:
        wheel = polynomial(self.tyre_stiffness, 0.0, self.unsprung_mass)
        both = polynomial(self.tyre_stiffness, 0.0, self.sprung_mass + self.unsprung_mass)
        return add(
            shift(self.sprung_mass * multiply(wheel, strut.denominator), 2),
            multiply(both, strut.numerator),
        )


@dataclass(frozen=True, kw_only=True)
class Road:
    """Road of spectral density `roughness * velocity / f^2`; the values are Wang and Su's.

    `velocity` V [m/s], `roughness` kappa [m^3/cycle].

    Raises
    ------
    ValueError
        A value is not positive.
    """

    velocity: float = 25.0
    roughness: float = 5e-7

    def __post_init__(self) -> None:
        positive(self, ("velocity", "roughness"))

    @property
    def slope(self) -> float:
        """2 pi sqrt(V kappa): the root of the two-sided density of zr' as white noise."""
        return 2.0 * math.pi * math.sqrt(self.velocity * self.roughness)


def positive(thing: object, names: tuple[str, ...]) -> None:
    """Refuse values that are not positive and finite, by name."""
    for name in names:
        value = getattr(thing, name)
        if not (math.isfinite(value) and value > 0.0):
            raise ValueError(f"{name} is {value:g}: give a positive number")
