"""One row of an evaluation."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any


@dataclass(frozen=True, kw_only=True)
class Evaluation:
    """One index of one case; SI units.

    Attributes
    ----------
    layout, case, index, road, stiffness, damping, inertance
        What was evaluated; of a half-car the front strut.
    rear_stiffness, rear_damping, rear_inertance
        Of a half-car's rear strut; None else.
    car
        "quarter" or "half".
    numbers
        The case in the paper, "2.3" for case 3 of Table 2.
    value, low, high
        The index and its 95 % interval; equal for J5.
    exact
        The norm of the transfer function, where the case is linear.
    change, change_low, change_high
        Relative to the same layout with an ideal inerter at its linear optimum.
    roads
        How many; 0 for J5.
    reoptimised
        Whether c and b are the best for this case.
    peaks
        J5: (frequency [Hz], gain [m/N]) of each.
    """

    layout: str
    case: str
    index: str
    road: str | None
    stiffness: float
    damping: float
    inertance: float
    rear_stiffness: float | None
    rear_damping: float | None
    rear_inertance: float | None
    car: str
    numbers: str
    value: float
    low: float
    high: float
    exact: float | None
    change: float
    change_low: float
    change_high: float
    roads: int
    reoptimised: bool
    peaks: tuple[tuple[float, float], ...] = ()

    def json(self) -> dict[str, Any]:
        """Plain data: of a half-car the struts as "front" and "rear"."""
        row = asdict(self)
        rear = {name: row.pop(f"rear_{name}") for name in ("stiffness", "damping", "inertance")}
        if self.rear_stiffness is not None:
            row["front"] = {"stiffness": self.stiffness} | {
                name: row.pop(name) for name in ("damping", "inertance")
            }
            row["rear"] = rear
        return row
