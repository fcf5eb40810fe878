"""Load friction of laws with memory: the load raises the level at which a bristle yields."""

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from core_draws import LAWS as ALL_LAWS
from core_draws import (
    MEMORY,
    draw_branches,
    draw_friction,
    draw_levels,
    draw_points,
    draw_series,
    draw_states,
)
from inerter.core import Device, DeviceError
from inerter.exudyn import device as element
from inerter.exudyn.friction import bouc_wen
from inerter.exudyn.functions import NUMBERS
from inerter.exudyn.parameters import Parameters
from inerter.reference import ReferenceDevice
from inerter.reference.motion import Motion, response

B = 50.0
LAWS: dict[str, dict[str, Any]] = {
    "dahl": {"coulomb_force": 10.0, "bristle_stiffness": 1e5},
    "lugre": {"coulomb_force": 10.0, "bristle_stiffness": 1e5, "bristle_damping": 30.0},
    "bouc_wen": {
        "bw_stiffness": 1e5, "bw_alpha": 1.0, "bw_beta": 6e3, "bw_gamma": 4e3, "bw_exponent": 1.0,
    },
    "maxwell_slip": {
        "slip_stiffness_1": 6e4, "slip_force_1": 3.0, "slip_stiffness_2": 4e4, "slip_force_2": 7.0,
    },
}  # fmt: skip
"""Each yields at 10 N, with a stiffness of 1e5 N/m before."""

LEVEL = {
    "dahl": ("coulomb_force",),
    "lugre": ("coulomb_force",),
    "maxwell_slip": ("slip_force_1", "slip_force_2"),
}


def device(law: str, **others: Any) -> Device:
    return Device(inertance=B, friction=law, **LAWS[law], **others)


@pytest.mark.parametrize("law", LAWS)
def test_steady_sliding_is_at_the_level_of_the_load(law: str) -> None:
    """By hand: f_c + mu b |a|, mu by the direction of power."""
    made = device(law, mu_forward=0.3, mu_backward=0.2)
    for v, a, mu in ((0.2, 3.0, 0.3), (0.2, -3.0, 0.2), (-0.2, 3.0, 0.2), (-0.2, -3.0, 0.3)):
        z = made.step(0.0, v, np.zeros(made.nstate), 10.0, a=a)
        said = made.evaluate(0.0, v, a, z[np.newaxis])
        assert said["friction"][0] == pytest.approx(np.sign(v) * (10.0 + mu * B * 3.0), rel=1e-9)


