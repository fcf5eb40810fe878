"""The half-car in the time domain against complex equations of motion and the reference."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from inerter.model_parameters import HALF_CAR
from inerter.reference import HalfCar, ReferenceDevice, corner_of
from inerter.suspension.time_domain.cases import CASES
from inerter.suspension.time_domain.linear import exact_index, spectrum
from inerter.suspension.time_domain.load_peaks import load_peaks
from inerter.suspension.time_domain.model import CarModel, Design, compiled
from inerter.suspension.time_domain.road import PeriodicRoad, paper_road
from inerter.suspension.time_domain.simulate import RunSettings, load_gains, road_indices
from inerter.suspension.vehicle.cars import half_car
from time_domain_car import SOFT
from time_domain_half_car import centre_per_load, half_car_indices

SETTINGS = RunSettings(settle=16.0, jobs=2)
LINEAR = [("S1", "ideal"), ("S2", "ideal"), ("S3", "ideal"), ("S2", "elastic"), ("S3", "elastic")]
STRUTS = {
    "S1": ((19960.0, 1290.0, 0.0), (17500.0, 1690.0, 0.0)),
    "S2": ((19960.0, 1290.0, 30.0), (17500.0, 1690.0, 45.0)),
    "S3": ((60e3, 4000.0, 300.0), (50e3, 3000.0, 200.0)),
}


def design_of(layout: str) -> Design:
    front, rear = STRUTS[layout]
    return Design(*front, rear=Design(*rear))


def car_of(layout: str, case: str) -> CarModel:
    return compiled(layout, CASES[case], half_car())


def pair_of(case: str) -> tuple[float, float] | None:
    return SOFT if case == "elastic" else None


def accuracy(layout: str, case: str) -> float:
    """S3 behind a shaft is extrapolated from steps of first order."""
    return 4e-4 if (layout, case) == ("S3", "elastic") else 1e-4


@pytest.mark.parametrize(("layout", "case"), LINEAR)
def test_indices_are_the_sums_over_the_sinusoids(layout: str, case: str) -> None:
    """Also that the rear wheel is on the front's road, later by the wheelbase over the speed."""
    speeds = (25.0, 9.0) if (layout, case) == ("S2", "ideal") else (25.0,)
    for speed in speeds:
        road = dataclasses.replace(paper_road(), speed=speed)
        found = road_indices(car_of(layout, case), [design_of(layout)], road, [1], SETTINGS)
        exact = half_car_indices(road, layout, STRUTS[layout], pair_of(case))
        assert [found["J1"][0, 0], found["J3"][0, 0]] == pytest.approx(
            exact, rel=accuracy(layout, case)
        )


@pytest.mark.rarely("S3-elastic")
@pytest.mark.parametrize(("layout", "case"), LINEAR)
def test_gains_are_the_transfer_function(layout: str, case: str) -> None:
    f = np.array([0.7, 1.3, 2.9, 9.0, 17.3])
    found = load_gains(
        car_of(layout, case), [design_of(layout)], f[None], 2000.0, settings=SETTINGS
    )[0]
    assert found == pytest.approx(
        centre_per_load(f, layout, STRUTS[layout], pair_of(case)), rel=accuracy(layout, case)
    )


@pytest.mark.parametrize(("layout", "case"), LINEAR)
def test_indices_are_those_of_the_linear_study(layout: str, case: str) -> None:
    """The paper's sinusoids end at 1000 Hz, the norms do not: of the tyre force kt zr is left.

    A rigid inertance hands some of that on to the body: 0.06 % here.
    """
    car, design = car_of(layout, case), design_of(layout)
    found = road_indices(car, [design], paper_road(), [3], SETTINGS)
    pair, road = CASES[case].pair, spectrum(paper_road())
    beyond = HALF_CAR.front.tyre_stiffness**2 * paper_road().strength / 1000.0
    for index, left, within in (("J1", 0.0, 1e-3), ("J3", beyond, 5e-4)):
        exact = exact_index(index, layout, design, pair, half_car(), road)
        assert found[index][0, 0] == pytest.approx(np.sqrt(exact**2 - left), rel=within)
    if case == "ideal":
        (peaks,) = load_peaks(car, [design], 2000.0, SETTINGS)
        exact = exact_index("J5", layout, design, pair, half_car(), road)
        # the sweep ends at 30 Hz, begins at 0.5 Hz and knows the load at rest
        assert peaks.value == pytest.approx(exact, rel=2e-4)


