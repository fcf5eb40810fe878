"""Half-car and full car: linear limits, symmetry, reductions to smaller models, energy."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from inerter.reference import (
    FULL_CAR,
    HALF_CAR,
    Corner,
    FullCar,
    HalfCar,
    QuarterCar,
    ReferenceDevice,
    Strut,
    corner_of,
)
from inerter.reference.structure import joint_branch_forces
from scipy.linalg import expm

ROUGH = ReferenceDevice(
    inertance=60.0, friction="lugre", coulomb_force=40.0, static_force=60.0,
    bristle_stiffness=2e4, load_friction=0.2, transition_velocity=1e-2, inertance_gradient=3.0,
    stop_upper=0.02, stop_stiffness=1e5,
)  # fmt: skip
LOOSE = ReferenceDevice(
    inertance=60.0, series_stiffness=2e5, series_damping=400.0, backlash=3e-4, viscous=100.0
)


def front_road(t: float) -> float:
    return 0.02 * float(np.sin(9.0 * t) * np.sin(2.3 * t))


def rear_road(t: float) -> float:
    return front_road(max(0.0, t - 0.1))


def quadratic_form(rows: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Hessian of sum weight_i (row_i q)^2 / 2."""
    return rows.T @ np.diag(weights) @ rows


def test_full_car_is_the_matrix_exponential() -> None:
    car, p = FullCar(), FULL_CAR
    x = np.array([1.011, 1.011, -1.803, -1.803])
    y = np.array([0.755, -0.755, 0.755, -0.755])
    # elongations of struts and tyres per (z, theta, phi, wheels): energies give the matrices
    strut = np.column_stack((np.ones(4), -x, y, -np.eye(4)))
    tyre = np.column_stack((np.zeros((4, 3)), np.eye(4)))
    wheel = [p.front.wheel_mass] * 2 + [p.rear.wheel_mass] * 2
    mass = np.diag([p.body_mass, p.pitch_inertia, p.roll_inertia, *wheel])
    mass = mass + quadratic_form(strut, np.full(4, 30.0))
    springs = np.array([19960.0, 19960.0, 17500.0, 17500.0])
    stiffness = quadratic_form(strut, springs) + quadratic_form(tyre, np.full(4, 175500.0))
    damping = quadratic_form(strut, np.array([1290.0, 1290.0, 1690.0, 1690.0]))
    inverse = np.linalg.inv(mass)
    matrix = np.block([[np.zeros((7, 7)), np.eye(7)], [-inverse @ stiffness, -inverse @ damping]])

    start = np.zeros(14)
    start[[0, 2, 3]], start[[8, 13]] = (0.01, 0.02, -0.005), (0.1, 0.3)
    times = np.linspace(0.0, 0.6, 4)
    run = car.simulate([lambda t: 0.0] * 4, times, initial=start, method="DOP853")
    exact = np.array([expm(matrix * t) @ start for t in times])
    np.testing.assert_allclose(run.heave, exact[:, 0], atol=1e-9)
    np.testing.assert_allclose(run.pitch, exact[:, 1], atol=1e-9)
    np.testing.assert_allclose(run.roll, exact[:, 2], atol=1e-9)
    np.testing.assert_allclose(run.wheel_displacement, exact[:, 3:7], atol=1e-9)


def test_signs_by_hand() -> None:
    # a bump under the front lifts the nose: pitch is negative; one on the left: roll is positive
    car = FullCar()
    one, zero = (lambda t: 1e-3), (lambda t: 0.0)
    nose = car.simulate([one, one, zero, zero], [0.0, 0.1])
    assert nose.heave[-1] > 0.0 > nose.pitch[-1]
    assert abs(nose.roll[-1]) < 1e-12
    left = car.simulate([one, zero, one, zero], [0.0, 0.1])
    assert left.roll[-1] > 0.0
    load = HalfCar().simulate(
        [zero, zero], [0.0, 20.0], body_load=lambda t: (0.0, 100.0), method="LSODA"
    )
    compliance = [1 / 19960 + 1 / 175500, 1 / 17500 + 1 / 175500]
    # moment 100 N m nose down: the axle forces are -+ M / L, the ends move by force * compliance
    wheelbase = 1.011 + 1.803
    front, rear = -100.0 / wheelbase * compliance[0], 100.0 / wheelbase * compliance[1]
    assert load.pitch[-1] == pytest.approx((rear - front) / wheelbase, rel=1e-5)


