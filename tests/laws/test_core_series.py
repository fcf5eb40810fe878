"""The series element in the core: limits, energy along runs, and the step of its states.

Runs of a device at constant velocity of the terminals are compared with an adaptive solver on the
core's own rates, which test_core_parts.py compares with formulas.
"""

import numpy as np
import pytest
from core_draws import around, draw_flywheel, draw_stops
from core_telling import Array
from inerter.core import Device
from scipy.integrate import solve_ivp

PLAIN = {"inertance": 100.0, "series_stiffness": 1e5, "series_damping": 200.0}
GAP = PLAIN | {"backlash": 2e-4}


def exact(device: Device, x: float, v: float, z: Array, time: float) -> Array:
    """States after a time at constant velocity, by an adaptive solver."""

    def rates(t: float, state: Array) -> Array:
        return device.evaluate(x + v * t, v, 0.0, state)["state_rate"][0]

    run = solve_ivp(rates, (0.0, time), z, rtol=1e-11, atol=1e-13, method="DOP853")
    return run.y[:, -1]


def stepped(device: Device, x: float, v: float, z: Array, time: float, count: int) -> Array:
    """States after `count` equal steps."""
    state = np.array(z, dtype=float)
    for i in range(count):
        state = device.step(x + v * time * i / count, v, state, time / count)
    return state


def total(device: Device, x: float, v: float, z: list[float]) -> float:
    return float(device.evaluate(x, v, 0.0, z)["total"][0])


# ------------------------------ force ------------------------------


def test_force_by_hand() -> None:
    device = Device(**PLAIN)
    # 1e5 * 1e-3 + 200 * (0.3 - 0.1)
    assert total(device, 0.0, 0.3, [1e-3, 0.1]) == pytest.approx(140.0)
    rates = device.evaluate(0.0, 0.3, 0.0, [1e-3, 0.1])["state_rate"][0]
    np.testing.assert_allclose(rates, [0.2, 1.4], rtol=1e-14)
    # half an mm beyond the play, in contact; loose; pulled apart faster than the spring pushes
    gap = Device(**GAP)
    assert total(gap, 0.0, 0.0, [7e-4, 0.0, 2e-4]) == pytest.approx(50.0)
    assert total(gap, 0.0, 0.0, [7e-4, 0.0, 1e-4]) == 0.0
    assert total(gap, -1.0, -1.0, [7e-4, 0.0, 2e-4]) == 0.0
    assert gap.evaluate(0.0, -1.0, 0.0, [7e-4, 0.0, 2e-4])["state_rate"][0, 2] == pytest.approx(
        -1.0 + 50.0 / 200.0
    )
    # hardening: 1e5 (1 + 100 * 1e-3) 1e-3; softening side ends at a quarter of k / q
    hard = Device(**PLAIN, series_hardening=100.0)
    assert total(hard, 0.0, 0.0, [1e-3, 0.0]) == pytest.approx(110.0)
    for d in (-0.005, -0.02):
        assert total(hard, 0.0, 0.0, [d, 0.0]) == pytest.approx(-1e5 / 400.0)


def test_without_damper_backlash_is_a_dead_zone() -> None:
    device = Device(**{**GAP, "series_damping": 0.0})
    s = np.linspace(-1e-3, 1e-3, 401)
    # whatever the gap state says, it follows the deflection
    for gap in (-2e-4, 0.0, 1e-4):
        z = np.stack([s, 0.0 * s, 0.0 * s + gap], axis=1)
        found = device.evaluate(0.0, 0.3, 0.0, z)
        dead = np.sign(s) * np.maximum(0.0, abs(s) - 2e-4)
        np.testing.assert_allclose(found["total"], 1e5 * dead, atol=1e-10)
        np.testing.assert_allclose(found["stored_energy"], 0.5e5 * dead**2, atol=1e-13)
        assert not found["dissipated_power"].any()


def test_terminals_feel_no_acceleration_behind_a_spring() -> None:
    device = Device(**PLAIN, load_friction=0.1, stiffness=50.0)
    z = [1e-3, 0.1]
    assert (
        device.evaluate(0.0, 0.3, [0.0, 1e6], 0.0)["total"].tolist()
        == [40.0 * 0 + total(device, 0.0, 0.3, [0.0, 0.0])] * 2
    )
    found = device.evaluate(0.0, 0.3, 0.0, z)
    # the load friction counts the force through the element
    assert found["friction"][0] == pytest.approx(14.0)
    assert found["inertance"][0] == pytest.approx(140.0)