@pytest.mark.parametrize("law", LEVEL)
def test_a_constant_load_is_a_higher_level(law: str) -> None:
    """Loops under a preload are those of the law with that level, at every point."""
    a, mu = 4.0, 0.25
    loaded = device(law, load_friction=mu)
    level = 1.0 + mu * B * a / 10.0
    higher = {name: level * LAWS[law][name] for name in LEVEL[law]}
    plain = Device(inertance=B, friction=law, **{**LAWS[law], **higher})
    x = 3e-4 * np.concatenate(
        [np.linspace(0, 1, 40), np.linspace(1, -0.6, 60), np.linspace(-0.6, 0.9, 60)]
    )
    one = other = np.zeros(loaded.nstate)
    for before, after in pairwise(x):
        v = (after - before) / 1e-3
        one, other = loaded.step(before, v, one, 1e-3, a=a), plain.step(before, v, other, 1e-3)
        np.testing.assert_allclose(one, other, rtol=1e-12, atol=1e-18)
        found = [
            each.evaluate(after, v, a, z[np.newaxis])["friction"][0]
            for each, z in ((loaded, one), (plain, other))
        ]
        assert found[0] == pytest.approx(found[1], rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("law", LAWS)
def test_the_stiffness_before_sliding_is_that_without_a_load(law: str) -> None:
    for mu in (0.0, 0.5):
        made = device(law, load_friction=mu)
        z = made.step(0.0, 1e-6, np.zeros(made.nstate), 1e-3, a=5.0)
        assert made.evaluate(0.0, 0.0, 0.0, z[np.newaxis])["friction"][0] == pytest.approx(
            1e-4, rel=1e-4
        )


@pytest.mark.parametrize("law", LAWS)
def test_no_load_is_the_law_itself_bit_for_bit(law: str) -> None:
    rng = np.random.default_rng(3)
    x, v, a, z = draw_points(rng, 50, 1e-4)
    for given in ({}, {"bristle_damping": 0.0} if law == "lugre" else {}):
        p = {**LAWS[law], **given}
        states = np.stack([z] * Device(friction=law, **p).nstate, axis=1)
        plain = Device(inertance=0.0, friction=law, **p).evaluate(x, v, a, states)
        # a load of nothing: no inertance, so that nothing goes through it
        loaded = Device(inertance=0.0, friction=law, load_friction=0.5, **p).evaluate(
            x, v, a, states
        )
        for name, value in plain.items():
            np.testing.assert_array_equal(value, loaded[name])


def drawn(rng: np.random.Generator, law: str, side: str) -> dict[str, Any]:
    p: dict[str, Any] = {"friction": law, **LAWS[law]} | draw_branches(rng)
    p.pop("load_friction")
    p |= {"mu_forward": float(rng.uniform(0.0, 2.0)), "mu_backward": float(rng.uniform(0.0, 0.9))}
    if law != "bouc_wen":
        p |= draw_levels(rng)
    if law == "lugre":
        p |= {"static_force": 14.0, "stribeck_velocity": 0.05}
    if side:
        p |= draw_series(rng, backlash=bool(rng.random() < 0.5)) | {"friction_side": side}
    if law != "maxwell_slip" and rng.random() < 0.3:
        p["friction_backlash"] = 2e-5
    return p


@pytest.mark.parametrize("side", ["", "terminals", "flywheel"])
@pytest.mark.parametrize("law", LAWS)
def test_three_tellings_agree_and_are_passive(law: str, side: str) -> None:
    rng = np.random.default_rng([list(LAWS).index(law), len(side)])
    for _ in range(40):
        p = drawn(rng, law, side)
        core, reference = Device(**p), ReferenceDevice(**p)
        x, v, a, _ = draw_points(rng, 40, 1.0, 1.0)
        z = draw_states(rng, 40, p)
        if p.get("backlash"):
            z[:, -1] = np.clip(z[:, -1], -p["backlash"], p["backlash"])
            if not p["series_damping"]:
                z[:, -1] = np.clip(z[:, -3], -p["backlash"], p["backlash"])
        said, state = core.evaluate(x, v, a, z), reference.state_argument(z)
        expected = {
            "inertance": reference.inertance_force(x, v, a, state),
            "friction": reference.total_friction(x, v, a, state),
            "total": reference.force(x, v, a, state),
            "dissipated_power": reference.dissipated_power(x, v, a, state),
            "state_rate": reference.state_rate(x, v, state, a=a),
        }
        scale = 1.0 + abs(said["inertance"]) + abs(said["friction"]) + abs(said["total"])
        for name, value in expected.items():
            size = scale * (1.0 + abs(v)) if name == "dissipated_power" else scale
            size = size[:, np.newaxis] if name == "state_rate" else size
            size = size * (1e4 if name == "state_rate" else 10.0)
            error = abs(np.reshape(value, said[name].shape) - said[name])
            error = error.reshape(len(x), -1)
            size = np.reshape(size, (len(x), -1))
            assert np.all(error <= 1e-11 * size), (p, name, error.max())
        parameters = Parameters.of(core)
        for i in range(len(x)):
            at = float(x[i] - core.rest_length), float(v[i]), float(a[i])
            told = element.forces(parameters, *at, z[i].tolist())
            for name, value in told.items():
                assert value == pytest.approx(said[name][i], rel=1e-10, abs=1e-11 * scale[i] * 10)
        # LuGre's damper may give while its bristle straightens, as without a load
        if law != "lugre":
            assert np.all(said["dissipated_power"] >= -1e-11 * scale * (1.0 + abs(v)) * 10.0)


@pytest.mark.parametrize("law", LAWS)
def test_a_load_that_pumps_gets_nothing(law: str) -> None:
    """Bent under no load and let go under a large one, over and over: nothing is gained."""
    made = device(law, load_friction=0.9)
    z, work = np.zeros(made.nstate), 0.0
    for k in range(400):
        v = 0.05 if k // 10 % 2 == 0 else -0.05
        a = 0.0 if v > 0 else 40.0 * np.sin(k)
        before = made.evaluate(0.0, v, 0.0, z[np.newaxis])["friction"][0]
        z = made.step(0.0, v, z, 1e-5, a=a)
        after = made.evaluate(0.0, v, 0.0, z[np.newaxis])["friction"][0]
        work += 0.5 * (before + after) * v * 1e-5
        assert work >= -1e-6


@pytest.mark.parametrize("exponent", [1.0, 3.4])
@pytest.mark.parametrize("beta", [0.0, 0.3])
def test_a_load_that_falls_lets_no_bouc_wen_run_away(exponent: float, beta: float) -> None:
    """With gamma > beta the way back from above the level has the slope that it has at the level.

    By itself z' = v (alpha - (gamma - beta) |z|^n / level^n) leaves every bound there.
    """
    bound = 1e-4
    narrow = bound**-exponent
    law = {
        "bw_stiffness": 1e5, "bw_alpha": 1.0, "bw_exponent": exponent,
        "bw_beta": beta * narrow, "bw_gamma": (1.0 - beta) * narrow,
    }  # fmt: skip
    made = Device(inertance=B, friction="bouc_wen", load_friction=0.9, **law)
    reference = ReferenceDevice(inertance=B, friction="bouc_wen", load_friction=0.9, **law)
    z = np.array([[-30.0 * bound], [-1.01 * bound], [-0.99 * bound], [-0.5 * bound]])
    x, v, a = np.zeros(4), np.full(4, 0.1), np.zeros(4)
    rate = made.evaluate(x, v, a, z)["state_rate"]
    inside = 1.0 - (1.0 - 2.0 * beta) * np.minimum(-z[:, 0] / bound, 1.0) ** exponent
    assert rate[:, 0] == pytest.approx(0.1 * inside, rel=1e-12, abs=1e-15)
    told = reference.state_rate(x, v, reference.state_argument(z), a=a)
    assert np.reshape(told, rate.shape) == pytest.approx(rate, rel=1e-12, abs=1e-15)
    for i in range(4):
        one = bouc_wen(NUMBERS, Parameters.of(made), 0.0, 0.1, float(z[i, 0]))
        assert one.rate == pytest.approx(rate[i, 0], rel=1e-12, abs=1e-15)
    # bent under a load that is gone when it goes back, along samples and step by step
    t = np.arange(0.0, 2.0, 5e-4)
    motion = 0.02 * np.sin(7.0 * t), 0.14 * np.cos(7.0 * t), 8.0 * np.sin(13.0 * t)
    states = made.along(t[1], *motion, np.zeros(1))["states"]
    highest = bound * (1.0 + 0.9 * B * 8.0 / 10.0)
    assert np.all(abs(states) <= highest)
    assert abs(states).max() > 5.0 * bound
    now = np.zeros(1)
    for k in range(400):
        pressed = k % 20 < 10
        now = made.step(0.0, -0.2 if pressed else 0.2, now, 5e-4, a=8.0 * pressed)
        assert np.all(abs(now) <= highest)


@pytest.mark.parametrize("exponent", [1.0, 2.6])
def test_from_above_its_level_bouc_wen_comes_back_and_crosses_its_play(exponent: float) -> None:
    """One step is as many short ones, through the level, the play and the other side."""
    narrow = 1e-4**-exponent
    made = Device(
        inertance=B, friction="bouc_wen", load_friction=0.9, friction_backlash=2e-4,
        bw_stiffness=1e5, bw_alpha=1.0, bw_exponent=exponent,
        bw_beta=0.3 * narrow, bw_gamma=0.7 * narrow,
    )  # fmt: skip
    start = made.step(0.0, -0.1, np.zeros(1), 0.02, a=8.0)
    assert start[0] < -1e-3
    for path in (3e-4, 2e-3, 3.2e-3, 4e-3):
        many, count = start, 4000
        for _ in range(count):
            many = made.step(0.0, 0.1, many, path / 0.1 / count, a=0.0)
        once = made.step(0.0, 0.1, start, path / 0.1, a=0.0)
        assert once == pytest.approx(many, abs=1e-12 if exponent == 1.0 else 1e-6)


@pytest.mark.parametrize("law", [law for law in LAWS if law != "maxwell_slip"])
def test_along_a_motion_core_and_reference_agree_to_second_order(law: str) -> None:
    made = device(law, load_friction=0.3)
    omega, size = 2 * np.pi * 3.0, 2e-3
    motion = Motion(
        lambda t: size * np.sin(omega * t),
        lambda t: size * omega * np.cos(omega * t),
        lambda t: -size * omega**2 * np.sin(omega * t),
    )
    reference = ReferenceDevice(**made.given)  # pyright: ignore[reportArgumentType]
    errors = []
    for h in (4e-4, 1e-4):
        t = np.arange(0.0, 0.6, h)
        true = response(reference, motion, t[::40], rtol=1e-9)
        x, v, a = motion.displacement(t), motion.velocity(t), motion.acceleration(t)
        found = made.along(h, x, v, a)["total"][::40]
        errors.append(np.sqrt(np.mean((found - true.force) ** 2)) / np.sqrt(np.mean(true.force**2)))
    assert errors[1] < 1e-3
    assert errors[1] < errors[0] / 6.0


def return_mapping(t: np.ndarray, mu: float, omega: float, size: float) -> np.ndarray:
    """Friction of springs held to a limit that moves with the load, in the steps of t."""
    law = LAWS["maxwell_slip"]
    stiffness, slip = (
        np.array([law[f"slip_{what}_{i}"] for i in (1, 2)]) for what in ("stiffness", "force")
    )
    x, a = size * np.sin(omega * t), -size * omega**2 * np.sin(omega * t)
    z, friction = np.zeros(2), np.zeros(t.size)
    for i in range(1, t.size):
        path = x[i] - x[i - 1]
        load = mu * B * abs(a[i] + a[i - 1]) / 2.0
        limit = slip * (1.0 + load / slip.sum()) / stiffness
        q = np.sign(path) * z
        beyond = limit + (q - limit) * np.exp(-abs(path) / limit)
        z = np.sign(path) * np.where(q > limit, beyond, np.minimum(q + abs(path), limit))
        friction[i] = stiffness @ z
    return friction


def test_along_a_motion_maxwell_slip_is_its_return_mapping() -> None:
    """In steps far below those of the record."""
    mu, omega, size, parts, h = 0.3, 2 * np.pi * 3.0, 2e-3, 20, 1e-4
    t = np.arange(0.0, 0.4, h / parts)
    friction = return_mapping(t, mu, omega, size)
    made, rows = device("maxwell_slip", load_friction=mu), slice(None, None, parts)
    x, v = size * np.sin(omega * t[rows]), size * omega * np.cos(omega * t[rows])
    found = made.along(h, x, v, -(omega**2) * x)["friction"]
    assert np.abs(found - friction[rows]).max() < 2e-3 * np.abs(friction).max()


def test_a_knee_of_maxwell_slip_is_off_by_its_share_of_the_force() -> None:
    """What the truth of `inerter validate` is integrated with, where a limit holds an element."""
    mu, omega, size, h = 0.3, 2 * np.pi * 3.0, 2e-3, 5e-6
    t = np.arange(0.0, 0.15, h)
    friction = return_mapping(t, mu, omega, size)
    motion = Motion(
        lambda t: size * np.sin(omega * t),
        lambda t: size * omega * np.cos(omega * t),
        lambda t: -size * omega**2 * np.sin(omega * t),
    )
    rows = slice(None, None, 200)
    reference = ReferenceDevice(**device("maxwell_slip", load_friction=mu).given)  # pyright: ignore[reportArgumentType]
    off = []
    for knee in (1e-2, 1e-3):
        z = response(reference.with_knee(knee), motion, t[rows], method="Radau", rtol=1e-7).states
        found = z @ [LAWS["maxwell_slip"][f"slip_stiffness_{i}"] for i in (1, 2)]
        off.append(np.abs(found - friction[rows]).max() / np.abs(friction).max())
    assert off[1] < 1.5e-3
    assert off[1] < off[0] / 5.0


def test_efficiency_of_a_screw_with_a_bristle() -> None:
    lead, rubbing = np.radians(12.0), np.radians(3.0)
    mu_forward = np.tan(lead + rubbing) / np.tan(lead) - 1.0
    mu_backward = 1.0 - np.tan(lead - rubbing) / np.tan(lead)
    screw = Device(
        inertance=B, friction="dahl", coulomb_force=1e-9, bristle_stiffness=1e6,
        mu_forward=mu_forward, mu_backward=mu_backward,
    )  # fmt: skip
    for v, a in ((0.2, 3.0), (-0.2, -3.0), (0.2, -3.0), (-0.2, 3.0)):
        z = screw.step(0.0, v, 0.0, 10.0, a=a)
        said = screw.evaluate(0.0, v, a, z)
        ratio = said["inertance"][0] / said["total"][0]
        if v * a > 0:
            assert ratio == pytest.approx(np.tan(lead) / np.tan(lead + rubbing), rel=1e-8)
        else:
            assert 1.0 / ratio == pytest.approx(np.tan(lead - rubbing) / np.tan(lead), rel=1e-8)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("shaft", [{}, {"series_stiffness": 5e4, "series_damping": 50.0}])
@pytest.mark.parametrize("side", ["terminals", "flywheel"])
def test_over_a_step_the_force_does_not_fall_with_the_acceleration(
    law: str, shaft: dict[str, float], side: str
) -> None:
    made = device(law, mu_forward=0.5, mu_backward=0.7, friction_side=side, **shaft)
    nfriction = made.nstate - 2 * bool(shaft)
    for v in (-0.3, -1e-3, 0.0, 1e-3, 0.3):
        for share in (-1.0, 0.0, 1.0):
            z = [share * 5e-5] * nfriction + ([1e-3 * share, v] if shaft else [])
            force = [
                made.over_step(0.0, v, a, z, 1e-3, 0.01)[0]["total"]
                for a in np.linspace(-50.0, 50.0, 201)
            ]
            assert np.all(np.diff(force) >= -1e-8), (v, share)


def test_age_and_smooth_laws_scale_with_the_load() -> None:
    """Each has its own shape: (f_c + mu |N|) in place of f_c."""
    v, a, mu = 0.01, 3.0, 0.2
    for law, shape in (
        ("rate_state", {"rate_effect": 0.03, "age_effect": 0.02, "rate_velocity": 1e-2}),
        ("brown_mcphee", {"stribeck_velocity": 0.05}),
        ("coulomb", {}),
    ):
        loaded = Device(inertance=B, friction=law, coulomb_force=10.0, load_friction=mu, **shape)
        plain = Device(inertance=B, friction=law, coulomb_force=10.0 + mu * B * a, **shape)
        z = 0.7 if law == "rate_state" else 0.0
        one, other = (each.evaluate(0.0, v, a, z)["total"][0] for each in (loaded, plain))
        assert one == pytest.approx(other, rel=1e-13)


@pytest.mark.parametrize("law", [law for law in ALL_LAWS if law not in (*MEMORY, "none")])
def test_a_load_has_the_shape_of_every_law_without_a_state(law: str) -> None:
    """f_c + mu |N| in place of f_c, f_s as much higher, at speeds above and below what bends it."""
    rng = np.random.default_rng(4)
    for _ in range(20):
        p, mu = draw_friction(rng, law), rng.uniform(0.0, 0.9)
        v, a = 10.0 ** rng.uniform(-5.0, 0.0) * rng.choice([-1.0, 1.0]), rng.normal(0.0, 3.0)
        more = mu * B * abs(a)
        higher = {k: p[k] + more for k in ("coulomb_force", "static_force") if k in p}
        for telling in (
            lambda **keys: Device(**keys).evaluate(0.0, v, a, 0.0)["total"][0],  # noqa: B023
            lambda **keys: ReferenceDevice(**keys).force(0.0, v, a),  # noqa: B023
        ):
            loaded = telling(inertance=B, **p, load_friction=mu)
            plain = telling(inertance=B, **p | higher)
            assert loaded == pytest.approx(plain, rel=1e-12, abs=1e-12 * B)


def test_what_does_not_fit_is_refused() -> None:
    with pytest.raises(
        DeviceError, match=r"bw_beta \+ bw_gamma is -10: this bouc_wen never yields"
    ):
        device("bouc_wen", load_friction=0.2).replace(bw_beta=-20.0, bw_gamma=10.0)
    with pytest.raises(DeviceError, match="bw_ratio is 1: no share of this bouc_wen yields"):
        device("bouc_wen", load_friction=0.2, bw_ratio=1.0)
    with pytest.raises(ValueError, match="never yields"):
        ReferenceDevice(friction="bouc_wen", bw_stiffness=1.0, bw_beta=-1.0, load_friction=0.1)
