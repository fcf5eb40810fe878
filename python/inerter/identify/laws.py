"""What a device can be identified as: a law and further parts, joined by "+".

    "dahl", "lugre+series", "brown_mcphee+series+offset", "coulomb+backlash"

Every law has the inertance; all but `ideal` have viscous damping. A part adds its coordinates (see
`coordinates`), each with the range in which a search begins, relative to the data's own sizes: a
start is no bound, fits go on where the data lead them.
"""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from inerter.catalogue.coordinates import COORDINATES
from inerter.catalogue.friction import BRISTLES, FRICTION, LEVEL_COORDINATES, FrictionLaw
from inerter.core import DeviceError


@dataclass(frozen=True, kw_only=True)
class Part:
    """One law or term.

    Attributes
    ----------
    name, meaning
        In the user's words.
    friction
        The friction law that it brings; a model has one at most.
    linear
        Coordinates that enter the force in proportion.
    others
        Further coordinates, in the order in which starts are spread over them.
    needs
        Parts that come with it.
    """

    name: str
    meaning: str
    friction: str | None = None
    linear: tuple[str, ...] = ()
    others: tuple[str, ...] = ()
    needs: tuple[str, ...] = ()


def _friction(law: FrictionLaw) -> Part:
    return Part(
        name=law.name, meaning=law.meaning, friction=law.name, linear=("viscous",),
        others=law.spread,
    )  # fmt: skip


_ALL = (
    Part(name="ideal", meaning="inertance alone"),
    Part(name="viscous", meaning="viscous damping", linear=("viscous",)),
    *(_friction(law) for law in FRICTION.values() if law.level),
    # beta and gamma of any sign: hysteresis that hardens has no largest force
    Part(
        name="bouc_wen_any", meaning="Bouc-Wen hysteresis, softening or hardening",
        friction="bouc_wen", linear=("viscous", "bw_stiffness"), others=("bw_beta", "bw_gamma"),
    ),
    Part(
        name="series", meaning="spring and damper in series with the inertance",
        others=("series_frequency", "series_loss"),
    ),
    Part(
        name="backlash", meaning="free play in series with the inertance", others=("backlash",),
        needs=("series",),
    ),
    # where in its play a run begins is as unknown as the play
    Part(
        name="play", meaning="free play before the friction",
        others=("friction_backlash", "friction_place"),
    ),
    Part(
        name="fluid", friction="brown_mcphee", linear=("viscous",), needs=("series",),
        meaning="fluid inerter: Brown-McPhee friction, compressible fluid, lossy channel",
        others=(*FRICTION["brown_mcphee"].spread, "flywheel_viscous", "series_hardening"),
    ),
    Part(name="offset", meaning="constant force", linear=("force_offset",)),
    # where x = 0 is, is the bench's choice: a spring comes with a constant force
    Part(name="stiffness", meaning="parallel spring", linear=("stiffness", "force_offset")),
    Part(
        name="hardening", meaning="cubic parallel spring",
        linear=("stiffness", "stiffness_cubic", "force_offset"),
    ),
    Part(name="quadratic", meaning="quadratic damping", linear=("quadratic_damping",)),
    Part(name="load", meaning="friction per inertance force", others=("load_friction",)),
    Part(
        name="asymmetry", meaning="friction that differs between directions",
        others=("friction_asymmetry",),
    ),
    Part(
        name="position", meaning="friction that changes along the stroke",
        others=("friction_gradient", "friction_curvature"),
    ),
    Part(
        name="variable", meaning="inertance that changes along the stroke",
        others=("inertance_gradient", "inertance_curvature"),
    ),
    Part(name="delay", meaning="force channel late", others=("delay",)),
)  # fmt: skip

PARTS: Mapping[str, Part] = MappingProxyType({part.name: part for part in _ALL})
"""Every law and term by its name."""

LAWS = ("ideal", "viscous", "coulomb", "stribeck", "brown_mcphee", "dahl", "lugre", "bouc_wen")
"""What is tried unless something is asked for."""


@dataclass(frozen=True)
class FittedLaw:
    """What is to be identified: `name` as given, its friction law, and its coordinates.

    `linear` as in `Part`, of all parts together; `starts`: the other coordinates, each with the
    lowest and highest value at which a search begins, see `Coordinate`.
    """

    name: str
    friction: str
    linear: tuple[str, ...]
    starts: Mapping[str, tuple[float, float]]


def law_named(text: str) -> FittedLaw:
    """A law and further parts, joined by "+".

    Raises
    ------
    DeviceError
        An unknown part, or two friction laws.
    """
    names = [name.strip().lower().replace("-", "_") for name in text.split("+")]
    for name in names:
        if name not in PARTS:
            close = difflib.get_close_matches(name, PARTS, n=1)
            hint = f" (did you mean {close[0]}?)" if close else ""
            raise DeviceError(
                f"law {text!r}: {name!r} is not known{hint}; choose from {', '.join(PARTS)}, "
                "joined by + where there are several"
            )
    parts = [PARTS[name] for name in dict.fromkeys(names)]
    parts += [PARTS[name] for part in parts for name in part.needs if name not in names]
    frictions = [part.friction for part in parts if part.friction]
    if len(frictions) > 1:
        raise DeviceError(
            f"law {text!r} has two friction laws, {' and '.join(frictions)}: take one"
        )
    friction = frictions[0] if frictions else "none"
    linear = dict.fromkeys(("inertance", *(name for part in parts for name in part.linear)))
    starts = {name: COORDINATES[name].start for part in parts for name in part.others}
    if any(name in starts for name in LEVEL_COORDINATES) and not FRICTION[friction].varies:
        raise DeviceError(
            f"law {text!r} varies a friction level, but has none: add coulomb, stribeck, dahl or "
            "lugre"
        )
    if "friction_backlash" in starts and friction not in BRISTLES:
        raise DeviceError(
            f"law {text!r} has free play before a bristle, but no bristle: add "
            f"{', '.join(BRISTLES[:-1])} or {BRISTLES[-1]} (backlash is the free play in series "
            "with the inertance)"
        )
    return FittedLaw("+".join(names), friction, tuple(linear), MappingProxyType(starts))
