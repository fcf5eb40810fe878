"""What is chosen of a strut, and in place of the case's own parameters."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Design:
    """k [N/m], c [N s/m], b [kg], and values in place of the case's own (SI, by key).

    `rear`: the same of the rear strut, for a half-car; the rest is then of the front one.

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
