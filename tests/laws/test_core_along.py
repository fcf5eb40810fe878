"""Devices along a sampled motion: converges to the reference, keeps rate independence, threads."""

import numpy as np
import pytest
from core_draws import (
    LAWS,
    MEMORY,
    Parameters,
    draw_branches,
    draw_flywheel,
    draw_friction,
    draw_levels,
    draw_series,
    draw_stops,
)
from curve_draws import draw_curves
from inerter.core import Device, along_many
from inerter.reference import Motion, ReferenceDevice, response, sine_motion, sum_of_sines
from map_draws import draw_map

MOTION = sum_of_sines([1e-3, 4e-4], [1.0, 2.7], [0.3, 1.1])

# laws that may have free play before them
BRISTLES = ("dahl", "lugre", "bouc_wen")

FRICTION: dict[str, Parameters] = {
    "dahl": {"coulomb_force": 20.0, "bristle_stiffness": 5e4},
    "dahl, exponent 2": {"coulomb_force": 20.0, "bristle_stiffness": 5e4, "dahl_exponent": 2.0},
    "lugre": {
        "coulomb_force": 20.0, "static_force": 26.0, "stribeck_velocity": 5e-3,
        "bristle_stiffness": 5e4, "bristle_damping": 100.0,
    },
    "bouc_wen": {"bw_stiffness": 5e4, "bw_beta": 2000.0, "bw_gamma": 500.0, "bw_ratio": 0.1},
    "bouc_wen, exponent 2": {
        "bw_stiffness": 5e4, "bw_beta": 4e6, "bw_gamma": 2e6, "bw_exponent": 2.0,
    },
    "dahl, level along the stroke": {
        "coulomb_force": 20.0, "bristle_stiffness": 5e4, "friction_gradient": 100.0,
        "friction_curvature": 2e4,
    },
}  # fmt: skip


def sampled(motion: Motion, h: float, end: float) -> tuple[np.ndarray, ...]:
    t: np.ndarray = np.arange(round(end / h) + 1) * h
    return t, *(
        np.asarray(f(t)) for f in (motion.displacement, motion.velocity, motion.acceleration)
    )


@pytest.mark.parametrize("name", FRICTION)
def test_along_is_second_order_in_the_sample_spacing(name: str) -> None:
    p = FRICTION[name] | {"friction": name.split(",")[0], "inertance": 80.0, "viscous": 10.0}
    t, *_ = sampled(MOTION, 4e-3, 2.0)
    exact = response(ReferenceDevice(**p), MOTION, t, rtol=1e-11).force
    size = np.max(abs(exact))

    errors = []
    for fine in (1, 2, 4, 8, 16):
        _, x, v, a = sampled(MOTION, 4e-3 / fine, 2.0)
        found = Device(**p).along(4e-3 / fine, x, v, a)["total"][::fine]
        errors.append(np.sqrt(np.mean((found - exact) ** 2)) / size)
    order = np.log2(errors[0] / errors[-1]) / 4.0
    assert order > 1.8, errors
    assert errors[-1] < 1e-4, errors


@pytest.mark.parametrize("law", [law for law in LAWS if law not in MEMORY])
def test_along_without_memory_is_the_force_at_each_sample(law: str) -> None:
    rng = np.random.default_rng(1)
    p = draw_friction(rng, law) | draw_branches(rng)
    t, x, v, a = sampled(MOTION, 1e-3, 1.0)
    found = Device(**p).along(1e-3, x, v, a)
    exact = response(ReferenceDevice(**p), MOTION, t).force
    np.testing.assert_allclose(found["total"], exact, rtol=1e-12, atol=1e-12 * np.max(abs(exact)))
    assert not found["state"].any()


@pytest.mark.parametrize("name", [name for name in FRICTION if not name.startswith("lugre")])
@pytest.mark.parametrize("slower", [1e-3, 1e3])
def test_dahl_and_bouc_wen_do_not_know_the_speed(name: str, slower: float) -> None:
    p = FRICTION[name] | {"friction": name.split(",")[0]}
    _, x, v, a = sampled(MOTION, 1e-3, 2.0)
    device = Device(**p)
    one = device.along(1e-3, x, v, a)
    other = device.along(1e-3 * slower, x, v / slower, a / slower**2)
    np.testing.assert_allclose(other["friction"], one["friction"], atol=1e-11)


