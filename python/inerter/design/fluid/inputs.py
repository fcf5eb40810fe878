"""What the fluid calculator asks for, with the small-scale prototype of Innsbruck as default."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass

from inerter.design.fluid.liquids import LIQUIDS, Properties, properties
from inerter.design.inputs import CHOSEN, Choice, DesignError, Input, Values

_PAPER = "fluid inerter paper, Table 1"
_HELIX = ("helix_radius", "helix_turns", "helix_pitch")
BORE, ROD, CHANNEL_DIAMETER, CHANNEL_LENGTH = 0.05, 0.02, 0.006, 1.7

INPUTS: tuple[Input | Choice, ...] = (
    Input(
        name="bore", unit="m", meaning="diameter of the cylinder",
        source=f"{BORE:g} if nothing is said of the piston: {_PAPER}",
    ),
    Input(
        name="rod", unit="m", open_lower=False, meaning="diameter of the rod, through both ends",
        source=f"{ROD:g} if nothing is said of the piston: {_PAPER}; 0 with a bore alone",
    ),
    Input(name="piston_area", unit="m^2", meaning="area A1, in place of bore and rod"),
    Input(
        name="channel_diameter", unit="m", meaning="inner diameter of the channel",
        source=f"{CHANNEL_DIAMETER:g} if no area is given: {_PAPER}",
    ),
    Input(name="channel_area", unit="m^2", meaning="area A2, in place of the diameter"),
    Input(
        name="channel_length", unit="m", meaning="length l of the channel", longest_bare=100.0,
        source=f"{CHANNEL_LENGTH:g} if no helix is given: {_PAPER}",
    ),
    Input(
        name="helix_radius", unit="m",
        meaning="radius of a helical channel's centre line; length with helix_turns",
    ),
    Input(name="helix_pitch", unit="m", open_lower=False, default=0.0, source="a ring",
          meaning="climb of the helix per turn"),
    Input(name="helix_turns", unit="", meaning="turns of the helix"),
    Choice(
        name="liquid", choices=tuple(LIQUIDS), default="water", source=_PAPER, meaning="liquid"
    ),
    Input(
        name="temperature", unit="K", default=303.15, meaning="temperature of the liquid",
        source="30 degC, at which water has the printed density of 995.6 kg/m^3",
    ),
    Input(name="density", unit="kg/m^3", meaning="density, in place of the liquid's"),
    Input(name="viscosity", unit="Pa*s", meaning="dynamic viscosity, in place of the liquid's"),
    Input(name="vapour_pressure", unit="Pa", open_lower=False,
          meaning="vapour pressure, in place of the liquid's"),
    Input(name="bulk_modulus", unit="Pa", meaning="bulk modulus, in place of the liquid's"),
    Input(
        name="roughness", unit="m", default=1.5e-6, open_lower=False,
        source=f"drawn tube or plastic hose; {CHOSEN}", meaning="roughness of the channel's wall",
    ),
    Input(
        name="minor_loss", unit="", default=1.5, open_lower=False,
        source="0.5 for a sharp entrance, 1 for the exit, as handbooks have them; no bends, valves",
        meaning="loss at bends and ends per rho u^2 / 2, K",
    ),
    Input(
        name="static_pressure", unit="Pa", default=101325.0,
        source="one standard atmosphere, absolute", meaning="absolute pressure at rest, p_0",
    ),
    Input(
        name="suction_share", unit="", default=0.5, upper=1.0,
        source="equal closed chambers; 1 if one of them is held at p_0",
        meaning="share of the pressure difference by which the lower chamber falls below p_0",
    ),
    Input(
        name="stroke", unit="m",
        meaning="full stroke: chambers of area times half of it; the liquid is rigid if not given",
    ),
    Input(
        name="dead_volume", unit="m^3", default=0.0, open_lower=False, source="none",
        meaning="volume of each chamber beside the stroke's",
    ),
    Input(
        name="air_fraction", unit="", default=0.0, open_lower=False, upper=1.0, open_upper=True,
        source="none", meaning="volume of free bubbles per volume of liquid, at p_0",
    ),
    Input(name="gas_volume", unit="m^3", meaning="trapped air, a gas spring; none if not given"),
    Input(
        name="gas_exponent", unit="", default=1.4, upper=5.0, source="fluid inerter paper, air",
        meaning="polytropic exponent of air",
    ),
    Input(
        name="speed", unit="m/s", default=0.02, source=CHOSEN,
        meaning="speed of the piston at which losses are stated",
    ),
    Input(
        name="amplitude", unit="m", default=1e-3, source=CHOSEN,
        meaning="amplitude of the motion for the cavitation limit",
    ),
    Input(
        name="highest_frequency", unit="Hz", default=12.0, source="fluid inerter paper's sweep",
        meaning="highest frequency of the curves",
    ),
)  # fmt: skip


@dataclass(frozen=True)
class Geometry:
    """`piston_area`, `channel_area` [m^2], `length` [m], `coil_diameter` [m], 0 when straight."""

    piston_area: float
    channel_area: float
    length: float
    coil_diameter: float

    @property
    def diameter(self) -> float:
        """Diameter of the channel [m]."""
        return math.sqrt(4.0 * self.channel_area / math.pi)

    @property
    def ratio(self) -> float:
        """Speed in the channel per speed of the piston [-]."""
        return self.piston_area / self.channel_area


def with_prototype(values: Values) -> Values:
    """The inputs with the prototype's piston, channel and length where none is stated.

    Raises
    ------
    DesignError
        Two statements of one thing.
    """
    _one_of(values, "piston_area", ("bore", "rod"))
    _one_of(values, "channel_area", ("channel_diameter",))
    _one_of(values, "channel_length", _HELIX)
    stated = values.given
    found: dict[str, float] = {}
    if "piston_area" not in stated and "bore" not in stated:
        found["bore"] = BORE
        if "rod" not in stated:
            found["rod"] = ROD
    if "channel_area" not in stated and "channel_diameter" not in stated:
        found["channel_diameter"] = CHANNEL_DIAMETER
    if not any(name in stated for name in ("channel_length", *_HELIX)):
        found["channel_length"] = CHANNEL_LENGTH
    return values.derived(f"default, {_PAPER}", **found)


def read_geometry(values: Values) -> Geometry:
    """Areas and length of inputs that went through `with_prototype`.

    Raises
    ------
    DesignError
        Half of a statement, or areas that cannot be.
    """
    piston = values.maybe("piston_area")
    if piston is None:
        bore, rod = values.number("bore"), values.maybe("rod") or 0.0
        if rod >= bore:
            raise DesignError(f"rod is {rod:g} m, not below bore {bore:g} m: give a smaller rod")
        piston = 0.25 * math.pi * (bore**2 - rod**2)
    channel = values.maybe("channel_area")
    if channel is None:
        channel = 0.25 * math.pi * values.number("channel_diameter") ** 2
    if channel >= piston:
        raise DesignError(
            f"the channel's area is {channel:.4g} m^2, not below the piston's {piston:.4g} m^2: "
            "give a narrower channel or a larger piston"
        )
    diameter, roughness = math.sqrt(4.0 * channel / math.pi), values.number("roughness")
    if roughness >= 0.5 * diameter:
        raise DesignError(
            f"roughness is {roughness:g} m, not below the channel's radius {diameter / 2:.4g} m: "
            "give the height of the wall's unevenness"
        )
    radius, turns = values.maybe("helix_radius"), values.maybe("helix_turns")
    if (radius is None) != (turns is None) or ("helix_pitch" in values.given and radius is None):
        raise DesignError(
            "the helix is incomplete: give helix_radius and helix_turns (and helix_pitch), or "
            "channel_length alone"
        )
    if radius is None or turns is None:
        return Geometry(piston, channel, values.number("channel_length"), 0.0)
    if 2.0 * radius <= diameter:
        raise DesignError(
            f"helix_radius is {radius:g} m, less than the channel's own radius: give a larger one"
        )
    pitch = values.number("helix_pitch")
    length = turns * math.hypot(2.0 * math.pi * radius, pitch)
    # diameter of the circle with the helix's curvature
    coil = 2.0 * radius * (1.0 + (pitch / (2.0 * math.pi * radius)) ** 2)
    return Geometry(piston, channel, length, coil)


def read_liquid(values: Values) -> Properties:
    """Properties of the liquid, those that were given in place of its own.

    Raises
    ------
    DesignError
        The temperature is out of range, or the liquid boils at rest.
    """
    names = ("density", "viscosity", "vapour_pressure", "bulk_modulus")
    given = {name: values.number(name) for name in names if values.maybe(name) is not None}
    if len(given) < len(names):
        found = properties(values.word("liquid"), values.number("temperature"))
        given = asdict(found) | given
    found = Properties(**given)
    static = values.number("static_pressure")
    if static <= found.vapour_pressure:
        raise DesignError(
            f"static_pressure is {static:g} Pa, not above the vapour pressure "
            f"{found.vapour_pressure:.4g} Pa of {values.word('liquid')}: it cavitates at rest; "
            "raise static_pressure or lower temperature"
        )
    return found


def _one_of(values: Values, one: str, others: tuple[str, ...]) -> None:
    both = [name for name in others if name in values.given]
    if one in values.given and both:
        raise DesignError(
            f"{one} is given and so is {' and '.join(both)}: they state the same, leave one out"
        )
