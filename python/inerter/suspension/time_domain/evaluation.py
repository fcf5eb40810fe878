"""One row of an evaluation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

from inerter.suspension.optimum import finite
from inerter.suspension.time_domain.varied import Varied, summary


@dataclass(frozen=True, kw_only=True)
class Evaluation:
    """One index of one case; SI units.

    Attributes
    ----------
    layout, case, index, road, stiffness, damping, inertance
        What was evaluated; of a half- or full car the front strut.
    rear_stiffness, rear_damping, rear_inertance
        Of the rear strut; None of a quarter-car.
    springs, rear_springs
        Inner springs of the layout [N/m] by name, inf for a rigid one.
    car
        "quarter", "half" or "full".
    numbers
        The case in the paper, "2.3" for case 3 of Table 2.
    value, low, high
        The index and its 95 % interval; equal for J5.
    exact
        Exact where the case is linear: on the paper's road the norm of the transfer function, on
        another the integral over its band.
    linear
        The exact value of the same design without friction and play, on the same road.
    change, change_low, change_high
        Relative to the same layout with an ideal inerter at its linear optimum.
    roads
        How many; 0 for J5.
    road_period
        After how many seconds the road repeats; None for J5.
    settle
        Seconds before the means began.
    travel_rms, travel_peak, lift_off, tyre_peak
        On the roads, None for J5: rms and largest travel of a strut [m], share of time that a tyre
        is off the road (mean of the wheels), largest dynamic force that presses a tyre [N].
    pulling
        The index with tyres that pull on the road, where they would be off it.
    variations
        The index of the design under each variation of the plan; empty without any.
    notes
        Sentences on what a reader should know.
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
    linear: float | None
    change: float
    change_low: float
    change_high: float
    roads: int
    reoptimised: bool
    road_period: float | None = None
    settle: float = 0.0
    travel_rms: float | None = None
    travel_peak: float | None = None
    lift_off: float | None = None
    tyre_peak: float | None = None
    pulling: float | None = None
    springs: Mapping[str, float] = field(default_factory=dict)
    rear_springs: Mapping[str, float] = field(default_factory=dict)
    peaks: tuple[tuple[float, float], ...] = ()
    notes: tuple[str, ...] = ()
    variations: tuple[Varied, ...] = ()

    def json(self) -> dict[str, Any]:
        """Plain data: of a half- or full car the struts as "front" and "rear"."""
        row = asdict(self)
        each = row.pop("variations")
        if self.variations:
            row["variations"] = {**summary(self.value, self.variations), "each": each}
        springs, behind = (finite(row.pop(name)) for name in ("springs", "rear_springs"))
        rear = {name: row.pop(f"rear_{name}") for name in ("stiffness", "damping", "inertance")}
        if self.rear_stiffness is not None:
            row["front"] = {"stiffness": self.stiffness} | {
                name: row.pop(name) for name in ("damping", "inertance")
            }
            row["front"] |= springs
            row["rear"] = rear | behind
            return row
        return row | springs
