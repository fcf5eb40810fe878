"""The balls' path and how they slide, against rigid bodies in world coordinates."""

import math

import numpy as np
import pytest
from inerter.design.ball_screw.helix import Helix
from inerter.design.ball_screw.sliding import Sliding, consistent, mean_speed, printed
from inerter.design.hertz import contact, contact_modulus

HELIX = Helix(radius=0.006, lead=0.01)
BALL, ANGLE = 0.003, math.radians(40.0)


def test_frame_is_that_of_the_curve() -> None:
    theta, h = 0.7, 1e-5
    before, here, after = (HELIX.position(theta + step) for step in (-h, 0.0, h))
    t, n, b = HELIX.frame(theta)
    speed = HELIX.radius / math.cos(HELIX.angle)
    assert (after - before) / (2 * h * speed) == pytest.approx(t, abs=1e-9)
    assert np.cross(t, n) == pytest.approx(b, abs=1e-15)

    # Frenet: t' = kappa n, b' = -tau n
    turned = (HELIX.frame(theta + h) - HELIX.frame(theta - h)) / (2 * h * speed)
    assert turned[0] == pytest.approx(HELIX.curvature * n, rel=1e-6, abs=1e-6)
    assert turned[2] == pytest.approx(-HELIX.torsion * n, rel=1e-6, abs=1e-6)
    # n points to the axis
    assert here[:2] @ n[:2] < 0


@pytest.mark.parametrize("lead", [0.002, 0.01, 0.03])
def test_slip_is_the_least_that_rigid_bodies_allow(lead: float) -> None:
    helix = Helix(0.006, lead)
    theta = 1.1
    centre, (t, n, b) = helix.position(theta), helix.frame(theta)
    normal = math.cos(ANGLE) * n + math.sin(ANGLE) * b
    arms = (-BALL * normal, BALL * normal)

    # the nut's screw motion at 1 rad/s; the screw rests
    axis = np.array([0.0, 0.0, 1.0])
    nut = np.cross(axis, centre + arms[0]) + lead / (2 * math.pi) * axis
    assert nut @ normal == pytest.approx(0.0, abs=1e-15)

    # ball: speed along its path and three rates of turn, such that slip is least
    rows, wanted = [], []
    for arm, raceway in zip(arms, (nut, np.zeros(3)), strict=True):
        turning = np.column_stack([np.cross(e, arm) for e in np.eye(3)])
        rows.append(np.column_stack([t, turning]))
        wanted.append(raceway)
    matrix, target = np.vstack(rows), np.concatenate(wanted)
    motion = np.linalg.lstsq(matrix, target, rcond=None)[0]
    slips = np.linalg.norm((matrix @ motion - target).reshape(2, 3), axis=1)

    found = consistent(helix, BALL, ANGLE)
    assert slips == pytest.approx([found.slip, found.slip], rel=1e-9)
    # the nut's own rotation about the normal is what nut and screw share as spin
    assert 2 * found.spin == pytest.approx(axis @ normal, rel=1e-12)


def test_printed_equations_lose_nothing_at_the_nut() -> None:
    nut, screw = printed(HELIX, BALL, ANGLE)
    assert nut.spin == pytest.approx(0.0, abs=1e-12)
    travel = HELIX.lead / (2 * math.pi)
    expected = travel * math.cos(HELIX.angle) * math.sin(ANGLE) / BALL
    assert screw.spin == pytest.approx(expected, rel=1e-12)


def test_mean_speed_in_its_limits() -> None:
    major, minor = 2e-4, 3e-5
    assert mean_speed(Sliding(1e-3, 0.0), major, minor) == pytest.approx(1e-3, rel=1e-12)

    # spin alone: the closed form of the moment
    found = contact(200.0, 3000.0, 10.0, contact_modulus(206e9, 0.3))
    spinning = mean_speed(Sliding(0.0, 0.4), found.major, found.minor)
    assert spinning == pytest.approx(0.4 * found.spin_moment(1.0) / found.load, rel=1e-4)

    # much slip, little spin: s + w^2 <x^2> / (2 s), <x^2> = a^2 / 5
    slip, spin = 1e-3, 0.2
    second = spin**2 * major**2 / 5 / (2 * slip)
    assert mean_speed(Sliding(slip, spin), major, minor) - slip == pytest.approx(second, rel=1e-2)