def test_lugre_does_know_the_speed() -> None:
    p = FRICTION["lugre"] | {"friction": "lugre"}
    _, x, v, a = sampled(MOTION, 1e-3, 2.0)
    one = Device(**p).along(1e-3, x, v, a)["friction"]
    other = Device(**p).along(1.0, x, v / 1e3, a / 1e6)["friction"]
    assert np.max(abs(other - one)) > 5.0


def test_dahl_loop_closed_form() -> None:
    # the steady loop between -A and A: exponentials, tip at tanh(A sigma0 / f_c)
    reach, amplitude = 4e-4, 1e-3
    device = Device(friction="dahl", coulomb_force=20.0, bristle_stiffness=5e4)
    _, x, v, a = sampled(sine_motion(amplitude, 1.0), 1.0 / 4096.0, 5.0)
    force = device.along(1.0 / 4096.0, x, v, a)["friction"][-4096:]
    x, v = x[-4096:], v[-4096:]
    tip = np.tanh(amplitude / reach)
    up = 1.0 - (1.0 + tip) * np.exp(-(x + amplitude) / reach)
    down = -1.0 + (1.0 + tip) * np.exp((x - amplitude) / reach)
    np.testing.assert_allclose(force, 20.0 * np.where(v > 0.0, up, down), atol=2e-5)


@pytest.mark.parametrize("exponent", [1.3, 2.0, 6.0])
def test_bouc_wen_that_slides_stays_at_its_limit(exponent: float) -> None:
    device = Device(
        friction="bouc_wen", bw_stiffness=1e5, bw_exponent=exponent,
        bw_beta=0.6 * 2e4**exponent, bw_gamma=0.4 * 2e4**exponent,
    )  # fmt: skip
    limit, state = 1 / 2e4, 0.0
    for _ in range(40):
        # twelve yield distances each, and what is left of the way to the limit becomes less
        before, state = state, device.step(0.0, 0.6, state, 1e-3)
        assert abs(limit - state) <= abs(limit - before)
    assert state == pytest.approx(limit, rel=3e-14)
    assert device.step(0.0, 0.6, state, 1e-3) == state
    # and turns at once
    back = device.step(0.0, -1e-3, state, 1e-3)
    assert back == pytest.approx(state - 1e-6 * (1 + 0.2), rel=0.05)


def test_bouc_wen_without_gamma_is_dahl() -> None:
    _, x, v, a = sampled(MOTION, 1e-3, 2.0)
    dahl = Device(friction="dahl", coulomb_force=20.0, bristle_stiffness=5e4)
    other = Device(friction="bouc_wen", bw_stiffness=5e4, bw_beta=2500.0, bw_gamma=0.0)
    np.testing.assert_allclose(
        dahl.along(1e-3, x, v, a)["friction"], other.along(1e-3, x, v, a)["friction"], atol=1e-10
    )


@pytest.mark.parametrize("law", MEMORY)
def test_a_run_can_be_cut_in_two(law: str) -> None:
    # the state at the cut, handed on, continues the run bit for bit
    device = Device(friction=law, **FRICTION[law])
    _, x, v, a = sampled(MOTION, 1e-3, 1.0)
    whole = device.along(1e-3, x, v, a, state=1e-4)
    cut = 400
    tail = device.along(1e-3, x[cut:], v[cut:], a[cut:], state=float(whole["state"][cut]))
    for name in ("total", "friction", "state"):
        np.testing.assert_array_equal(tail[name], whole[name][cut:])


@pytest.mark.parametrize("threads", [None, 1, 2, 3, 7, 64])
def test_along_many_is_along_bit_for_bit(threads: int | None) -> None:
    rng = np.random.default_rng(2)
    drawn = [draw_friction(rng, law) | draw_branches(rng) for law in LAWS for _ in range(3)]
    devices = [Device(**p) for p in drawn]
    _, x, v, a = sampled(MOTION, 1e-3, 0.5)
    together = along_many(devices, 1e-3, x, v, a, threads=threads)
    assert together.shape == (len(devices), x.size)
    for row, device in zip(together, devices, strict=True):
        np.testing.assert_array_equal(row, device.along(1e-3, x, v, a)["total"])


def test_along_many_of_nothing() -> None:
    x = np.zeros(5)
    assert along_many([], 1e-3, x, x, x).shape == (0, 5)
    device = Device(inertance=1.0)
    assert along_many([device], 1e-3, x[:0], x[:0], x[:0]).shape == (1, 0)


