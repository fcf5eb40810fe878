"""The core's step of the friction state: closed forms, observed order, steps of any length."""

import numpy as np
import pytest
from core_draws import MEMORY, Parameters, draw_friction, draw_levels, state_limit
from inerter.core import Device
from inerter.reference import Motion, ReferenceDevice, response

LEVEL, STIFFNESS = 20.0, 5e4
BRISTLE = LEVEL / STIFFNESS


def constant(speed: float) -> Motion:
    """Motion x = speed t."""
    return Motion(lambda t: speed * t, lambda t: speed + 0.0 * t, lambda t: 0.0 * t)


def reference_step(p: Parameters, speed: float, state: float, time: float) -> float:
    """State after `time` at constant speed from x = 0, by the reference's solver."""
    device = ReferenceDevice(**p)
    run = response(
        device, constant(speed), [0.0, time], initial_state=state, rtol=1e-12,
        scan_step=time / 200.0,
    )  # fmt: skip
    return float(run.state[-1])


# ------------------------------ Dahl ------------------------------


def dahl(exponent: float, **more: float) -> Device:
    return Device(
        friction="dahl", coulomb_force=LEVEL, bristle_stiffness=STIFFNESS, dahl_exponent=exponent,
        **more,
    )  # fmt: skip


def dahl_exact(exponent: float, v: float, z: float, h: float) -> float:
    """From u' = -r sgn(u) |u|^m with r = sigma0 |v| / f_c, u = 1 - sigma0 z sgn(v) / f_c."""
    u = 1.0 - z * np.sign(v) / BRISTLE
    path = abs(v) * h / BRISTLE
    if exponent == 1.0:
        size = abs(u) * np.exp(-path)
    else:
        power = 1.0 - exponent
        remaining = (abs(u) ** power if u else 0.0) - power * path
        size = max(0.0, remaining) ** (1.0 / power) if u else 0.0
    return (1.0 - np.sign(u) * size) * np.sign(v) * BRISTLE


@pytest.mark.parametrize("exponent", [0.0, 0.5, 1.0, 1.7, 2.0])
@pytest.mark.parametrize("start", [-3.0, -1.0, -0.4, 0.0, 0.7, 0.999, 1.0, 2.5])
@pytest.mark.parametrize("v", [-0.02, 3e-4])
def test_dahl_closed_form(exponent: float, start: float, v: float) -> None:
    device = dahl(exponent)
    for path in [1e-9, 1e-3, 0.3, 1.0, 2.0, 30.0, 1e6]:
        h = path * BRISTLE / abs(v)
        exact = dahl_exact(exponent, v, start * BRISTLE, h)
        assert device.step(0.0, v, start * BRISTLE, h) == pytest.approx(exact, abs=1e-14 * BRISTLE)


def test_dahl_by_hand() -> None:
    # exponent 0: elastic until it slides
    device = dahl(0.0)
    assert device.step(0.0, 1.0, 0.0, 1e-4) == pytest.approx(1e-4, rel=1e-15)
    assert device.step(0.0, 1.0, 0.0, 1.0) == pytest.approx(4e-4, rel=1e-15)
    # exponent 1: from rest to f_c (1 - 1/e) over one bristle length
    assert dahl(1.0).step(0.0, 1.0, 0.0, 4e-4) == pytest.approx(4e-4 * -np.expm1(-1), rel=1e-15)
    # exponent 2 over one bristle length: u = 1 / 2
    assert dahl(2.0).step(0.0, 1.0, 0.0, 4e-4) == pytest.approx(2e-4, rel=1e-15)


@pytest.mark.parametrize("distance", [1e-15, 1e-12, 1e-9, 1e-6, 1e-3])
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_dahl_exponent_is_continuous_at_one(distance: float, side: float) -> None:
    # d log(u) / dm at m = 1 is path^2 / 2, from u^(1-m) = 1 - (1-m) path
    for path in (1e-6, 0.5, 3.0, 10.0):
        near = dahl(1.0 + side * distance).step(0.0, 1.0, 0.0, path * BRISTLE)
        gap = np.exp(-path) * np.expm1(0.5 * side * distance * path**2)
        tolerance = (20.0 * distance**2 * max(path, path**4) * np.exp(-path) + 4e-16) * BRISTLE
        assert near == pytest.approx((-np.expm1(-path) - gap) * BRISTLE, abs=tolerance)


# ------------------------------ LuGre ------------------------------


