"""The friction laws: what a fit varies of each, which one holds which, where trials begin."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

from inerter.catalogue.coordinates import COORDINATES


@dataclass(frozen=True, kw_only=True)
class FrictionLaw:
    """One friction law of the core, as records show it.

    Attributes
    ----------
    name, words
        As the core calls it, and in running text.
    meaning
        What `identify` fits with it.
    effect
        The effect that a diagnosis names it as.
    coordinates
        What a fit of a diagnosis varies, level first.
    stated
        What is set free of a law that a user states; by default the coordinates.
    constants
        Parameters that a user may state and no fit changes.
    spread
        Coordinates over which the starts of an identification are spread, in that order.
    level
        The coordinate that the force grows in proportion to.
    smoothed
        Whether it reads the width of sign(v).
    memory
        Whether it has a state.
    peak
        Of a law that falls with the speed, or from what it was at rest, the coordinate that says
        at which speed or after which way: the blur of smoothed data may look so. Where that is
        small, a law without memory is near those of `limits`.
    varies
        Whether its level can differ with the direction and along the stroke.
    contains, limits
        Laws that it is with some of its parameters at certain values, and that it comes near to.
    simpler
        Laws that are tried in its place, the plainest first.
    tried_on
        Laws in the place of which a diagnosis tries it; never, where there are none.
    grid
        Where those trials begin: values in units of `start_unit`, every one with every other. What
        the model has already stands in the place of a row.
    begin
        The same of what has one value: of the level, or in units of `start_unit`.
    rich
        Whether it is tried only where a plainer law with memory does better than none.
    """

    name: str
    words: str
    meaning: str = ""
    effect: str = ""
    coordinates: tuple[str, ...] = ()
    stated: tuple[str, ...] = ()
    constants: tuple[str, ...] = ()
    spread: tuple[str, ...] = ()
    level: str = "coulomb_force"
    smoothed: bool = False
    memory: bool = False
    peak: str = ""
    varies: bool = True
    contains: tuple[str, ...] = ("none",)
    limits: tuple[str, ...] = ()
    simpler: tuple[str, ...] = ()
    tried_on: tuple[str, ...] = ()
    grid: Mapping[str, tuple[float, ...]] = field(default_factory=dict)
    begin: Mapping[str, float] = field(default_factory=dict)
    rich: bool = False

    @property
    def set_free(self) -> tuple[str, ...]:
        """Coordinates that are set free of one that a user states."""
        return self.stated or self.coordinates

    def of_device(self, device: Any) -> dict[str, float]:
        """Coordinates that are set free of a device's law: its parameters, stated or by default."""
        return {name: COORDINATES[name].of(device) for name in self.set_free}


