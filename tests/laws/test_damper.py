"""Dampers of vehicles: other damping in bump than in rebound, a valve that opens."""

from __future__ import annotations

import numpy as np
import pytest
from core_draws import around
from inerter.core import Device
from inerter.reference import ReferenceDevice

SPEEDS = np.r_[-np.geomspace(3.0, 1e-6, 40), 0.0, np.geomspace(1e-6, 3.0, 40)]


def force(**values: float) -> np.ndarray:
    device = Device(**values)
    return np.array([device.evaluate(0.0, v, 0.0, 0.0)["total"] for v in SPEEDS]).ravel()


def test_rebound_and_bump_have_a_damping_each() -> None:
    found = force(viscous=1000.0, damping_asymmetry=0.3)
    expected = np.where(SPEEDS > 0, 1300.0, 700.0) * SPEEDS
    np.testing.assert_allclose(found, expected, rtol=1e-14)


def test_the_asymmetry_is_of_quadratic_damping_too() -> None:
    found = force(quadratic_damping=50.0, damping_asymmetry=-0.5)
    expected = np.where(SPEEDS > 0, 25.0, 75.0) * SPEEDS * np.abs(SPEEDS)
    np.testing.assert_allclose(found, expected, rtol=1e-14)


@pytest.mark.parametrize("beyond", [0.0, 0.25, 1.0, 3.0])
def test_slopes_below_and_beyond_the_knee(beyond: float) -> None:
    device = Device(viscous=800.0, damping_knee=0.1, damping_beyond=beyond)

    def slope(v: float) -> float:
        there, here = (device.evaluate(0.0, u, 0.0, 0.0)["total"] for u in (v + 1e-6, v - 1e-6))
        return float(np.ravel(there - here)[0]) / 2e-6

    assert slope(0.0) == pytest.approx(800.0, rel=1e-6)
    assert slope(20.0) == pytest.approx(800.0 * beyond, rel=1e-5, abs=1e-3)
    # what a digressive damper holds beyond its knee
    high = float(np.ravel(device.evaluate(0.0, 20.0, 0.0, 0.0)["total"])[0])
    assert high == pytest.approx(800.0 * (beyond * 20.0 + (1 - beyond) * 0.1), rel=2e-5)


def test_without_a_knee_and_with_an_equal_slope_it_is_the_straight_line() -> None:
    plain = force(viscous=70.0)
    for values in ({"damping_beyond": 0.2}, {"damping_knee": 0.1}, {"damping_asymmetry": 0.0}):
        np.testing.assert_array_equal(force(viscous=70.0, **values), plain)


def test_each_direction_bends_by_itself() -> None:
    both = {"viscous": 600.0, "damping_knee": 0.2, "damping_beyond": 0.4}
    back = {"damping_knee": 0.05, "damping_beyond": 2.0}
    found = force(**both, damping_knee_back=0.05, damping_beyond_back=2.0)
    forth, other = force(**both), force(**(both | back))
    np.testing.assert_array_equal(found, np.where(SPEEDS < 0, other, forth))
    # what is not given is as in the other direction
    knee_alone = force(**both, damping_knee_back=0.05)
    other = force(**(both | {"damping_knee": 0.05}))
    np.testing.assert_array_equal(knee_alone, np.where(SPEEDS < 0, other, forth))
    # 0: while x shrinks it does not bend
    straight = force(**both, damping_knee_back=0.0)
    np.testing.assert_array_equal(straight, np.where(SPEEDS < 0, 600.0 * SPEEDS, forth))