def test_channels_of_other_lengths_are_refused() -> None:
    x = np.zeros(5)
    with pytest.raises(ValueError, match=r"\(5,\), \(4,\), \(5,\)"):
        Device(inertance=1.0).along(1e-3, x, x[:4], x)
    with pytest.raises(ValueError, match="one length"):
        along_many([Device(inertance=1.0)], 1e-3, x, x, x.reshape(1, 5))


def test_channels_of_any_kind_of_array_are_read() -> None:
    device = Device(inertance=2.0, stiffness=3.0)
    x = np.array([0, 1, 2, 3])
    found = device.along(0.1, x[::2], x[::2].astype(np.float32), x[::-2])["total"]
    np.testing.assert_array_equal(found, 3.0 * x[::2] + 2.0 * x[::-2])


@pytest.mark.parametrize("law", LAWS)
def test_along_is_its_samples_one_by_one(law: str) -> None:
    """Law by law and in blocks, along gives what step and evaluate give sample by sample."""
    rng = np.random.default_rng(3)
    friction = draw_friction(rng, law)
    beside = {"viscous": 3.0, "quadratic_damping": 2.0, "stiffness": 40.0, "stiffness_cubic": 9.0}
    device = Device(inertance=2.0, rest_length=0.3, force_offset=1.5, **beside, **friction)
    h = 1e-3
    _, x, v, a = sampled(MOTION, h, 0.7)
    x = x + 0.3
    found = device.along(h, x, v, a, state=1e-5 if device.nstate else 0.0)
    z = 1e-5
    for i in range(x.size):
        for start, end, time in (
            ways(x[i - 1 : i + 1], v[i - 1 : i + 1], h) if device.nstate else ()
        ):
            z = device.step(0.5 * (start + end), (end - start) / time, z, time)
        alone = device.evaluate(x[i], v[i], a[i], z)
        assert found["total"][i] == pytest.approx(alone["total"][0], rel=1e-13)
        assert found["friction"][i] == pytest.approx(alone["friction"][0], rel=1e-13, abs=1e-15)
        assert not device.nstate or found["state"][i] == z


def draw_beside_friction(rng: np.random.Generator, part: str) -> Parameters:
    """What is taken in blocks of samples beside a friction law."""
    if part == "curves":
        return draw_curves(rng) | draw_levels(rng)
    if part == "curves without flanks":
        return draw_curves(rng, ("inertance", "force", "friction"))
    if part == "branches and map":
        return draw_branches(rng) | draw_map(rng)
    if part == "play before friction":
        return {"friction_backlash": 10.0 ** float(rng.uniform(-5.0, -3.0))} | draw_levels(rng)
    if part == "flywheel and stops":
        return draw_flywheel(rng, bool(rng.integers(2)), True) | draw_stops(rng)
    return {"viscous": 30.0, "damping_knee": 2e-3, "damping_beyond": 0.3, "damping_asymmetry": 0.2}


def ways(x: np.ndarray, v: np.ndarray, h: float) -> list[tuple[float, float, float]]:
    """Ends and time of the way between two samples, of each part where the motion turns."""
    if x.size < 2:
        return []
    if not v[0] * v[1] < 0:
        return [(x[0], x[1], h)]
    time = h * v[0] / (v[0] - v[1])
    place = x[0] + 0.5 * v[0] * time
    if not (x[1] - place) * v[1] > 0:
        return [(x[0], x[1], h)]
    return [(x[0], place, time), (place, x[1], h - time)]


STIFF: dict[str, dict[str, float]] = {
    "dahl": {"coulomb_force": 20.0, "bristle_stiffness": 2e7},
    "dahl behind a play": {
        "coulomb_force": 20.0, "bristle_stiffness": 2e7, "friction_backlash": 1e-4,
    },
    "lugre": {
        "coulomb_force": 20.0, "bristle_stiffness": 2e7, "static_force": 20.0,
        "stribeck_velocity": 1.0, "bristle_damping": 0.0,
    },
    "bouc_wen": {"bw_alpha": 1.0, "bw_stiffness": 2e7, "bw_beta": 5e5, "bw_gamma": 5e5},
    "maxwell_slip": {
        "slip_force_1": 12.0, "slip_stiffness_1": 2e7, "slip_force_2": 8.0, "slip_stiffness_2": 5e6,
    },
}  # fmt: skip
"""Friction that yields between samples."""


def stiff(name: str) -> Device:
    return Device(friction=name.split()[0], inertance=0.0, **STIFF[name])


