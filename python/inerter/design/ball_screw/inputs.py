"""What the ball-screw calculator asks for, with the paper's device as default."""

from __future__ import annotations

import math

from inerter.design.inputs import CHOSEN, PAPER, Choice, DesignError, Input, Values

FITTED = "not printed: fitted to the paper's 12 measured points with the other defaults, rounded"

INPUTS: tuple[Input | Choice, ...] = (
    Input(name="lead", unit="m", default=0.01, source=PAPER, meaning="lead of the screw, P"),
    Input(
        name="inertia", unit="kg*m^2", default=1.12e-4, source=FITTED,
        meaning="moment of inertia of what turns (nut or screw, flywheel), J",
    ),
    Input(
        name="nominal_radius", unit="m", default=0.006,
        source="paper, Table 1: printed as a diameter, used there as a radius",
        meaning="radius of the circle of ball centres, r_o",
    ),
    Input(
        name="contact_angle", unit="rad", default=math.pi / 4, source=PAPER, upper=math.pi / 2,
        open_upper=True, meaning="contact angle between ball and raceways, beta",
        hint='a plain number is in radians, write "45 deg"',
    ),
    Input(
        name="ball_radius", unit="m", default=0.003,
        source="paper, Table 1: printed as a diameter, used there as a radius",
        meaning="radius of a ball, r_b",
    ),
    Input(
        name="ball_number", unit="", default=18, source=PAPER, lower=1, open_lower=False,
        whole=True, meaning="number of balls that carry the load, Z",
    ),
    Input(
        name="conformity", unit="", default=0.54, lower=0.5, upper=1e3,
        source=f"usual in gothic-arch raceways, 0.515 to 0.56; {CHOSEN}",
        meaning="radius of the groove per diameter of the ball",
    ),
    Input(
        name="sliding_friction", unit="", default=0.1, open_lower=False, upper=1.0,
        source=f"boundary-lubricated steel, 0.05 to 0.15; {CHOSEN}",
        meaning="friction coefficient of sliding, mu_f",
    ),
    Input(
        name="rolling_friction", unit="", default=0.0037, open_lower=False, upper=0.1,
        source="paper: 0.0036 to 0.0038", meaning="friction coefficient of rolling, mu_r",
    ),
    Input(
        name="preload", unit="N", default=0.59, open_lower=False, source=FITTED,
        meaning="load of each ball without axial load, Q_0",
    ),
    Input(
        name="youngs_modulus", unit="Pa", default=206e9, source=f"bearing steel; {CHOSEN}",
        meaning="Young's modulus of balls and raceways",
    ),
    Input(
        name="poisson_ratio", unit="", default=0.3, source=f"steel; {CHOSEN}", open_lower=False,
        upper=0.5, meaning="Poisson's ratio",
    ),
    Input(
        name="load", unit="N", default=100.0, source=f"about the paper's 7 Hz; {CHOSEN}",
        meaning="axial load at which contacts and efficiencies are stated, F",
    ),
    Input(
        name="amplitude", unit="m", default=1.33e-3,
        source="acceleration per (2 pi f)^2 in the paper's Table 2, 3 to 12 Hz",
        meaning="amplitude of the motion for the curves over frequency",
    ),
    Input(
        name="highest_frequency", unit="Hz", default=12.0, source="paper, Table 2",
        meaning="highest frequency of the curves",
    ),
    Choice(
        name="method", choices=("corrected", "printed"), default="corrected",
        meaning="sliding speeds and ball load: consistent, or by the paper's equations as they are",
    ),
)  # fmt: skip


def with_fitting_balls(values: Values) -> Values:
    """The inputs, with smaller balls where the paper's do not fit and none were stated."""
    if "ball_radius" in values.given:
        return values
    room = 0.35 * min(_pitch(values), 2.0 * values.number("nominal_radius"))
    if room >= values.number("ball_radius"):
        return values
    source = "chosen here: 0.35 of the room between turns and to the axis; the paper's do not fit"
    return values.derived(source, ball_radius=room)


def check_geometry(values: Values) -> None:
    """Refuse a screw that cannot be built.

    Raises
    ------
    DesignError
        Balls reach the axis, or the balls of one turn those of the next.
    """
    radius, ball = values.number("nominal_radius"), values.number("ball_radius")
    if ball >= radius:
        raise DesignError(
            f"ball_radius is {ball:g} m, not below nominal_radius {radius:g} m: the balls would "
            "reach the screw's axis; give a smaller ball_radius or a larger nominal_radius"
        )
    pitch = _pitch(values)
    if 2.0 * ball >= pitch:
        raise DesignError(
            f"ball_radius is {ball:g} m, but turns of the thread are {pitch:.4g} m apart: balls of "
            f"one turn would touch the next; give ball_radius below {pitch / 2:.4g} m, or a longer "
            "lead"
        )


def _pitch(values: Values) -> float:
    """Distance [m] of neighbouring turns of a single thread, across them."""
    lead = values.number("lead")
    return lead * math.cos(math.atan(lead / (2.0 * math.pi * values.number("nominal_radius"))))
