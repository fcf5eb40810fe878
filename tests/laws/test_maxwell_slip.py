"""Maxwell-slip friction: the tellings agree; Masing's rules, wiping-out, congruency.

The oracles are those of hysteresis with non-local memory (Mayergoyz, Mathematical Models of
Hysteresis, 1991; Masing 1926); a law with one state fails them, which is tested too.
"""

from typing import Any

import numpy as np
import pytest
from core_draws import draw_branches, draw_friction, draw_levels, draw_points, draw_states
from core_telling import Array
from inerter.core import Device, DeviceError
from inerter.reference import ReferenceDevice, response, sine_motion

ELEMENTS: dict[str, Any] = {
    "friction": "maxwell_slip",
    "slip_stiffness_1": 1e4, "slip_force_1": 4.0,
    "slip_stiffness_2": 2e3, "slip_force_2": 3.0,
    "slip_stiffness_3": 6e2, "slip_force_3": 3.0,
}  # fmt: skip


def walk(device: Device, turns: list[float], parts: int = 50) -> tuple[Array, Array]:
    """Displacement and friction force along straight ways between turning points, from rest."""
    x, force, z = [0.0], [0.0], np.zeros(device.nstate)
    for end in turns:
        start = x[-1]
        for share in np.linspace(0.0, 1.0, parts + 1)[1:]:
            place = start + share * (end - start)
            z = device.step(x[-1], (place - x[-1]) / 0.01, z, 0.01)
            x.append(place)
            force.append(float(device.evaluate(place, 0.0, 0.0, z)["friction"][0]))
    return np.array(x), np.array(force)


# ------------------------------ tellings ------------------------------


@pytest.mark.parametrize("wide", [1.0, 3.0])
def test_core_is_the_reference(wide: float) -> None:
    rng = np.random.default_rng(int(wide))
    for _ in range(60):
        p = draw_friction(rng, "maxwell_slip", wide) | draw_branches(rng, wide) | draw_levels(rng)
        core, reference = Device(**p), ReferenceDevice(**p)
        assert core.state_names == reference.state_names
        x, v, a, _ = draw_points(rng, 60, 1e-3, 2.0 * wide)
        z = draw_states(rng, 60, p)
        found, state = core.evaluate(x, v, a, z), reference.state_argument(z)
        stiffness = np.array([p[n] for n in p if n.startswith("slip_stiffness")])
        spring = stiffness * abs(z)
        rate_size = abs(v)[:, np.newaxis] * (2.0 + abs(z) * 1e3 * 10.0**wide * 10.0**wide)
        rates = np.reshape(reference.state_rate(x, v, state, a=a), z.shape)
        assert np.all(abs(found["state_rate"] - rates) <= 1e-12 * rate_size)
        size = 1.0 + spring.sum(axis=1) + abs(found["total"]) + abs(found["inertance"])
        size += (abs(p["stiffness"]) + abs(p["stiffness_cubic"]) * x**2) * abs(x - p["rest_length"])
        for name, value in (
            ("friction", reference.total_friction(x, v, a, state)),
            ("total", reference.force(x, v, a, state)),
        ):
            assert np.all(abs(found[name] - value) <= 1e-12 * size), name
        energy = np.asarray(reference.stored_energy(x, v, state))
        assert np.all(abs(found["stored_energy"] - energy) <= 1e-12 * (1.0 + abs(energy) + size))
        heat = np.asarray(reference.dissipated_power(x, v, a, state))
        scale = (size + spring.sum(axis=1)) * abs(v) + (spring * rate_size).sum(axis=1)
        assert np.all(abs(found["dissipated_power"] - heat) <= 1e-12 * (scale + abs(heat)))


@pytest.mark.long
def test_along_a_motion_the_core_is_the_reference() -> None:
    motion, t = sine_motion(3e-3, 5.0), np.linspace(0.0, 0.25, 2001)
    for more in ({}, {"inertance": 20.0, "series_stiffness": 5e4, "series_damping": 50.0,
                      "friction_side": "flywheel"}):  # fmt: skip
        core = Device(**ELEMENTS, **more)
        start = np.zeros(core.nstate)
        if more:
            start[-1] = motion.velocity(0.0)
        told = core.along(
            t[1], motion.displacement(t), motion.velocity(t), motion.acceleration(t), start
        )
        true = response(
            ReferenceDevice(**ELEMENTS, **more), motion, t[::8], initial_state=start, rtol=1e-9
        )
        error = told["total"][::8] - true.force
        assert np.max(abs(error)) < 2e-3 * np.max(abs(true.force))


def test_a_step_is_exact_however_long() -> None:
    rng = np.random.default_rng(3)
    for _ in range(40):
        device = Device(**draw_friction(rng, "maxwell_slip"))
        z = rng.normal(size=device.nstate) * 1e-3
        v, h = rng.normal(), 10.0 ** rng.uniform(-4, 0)
        whole, parts = device.step(0.0, v, z, h), z
        for _ in range(16):
            parts = device.step(0.0, v, parts, h / 16)
        np.testing.assert_allclose(whole, parts, rtol=1e-12, atol=1e-18)


# ------------------------------ memory ------------------------------