@pytest.mark.parametrize("name", STIFF)
def test_a_bristle_turns_where_the_motion_does(name: str) -> None:
    """Samples far apart, between which a bristle yields, are nearly as good as close ones."""
    device, fine, h = stiff(name), 64, 5e-3
    _, *close = sampled(MOTION, h / fine, 5.0)
    truth = device.along(h / fine, *close)["friction"][::fine]
    found = device.along(h, *(channel[::fine] for channel in close))["friction"]
    # at the mean velocity alone it would be 2.6 to 4 %
    assert np.sqrt(np.mean((found - truth) ** 2)) < 0.005 * np.max(np.abs(truth))


@pytest.mark.parametrize("name", STIFF)
@pytest.mark.parametrize("speed", [1e-18, 1e-30, 5e-324])
def test_a_turn_at_a_sample_is_none_between_samples(name: str, speed: float) -> None:
    """Of a motion that comes to rest in a sample, but for rounding, on either side of it."""
    h, x = 1e-3, np.array([0.0, 3.9999e-5, 3.9999e-5, 1.9e-5])
    v = np.array([0.08, -speed, speed, -0.04])
    found = stiff(name).along(h, x, v, np.zeros(4))
    rests = stiff(name).along(h, x, np.array([0.08, 0.0, 0.0, -0.04]), np.zeros(4))
    for each in ("total", "friction", "states"):
        assert np.isfinite(found[each]).all()
        np.testing.assert_allclose(found[each], rests[each], rtol=1e-9)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize(
    "part",
    [
        "curves", "curves without flanks", "branches and map", "play before friction",
        "flywheel and stops", "damper",
    ],
)  # fmt: skip
def test_parts_in_blocks_are_their_samples_one_by_one(law: str, part: str) -> None:
    rng = np.random.default_rng([5, len(part), LAWS.index(law)])
    h, (_, x, v, a) = 1e-3, sampled(MOTION, 1e-3, 0.7)
    x, v, a = 20.0 * x, 20.0 * v, 20.0 * a
    for _ in range(3):
        drawn = {"rest_length": 1e-3, **draw_friction(rng, law), **draw_beside_friction(rng, part)}
        # what a load does is taken sample by sample
        drawn.pop("load_friction", None)
        if "piston_area" not in drawn:
            drawn["inertance"] = 2.0
        if law == "none":
            drawn = {name: value for name, value in drawn.items() if "friction" not in name}
        if law not in BRISTLES:
            drawn.pop("friction_backlash", None)
        if law == "bouc_wen":
            drawn = {k: v for k, v in drawn.items() if k not in draw_levels(rng)}
        if not any(name.endswith("_curve") for name in drawn):
            drawn = {k: v for k, v in drawn.items() if k not in ("curve_lower", "curve_upper")}
        if "friction_back_curve" in drawn or "friction_back_periods" in drawn:
            drawn.pop("friction_asymmetry", None)
        device = Device(**drawn)
        found = device.along(h, x, v, a)
        z = np.zeros(device.nstate)
        for i in range(x.size):
            for start, end, time in ways(x[i - 1 : i + 1], v[i - 1 : i + 1], h):
                z = np.atleast_1d(device.step(0.5 * (start + end), (end - start) / time, z, time))
            alone = device.evaluate(x[i], v[i], a[i], z)
            size = abs(a[i]) * device.inertance + np.max(np.abs(found["total"]))
            for name in ("total", "friction"):
                assert found[name][i] == pytest.approx(alone[name][0], rel=1e-13, abs=1e-13 * size)
            np.testing.assert_allclose(found["states"][i], z, rtol=1e-12, atol=1e-300)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("backlash", [False, True])
def test_what_follows_the_motion_is_the_same_in_blocks_and_under_a_control(
    law: str, backlash: bool
) -> None:
    # a commanded device is taken sample by sample; its value is the one it has anyway
    rng = np.random.default_rng([6, backlash, LAWS.index(law)])
    h, (_, x, v, a) = 1e-3, sampled(MOTION, 1e-3, 0.7)
    for i in range(6):
        drawn = {"inertance": 2.0, **draw_friction(rng, law), **draw_series(rng, backlash)}
        drawn |= {"viscous": 30.0} | (draw_stops(rng) if i % 2 else {})
        drawn |= {"series_hardening": 20.0} if i == 4 and drawn.get("series_stiffness") else {}
        for number in range(1, i % 4 + 1):
            drawn[f"branch_stiffness_{number}"] = 10.0 ** float(rng.uniform(3.0, 5.0))
            drawn[f"branch_damping_{number}"] = 10.0 ** float(rng.uniform(1.0, 3.0))
        device = Device(**drawn)
        commanded = device.replace(control="viscous", control_lower=0.0, control_upper=99.0).along(
            h, x, v, a, command=30.0
        )
        found = device.along(h, x, v, a)
        size = float(np.max(np.abs(found["total"])))
        for name in ("total", "friction"):
            np.testing.assert_allclose(found[name], commanded[name], rtol=1e-13, atol=1e-13 * size)
        np.testing.assert_array_equal(found["states"], commanded["states"][:, : device.nstate])


