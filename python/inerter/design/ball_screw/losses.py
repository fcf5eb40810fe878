"""Friction of the balls: its force, efficiencies, and the inertance in the paper's sense.

    Q      = Q_0 + F / (Z cos al sin be)                      load of a ball
    f_1    = (2 pi / P) mu_f Z sum over A, B of Q <u>(Q)      force lost to sliding
    eta_1  = f_1 / F                                          share lost to sliding
    eta_2  = tan(al - atan mu_r) / tan al                     efficiency of rolling
    b_n    = b (eta_2 - eta_1)

Symbols: F [N] axial load, Q_0 [N] preload of a ball, Z balls, P [m] lead, al lead angle, be contact
angle, <u> [m] mean sliding speed per nut angle over the contact ellipse, b [kg] ideal inertance.
Printed: eq. (26) has Q = F cos al sin be / Z, where contact theory divides; eq. (37) has
b (1 - eta_1 - eta_2), which is about -eta_1 b because eta_2 is 0.985. By its definition eta_1 is a
share lost and eta_2 an efficiency, so what is left is eta_2 - eta_1. Method "printed" takes (26)
and (19) to (29) as they stand, but never (37).
What b_n means: the share of the driving force that reaches the inertia. It is not what a bench
measures as force per acceleration: friction adds to a driving force, F = b a (1 + mu) + f_0, and
gives it back when the inertia drives. For the simulators the same losses are

    mu  = lam / (1 - lam),  lam = 1 - eta_2 + (f_1(F) - f_1(0)) / F      load_friction
    f_0 = f_1(0)                                                        coulomb_force

Source: the ball-screw paper, eqs. (24) to (37); eta_2 after Lin, Velinsky and Ravani 1994.
Stiffness of the contacts is given beside, but is not in the device: screw, nut and bearings are
softer.
Not modelled: rolling losses of the preload, recirculation, seals, lubricant drag, other efficiency
of rolling when the inertia drives.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inerter.design.ball_screw.helix import Helix
from inerter.design.ball_screw.sliding import consistent, mean_speed, printed
from inerter.design.hertz import Contact, contact, contact_modulus
from inerter.design.inputs import Values


@dataclass(frozen=True)
class Losses:
    """Friction of a ball screw whose inputs are `values`."""

    values: Values

    @property
    def helix(self) -> Helix:
        """Path of the ball centres."""
        return Helix(self.values.number("nominal_radius"), self.values.number("lead"))

    @property
    def inertance(self) -> float:
        """Ideal inertance b = (2 pi / P)^2 J [kg]."""
        return (2.0 * math.pi / self.helix.lead) ** 2 * self.values.number("inertia")

    @property
    def load_share(self) -> float:
        """Load of a ball per axial load [-]."""
        factor = math.cos(self.helix.angle) * math.sin(self.values.number("contact_angle"))
        if self.values.word("method") == "corrected":
            factor = 1.0 / factor
        return factor / self.values.number("ball_number")

    @property
    def rolling_efficiency(self) -> float:
        """Efficiency eta_2 [-]; not above 0 where rolling friction locks the screw."""
        angle = self.helix.angle
        slip = math.atan(self.values.number("rolling_friction"))
        return math.tan(angle - slip) / math.tan(angle)

    def ball_load(self, load: float) -> float:
        """Load Q [N] of a ball under an axial load F [N]."""
        return self.values.number("preload") + self.load_share * load

    def contacts(self, load: float) -> tuple[Contact, Contact]:
        """Ellipses at nut and screw under an axial load F [N].

        Across the groove the ball (1 / r_b) lies in a groove of radius conformity * 2 r_b. Along it
        the raceway's curvature is that of a tube about the ball's path: -/+ kappa cos be /
        (1 +/- kappa r_b cos be) at nut and screw. The ellipse is taken along the groove; its turn
        by the torsion is left out.
        """
        ball = self.values.number("ball_radius")
        modulus = contact_modulus(
            self.values.number("youngs_modulus"), self.values.number("poisson_ratio")
        )
        across = 1.0 / ball - 1.0 / (2.0 * self.values.number("conformity") * ball)
        bend = self.helix.curvature * math.cos(self.values.number("contact_angle"))
        along = (1 / ball - bend / (1 + bend * ball), 1 / ball + bend / (1 - bend * ball))
        force = self.ball_load(load)
        return (
            contact(across, along[0], force, modulus),
            contact(across, along[1], force, modulus),
        )

    def contact_stiffness(self, load: float) -> float:
        """Axial stiffness [N/m] of the contacts about an axial load F [N]; 0 without any load.

        Approach goes with Q^(2/3); the balls are Z springs at the contact angle, two contacts each.
        """
        force = self.ball_load(load)
        approach = sum(found.approach for found in self.contacts(load))
        if approach == 0.0:
            return 0.0
        along = math.cos(self.helix.angle) * math.sin(self.values.number("contact_angle"))
        return self.values.number("ball_number") * along**2 * 1.5 * force / approach

    def sliding_force(self, load: float) -> float:
        """Force f_1 [N] that sliding takes from an axial load F [N]."""
        values, helix = self.values, self.helix
        ball, angle = values.number("ball_radius"), values.number("contact_angle")
        friction = values.number("sliding_friction")
        contacts = self.contacts(load)
        if values.word("method") == "printed":
            pairs = zip(printed(helix, ball, angle), contacts, strict=True)
            power = sum(found.spin_moment(friction) * sliding.spin for sliding, found in pairs)
        else:
            sliding = consistent(helix, ball, angle)
            speeds = [mean_speed(sliding, found.major, found.minor) for found in contacts]
            power = friction * self.ball_load(load) * sum(speeds)
        return 2.0 * math.pi / helix.lead * values.number("ball_number") * power

    def sliding_loss(self, load: float) -> float:
        """Share eta_1 [-] of an axial load F [N] that sliding takes."""
        return self.sliding_force(load) / load

    def efficiency(self, loads: Sequence[float] | NDArray[np.float64]) -> NDArray[np.float64]:
        """eta_2 - eta_1 [-] at axial loads [N]; NaN where friction takes the whole load."""
        found = np.array([self.rolling_efficiency - self.sliding_loss(load) for load in loads])
        return np.where(found > 0.0, found, np.nan)

    def load_loss(self, load: float) -> float:
        """Share lam [-] lost in proportion to an axial load F [N]: without the preload's part."""
        beyond = self.sliding_force(load) - self.sliding_force(0.0)
        return 1.0 - self.rolling_efficiency + beyond / load