# ------------------------------ limits ------------------------------


@pytest.mark.parametrize("damping", [0.0, 200.0])
def test_stiffer_and_stiffer_is_rigid(damping: float) -> None:
    # along a motion that begins smoothly, whether the samples resolve the spring or not
    t = np.linspace(0.0, 1.0, 4001)
    a = np.sin(20.0 * t)
    v, x = (1.0 - np.cos(20.0 * t)) / 20.0, (t - np.sin(20.0 * t) / 20.0) / 20.0
    errors = []
    for k in (1e5, 1e6, 1e7, 1e9, 1e12, 1e15):
        device = Device(inertance=10.0, series_stiffness=k, series_damping=damping)
        found = device.along(t[1], x, v, a)["total"]
        errors.append(np.sqrt(np.mean((found - 10.0 * a)[2000:] ** 2)))
    # damped: b a lags by b^2 a'' / k; undamped it rings about b a with the root of that
    rate = 9.0 if damping else 2.5
    assert errors[0] < 2.0
    assert errors[0] > rate * errors[1] > rate**2 * errors[2]
    assert max(errors[3:]) < 0.05


@pytest.mark.parametrize("damping", [0.0, 200.0])
def test_a_smaller_gap_is_no_gap(damping: float) -> None:
    t = np.linspace(0.0, 2.0, 20_001)
    x, v, a = 1e-3 * np.sin(9.0 * t), 9e-3 * np.cos(9.0 * t), -0.081 * np.sin(9.0 * t)
    p = PLAIN | {"series_damping": damping, "flywheel_viscous": 300.0}
    closed = Device(**p).along(t[1], x, v, a)["total"]
    errors = [
        np.sqrt(np.mean((Device(**p, backlash=eps).along(t[1], x, v, a)["total"] - closed) ** 2))
        for eps in (1e-5, 1e-6, 1e-7, 1e-9)
    ]
    assert errors[0] > errors[1] > errors[2] > errors[3]
    assert errors[3] < 1e-3 * np.max(abs(closed))


def test_a_dashpot_in_series_with_the_inertance() -> None:
    # layout S3: at constant velocity w' = (c / b) (v - w)
    device = Device(inertance=50.0, series_damping=200.0)
    assert device.state_names == ("series_deflection", "flywheel_velocity")
    end = stepped(device, 0.0, 0.4, np.zeros(2), 1.0, 200)
    assert end[1] == pytest.approx(0.4 * -np.expm1(-4.0), rel=1e-4)
    assert total(device, 0.4, 0.4, end.tolist()) == pytest.approx(80.0 * np.exp(-4.0), rel=1e-2)


# ------------------------------ step ------------------------------


def smooth_device(rng: np.random.Generator, backlash: bool) -> Device:
    """A device whose state moves without kinks for a while."""
    p = PLAIN | draw_flywheel(rng, channel=True, gas=True) | draw_stops(rng)
    del p["inertance"]
    p |= {"gas_law": "polytropic", "minor_loss": 0.0, "fluid_viscosity": 1e-3}
    p |= {"channel_area": 2.8e-5, "channel_length": 1.7, "piston_area": 1.6e-3}
    p |= {"series_hardening": 30.0, "inertance_gradient": 2.0, "inertance_curvature": 8.0}
    p |= {"friction": "dahl", "coulomb_force": around(rng, 10.0)}
    return Device(**p, **({"backlash": 1e-4} if backlash else {}))


@pytest.mark.parametrize("backlash", [False, True])
@pytest.mark.parametrize("seed", range(4))
def test_step_is_second_order(seed: int, backlash: bool) -> None:
    rng = np.random.default_rng(seed)
    device = smooth_device(rng, backlash)
    # with backlash: in contact, and loaded enough to stay there
    z = np.array([0.0, 5e-3, 0.3] + ([1e-4] if backlash else []))
    x, v, time = 0.002, 0.35, 0.02
    truth = exact(device, x, v, z, time)
    if backlash:
        assert truth[3] == 1e-4
    errors = [
        abs(stepped(device, x, v, z, time, count) - truth)[1:3] for count in (40, 80, 160, 320)
    ]
    order = np.log2(np.divide(errors[:-1], errors[1:]))
    assert np.all(order[-1] > 1.85), (order, errors)
    assert np.all(errors[-1] < [1e-7, 1e-5])