_ALL = (
    FrictionLaw(name="none", words="none", level="", varies=False, contains=()),
    FrictionLaw(
        name="coulomb", words="Coulomb", meaning="Coulomb friction", effect="coulomb_friction",
        coordinates=("coulomb_force",), smoothed=True,
        tried_on=("none",),
    ),
    FrictionLaw(
        name="stribeck", words="Stribeck", meaning="Stribeck friction", effect="stribeck_friction",
        coordinates=("coulomb_force", "static_excess", "stribeck_velocity"),
        constants=("stribeck_exponent",), spread=("stribeck_velocity", "static_excess"),
        smoothed=True, peak="stribeck_velocity", contains=("none", "coulomb"), simpler=("coulomb",),
        tried_on=("none", "coulomb"), grid={"stribeck_velocity": (0.03, 0.1, 0.4)},
        begin={"static_excess": 0.5},
    ),
    FrictionLaw(
        name="brown_mcphee", words="Brown-McPhee", meaning="Brown-McPhee friction",
        effect="stribeck_friction",
        coordinates=("coulomb_force", "static_excess", "stribeck_velocity"),
        spread=("stribeck_velocity", "static_excess"),
        peak="stribeck_velocity", limits=("coulomb",), simpler=("coulomb",),
    ),
    FrictionLaw(
        name="dahl", words="Dahl", meaning="Dahl friction", effect="hysteretic_friction",
        coordinates=("coulomb_force", "presliding"), constants=("dahl_exponent",),
        spread=("presliding",), memory=True, limits=("coulomb",), simpler=("coulomb",),
        tried_on=("none", "coulomb"), grid={"presliding": (0.003, 0.03, 0.3)},
    ),
    FrictionLaw(
        name="lugre", words="LuGre", meaning="LuGre friction", effect="hysteretic_friction",
        coordinates=(
            "coulomb_force", "static_excess", "stribeck_velocity", "presliding", "bristle_damping",
        ),
        constants=("stribeck_exponent",),
        spread=("stribeck_velocity", "static_excess", "presliding", "bristle_damping"),
        memory=True, peak="stribeck_velocity", contains=("none", "dahl"), limits=("coulomb",),
        simpler=("coulomb", "dahl", "stribeck"), tried_on=("none", "coulomb", "stribeck", "dahl"),
        grid={"presliding": (0.003, 0.03, 0.2), "stribeck_velocity": (0.05, 0.3)},
        begin={"static_excess": 0.5, "bristle_damping": 0.001}, rich=True,
    ),
    FrictionLaw(
        name="bouc_wen", words="Bouc-Wen", meaning="Bouc-Wen hysteresis",
        effect="hysteretic_friction",
        coordinates=(
            "bw_level", "presliding", "bw_shape", "bw_stiffness", "bw_beta", "bw_gamma",
            "bw_exponent", "bw_ratio",
        ),
        stated=("bw_stiffness", "bw_beta", "bw_gamma", "bw_exponent", "bw_ratio"),
        constants=("bw_alpha",), spread=("presliding", "bw_shape", "bw_exponent"),
        level="bw_level", memory=True, varies=False, contains=("none", "dahl"),
        limits=("coulomb",), simpler=("coulomb", "dahl"), tried_on=("none", "coulomb", "dahl"),
        grid={"presliding": (0.01, 0.1, 0.5), "bw_shape": (0.6, 1.0)},
        begin={"bw_exponent": 1.2}, rich=True,
    ),
    # held as they are stated: a diagnosis does not change them, no trial takes them
    FrictionLaw(
        name="maxwell_slip", words="Maxwell-slip", effect="hysteretic_friction", level="",
        constants=tuple(f"slip_{what}_{i}" for i in range(1, 9) for what in ("stiffness", "force")),
        memory=True, varies=False,
    ),
    FrictionLaw(
        name="rate_state", words="rate-and-state",
        meaning="rate-and-state friction, which ages at rest", effect="rate_state_friction",
        coordinates=("coulomb_force", "rate_effect", "age_effect", "age_distance"),
        constants=("rate_velocity",), spread=("age_distance", "age_effect", "rate_effect"),
        smoothed=True, memory=True, peak="age_distance", contains=("none", "coulomb"),
        simpler=("coulomb", "dahl"), tried_on=("none", "coulomb"),
        grid={"age_distance": (1e-3, 0.03)}, begin={"rate_effect": 0.02, "age_effect": 0.03},
    ),
)  # fmt: skip

FRICTION: Mapping[str, FrictionLaw] = MappingProxyType({law.name: law for law in _ALL})
"""Every friction law by its name."""

LAW_CONSTANTS = tuple(dict.fromkeys(name for law in _ALL for name in law.constants))
"""What a user may state of a friction law and no fit changes."""
LAW_COORDINATES = tuple(
    dict.fromkeys((*(name for law in _ALL for name in law.coordinates), *LAW_CONSTANTS))
)
"""What belongs to a friction law and leaves with it."""
PLAY_COORDINATES = ("friction_backlash", "friction_place")
"""Of a free play before the friction, which a law with a bristle can have."""
LEVEL_COORDINATES = ("friction_asymmetry", "friction_gradient", "friction_curvature")
"""Of a level that differs with direction and position; a drift is the record's, and every law's."""
BRISTLES = tuple(law.name for law in _ALL if "presliding" in law.coordinates)
"""Friction laws with a bristle that a fit can vary."""
LEVEL_LAWS = tuple(law.name for law in _ALL if law.varies)
"""Laws whose level can differ with the direction and along the stroke."""


def law_coordinates(device: Any, stated: Mapping[str, float]) -> dict[str, float]:
    """What a device states, with coordinates of its law in the place of its parameters.

    Parameters
    ----------
    device
        Whose law it is.
    stated
        Its parameters that are stated, by name.
    """
    values = dict(stated)
    for name in FRICTION[device.friction].set_free:
        parameters = COORDINATES[name].words
        if name not in parameters and any(each in values for each in parameters):
            for each in parameters:
                values.pop(each, None)
            values[name] = COORDINATES[name].of(device)
    return values
