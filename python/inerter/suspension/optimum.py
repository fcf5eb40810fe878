"""The best design of a layout: global search, exact polish, and what the optimum looks like.

Every local minimum of a coarse grid over the whole range is polished, and the best result counts.
Nothing is drawn at random: the same problem has the same answer on every machine.

Where J5 is at its lower bound 1/k + 1/kt (soft springs: no strut can do better, it is the yielding
under a constant load) a whole region of designs has it. The design of that region with the smallest
J1 is given, to about a thousandth.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Any

import numpy as np

from inerter.suspension.coarse_search import starting_points
from inerter.suspension.layouts import springs_of
from inerter.suspension.polish_peaks import local_peaks, polish_peaks
from inerter.suspension.polish_smooth import polish_smooth
from inerter.suspension.problem import Array, SuspensionProblem
from inerter.suspension.variations import scene_notes
from inerter.suspension.white_road import refuse_infinite

# relative: what counts as equal to the lower bound of J5
_EQUAL = 1e-9
_GOES = 6

LIMITS = {
    ("relaxation_stiffness", 0.0): "without the relaxation spring",
    ("relaxation_stiffness", math.inf): "with the relaxation spring rigid",
    ("centring_share", 0.0): "without centring springs",
}
"""What a variable at its limit means, in words."""


def finite(design: Mapping[str, float]) -> dict[str, float | None]:
    """A design for JSON: None for a spring that is rigid."""
    return {name: value if math.isfinite(value) else None for name, value in design.items()}


@dataclass(frozen=True, kw_only=True)
class Optimum:
    """The best design.

    Attributes
    ----------
    value
        The index, SI units.
    damping, inertance
        c [N s/m], b [kg]; 0 without inerter.
    relaxation_stiffness
        k_b [N/m], inf if it is best rigid; None where the layout has none.
    springs
        k_1, k_2 [N/m] beside damper and inerter and k of what stands beside them all, by name:
        "damper_stiffness", "inerter_stiffness", "parallel_stiffness". Empty where there are none.
    peaks
        Of J5: (frequency [Hz], gain [m/N]) of every local maximum of the gain, the static one too.
    notes
        Sentences on what a reader should know: a bound was met, the optimum is not unique.
    """

    value: float
    damping: float
    inertance: float
    relaxation_stiffness: float | None
    peaks: tuple[tuple[float, float], ...]
    notes: tuple[str, ...]
    springs: Mapping[str, float] = field(default_factory=dict)

    def design(self) -> dict[str, Any]:
        """Its part in a row of the command's JSON."""
        design = {"damping": self.damping, "inertance": self.inertance}
        if self.relaxation_stiffness is not None:
            design["relaxation_stiffness"] = self.relaxation_stiffness
        return finite({**design, **self.springs})


def optimise(problem: SuspensionProblem) -> Optimum:
    """Minimise an index over all designs of a layout.

    Raises
    ------
    InfiniteIndexError
        No design has a finite value, for tyre damping.
    """
    refuse_infinite(problem)
    if problem.limits or problem.catalogue or not problem.variables:
        return _limited(problem)
    best, value, point = problem, *best_point(problem)
    # without inertance, or another part, counts as a design where the strut still is one
    for other in problem.variants()[1:]:
        without, there = best_point(other)
        if without <= value * (1.0 + 1e-12):
            best, value, point = other, without, there
    notes = []
    if problem.index == "J5" and value <= _static(problem) * (1.0 + _EQUAL):
        value, point = _static(problem), _softest(best, point)
        notes.append(
            "J5 is 1/k + 1/kt, which no strut can lower; of the designs that reach it the one "
            "with the smallest J1 is given"
        )
    return _described(problem, best, value, point, notes)


def _limited(problem: SuspensionProblem) -> Optimum:
    from inerter.suspension.limited import best_within

    found = best_within(problem)
    notes = [f"held back by the limit of {name}" for name in found.reached]
    best = replace(found.problem, limits=())
    assert isinstance(best, SuspensionProblem)
    return _described(problem, best, found.value, found.point, notes)


