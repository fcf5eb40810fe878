"""Friction behind the series element: eq. (9) of Wang & Su 2008, and what follows from it.

That the tellings agree, that heat is never negative and that work is stored or lost is asked of
random devices with friction on either side in test_core_agreement.py and test_core_parts.py.
"""

from typing import Any

import numpy as np
import pytest
from core_draws import MEMORY, draw_branches, draw_complete, draw_friction, draw_levels
from inerter.core import Device, DeviceError
from inerter.reference import ReferenceDevice, response, sine_motion
from scipy.integrate import solve_ivp
from scipy.optimize import least_squares

STRUT = {"inertance": 50.0, "series_stiffness": 5e4, "series_damping": 100.0}
LAWS: dict[str, dict[str, Any]] = {
    "coulomb": {"coulomb_force": 10.0, "transition_velocity": 1e-3},
    "stribeck": {"coulomb_force": 10.0, "static_force": 14.0, "transition_velocity": 1e-3},
    "brown_mcphee": {"coulomb_force": 10.0, "static_force": 14.0},
    "dahl": {"coulomb_force": 10.0},
    "lugre": {"coulomb_force": 10.0, "static_force": 14.0, "bristle_damping": 50.0},
    "bouc_wen": {"bw_stiffness": 1e5, "bw_beta": 5e3, "bw_gamma": 5e3},
}


def device(law: str, **more: Any) -> Device:
    return Device(friction=law, friction_side="flywheel", **LAWS[law], **{**STRUT, **more})


def test_without_a_series_element_the_sides_are_the_same_bit_for_bit() -> None:
    rng = np.random.default_rng(1)
    for law in LAWS:
        p = draw_friction(rng, law) | draw_branches(rng)
        p |= {} if law == "bouc_wen" else draw_levels(rng)
        p["load_friction"] = min(p["load_friction"], 0.9)
        one, other = Device(**p), Device(**p, friction_side="flywheel")
        assert one.state_names == other.state_names
        points = rng.normal(size=(4, 50)) * [[0.01], [0.5], [5.0], [1e-4]]
        said, again = one.evaluate(*points), other.evaluate(*points)
        for name, value in said.items():
            np.testing.assert_array_equal(value, again[name])
        for x, v, a, z in points.T:
            assert one.step(x, v, z, 1e-3) == other.step(x, v, z, 1e-3)
            assert (
                one.over_step(x, v, a, z, 1e-3, 0.1)[0]
                == (other.over_step(x, v, a, z, 1e-3, 0.1)[0])
            )


def test_equation_nine() -> None:
    # c_s (z_r - z_b)' + k_s (z_r - z_b) = b (z_b - z_w)'' + f sign((z_b - z_w)')
    strut = device("coulomb")
    s, w, v = 2e-4, 0.3, 0.35
    force = 5e4 * s + 100.0 * (v - w)
    said = strut.evaluate(0.01, v, 7.0, [s, w])
    assert said["total"][0] == pytest.approx(force, rel=1e-14)
    assert said["friction"][0] == 10.0
    assert said["inertance"][0] == pytest.approx(force - 10.0, rel=1e-14)
    assert said["state_rate"][0, 1] == pytest.approx((force - 10.0) / 50.0, rel=1e-14)
    # heat: friction where it slides, and the shaft's damper
    assert said["dissipated_power"][0] == pytest.approx(10.0 * w + 100.0 * (v - w) ** 2, rel=1e-12)


def sines(t: np.ndarray, order: int) -> np.ndarray:
    """Displacement of a bench [m], or a derivative of it."""
    parts = ((1e-3, 3.1, 0.3), (2e-4, 9.7, 1.1), (1e-4, 14.3, 2.0), (6e-5, 21.9, 0.5))
    rates = [2.0 * np.pi * f for _, f, _ in parts]
    return sum(
        size * rate**order * np.sin(rate * t + phase + order * np.pi / 2.0)
        for (size, _, phase), rate in zip(parts, rates, strict=True)
    )  # pyright: ignore[reportReturnType]


