"""The series element: closed forms, its limits, and contact lost by force, not by position."""

from typing import Any

import numpy as np
import pytest
from inerter.reference import Motion, ReferenceDevice, response, sine_motion
from inerter.reference.laws import series, series_spring
from scipy.optimize import brentq

STIFFNESS, DAMPING, EPS = 4e4, 200.0, 5e-4


def test_linear_element_is_its_impedance() -> None:
    # started on the harmonic solution, the run stays on it: F = Z X exp(i w t)
    device = ReferenceDevice(
        inertance=113.0, series_stiffness=1e6, series_damping=3200.0, flywheel_viscous=50.0
    )
    p = 2j * np.pi * 3.0
    flywheel, shaft = (113.0 * p + 50.0) * p, 1e6 + 3200.0 * p
    force = flywheel * shaft / (flywheel + shaft) * 1e-3
    deflection, speed = force / shaft, p * (1e-3 - force / shaft)
    times = np.linspace(0.0, 1.0, 201)
    run = response(
        device, sine_motion(1e-3, 3.0), times, initial_state=[deflection.imag, speed.imag]
    )
    exact = (force * np.exp(p * times)).imag
    np.testing.assert_allclose(run.force, exact, atol=1e-7 * abs(force))
    np.testing.assert_allclose(run.states[:, 0], run.force / shaft.real, atol=3e-6)
    assert run.states.shape == (201, 2)
    assert not run.state.any()


def test_stiff_element_is_the_ideal_inerter() -> None:
    motion, times = sine_motion(2e-3, 2.0), np.linspace(0.0, 0.5, 101)
    ideal = response(ReferenceDevice(inertance=50.0), motion, times).force
    errors = []
    for stiffness in (1e6, 1e7, 1e8):
        device = ReferenceDevice(
            inertance=50.0, series_stiffness=stiffness, series_damping=np.sqrt(50.0 * stiffness)
        )
        start = [0.0, float(motion.velocity(0.0))]
        errors.append(
            np.max(abs(response(device, motion, times, initial_state=start).force - ideal))
        )
    # first order in the flywheel's delay sqrt(b / k_s)
    assert errors[1] < 0.4 * errors[0]
    assert errors[2] < 0.4 * errors[1]
    assert errors[2] < 0.02 * np.max(abs(ideal))


def test_a_flywheel_too_heavy_to_move_leaves_the_spring() -> None:
    device = ReferenceDevice(inertance=1e12, series_stiffness=STIFFNESS, series_damping=DAMPING)
    run = response(device, sine_motion(1e-3, 2.0), np.linspace(0.0, 1.0, 101))
    spring = STIFFNESS * run.displacement + DAMPING * run.velocity
    np.testing.assert_allclose(run.force, spring, atol=1e-6)


@pytest.mark.parametrize("hardening", [43.0, -43.0])
def test_hardening_stops_where_its_tangent_would_turn(hardening: float) -> None:
    device = ReferenceDevice(inertance=1.0, series_stiffness=1e5, series_hardening=hardening)
    edge = -0.5 / hardening
    assert series_spring.force(device, 1e-3) == pytest.approx(100.0 * (1.0 + 1e-3 * hardening))
    assert series_spring.force(device, 3.0 * edge) == series_spring.force(device, edge)
    assert series_spring.force(device, edge) == pytest.approx(1e5 * edge / 2.0)

    # monotone everywhere, and the potential's derivative
    d = np.linspace(-0.03, 0.03, 2001)
    phi = np.asarray(series_spring.force(device, d))
    assert np.all(np.diff(phi) >= -1e-9)
    energy = np.asarray(series_spring.stored_energy(device, d))
    np.testing.assert_allclose(np.gradient(energy, d)[1:-1], phi[1:-1], atol=0.02)