@pytest.mark.parametrize("layout", ["S1", "S2", "S3"])
def test_symmetric_half_car_does_not_pitch(layout: str) -> None:
    corner = corner_of(HALF_CAR.front, layout, ROUGH)
    car = HalfCar(front=corner, rear=corner)
    run = car.simulate([front_road] * 2, np.linspace(0.0, 0.4, 41), rtol=1e-7, atol=1e-10)
    assert np.max(abs(run.heave)) > 1e-3
    np.testing.assert_allclose(run.pitch, 0.0, atol=1e-12)
    tilted = HalfCar(front=corner, rear=replace(corner, distance=1.2))
    other = tilted.simulate([front_road] * 2, [0.0, 0.2, 0.4], rtol=1e-6, atol=1e-9)
    assert np.max(abs(other.pitch)) > 1e-5


@pytest.mark.often("S3-S1")
@pytest.mark.parametrize(("front", "rear"), [("S2", "S2"), ("S3", "S1")])
def test_decoupled_half_car_is_two_quarter_cars(front: str, rear: str) -> None:
    l_f, l_r, mass = 1.1, 1.6, 700.0
    corners = [
        replace(corner_of(HALF_CAR.front, front, ROUGH), distance=l_f),
        replace(corner_of(HALF_CAR.rear, rear, ROUGH), distance=l_r),
    ]
    car = HalfCar(body_mass=mass, pitch_inertia=mass * l_f * l_r, front=corners[0], rear=corners[1])
    times = np.linspace(0.0, 0.4, 41)
    options: dict[str, Any] = {"rtol": 1e-8, "atol": 1e-11}
    run = car.simulate([front_road, rear_road], times, **options)
    ends = (run.heave - l_f * run.pitch, run.heave + l_r * run.pitch)
    shares = (mass * l_r / (l_f + l_r), mass * l_f / (l_f + l_r))
    for i, road in enumerate((front_road, rear_road)):
        quarter = QuarterCar(
            layout=corners[i].strut.layout, stiffness=corners[i].strut.stiffness,
            damping=corners[i].strut.damping, device=ROUGH, sprung_mass=shares[i],
            unsprung_mass=corners[i].wheel_mass, tyre_stiffness=corners[i].tyre_stiffness,
        )  # fmt: skip
        alone = quarter.simulate(road, times, **options)
        np.testing.assert_allclose(ends[i], alone.body_displacement, atol=2e-8)
        np.testing.assert_allclose(run.device_force[:, i], alone.device_force, atol=0.05)


@pytest.mark.long
def test_full_car_on_equal_tracks_is_the_half_car() -> None:
    front = corner_of(FULL_CAR.front, "S2", LOOSE)
    rear = corner_of(FULL_CAR.rear, "S3", ROUGH)
    times = np.linspace(0.0, 0.3, 31)
    options: dict[str, Any] = {"rtol": 1e-7, "atol": 1e-10}
    half = HalfCar(front=front, rear=rear).simulate([front_road, rear_road], times, **options)
    full = FullCar(front_left=front, front_right=front, rear_left=rear, rear_right=rear).simulate(
        [front_road, front_road, rear_road, rear_road], times, **options
    )
    np.testing.assert_allclose(full.roll, 0.0, atol=1e-10)
    np.testing.assert_allclose(full.heave, half.heave, atol=1e-7)
    np.testing.assert_allclose(full.pitch, half.pitch, atol=1e-7)
    np.testing.assert_allclose(full.strut_force[:, [0, 2]], half.strut_force, atol=0.5)
    assert np.ptp(full.device_states[1][:, 2]) == pytest.approx(6e-4, rel=0.2)


@pytest.mark.long
def test_energy_of_a_half_car() -> None:
    car = HalfCar(
        front=corner_of(HALF_CAR.front, "S2", LOOSE), rear=corner_of(HALF_CAR.rear, "S2", ROUGH)
    )
    start = np.zeros(car.nstate)
    start[[4, 5, 6]] = 0.3, 0.2, -0.4
    times = np.linspace(0.0, 0.4, 2001)
    run = car.simulate([lambda t: 0.0] * 2, times, initial=start, rtol=1e-7, atol=1e-10)
    x, v = run.device_displacement, run.device_velocity
    rows = np.array([[1.0, -1.011], [1.0, 1.803]])
    a = np.column_stack((run.heave_acceleration, run.pitch_acceleration)) @ rows.T
    a = a - run.wheel_acceleration
    energy = 0.5 * (730.0 * run.heave_velocity**2 + 1230.0 * run.pitch_velocity**2)
    energy = energy + 0.5 * 175500.0 * np.sum(run.wheel_displacement**2, axis=1)
    energy = energy + 0.5 * run.wheel_velocity**2 @ [40.0, 35.5] + 0.5 * x**2 @ [19960.0, 17500.0]
    heat = v**2 @ [1290.0, 1690.0]
    for i, device in enumerate((LOOSE, ROUGH)):
        z = device.state_argument(run.device_states[i])
        energy = energy + np.asarray(device.stored_energy(x[:, i], v[:, i], z))
        heat = heat + np.asarray(device.dissipated_power(x[:, i], v[:, i], a[:, i], z))
    lost = np.concatenate(([0.0], np.cumsum(0.5 * (heat[1:] + heat[:-1]) * np.diff(times))))
    assert lost[-1] > 0.3 * energy[0]
    np.testing.assert_allclose(energy + lost, energy[0], rtol=3e-4)


