"""The path of the ball centres: a helix, its Frenet frame and curvatures.

    R = (r cos th, r sin th, r th tan al),  tan al = P / (2 pi r)
    t = (-sin th cos al,  cos th cos al, sin al)
    n = (-cos th,        -sin th,        0)
    b = ( sin th sin al, -cos th sin al, cos al)
    kappa = cos^2 al / r,  tau = sin al cos al / r

Symbols: r [m] radius of the circle of ball centres, P [m] lead, al lead angle, th [rad] angle about
the screw's axis, kappa, tau [1/m] curvature and torsion. n points to the axis.
Contacts: nut A at -r_b N, screw B at +r_b N from the ball's centre, N = (0, cos be, sin be) in
(t, n, b), be contact angle, r_b ball radius.
Source: eqs. (6) to (12) of the ball-screw paper. Its eqs. (9) and (12) have the sign of n wrong;
eq. (10) has it right, as n = b x t of eq. (5) and the contact points of the paper need it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Helix:
    """Path of the ball centres: `radius` r and `lead` P [m]."""

    radius: float
    lead: float

    @property
    def angle(self) -> float:
        """Lead angle al [rad]."""
        return math.atan(self.lead / (2.0 * math.pi * self.radius))

    @property
    def curvature(self) -> float:
        """Curvature kappa [1/m]."""
        return math.cos(self.angle) ** 2 / self.radius

    @property
    def torsion(self) -> float:
        """Torsion tau [1/m]."""
        return math.sin(self.angle) * math.cos(self.angle) / self.radius

    def position(self, theta: float) -> NDArray[np.float64]:
        """Point R (3,) [m] at the angle theta [rad]."""
        climb = theta * math.tan(self.angle)
        return self.radius * np.array([math.cos(theta), math.sin(theta), climb])

    def frame(self, theta: float) -> NDArray[np.float64]:
        """Rows t, n, b (3, 3) at the angle theta [rad]."""
        s, c = math.sin(theta), math.cos(theta)
        sa, ca = math.sin(self.angle), math.cos(self.angle)
        return np.array([[-s * ca, c * ca, sa], [-c, -s, 0.0], [s * sa, -c * sa, ca]])