def test_contact_is_lost_by_force_where_position_would_hold_it() -> None:
    # shaft still twisted by 1e-4 m (4 N) while the teeth part at 0.03 m/s (-6 N): a dead zone
    # with a damper would pull with -2 N, the true force is zero
    device = ReferenceDevice(
        inertance=10.0, series_stiffness=STIFFNESS, series_damping=DAMPING, backlash=EPS
    )
    z = np.array([EPS + 1e-4, 0.03, EPS])
    by_position = STIFFNESS * 1e-4 - DAMPING * 0.03
    assert by_position == pytest.approx(-2.0)
    assert device.force(0.0, 0.0, 0.0, z) == pytest.approx(0.0, abs=1e-12)
    rate = np.asarray(device.state_rate(0.0, 0.0, z))
    assert rate[2] == pytest.approx(-0.03 + STIFFNESS * 1e-4 / DAMPING)
    assert rate[1] == pytest.approx(0.0, abs=1e-12)
    assert device.contact_of(0.0, z) == 0

    # slower parting: the contact holds, the damper only weakens it; mirrored the same
    slow = np.array([EPS + 1e-4, 0.01, EPS])
    assert device.force(0.0, 0.0, 0.0, slow) == pytest.approx(2.0)
    assert device.force(0.0, 0.0, 0.0, -slow) == pytest.approx(-2.0)
    assert device.contact_of(0.0, slow) == 1
    assert device.contact_of(0.0, -slow) == -1

    # untwisted shaft, but pressed on: contact again although s is inside the gap by nothing
    pressed = np.array([EPS, -0.01, EPS])
    assert device.force(0.0, 0.0, 0.0, pressed) == pytest.approx(2.0)


def held_flywheel(damping: float, hardening: float = 0.0) -> ReferenceDevice:
    """A backlash before a flywheel that cannot move: s is the imposed motion."""
    return ReferenceDevice(
        inertance=1e12, series_stiffness=STIFFNESS, series_damping=damping, backlash=EPS,
        series_hardening=hardening,
    )  # fmt: skip


@pytest.mark.parametrize("method", ["LSODA", "Radau"])
def test_one_cycle_through_the_gap_in_closed_form(method: str) -> None:
    amplitude, omega = 2e-3, 2.0 * np.pi * 2.0
    motion = sine_motion(amplitude, 2.0)
    times = np.linspace(0.0, 0.5, 501)
    run = response(held_flywheel(DAMPING), motion, times, method=method, rtol=1e-9)

    def s(t: float) -> float:
        return amplitude * float(np.sin(omega * t))

    def contact_force(t: float, side: int) -> float:
        rate = amplitude * omega * float(np.cos(omega * t))
        return STIFFNESS * (s(t) - side * EPS) + DAMPING * rate

    # first touch, release where the force ends, relaxation with c/k, touch at the other side
    relaxing = DAMPING / STIFFNESS
    touch = np.arcsin(EPS / amplitude) / omega
    release = float(brentq(lambda t: contact_force(t, 1), 0.126, 0.249))  # pyright: ignore
    twist = s(release) - EPS
    other = float(
        brentq(  # pyright: ignore
            lambda t: s(t) - twist * np.exp(-(t - release) / relaxing) + EPS, release, 0.37
        )
    )
    assert twist > 0.1 * EPS
    exact = np.zeros_like(times)
    gap = np.array([s(t) for t in times])
    for i, t in enumerate(times):
        if touch < t < release:
            exact[i], gap[i] = contact_force(t, 1), EPS
        elif release < t < other:
            gap[i] = s(t) - twist * np.exp(-(t - release) / relaxing)
        elif t > other and contact_force(t, -1) < 0.0:
            exact[i], gap[i] = contact_force(t, -1), -EPS
    before = times < 0.44
    assert np.any(exact < -10.0)
    np.testing.assert_allclose(run.force[before], exact[before], atol=2e-5)
    np.testing.assert_allclose(run.states[before, 2], gap[before], atol=1e-9)


