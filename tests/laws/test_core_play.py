"""Free play before the friction: closed forms, both tellings, energy, steps through the gap."""

from __future__ import annotations

import numpy as np
import pytest
from core_draws import (
    MEMORY,
    Array,
    Parameters,
    draw_branches,
    draw_friction,
    draw_levels,
    draw_points,
    magnitudes,
    state_limit,
)
from inerter.core import Device, DeviceError, friction_laws
from inerter.reference import Motion, ReferenceDevice, response, sum_of_sines
from test_core_along import sampled
from test_core_over_step import FORCES, Mass, not_falling

HALF = 1e-3
LEVEL, STIFFNESS = 20.0, 5e4
SHARP: dict[str, Parameters] = {
    "dahl": {"coulomb_force": LEVEL, "bristle_stiffness": STIFFNESS},
    "lugre": {"coulomb_force": LEVEL, "bristle_stiffness": STIFFNESS},
    "bouc_wen": {"bw_stiffness": STIFFNESS, "bw_beta": 2000.0, "bw_gamma": 500.0},
}
"""Loops that do not depend on speed."""


def drawn(rng: np.random.Generator, law: str, wide: float = 1.0) -> Parameters:
    """A friction law behind a play of some deflections of its bristle."""
    p = draw_friction(rng, law, wide)
    return p | {"friction_backlash": state_limit(p) * float(10.0 ** rng.uniform(-1.0, 1.0))}


def places(rng: np.random.Generator, p: Parameters, count: int) -> Array:
    """States in the gap, exactly at its edges, engaged on either side."""
    half, inside = p["friction_backlash"], rng.uniform(-1.0, 1.0, count)
    beyond = np.sign(inside) * (half + state_limit(p) * rng.uniform(0.0, 1.5, count))
    kind = rng.integers(0, 4, count)
    return np.choose(kind, [half * inside, half * np.sign(inside), beyond, beyond])


def linear(p: Parameters) -> Parameters:
    """The same limit with a Bouc-Wen exponent of 1, where steps are exact."""
    if p["friction"] != "bouc_wen":
        return p
    slope = p["bw_alpha"] / state_limit(p)
    return p | {"bw_exponent": 1.0, "bw_beta": 0.7 * slope, "bw_gamma": 0.3 * slope}


# ------------------------------ the loop ------------------------------


@pytest.mark.parametrize("law", MEMORY)
def test_a_slow_triangle_loses_the_force_over_the_play(law: str) -> None:
    # back and forth by 5 mm; the law alone, driven by the motion less the play, gives the rest
    device, alone = (
        Device(friction=law, **SHARP[law], **more) for more in ({"friction_backlash": HALF}, {})
    )
    fine, reach = 1e-6, 5e-3
    leg = np.arange(-reach, reach + fine / 2.0, fine)
    x = np.concatenate([leg, leg[-2::-1], leg[1:]])
    v = np.sign(np.diff(x, append=x[-1] + fine))
    force = device.along(1e-3, x, v, 0.0 * x, HALF)["friction"]
    back, forth = slice(leg.size, 2 * leg.size), slice(2 * leg.size, None)
    for part in (back, forth):
        # exactly 2 eps without force, to the sampling
        assert np.count_nonzero(force[part] == 0.0) * fine == pytest.approx(
            2.0 * HALF, abs=2.1 * fine
        )
    # taken out of the motion, the gap leaves the loop of the law itself
    kept = force != 0.0
    kept[np.flatnonzero(~kept)[0]] = True
    moved = np.concatenate([[0.0], np.cumsum(np.where(np.diff(force) == 0.0, 0.0, np.diff(x)))])
    without = alone.along(1e-3, moved, v, 0.0 * x, 0.0)["friction"]
    unsaturated = abs(force) < 0.999 * LEVEL
    np.testing.assert_allclose(
        force[unsaturated], without[unsaturated], atol=3.0 * STIFFNESS * fine
    )