def test_from_rest_the_force_is_the_polygon() -> None:
    x = np.linspace(0.0, 0.01, 400)
    _, force = walk(Device(**ELEMENTS), list(x[1:]), 1)
    polygon = sum(np.minimum(k * x, f) for k, f in ((1e4, 4.0), (2e3, 3.0), (6e2, 3.0)))
    np.testing.assert_allclose(force, polygon, rtol=1e-12, atol=1e-12)


def test_masing_branches_are_the_first_curve_twice_as_large() -> None:
    device, top = Device(**ELEMENTS), 4e-3
    x, force = walk(device, [top, -top, top])
    first = np.interp(np.linspace(0.0, top, 51), x[:51], force[:51])
    # down from the top, and up again: twice the first curve from the turning point
    np.testing.assert_allclose(force[50] - force[50:101], 2.0 * first, atol=1e-12)
    np.testing.assert_allclose(force[100:151] - force[100], 2.0 * first, atol=1e-12)


def test_a_larger_turn_wipes_the_smaller_ones_out() -> None:
    device = Device(**ELEMENTS)
    plain = walk(device, [5e-3, -3e-3, 5e-3, 6e-3])[1][-1]
    nested = walk(device, [5e-3, -3e-3, 1e-3, -1e-3, 2e-3, -2.5e-3, 5e-3, 6e-3])[1][-1]
    assert nested == pytest.approx(plain, abs=1e-12)
    # a loop closes: back at the turning point the force is what it was there
    x, force = walk(device, [5e-3, 1e-3, 3e-3, 1e-3])
    assert force[-1] == pytest.approx(force[100], abs=1e-12)
    assert x[-1] == x[100]


def test_loops_between_the_same_ends_are_congruent() -> None:
    device = Device(**ELEMENTS)
    histories = ([4e-3, 1e-3], [-4e-3, 1e-3], [8e-3, -8e-3, 1e-3])
    shapes = []
    for history in histories:
        _, force = walk(device, [*history, 2e-3, 1e-3, 2e-3, 1e-3])
        loop = force[-101:]
        shapes.append(loop - loop[0])
    assert np.ptp(shapes[0]) > 1.0
    for shape in shapes[1:]:
        np.testing.assert_allclose(shape, shapes[0], atol=1e-12)


def test_one_bristle_fails_these_rules() -> None:
    for device in (
        Device(friction="dahl", coulomb_force=10.0, bristle_stiffness=1e4),
        Device(friction="lugre", coulomb_force=10.0, bristle_stiffness=1e4),
        Device(friction="bouc_wen", bw_stiffness=1e4, bw_beta=500.0, bw_gamma=500.0),
    ):
        _, force = walk(device, [5e-3, 4.5e-3, 4.8e-3, 4.5e-3])
        assert abs(force[-1] - force[100]) > 0.1


def test_a_cycle_loses_the_area_of_its_loop() -> None:
    device, top = Device(**ELEMENTS), 4e-3
    x, force = walk(device, [top, -top, top], 2000)
    area = np.trapezoid(force[2000:], x[2000:])
    lost = sum(4.0 * f * max(0.0, top - f / k) for k, f in ((1e4, 4.0), (2e3, 3.0), (6e2, 3.0)))
    assert area == pytest.approx(lost, rel=1e-5)


def test_heat_is_never_negative_and_mirrored_motion_mirrors_the_force() -> None:
    rng = np.random.default_rng(8)
    for _ in range(60):
        p = draw_friction(rng, "maxwell_slip") | {"transition_velocity": 0.01}
        x, v, a, _ = draw_points(rng, 50, 1e-3)
        z = draw_states(rng, 50, p)
        one, other = Device(**p).evaluate(x, v, a, z), Device(**p).evaluate(-x, -v, -a, -z)
        for name in ("total", "friction", "state_rate"):
            np.testing.assert_array_equal(one[name], -other[name])
        said = Device(**(p | draw_levels(rng))).evaluate(x, v, a, z)
        assert np.all(said["dissipated_power"] >= -1e-12 * abs(v) * (1.0 + abs(said["total"])))


def test_the_state_of_a_force_holds_it() -> None:
    device = Device(**ELEMENTS)
    for wanted in (-9.9, -5.0, 0.0, 1e-3, 4.0, 8.0, 9.5):
        z = device.state_of_force(0.0, 0.0, 0.0, wanted)
        assert device.evaluate(0.0, 0.0, 0.0, z)["total"][0] == pytest.approx(wanted, abs=1e-12)
    beyond = device.state_of_force(0.0, 0.0, 0.0, 50.0)
    assert device.evaluate(0.0, 0.0, 0.0, beyond)["total"][0] == pytest.approx(10.0)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({}, "slip_stiffness_1 is 0 N/m, but friction is"),
        ({"slip_stiffness_1": 1e4}, "slip_stiffness_1 is 10000 N/m, but slip_force_1 is 0; give"),
        ({"slip_force_1": 2.0}, "slip_force_1 is 2 N, but slip_stiffness_1 is 0; give both"),
        (
            {"slip_stiffness_2": 1e4, "slip_force_2": 1.0},
            "slip_stiffness_2 is 10000 N/m, but slip_stiffness_1 is 0 N/m: elements are numbered",
        ),
    ],
)
def test_half_an_element_is_refused(values: dict[str, Any], message: str) -> None:
    with pytest.raises(DeviceError, match=message):
        Device(friction="maxwell_slip", **values)
    with pytest.raises(ValueError, match="slip_"):
        ReferenceDevice(friction="maxwell_slip", **values)