@pytest.mark.parametrize("start", [-2.0, -1.0, 0.0, 0.5, 1.0, 3.0])
@pytest.mark.parametrize("v", [-0.3, -4e-3, 1e-5, 2e-2])
def test_lugre_closed_form(start: float, v: float) -> None:
    device = Device(
        friction="lugre", coulomb_force=10.0, static_force=16.0, stribeck_velocity=5e-3,
        stribeck_exponent=1.5, bristle_stiffness=STIFFNESS, bristle_damping=80.0,
    )  # fmt: skip
    end = (10.0 + 6.0 * np.exp(-((abs(v) / 5e-3) ** 1.5))) / STIFFNESS
    for path in [1e-9, 1e-3, 0.7, 5.0, 1e6]:
        h = path * end / abs(v)
        exact = start * end * np.exp(-path) - np.expm1(-path) * np.sign(v) * end
        assert device.step(0.0, v, start * end, h) == pytest.approx(exact, abs=1e-14 * end)


# ------------------------------ Bouc-Wen ------------------------------


def bouc_wen(n: float, beta: float, gamma: float, alpha: float = 1.2) -> Parameters:
    return {
        "friction": "bouc_wen", "bw_stiffness": 1e4, "bw_alpha": alpha, "bw_beta": beta,
        "bw_gamma": gamma, "bw_exponent": n,
    }  # fmt: skip


def linear_exact(alpha: float, beta: float, gamma: float, z: float, path: float) -> float:
    """Bouc-Wen with n = 1 along a path in positive direction: an exponential on each side of 0."""
    if z < 0.0:
        # dz/dx = alpha + (gamma - beta) z, until z = 0
        rise = gamma - beta
        length = -z / alpha if rise == 0.0 else -np.log1p(rise * z / alpha) / rise
        if path <= length:
            growth = path if rise == 0.0 else np.expm1(rise * path) / rise
            return z + growth * (alpha + rise * z)
        z, path = 0.0, path - length
    fall = beta + gamma
    return z - np.expm1(-fall * path) * (alpha / fall - z)


@pytest.mark.parametrize(("beta", "gamma"), [(900, 400), (700, 700), (300, 800), (900, -400)])
@pytest.mark.parametrize("start", [-1.0, -0.6, -1e-9, 0.0, 0.3, 1.0, 1.8])
def test_bouc_wen_linear_closed_form(beta: float, gamma: float, start: float) -> None:
    p = bouc_wen(1.0, beta, gamma)
    device, limit = Device(**p), state_limit(p)
    for v in (0.01, -0.3):
        for path in np.array([1e-8, 0.1, 0.5, 1.0, 3.0, 100.0]) * limit:
            exact = linear_exact(1.2, beta, gamma, start * limit, path)
            found = np.sign(v) * device.step(0.0, v, np.sign(v) * start * limit, path / abs(v))
            assert found == pytest.approx(exact, abs=1e-13 * limit)


def test_bouc_wen_of_exponent_two_against_the_hyperbolic_tangent() -> None:
    # alpha = 1, z from 0: z = tanh(x sqrt(beta + gamma)) / sqrt(beta + gamma)
    p = bouc_wen(2.0, 3e6, 1e6, alpha=1.0)
    device = Device(**p)
    for parts in (8, 64):
        z, h = 0.0, 1e-3 / parts
        for _ in range(parts):
            z = device.step(0.0, 1.0, z, h)
        assert z == pytest.approx(np.tanh(2.0) / 2e3, rel=0.2 / parts**2)


@pytest.mark.parametrize("n", [2.0, 3.0])
@pytest.mark.parametrize("start", [-0.9, -0.4, 0.0, 0.6])
@pytest.mark.parametrize("v", [0.05, -0.05])
def test_bouc_wen_is_second_order(n: float, start: float, v: float) -> None:
    p = bouc_wen(n, 700.0 * 1e3 ** (n - 1.0), 500.0 * 1e3 ** (n - 1.0))
    device, limit = Device(**p), state_limit(p)
    time = 1.5 * limit / 1.2 / abs(v)
    z = start * limit * np.sign(v)
    exact = reference_step(p, v, z, time)

    errors = []
    for parts in (16, 32, 64, 128):
        state = z
        for _ in range(parts):
            state = device.step(0.0, v, state, time / parts)
        errors.append(abs(state - exact) / limit)
    order = np.log2(errors[0] / errors[-1]) / 3.0
    assert errors[0] < 3e-3
    assert order > 1.8, errors

    # one step over the whole path sub-divides by itself
    assert device.step(0.0, v, z, time) == pytest.approx(exact, abs=0.02 * limit)


