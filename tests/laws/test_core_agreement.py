"""The core and the reference, written apart from each other, say the same of every law.

Pointwise: force, state rate, stored energy, dissipated power, to 1e-12 of the terms' sizes. Then
what both owe to physics: odd symmetry, passivity, power balance.
"""

from collections.abc import Callable
from dataclasses import fields

import numpy as np
import pytest
from core_draws import (
    AGING,
    LAWS,
    MEMORY,
    SEVERAL,
    Parameters,
    draw_branches,
    draw_complete,
    draw_friction,
    draw_levels,
    draw_points,
    draw_states,
    magnitudes,
    state_limit,
)
from core_telling import Telling
from inerter.core import Device, friction_laws, parameters
from inerter.reference import FRICTION_LAWS, ReferenceDevice

TOLERANCE = 1e-12
DECLARED = {f.name: (f.default, f.metadata) for f in fields(ReferenceDevice) if f.metadata}


def reach(p: Parameters) -> float:
    return state_limit(p) if p["friction"] in MEMORY else 1e-3


def test_both_know_the_same_laws_and_parameters() -> None:
    assert tuple(friction_laws()) == tuple(FRICTION_LAWS)
    assert sorted(FRICTION_LAWS) == sorted(LAWS + SEVERAL + AGING)
    assert set(parameters()) == set(DECLARED)


@pytest.mark.parametrize("name", parameters())
def test_both_declare_the_same_unit_default_and_bounds(name: str) -> None:
    core, (default, said) = parameters()[name], DECLARED[name]
    unit = "1" if said["unit"] == "-" else said["unit"].replace(" ", "*")
    assert unit == core.unit
    np.testing.assert_equal(default, core.initial)
    assert core.lower_open == (said["above"] is not None)
    lower = said["above"] if core.lower_open else said["at_least"]
    assert (-np.inf if lower is None else lower) == core.lower
    assert (np.inf if said["at_most"] is None else said["at_most"]) == core.upper


def around_the_bounds(name: str) -> list[float]:
    """At, just inside and just outside each bound of a parameter."""
    core = parameters()[name]
    found = []
    for bound in (core.lower, core.upper):
        if np.isfinite(bound):
            near = 1e-9 * max(abs(bound), 1.0)
            found += [bound - near, bound, bound + near]
    return [*found, np.inf, np.nan]


def accepts(make: Callable[..., object], given: Parameters) -> bool:
    try:
        make(**given)
    except ValueError:
        return False
    return True


# parts without which one of their parameters is a mistake in itself
SERIES = {"series_stiffness": 1e5, "series_damping": 10.0}
STOPS = {"stop_lower": -0.01, "stop_upper": 0.01, "stop_stiffness": 1e5}
GAS = {"gas_pressure": 1e5, "gas_area": 1e-3, "gas_volume": 2e-5}
CHANNEL = {"piston_area": 1.6e-3, "channel_area": 1e-4, "channel_length": 1.7}


def beside(name: str) -> Parameters:
    """The part that a parameter is of."""
    if name.startswith("gas_"):
        return GAS
    if name.startswith("stop_"):
        return STOPS
    if name.startswith(("series_", "backlash")):
        return SERIES
    fluid = name.startswith(("piston_", "channel_", "fluid_", "minor_"))
    return CHANNEL if fluid else {}


@pytest.mark.parametrize("law", LAWS)
def test_both_take_and_refuse_the_same_values(law: str) -> None:
    rng = np.random.default_rng(LAWS.index(law))
    base = draw_friction(rng, law) | draw_branches(rng)
    both = 0
    for name, known in parameters().items():
        if known.laws and law not in known.laws:
            continue
        for value in around_the_bounds(name):
            # a parameter that is not a number is one that is not given, to the reference
            if np.isnan(value) and np.isnan(known.initial):
                continue
            given = base | beside(name) | {name: value}
            if beside(name) is CHANNEL:
                del given["inertance"]
            taken = accepts(Device, given)
            assert taken == accepts(ReferenceDevice, given), (name, value)
            both += taken
    assert both > 10


