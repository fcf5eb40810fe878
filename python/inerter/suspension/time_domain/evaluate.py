"""Indices of nonlinear cases with confidence intervals, c and b kept or sought anew.

J1 and J3 are means over roads of random phases, with the 95 % interval of Student's t. J5 has no
road in it and no interval. What a case costs against the ideal inerter is compared road by road,
which takes most of the chance out; its interval is that of the differences.

c and b are those of the linear optimum with the case's own inerter, ideal or elastic, without
friction and play (`reoptimise=False`), or sought by Nelder and Mead over the logarithms from three
starts, on a few of the roads, the same for every design. The ideal case is compared at its own
optimum either way.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import asdict, dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize
from scipy.stats import t as student

from inerter.suspension.quarter_car import QuarterCar, Road
from inerter.suspension.time_domain.cases import CASES, Case, numbers_of
from inerter.suspension.time_domain.linear import (
    SMALLEST_INERTANCE,
    exact_index,
    linear_optimum,
)
from inerter.suspension.time_domain.load_peaks import load_peaks
from inerter.suspension.time_domain.model import CarModel, Design, compiled
from inerter.suspension.time_domain.road import PeriodicRoad, paper_road
from inerter.suspension.time_domain.simulate import RunSettings, road_indices
from inerter.suspension.time_domain.stepping import StepError

Array = NDArray[np.float64]
Progress = Callable[[float, str], None]

CONFIDENCE = 0.95
INDEX_NAMES = ("J1", "J3", "J5")

_STARTS = ((1.0, 1.0), (0.75, 1.35), (1.35, 0.75))
_SIMPLEX = 0.12


@dataclass(frozen=True, kw_only=True)
class Plan:
    """What is to be evaluated; every layout with every case that it can have.

    `seeds`: number of roads; `search_seeds`: of them, those that a search uses. `amplitude` [N] of
    the load for J5.

    Raises
    ------
    ValueError
        An unknown name, or a number out of range.
    """

    layouts: tuple[str, ...] = ("S1", "S2", "S3")
    cases: tuple[Case, ...] = (CASES["ideal"],)
    indices: tuple[str, ...] = INDEX_NAMES
    stiffnesses: tuple[float, ...] = (120e3,)
    road: PeriodicRoad = field(default_factory=paper_road)
    seeds: int = 20
    search_seeds: int = 4
    reoptimise: bool = False
    amplitude: float = 1000.0
    car: QuarterCar = field(default_factory=QuarterCar)
    settings: RunSettings = field(default_factory=RunSettings)

    def __post_init__(self) -> None:
        """Check what was given, see Raises."""
        for index in self.indices:
            if index not in INDEX_NAMES:
                raise ValueError(f"index {index!r}: there are {', '.join(INDEX_NAMES)}")
        for stiffness in self.stiffnesses:
            if not 0.0 < stiffness < math.inf:
                raise ValueError(f"stiffness is {stiffness:g} N/m: give a positive number")
        if self.seeds < 2:
            raise ValueError(f"seeds is {self.seeds}: give 2 or more, for an interval")
        if self.search_seeds < 1:
            raise ValueError(f"search_seeds is {self.search_seeds}: give 1 or more")
        if not 0.0 < self.amplitude < math.inf:
            raise ValueError(f"amplitude is {self.amplitude:g} N: give a positive number")
        for layout in self.layouts:
            compiled(layout, CASES["ideal"], self.car)
        if not self.rows:
            raise ValueError("layout S1 has no inerter: nothing but the case ideal is one of it")

    @property
    def rows(self) -> list[tuple[float, str, str, Case]]:
        """Stiffness, index, layout, case of every row; S1 has the ideal case only."""
        return [
            (k, index, layout, case)
            for k in self.stiffnesses
            for index in self.indices
            for layout in self.layouts
            for case in self.cases
            if layout != "S1" or (case.friction == "none" and not case.parameters)
        ]


@dataclass(frozen=True)
class Evaluation:
    """One index of one case; SI units.

    Attributes
    ----------
    layout, case, index, road, stiffness, damping, inertance
        What was evaluated.
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
        Whether c and b were sought for this case.
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
        """Plain data."""
        return asdict(self)


def evaluate(plan: Plan, progress: Progress | None = None) -> list[Evaluation]:
    """Every row of a plan, in its order.

    Raises
    ------
    ValueError
        A design that cannot be simulated with the step of the settings.
    """
    tell = progress or (lambda share, text: None)
    results: list[Evaluation] = []
    baseline: dict[tuple[float, str, str], Samples] = {}
    for done, (k, index, layout, case) in enumerate(plan.rows):
        tell(done / len(plan.rows), f"{index} of {layout}, {case.name}")
        key = (k, index, layout)
        if key not in baseline:
            baseline[key] = _samples_of_ideal(plan, *key)
        results.append(_row(plan, k, index, layout, case, baseline[key]))
    tell(1.0, "done")
    return results


