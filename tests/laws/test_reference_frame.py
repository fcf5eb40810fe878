"""Shear frame: modes, matrix exponential and impedances against the integrated frame."""

from dataclasses import replace

import numpy as np
import pytest
from inerter.reference import (
    FRAME_DEVICE,
    FloorDevice,
    ReferenceDevice,
    ShearFrame,
    frame_modes,
    frame_receptance,
    frame_state_matrix,
)
from scipy.linalg import expm

MIXED = ShearFrame(
    storey_damping=(800.0, 600.0, 500.0),
    devices=(
        FloorDevice(lower=0, upper=1, device=FRAME_DEVICE),
        FloorDevice(
            lower=1, upper=3,
            device=ReferenceDevice(
                inertance=300.0, viscous=900.0, stiffness=2e4, flywheel_viscous=100.0
            ),
        ),
        FloorDevice(
            lower=0, upper=2,
            device=ReferenceDevice(inertance=200.0, series_damping=4e3, flywheel_viscous=50.0),
        ),
    ),
)  # fmt: skip


def test_modes_of_a_uniform_chain() -> None:
    # 2 sqrt(k / m) sin((2 i - 1) pi / (2 (2 n + 1)))
    frequencies, shapes = frame_modes(ShearFrame(devices=()))
    i = np.arange(1, 4)
    exact = 2.0 * np.sqrt(1.5e6 / 1e3) * np.sin((2 * i - 1) * np.pi / 14.0) / (2.0 * np.pi)
    np.testing.assert_allclose(frequencies, exact, rtol=1e-12)
    assert np.all(np.diff(abs(shapes[:, 0])) > 0.0)


def test_frame_is_the_matrix_exponential() -> None:
    # one device without, two with a series element; one skips a floor
    start = np.zeros(MIXED.nstate)
    start[:6] = 0.01, -0.02, 0.03, 0.1, 0.4, -0.3
    times = np.linspace(0.0, 0.8, 5)
    run = MIXED.simulate(times, initial=start, method="DOP853", rtol=1e-10)
    matrix = frame_state_matrix(MIXED)
    exact = np.array([expm(matrix * t) @ start for t in times])
    np.testing.assert_allclose(run.displacement, exact[:, :3], atol=1e-9)
    np.testing.assert_allclose(run.velocity, exact[:, 3:6], atol=1e-8)
    np.testing.assert_allclose(run.device_states[0], exact[:, 6:8], atol=1e-8)


def test_impedances_agree_with_the_state_matrix() -> None:
    # ground acceleration enters where a floor's own mass is, also beside a grounded inerter
    mass = np.diag([1000.0] * 3)
    e = MIXED.directions[:, 1]
    drive = np.zeros(MIXED.nstate)
    drive[3:6] = -np.linalg.solve(mass + 300.0 * np.outer(e, e), mass @ np.ones(3))
    matrix, frequencies = frame_state_matrix(MIXED), np.array([0.5, 2.7, 3.3, 8.0, 20.0])
    exact = [
        np.linalg.solve(2j * np.pi * f * np.eye(MIXED.nstate) - matrix, drive)[:3]
        for f in frequencies
    ]
    np.testing.assert_allclose(frame_receptance(MIXED, frequencies), exact, rtol=1e-9)


@pytest.mark.long
def test_a_shaken_frame_settles_on_its_receptance() -> None:
    frequency = 3.0
    omega = 2.0 * np.pi * frequency
    frame = replace(MIXED, storey_damping=(2e4, 2e4, 2e4))
    times = np.linspace(7.0, 8.0, 21)
    run = frame.simulate(
        np.concatenate(([0.0], times)),
        ground_acceleration=lambda t: float(np.sin(omega * t)),
        method="DOP853",
        rtol=1e-8,
    )
    response = frame_receptance(frame, frequency)[0]
    exact = (np.exp(1j * omega * times)[:, None] * response).imag
    np.testing.assert_allclose(run.displacement[1:], exact, atol=1e-4 * np.max(abs(exact)))
    ground = np.sin(omega * run.time)[:, None]
    np.testing.assert_allclose(run.absolute_acceleration, run.acceleration + ground)


def test_the_damper_is_tuned() -> None:
    # the largest amplification near the first mode rises with every detuning
    band = np.linspace(1.5, 4.5, 601)

    def peak(**changes: float) -> float:
        device = replace(FRAME_DEVICE, **changes)
        frame = ShearFrame(devices=(FloorDevice(lower=0, upper=1, device=device),))
        return float(np.max(abs(frame_receptance(frame, band)[:, 2])))

    best = peak()
    for name in ("series_stiffness", "series_damping"):
        for factor in (0.93, 1.07):
            assert peak(**{name: factor * getattr(FRAME_DEVICE, name)}) > best
    assert best < 0.1 * np.max(abs(frame_receptance(ShearFrame(devices=()), band)[:, 2]))


def test_static_floor_forces() -> None:
    frame = ShearFrame(storey_damping=(3e4, 3e4, 3e4), devices=())
    run = frame.simulate([0.0, 8.0], floor_forces=lambda t: (0.0, 0.0, 1500.0), method="LSODA")
    np.testing.assert_allclose(run.displacement[-1], [1e-3, 2e-3, 3e-3], rtol=1e-4)


@pytest.mark.long
def test_energy_with_backlash_between_floors() -> None:
    loose = replace(FRAME_DEVICE, backlash=5e-4, flywheel_viscous=200.0)
    frame = ShearFrame(
        devices=(
            FloorDevice(lower=0, upper=1, device=loose),
            FloorDevice(lower=1, upper=3, device=loose),
        )
    )
    start = np.zeros(frame.nstate)
    start[2], start[5] = 0.01, 0.2
    times = np.linspace(0.0, 0.6, 3001)
    run = frame.simulate(times, initial=start, rtol=1e-8, atol=1e-11)
    drift = np.diff(run.displacement, axis=1, prepend=0.0)
    energy = 0.5e3 * np.sum(run.velocity**2, axis=1) + 0.75e6 * np.sum(drift**2, axis=1)
    heat = np.zeros(times.size)
    velocity = run.velocity @ frame.directions
    for i, placed in enumerate(frame.devices):
        x, z = run.device_displacement[:, i], run.device_states[i]
        energy += np.asarray(placed.device.stored_energy(x, velocity[:, i], z))
        heat += np.asarray(placed.device.dissipated_power(x, velocity[:, i], 0.0 * x, z))
    lost = np.concatenate(([0.0], np.cumsum(0.5 * (heat[1:] + heat[:-1]) * np.diff(times))))
    assert lost[-1] > 0.1 * energy[0]
    # what is left is the quadrature over the jumps at contact; it halves with the spacing
    np.testing.assert_allclose(energy + lost, energy[0], rtol=2e-3)


def test_errors() -> None:
    with pytest.raises(ValueError, match="lower"):
        FloorDevice(lower=2, upper=2, device=ReferenceDevice())
    with pytest.raises(ValueError, match="4, but the frame has 3"):
        ShearFrame(devices=(FloorDevice(lower=0, upper=4, device=ReferenceDevice()),))
    with pytest.raises(ValueError, match="lengths"):
        ShearFrame(storey_mass=(1.0, 2.0))