@pytest.mark.parametrize("law", LAWS)
def test_both_say_the_same_of_a_device_with_next_to_nothing_given(law: str) -> None:
    """Each parameter but the level left to its default: what is not given is the same in both."""
    rng = np.random.default_rng(100 + LAWS.index(law))
    least = {"bouc_wen": {"bw_stiffness": 2e4}, "none": {}}.get(law, {"coulomb_force": 10.0})
    needed = {"friction", *least}
    drawn = draw_friction(rng, law)
    for left in (None, *(name for name in sorted(drawn) if name not in needed)):
        each = {"friction": law, **least} if left is None else {**drawn}
        each.pop(left or "", None)
        core, reference = Device(**each), ReferenceDevice(**each)
        x, v, a, z = draw_points(rng, 40, 1e-3, 2.0)
        found = core.evaluate(x, v, a, z)
        sizes = magnitudes(reference, x, v, a, z)
        error = abs(found["total"] - reference.force(x, v, a, z))
        assert np.all(error <= TOLERANCE * sizes["total"]), (each, error.max())
        rates = abs(found["state_rate"] - reference.state_rate(x, v, z))
        assert np.all(rates <= TOLERANCE * sizes["state_rate"]), each


@pytest.mark.parametrize("wide", [1.0, 3.0], ids=["usual", "extreme"])
@pytest.mark.parametrize("law", LAWS)
def test_core_is_the_reference(law: str, wide: float) -> None:
    rng = np.random.default_rng([LAWS.index(law), int(wide)])
    for _ in range(60):
        p = draw_friction(rng, law, wide) | draw_branches(rng, wide)
        if law not in ("none", "bouc_wen"):
            p |= draw_levels(rng)
        core, reference = Device(**p), ReferenceDevice(**p)
        x, v, a, z = draw_points(rng, 100, reach(p), 2.0 * wide)

        found = core.evaluate(x, v, a, z)
        carried = reference.inertance_force(x, v, a)
        load = reference.load_friction_force(v, carried, z)
        expected = {
            "inertance": carried,
            "friction": reference.friction_force(x, v, z, a=a) + load,
            "total": reference.force(x, v, a, z),
            "state_rate": reference.state_rate(x, v, z, a=a),
            "stored_energy": reference.stored_energy(x, v, z),
            "dissipated_power": reference.dissipated_power(x, v, a, z),
        }
        sizes = magnitudes(reference, x, v, a, z)
        assert set(found) == set(expected)
        for name, value in expected.items():
            error = abs(found[name] - value)
            assert np.all(error <= TOLERANCE * sizes[name]), (p, name, error.max())


def test_core_is_the_reference_of_the_complete_device() -> None:
    # series element, backlash, stops, gas, channel, speed gradient; the gap inside and at its sides
    rng = np.random.default_rng(11)
    for _ in range(300):
        p = draw_complete(rng)
        core, reference = Device(**p), ReferenceDevice(**p)
        assert core.state_names == reference.state_names
        x, v, a, _ = draw_points(rng, 60, 1.0, 1.0)
        z = draw_states(rng, 60, p)
        if p.get("backlash"):
            z[:, -1] = np.clip(z[:, -1], -p["backlash"], p["backlash"])
        state = reference.state_argument(z)

        found = core.evaluate(x, v, a, z)
        expected = {
            "inertance": reference.inertance_force(x, v, a, state),
            "friction": reference.total_friction(x, v, a, state),
            "total": reference.force(x, v, a, state),
            "state_rate": reference.state_rate(x, v, state, a=a),
            "stored_energy": reference.stored_energy(x, v, state),
            "dissipated_power": reference.dissipated_power(x, v, a, state),
        }
        sizes = Telling(**p).quantities(x, v, a, z)
        for name, value in expected.items():
            size = sizes[name][1]
            if core.nstate == 0 and name == "state_rate":
                continue
            error = abs(found[name].reshape(size.shape) - np.reshape(value, size.shape))
            assert np.all(error <= TOLERANCE * size), (p, name, error.max())


@pytest.mark.parametrize("law", LAWS)
def test_mirrored_motion_gives_the_mirrored_force(law: str) -> None:
    # without offset, rest length, asymmetry and gradient: bit for bit
    rng = np.random.default_rng(LAWS.index(law))
    for _ in range(20):
        p = draw_friction(rng, law) | draw_branches(rng)
        uneven = ("rest_length", "force_offset", "inertance_gradient", "damping_asymmetry")
        even = {name: value for name, value in p.items() if not name.endswith("_back")}
        device = Device(**(even | dict.fromkeys(uneven, 0.0)))
        x, v, a, z = draw_points(rng, 100, reach(p))
        one, other = device.evaluate(x, v, a, z), device.evaluate(-x, -v, -a, -z)
        for name in ("total", "inertance", "friction", "state_rate"):
            np.testing.assert_array_equal(one[name], -other[name])
        for name in ("stored_energy", "dissipated_power"):
            np.testing.assert_array_equal(one[name], other[name])
        for point in zip(x, v, z, strict=True):
            xi, vi, zi = map(float, point)
            assert device.step(xi, vi, zi, 1e-3) == -device.step(-xi, -vi, -zi, 1e-3)


