"""Rate-and-state friction: steady state, velocity step, hold and slide in closed form, heat."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from core_draws import (
    around,
    draw_branches,
    draw_friction,
    draw_levels,
    draw_points,
    draw_series,
    magnitudes,
)
from inerter.core import Device, DeviceError
from inerter.reference import Motion, ReferenceDevice, response

LAW: dict[str, Any] = {
    "friction": "rate_state", "coulomb_force": 8.0, "rate_effect": 0.015, "age_effect": 0.025,
    "rate_velocity": 1e-3, "age_distance": 2e-5, "transition_velocity": 1e-7,
}  # fmt: skip
FC, A, B, V0, L = 8.0, 0.015, 0.025, 1e-3, 2e-5


def force(v: float, z: float, **more: Any) -> float:
    return float(Device(**{**LAW, **more}).evaluate(0.0, v, 0.0, z)["total"][0])


def draw(rng: np.random.Generator, wide: float = 1.0) -> dict[str, Any]:
    p: dict[str, Any] = (
        draw_friction(rng, "rate_state", wide) | draw_branches(rng, wide) | draw_levels(rng)
    )
    p["load_friction"] = min(p["load_friction"], 0.9)
    return p


# --- closed forms ---------------------------------------------------------------------------------


@pytest.mark.parametrize("v", [-0.3, 1e-5, 1e-3, 0.02, 4.0])
def test_steady_sliding_falls_with_the_logarithm_of_speed(v: float) -> None:
    device = Device(**LAW)
    z = device.step(0.0, v, 0.0, 1e3 * L / abs(v))
    assert z == pytest.approx(np.log(V0 / abs(v)), abs=1e-12)
    level = FC * (1.0 + (A - B) * np.log(abs(v) / V0))
    assert force(v, z) == pytest.approx(np.sign(v) * level, rel=1e-4)


def test_a_step_of_the_velocity_is_the_closed_form() -> None:
    # up by the direct effect at once, then back by the age over the way L
    slow, fast = 1e-4, 2e-3
    device = Device(**LAW)
    z = device.step(0.0, slow, 0.0, 1e4 * L / slow)
    before, jump = force(slow, z), force(fast, z)
    assert jump - before == pytest.approx(FC * A * np.log(fast / slow), rel=1e-5)
    for way in (0.1, 0.7, 1.0, 3.0, 30.0):
        t = way * L / fast
        age = V0 / fast + (V0 / slow - V0 / fast) * np.exp(-way)
        expected = FC * (1.0 + A * np.log(fast / V0) + B * np.log(age))
        assert force(fast, device.step(0.0, fast, z, t)) == pytest.approx(expected, rel=1e-6)
        # in many steps the same
        state = z
        for _ in range(7):
            state = device.step(0.0, fast, state, t / 7)
        assert state == pytest.approx(np.log(age), abs=1e-12)


def test_held_and_slid_again_it_has_grown_with_the_logarithm_of_the_hold() -> None:
    v = 1e-3
    device = Device(**LAW)
    start = device.step(0.0, v, 0.0, 1e4 * L / v)
    peaks = []
    holds = np.array([1.0, 10.0, 100.0, 1000.0, 1e5])
    for hold in holds:
        held = device.step(0.0, 0.0, start, float(hold))
        assert np.exp(held) == pytest.approx(np.exp(start) + V0 * hold / L, rel=1e-12)
        peaks.append(force(v, held))
    rise = np.diff(peaks) / np.diff(np.log10(holds))
    np.testing.assert_allclose(rise[1:], FC * B * np.log(10.0), rtol=3e-3)


def test_the_reference_integrates_to_the_closed_form() -> None:
    # slide, hold, slide: with smooth ends of the hold left out, one stretch at a time
    told = ReferenceDevice(**LAW)
    for v, begin in ((2e-3, 1.3), (0.0, -0.4), (-5e-4, 2.0)):
        still = Motion(
            lambda t, v=v: v * t, lambda t, v=v: v + 0.0 * t, lambda t: 0.0 * t
        )  # fmt: skip
        times = np.linspace(0.0, 0.05, 11)
        found = response(told, still, times, initial_state=begin, scan_step=1e-2)
        exact = [Device(**LAW).step(0.0, v, begin, float(t)) for t in times]
        np.testing.assert_allclose(found.state, exact, atol=3e-8)


# --- both tellings, symmetry, passivity -----------------------------------------------------------


def test_core_and_reference_agree() -> None:
    rng = np.random.default_rng(11)
    for k in range(60):
        p: dict[str, Any] = draw(rng, 0.5 + k % 3)
        device, told = Device(**p), ReferenceDevice(**p)
        assert device.state_names == told.state_names == ("friction_state",)
        x, v, a, z = draw_points(rng, 50, 5.0)
        said, size = device.evaluate(x, v, a, z), magnitudes(told, x, v, a, z)
        expected = {
            "total": told.force(x, v, a, z),
            "friction": told.total_friction(x, v, a, z),
            "state_rate": told.state_rate(x, v, z),
            "stored_energy": told.stored_energy(x, v, z),
            "dissipated_power": told.dissipated_power(x, v, a, z),
        }
        for name, value in expected.items():
            error = np.abs(said[name].ravel() - value) / (size[name] + 1e-300)
            assert error.max() < 1e-12, name


def test_behind_a_series_element_too() -> None:
    rng = np.random.default_rng(12)
    for _ in range(20):
        p: dict[str, Any] = draw(rng) | draw_series(rng, backlash=False)
        p["friction_side"] = "flywheel"
        device, told = Device(**p), ReferenceDevice(**p)
        x, v, a, z0 = draw_points(rng, 30, 3.0)
        z = np.column_stack([z0, 1e-4 * rng.normal(size=(30, 2))])
        said = device.evaluate(x, v, a, z)
        for name, value in (
            ("total", told.force(x, v, a, z)),
            ("state_rate", told.state_rate(x, v, z)),
            ("dissipated_power", told.dissipated_power(x, v, a, z)),
        ):
            scale = np.abs(value).max(axis=0)
            np.testing.assert_allclose(said[name], value, rtol=1e-9, atol=1e-10 * scale.max())


def test_mirrored_motion_mirrors_the_force_at_the_same_age() -> None:
    rng = np.random.default_rng(13)
    for _ in range(20):
        p = draw_friction(rng, "rate_state", 2.0)
        device = Device(**p)
        x, v, a, z = draw_points(rng, 40, 5.0)
        one, other = device.evaluate(x, v, a, z), device.evaluate(-x, -v, -a, z)
        np.testing.assert_array_equal(one["total"], -other["total"])
        np.testing.assert_array_equal(one["state_rate"], other["state_rate"])


def test_passive_at_any_age_and_speed() -> None:
    rng = np.random.default_rng(14)
    for _ in range(50):
        device = Device(**(draw_friction(rng, "rate_state", 2.0) | draw_levels(rng)))
        x, v, a, z = draw_points(rng, 100, 200.0)
        said = device.evaluate(x, v, a, z)
        assert said["dissipated_power"].min() >= 0.0
        assert (said["stored_energy"] == 0.0).all()
        # never without a level
        assert (np.sign(said["friction"]) == np.sign(v)).all()


def test_two_steps_are_one_and_no_step_is_too_long() -> None:
    rng = np.random.default_rng(15)
    for _ in range(200):
        device = Device(**draw_friction(rng, "rate_state", 2.0))
        v, z, h = rng.normal() * around(rng, 0.01, 4), rng.normal() * 30.0, around(rng, 0.01, 5)
        share = rng.uniform()
        parts = device.step(0.0, v, device.step(0.0, v, z, share * h), (1.0 - share) * h)
        assert device.step(0.0, v, z, h) == pytest.approx(parts, rel=1e-11, abs=1e-11)
        for far in (1e-300, 1e-12, 1e12, 1e300):
            assert np.isfinite(device.step(0.0, v, z, far))
        for old in (-1e6, 1e6):
            assert np.isfinite(device.step(0.0, v, old, h))
        assert device.step(0.0, v, z, 0.0) == z


def test_the_force_over_a_step_does_not_fall_with_the_acceleration() -> None:
    rng = np.random.default_rng(16)
    for _ in range(100):
        p = draw_friction(rng, "rate_state", 2.0) | {"inertance": around(rng, 10.0)}
        p["transition_velocity"] = around(rng, 1e-4, 3.0)
        device = Device(**p)
        v, z, h = 0.1 * rng.normal(), rng.normal() * 4.0, around(rng, 1e-3)
        a = np.sort(np.concatenate([-v / h * (1 + 1e-6 * rng.normal(size=20)),
                                    rng.normal(size=20) * 100.0]))  # fmt: skip
        forces = [device.over_step(0.0, v, each, z, h, 0.1)[0]["total"] for each in a]
        assert (np.diff(forces) >= -1e-12 * np.abs(forces).max()).all()
        _, end = device.over_step(0.0, v, 1.0, z, h, 0.1)
        assert end[0] == pytest.approx(device.step(0.0, v + h, z, h), rel=1e-14, abs=1e-14)


def test_state_of_force_is_the_age_that_has_it() -> None:
    device = Device(inertance=3.0, **LAW)
    for z in (-3.0, 0.5, 6.0):
        total = device.evaluate(0.0, 0.02, 1.5, z)["total"][0]
        assert device.state_of_force(0.0, 0.02, 1.5, total) == pytest.approx(z, rel=1e-9)
    assert device.state_of_force(0.0, 0.0, 0.0, 4.0) == 0.0


def test_what_it_does_not_read_is_refused() -> None:
    with pytest.raises(DeviceError, match="friction_backlash"):
        Device(**LAW, friction_backlash=1e-3)
    with pytest.raises(DeviceError, match="coulomb_force is 0"):
        Device(friction="rate_state")
    with pytest.raises(DeviceError, match="age_distance"):
        Device(**{**LAW, "age_distance": 0.0})