SHAFT = {"inertance": 2.0, "series_stiffness": 2.0 * 60.0**2, "series_damping": 24.0}
FOLLOWING = {
    "shaft": SHAFT,
    "shaft and lossy wheel": {**SHAFT, "flywheel_viscous": 30.0},
    "dashpot": {**SHAFT, "series_damping": 2e3},
    "branch": {"branch_stiffness_1": 2e4, "branch_damping_1": 4e2},
    "quick branch": {"branch_stiffness_1": 2e4, "branch_damping_1": 4.0},
}


def impedance(device: Device, w: float) -> complex:
    """Force per velocity at a frequency [rad/s]."""
    mass = 1j * w * device.inertance + device.flywheel_viscous
    found = mass
    if device.series_stiffness:
        spring = device.series_stiffness / (1j * w) + device.series_damping
        found = mass * spring / (mass + spring)
    if device.branch_stiffness_1:
        spring = device.branch_stiffness_1 / (1j * w)
        found += device.branch_damping_1 * spring / (device.branch_damping_1 + spring)
    return found


@pytest.mark.parametrize("part", FOLLOWING)
def test_what_follows_a_motion_follows_it_closely(part: str) -> None:
    # 18 samples in a period; a cubic through two of them has an acceleration that is 1 % wrong
    device, w, errors = Device(**FOLLOWING[part]), 50.0, []
    for h in (7e-3, 3.5e-3):
        t = h * np.arange(round(7.0 / h))
        x, v, a = np.sin(w * t), w * np.cos(w * t), -(w**2) * np.sin(w * t)
        truth = (impedance(device, w) * w * np.exp(1j * w * t)).real
        late = t > 6.0
        error = device.along(h, x, v, a)["total"][late] - truth[late]
        errors.append(np.max(np.abs(error)) / np.max(np.abs(truth)))
    assert errors[0] < 1e-5
    assert errors[1] < errors[0] / 10.0


@pytest.mark.parametrize("stiffness", [1e5, 1e7, 1e9, 1e13])
@pytest.mark.parametrize("damping", [0.0, 1e3, 1e6])
@pytest.mark.parametrize("hardening", [0.0, 1.0])
def test_a_stiff_shaft_is_none(stiffness: float, damping: float, hardening: float) -> None:
    h, w = 7e-3, 50.0
    t = h * np.arange(600)
    x, v, a = np.sin(w * t), w * np.cos(w * t), -(w**2) * np.sin(w * t)
    shaft = Device(
        inertance=2.0, series_stiffness=stiffness, series_damping=damping,
        series_hardening=hardening,
    )  # fmt: skip
    # from where it does not ring
    twist = -(w**2) * 2.0 / (stiffness + 1j * w * damping - w**2 * 2.0)
    start = [twist.imag, v[0] - (1j * w * twist).imag]
    error = np.max(np.abs(shaft.along(h, x, v, a, state=start)["total"] - 2.0 * a))
    square = w**2 * 2.0 / stiffness
    assert error < (3.0 * square + 1e-9) * 2.0 * w**2


@pytest.mark.parametrize("channel", [0, 1, 2])
@pytest.mark.parametrize("value", [np.nan, -np.inf])
def test_a_motion_with_a_number_that_is_none_is_refused(channel: int, value: float) -> None:
    _, *motion = sampled(MOTION, 1e-2, 0.1)
    motion[channel][4] = value
    device = Device(inertance=2.0)
    message = f"{'xva'[channel]} is {value} at sample 4"
    with pytest.raises(ValueError, match=message):
        device.along(1e-2, *motion)
    with pytest.raises(ValueError, match=message):
        along_many([device], 1e-2, motion[0], motion[1], motion[2])


@pytest.mark.parametrize("h", [0.0, -1e-3, np.nan, np.inf])
def test_a_spacing_that_cannot_be_is_refused(h: float) -> None:
    _, *motion = sampled(MOTION, 1e-2, 0.1)
    with pytest.raises(ValueError, match=f"h is {h} s; give a finite sample spacing > 0 s"):
        Device(inertance=2.0).along(h, *motion)