@pytest.mark.parametrize("law", LAWS)
def test_heat_is_never_negative_where_the_law_is_passive(law: str) -> None:
    rng = np.random.default_rng(100 + LAWS.index(law))
    for _ in range(60):
        p = draw_friction(rng, law, 2.0) | draw_branches(rng)
        start = reach(p)
        if law == "bouc_wen":
            # passive for beta >= |gamma|, 0 <= A <= 1
            p["bw_gamma"] = p["bw_beta"] * rng.uniform(-1.0, 1.0)
            p["bw_ratio"] = rng.uniform(0.0, 1.0)
        elif law != "none":
            p |= draw_levels(rng)
        device, reference = Device(**p), ReferenceDevice(**p)
        x, v, a, z = draw_points(rng, 100, start)
        heat = device.evaluate(x, v, a, z)["dissipated_power"]
        allowed = np.ones_like(v, dtype=bool)
        if law == "lugre":
            # passive for sigma1 <= 4 g / |v|; the smallest g is what f_c leaves
            level = reference.coulomb_force * np.asarray(level_of(p, x - reference.rest_length, v))
            allowed = p["bristle_damping"] * abs(v) <= 4.0 * level
            assert allowed.any()
        rounding = TOLERANCE * magnitudes(reference, x, v, a, z)["dissipated_power"]
        assert np.all((heat >= -rounding)[allowed]), p


def level_of(p: Parameters, x: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Factor on the friction level, as plugin_c/core/friction.h states it."""
    direction = 1.0 + p["friction_asymmetry"] * np.tanh(v / p["transition_velocity"])
    along = 1.0 + p["friction_gradient"] * x + p["friction_curvature"] * x**2
    return direction * np.maximum(1e-3, along)


def test_a_bouc_wen_outside_the_passive_range_is_known_to_create_energy() -> None:
    # gamma > beta: unloading stiffer than loading; the header's limit is not there for nothing
    device = Device(friction="bouc_wen", bw_stiffness=1e4, bw_beta=1.0, bw_gamma=900.0)
    heat = device.evaluate(0.0, [1.0, -1.0], 0.0, 1e-3)["dissipated_power"]
    assert heat[0] > 0.0 > heat[1]


@pytest.mark.parametrize("law", MEMORY)
def test_work_done_is_stored_or_lost(law: str) -> None:
    # forth and back at constant speed; integral of F dx = stored + lost, by the trapezoid rule
    rng = np.random.default_rng(7)
    for _ in range(20):
        p = draw_friction(rng, law) | {"viscous": 20.0, "stiffness": 3e3}
        if law == "dahl":
            # below 1/2 the corner at the end of sliding is too sharp for the trapezoid rule
            p["dahl_exponent"] = max(0.5, p["dahl_exponent"])
        device, limit = Device(**p), state_limit(p)
        if law == "bouc_wen":
            limit /= p["bw_alpha"]
        path, speed, count = 3.0 * limit, 0.05, 500
        h, x, z = path / speed / count, 1e-3, 0.0
        work = change = size = 0.0
        for v in (speed, -speed):
            for _ in range(count):
                after = device.step(x, v, z, h)
                points = device.evaluate([x, x + h * v], v, 0.0, [z, after])
                work += points["total"].mean() * h * v
                size += abs(points["total"]).mean() * h * speed
                change += np.diff(points["stored_energy"])[0]
                change += points["dissipated_power"].mean() * h
                x, z = x + h * v, after
        assert abs(work - change) < 2e-4 * size, p


def test_shapes_and_scalars() -> None:
    device = Device(inertance=2.0, friction="coulomb", coulomb_force=1.0)
    assert device.evaluate(0.0, 0.0, 3.0, 0.0)["total"].tolist() == [6.0]
    assert device.evaluate(0.0, [1.0, -1.0], 3.0, 0.0)["total"].tolist() == [7.0, 5.0]
    assert device.evaluate(np.zeros((2, 3)), 0.0, 1.0, 0.0)["total"].shape == (2, 3)
