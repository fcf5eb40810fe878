"""What is to be evaluated: every layout with every case that it can have."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from inerter.suspension.indices import INDICES
from inerter.suspension.own_index import is_own
from inerter.suspension.quarter_car import QuarterCar, Road
from inerter.suspension.study import refuse_turning
from inerter.suspension.time_domain.cases import CASES, Case
from inerter.suspension.time_domain.model import LAYOUTS, Car
from inerter.suspension.time_domain.road import PeriodicRoad, paper_road
from inerter.suspension.time_domain.simulate import RunSettings
from inerter.suspension.variations import scenes_of


@dataclass(frozen=True, kw_only=True)
class Plan:
    """Rows to be evaluated and how.

    Attributes
    ----------
    layouts, cases, indices, stiffnesses
        Every combination is a row; layouts without inerter have the ideal case only.
        Stiffness [N/m] of the front strut.
    road
        Of which `seeds` roads are drawn; `search_seeds` of them are those of a search.
    reoptimise
        Seek c and b for every case that is not linear.
    given
        (c [N s/m], b [kg]) of every strut, front first, in place of an optimum; one pair counts
        for both struts of a half- or full car. None for the one that is sought.
    one_sided
        A tyre leaves the road where it would have to pull by more than its static load. If not
        told: everywhere but on the paper's road, whose study has tyres that pull.
    keep_settle
        The settling time of the settings, even where the modes of the car ask for a longer one.
    amplitude
        [N] of the load for J5.
    vary
        Factors by the names in `variations`: every row is told for each combination, too.
    car, settings
        The car, and how it is stepped.

    Raises
    ------
    ValueError
        An unknown name, or a number out of range.
    """

    layouts: tuple[str, ...] = ("S1", "S2", "S3")
    cases: tuple[Case, ...] = (CASES["ideal"],)
    indices: tuple[str, ...] = ("J1", "J3", "J5")
    stiffnesses: tuple[float, ...] = (120e3,)
    road: PeriodicRoad = field(default_factory=paper_road)
    seeds: int = 20
    search_seeds: int = 4
    reoptimise: bool = False
    given: tuple[tuple[float | None, float | None], ...] = ()
    one_sided: bool | None = None
    keep_settle: bool = False
    amplitude: float = 1000.0
    vary: tuple[tuple[str, tuple[float, ...]], ...] = ()
    car: Car = field(default_factory=QuarterCar)
    settings: RunSettings = field(default_factory=RunSettings)

    def __post_init__(self) -> None:
        """Check what was given, see Raises."""
        for index in self.indices:
            if index not in INDICES and not is_own(index):
                raise ValueError(
                    f"index {index!r}: there are {', '.join(INDICES)}, or a file of your own"
                )
        refuse_turning(self.indices, self.car)
        for index in self.indices:
            if "travel" in (index, INDICES[index].signal):
                raise ValueError(
                    f"index {index!r}: travel alone is least with a damper that holds the strut "
                    "fast, so there is nothing to compare with; every row has travel_rms beside, "
                    "and a function mine.py:NAME may take travel with other indices"
                )
        for stiffness in self.stiffnesses:
            if not 0.0 < stiffness < math.inf:
                raise ValueError(f"stiffness is {stiffness:g} N/m: give a positive number")
        if self.seeds < 2:
            raise ValueError(f"seeds is {self.seeds}: give 2 or more, for an interval")
        if self.search_seeds < 1:
            raise ValueError(f"search_seeds is {self.search_seeds}: give 1 or more")
        if not 0.0 < self.amplitude < math.inf:
            raise ValueError(f"amplitude is {self.amplitude:g} N: give a positive number")
        if self.reoptimise and any(None not in pair for pair in self.given):
            raise ValueError("a given damping and inertance cannot be sought anew: take one of two")
        if len(self.given) not in (0, 1, 1 if isinstance(self.car, QuarterCar) else 2):
            raise ValueError(f"{len(self.given)} struts given, but the car is a {self.car_name}")
        for damping, inertance in self.given:
            if damping is not None and not 0.0 < damping < math.inf:
                raise ValueError(f"damping is {damping:g} N s/m: give a positive number")
            if inertance is not None and not 0.0 <= inertance < math.inf:
                raise ValueError(f"inertance is {inertance:g} kg: give a number that is 0 or above")
        for layout in self.layouts:
            if layout not in LAYOUTS:
                raise ValueError(f"layout {layout!r} is not known: take {', '.join(LAYOUTS)}")
        # what is too much is said before the work
        scenes_of(self.car, Road(), dict(self.vary))
        if not self.rows:
            raise ValueError(
                f"layout {self.layouts[0]} has no inerter: nothing but the case ideal is one of it"
            )

    @property
    def car_name(self) -> str:
        """Name of the car: quarter, half or full."""
        return "quarter" if isinstance(self.car, QuarterCar) else self.car.name

    @property
    def leaves(self) -> bool:
        """Whether tyres leave the road."""
        return self.road.name != "paper" if self.one_sided is None else self.one_sided

    @property
    def held(self) -> tuple[str, ...]:
        """What is given of every strut while the rest is sought: "damping", "inertance"."""
        names = ("damping", "inertance")
        return tuple(
            name for n, name in enumerate(names) if any(pair[n] is not None for pair in self.given)
        )

    @property
    def rows(self) -> list[tuple[float, str, str, Case]]:
        """Stiffness, index, layout, case of every row."""
        return [
            (k, index, layout, case)
            for k in self.stiffnesses
            for index in self.indices
            for layout in self.layouts
            for case in self.cases
            if LAYOUTS[layout].has_inerter or case.ideal
        ]
