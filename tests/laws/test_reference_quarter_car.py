"""Quarter-car: linear layouts against the matrix exponential, friction against its own balance."""

import numpy as np
import pytest
from inerter.reference import QuarterCar, ReferenceDevice
from scipy.linalg import expm

MS, MU, KT = 181.75, 25.0, 120e3
K, C, B = 60e3, 1500.0, 113.0


def linear_system(layout: str) -> np.ndarray:
    """State matrix of the linear car, road at zero, written from the equations of motion."""
    if layout == "S3":
        # unknowns vs', vu', y'' with states (zs, zu, vs, vu, y, y')
        a = np.zeros((6, 6))
        a[0, 2] = a[1, 3] = a[4, 5] = 1.0
        strut = np.array([K, -K, C, -C, 0.0, -C])
        a[2] = -strut / MS
        a[3] = strut / MU
        a[3, 1] -= KT / MU
        a[5] = np.array([0.0, 0.0, C, -C, 0.0, -C]) / B
        return a
    b = B if layout == "S2" else 0.0
    mass = np.array([[MS + b, -b], [-b, MU + b]])
    stiffness = np.array([[K, -K], [-K, K + KT]])
    damping = np.array([[C, -C], [-C, C]])
    inverse = np.linalg.inv(mass)
    return np.block([[np.zeros((2, 2)), np.eye(2)], [-inverse @ stiffness, -inverse @ damping]])


@pytest.mark.rarely("Radau-S2", "Radau-S3")
@pytest.mark.parametrize("layout", ["S1", "S2", "S3"])
@pytest.mark.parametrize("method", ["DOP853", "Radau"])
def test_linear_car_is_the_matrix_exponential(layout: str, method: str) -> None:
    device = ReferenceDevice(inertance=B if layout != "S1" else 0.0)
    car = QuarterCar(layout=layout, stiffness=K, damping=C, device=device)
    start = np.zeros(car.nstate)
    start[1], start[3] = 2e-3, 0.3
    times = np.linspace(0.0, 1.0, 11)
    run = car.simulate(lambda t: 0.0, times, initial=start, method=method, rtol=1e-10)
    exact = np.array([expm(linear_system(layout) * t) @ start for t in times])
    np.testing.assert_allclose(run.body_displacement, exact[:, 0], atol=1e-9)
    np.testing.assert_allclose(run.wheel_displacement, exact[:, 1], atol=1e-9)
    np.testing.assert_allclose(run.body_velocity, exact[:, 2], atol=1e-8)


def test_wheel_after_two_seconds() -> None:
    # the exact value for zu'(0) = 0.3 m/s, S2
    device = ReferenceDevice(inertance=B)
    car = QuarterCar(layout="S2", stiffness=K, damping=C, device=device)
    run = car.simulate(lambda t: 0.0, [0.0, 2.0], initial=[0, 0, 0, 0.3], method="DOP853")
    assert run.wheel_displacement[-1] == pytest.approx(-5.12105e-5, rel=1e-5)


def test_static_deflection_under_a_body_force() -> None:
    # F_s lifts the body by F_s (1/k + 1/kt)
    car = QuarterCar(layout="S1", stiffness=K, damping=4000.0)
    run = car.simulate(lambda t: 0.0, [0.0, 6.0], body_force=lambda t: 1000.0)
    assert run.body_displacement[-1] == pytest.approx(1000.0 * (1 / K + 1 / KT), rel=1e-6)
    assert run.tyre_force[-1] == pytest.approx(1000.0, rel=1e-6)


FRICTION = {
    "coulomb": {"friction": "coulomb", "coulomb_force": 10.0, "transition_velocity": 1e-3},
    "lugre": {"friction": "lugre", "coulomb_force": 10.0, "static_force": 14.0},
    "load": {"load_friction": 0.2, "transition_velocity": 1e-3},
}


@pytest.mark.parametrize("layout", ["S2", "S3"])
@pytest.mark.parametrize("name", FRICTION)
def test_forces_balance_exactly(layout: str, name: str) -> None:
    device = ReferenceDevice(inertance=B, **FRICTION[name])  # type: ignore[arg-type]
    car = QuarterCar(layout=layout, stiffness=K, damping=C, device=device)
    times = np.linspace(0.0, 0.5, 101)
    run = car.simulate(lambda t: 5e-3 * np.sin(20.0 * t), times, rtol=1e-7, atol=1e-10)

    # Newton on the wheel, and the strut as the sum of its branches
    wheel = run.strut_force - run.tyre_force
    np.testing.assert_allclose(MU * run.wheel_acceleration, wheel, atol=1e-8)
    branches = K * run.suspension_travel + run.device_force
    if layout == "S2":
        branches = branches + C * (run.body_velocity - run.wheel_velocity)
    np.testing.assert_allclose(run.strut_force, branches, atol=1e-8)

    # the device itself agrees with the force it is said to carry
    x, v, z = run.device_displacement, run.device_velocity, run.device_state
    if layout == "S2":
        a = run.body_acceleration - run.wheel_acceleration
    else:
        a = np.asarray(device.acceleration(x, v, run.device_force, z))
    np.testing.assert_allclose(np.asarray(device.force(x, v, a, z)), run.device_force, atol=1e-8)


def test_energy_of_a_frictional_car_only_falls() -> None:
    device = ReferenceDevice(inertance=B, **FRICTION["lugre"])  # type: ignore[arg-type]
    car = QuarterCar(layout="S2", stiffness=K, damping=0.0, device=device)
    times = np.linspace(0.0, 0.5, 2001)
    run = car.simulate(lambda t: 0.0, times, initial=[0, 0, 0, 0.3, 0], rtol=1e-7, atol=1e-10)
    x, v, z = run.device_displacement, run.device_velocity, run.device_state
    a = run.body_acceleration - run.wheel_acceleration
    energy = (
        0.5 * MS * run.body_velocity**2
        + 0.5 * MU * run.wheel_velocity**2
        + 0.5 * KT * run.wheel_displacement**2
        + 0.5 * K * x**2
        + np.asarray(device.stored_energy(x, v, z))
    )
    heat = np.asarray(device.dissipated_power(x, v, a, z))
    lost = np.concatenate(([0.0], np.cumsum(0.5 * (heat[1:] + heat[:-1]) * np.diff(times))))
    assert heat.min() >= -1e-9
    np.testing.assert_allclose(energy + lost, energy[0], rtol=2e-4)


def test_errors() -> None:
    with pytest.raises(ValueError, match="S4"):
        QuarterCar(layout="S4")
    with pytest.raises(ValueError, match="in series"):
        QuarterCar(layout="S3")
    with pytest.raises(ValueError, match="states"):
        QuarterCar(layout="S1").simulate(lambda t: 0.0, [0.0, 1.0], initial=[0.0])
