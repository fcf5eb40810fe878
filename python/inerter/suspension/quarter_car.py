"""Quarter-car over a road: transfer functions as polynomials, exactly.

`ms s^2 zs = Fs - u`, `mu s^2 zu = u - Fr`, `Fr = T (zu - zr)`, T = kt + ct s, `u = D(s) (zs - zu)`
with the strut's dynamic stiffness D = N / P. Eliminating zu,

    A     = ms s^2 (mu s^2 + T) P + ((ms + mu) s^2 + T) N
    zs/zr = T N / A
    (zs - zu)/zr = -T ms s^2 P / A
    Fr/zr = -T s^2 (ms mu s^2 P + (ms + mu) N) / A
    zs/Fs = ((mu s^2 + T) P + N) / A

so the powers of s that make the indices finite are there by structure, not by cancellation.
Source: Wang and Su, ACC 2008, eqs. (2), (3), there without ct. With a tyre's damper, ct > 0, the
tyre force follows the road's velocity at once: where that is white noise Fr has no finite rms, nor
has the acceleration of a body that an inerter couples to the wheel.
Not modelled: loss of contact.
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
    """`sprung_mass` ms, `unsprung_mass` mu [kg], `tyre_stiffness` kt [N/m], `tyre_damping` ct.

    ct [N s/m] may be 0, the others are positive.

    Raises
    ------
    ValueError
        A value that cannot be.
    """

    sprung_mass: float = QUARTER_CAR.sprung_mass
    unsprung_mass: float = QUARTER_CAR.unsprung_mass
    tyre_stiffness: float = QUARTER_CAR.tyre_stiffness
    tyre_damping: float = 0.0

    def __post_init__(self) -> None:
        positive(self, ("sprung_mass", "unsprung_mass", "tyre_stiffness"))
        not_negative(self, ("tyre_damping",))

    @property
    def tyre(self) -> Coefficients:
        """T(s) = kt + ct s [N/m]."""
        more = (self.tyre_damping,) if self.tyre_damping else ()
        return polynomial(self.tyre_stiffness, *more)

    def body_per_road(self, strut: Rational) -> Rational:
        """zs/zr."""
        top = multiply(self.tyre, strut.numerator)
        return Rational(top, self._denominator(strut))

    def tyre_force_per_road(self, strut: Rational) -> Rational:
        """Fr/zr [N/m], up to the sign that no index sees."""
        both = self.sprung_mass + self.unsprung_mass
        top = add(
            shift(self.sprung_mass * self.unsprung_mass * strut.denominator, 2),
            both * strut.numerator,
        )
        return Rational(shift(multiply(self.tyre, top), 2), self._denominator(strut))

    def travel_per_road(self, strut: Rational) -> Rational:
        """(zs - zu)/zr."""
        top = multiply(-self.sprung_mass * self.tyre, shift(strut.denominator, 2))
        return Rational(top, self._denominator(strut))

    def body_per_load(self, strut: Rational) -> Rational:
        """zs/Fs [m/N]."""
        wheel = self._with_inertia(self.unsprung_mass)
        top = add(multiply(wheel, strut.denominator), strut.numerator)
        return Rational(top, self._denominator(strut))

    @property
    def static_load(self) -> float:
        """Weight on the tyre [N]."""
        return GRAVITY * (self.sprung_mass + self.unsprung_mass)

    def static_compliance(self, stiffness: float) -> float:
        """1/k + 1/kt [m/N]: zs/Fs at rest, whatever the layout."""
        return 1.0 / stiffness + 1.0 / self.tyre_stiffness

    def _with_inertia(self, mass: float) -> Coefficients:
        return polynomial(self.tyre_stiffness, self.tyre_damping, mass)

    def _denominator(self, strut: Rational) -> Coefficients:
        wheel = self._with_inertia(self.unsprung_mass)
        both = self._with_inertia(self.sprung_mass + self.unsprung_mass)
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


def not_negative(thing: object, names: tuple[str, ...]) -> None:
    """Refuse values that are negative or not finite, by name."""
    for name in names:
        value = getattr(thing, name)
        if not (math.isfinite(value) and value >= 0.0):
            raise ValueError(f"{name} is {value:g}: give 0 or a positive number")