@pytest.mark.parametrize("beyond", [0.2, 3.0])
def test_a_sharp_knee_is_a_corner(beyond: float) -> None:
    bend = {"viscous": 800.0, "damping_knee": 0.1, "damping_beyond": beyond}
    corner = 800.0 * (beyond * SPEEDS + (1 - beyond) * np.clip(SPEEDS, -0.1, 0.1))
    deviation = [
        np.max(abs(force(**bend, damping_sharpness=n) - corner)) for n in (1.0, 2.0, 8.0, 64.0)
    ]
    # at the knee (1 - 2^(-1 / n)) of what bends is missing, elsewhere less
    most = [800.0 * abs(1 - beyond) * 0.1 * (1 - 0.5 ** (1 / n)) for n in (1.0, 2.0, 8.0, 64.0)]
    assert np.all(np.array(deviation) <= 1.001 * np.array(most))
    assert deviation[3] < 0.02 * deviation[0]
    # gently as by default, bit for bit
    np.testing.assert_array_equal(force(**bend, damping_sharpness=2.0), force(**bend))


def test_an_eddy_current_brake_and_a_silicone_damper() -> None:
    brake = force(viscous=50.0, damping_knee=0.2, damping_beyond=0.0, damping_exponent=-1.0)
    np.testing.assert_allclose(brake, 50.0 * SPEEDS / (1.0 + (SPEEDS / 0.2) ** 2), rtol=1e-14)
    # most at the knee, half of what the straight line has there
    assert np.max(brake) == pytest.approx(0.5 * 50.0 * 0.2, rel=0.02)
    # beyond the knee a power of the speed
    oil = {"damping_knee": 1e-4, "damping_beyond": 0.0, "damping_exponent": 0.35}
    fast = abs(SPEEDS) > 1e-2
    power = 700.0 * 1e-4**0.65 * np.sign(SPEEDS) * abs(SPEEDS) ** 0.35
    np.testing.assert_allclose(force(viscous=700.0, **oil)[fast], power[fast], rtol=1e-4)
    straight = force(viscous=700.0, **(oil | {"damping_exponent": 1.0}))
    np.testing.assert_allclose(straight, 700.0 * SPEEDS, rtol=1e-14)


@pytest.mark.parametrize("seed", range(30))
def test_core_and_reference_agree_and_take_energy(seed: int) -> None:
    rng = np.random.default_rng([28, seed])
    values = {
        "viscous": around(rng, 500.0), "quadratic_damping": around(rng, 500.0),
        "damping_asymmetry": float(rng.uniform(-0.99, 0.99)),
        "damping_knee": around(rng, 0.1, 1.0), "damping_beyond": float(rng.uniform(0, 4)),
    }  # fmt: skip
    if seed % 2:
        values["damping_knee_back"] = around(rng, 0.1, 1.0)
    if seed % 5:
        values["damping_sharpness"] = float(rng.uniform(1.0, 64.0))
    if seed % 7:
        values["damping_exponent"] = float(rng.uniform(-1.0, 1.0))
    if seed % 3:
        values["damping_beyond_back"] = float(rng.uniform(0, 4))
    found = force(**values)
    reference = ReferenceDevice(**values)  # pyright: ignore[reportArgumentType]
    expected = [reference.force(0.0, v, 0.0) for v in SPEEDS]
    np.testing.assert_allclose(found, expected, rtol=1e-13)
    assert np.all(found * SPEEDS >= 0)
    device = Device(**values)
    heat = [device.evaluate(0.0, v, 0.0, 0.0)["dissipated_power"] for v in SPEEDS]
    np.testing.assert_allclose(np.ravel(heat), found * SPEEDS, rtol=1e-13)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("damping_asymmetry", 1.5), ("damping_knee", -0.1), ("damping_beyond", -1),
        ("damping_knee_back", -0.1), ("damping_beyond_back", -1), ("damping_sharpness", 0.5),
        ("damping_sharpness", 65), ("damping_exponent", -1.5), ("damping_exponent", 1.1),
    ],
)  # fmt: skip
def test_a_value_out_of_range_is_refused_by_name(name: str, value: float) -> None:
    with pytest.raises(ValueError, match=name):
        Device(**{"viscous": 10.0, name: value})  # pyright: ignore[reportArgumentType]