def test_a_long_step_divides_itself() -> None:
    # ten radians in one call
    device = Device(**PLAIN)
    z, time = np.array([1e-3, 0.0]), 10.0 / np.sqrt(1e3)
    truth = exact(device, 0.0, 0.1, z, time)
    found = device.step(0.0, 0.1, z, time)
    # amplitude 3.3 mm, 0.1 m/s; what is left is the phase
    assert found == pytest.approx(truth, abs=0.012)
    assert found[0] == pytest.approx(truth[0], abs=4e-4)


@pytest.mark.parametrize("damping", [0.0, 1.0, 1e3, 1e6])
@pytest.mark.parametrize("backlash", [0.0, 1e-4])
@pytest.mark.parametrize("stiffness", [1e11, 1e12, 1e15])
def test_a_stiff_element_settles(stiffness: float, backlash: float, damping: float) -> None:
    # no ring, whatever the start: after some steps the flywheel moves with the terminals
    device = Device(
        inertance=10.0, series_stiffness=stiffness, series_damping=damping, backlash=backlash
    )
    for v, s, w in ((0.2, 0.0, 0.0), (0.0, 1e-3, -0.4), (-1.0, -1e-3, 2.0)):
        z = np.array([s, w, 0.0][: device.nstate])
        for i in range(400):
            z = device.step(v * i * 1e-3, v, z, 1e-3)
        assert abs(total(device, 0.0, v, z.tolist())) < 1e-3 * 10.0 * 1e3
        if not backlash:
            assert z == pytest.approx([0.0, v], abs=1e-6)
        else:
            # loose within the play, not faster than it came
            assert abs(z[0]) <= backlash * (1.0 + 1e-9) + 1e-9
            assert abs(z[1] - v) <= abs(w - v)


def energy_of(device: Device, x: float, v: float, z: Array) -> float:
    return float(device.evaluate(x, v, 0.0, z)["stored_energy"][0])


@pytest.mark.parametrize("stiffness", [1e3, 1e5, 1e8, 1e12])
@pytest.mark.parametrize("damping", [0.0, 10.0, 1e4])
def test_a_held_device_with_backlash_never_gains_energy(stiffness: float, damping: float) -> None:
    # terminals at rest: kinetic energy bounces between the sides of the play and can only fall
    device = Device(
        inertance=10.0, series_stiffness=stiffness, series_damping=damping, backlash=1e-3
    )
    for h in (1e-5, 1e-4, 1e-3):
        z = np.array([0.0, 0.5, 0.0])
        start = energy_of(device, 0.0, 0.0, z)
        seen = [start]
        for _ in range(3000):
            z = device.step(0.0, 0.0, z, h)
            seen.append(energy_of(device, 0.0, 0.0, z))
        assert max(np.diff(seen)) < 1e-12 * start, h
        assert abs(z[2]) <= 1e-3


def test_a_cycle_through_the_play_takes_energy() -> None:
    # driven to and fro, in the steady cycle: the work of a period is heat, and positive
    device = Device(**GAP, flywheel_viscous=20.0)
    period, count = 0.25, 20_000
    t = np.arange(40 * count + 1) * (period / count)
    w = 2.0 * np.pi / period
    x, v = 1e-3 * np.sin(w * t), 1e-3 * w * np.cos(w * t)
    found = device.along(t[1], x, v, 0.0 * t)
    last = slice(-count - 1, None)
    work = np.trapezoid(found["total"][last] * v[last], t[last])
    heat = device.evaluate(x[last], v[last], 0.0, found["states"][last])["dissipated_power"]
    assert work == pytest.approx(np.trapezoid(heat, t[last]), rel=1e-2)
    assert work > 0.0
    # and it went through the play, to both sides
    assert set(np.sign(found["total"][last])) == {-1.0, 0.0, 1.0}


def test_contact_is_lost_at_the_force_and_made_at_the_other_side() -> None:
    # against the solver, which stops at the events: pulled back from contact through the play
    device = Device(**GAP)
    z, v = np.array([4e-4, 0.0, 2e-4]), -0.05
    count, h = 20_000, 1e-6
    found = device.along(h, v * h * np.arange(count), np.full(count, v), np.zeros(count), z)
    force, gap = found["total"], found["states"][:, 2]
    free = np.flatnonzero(force == 0.0)
    # the spring still pushes when contact ends: phi = c |s'| > 0, far from d = 0
    s, w, _ = found["states"][free[0] - 1]
    assert 1e5 * (s - 2e-4) == pytest.approx(200.0 * (w - v), rel=1e-2)
    assert 1e5 * (s - 2e-4) > 5.0
    # in the play the deflection of the spring relaxes with c / k = 2 ms
    inside = free[free < free[0] + 3000]
    d = found["states"][inside, 0] - gap[inside]
    np.testing.assert_allclose(d, d[0] * np.exp(-(inside - inside[0]) * h / 2e-3), rtol=2e-3)
    # then it lands on the other side, and never outside
    assert gap[-1] == -2e-4
    assert np.max(abs(gap)) <= 2e-4
    assert force[-1] < 0.0