def test_dahl_through_the_play_closed_form() -> None:
    # from -f_c: straight after ln 2 f_c / sigma0, 2 eps without force, then 1 - exp
    device = Device(friction="dahl", friction_backlash=HALF, **SHARP["dahl"])
    bristle = LEVEL / STIFFNESS
    path: Array = np.linspace(0.0, 6e-3, 601)
    s = np.array([device.step(0.0, 0.1, -HALF - bristle, each / 0.1) for each in path])
    straight, engaged = bristle * np.log(2.0), bristle * np.log(2.0) + 2.0 * HALF
    exact = np.where(path < straight, 1.0 - 2.0 * np.exp(-path / bristle), 0.0)
    exact = np.where(path > engaged, 1.0 - np.exp(-(path - engaged) / bristle), exact)
    force = device.evaluate(0.0, 0.1, 0.0, s)["friction"]
    np.testing.assert_allclose(force, LEVEL * exact, atol=1e-10)
    gap = (path > straight) & (path < engaged)
    np.testing.assert_allclose(s[gap], path[gap] - straight - HALF, atol=1e-15)


def test_the_elastic_share_of_bouc_wen_is_beside_the_play() -> None:
    p = SHARP["bouc_wen"] | {"bw_ratio": 0.3, "friction_backlash": HALF}
    device = Device(friction="bouc_wen", **p)
    x: Array = np.linspace(-2e-3, 2e-3, 9)
    found = device.evaluate(x, 0.1, 0.0, 0.5 * HALF)
    np.testing.assert_allclose(found["total"], 0.3 * STIFFNESS * x, rtol=1e-13)
    np.testing.assert_allclose(found["stored_energy"], 0.15 * STIFFNESS * x**2, rtol=1e-13)
    np.testing.assert_array_equal(found["dissipated_power"], 0.0)


# ------------------------------ both tellings ------------------------------


@pytest.mark.parametrize("law", MEMORY)
def test_core_is_the_reference(law: str) -> None:
    rng = np.random.default_rng(MEMORY.index(law))
    for _ in range(100):
        p = drawn(rng, law) | draw_branches(rng)
        if law != "bouc_wen":
            p |= draw_levels(rng)
        core, reference = Device(**p), ReferenceDevice(**p)
        x, v, a, _ = draw_points(rng, 100, 1.0)
        s = places(rng, p, 100)
        found = core.evaluate(x, v, a, s)
        load = reference.load_friction_force(v, reference.inertance_force(x, v, a), s)
        expected = {
            "friction": reference.friction_force(x, v, s, a=a) + load,
            "total": reference.force(x, v, a, s),
            "state_rate": reference.state_rate(x, v, s, a=a),
            "stored_energy": reference.stored_energy(x, v, s),
            "dissipated_power": reference.dissipated_power(x, v, a, s),
        }
        sizes = magnitudes(reference, x, v, a, s)
        for name, value in expected.items():
            # the rounding of s - eps is that of s
            assert np.all(abs(found[name] - value) <= 1e-12 * sizes[name]), (p, name)


@pytest.mark.parametrize("law", MEMORY)
def test_a_step_is_the_reference_solution(law: str) -> None:
    rng = np.random.default_rng(3)
    for _ in range(25):
        p = linear(drawn(rng, law))
        if law == "dahl":
            p["dahl_exponent"] = max(1.0, p["dahl_exponent"])
        limit, half = state_limit(p), p["friction_backlash"]
        side = float(rng.choice([-1.0, 1.0]))
        v, s = side * float(10.0 ** rng.uniform(-4.0, 0.0)), -side * (half + 0.6 * limit)
        alpha = p.get("bw_alpha", 1.0)
        time = (2.0 * half + 2.0 * limit / alpha) / abs(v) * float(rng.uniform(0.1, 1.5))

        def motion(v: float = v) -> Motion:
            return Motion(lambda t: v * t, lambda t: v + 0.0 * t, lambda t: 0.0 * t)

        run = response(
            ReferenceDevice(**p), motion(), [0.0, time], initial_state=s, rtol=1e-11,
            scan_step=time / 500.0,
        )  # fmt: skip
        size = limit + half
        assert Device(**p).step(0.0, v, s, time) == pytest.approx(run.state[-1], abs=1e-7 * size)


@pytest.mark.parametrize("law", MEMORY)
def test_two_steps_are_one(law: str) -> None:
    rng = np.random.default_rng(4)
    for _ in range(300):
        p = linear(drawn(rng, law))
        device, size = Device(**p), p["friction_backlash"] + state_limit(p)
        v, s = float(rng.normal(0.0, 0.1)), float(places(rng, p, 1)[0])
        h1, h2 = (size / abs(v) * rng.uniform(0.0, 2.0, 2)).tolist()
        twice = device.step(0.0, v, device.step(0.0, v, s, h1), h2)
        assert twice == pytest.approx(device.step(0.0, v, s, h1 + h2), abs=1e-11 * size), p