def test_equation_nine_is_identified_again() -> None:
    # the paper's device, b = 113 kg, k_s = 1000 kN/m, c_s = 3200 N s/m, f = 10 N, its equation
    # integrated here, 0.3 N of noise: each within 1 %, and the residual is the noise
    truth, width, noise = np.array([113.0, 1e6, 3200.0, 10.0]), 1e-3, 0.3
    b, k, c, level = truth
    t = np.arange(4001) / 2000.0
    x, v, a = (sines(t, order) for order in range(3))

    def rate(now: float, y: np.ndarray) -> list[float]:
        rub = level * np.tanh(y[1] / width)
        slide = float(sines(np.asarray(now), 1)) - y[1]
        return [slide, (k * y[0] + c * slide - rub) / b]

    y = solve_ivp(
        rate, (0.0, t[-1]), [0.0, v[0]], t_eval=t, method="LSODA", rtol=1e-9, atol=1e-12,
        max_step=5e-4,
    ).y  # fmt: skip
    measured = k * y[0] + c * (v - y[1])
    measured = measured + noise * np.random.default_rng(1).standard_normal(t.size)

    def fit(side: str) -> tuple[np.ndarray, float]:
        def residual(q: np.ndarray) -> np.ndarray:
            inertance, stiffness, damping, friction = np.exp(q)
            strut = Device(
                inertance=inertance, series_stiffness=stiffness, series_damping=damping,
                friction="coulomb", coulomb_force=friction, transition_velocity=width,
                friction_side=side,
            )  # fmt: skip
            return (strut.along(t[1], x, v, a, [0.0, v[0]])["total"] - measured) / noise

        start = np.log([100.0, 7e5, 5000.0, 5.0])
        found = least_squares(residual, start, x_scale=0.1, diff_step=1e-5)
        return np.exp(found.x), float(np.sqrt(np.mean(found.fun**2)))

    found, left = fit("flywheel")
    np.testing.assert_allclose(found, truth, rtol=0.01)
    assert 0.9 < left < 1.1
    # with the friction at the terminals nothing fits
    wrong, left = fit("terminals")
    assert left > 20.0
    assert (np.abs(wrong / truth - 1.0)[1:] > 0.03).all()


def test_load_friction_takes_its_share_of_what_the_inertance_gets() -> None:
    strut = Device(**STRUT, load_friction=0.2, friction_side="flywheel")
    for s, w, share in ((1e-3, 0.1, 1.2), (1e-3, -0.1, 0.8), (-1e-3, 0.1, 0.8)):
        said = strut.evaluate(0.0, w, 0.0, [s, w])
        assert said["inertance"][0] == pytest.approx(5e4 * s / share, rel=1e-12)
        assert said["state_rate"][0, 1] == pytest.approx(5e4 * s / share / 50.0, rel=1e-12)
        assert said["dissipated_power"][0] >= 0.0


def errors_along(law: str, parts: tuple[int, ...], **also: float) -> list[float]:
    """Of the core along a sine beside the reference, samples divided so often, per force rms."""
    p: dict[str, Any] = {**STRUT, "friction": law, **LAWS[law], **also}
    core = Device(**p, friction_side="flywheel")
    motion, times = sine_motion(2e-3, 3.0), np.linspace(0.0, 0.4, 201)
    start = np.zeros(core.nstate)
    start[core.state_names.index("flywheel_velocity")] = motion.velocity(0.0)
    true = response(
        ReferenceDevice(**p, friction_side="flywheel"), motion, times, initial_state=start,
        rtol=1e-9,
    )  # fmt: skip
    size, errors = np.sqrt(np.mean(true.force**2)), []
    for each in parts:
        t = np.linspace(0.0, 0.4, 200 * each + 1)
        told = core.along(
            t[1], motion.displacement(t), motion.velocity(t), motion.acceleration(t), start
        )
        errors.append(float(np.sqrt(np.mean((told["total"][::each] - true.force) ** 2)) / size))
    return errors


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("play", [0.0, 1e-4], ids=["no_play", "play"])
def test_along_a_motion_the_core_converges_to_the_reference(law: str, play: float) -> None:
    errors = errors_along(law, (2, 16), backlash=play, load_friction=0.1)
    assert errors[0] < 2e-3
    assert errors[1] < 2e-4


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("play", [0.0, 1e-4], ids=["no_play", "play"])
def test_a_flywheel_that_slides_is_followed_in_long_steps(law: str, play: float) -> None:
    """Without load friction a step where friction is even has a closed form: few are needed."""
    errors = errors_along(law, (1, 4, 16), backlash=play)
    assert errors[0] < 3e-3
    assert errors[1] < 5e-4
    assert errors[2] < 1e-4


