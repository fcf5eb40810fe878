"""Laws without memory against hand values and published numbers."""

import numpy as np
import pytest
from inerter.reference import ReferenceDevice
from scipy.optimize import brentq

# the fluid inerter's friction: f_s 50 N, f_d 25 N, v_s 0.013 m/s, c_d 515 N s/m
FLUID = {
    "friction": "brown_mcphee", "coulomb_force": 25.0, "static_force": 50.0,
    "stribeck_velocity": 0.013,
}  # fmt: skip


def test_brown_mcphee_peak_is_at_the_stribeck_velocity() -> None:
    device = ReferenceDevice(**FLUID)  # type: ignore[arg-type]
    assert device.force(0.0, 0.013, 0.0) == pytest.approx(25.0 * np.tanh(4.0) + 25.0, rel=1e-14)
    speeds = np.linspace(1e-5, 0.1, 10001)
    force = np.asarray(device.force(0.0, speeds, 0.0))
    assert force.max() == pytest.approx(49.98, abs=0.01)
    assert speeds[force.argmax()] == pytest.approx(0.013, rel=0.01)


def test_brown_mcphee_with_viscous_part_has_the_published_extrema() -> None:
    device = ReferenceDevice(viscous=515.0, **FLUID)  # type: ignore[arg-type]

    def force(speed: float) -> float:
        return float(device.force(0.0, speed, 0.0))

    # the derivative of the curve's two terms, zero where the force turns
    def slope(speed: float) -> float:
        s = speed / 0.013
        rising = 4.0 * 25.0 / 0.013 / np.cosh(4.0 * s) ** 2
        peak = 25.0 / 0.013 * (0.75 - 0.75 * s**2) / (s**2 / 4.0 + 0.75) ** 3
        return float(rising + peak + 515.0)

    top = float(brentq(slope, 0.014, 0.025))  # pyright: ignore[reportArgumentType]
    bottom = float(brentq(slope, 0.025, 0.05))  # pyright: ignore[reportArgumentType]
    assert top == pytest.approx(0.016, abs=5e-4)
    assert bottom == pytest.approx(0.036, abs=5e-4)
    assert force(top) == pytest.approx(57.4, abs=0.05)
    assert force(bottom) == pytest.approx(53.3, abs=0.05)
    assert force(top) > max(force(top - 1e-4), force(top + 1e-4))
    assert force(bottom) < min(force(bottom - 1e-4), force(bottom + 1e-4))


def test_stribeck_limits() -> None:
    device = ReferenceDevice(
        friction="stribeck", coulomb_force=10.0, static_force=16.0, stribeck_velocity=0.01,
        transition_velocity=1e-6,
    )  # fmt: skip
    assert device.force(0.0, 1e-4, 0.0) == pytest.approx(16.0, rel=1e-3)
    assert device.force(0.0, 0.01, 0.0) == pytest.approx(10.0 + 6.0 / np.e, rel=1e-12)
    assert device.force(0.0, -1.0, 0.0) == pytest.approx(-10.0, rel=1e-12)


def test_stribeck_without_fall_is_coulomb() -> None:
    speeds = np.linspace(-1e-3, 1e-3, 101)
    stribeck = ReferenceDevice(friction="stribeck", coulomb_force=10.0, static_force=10.0)
    coulomb = ReferenceDevice(friction="coulomb", coulomb_force=10.0)
    np.testing.assert_allclose(
        np.asarray(stribeck.force(0.0, speeds, 0.0)), np.asarray(coulomb.force(0.0, speeds, 0.0))
    )


def test_coulomb_smoothing_width() -> None:
    device = ReferenceDevice(friction="coulomb", coulomb_force=10.0)
    assert device.force(0.0, 1e-4, 0.0) == pytest.approx(10.0 * np.tanh(1.0), rel=1e-14)
    assert device.force(0.0, 1e-3, 0.0) == pytest.approx(10.0, rel=1e-8)