@pytest.mark.parametrize("n", [1.5, 2.0, 4.0])
def test_bouc_wen_of_any_exponent_crosses_to_second_order(n: float) -> None:
    p = {"bw_stiffness": 1e4, "bw_exponent": n, "bw_alpha": 0.8}
    limit = 4e-4
    p |= {"bw_beta": 0.7 * 0.8 / limit**n, "bw_gamma": 0.3 * 0.8 / limit**n}
    device = Device(friction="bouc_wen", friction_backlash=HALF, **p)
    ends = []
    for parts in (64, 256, 16384):
        s = -HALF - 0.9 * limit
        for _ in range(parts):
            s = device.step(0.0, 0.1, s, (2.0 * HALF + 1.6 * limit) / 0.1 / parts)
        ends.append(s)
    errors = abs(np.array(ends[:2]) - ends[2])
    assert errors[1] < errors[0] / 12.0
    assert errors[1] < 1e-4 * limit


@pytest.mark.parametrize("law", MEMORY)
def test_along_a_motion_it_is_second_order(law: str) -> None:
    p = SHARP[law] | {"friction": law, "friction_backlash": 3e-4}
    if law == "lugre":
        # a damper lets the force jump at contact: that is first order
        p |= {"static_force": 26.0, "stribeck_velocity": 5e-3}
    motion = sum_of_sines([1e-3, 4e-4], [1.0, 2.7], [0.3, 1.1])
    t = np.arange(501) * 4e-3
    exact = response(ReferenceDevice(**p), motion, t, rtol=1e-10).force
    errors = []
    for fine in (1, 4, 16):
        _, x, v, a = sampled(motion, 4e-3 / fine, 2.0)
        found = Device(**p).along(4e-3 / fine, x, v, a)["total"][::fine]
        errors.append(float(np.sqrt(np.mean((found - exact) ** 2))))
    assert np.log(errors[0] / errors[-1]) / np.log(16.0) > 1.8, errors
    assert errors[-1] < 1e-4 * LEVEL


# ------------------------------ limits ------------------------------


@pytest.mark.parametrize("law", MEMORY)
def test_less_and_less_play_is_the_law_itself(law: str) -> None:
    motion = sum_of_sines([1e-3, 4e-4], [1.0, 2.7], [0.3, 1.1])
    _, x, v, a = sampled(motion, 5e-4, 2.0)
    rigid = Device(friction=law, **SHARP[law]).along(5e-4, x, v, a)["total"]
    errors = []
    for half in (1e-4, 1e-5, 1e-6, 0.0):
        device = Device(friction=law, friction_backlash=half, **SHARP[law])
        errors.append(np.max(abs(device.along(5e-4, x, v, a)["total"] - rigid)))
    assert errors[3] == 0.0
    assert errors[0] < 2.1e-4 * STIFFNESS
    # in proportion to the play
    assert errors[1] == pytest.approx(errors[0] / 10.0, rel=0.5)
    assert errors[2] == pytest.approx(errors[1] / 10.0, rel=0.2)


@pytest.mark.parametrize("law", MEMORY)
def test_within_the_play_nothing_is_felt_however_long(law: str) -> None:
    device = Device(friction=law, friction_backlash=HALF, **SHARP[law])
    rng, s = np.random.default_rng(8), 0.0
    for _ in range(1000):
        v = float(rng.normal())
        # as far as the gap goes
        h = float(rng.uniform(0.0, 1.0)) * (HALF - np.sign(v) * s) / abs(v)
        after = device.step(0.0, v, s, h)
        assert after == pytest.approx(s + v * h, abs=1e-15)
        s = after
        for name, value in device.evaluate(0.0, v, 0.0, s).items():
            assert name == "state_rate" or value[0] == 0.0


# ------------------------------ energy ------------------------------


@pytest.mark.parametrize("law", MEMORY)
def test_heat_is_never_negative(law: str) -> None:
    # LuGre at any speed and damping: its contact does not pull
    rng = np.random.default_rng(100)
    for _ in range(100):
        p = drawn(rng, law, 2.0)
        if law == "bouc_wen":
            p["bw_gamma"] = p["bw_beta"] * rng.uniform(-1.0, 1.0)
            p["bw_ratio"] = rng.uniform(0.0, 1.0)
            p["friction_backlash"] = 1.0
        x, v, a, _ = draw_points(rng, 200, 1.0, 3.0)
        s = places(rng, p, 200)
        heat = Device(**p).evaluate(x, v, a, s)["dissipated_power"]
        size = magnitudes(ReferenceDevice(**p), x, v, a, s)["dissipated_power"]
        assert np.all(heat >= -1e-12 * size), p