def test_static_load_is_shared_by_the_axles() -> None:
    """By hand: the centre of mass of a beam on two springs, each an axle's."""
    car, design = car_of("S1", "ideal"), design_of("S1")
    front, rear = 1.011 / 2.814, 1.803 / 2.814
    by_hand = rear**2 * (1 / 19960 + 1 / 175500) + front**2 * (1 / 17500 + 1 / 175500)
    assert car.static_compliance(design) == pytest.approx(by_hand, rel=1e-12)
    slow = load_gains(car, [design], [[0.02]], 2000.0, settings=RunSettings(jobs=2))[0, 0]
    assert slow == pytest.approx(by_hand, rel=1e-3)


@pytest.mark.rarely("S2-friction100")
@pytest.mark.parametrize(("layout", "case"), [("S2", "friction100"), ("S3", "dahl")])
def test_road_indices_are_those_of_the_reference(layout: str, case: str) -> None:
    """A road that ends at 6 Hz, which an adaptive solver drives over in seconds."""
    road = PeriodicRoad("slow", paper_road().strength, 3, 60)
    settings = RunSettings(settle=1.0, jobs=2)
    found = road_indices(car_of(layout, case), [design_of(layout)], road, [7], settings)
    corners = {}
    for axle, (k, c, b) in zip(("front", "rear"), STRUTS[layout], strict=True):
        device = ReferenceDevice(
            inertance=b,
            friction=CASES[case].friction,
            **CASES[case].parameters,  # type: ignore[arg-type]
        )
        corner = corner_of(getattr(HALF_CAR, axle), layout, device)
        strut = dataclasses.replace(corner.strut, stiffness=k, damping=c)
        corners[axle] = dataclasses.replace(corner, strut=strut)
    omega = 2 * np.pi * road.frequencies
    lag = 2.814 / road.speed

    def height(t: float, behind: float) -> float:
        fade = 0.5 * (1 - np.cos(np.pi * min(t, 1.0)))
        angles = omega * (t - 1.0 - behind) + road.phases(7)
        return fade * float(road.amplitudes @ np.sin(angles))

    times = np.arange(0.0, 11.0, 2e-3)
    run = HalfCar(**corners).simulate(
        [lambda t: height(t, 0.0), lambda t: height(t, lag)],
        times, rtol=1e-5, atol=1e-8, max_step=0.02,
    )  # fmt: skip
    late = times >= 1.0 - 1e-9
    pitch = run.pitch_acceleration[late]
    above = [run.heave_acceleration[late] + x * pitch for x in (-1.011, 1.803)]
    j1 = np.sqrt(np.mean(np.square(above)))
    j3 = np.sqrt(np.mean(run.tyre_force[late] ** 2))
    assert [found["J1"][0, 0], found["J3"][0, 0]] == pytest.approx([j1, j3], rel=1e-3)


def test_struts_have_their_own_values() -> None:
    """Front and rear exchanged is another car; a design without a rear strut is none."""
    car, road = car_of("S2", "friction"), paper_road()
    front, rear = STRUTS["S2"]
    swapped = Design(*rear, rear=Design(*front))
    found = road_indices(car, [design_of("S2"), swapped], road, [1], SETTINGS)["J1"]
    assert abs(found[0, 0] / found[1, 0] - 1.0) > 0.01
    with pytest.raises(ValueError, match="the design has 1 struts, the car 2"):
        road_indices(car, [Design(*front)], road, [1], SETTINGS)
