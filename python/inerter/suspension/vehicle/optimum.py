"""The best struts of a half- or full car: many starts, exact polish, and what the optimum is like.

The same problem has the same answer on every machine. Where J5 is at its lower bound, the yielding
of the centre of mass under a constant load, a whole region of designs has it: the one with the
smallest J1 is given.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from inerter.suspension.layouts import SeriesPair, springs_of
from inerter.suspension.optimum import LIMITS, finite
from inerter.suspension.problem import Array
from inerter.suspension.quarter_car import Road
from inerter.suspension.variations import scene_notes
from inerter.suspension.vehicle.cars import Vehicle
from inerter.suspension.vehicle.load_bound import NEAR, softest_at_bound, start_point
from inerter.suspension.vehicle.load_peaks import peaks
from inerter.suspension.vehicle.problem import VehicleProblem
from inerter.suspension.vehicle.search import at_bound
from inerter.suspension.vehicle.strut import VehicleStrut
from inerter.suspension.white_road import refuse_infinite


@dataclass(frozen=True)
class VehicleOptimum:
    """The best design.

    Attributes
    ----------
    value
        The index, SI units.
    struts
        Front and rear.
    peaks
        Of J5: (frequency [Hz], gain [m/N]) of every local maximum of the gain, the static one too.
    notes
        Sentences on what a reader should know: a bound was met, the optimum is not unique.
    """

    value: float
    struts: tuple[VehicleStrut, VehicleStrut]
    peaks: tuple[tuple[float, float], ...]
    notes: tuple[str, ...]

    def design(self) -> dict[str, Any]:
        """Its part in a row of the command's JSON."""
        return {
            axle: {
                "stiffness": strut.stiffness,
                **finite(strut.layout_values()),
                **springs_of(strut.stiffness, strut.layout_values()),
            }
            for axle, strut in zip(("front", "rear"), self.struts, strict=True)
        }


def vehicle_optimum(
    index: str,
    car: Vehicle,
    layout: str,
    stiffnesses: tuple[float, float],
    pair: SeriesPair | None = None,
    road: Road | None = None,
    *,
    equal: bool = False,
) -> VehicleOptimum:
    """Damping, inertance and relaxation spring of both axles that minimise an index.

    Parameters
    ----------
    index, car, layout, pair, road
        As in `vehicle_index`; the layout by its name.
    stiffnesses
        k [N/m], front and rear.
    equal
        The same damping, inertance and relaxation spring at both axles.
    """
    problem = VehicleProblem(
        car=car,
        road=road or Road(),
        layout=layout,
        index=index,
        stiffnesses=stiffnesses,
        pair=pair,
        equal=equal,
    )
    return optimise_vehicle(problem)


def optimise_vehicle(problem: VehicleProblem, more: int = 1) -> VehicleOptimum:
    """Minimise an index over all designs of a layout; `more` as in `starting_points`.

    Raises
    ------
    InfiniteIndexError
        No design has a finite value, for tyre damping.
    """
    refuse_infinite(problem)
    if problem.limits or problem.catalogue or not problem.variables:
        return _limited(problem)
    notes = []
    best, value, point = problem, *start_point(problem, more)
    # without inertance counts as a design where the strut still is one
    variants = problem.variants()
    for other in variants[1:]:
        if at_bound(problem, value):
            break
        without, there = start_point(other, more)
        if without <= value * (1.0 + 1e-12):
            best, value, point = other, without, there
    if at_bound(problem, value):
        value = problem.static_compliance()
        best, point = softest_at_bound(variants, best, point)
        notes.append(
            "J5 is what springs and tyres yield under a constant load, which no strut can lower; "
            "of the designs that reach it the one with the smallest J1 is given"
        )
    elif problem.index == "J5" and value <= problem.static_compliance() * (1.0 + NEAR):
        notes.append(
            "J5 comes as near as one likes to what springs and tyres yield under a constant load, "
            "which no strut can lower; a design within 1e-5 of it is given"
        )
    notes += [
        f"best without inertance {where}"
        for where, now, before in zip(
            ("in front", "at the rear"), best.massless, problem.massless, strict=True
        )
        if now and not before
    ]
    for limit in problem.network.limits:
        free = any(limit[0] == name for _, name in problem.variables)
        held = all(limit in own for own in best.fixed)
        notes += [f"best {LIMITS[limit]}"] if free and held else []
    notes += [*_at_bounds(best, point), *scene_notes(best, point)]
    return VehicleOptimum(
        value=value,
        struts=best.struts(point),
        peaks=_peaks(best, point) if problem.index == "J5" else (),
        notes=tuple(notes),
    )


def _limited(problem: VehicleProblem) -> VehicleOptimum:
    from inerter.suspension.limited import best_within

    found = best_within(problem)
    best = replace(found.problem, limits=())
    assert isinstance(best, VehicleProblem)
    notes = [f"held back by the limit of {name}" for name in found.reached]
    return VehicleOptimum(
        value=found.value,
        struts=best.struts(found.point),
        peaks=_peaks(best, found.point) if problem.index == "J5" else (),
        notes=(*notes, *_at_bounds(best, found.point), *scene_notes(best, found.point)),
    )


def _peaks(problem: VehicleProblem, point: Array) -> tuple[tuple[float, float], ...]:
    load, static = problem.load(point), problem.static_compliance()
    frequency, gain = peaks(load)
    # a swelling beside w = 0 that is no more than rounding is the static value
    small = len(gain) > 0 and frequency[0] > 0.0 and gain[0] <= static * (1.0 + 2.0 * NEAR)
    if small and load.gain(0.5 * frequency[:1])[0] >= static:
        frequency[0], gain[0] = 0.0, static
    return tuple((float(w / (2.0 * np.pi)), float(g)) for w, g in zip(frequency, gain, strict=True))


def _at_bounds(problem: VehicleProblem, point: Array) -> list[str]:
    notes = []
    for (axle, name), at, (low, high) in zip(problem.variables, point, problem.bounds, strict=True):
        where = "" if problem.equal else ("front ", "rear ")[axle]
        word = where + name.replace("_", " ")
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