def test_a_contact_never_pulls() -> None:
    p = SHARP["lugre"] | {"bristle_damping": 300.0, "friction_backlash": HALF}
    device = Device(friction="lugre", **p)
    s: Array = np.repeat(np.linspace(-2e-3, 2e-3, 401), 21)
    v: Array = np.tile(np.linspace(-1.0, 1.0, 21), 401)
    force = device.evaluate(0.0, v, 0.0, s)["total"]
    assert np.all(force * s >= 0.0)
    assert np.all(force[abs(s) < HALF] == 0.0)
    # without play it does
    assert np.any(device.replace(friction_backlash=0.0).evaluate(0.0, v, 0.0, s)["total"] * s < 0.0)


@pytest.mark.parametrize("law", MEMORY)
def test_work_done_is_stored_or_lost(law: str) -> None:
    rng = np.random.default_rng(7)
    for _ in range(20):
        p = drawn(rng, law) | {"viscous": 20.0, "stiffness": 3e3}
        if law == "dahl":
            p["dahl_exponent"] = max(0.5, p["dahl_exponent"])
        # a jump of the force at contact is beyond the trapezoid rule
        p |= {"bristle_damping": 0.0} if law == "lugre" else {}
        device, limit = Device(**p), state_limit(p) / p.get("bw_alpha", 1.0)
        path, speed, count = 3.0 * limit + 2.0 * p["friction_backlash"], 0.05, 3000
        h, start, s = path / speed / count, 1e-3, 0.0
        work = change = size = 0.0
        for v in (speed, -speed):
            x = start + v * h * np.arange(count + 1)
            states = device.along(h, x, v + 0.0 * x, 0.0 * x, s)["state"]
            points = device.evaluate(x, v, 0.0, states)
            work += np.trapezoid(points["total"], x)
            size += abs(np.trapezoid(abs(points["total"]), x))
            change += points["stored_energy"][-1] - points["stored_energy"][0]
            change += np.trapezoid(points["dissipated_power"], dx=h)
            start, s = float(x[-1]), float(states[-1])
        assert abs(work - change) < 1e-3 * size, p


@pytest.mark.parametrize("law", MEMORY)
def test_a_mass_on_it_comes_to_rest_and_gains_nothing(law: str) -> None:
    # implicit steps that do not resolve the bristle
    more: Parameters = {"bristle_damping": 50.0} if law == "lugre" else {}
    device = Device(friction=law, friction_backlash=HALF, **SHARP[law], **more)
    mass, energy = Mass(device, 0.5, v=0.3), []
    for _ in range(400):
        mass.step(5e-4)
        energy.append(mass.energy)
    assert max(np.diff(energy)) < 0.02 * 0.5 * 0.5 * 0.3**2
    assert energy[-1] < 0.05 * energy[0]


# ------------------------------ a step's force ------------------------------


@pytest.mark.parametrize("law", MEMORY)
def test_the_force_over_a_step_rises_without_jumps(law: str) -> None:
    # what makes the acceleration unique, with the damper of LuGre too
    rng = np.random.default_rng(20)
    for _ in range(40):
        p = drawn(rng, law)
        damping = p.get("bristle_damping")
        p = not_falling(p) | ({} if damping is None else {"bristle_damping": damping})
        device = Device(**p)
        # beyond the limit a bristle straightens the more, the faster it slides
        most = p["friction_backlash"] + state_limit(p)
        s = float(np.clip(places(rng, p, 1)[0], -most, most))
        h = float(10.0 ** rng.uniform(-5.0, -1.5))
        size = p["friction_backlash"] + state_limit(p)
        speeds = np.linspace(-4.0, 4.0, 801) * size / h
        found = np.array(
            [device.over_step(0.0, 0.0, v / h, s, h, 0.1)[0]["total"] for v in speeds.tolist()]
        )
        span = np.ptp(found)
        assert np.min(np.diff(found)) >= -1e-12 * (span + 1.0), (p, h)
        # no jump: halve the interval with the larger difference
        low, high = -4.0 * size / h**2, 4.0 * size / h**2

        def force(a: float, device: Device = device, s: float = s, h: float = h) -> float:
            return device.over_step(0.0, 0.0, a, s, h, 0.1)[0]["total"]

        for _ in range(45):
            middle = 0.5 * (low + high)
            first, second = abs(force(middle) - force(low)), abs(force(high) - force(middle))
            low, high = (low, middle) if first > second else (middle, high)
        assert abs(force(high) - force(low)) < 1e-6 * span + 1e-9, p


