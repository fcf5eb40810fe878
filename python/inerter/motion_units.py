"""Units of a device that moves along a line, and of one that turns about an axis.

The laws are the same: a displacement is an angle, a force a torque, an inertance a moment of
inertia. Everything is written for translation; here is what its units are in rotation. A gas or a
fluid is pressed by a vane: its area is the volume that a radian moves, m^3/rad.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any, Final, Literal

Kind = Literal["translation", "rotation"]
TRANSLATION: Final[Literal["translation"]] = "translation"
ROTATION: Final[Literal["rotation"]] = "rotation"

_TURNED = {"m": "rad", "mm": "mrad", "um": "urad", "N": "N*m", "kg": "kg*m^2"}
# what is no length of the motion: a gas, a fluid, a channel
_SAME = {"m^3", "Pa", "Pa*s", "kg/m^3"}
_AREA = {"m^2": "m^3/rad"}
_LENGTHS_OF_FLUID = ("channel_area", "channel_length", "channel_roughness", "coil_diameter")
_UNIT = re.compile(r"(?<![A-Za-z^])(?:kg|mm|um|m|N)(?![A-Za-z])")


def unit(motion: Kind, name: str) -> str:
    """The unit of a motion in place of one of translation: "N*s/m" is "N*m*s/rad" in rotation."""
    if motion == TRANSLATION or name in _SAME:
        return name
    if name in _AREA:
        return _AREA[name]
    return _UNIT.sub(lambda found: _TURNED[found[0]], name)


def parameter_unit(motion: Kind, parameter: str, name: str) -> str:
    """The unit of a device's parameter, whose unit in translation is `name`."""
    return name if parameter in _LENGTHS_OF_FLUID else unit(motion, name)


def words(motion: Kind, name: str) -> str:
    """The same for a text, with blanks for the signs of products: "N s/m", "N m s/rad"."""
    return unit(motion, name.replace(" ", "*")).replace("*", " ")


def force_word(motion: Kind) -> str:
    """What the force of a motion is called."""
    return "force" if motion == TRANSLATION else "torque"


def shown_as(motion: Kind, text: str) -> str:
    """A sentence about forces as one about torques where the device turns."""
    return text if motion == TRANSLATION else re.sub(r"\bforce\b", "torque", text)


def one_motion(records: Iterable[Any]) -> Kind:
    """The motion of all records; ValueError where some are of translation and some of rotation."""
    of: dict[Kind, str] = {}
    for record in records:
        of.setdefault(record.motion, record.name)
    if len(of) > 1:
        raise ValueError(
            f"{of[TRANSLATION]} moves along a line (m, N) and {of[ROTATION]} turns (rad, N*m); "
            "they are no records of one device: give one kind at a time"
        )
    return next(iter(of), None) or TRANSLATION
