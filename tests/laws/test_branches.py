"""Viscoelastic branches: the tellings agree; complex stiffness, relaxation, energy."""

from typing import Any

import numpy as np
import pytest
from core_draws import around, draw_complete, draw_points, draw_states
from core_telling import Telling
from inerter.core import Device, DeviceError
from inerter.reference import ReferenceDevice, response, sine_motion

RUBBER: dict[str, Any] = {
    "stiffness": 5e3,
    "branch_stiffness_1": 2e4, "branch_damping_1": 800.0,
    "branch_stiffness_2": 8e3, "branch_damping_2": 2e3,
    "branch_stiffness_3": 3e4, "branch_damping_3": 60.0,
}  # fmt: skip


def draw_branch(rng: np.random.Generator) -> dict[str, float]:
    drawn = {}
    for i in range(1, int(rng.integers(2, 5))):
        drawn |= {
            f"branch_stiffness_{i}": around(rng, 1e4),
            f"branch_damping_{i}": around(rng, 1e3),
        }
    return drawn


def test_core_is_the_reference_on_random_devices() -> None:
    rng = np.random.default_rng(1)
    for _ in range(150):
        bare = draw_complete(rng)
        bare["load_friction"] = min(0.9, bare["load_friction"])
        p: dict[str, Any] = bare | draw_branch(rng)
        core, reference = Device(**p), ReferenceDevice(**p)
        assert core.state_names == reference.state_names
        n = sum(name.startswith("branch_stiffness") for name in p)
        x, v, a, _ = draw_points(rng, 30, 1.0, 1.0)
        inner = draw_states(rng, 30, bare)
        if bare.get("backlash"):
            inner[:, -1] = np.clip(inner[:, -1], -bare["backlash"], bare["backlash"])
        z = np.column_stack([inner, rng.normal(size=(30, n)) * 0.01])
        found, state = core.evaluate(x, v, a, z), reference.state_argument(z)
        sizes = Telling(**bare).quantities(x, v, a, inner)
        k = np.array([p[f"branch_stiffness_{i + 1}"] for i in range(n)])
        c = np.array([p[f"branch_damping_{i + 1}"] for i in range(n)])
        beside = abs(z[:, -n:]) @ k
        more = {"total": beside, "stored_energy": z[:, -n:] ** 2 @ k}
        more["dissipated_power"] = 4.0 * ((k * z[:, -n:]) ** 2 / c).sum(axis=1)
        more["dissipated_power"] += (c * v[:, np.newaxis] ** 2).sum(axis=1)
        for name, value in (
            ("total", reference.force(x, v, a, state)),
            ("friction", reference.total_friction(x, v, a, state)),
            ("stored_energy", reference.stored_energy(x, v, state)),
            ("dissipated_power", reference.dissipated_power(x, v, a, state)),
        ):
            error = abs(found[name] - np.reshape(value, v.shape))
            assert np.all(error <= 1e-12 * (sizes[name][1] + more.get(name, 0.0))), (p, name)
        rates = np.reshape(reference.state_rate(x, v, state, a=a), z.shape)
        size = np.column_stack(
            [sizes["state_rate"][1], abs(v)[:, np.newaxis] + abs(z[:, -n:]) * k / c]
        )
        assert np.all(abs(found["state_rate"].reshape(z.shape) - rates) <= 1e-12 * size), p


@pytest.mark.parametrize("frequency", [0.1, 3.0, 40.0])
def test_complex_stiffness(frequency: float) -> None:
    # after the transient: force over displacement, in amplitude and phase
    device, omega = Device(**RUBBER), 2.0 * np.pi * frequency
    pairs = [(RUBBER[f"branch_stiffness_{i}"], RUBBER[f"branch_damping_{i}"]) for i in (1, 2, 3)]
    stiffness = 5e3 + sum(k * 1j * omega * c / (k + 1j * omega * c) for k, c in pairs)
    motion, count = sine_motion(1e-3, frequency), 2000
    periods = 4 + int(np.ceil(5.0 * frequency))
    t = np.arange(periods * count) / (count * frequency)
    force = device.along(t[1], motion.displacement(t), motion.velocity(t), motion.acceleration(t))[
        "total"
    ][-count:]
    found = 2.0 * np.mean(force * np.exp(-1j * omega * t[-count:])) * 1j / 1e-3
    assert abs(found - stiffness) < 1e-4 * abs(stiffness)


def test_a_step_is_exact_however_long() -> None:
    device, z = Device(**RUBBER), np.array([1e-3, -2e-3, 5e-4])
    for h in (1e-6, 0.1, 1e3):
        found = device.step(0.0, 0.3, z, h)
        for i in range(3):
            time = RUBBER[f"branch_damping_{i + 1}"] / RUBBER[f"branch_stiffness_{i + 1}"]
            fade = np.exp(-h / time)
            assert found[i] == pytest.approx(z[i] * fade + 0.3 * time * (1.0 - fade), rel=1e-9)


def test_along_a_motion_the_core_is_the_reference() -> None:
    more: dict[str, Any] = {"inertance": 5.0, "series_stiffness": 1e5, "series_damping": 100.0}
    motion, t = sine_motion(1e-3, 5.0), np.linspace(0.0, 0.4, 4001)
    core = Device(**RUBBER, **more)
    start = np.zeros(core.nstate)
    start[1] = motion.velocity(0.0)
    told = core.along(
        t[1], motion.displacement(t), motion.velocity(t), motion.acceleration(t), start
    )
    true = response(ReferenceDevice(**RUBBER, **more), motion, t[::20], initial_state=start)
    error = told["total"][::20] - true.force
    assert np.max(abs(error)) < 1e-4 * np.max(abs(true.force))


def test_over_a_step_the_force_does_not_fall_and_goes_to_that_of_the_instant() -> None:
    device, z = Device(**RUBBER), np.array([1e-3, -2e-3, 5e-4])
    now = device.evaluate(0.0, 0.2, 0.0, z)["total"][0]
    assert device.over_step(0.0, 0.2, 0.0, z, 1e-9, 1.0)[0]["total"] == pytest.approx(now, rel=1e-5)
    for h in (1e-4, 1e-2, 1.0):
        force = [
            device.over_step(0.0, 0.2, a, z, h, 1.0)[0]["total"] for a in np.linspace(-9, 9, 19)
        ]
        assert np.all(np.diff(force) >= 0.0)


def test_half_a_branch_is_refused() -> None:
    cases: tuple[tuple[dict[str, Any], str], ...] = (
        ({"branch_stiffness_1": 1e4}, "branch_damping_1 0 N.s/m: half a branch"),
        ({"branch_stiffness_2": 1e4, "branch_damping_2": 1.0}, "branch_stiffness_1 is 0 N/m"),
    )
    for values, message in cases:
        with pytest.raises(DeviceError, match=message):
            Device(**values)
        with pytest.raises(ValueError, match="branch"):
            ReferenceDevice(**values)