def test_without_damper_the_backlash_is_a_dead_zone() -> None:
    run = response(held_flywheel(0.0, 30.0), sine_motion(2e-3, 2.0), np.linspace(0.0, 1.0, 401))
    s = run.displacement
    d = s - np.clip(s, -EPS, EPS)
    np.testing.assert_allclose(run.force, STIFFNESS * (1.0 + 30.0 * d) * d, atol=1e-6)


def test_a_vanishing_gap_is_no_gap() -> None:
    tight: dict[str, Any] = {
        "inertance": 20.0,
        "series_stiffness": STIFFNESS,
        "series_damping": DAMPING,
    }
    motion, times = sine_motion(2e-3, 3.0, np.pi / 2.0), np.linspace(0.0, 0.6, 121)
    exact = response(ReferenceDevice(**tight), motion, times, rtol=1e-9).force
    errors = []
    for eps in (1e-4, 1e-5, 1e-6):
        device = ReferenceDevice(backlash=eps, **tight)
        errors.append(np.max(abs(response(device, motion, times, rtol=1e-9).force - exact)))
    assert errors[0] > 1.0
    assert errors[1] < 0.3 * errors[0]
    assert errors[2] < 0.3 * errors[1]


@pytest.mark.parametrize("damping", [0.0, 30.0, DAMPING])
def test_energy_along_a_run_through_the_gap(damping: float) -> None:
    device = ReferenceDevice(
        inertance=20.0, series_stiffness=STIFFNESS, series_damping=damping, backlash=EPS,
        flywheel_viscous=40.0, inertance_gradient=20.0, inertance_speed_gradient=2.0,
        friction="dahl", coulomb_force=5.0,
    )  # fmt: skip
    times = np.linspace(0.0, 0.7, 14001)
    run = response(device, sine_motion(3e-3, 3.0, 0.4), times, rtol=1e-9)
    x, v, a = run.displacement, run.velocity, run.acceleration
    heat = np.asarray(device.dissipated_power(x, v, a, run.states))
    stored = np.asarray(device.stored_energy(x, v, run.states))
    work = np.trapezoid(run.force * v, times)
    assert np.ptp(run.states[:, 3]) == pytest.approx(2.0 * EPS)
    assert heat.min() >= -1e-9
    assert work == pytest.approx(stored[-1] - stored[0] + np.trapezoid(heat, times), rel=5e-4)


def test_series_damper_alone_is_a_first_order_lag() -> None:
    # constant speed on a resting flywheel: w = v (1 - exp(-c t / b)), F = c v exp(-c t / b)
    device = ReferenceDevice(inertance=40.0, series_damping=DAMPING)
    motion = Motion(lambda t: 0.1 * t, lambda t: 0.1 + 0.0 * t, lambda t: 0.0 * t)
    times = np.linspace(0.0, 1.0, 51)
    run = response(device, motion, times)
    np.testing.assert_allclose(run.force, DAMPING * 0.1 * np.exp(-DAMPING * times / 40.0), 1e-8)


def test_states_are_named_and_shaped() -> None:
    device = held_flywheel(DAMPING)
    assert device.state_names == ("series_deflection", "flywheel_velocity", "gap_position")
    with pytest.raises(ValueError, match="series_deflection, flywheel_velocity, gap_position"):
        device.force(0.0, 0.0, 0.0, np.zeros(2))
    with pytest.raises(ValueError, match="series element"):
        device.acceleration(0.0, 0.0, 1.0)
    many = np.random.default_rng(1).normal(size=(7, 3)) * [1e-3, 0.1, 4e-4]
    many[:, 2] = np.clip(many[:, 2], -EPS, EPS)
    together = np.asarray(device.force(np.zeros(7), np.full(7, 0.1), np.zeros(7), many))
    alone = [float(device.force(0.0, 0.1, 0.0, z)) for z in many]
    np.testing.assert_allclose(together, alone, rtol=1e-14)
    assert np.shape(device.state_rate(np.zeros(7), np.zeros(7), many)) == (7, 3)
    assert series.gap_rate(device, 0.0, 0.1, EPS) == 0.0