def _samples_of_ideal(plan: Plan, k: float, index: str, layout: str) -> Samples:
    design = linear_optimum(index, layout, k, None, plan.car, _slope(plan))
    model = compiled(layout, CASES["ideal"], plan.car)
    return samples(plan, model, index, design, plan.seeds)


def _row(plan: Plan, k: float, index: str, layout: str, case: Case, ideal: Samples) -> Evaluation:
    model = compiled(layout, case, plan.car)
    design = linear_optimum(index, layout, k, case.pair, plan.car, _slope(plan))
    searched = plan.reoptimise and not case.linear
    if searched:
        design = reoptimised(plan, model, index, design)
    same = case.friction == "none" and not case.parameters
    found = ideal if same else samples(plan, model, index, design, plan.seeds)
    values = found.values
    value, low, high = interval(values)
    change, change_low, change_high = interval(values / ideal.values - 1.0)
    exact = None
    if case.linear and (index == "J5" or plan.road.name == "paper"):
        exact = exact_index(index, layout, design, case.pair, plan.car, _slope(plan))
    return Evaluation(
        layout=layout,
        case=case.name,
        index=index,
        road=None if index == "J5" else plan.road.name,
        stiffness=k,
        damping=design.damping,
        inertance=design.inertance,
        numbers=numbers_of(layout, case.name),
        value=value,
        low=low,
        high=high,
        exact=exact,
        change=change,
        change_low=change_low,
        change_high=change_high,
        roads=0 if index == "J5" else plan.seeds,
        reoptimised=searched or (plan.reoptimise and case.linear),
        peaks=found.peaks,
    )


@dataclass(frozen=True)
class Samples:
    """An index of one design: `values` on every road, shape (roads,), one for J5 with its peaks."""

    values: Array
    peaks: tuple[tuple[float, float], ...] = ()


def samples(plan: Plan, model: CarModel, index: str, design: Design, seeds: int) -> Samples:
    """An index of a design on `seeds` roads.

    Raises
    ------
    ValueError
        A design that cannot be simulated (`StepError` if it diverged).
    """
    if index == "J5":
        (found,) = load_peaks(model, [design], plan.amplitude, plan.settings)
        return Samples(np.array([found.value]), found.peaks)
    return Samples(road_indices(model, [design], plan.road, range(seeds), plan.settings)[index][0])


def reoptimised(plan: Plan, model: CarModel, index: str, start: Design) -> Design:
    """The c and b of the smallest mean index, sought from the linear optimum and around it.

    The roads are the same for every design, so that chance does not move the optimum about.
    """
    seeds = min(plan.search_seeds, plan.seeds)
    free = 1 if model.layout == "S1" else 2

    def design(point: Array) -> Design:
        scale = np.exp(np.append(point, np.zeros(2 - free)))
        return replace(
            start,
            damping=start.damping * float(scale[0]),
            inertance=max(start.inertance * float(scale[1]), SMALLEST_INERTANCE * (free - 1)),
        )

    def cost(point: Array) -> float:
        if np.max(np.abs(point)) > 4.0:
            return math.inf
        try:
            return float(samples(plan, model, index, design(point), seeds).values.mean())
        except StepError:
            return math.inf

    scale = cost(np.zeros(free))
    best = (1.0, np.zeros(free))
    for factors in _STARTS:
        first = np.log(factors[:free])
        simplex = np.vstack([first, first + _SIMPLEX * np.eye(free)])
        found = minimize(
            lambda point: cost(point) / scale,
            first,
            method="Nelder-Mead",
            options={"initial_simplex": simplex, "xatol": 4e-3, "fatol": 2e-5, "maxfev": 80},
        )
        if found.fun < best[0]:
            best = (float(found.fun), np.asarray(found.x))
    return design(best[1])


def interval(values: Array) -> tuple[float, float, float]:
    """Mean and the ends of its 95 % interval; all three equal for a single value."""
    mean = float(np.mean(values))
    if values.size < 2:
        return mean, mean, mean
    spread = float(np.std(values, ddof=1)) / math.sqrt(values.size)
    half = spread * float(student.ppf(0.5 + 0.5 * CONFIDENCE, values.size - 1))
    return mean, mean - half, mean + half


def _slope(plan: Plan) -> Road:
    """The road of the linear study: a density of the same slope, so that the optimum is the same.

    The norms scale with it; only those of the paper's own road are shown as exact.
    """
    return Road(velocity=1.0, roughness=0.5 * plan.road.strength)
