"""What is chosen of a strut, and in place of the case's own parameters."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from inerter.suspension.layouts import springs_of

_WITHOUT_SPRING = {"S4": "S2", "S5": "S3", "SR": "S1", "SW8": "SW7"}
_UNCENTRED = {"SW7": "S3", "SW8": "S5"}


@dataclass(frozen=True)
class Design:
    """k [N/m], c [N s/m], b [kg], and values in place of the case's own (SI, by key).

    `rear`: the same of the rear strut, for a half- or full car; the rest is then of the front one.
    `relaxation_stiffness` k_b [N/m] (inf: rigid), `centring_share` and `centring_ratio` where the
    layout has them.

    Raises
    ------
    ValueError
        A stiffness or damping that is not positive, a negative inertance.
    """

    stiffness: float
    damping: float
    inertance: float = 0.0
    parameters: Mapping[str, float] = field(default_factory=dict)
    rear: Design | None = None
    relaxation_stiffness: float | None = None
    centring_share: float | None = None
    centring_ratio: float | None = None

    def __post_init__(self) -> None:
        """Check what was given, see Raises."""
        for name in ("stiffness", "damping"):
            if not 0.0 < getattr(self, name) < float("inf"):
                raise ValueError(f"{name} is {getattr(self, name):g}: give a positive number")
        if not 0.0 <= self.inertance < float("inf"):
            raise ValueError(f"inertance is {self.inertance:g}: give a number that is 0 or above")

    @property
    def struts(self) -> tuple[Design, ...]:
        """The front strut and, if there is one, the rear strut."""
        return (self,) if self.rear is None else (self, self.rear)

    @property
    def more(self) -> dict[str, float]:
        """What a layout takes beside stiffness, damping and inertance, by name."""
        names = ("relaxation_stiffness", "centring_share", "centring_ratio")
        found = {name: getattr(self, name) for name in names}
        return {name: value for name, value in found.items() if value is not None}

    @property
    def springs(self) -> dict[str, float]:
        """Inner springs of one strut [N/m] by name: k_b, and k_1, k_2 with what is beside them."""
        found = springs_of(self.stiffness, self.more)
        if self.relaxation_stiffness is not None:
            found = {"relaxation_stiffness": self.relaxation_stiffness, **found}
        return found


def both(struts: list[Design]) -> Design:
    """One design of the struts, front first."""
    return struts[0] if len(struts) == 1 else replace(struts[0], rear=struts[1])


def left_of(layout: str, strut: Design) -> str:
    """The layout that a strut is where springs of it are rigid or absent."""
    if strut.relaxation_stiffness == math.inf:
        layout = _WITHOUT_SPRING.get(layout, layout)
    if strut.relaxation_stiffness == 0.0 and layout == "S6":
        layout = "S3"
    return _UNCENTRED.get(layout, layout) if strut.centring_share == 0.0 else layout
