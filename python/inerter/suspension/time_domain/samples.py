"""An index of one design on every road, and its mean with an interval."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.stats import t as student

from inerter.suspension.time_domain.car_model import CarModel
from inerter.suspension.time_domain.design import Design
from inerter.suspension.time_domain.load_peaks import load_peaks
from inerter.suspension.time_domain.plan import Plan
from inerter.suspension.time_domain.simulate import BESIDE, road_indices

Array = NDArray[np.float64]

CONFIDENCE = 0.95


@dataclass(frozen=True)
class Samples:
    """An index of one design: `values` on every road, shape (roads,), one for J5 with its peaks.

    `beside`: of a road what else `road_indices` gives, means over the roads, peaks the largest.
    """

    values: Array
    peaks: tuple[tuple[float, float], ...] = ()
    beside: Mapping[str, float] = field(default_factory=dict)


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
    found = road_indices(model, [design], plan.road, range(seeds), plan.settings, indices=(index,))
    beside = {
        name: float(values.max() if name.endswith("_peak") else values.mean())
        for name, values in found.items()
        if name in BESIDE
    }
    return Samples(found[index][0], beside=beside)


def interval(values: Array) -> tuple[float, float, float]:
    """Mean and the ends of its 95 % interval; all three equal for a single value."""
    mean = float(np.mean(values))
    if values.size < 2:
        return mean, mean, mean
    spread = float(np.std(values, ddof=1)) / math.sqrt(values.size)
    half = spread * float(student.ppf(0.5 + 0.5 * CONFIDENCE, values.size - 1))
    return mean, mean - half, mean + half
