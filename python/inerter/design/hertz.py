"""Elliptical contact of two elastic bodies, with exact elliptic integrals.

    A = (curvature along the major axis) / 2,  B = (across it) / 2,  k = b / a
    B / A = R_D(0, 1, k^2) / R_D(0, k^2, 1)
    a^3   = 3 Q E(m) / (2 pi k^2 E* (A + B)),  m = 1 - k^2,  b = k a
    p0    = 3 Q / (2 pi a b),   delta = 3 Q K(m) / (2 pi a E*)
    M     = 3/8 mu Q a E(m)

Symbols: a, b [m] semi-axes, Q [N] load, E* [Pa] contact modulus, 1/E* = 2 (1 - nu^2) / E for equal
bodies, K, E complete elliptic integrals, p0 [Pa] largest pressure, delta [m] approach, M [N m]
moment of Coulomb friction mu over the ellipse when the bodies spin about their common normal.
Range: frictionless, elastic, a and b small against every radius of curvature; a conforming groove
strains the last one.
Source: K. L. Johnson, Contact Mechanics, 1985, section 4.2; the ratio B / A is rewritten with
Carlson's R_D, which loses no digits for nearly circular contacts. M: integral of r mu p over the
ellipse with the half-ellipsoidal p, done in closed form (circle: 3 pi / 16 mu Q a).
Why not Hamrock and Brewe's power law: it is a fit of these integrals to some per cent; a test holds
it against them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from scipy.optimize import brentq
from scipy.special import ellipe, ellipkm1, elliprd

_SMALLEST_AXES = 1e-6  # b / a


@dataclass(frozen=True)
class Contact:
    """An ellipse under load: `major`, `minor` semi-axes [m], `load` [N], `pressure` [Pa].

    `approach` [m] is that of distant points of the bodies.
    """

    major: float
    minor: float
    load: float
    pressure: float
    approach: float

    def spin_moment(self, friction: float) -> float:
        """Moment M [N m] of Coulomb friction against spin about the common normal."""
        eccentricity = 1.0 - (self.minor / self.major) ** 2 if self.major else 0.0
        return 0.375 * friction * self.load * self.major * float(ellipe(eccentricity))


def contact_modulus(youngs_modulus: float, poisson_ratio: float) -> float:
    """E* [Pa] of two bodies of one material."""
    return youngs_modulus / (2.0 * (1.0 - poisson_ratio**2))


def axis_ratio(curvature_ratio: float) -> float:
    """Ratio b / a of the ellipse [-] for B / A >= 1.

    Raises
    ------
    ValueError
        The contact is so long that it is a line.
    """

    def excess(log_ratio: float) -> float:
        square = math.exp(2.0 * log_ratio)
        found = elliprd(0.0, 1.0, square) / elliprd(0.0, square, 1.0)
        return math.log(float(found) / curvature_ratio)

    lowest = math.log(_SMALLEST_AXES)
    if curvature_ratio < 1.0 or excess(lowest) < 0.0:
        raise ValueError(f"curvature ratio {curvature_ratio:g}; the contact is not an ellipse")
    if excess(0.0) >= 0.0:
        return 1.0
    return math.exp(float(brentq(excess, lowest, 0.0, xtol=1e-14)))  # type: ignore[arg-type]


def contact(curvature: float, other: float, load: float, modulus: float) -> Contact:
    """The ellipse under a load.

    Parameters
    ----------
    curvature, other : float
        Sums of the two bodies' curvatures in the two principal directions [1/m], both positive.
    load : float
        Q [N]; 0 gives an ellipse of size 0.
    modulus : float
        E* [Pa].
    """
    flat, steep = sorted((curvature, other))
    ratio = axis_ratio(steep / flat)
    m = 1.0 - ratio**2
    first, second = float(ellipkm1(ratio**2)), float(ellipe(m))
    major = (3.0 * load * second / (math.pi * ratio**2 * modulus * (flat + steep))) ** (1.0 / 3.0)
    if major == 0.0:
        return Contact(0.0, 0.0, load, 0.0, 0.0)
    minor = ratio * major
    return Contact(
        major=major,
        minor=minor,
        load=load,
        pressure=1.5 * load / (math.pi * major * minor),
        approach=1.5 * load * first / (math.pi * major * modulus),
    )
