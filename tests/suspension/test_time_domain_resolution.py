"""How close a road's sinusoids have to be: narrow modes are not lost between two of them."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from inerter.suspension.quarter_car import QuarterCar
from inerter.suspension.time_domain.cases import CASES
from inerter.suspension.time_domain.evaluate import evaluate
from inerter.suspension.time_domain.linear import exact_index, spectrum
from inerter.suspension.time_domain.model import Design
from inerter.suspension.time_domain.plan import Plan
from inerter.suspension.time_domain.resolution import (
    exact_on_road,
    on_sinusoids,
    resolution_of,
)
from inerter.suspension.time_domain.road import PeriodicRoad, iso_road, paper_road
from inerter.suspension.time_domain.simulate import RunSettings
from inerter.suspension.vehicle.cars import half_car

NARROW = Design(120e3, 4500.0, 60.0)
WIDE = Design(120e3, 7544.2, 366.52)
HALF = Design(20e3, 1800.0, 40.0, rear=Design(18e3, 1500.0, 40.0))


def test_a_narrow_mode_asks_for_closer_sinusoids_and_longer_settling() -> None:
    car, road = QuarterCar(), paper_road()
    wide = resolution_of("J1", "S3", WIDE, None, car, road)
    narrow = resolution_of("J1", "S3", NARROW, None, car, road)
    assert wide.refined == 1
    assert narrow.refined > 3
    assert narrow.settle > 5.0 * wide.settle
    asked = ("J1", "S3", NARROW, None, car)
    exact = exact_index(*asked, spectrum(road))
    assert on_sinusoids(*asked, road) < 0.9 * exact
    # the tail of the modes that is left is what resolution_of allows
    assert on_sinusoids(*asked, road.refined(narrow.refined)) == pytest.approx(exact, rel=5e-4)


@pytest.mark.parametrize("index", ["J1", "J3"])
@pytest.mark.parametrize(
    ("car", "layout", "design"),
    [(QuarterCar(), "S2", WIDE), (QuarterCar(), "S3", NARROW), (half_car(), "S3", HALF)],
)
def test_a_road_without_end_has_the_norm(
    car: object, layout: str, design: Design, index: str
) -> None:
    """The integral over the density against Astrom's recursion, or the Lyapunov equation."""
    road = PeriodicRoad("wide", 2.5e-5, band=(0.0, 1e6))
    exact = exact_index(index, layout, design, None, car, spectrum(road))  # type: ignore[arg-type]
    found = exact_on_road(index, layout, design, None, car, road)  # type: ignore[arg-type]
    assert found == pytest.approx(exact, rel=2e-5)


def test_closer_sinusoids_have_the_same_density_and_band() -> None:
    road = iso_road("C", 30.0)
    fine = road.refined(7)
    assert fine.period == pytest.approx(70.0)
    assert fine.limits == road.limits == (0.3, 300.0)
    assert fine.frequencies[[0, -1]] == pytest.approx([0.3, 300.0], abs=0.1 / 7)
    density = 0.5 * fine.amplitudes**2 / fine.spacing
    assert density == pytest.approx(road.strength / fine.frequencies**2)
    values = fine.instants(4, 70_001)
    assert np.sqrt(np.mean(values**2)) == pytest.approx(fine.rms, rel=1e-9)
    with pytest.raises(ValueError, match="give a whole number from 1"):
        road.refined(0)


@pytest.mark.long
def test_the_interval_holds_the_exact_value() -> None:
    """Its lines 0.1 Hz apart gave 6.750 +- 0.003 where 8.129 is exact."""
    plan = Plan(
        layouts=("S3",), indices=("J1",), given=((4500.0, 60.0),), seeds=4,
        one_sided=False, settings=RunSettings(step=2e-3, jobs=1),
    )  # fmt: skip
    (row,) = evaluate(plan)
    assert row.exact == pytest.approx(8.1291, abs=1e-4)
    assert row.exact is not None
    assert row.low <= row.exact <= row.high
    assert row.high - row.low < 0.05
    assert row.road_period is not None
    assert row.road_period > 40.0
    assert "--tyre one-sided has it leave the road" in row.notes[0]


def test_a_settling_that_is_too_short_is_said_and_every_road_has_its_exact_value() -> None:
    plan = Plan(
        layouts=("S2",), cases=(CASES["ideal"], CASES["friction"]), indices=("J1",), seeds=2,
        road=iso_road("B"), keep_settle=True, settings=RunSettings(step=2e-3, settle=1.0, jobs=1),
    )  # fmt: skip
    ideal, friction = evaluate(plan)
    assert ideal.exact == ideal.linear == friction.linear
    assert friction.exact is None
    assert ideal.value == pytest.approx(ideal.exact, rel=5e-3)
    assert "--settle 1: the slowest mode needs" in ideal.notes[0]
    settled = dataclasses.replace(plan, keep_settle=False)
    assert not evaluate(settled)[0].notes


def test_a_tyre_off_the_road_is_said_with_what_it_changes() -> None:
    """Beside the exact value stands what tyres that pull, as there, would give."""
    plan = Plan(
        layouts=("S1",), indices=("J3",), seeds=2, road=iso_road("E"),
        settings=RunSettings(step=2e-3, jobs=1),
    )  # fmt: skip
    (row,) = evaluate(plan)
    assert row.lift_off is not None
    assert row.lift_off > 0.1
    assert row.pulling == pytest.approx(row.exact, rel=2e-3)
    assert row.exact is not None
    assert row.value < 0.9 * row.exact
    assert "a tyre is off the road" in row.notes[0]
