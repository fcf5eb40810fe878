"""Every part of the device in the core against formulas in NumPy, and what all owe to physics.

Pointwise over random complete devices: the values themselves, the power balance, passivity, odd
symmetry, continuity in every variable.
"""

import numpy as np
import pytest
from core_draws import Parameters, draw_complete, draw_points, draw_states
from core_telling import Array, Telling
from inerter.core import Device

FORCES = ("total", "inertance", "friction")


def drawn(seed: int, count: int, points: int) -> list[tuple[Parameters, list[Array]]]:
    rng = np.random.default_rng(seed)
    found = []
    for _ in range(count):
        p = draw_complete(rng)
        x, v, a, _ = draw_points(rng, points, 1.0, 1.0)
        found.append((p, [x, v, a, draw_states(rng, points, p)]))
    return found


def test_core_is_the_telling() -> None:
    seen: set[str] = set()
    for p, points in drawn(1, 400, 60):
        found = Device(**p).evaluate(*points)
        for name, (value, size) in Telling(**p).quantities(*points).items():
            error = abs(found[name].reshape(value.shape) - value)
            assert np.all(error <= 1e-12 * size), (p, name)
        seen |= {name for name, value in p.items() if value}
    # nothing that can be drawn was left out
    assert {"backlash", "gas_law", "minor_loss", "stop_lower", "series_hardening"} <= seen


def balance(device: Device, points: list[Array]) -> tuple[Array, Array]:
    """F v - F0 v - dE/dt - heat at points, and how large its error may be.

    dE/dt forward in time, by three points: a step back would leave a contact.
    """
    x, v, a, z = points
    now = device.evaluate(x, v, a, z)
    rate = now["state_rate"].reshape(z.shape)
    step = 1e-5 / (1.0 + np.max(abs(rate), axis=1, initial=0.0) + abs(v) + abs(a))
    energy = [
        device.evaluate(x + t * v, v + t * a, a, z + t[:, np.newaxis] * rate)["stored_energy"]
        for t in (0.0 * step, step, 2.0 * step)
    ]
    growth = (-3.0 * energy[0] + 4.0 * energy[1] - energy[2]) / (2.0 * step)
    power = (now["total"] - device.force_offset) * v
    size = abs(power) + abs(growth) + abs(now["dissipated_power"])
    rounding = 1e-13 * abs(energy[0]) / step
    return power - growth - now["dissipated_power"], 1e-4 * size + 1e-8 * max(size) + rounding


def test_work_is_stored_or_turned_into_heat() -> None:
    for p, points in drawn(2, 200, 60):
        if p.get("backlash"):
            # in contact, or too far from it to get there within the difference; a gap outside its
            # range is an integrator's error, not a state of the device
            room = p["backlash"] - abs(points[3][:, -1])
            points = [value[(room == 0.0) | (room > 3e-5)] for value in points]
        rest, allowed = balance(Device(**p), points)
        # a kink within the difference of a few points is possible, in more it is an error
        assert np.sum(abs(rest) > allowed) <= 1 + 0.02 * rest.size, p


def test_heat_is_never_negative() -> None:
    for p, points in drawn(3, 400, 60):
        heat = Device(**p).evaluate(*points)["dissipated_power"]
        size = Telling(**p).quantities(*points)["dissipated_power"][1]
        assert np.all(heat >= -1e-13 * size), p


def test_mirrored_devices_have_mirrored_forces() -> None:
    # stops swapped, everything that has a direction turned round
    turned = ("inertance_gradient", "force_offset", "series_hardening", "damping_asymmetry")
    for p, (x, v, a, z) in drawn(4, 200, 40):
        p |= {"rest_length": 0.0}
        for name in [name for name in p if name.startswith("gas")]:
            del p[name]
        mirror = p | {name: -p.get(name, 0.0) for name in turned}
        for name in ("damping_knee", "damping_beyond"):
            back = p.get(f"{name}_back", p[name])
            mirror |= {name: back, f"{name}_back": p[name]}
        lower, upper = p.get("stop_lower"), p.get("stop_upper")
        for name, place in (("stop_lower", upper), ("stop_upper", lower)):
            mirror.pop(name, None)
            mirror |= {} if place is None else {name: -place}
        one, other = Device(**p).evaluate(x, v, a, z), Device(**mirror).evaluate(-x, -v, -a, -z)
        for name in (*FORCES, "state_rate"):
            np.testing.assert_allclose(one[name], -other[name], rtol=1e-13, atol=0.0)
        for name in ("stored_energy", "dissipated_power"):
            np.testing.assert_allclose(one[name], other[name], rtol=1e-13, atol=0.0)