def test_along_is_second_order_with_a_series_element() -> None:
    device = Device(**PLAIN, series_hardening=20.0, inertance_gradient=3.0)

    def motion(t: Array) -> tuple[Array, Array, Array]:
        return 1e-2 * np.sin(7.0 * t), 7e-2 * np.cos(7.0 * t), -0.49 * np.sin(7.0 * t)

    def rates(t: float, state: Array) -> Array:
        x, v, a = motion(np.array([t]))
        return device.evaluate(x, v, a, state)["state_rate"][0]

    run = solve_ivp(rates, (0.0, 1.0), [0.0, 0.07], rtol=1e-11, atol=1e-14, method="DOP853")
    x, v, a = motion(np.ones(1))
    truth = float(device.evaluate(x, v, a, run.y[:, -1])["total"][0])
    errors = []
    for count in (800, 1600, 3200):  # one part per sample
        t = np.linspace(0.0, 1.0, count + 1)
        found = device.along(t[1], *motion(t), state=[0.0, 0.07])
        assert found["states"].shape == (count + 1, 2)
        np.testing.assert_array_equal(found["state"], found["states"][:, 0])
        errors.append(abs(found["total"][-1] - truth))
    assert np.all(np.log2(np.divide(errors[:-1], errors[1:])) > 1.8), errors


@pytest.mark.parametrize("damping", [0.0, 20.0, 200.0, 2e4])
@pytest.mark.parametrize("play", [0.0, 2e-4])
def test_along_a_cubic_a_linear_element_is_exact_in_contact(play: float, damping: float) -> None:
    """Ten steps per natural period are as good as an adaptive solver, strongly damped or not."""
    device = Device(
        inertance=100.0, series_stiffness=1e5, series_damping=damping, flywheel_viscous=30.0,
        backlash=play,
    )  # fmt: skip
    time = 0.02 * np.arange(30)
    # towards one side ever faster: the play stays closed
    x, v, a = 0.1 * time + 2 * time**2 + time**3, 0.1 + 4 * time + 3 * time**2, 4 + 6 * time
    z = np.array([5e-3, 0.0, play])[: device.nstate]

    def rates(t: float, state: Array) -> Array:
        now = (0.1 * t + 2 * t**2 + t**3, 0.1 + 4 * t + 3 * t**2, 4 + 6 * t)
        return device.evaluate(*now, state)["state_rate"][0]

    true = solve_ivp(rates, (0.0, time[-1]), z, rtol=1e-11, atol=1e-13, method="Radau",
                     t_eval=time)  # fmt: skip
    found = device.along(time[1], x, v, a, z)["states"]
    np.testing.assert_allclose(found[:, :2], true.y[:2].T, rtol=1e-7, atol=1e-9)


VARYING = {
    "stroke": {"inertance_gradient": 3.0, "inertance_curvature": 100.0},
    "speed": {"inertance_speed_gradient": 0.5},
    "hardening": {"series_hardening": 30.0},
    "gas": {"gas_pressure": 1e5, "gas_area": 1e-3, "gas_volume": 6e-5},
    "pipe": {"piston_area": 2e-3, "channel_area": 1e-4, "channel_length": 5.0,
             "fluid_density": 850.0, "fluid_viscosity": 0.03},
}  # fmt: skip


def along_two_sines(device: Device, parts: int) -> dict[str, Array]:
    """2 s in 1600 samples, each of them divided, from where the flywheel moves along."""
    t = np.linspace(0.0, 2.0, 1600 * parts + 1)
    x, v, a = np.zeros((3, t.size))
    for size, rate in ((0.02, 12.6), (0.003, 56.5)):
        x += size * np.sin(rate * t)
        v += size * rate * np.cos(rate * t)
        a -= size * rate**2 * np.sin(rate * t)
    return device.along(t[1], x, v, a, [0.0, v[0], 0.0][: device.nstate])


