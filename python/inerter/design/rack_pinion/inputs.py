"""What the rack-and-pinion calculator asks for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from inerter.design.inputs import CHOSEN, Choice, DesignError, Input, read_inputs

_EFFICIENCY = f"spur gears, 0.97 to 0.99 a mesh; {CHOSEN}"

INPUTS: tuple[Input | Choice, ...] = (
    Input(
        name="pinion_radius", unit="m", required=True,
        meaning="pitch radius of the pinion on the rack, r",
    ),
    Input(
        name="pinion_inertia", unit="kg*m^2", default=0.0, open_lower=False, source="no inertia",
        meaning="moment of inertia of all that turns with the pinion",
    ),
    Input(
        name="rack_mass", unit="kg", default=0.0, open_lower=False, source="no mass",
        meaning="mass of the rack, which moves with its terminal",
    ),
    Input(
        name="rack_efficiency", unit="", default=0.98, upper=1.0, source=_EFFICIENCY,
        meaning="efficiency of the mesh of rack and pinion",
    ),
    Input(
        name="rack_play", unit="m", default=0.0, open_lower=False, source="no play",
        meaning="travel of the rack with the pinion held, from flank to flank",
    ),
    Input(
        name="pinion_stiffness", unit="N*m/rad",
        meaning="torsional stiffness of the pinion's shaft; rigid if not given",
    ),
    Input(
        name="highest_frequency", unit="Hz", default=50.0, source=CHOSEN,
        meaning="highest frequency of the curve",
    ),
)  # fmt: skip

STAGE: tuple[Input | Choice, ...] = (
    Input(
        name="ratio", unit="", required=True,
        meaning="turns of the stage's driven shaft per turn of the shaft before",
    ),
    Input(
        name="inertia", unit="kg*m^2", required=True, open_lower=False,
        meaning="moment of inertia of all that turns with the driven shaft",
    ),
    Input(
        name="efficiency", unit="", default=0.98, upper=1.0, source=_EFFICIENCY,
        meaning="efficiency of the stage's mesh",
    ),
    Input(
        name="play", unit="rad", default=0.0, open_lower=False, upper=1.0, source="no play",
        meaning="turn of the driven shaft with the shaft before held",
        hint='a plain number is in radians, write "0.1 deg"',
    ),
    Input(
        name="stiffness", unit="N*m/rad",
        meaning="torsional stiffness of the driven shaft; rigid if not given",
    ),
)  # fmt: skip


@dataclass(frozen=True)
class Stage:
    """One gear stage, SI units; `stiffness` None: rigid."""

    ratio: float
    inertia: float
    efficiency: float
    play: float
    stiffness: float | None


def read_stage(number: int, given: str | Mapping[str, float | str]) -> Stage:
    """A stage from keys and values, or from the text "ratio=4,inertia=1e-4".

    Raises
    ------
    DesignError
        A key or a value that cannot be; names the stage.
    """
    try:
        values = read_inputs(STAGE, _split(given) if isinstance(given, str) else given)
    except DesignError as error:
        raise DesignError(f"stage {number}: {error}") from None
    return Stage(
        values.number("ratio"), values.number("inertia"), values.number("efficiency"),
        values.number("play"), values.maybe("stiffness"),
    )  # fmt: skip


def _split(text: str) -> dict[str, str]:
    found: dict[str, str] = {}
    for part in text.split(","):
        name, equals, value = part.partition("=")
        name = name.strip()
        if not equals or name in found:
            raise DesignError(
                f"{text!r} is not a list of key=value, each key once: write it as "
                "ratio=4,inertia=1e-4"
            )
        found[name] = value.strip()
    return found
