"""Half- and full-car indices against quarter-cars, quadrature, limits and a second formulation."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from inerter.suspension.indices import INDICES
from inerter.suspension.layouts import HARD, LAYOUTS, SOFT, SeriesPair
from inerter.suspension.quarter_car import QuarterCar, Road
from inerter.suspension.vehicle import (
    FullCar,
    HalfCar,
    VehicleStrut,
    full_car,
    half_car,
    vehicle_index,
)
from inerter.suspension.vehicle.indices import quick_rms_index
from inerter.suspension.vehicle.problem import VehicleProblem
from vehicle_oracle import responses, rms

ROAD = Road()
HALF = half_car()
# pitching far from two quarter-cars
COUPLED = replace(HALF, pitch_inertia=0.5 * HALF.pitch_inertia)


def both(c: float, b: float, kb: float) -> tuple[VehicleStrut, VehicleStrut]:
    return VehicleStrut(19960.0, c, b, kb), VehicleStrut(25000.0, 0.8 * c, 0.7 * b, 0.9 * kb)


# damped well enough that a quadrature sees every peak
STRUTS = {
    "S1": both(2000.0, 0.0, 1.0),
    "S2": both(2000.0, 80.0, 1.0),
    "S3": both(2000.0, 500.0, 1.0),
    "S4": both(2300.0, 18.0, 2e5),
    "S5": both(2700.0, 600.0, 3e5),
    "S6": both(550.0, 150.0, 5e3),
}
PAIRS = (None, SOFT)


def free(car: HalfCar) -> HalfCar:
    """The car whose dynamic index is 1: two quarter-cars."""
    return replace(car, pitch_inertia=car.body_mass * car.front.distance * car.rear.distance)


def draw_struts(draw: np.random.Generator) -> tuple[VehicleStrut, VehicleStrut]:
    found = []
    for _ in range(2):
        c, b, kb = 10.0 ** draw.uniform([2.7, 0.5, 4.0], [4.5, 3.0, 6.0])
        found.append(VehicleStrut(10.0 ** draw.uniform(4.0, 5.5), c, b, kb))
    return found[0], found[1]


def quarter(
    index: str,
    car: QuarterCar,
    layout: str,
    strut: VehicleStrut,
    pair: SeriesPair | None,
    road: Road,
) -> float:
    kb = strut.relaxation_stiffness or 1.0
    network = LAYOUTS[layout].stiffness(
        strut.stiffness, strut.damping, strut.inertance, kb, pair=pair
    )
    return float(INDICES[index].evaluate(car, road, network))


@pytest.mark.parametrize("velocity", [0.5, 25.0, 1e4])
@pytest.mark.parametrize("layout", STRUTS)
def test_a_dynamic_index_of_1_is_two_quarter_cars(layout: str, velocity: float) -> None:
    draw, car, road = np.random.default_rng(3), free(HALF), Road(velocity=velocity)
    for pair in (None, SOFT, HARD):
        struts = draw_struts(draw)
        for index in ("J1", "J3"):
            both = [
                quarter(index, corner, layout, strut, pair, road)
                for corner, strut in zip(car.corners(), struts, strict=True)
            ]
            found = vehicle_index(index, car, layout, struts, pair, road)
            # a light damping takes digits from every covariance
            assert found == pytest.approx(np.sqrt(np.mean(np.square(both))), rel=1e-9 if
                                          layout == "S6" else 1e-10)  # fmt: skip


@pytest.mark.parametrize("pair", PAIRS)
@pytest.mark.parametrize("layout", STRUTS)
@pytest.mark.parametrize("index", ["J1", "J3"])
def test_a_coupled_car_is_the_integral_over_frequency(
    index: str, layout: str, pair: SeriesPair | None
) -> None:
    delay = COUPLED.wheelbase / ROAD.velocity
    exact = ROAD.slope * rms(index, COUPLED, layout, STRUTS[layout], pair, delay=delay)
    found = vehicle_index(index, COUPLED, layout, STRUTS[layout], pair, ROAD)
    assert found == pytest.approx(exact, rel=1e-7)
    # and the delay counts
    together = ROAD.slope * rms(index, COUPLED, layout, STRUTS[layout], pair, delay=0.0)
    assert abs(found / together - 1.0) > 1e-3


@pytest.mark.parametrize("correlation", [0.0, 0.5, 0.9])
@pytest.mark.parametrize(
    ("layout", "pair"), [("S1", None), ("S2", SOFT), ("S3", None), ("S5", SOFT)]
)
@pytest.mark.parametrize("index", ["J1", "J3"])
def test_a_full_car_is_the_integral_over_frequency(
    index: str, layout: str, pair: SeriesPair | None, correlation: float
) -> None:
    car = full_car(correlation)
    delay = car.wheelbase / ROAD.velocity
    exact = rms(index, car, layout, STRUTS[layout], pair, delay=delay, correlation=correlation)
    found = vehicle_index(index, car, layout, STRUTS[layout], pair, ROAD)
    assert found == pytest.approx(ROAD.slope * exact, rel=1e-7)


def test_equal_tracks_are_the_half_car() -> None:
    for index in ("J1", "J3"):
        half = vehicle_index(index, HALF, "S3", STRUTS["S3"], SOFT, ROAD)
        assert vehicle_index(index, full_car(1.0), "S3", STRUTS["S3"], SOFT, ROAD) == half
    # the load of a full car is carried by two sides
    half = vehicle_index("J5", HALF, "S3", STRUTS["S3"], SOFT)
    assert vehicle_index("J5", full_car(0.3), "S3", STRUTS["S3"], SOFT) == pytest.approx(0.5 * half)


@pytest.mark.parametrize("index", ["J1", "J3"])
def test_no_delay_and_a_long_one(index: str) -> None:
    found = [
        vehicle_index(index, COUPLED, "S3", STRUTS["S3"], None, road) / road.slope
        for road in (Road(velocity=1e9), Road(velocity=1e-3))
    ]
    # after a long time the rear's road is one that knows nothing of the front's
    exact = [rms(index, COUPLED, "S3", STRUTS["S3"], None, delay=delay) for delay in (0.0, None)]
    assert found == pytest.approx(exact, rel=1e-7)
    assert abs(exact[0] / exact[1] - 1.0) > 1e-3


@pytest.mark.rarely("car1")
@pytest.mark.parametrize("car", [COUPLED, full_car()])
def test_j5_is_reached_and_never_exceeded(car: HalfCar | FullCar) -> None:
    dense = np.geomspace(1e-3, 1e4, 200_000)
    for layout in STRUTS:
        for pair in PAIRS:
            found = vehicle_index("J5", car, layout, STRUTS[layout], pair)
            gain = np.abs(responses(car, layout, STRUTS[layout], pair, dense)[2])
            assert gain.max() <= found * (1.0 + 1e-10)
            assert gain.max() == pytest.approx(found, rel=1e-5)


def test_j5_of_a_needle() -> None:
    # an almost undamped strut: the peak is too narrow for any grid
    struts = (VehicleStrut(19960.0, 1e-2), VehicleStrut(17500.0, 1e-2))
    found = vehicle_index("J5", HALF, "S1", struts)
    # half the damping, twice the peak
    less = (VehicleStrut(19960.0, 5e-3), VehicleStrut(17500.0, 5e-3))
    assert vehicle_index("J5", HALF, "S1", less) == pytest.approx(2.0 * found, rel=1e-4)
    assert found > 1e3 * HALF.static_compliance((19960.0, 17500.0))


def test_static_compliance_by_hand() -> None:
    # a load in the middle of equal axles: half of it bends each, and the middle moves as they do
    axle = replace(HALF.front, distance=1.2)
    car = replace(HALF, front=axle, rear=axle)
    k, kt = 20e3, axle.tyre_stiffness
    assert car.static_compliance((k, k)) == pytest.approx(0.5 * (1.0 / k + 1.0 / kt))
    rest = responses(HALF, "S3", STRUTS["S3"], None, np.array([1e-9]))[2]
    stiffnesses = STRUTS["S3"][0].stiffness, STRUTS["S3"][1].stiffness
    assert HALF.static_compliance(stiffnesses) == pytest.approx(abs(rest[0]), rel=1e-9)


@pytest.mark.parametrize("car", [COUPLED, full_car(0.2)])
@pytest.mark.parametrize("layout", ["S1", "S3", "S4", "S6"])
def test_gradients_are_difference_quotients(car: HalfCar | FullCar, layout: str) -> None:
    step = 1e-5
    for equal in (False, True):
        for index in ("J1", "J3"):
            problem = VehicleProblem(
                car=car,
                road=ROAD,
                layout=layout,
                index=index,
                stiffnesses=(19960.0, 17500.0),
                pair=SOFT,
                equal=equal,
            )
            point = problem.point(STRUTS[layout])
            _, slope = problem.logarithm(point)
            moves = np.eye(len(point)) * step
            up, down = problem.value(point + moves), problem.value(point - moves)
            assert slope == pytest.approx((np.log(up) - np.log(down)) / (2.0 * step), abs=3e-6)
        problem = VehicleProblem(
            car=car,
            road=ROAD,
            layout=layout,
            index="J5",
            stiffnesses=(19960.0, 17500.0),
            pair=SOFT,
            equal=equal,
        )
        frequency = np.array([0.0, 3.0, 8.0, 70.0])
        _, slopes = problem.levels(point, frequency)
        quotients = [
            (np.log(problem.load(point + move).gain(frequency))
             - np.log(problem.load(point - move).gain(frequency))) / (2.0 * step)
            for move in moves
        ]  # fmt: skip
        assert slopes == pytest.approx(np.array(quotients).T, abs=1e-7)


def test_the_quick_route_agrees() -> None:
    for car in (COUPLED, full_car()):
        for layout in STRUTS:
            for index in ("J1", "J3"):
                problem = VehicleProblem(
                    car=car,
                    road=ROAD,
                    layout=layout,
                    index=index,
                    stiffnesses=(19960.0, 17500.0),
                    pair=SOFT,
                )
                point = problem.point(STRUTS[layout])
                several = problem.branches(np.array([point, point]))
                quick = quick_rms_index(index, car, ROAD, several)
                assert quick == pytest.approx(problem.value(point[None])[0], rel=1e-6)


def test_an_undamped_car_has_no_index() -> None:
    struts = (VehicleStrut(19960.0, 0.0), VehicleStrut(17500.0, 0.0))
    assert vehicle_index("J1", HALF, "S1", struts) == np.inf


@pytest.mark.parametrize(
    ("call", "told"),
    [
        (lambda: vehicle_index("J2", HALF, "S1", STRUTS["S1"]), "J1, J3, J5"),
        (lambda: vehicle_index("J1", HALF, "S9", STRUTS["S1"]), "S1, S2"),
        (lambda: full_car(1.5), "from 0 to 1"),
        (lambda: replace(HALF, body_mass=-1.0), "body_mass is -1"),
        (lambda: replace(HALF.front, distance=0.0), "distance is 0"),
    ],
)
def test_what_cannot_be_is_refused(call: object, told: str) -> None:
    assert callable(call)
    with pytest.raises(ValueError, match=told):
        call()