def test_branch_forces_solve_their_equations_jointly() -> None:
    draw = np.random.default_rng(4)
    for _ in range(200):
        n = int(draw.integers(1, 5))
        mass = draw.uniform(0.0, 300.0, n) * (draw.random(n) > 0.2)
        rest, free = draw.normal(0.0, 50.0, n), draw.normal(0.0, 3.0, n)
        share = draw.uniform(-0.95, 0.95, n) * (draw.random(n) > 0.2)
        half = draw.normal(0.0, 0.1, (n, n + 1))
        mobility = half @ half.T
        force = joint_branch_forces(mass, rest, share, free, mobility)
        carried = mass * (free - mobility @ force) + rest
        np.testing.assert_allclose(force, carried + share * abs(carried), atol=1e-9)
        # another share where the flywheel drives: N < 0 for one direction of motion
        both = np.sign(share) * draw.uniform(0.0, 0.95, (2, n))
        force = joint_branch_forces(mass, rest, both, free, mobility)
        carried = mass * (free - mobility @ force) + rest
        felt = np.where(carried < 0.0, both[1], both[0])
        np.testing.assert_allclose(force, carried + felt * abs(carried), atol=1e-9)


def s3_pair(device: ReferenceDevice) -> tuple[QuarterCar, QuarterCar]:
    """Layout S3, and S2 whose device has the damper as its series element."""
    layout = QuarterCar(layout="S3", stiffness=3e4, damping=1500.0, device=device)
    inside = replace(device, series_damping=1500.0)
    return layout, QuarterCar(layout="S2", stiffness=3e4, damping=0.0, device=inside)


def test_layout_s3_is_a_device_with_series_damping() -> None:
    one, other = s3_pair(ReferenceDevice(inertance=113.0, flywheel_viscous=20.0))
    times = np.linspace(0.0, 0.6, 31)
    first = one.simulate(front_road, times, rtol=1e-8)
    second = other.simulate(front_road, times, rtol=1e-8)
    np.testing.assert_allclose(first.body_displacement, second.body_displacement, atol=1e-9)
    np.testing.assert_allclose(first.device_force, second.device_force, atol=1e-4)
    # s = x - y
    y = second.suspension_travel - second.device_states[:, 0]
    np.testing.assert_allclose(first.device_displacement, y, atol=1e-9)


def test_s3_with_a_stiff_shaft_is_s3_without() -> None:
    # the device's own series element makes its velocity algebraic
    soft = ReferenceDevice(inertance=113.0, series_stiffness=1e7, series_damping=2e4)
    rigid = ReferenceDevice(inertance=113.0)
    times = np.linspace(0.0, 0.3, 16)
    runs = [
        QuarterCar(layout="S3", stiffness=3e4, damping=1500.0, device=device).simulate(
            front_road, times, rtol=1e-6, atol=1e-9
        )
        for device in (soft, rigid)
    ]
    size = np.max(abs(runs[1].device_force))
    np.testing.assert_allclose(runs[0].device_force, runs[1].device_force, atol=0.01 * size)
    balance = 1500.0 * (runs[0].body_velocity - runs[0].wheel_velocity - runs[0].device_velocity)
    np.testing.assert_allclose(runs[0].device_force, balance, atol=1e-8)


def test_errors() -> None:
    with pytest.raises(ValueError, match="roads: 1"):
        HalfCar().simulate([front_road], [0.0, 1.0])
    with pytest.raises(ValueError, match="pitch_inertia"):
        HalfCar(pitch_inertia=0.0)
    with pytest.raises(ValueError, match="wheel_mass"):
        Corner(distance=1.0, wheel_mass=0.0, tyre_stiffness=1.0, strut=Strut())
    with pytest.raises(ValueError, match="states"):
        FullCar().simulate([front_road] * 4, [0.0, 1.0], initial=[0.0])