@pytest.mark.parametrize("n", [1.0, 1.5, 2.0, 3.0, 8.0, 20.0])
@pytest.mark.parametrize("start", [-1.0, -0.3, 0.0, 0.8, 1.0, 3.0])
def test_a_long_step_of_bouc_wen_ends_at_its_limit(n: float, start: float) -> None:
    if start > 1.0 and n > 3.0:
        pytest.skip("from beyond a sharp knee a single step comes closer, but not all the way")
    p = bouc_wen(n, 0.6 * 1e3**n, 0.4 * 1e3**n)
    device, limit = Device(**p), state_limit(p)
    for path in (30.0 * limit, 1.0, 1e9):
        assert device.step(0.0, -2.0, -start * limit, path / 2.0) == pytest.approx(-limit, rel=1e-5)


@pytest.mark.parametrize("n", [2.0, 5.0, 20.0])
def test_a_step_of_bouc_wen_never_passes_its_limit(n: float) -> None:
    # a tangent taken before the knee of a large n points beyond it
    p = bouc_wen(n, 0.6 * 1e3**n, 0.4 * 1e3**n)
    device, limit = Device(**p), state_limit(p)
    for z in np.linspace(-1.0, 1.0, 41) * limit:
        for path in np.linspace(0.01, 3.0, 60) * limit:
            assert abs(device.step(0.0, 1.0, z, path)) <= limit * (1.0 + 1e-12)


# ------------------------------ every law with memory ------------------------------


@pytest.mark.parametrize("law", MEMORY)
def test_step_is_the_reference_solution(law: str) -> None:
    # random parameters and states; Bouc-Wen with n > 1 in 200 steps, the others in one
    rng = np.random.default_rng(3)
    for _ in range(25):
        p = draw_friction(rng, law)
        if law == "dahl":
            # below 1 the reference's solver itself stalls at the corner where sliding begins
            p["dahl_exponent"] = max(1.0, p["dahl_exponent"])
        device, limit = Device(**p), state_limit(p)
        v = float(rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-4.0, 0.0))
        z = limit * float(rng.uniform(-0.95, 0.95))
        time = limit / p.get("bw_alpha", 1.0) / abs(v) * float(rng.uniform(0.1, 4.0))
        parts = 200 if p.get("bw_exponent", 1.0) != 1.0 else 1
        found = z
        for _ in range(parts):
            found = device.step(0.0, v, found, time / parts)
        tolerance = 1e-8 if parts == 1 else 1e-3
        assert found == pytest.approx(reference_step(p, v, z, time), abs=tolerance * limit), p


@pytest.mark.parametrize("law", MEMORY)
def test_two_steps_are_one(law: str) -> None:
    # exact solutions form a semigroup
    rng = np.random.default_rng(4)
    for _ in range(200):
        p = draw_friction(rng, law)
        if law == "bouc_wen":
            p |= {"bw_exponent": 1.0}
        device, limit = Device(**p), state_limit(p)
        v, z = float(rng.normal(0.0, 0.1)), limit * float(rng.uniform(-1.0, 1.0))
        h1, h2 = (limit / abs(v) * rng.uniform(0.0, 2.0, 2)).tolist()
        twice = device.step(0.0, v, device.step(0.0, v, z, h1), h2)
        once = device.step(0.0, v, z, h1 + h2)
        # near the end of sliding |u|^(1-m) carries a power of the rounding error
        assert twice == pytest.approx(once, abs=1e-11 * limit), p


@pytest.mark.parametrize("law", MEMORY)
def test_no_motion_and_no_time_leave_the_state(law: str) -> None:
    rng = np.random.default_rng(5)
    for _ in range(50):
        p = draw_friction(rng, law)
        device, z = Device(**p), state_limit(p) * float(rng.uniform(-1.0, 1.0))
        assert device.step(0.0, 0.0, z, 1e9) == z
        assert device.step(0.0, 0.3, z, 0.0) == z