@pytest.mark.parametrize("law", MEMORY)
def test_a_short_step_is_the_force_itself(law: str) -> None:
    rng = np.random.default_rng(21)
    for _ in range(100):
        p = drawn(rng, law)
        device, s = Device(**p), float(places(rng, p, 1)[0])
        if abs(abs(s) - p["friction_backlash"]) < 1e-3 * p["friction_backlash"]:
            # at the edge LuGre's damper sets in within the step
            continue
        x, v, a = 1e-3, float(rng.normal(0.0, 0.1)), float(rng.normal())
        now = device.evaluate(x, v, a, s)
        for h, share in ((1e-8, 1e-2), (0.0, 1e-13)):
            force, end = device.over_step(x, v, a, s, h, 0.1)
            size = sum(abs(now[name][0]) for name in FORCES) + 1.0
            assert end[0] == s or h > 0.0
            assert abs(force["total"] - now["total"][0]) <= share * size, p


# ------------------------------ state of a force ------------------------------


@pytest.mark.parametrize("law", MEMORY)
def test_state_of_force_inverts_the_force(law: str) -> None:
    rng = np.random.default_rng(9)
    for _ in range(300):
        p = drawn(rng, law) | {"inertance": 50.0, "viscous": 5.0, "force_offset": 3.0}
        p |= {"bristle_damping": 0.0, "static_force": p["coulomb_force"]} if law == "lugre" else {}
        device, half = Device(**p), p["friction_backlash"]
        z = state_limit(p) * float(rng.uniform(-0.99, 0.99))
        x, v, a = 0.01 * rng.normal(), 0.1 * rng.normal(), rng.normal()
        force = float(device.evaluate(x, v, a, z + np.sign(z) * half)["total"][0])
        stiffness = p.get("bristle_stiffness") or p["bw_stiffness"] * abs(1.0 - p["bw_ratio"])
        slack = 1e-12 * (abs(force) + 50.0 * abs(a) + 100.0) / stiffness + 1e-12 * half
        assert device.state_of_force(x, v, a, force) == pytest.approx(
            z + np.sign(z) * half, abs=slack
        )


def test_state_of_force_with_a_damper_that_bears_it_all() -> None:
    # 150 N s/m at 0.1 m/s are more than the 5 N wanted: the contact is only just there
    p = SHARP["lugre"] | {"bristle_damping": 150.0, "friction_backlash": HALF}
    device = Device(friction="lugre", **p)
    assert device.state_of_force(0.0, 0.1, 0.0, 5.0) == HALF
    assert device.state_of_force(0.0, -0.1, 0.0, -5.0) == -HALF
    assert device.state_of_force(0.0, 0.1, 0.0, 0.0) == 0.0


# ------------------------------ refusals ------------------------------


@pytest.mark.parametrize("law", [law for law in friction_laws() if law not in MEMORY])
def test_a_law_without_bristle_has_no_play(law: str) -> None:
    levels: dict[str, Parameters] = {
        "none": {}, "maxwell_slip": {"slip_stiffness_1": 1e4, "slip_force_1": 5.0},
    }  # fmt: skip
    level = levels.get(law, {"coulomb_force": 5.0})
    with pytest.raises(DeviceError, match="friction_backlash is given, but friction is"):
        Device(friction=law, friction_backlash=HALF, **level)


@pytest.mark.parametrize("value", [-1e-3, float("nan"), float("inf")])
def test_a_play_that_cannot_be(value: float) -> None:
    with pytest.raises(DeviceError, match=r"friction_backlash is .*>= 0 m"):
        Device(friction="dahl", friction_backlash=value, **SHARP["dahl"])
    with pytest.raises(ValueError, match="friction_backlash"):
        ReferenceDevice(friction="dahl", friction_backlash=value, **SHARP["dahl"])