@pytest.mark.parametrize("variable", ["x", "v", "a", "s", "w"])
def test_forces_are_continuous(variable: str) -> None:
    # along a line through the space of states: no difference of neighbours stays large when the
    # line is sampled more finely; the gap is the one variable whose sides meet with a jump
    rng = np.random.default_rng(5)
    for _ in range(60):
        # without the floor of the inertance, where R ends, and with sign(v) wide enough to resolve
        p = draw_complete(rng) | {"inertance_curvature": 20.0, "transition_velocity": 0.1}
        p["inertance_gradient"] *= 0.05
        device = Device(**p)
        names = device.state_names
        if variable in "sw" and len(names) < 2:
            continue
        x, v, a, _ = draw_points(rng, 1, 1.0, 0.5)
        start = [x, v, a, draw_states(rng, 1, p)]
        if "friction_state" in names:
            start[3][:, 0] = 0.0
        span = {"x": 0.1, "v": 4.0, "a": 100.0, "s": 0.02, "w": 4.0}[variable]
        steps = []
        for count in (1_000, 16_000):
            line = np.linspace(-span, span, count)
            points = [np.repeat(value, count, axis=0) for value in start]
            if variable in "xva":
                points["xva".index(variable)] = line
            else:
                place = "series_deflection" if variable == "s" else "flywheel_velocity"
                points[3][:, names.index(place)] = line
            found = device.evaluate(*points)
            steps.append([np.max(abs(np.diff(found[name]))) for name in (*FORCES, "stored_energy")])
        # sixteen times finer: sixteen times smaller where the slope is resolved
        for coarse, fine in zip(*steps, strict=True):
            assert fine < 0.2 * coarse + 1e-9, (p, variable, steps)


def test_a_device_with_more_than_one_state_wants_their_axis() -> None:
    device = Device(inertance=10.0, series_stiffness=1e4, friction="dahl", coulomb_force=3.0)
    assert device.state_names == ("friction_state", "series_deflection", "flywheel_velocity")
    with pytest.raises(ValueError, match=r"shape \(5,\); this device has 3 states"):
        device.evaluate(np.zeros(5), 0.0, 0.0, np.zeros(5))
    with pytest.raises(ValueError, match=r"shape \(2,\); this device has 3 states"):
        device.step(0.0, 0.0, [0.0, 0.0], 1e-3)

    # one number: the friction state, the others 0
    one = device.evaluate(np.zeros(5), 0.1, 0.0, 2e-6)
    other = device.evaluate(np.zeros(5), 0.1, 0.0, [2e-6, 0.0, 0.0])
    assert one["state_rate"].shape == (5, 3)
    np.testing.assert_array_equal(one["state_rate"], other["state_rate"])
    assert one["friction"] == pytest.approx([0.2] * 5)
    assert device.step(0.0, 0.1, [0.0, 0.0, 0.0], 1e-6).shape == (3,)


def test_state_shapes_with_one_state_and_without() -> None:
    dahl = Device(friction="dahl", coulomb_force=3.0)
    assert dahl.evaluate(np.zeros(4), 0.1, 0.0, np.zeros(4))["state_rate"].shape == (4,)
    assert dahl.evaluate(np.zeros(4), 0.1, 0.0, np.zeros((4, 1)))["state_rate"].shape == (4, 1)
    assert dahl.evaluate(0.0, 0.1, 0.0, np.zeros(4))["total"].shape == (4,)
    bare = Device(inertance=2.0)
    assert bare.state_names == ()
    assert bare.evaluate(np.zeros(4), 0.1, 0.0, 0.0)["state_rate"].shape == (4,)
    assert bare.evaluate(np.zeros(4), 0.1, 0.0, np.zeros((4, 0)))["state_rate"].shape == (4, 0)
