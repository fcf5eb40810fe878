"""The best design of a layout: global search, exact polish, and what the optimum looks like.

Every local minimum of a coarse grid over the whole range is polished, and the best result counts.
Nothing is drawn at random: the same problem has the same answer on every machine.

Where J5 is at its lower bound 1/k + 1/kt (soft springs: no strut can do better, it is the yielding
under a constant load) a whole region of designs has it. The design of that region with the smallest
J1 is given, to about a thousandth.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from inerter.suspension.coarse_search import starting_points
from inerter.suspension.layouts import LAYOUTS
from inerter.suspension.polish_peaks import local_peaks, polish_peaks
from inerter.suspension.polish_smooth import polish_smooth
from inerter.suspension.problem import Array, SuspensionProblem

# relative: what counts as equal to the lower bound of J5
_EQUAL = 1e-9


class NoDesignError(ValueError):
    """No design of a layout keeps the limits; one sentence."""


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
        k_b [N/m]; None where the layout has none.
    peaks
        Of J5: (frequency [Hz], gain [m/N]) of every local maximum of the gain, the static one too.
    notes
        Sentences on what a reader should know: a bound was met, the optimum is not unique.
    more
        Further parameters of the layout by name, SI units; with centring springs also the
        `spring_beside`, what is left of k for it.
    """

    value: float
    damping: float
    inertance: float
    relaxation_stiffness: float | None
    peaks: tuple[tuple[float, float], ...]
    notes: tuple[str, ...]
    more: Mapping[str, float] = field(default_factory=dict)

    def design(self) -> dict[str, Any]:
        """Its part in a row of the command's JSON."""
        design = {"damping": self.damping, "inertance": self.inertance}
        if self.relaxation_stiffness is not None:
            design["relaxation_stiffness"] = self.relaxation_stiffness
        return design | dict(self.more)


def optimise(problem: SuspensionProblem, *, limits: bool = True) -> Optimum:
    """Minimise an index over all designs of a layout, and of those that it has as a limit.

    `limits`: look at the latter.

    Raises
    ------
    NoDesignError
        No design keeps the limits of the problem.
    """
    if problem.choices:
        return _of_catalogue(problem)
    if problem.limits:
        return _within(problem)
    found = _optimise(problem)
    if not limits:
        return found
    for name, ends in problem.network.limits.items():
        inner = limit_of(problem, name, ends)
        if inner is None:
            continue
        other = optimise(inner)
        if other.value < found.value * (1.0 - 1e-9):
            found = _as_limit(problem, other, name, ends)
    return found


def _of_catalogue(problem: SuspensionProblem) -> Optimum:
    """The best of all combinations of values of a catalogue."""
    names = [name for name, _ in problem.choices]
    found: list[Optimum] = []
    refused = NoDesignError("a catalogue is empty")
    for values in itertools.product(*(values for _, values in problem.choices)):
        fixed = (*problem.fixed, *zip(names, values, strict=True))
        try:
            found.append(optimise(replace(problem, choices=(), fixed=fixed)))
        except NoDesignError as error:
            refused = error
    if not found:
        raise refused
    return min(found, key=lambda one: one.value)


def _within(problem: SuspensionProblem) -> Optimum:
    from inerter.suspension.within import optimise_within

    free = replace(problem, limits=())
    found = optimise_within(free, dict(problem.limits))
    if found is None:
        words = ", ".join(f"{name} <= {value:g}" for name, value in problem.limits)
        raise NoDesignError(f"no design of {problem.layout} keeps {words}: widen the limit")
    notes = [f"{name} at its limit" for name, value in problem.limits
             if found.indices[name] >= value * (1.0 - 1e-4)]  # fmt: skip
    if found.layout != problem.layout:
        notes.append(f"best as {found.layout}, which it has as a limit")
    design = {key: x for key, x in found.design.items() if key != "stiffness"}
    known = ("damping", "inertance", "relaxation_stiffness")
    return Optimum(
        value=found.value,
        damping=design.get("damping", 0.0),
        inertance=design.get("inertance", 0.0),
        relaxation_stiffness=design.get("relaxation_stiffness"),
        peaks=(),
        notes=tuple(notes),
        more={key: x for key, x in design.items() if key not in known},
    )


