"""The search for c and b finds optima that are known exactly, starting from wrong ones."""

from __future__ import annotations

import dataclasses

import pytest
from inerter.suspension.time_domain.cases import CASES
from inerter.suspension.time_domain.linear import exact_index, linear_optimum, spectrum
from inerter.suspension.time_domain.load_peaks import load_peaks
from inerter.suspension.time_domain.model import Design, compiled
from inerter.suspension.time_domain.plan import Plan
from inerter.suspension.time_domain.search import reoptimised
from inerter.suspension.time_domain.simulate import RunSettings
from inerter.suspension.vehicle.cars import half_car

QUICK = RunSettings(step=2e-3, jobs=2)


@pytest.mark.parametrize(("index", "within"), [("J1", 1e-5), ("J5", 1e-4)])
def test_an_elastic_shaft_is_found_from_the_ideal_inerter(index: str, within: float) -> None:
    """Start and correction know the ideal inerter alone; the shaft is only in the simulations.

    J5's optimum is a corner of two equal peaks, and the start lies 18 % above it.
    """
    plan = Plan(search_seeds=1, settings=QUICK)
    road, pair = spectrum(plan.road), CASES["elastic"].pair
    start = linear_optimum(index, "S2", 120e3, None, plan.car, road)
    best = linear_optimum(index, "S2", 120e3, pair, plan.car, road)
    model = compiled("S2", CASES["elastic"])
    found = reoptimised(plan, model, index, start, pair=None, like_case=False)

    def exact(design: Design) -> float:
        return exact_index(index, "S2", design, pair, plan.car, road)

    assert exact(start) > exact(best) * (1.0 + 4e-3)
    assert exact(found) < exact(best) * (1.0 + within)


def test_a_half_cars_struts_are_found_from_the_ideal_inerter() -> None:
    """Four variables at once."""
    car = half_car()
    settings = RunSettings(step=2e-3, settle=6.0, jobs=2)
    plan = Plan(car=car, stiffnesses=(80e3,), search_seeds=1, settings=settings)
    road, pair = spectrum(plan.road), CASES["elastic"].pair
    start = linear_optimum("J1", "S2", 80e3, None, car, road)
    best = linear_optimum("J1", "S2", 80e3, pair, car, road)
    model = compiled("S2", CASES["elastic"], car)
    found = reoptimised(plan, model, "J1", start, pair=None, like_case=False)
    above = [
        exact_index("J1", "S2", design, pair, car, road)
        / exact_index("J1", "S2", best, pair, car, road)
        - 1.0
        for design in (start, found)
    ]
    assert above[0] > 1e-3
    assert above[1] < 1e-4


@pytest.mark.long
def test_the_corner_of_a_nonlinear_case() -> None:
    """No neighbour is better, and both peaks are equal, as in the linear optimum."""
    plan = Plan(settings=QUICK)
    case = CASES["friction100"]
    start = linear_optimum("J5", "S2", 120e3, None, plan.car, spectrum(plan.road))
    model = compiled("S2", case)
    best = reoptimised(plan, model, "J5", start)
    near = [
        dataclasses.replace(best, damping=best.damping * c, inertance=best.inertance * b)
        for c, b in ((1.0, 1.0), (0.98, 1.0), (1.02, 1.0), (1.0, 0.98), (1.0, 1.02))
    ]
    found = load_peaks(model, [start, *near], plan.amplitude, QUICK)
    values = [each.value for each in found]
    assert values[1] < values[0] * 0.99
    assert all(value > values[1] for value in values[2:])
    gains = sorted(gain for _, gain in found[1].peaks)
    assert gains[-1] / gains[-2] == pytest.approx(1.0, abs=2e-4)