@pytest.mark.parametrize("law", LAWS)
def test_a_step_is_stable_however_long_and_however_stiff(law: str) -> None:
    # at rest at the ends the flywheel comes to rest, and its energy never grows
    stiff = {"bristle_stiffness": 1e9} if law in ("dahl", "lugre") else {}
    for h in (1e-6, 1e-3, 1.0):
        strut = device(law, **stiff)
        z = np.zeros(strut.nstate)
        z[-1] = 1.0
        energy = strut.evaluate(0.0, 0.0, 0.0, z)["stored_energy"][0]
        for _ in range(60):
            z = strut.step(0.0, 0.0, z, h)
            now = strut.evaluate(0.0, 0.0, 0.0, z)["stored_energy"][0]
            assert now <= energy * (1.0 + 1e-9)
            energy = now
    assert energy < 0.2


def test_a_step_is_the_flow_of_the_rates() -> None:
    for law in ("coulomb", "lugre", "dahl"):
        strut = device(law, load_friction=0.1)
        z = np.zeros(strut.nstate)
        z[-2:] = 2e-4, 0.05
        flow = solve_ivp(
            lambda t, y, strut=strut: strut.evaluate(0.2 * t, 0.2, 0.0, y)["state_rate"][0],
            (0.0, 0.02), z, rtol=1e-10, atol=1e-13, method="Radau",
        ).y[:, -1]  # fmt: skip
        errors = []
        for count in (200, 800):
            state = z
            for i in range(count):
                state = strut.step(0.2 * 0.02 * i / count, 0.2, state, 0.02 / count)
            errors.append(abs(state - flow)[-1])
        assert errors[1] < 1e-6
        assert errors[1] < errors[0] / 4.0


def test_over_a_step_the_force_is_that_of_the_instant_for_short_steps() -> None:
    rng = np.random.default_rng(4)
    for law in LAWS:
        for _ in range(5):
            # without the corner at the middle of the play
            strut = device(law, backlash=0.0, load_friction=0.1)
            z = rng.normal(size=strut.nstate) * 1e-4
            z[-1] = rng.normal()
            x, v, a = rng.normal(size=3) * [0.01, 0.5, 5.0]
            now = {k: f[0] for k, f in strut.evaluate(x, v, a, z).items() if k != "state_rate"}
            over, _ = strut.over_step(x, v, a, z, 1e-8, 0.01)
            for name in ("total", "inertance", "friction"):
                assert over[name] == pytest.approx(now[name], rel=1e-3, abs=1e-2)
            assert over["total"] == pytest.approx(over["inertance"] + over["friction"], abs=1e-9)


def test_over_a_step_the_force_does_not_fall_with_the_acceleration() -> None:
    rng = np.random.default_rng(5)
    for _ in range(60):
        p = draw_complete(rng)
        p |= {"friction_side": "flywheel", "load_friction": min(0.9, p["load_friction"])}
        strut = Device(**p)
        z = rng.normal(size=strut.nstate) * 1e-4
        x, v = rng.normal(size=2) * [0.01, 0.5]
        h = 10.0 ** rng.uniform(-4, -2)
        force = [
            strut.over_step(x, v, a, z, h, 0.01)[0]["total"] for a in np.linspace(-100, 100, 41)
        ]
        assert np.all(np.diff(force) >= -1e-9 * (1.0 + np.max(np.abs(force)))), p


def test_a_stiff_shaft_is_none() -> None:
    for law in LAWS:
        # a direction that changes slower than the shaft rings
        values = {**LAWS[law], "friction": law, "inertance": 50.0, "load_friction": 0.1}
        values["transition_velocity"] = 1e-2
        motion, t = sine_motion(2e-3, 3.0), np.linspace(0.0, 0.4, 2001)
        each = (motion.displacement, motion.velocity, motion.acceleration)
        x, v, a = (np.asarray(of(t)) for of in each)
        stiff = {"series_stiffness": 1e9, "series_damping": 4e5, "friction_side": "flywheel"}
        strut = Device(**values, **stiff)
        start = np.zeros(strut.nstate)
        start[-1] = v[0]
        soft = strut.along(t[1], x, v, a, start)["total"]
        rigid = Device(**values).along(t[1], x, v, a)["total"]
        # the shaft's own transient at the start left out
        assert np.max(abs(soft - rigid)[20:]) < 0.02 * np.max(abs(rigid)), law


def test_what_cannot_be_is_refused() -> None:
    with pytest.raises(DeviceError, match='friction_side is "shaft": no such side; choose one of'):
        Device(**STRUT, friction_side="shaft")
    with pytest.raises(DeviceError, match="the flywheel would lock; give load_friction < 1"):
        Device(**STRUT, load_friction=1.0, friction_side="flywheel")


def test_states_keep_their_names() -> None:
    for law in MEMORY:
        names = device(law).state_names
        assert names == ("friction_state", "series_deflection", "flywheel_velocity")
