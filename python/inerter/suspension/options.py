"""Options that the commands of a suspension share: said once, alike in every help."""

from __future__ import annotations

from typing import Annotated

import typer

from inerter.console import number
from inerter.suspension.quarter_car import Road

ROAD = Road()
FACTORS = (
    "NAME=FACTOR/FACTOR/..., as in body_mass=1/1.3,speed=0.6/1.4,damping=0.8/1.2; also wheel_mass, "
    "tyre_stiffness, inertance, relaxation_stiffness."
)

Layouts = Annotated[
    str, typer.Option(help="Layouts S1 ... S6, SR, SW1 ... SW8, with commas between.")
]
Stiffness = Annotated[
    str | None,
    typer.Option(
        help="k [N/m]: numbers and ranges FIRST:LAST:COUNT, with commas; of a half- or full car "
        "the front's, or KF/KR.",
        show_default="120000, or that of the half- or full car or the file",
    ),
]
Series = Annotated[
    str, typer.Option(help="none (ideal), soft, hard or KS/CS [N/m, N s/m]; with commas.")
]
Car = Annotated[
    str,
    typer.Option(
        help="quarter (Wang and Su's), half or full (a published passenger car), or a file "
        "car.toml of your own."
    ),
]
Limit = Annotated[
    str | None,
    typer.Option(help="Not above: INDEX=VALUE in SI, as in travel=0.02,J3=900; also J5, J1w."),
]
Hold = Annotated[
    str | None,
    typer.Option(help="Not sought: damping=, inertance=, relaxation_stiffness= VALUE in SI."),
]
Catalogue = Annotated[
    str | None,
    typer.Option(
        help="One of some values each: NAME=VALUE/VALUE/... in SI, as in "
        "inertance=60/80/113,damping=900/1200; names as for --hold."
    ),
]
Vary = Annotated[
    str | None, typer.Option(help=f"The best over all combinations of factors: {FACTORS}")
]
Equal = Annotated[
    bool, typer.Option("--equal", help="Half, full: the same c, b, k_b at front and rear.")
]
Speed = Annotated[float, number("m/s", "Speed of the car [m/s].")]
OldSpeed = Annotated[float | None, number("m/s", "The name of --speed before.", hidden=True)]
Roughness = Annotated[
    float,
    number(
        "m^3/cycle",
        "Of the road, kappa [m^3/cycle]: of a two-sided density, half of ISO 8608's G_d(n0) n0^2.",
    ),
]


def road_asked(speed: float, velocity: float | None, roughness: float) -> Road:
    """The road of the options; velocity: the name of the speed before."""
    return Road(velocity=speed if velocity is None else velocity, roughness=roughness)
