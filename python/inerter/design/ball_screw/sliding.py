"""How fast a ball slides on its raceways, per angular velocity of the nut.

Consistent kinematics. The nut turns at w and moves along by P w / (2 pi) against the screw. In
(t, n, b), with N = (0, cos be, sin be) and m = (0, -sin be, cos be):

    nut at A     w [(r / cos al + r_b cos be cos al) t - r_b sin al m]
    screw at B   0
    ball at A    v t + r_b w_m t - r_b w_t m      (B: v t - r_b w_m t + r_b w_t m)

Along t both contacts can roll: v = r_b w_m = w (r / cos al + r_b cos be cos al) / 2. Along m they
cannot: one needs w_t = w sin al, the other w_t = 0. The balls would have to climb the groove, so
r_b w sin al of slip stays, and half of it at each contact is the least uneven share (with Coulomb
friction any share costs the same). About N the ball spins against nut and screw by
w cos al sin be in sum, shared equally too.

    slip = r_b sin al / 2 [m],  spin = cos al sin be / 2 [-],  per nut angle, at each contact

As printed, eqs. (19) to (23): the nut's velocity at A leaves out the distance from the axis to the
ball, so that a ball that rolls is given its whole travel as sliding; all of the ball's rotation is
put about N, which takes rolling away; sliding velocities become angular by division by r_b. With
the moment of eq. (29) about N, what is left at the nut is exactly 0, and at the screw
cos al sin be / r_b per velocity.

Symbols: r [m] nominal radius, r_b [m] ball radius, al lead angle, be contact angle, w [rad/s]
angular velocity of the nut, v [m/s] ball's speed along its path, (w_t, w_N, w_m) its rotation.
Source: the frame is the paper's. That slip remains for every lead angle but 0 is known from Lin,
Ravani and Velinsky, "Kinematics of the ball screw mechanism", J. Mech. Design 116(3), 1994 (their
text was not at hand: derived here).
Not modelled: slip from the groove's curvature within the ellipse (Heathcote), contact angles that
differ, balls that climb the groove instead of sliding in strokes shorter than the climb.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from inerter.design.ball_screw.helix import Helix


@dataclass(frozen=True)
class Sliding:
    """Slip along the groove's section [m/rad] and spin about the normal [-], per nut angle."""

    slip: float
    spin: float


def consistent(helix: Helix, ball_radius: float, contact_angle: float) -> Sliding:
    """Slip and spin at each of the two contacts, from kinematics that let the balls roll."""
    angle = helix.angle
    return Sliding(
        slip=0.5 * ball_radius * math.sin(angle),
        spin=0.5 * math.cos(angle) * math.sin(contact_angle),
    )


def printed(helix: Helix, ball_radius: float, contact_angle: float) -> tuple[Sliding, Sliding]:
    """Spin about the normal at nut and screw from the printed angular velocities."""
    sa, ca = math.sin(helix.angle), math.cos(helix.angle)
    sb, cb = math.sin(contact_angle), math.cos(contact_angle)
    per_travel = 2.0 * math.pi / helix.lead
    radius = helix.radius

    # eqs. (22), (23) per velocity of the screw, then along N, then per nut angle
    nut = per_travel * np.array([radius / (ball_radius * ca) - ca * cb, -sa * sb, sa * cb])
    screw = np.array([radius / ca * per_travel - sa, 0.0, -ca]) / ball_radius
    normal = np.array([0.0, cb, sb])
    spins = (abs(float(normal @ nut)) / per_travel, abs(float(normal @ screw)) / per_travel)
    return Sliding(0.0, spins[0]), Sliding(0.0, spins[1])


def mean_speed(sliding: Sliding, major: float, minor: float) -> float:
    """Sliding speed per nut angle [m/rad], averaged over the ellipse with the pressure as weight.

    Slip lies along the major axis, across the groove. `major`, `minor` are the semi-axes [m].
    """
    x, y = major * _X, minor * _Y
    speed = np.hypot(sliding.slip - sliding.spin * y, sliding.spin * x)
    return float(np.sum(_WEIGHT * speed))


def _points() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Points of the unit disk and weights of the pressure sqrt(1 - r^2), of sum 1."""
    height, weight = np.polynomial.legendre.leggauss(48)
    height, weight = 0.5 * (height + 1.0), 0.5 * weight
    turn = 2.0 * math.pi * (np.arange(96) + 0.5) / 96
    radius = np.sqrt(1.0 - height**2)[:, None]
    weights = np.broadcast_to((3.0 * height**2 * weight / 96)[:, None], (48, 96))
    return radius * np.cos(turn), radius * np.sin(turn), weights


_X, _Y, _WEIGHT = _points()