@pytest.mark.parametrize("stiffness", [1e5, 3e6, 3e7])
@pytest.mark.parametrize("what", VARYING)
def test_along_need_not_resolve_an_oscillation_whose_coefficients_vary(
    what: str, stiffness: float
) -> None:
    """0.03 to 0.8 rad of it in a step, along two sines, begun with the flywheel at rest."""
    given = VARYING[what] | ({} if what == "pipe" else {"inertance": 80.0})
    device = Device(**given, series_stiffness=stiffness, series_damping=60.0)

    def force(parts: int) -> Array:
        return along_two_sines(device, parts)["total"][::parts]

    true = force(32)
    error = [float(np.max(np.abs(force(parts) - true)) / np.std(true)) for parts in (1, 2, 4)]
    assert error[0] < 3e-3
    # second order, where not the step is divided already
    assert error[2] < error[0] / 10 or error[0] < 1e-4


@pytest.mark.parametrize("what", ["stroke", "speed", "hardening", "gas"])
def test_a_play_behind_coefficients_that_hardly_vary_is_a_plain_one(what: str) -> None:
    """Two sets of formulas, one for linear elements, tell the same impacts."""
    hardly = {
        "stroke": {"inertance_gradient": 1e-9},
        "speed": {"inertance_speed_gradient": 1e-9},
        "hardening": {"series_hardening": 1e-9},
        "gas": {**VARYING["gas"], "gas_pressure": 1e-6},
    }[what]
    plain = GAP | {"series_stiffness": 8e5, "series_damping": 3e3}
    one, other = (along_two_sines(Device(**plain, **more), 1) for more in ({}, hardly))
    size = float(np.std(one["total"]))
    np.testing.assert_allclose(other["total"], one["total"], atol=1e-4 * size)
    assert np.mean(one["total"] == 0) > 0.01  # it flies


@pytest.mark.parametrize("what", VARYING)
def test_along_behind_a_play_needs_no_small_steps(what: str) -> None:
    given = VARYING[what] | ({} if what == "pipe" else {"inertance": 80.0})
    device = Device(**given, series_stiffness=1e6, series_damping=4e3, backlash=2e-4)
    coarse, fine = (along_two_sines(device, parts)["total"][::parts] for parts in (1, 16))
    # where the flywheel lands is told by the step; at nine of ten samples nothing of it is left
    assert np.quantile(np.abs(coarse - fine), 0.9) < 5e-3 * np.std(fine)


def test_a_run_with_all_states_can_be_cut_in_two() -> None:
    device = Device(**GAP, friction="lugre", coulomb_force=5.0)
    t = np.linspace(0.0, 1.0, 1001)
    x, v, a = 1e-3 * np.sin(30.0 * t), 3e-2 * np.cos(30.0 * t), -0.9 * np.sin(30.0 * t)
    whole = device.along(1e-3, x, v, a)
    cut = 400
    tail = device.along(1e-3, x[cut:], v[cut:], a[cut:], state=whole["states"][cut])
    for name in ("total", "friction", "states"):
        np.testing.assert_array_equal(tail[name], whole[name][cut:])


# ------------------------------ state of a force ------------------------------


@pytest.mark.parametrize("force", [-30.0, 250.0])
@pytest.mark.parametrize("q", [0.0, 40.0, -40.0])
@pytest.mark.parametrize("backlash", [0.0, 1e-4])
def test_state_of_force_loads_the_series_element(force: float, q: float, backlash: float) -> None:
    device = Device(
        **PLAIN, series_hardening=q, backlash=backlash, friction="dahl", coulomb_force=5.0,
        load_friction=0.2, viscous=30.0, force_offset=4.0,
    )  # fmt: skip
    z = device.state_of_force(0.01, 0.3, 7.0, force)
    assert isinstance(z, np.ndarray)
    assert float(device.evaluate(0.01, 0.3, 7.0, z)["total"][0]) == pytest.approx(force, rel=1e-12)
    assert z[0] == 0.0
    assert z[2] == 0.3
    assert backlash == 0.0 or z[3] == np.sign(force - 13.0) * backlash


def test_state_of_force_of_a_dashpot_and_beyond_what_a_spring_holds() -> None:
    dashpot = Device(inertance=50.0, series_damping=200.0)
    z = dashpot.state_of_force(0.0, 0.3, 0.0, 40.0)
    assert z == pytest.approx([0.0, 0.1])
    soft = Device(**PLAIN, series_hardening=100.0)
    # the softening side bears 250 N
    found = soft.state_of_force(0.0, 0.0, 0.0, -900.0)
    assert total(soft, 0.0, 0.0, list(np.atleast_1d(found))) == pytest.approx(-250.0)
    for force in (np.nan, np.inf):
        assert soft.state_of_force(0.0, 0.2, 0.0, force) == pytest.approx([0.0, 0.2])
