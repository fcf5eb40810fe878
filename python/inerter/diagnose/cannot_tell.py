"""What a motion cannot tell, whatever is found along it."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any


@dataclass(frozen=True)
class CannotTell:
    """Effects that are the same force along a motion as something else.

    Attributes
    ----------
    effects : tuple of str
        What is found of one of these holds for the other force as well.
    same_as : str
        What their force is along this motion, in words.
    experiment : str
        What would tell, in words.
    """

    effects: tuple[str, ...]
    same_as: str
    experiment: str

    def json(self) -> dict[str, Any]:
        """As in diagnosis.json."""
        return {**asdict(self), "effects": list(self.effects)}


_SECOND = "a record at a second frequency"
# with a = -w^2 x a spring is an inertance of -k / w^2, and b tau a' is a damper of -b tau w^2
ONE_SINE = (
    CannotTell(
        ("parallel_stiffness", "series_elasticity"), "an inertance of another size", _SECOND
    ),
    CannotTell(("sensor_delay",), "viscous friction", _SECOND),
    CannotTell(("viscoelasticity",), "an inertance of another size and viscous friction", _SECOND),
)
IN_WORDS = (
    "The motion is nearly one sine. Along it a parallel stiffness and a series elasticity are an "
    "inertance of another size, a delay is viscous friction, and a spring that relaxes is both: "
    "what is said of one of them holds for all together, and a record at a second frequency tells "
    "them apart. "
)
"""The same of one sine, as a verdict says it."""


def of_a_tone(frequency: float) -> CannotTell:
    """Of a tone in the force [Hz] above the band in which the motion is told from noise."""
    return CannotTell(
        ("periodic_disturbance",),
        f"a ringing of the drive at {frequency:.3g} Hz that the displacement does not show",
        "a record of the force while nothing is driven, or a displacement with less noise",
    )
