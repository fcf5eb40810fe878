"""Are the vehicles' optima ones: against quarter-cars, neighbours, many more starts, bounds."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from inerter.suspension.layouts import SOFT, SeriesPair
from inerter.suspension.optimum import optimise
from inerter.suspension.problem import SuspensionProblem
from inerter.suspension.quarter_car import Road
from inerter.suspension.vehicle import (
    VehicleOptimum,
    full_car,
    half_car,
    vehicle_index,
    vehicle_optimum,
)
from inerter.suspension.vehicle.optimum import optimise_vehicle
from inerter.suspension.vehicle.problem import VehicleProblem

ROAD = Road()
HALF = half_car()
COUPLED = replace(HALF, pitch_inertia=0.5 * HALF.pitch_inertia)
SOFTER = (19960.0, 17500.0)
STIFFER = (6.0 * 19960.0, 6.0 * 17500.0)


@cache
def solved(
    layout: str, index: str, stiffnesses: tuple[float, float], pair: SeriesPair | None = None
) -> VehicleOptimum:
    return vehicle_optimum(index, HALF, layout, stiffnesses, pair, ROAD)


@pytest.mark.parametrize("layout", ["S1", "S2", "S3", "S6"])
@pytest.mark.parametrize("index", ["J1", "J3"])
def test_a_dynamic_index_of_1_has_the_optima_of_its_quarter_cars(index: str, layout: str) -> None:
    inertia = HALF.body_mass * HALF.front.distance * HALF.rear.distance
    car = replace(HALF, pitch_inertia=inertia)
    quarters = [
        optimise(
            SuspensionProblem(
                car=corner,
                road=ROAD,
                layout=layout,
                index=index,
                stiffness=k,
                pair=SOFT if layout != "S1" else None,
            )
        )
        for corner, k in zip(car.corners(), STIFFER, strict=True)
    ]
    found = vehicle_optimum(index, car, layout, STIFFER, SOFT if layout != "S1" else None, ROAD)
    mean = np.sqrt(np.mean([quarter.value**2 for quarter in quarters]))
    assert found.value == pytest.approx(mean, rel=1e-9)
    for strut, quarter in zip(found.struts, quarters, strict=True):
        assert strut.damping == pytest.approx(quarter.damping, rel=1e-4)


@pytest.mark.parametrize(
    ("layout", "index", "stiffnesses", "pair"),
    [
        ("S1", "J1", SOFTER, None), ("S2", "J1", STIFFER, SOFT), ("S3", "J3", STIFFER, None),
        ("S6", "J1", SOFTER, None), ("S1", "J5", STIFFER, None), ("S3", "J5", STIFFER, None),
    ],
)  # fmt: skip
def test_no_other_design_is_better(
    layout: str, index: str, stiffnesses: tuple[float, float], pair: SeriesPair | None
) -> None:
    found = solved(layout, index, stiffnesses, pair)
    problem = VehicleProblem(
        car=HALF, road=ROAD, layout=layout, index=index, stiffnesses=stiffnesses, pair=pair
    )
    point, (low, high) = problem.point(found.struts), problem.bounds.T
    # the design that is given has the value that is given
    exact = vehicle_index(index, HALF, layout, found.struts, pair, ROAD)
    assert exact == pytest.approx(found.value, rel=2e-9)
    draw = np.random.default_rng(7)
    close = [
        np.clip(point + size * draw.standard_normal((25, len(point))), low, high)
        for size in (1e-3, 1e-2, 0.3)
    ]
    values = problem.value(np.vstack([*close, draw.uniform(low, high, (50, len(low)))]))
    assert values.min() >= found.value * (1.0 - 1e-9)


def test_peaks_of_j5_are_equal() -> None:
    # as many equal peaks as there are variables and the level
    gains = [gain for _, gain in solved("S3", "J5", STIFFER).peaks]
    assert sum(gain > max(gains) * (1.0 - 1e-7) for gain in gains) == 4


@pytest.mark.long
@pytest.mark.parametrize(("layout", "index"), [("S2", "J1"), ("S3", "J3"), ("S1", "J5")])
def test_ten_times_as_many_starts_find_nothing_better(layout: str, index: str) -> None:
    for car in (HALF, COUPLED):
        problem = VehicleProblem(
            car=car, road=ROAD, layout=layout, index=index, stiffnesses=STIFFER
        )
        few, many = optimise_vehicle(problem), optimise_vehicle(problem, 10)
        assert few.value <= many.value * (1.0 + 1e-6)


def test_at_the_bound_of_j5_the_most_comfortable_is_given() -> None:
    found = solved("S1", "J5", SOFTER)
    assert any("smallest J1" in note for note in found.notes)
    assert found.value == HALF.static_compliance(SOFTER)
    load = VehicleProblem(car=HALF, road=ROAD, layout="S1", index="J5", stiffnesses=SOFTER)
    ride = replace(load, index="J1")
    point = load.point(found.struts)
    draw = np.random.default_rng(2)
    around = point + np.concatenate([s * draw.standard_normal((150, 2)) for s in (0.02, 0.5)])
    allowed = around[load.value(around) <= found.value * (1.0 + 1e-9)]
    assert len(allowed) > 20
    assert ride.value(allowed).min() >= ride.value(point[None])[0] * (1.0 - 1e-6)


def test_near_the_bound_of_j5() -> None:
    # without a damper of its own S3 is a spring and damper only behind a rigid inertance
    found = solved("S3", "J5", SOFTER)
    static = HALF.static_compliance(SOFTER)
    assert static * (1.0 + 1e-9) < found.value <= static * (1.0 + 1.1e-5)
    assert any("as near as one likes" in note for note in found.notes)


def test_equal_struts_are_equal_and_not_better() -> None:
    for index in ("J1", "J3"):
        found = vehicle_optimum(index, HALF, "S3", STIFFER, None, ROAD, equal=True)
        front, rear = found.struts
        assert (front.damping, front.inertance) == (rear.damping, rear.inertance)
        assert front.stiffness != rear.stiffness
        assert found.value > solved("S3", index, STIFFER).value


def test_in_tyre_load_inertance_of_s2_may_vanish() -> None:
    found = solved("S2", "J3", SOFTER)
    assert [strut.inertance for strut in found.struts] == [0.0, 0.0]
    assert found.value == pytest.approx(solved("S1", "J3", SOFTER).value, rel=1e-10)


def test_a_full_car_lies_between_its_tracks() -> None:
    # the mean over a correlation is the mean of the squares: the best for one is not for another
    values = [
        vehicle_optimum("J1", full_car(rho), "S1", SOFTER, None, ROAD).value
        for rho in (0.0, 0.5, 1.0)
    ]
    assert values[2] == pytest.approx(solved("S1", "J1", SOFTER).value, rel=1e-10)
    # the least of a sum is concave in its shares
    assert values[1] ** 2 >= 0.5 * (values[0] ** 2 + values[2] ** 2) * (1.0 - 1e-12)


def test_the_answer_is_the_same_each_time() -> None:
    for index in ("J1", "J5"):
        problem = VehicleProblem(car=HALF, road=ROAD, layout="S1", index=index, stiffnesses=STIFFER)
        assert optimise_vehicle(problem) == optimise_vehicle(problem)