@pytest.mark.parametrize("law", MEMORY)
def test_no_step_is_too_long_and_no_bristle_too_stiff(law: str) -> None:
    rng = np.random.default_rng(6)
    for _ in range(3000):
        p = draw_friction(rng, law, 3.0)
        level = 1.0
        if law != "bouc_wen":
            p["bristle_stiffness"] = 10.0 ** rng.uniform(0.0, 12.0)
            if rng.random() < 0.5:
                p |= draw_levels(rng)
                level = 1.0 + abs(p["friction_asymmetry"])
        device, limit = Device(**p), state_limit(p) * level
        h = 10.0 ** rng.uniform(-9.0, 9.0)
        v = float(rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-9.0, 3.0))

        # from within the limit it stays within
        z = limit * float(rng.choice([-1.0, 1.0, 0.0, rng.uniform(-1.0, 1.0)]))
        found = device.step(0.0, v, z, h)
        assert abs(found) <= limit * (1.0 + 1e-12), (p, v, z, h)

        # from far outside it comes closer; Bouc-Wen with gamma > beta only in its own direction
        far = 10.0 ** rng.uniform(0.0, 6.0) * limit * float(rng.choice([-1.0, 1.0]))
        if law == "bouc_wen":
            far = float(np.copysign(far, v))
        found = device.step(0.0, v, far, h)
        assert abs(found) <= abs(far) * (1.0 + 1e-12), (p, v, far, h)


@pytest.mark.parametrize("law", MEMORY)
def test_a_random_walk_of_steps_stays_within_the_friction_level(law: str) -> None:
    rng = np.random.default_rng(8)
    for _ in range(20):
        p = draw_friction(rng, law, 2.0) | ({"bw_ratio": 0.0} if law == "bouc_wen" else {})
        device, limit, z = Device(**p), state_limit(p), 0.0
        for _ in range(300):
            v = float(rng.normal(0.0, 1.0) * 10.0 ** rng.uniform(-6.0, 1.0))
            z = device.step(0.0, v, z, 10.0 ** rng.uniform(-9.0, 2.0))
            assert abs(z) <= limit * (1.0 + 1e-12)
            # LuGre's micro-damping adds at most sigma1 times twice the speed
            force = float(device.evaluate(0.0, v, 0.0, z)["friction"][0])
            allowed = p.get("bw_stiffness", p.get("bristle_stiffness")) * limit
            assert law == "lugre" or abs(force) <= allowed * (1.0 + 1e-12)


# ------------------------------ state of a force ------------------------------


@pytest.mark.parametrize("law", MEMORY)
def test_state_of_force_inverts_the_force(law: str) -> None:
    rng = np.random.default_rng(9)
    for _ in range(300):
        p = draw_friction(rng, law) | {"inertance": 50.0, "viscous": 5.0, "force_offset": 3.0}
        if law == "lugre":
            p["bristle_damping"] = 0.0
        device, z = Device(**p), state_limit(p) * float(rng.uniform(-0.99, 0.99))
        if law == "lugre":
            # beyond f_c no fast slide leads
            z *= p["coulomb_force"] / p["static_force"]
        x, v, a = 0.01 * rng.normal(), 0.1 * rng.normal(), rng.normal()
        points = device.evaluate(x, v, a, z)
        found = device.state_of_force(x, v, a, float(points["total"][0]))
        slack = 1e-12 * (abs(points["total"][0]) + abs(points["inertance"][0]) + 100.0)
        stiffness = p.get("bristle_stiffness") or p["bw_stiffness"] * abs(1.0 - p["bw_ratio"])
        assert found == pytest.approx(z, abs=slack / stiffness)


@pytest.mark.parametrize("law", MEMORY)
def test_state_of_force_keeps_within_what_the_law_can_hold(law: str) -> None:
    rng = np.random.default_rng(10)
    for _ in range(200):
        p = draw_friction(rng, law) | ({"bw_ratio": 0.1} if law == "bouc_wen" else {})
        device, limit = Device(**p), state_limit(p)
        for force in (1e9, -1e9):
            found = device.state_of_force(0.0, 0.0, 0.0, force)
            assert found == pytest.approx(np.sign(force) * limit, rel=1e-6), p


def test_state_of_force_knows_the_asymmetry() -> None:
    # forward this device holds 15 N, backward 5 N
    device = Device(
        friction="dahl", coulomb_force=10.0, bristle_stiffness=1e4, friction_asymmetry=0.5
    )
    assert device.state_of_force(0.0, 0.1, 0.0, 14.0) == pytest.approx(1.4e-3)
    assert device.state_of_force(0.0, 0.1, 0.0, 99.0) == pytest.approx(1.5e-3)


def test_state_of_force_without_a_state_to_find() -> None:
    assert Device(friction="coulomb", coulomb_force=5.0).state_of_force(0, 1, 0, 3.0) == 0.0
    elastic = Device(friction="bouc_wen", bw_stiffness=1e3, bw_ratio=1.0)
    assert elastic.state_of_force(0.0, 0.0, 0.0, 3.0) == 0.0
    device = Device(friction="dahl", coulomb_force=5.0)
    assert device.state_of_force(0.0, 0.0, 0.0, float("nan")) == 0.0
