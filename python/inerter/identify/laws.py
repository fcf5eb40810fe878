"""What a device can be identified as: a law and further parts, joined by "+".

    "dahl", "lugre+series", "brown_mcphee+series+offset", "coulomb+backlash"

Every law has the inertance; all but `ideal` have viscous damping. A part adds its coordinates (see
`coordinates`), each with the range in which a search begins, relative to the data's own sizes: a
start is no bound, fits go on where the data lead them.
"""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from inerter.core import DeviceError
from inerter.identify.coordinates import Scales

LEVEL = 0.1
"""Friction level at which a search begins, per rms force."""


@dataclass(frozen=True)
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
    starts
        Other coordinates: lowest and highest start, in units of `unit_of`, between which starts are
        spread by their logarithm, or evenly where the lowest is negative.
    needs
        Parts that come with it.
    """

    name: str
    meaning: str
    friction: str | None = None
    linear: tuple[str, ...] = ()
    starts: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    needs: tuple[str, ...] = ()


_STRIBECK = {"stribeck_velocity": (0.03, 1.0), "static_excess": (0.03, 1.5)}
_BRISTLE = {"presliding": (1e-3, 1.0)}
_SERIES = {"series_frequency": (1.5, 30.0), "series_loss": (0.01, 1.0)}

PARTS: Mapping[str, Part] = MappingProxyType(
    {
        part.name: part
        for part in (
            Part("ideal", "inertance alone"),
            Part("viscous", "viscous damping", None, ("viscous",)),
            Part("coulomb", "Coulomb friction", "coulomb", ("viscous",)),
            Part("stribeck", "Stribeck friction", "stribeck", ("viscous",), _STRIBECK),
            Part(
                "brown_mcphee", "Brown-McPhee friction", "brown_mcphee", ("viscous",), _STRIBECK
            ),
            Part("dahl", "Dahl friction", "dahl", ("viscous",), _BRISTLE),
            Part(
                "lugre", "LuGre friction", "lugre", ("viscous",),
                _STRIBECK | _BRISTLE | {"bristle_damping": (1e-3, 0.3)},
            ),
            Part(
                "bouc_wen", "Bouc-Wen hysteresis", "bouc_wen", ("viscous",),
                _BRISTLE | {"bw_shape": (0.3, 1.2), "bw_exponent": (1.05, 2.5)},
            ),
            # beta and gamma of any sign: hysteresis that hardens has no largest force
            Part(
                "bouc_wen_any", "Bouc-Wen hysteresis, softening or hardening", "bouc_wen",
                ("viscous", "bw_stiffness"), {"bw_beta": (0.03, 3.0), "bw_gamma": (0.0, 0.0)},
            ),
            Part("series", "spring and damper in series with the inertance", None, (), _SERIES),
            Part(
                "backlash", "free play in series with the inertance", None, (),
                {"backlash": (1e-3, 0.3)}, needs=("series",),
            ),
            # where in its play a run begins is as unknown as the play
            Part(
                "play", "free play before the friction", None, (),
                {"friction_backlash": (1e-3, 0.3), "friction_place": (-0.75, 0.75)},
            ),
            Part(
                "fluid", "fluid inerter: Brown-McPhee friction, compressible fluid, lossy channel",
                "brown_mcphee", ("viscous",),
                _STRIBECK | {"flywheel_viscous": (1e-3, 0.3), "series_hardening": (0.0, 0.0)},
                needs=("series",),
            ),
            Part("offset", "constant force", None, ("force_offset",)),
            # where x = 0 is, is the bench's choice: a spring comes with a constant force
            Part("stiffness", "parallel spring", None, ("stiffness", "force_offset")),
            Part(
                "hardening", "cubic parallel spring", None,
                ("stiffness", "stiffness_cubic", "force_offset"),
            ),
            Part("quadratic", "quadratic damping", None, ("quadratic_damping",)),
            Part("load", "friction per inertance force", None, (), {"load_friction": (0.01, 0.05)}),
            Part(
                "asymmetry", "friction that differs between directions", None, (),
                {"friction_asymmetry": (0.0, 0.0)},
            ),
            Part(
                "position", "friction that changes along the stroke", None, (),
                {"friction_gradient": (0.0, 0.0), "friction_curvature": (0.0, 0.0)},
            ),
            Part(
                "variable", "inertance that changes along the stroke", None, (),
                {"inertance_gradient": (0.0, 0.0), "inertance_curvature": (0.0, 0.0)},
            ),
            Part("delay", "force channel late", None, (), {"delay": (0.0, 0.0)}),
        )
    }
)  # fmt: skip
"""Every law and term by its name."""

LAWS = ("ideal", "viscous", "coulomb", "stribeck", "brown_mcphee", "dahl", "lugre", "bouc_wen")
"""What is tried unless something is asked for."""

BRISTLES = ("dahl", "lugre", "bouc_wen")
"""Friction laws with a state."""


@dataclass(frozen=True)
class Law:
    """What is to be identified: `name` as given, its friction law, and its coordinates.

    `linear` and `starts` as in `Part`, of all parts together.
    """

    name: str
    friction: str
    linear: tuple[str, ...]
    starts: Mapping[str, tuple[float, float]]


def law_named(text: str) -> Law:
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
    starts = {name: ends for part in parts for name, ends in part.starts.items()}
    if any(name in starts for name in ("friction_asymmetry", "friction_gradient")) and (
        friction in ("none", "bouc_wen")
    ):
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
    return Law("+".join(names), friction, tuple(linear), MappingProxyType(starts))


def unit_of(name: str, sizes: Scales) -> float:
    """What the starts of a coordinate are counted in."""
    slow = (sizes.acceleration / sizes.displacement) ** 0.5 / 6.283185307179586
    return {
        "stribeck_velocity": sizes.velocity,
        # of the friction level
        "static_excess": LEVEL * sizes.force,
        "presliding": sizes.displacement,
        "bristle_damping": sizes.force / sizes.velocity,
        "flywheel_viscous": sizes.force / sizes.velocity,
        "series_frequency": slow,
        "backlash": sizes.displacement,
        "friction_backlash": sizes.displacement,
        "bw_beta": 1 / sizes.displacement,
    }.get(name, 1.0)