def _described(
    problem: SuspensionProblem,
    best: SuspensionProblem,
    value: float,
    point: Array,
    notes: list[str],
) -> Optimum:
    design = best.held | dict(zip(best.variables, map(_rounded, np.exp(point)), strict=True))
    if best.massless and not problem.massless:
        notes.append("best without inertance")
    notes += [
        f"best {LIMITS[limit]}"
        for limit in problem.network.limits
        if limit[0] in problem.variables and limit in best.fixed
    ]
    notes += [*_at_bounds(best, point), *scene_notes(best, point)]
    return Optimum(
        value=value,
        damping=design["damping"],
        inertance=design.get("inertance", 0.0),
        relaxation_stiffness=design.get("relaxation_stiffness"),
        peaks=_peaks(best, point) if problem.index == "J5" else (),
        notes=tuple(notes),
        springs=springs_of(problem.stiffness, design),
    )


@lru_cache(maxsize=256)
def best_point(problem: SuspensionProblem) -> tuple[float, Array]:
    """Value and point of the global minimum, every variable of the layout in play."""
    if not problem.variables:
        alone = np.empty(0)
        return float(np.ravel(problem.value(alone[None]))[0]), alone
    polish = polish_smooth if problem.objective.smooth else polish_peaks
    best, at = np.inf, np.empty(0)
    starts = [*starting_points(problem)]
    # what a layout contains is a design of it: so it is never worse
    for inner in problem.inner():
        values = inner.held | dict(
            zip(inner.variables, np.exp(best_point(inner)[1]).tolist(), strict=True)
        )
        starts.append(problem.embedded(inner.layout, values))
    for start in starts:
        value, point = polish(problem, start, best)
        # of equal ones the first, which alone was followed to its last digits
        if value < best * (1.0 - 1e-8):
            best, at = value, point
        # nothing is below the lower bound
        if problem.index == "J5" and best <= _static(problem) * (1.0 + _EQUAL):
            break
    # valleys of four and five variables are walked in more than one go
    for _ in range(_GOES if len(at) > 3 else 0):
        value, point = polish(problem, at, np.inf)
        if not value < best * (1.0 - 1e-11):
            break
        best, at = value, point
    return best, at


def _rounded(value: float) -> float:
    """Without what a logarithm and back leave in the last digits."""
    return float(f"{value:.13g}")


def _static(problem: SuspensionProblem) -> float:
    return problem.car.static_compliance(problem.stiffness)


def _softest(problem: SuspensionProblem, start: Array) -> Array:
    """The design with the smallest J1 among those whose J5 is the static compliance."""
    comfort = replace(problem, index="J1")
    limit = _static(problem) * (1.0 + _EQUAL)
    low, high = problem.bounds.T
    count = len(start)
    number = 7 if count < 4 else 3
    stencil = np.array(list(itertools.product(np.linspace(-1.0, 1.0, number), repeat=count)))
    point, size = start, np.full(count, 1.0)
    # the box shrinks only when its middle is best, so the region can be walked along
    for _ in range(60):
        around = np.clip(np.vstack([point, point + stencil * size]), low, high)
        values = np.where(problem.value(around) <= limit, comfort.value(around), np.inf)
        best = int(np.argmin(values))
        if best == 0 or not np.isfinite(values[best]):
            size = size / 2.5
        else:
            point = around[best]
        if size[0] < 1e-4:
            break
    return point


def _peaks(problem: SuspensionProblem, point: Array) -> tuple[tuple[float, float], ...]:
    frequency, gain = local_peaks(problem.load_function(point))
    pairs = zip(frequency / (2.0 * np.pi), gain, strict=True)
    return tuple((float(f), float(g)) for f, g in pairs)


def _at_bounds(problem: SuspensionProblem, point: Array) -> list[str]:
    notes = []
    for name, at, (low, high) in zip(problem.variables, point, problem.bounds, strict=True):
        word = name.replace("_", " ")
        if name.startswith("centring"):
            if not low + 1e-6 < at < high - 1e-6:
                notes.append(
                    f"{word} at the end of its range: a centring spring is as good as absent"
                )
        elif at <= low + 1e-6:
            notes.append(f"{word} at the lower end of its range: the layout is best without it")
        elif at >= high - 1e-6:
            notes.append(f"{word} at the upper end of its range: the layout is best with it rigid")
    return notes