def limit_of(
    problem: SuspensionProblem, name: str, ends: Mapping[str, int]
) -> SuspensionProblem | None:
    """The problem of a layout that is a limit; none where a bound or a given value forbids it."""
    held = {key for key, *_ in (*problem.fixed, *problem.ranges)}
    if held & set(ends) or (problem.massless and "inertance" in ends):
        return None
    names = LAYOUTS[name].variables
    return replace(
        problem,
        layout=name,
        own=None,
        fixed=tuple(one for one in problem.fixed if one[0] in names),
        ranges=tuple(one for one in problem.ranges if one[0] in names),
    )


def _as_limit(
    problem: SuspensionProblem, other: Optimum, name: str, ends: Mapping[str, int]
) -> Optimum:
    """The optimum of a limit as one of the layout: what is absent is 0, what is rigid its bound."""
    high = dict(zip(problem.variables, np.exp(problem.bounds[:, 1]).tolist(), strict=True))
    values = {key: high[key] if end else 0.0 for key, end in ends.items()}
    words = " and ".join(
        f"{key.replace('_', ' ')} {'without limit' if end else '0'}" for key, end in ends.items()
    )
    own = {
        key: values.get(key, getattr(other, key))
        for key in ("damping", "inertance", "relaxation_stiffness")
    }
    more = {
        key: values.get(key, other.more.get(key, 0.0))
        for key in problem.network.variables
        if key not in own
    }
    note = f"best as {name}, which it is with {words}: the value is that of {name}"
    return replace(other, **own, more=more, notes=(note, *other.notes))


def _optimise(problem: SuspensionProblem) -> Optimum:
    best, value, point = problem, *_best(problem)
    # without inertance counts as a design where the strut still is one
    held = {name for name, *_ in (*problem.fixed, *problem.ranges)}
    may_vanish = problem.network.may_vanish and "inertance" not in held
    if may_vanish and not problem.massless:
        other = problem.without()
        without, there = _best(other)
        if without <= value * (1.0 + 1e-12):
            best, value, point = other, without, there
    notes = []
    if problem.index == "J5" and value <= _static(problem) * (1.0 + _EQUAL):
        value, point = _static(problem), _softest(best, point)
        notes.append(
            "J5 is 1/k + 1/kt, which no strut can lower; of the designs that reach it the one "
            "with the smallest J1 is given"
        )
    if best is not problem:
        notes.append("best without inertance")
    notes += _at_bounds(best, point)
    return _described(best, value, point, tuple(notes))


def _described(
    problem: SuspensionProblem, value: float, point: Array, notes: tuple[str, ...]
) -> Optimum:
    design = {key: _rounded(float(x)) for key, x in problem.parameters(point).items()}
    known = ("damping", "inertance", "relaxation_stiffness", "stiffness")
    more = {key: x for key, x in design.items() if key not in known}
    if problem.network.centring:
        more["spring_beside"] = design["stiffness"]
    return Optimum(
        value=value,
        damping=design.get("damping", 0.0),
        inertance=design.get("inertance", 0.0),
        relaxation_stiffness=design.get("relaxation_stiffness"),
        peaks=_peaks(problem, point) if problem.index == "J5" else (),
        notes=notes,
        more=more,
    )


def _best(problem: SuspensionProblem) -> tuple[float, Array]:
    if not problem.variables:
        nothing = np.empty(0)
        return float(np.squeeze(problem.value(nothing[None]))), nothing
    polish = polish_smooth if problem.objective.smooth else polish_peaks
    best, at = np.inf, np.empty(0)
    for start in starting_points(problem):
        value, point = polish(problem, start, best)
        # of equal ones the first, which alone was followed to its last digits
        if value < best * (1.0 - 1e-8):
            best, at = value, point
        # nothing is below the lower bound
        if problem.index == "J5" and best <= _static(problem) * (1.0 + _EQUAL):
            break
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
    steps = 7 if count <= 3 else 3
    stencil = np.array(list(itertools.product(np.linspace(-1.0, 1.0, steps), repeat=count)))
    if not count:
        return start
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
        if at <= low + 1e-6:
            notes.append(f"{word} at the lower end of its range: the layout is best without it")
        elif at >= high - 1e-6:
            notes.append(f"{word} at the upper end of its range: the layout is best with it rigid")
    return notes
