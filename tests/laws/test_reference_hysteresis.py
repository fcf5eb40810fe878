"""Laws with memory against closed forms and published runs."""

import numpy as np
import pytest
from inerter.reference import (
    Motion,
    ReferenceDevice,
    response,
    sine_motion,
    strokes,
    sum_of_sines,
)
from scipy.integrate import solve_ivp

LEVEL, STIFFNESS, AMPLITUDE = 20.0, 5e4, 1e-3


def dahl_loop(x: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Steady Dahl loop (n = 1) under a harmonic motion of AMPLITUDE: an exponential per stroke."""
    reach = LEVEL / STIFFNESS
    tip = np.tanh(AMPLITUDE / reach)
    up = 1.0 - (1.0 + tip) * np.exp(-(x + AMPLITUDE) / reach)
    down = -1.0 + (1.0 + tip) * np.exp((x - AMPLITUDE) / reach)
    return LEVEL * np.where(v > 0.0, up, down)


@pytest.mark.rarely("Radau")
@pytest.mark.parametrize("method", ["LSODA", "Radau"])
def test_dahl_loop_closed_form(method: str) -> None:
    device = ReferenceDevice(friction="dahl", coulomb_force=LEVEL, bristle_stiffness=STIFFNESS)
    # sampled off the reversals, in the fifth cycle
    times = np.concatenate(([0.0], 4.0 + (np.arange(500) + 0.5) / 500.0))
    run = response(device, sine_motion(AMPLITUDE, 1.0), times, method=method)
    exact = dahl_loop(run.displacement[1:], run.velocity[1:])
    np.testing.assert_allclose(run.force[1:], exact, atol=1e-6 * LEVEL)


def test_dahl_loop_work_closed_form() -> None:
    # area of the loop: 4 f_c (A - z_c tanh(A / z_c))
    device = ReferenceDevice(friction="dahl", coulomb_force=LEVEL, bristle_stiffness=STIFFNESS)
    reach = LEVEL / STIFFNESS
    run = response(device, sine_motion(AMPLITUDE, 1.0), np.linspace(0.0, 6.0, 60001))
    last = run.time >= 5.0
    work = np.trapezoid(run.force[last], run.displacement[last])
    assert work == pytest.approx(4 * LEVEL * (AMPLITUDE - reach * np.tanh(AMPLITUDE / reach)), 1e-5)


@pytest.mark.parametrize("exponent", [0.5, 2.0])
def test_dahl_exponent_closed_form(exponent: float) -> None:
    # from z = 0 with u = 1 - s z / f: u^(1-n) = 1 - (1-n) s x / f, u >= 0
    device = ReferenceDevice(
        friction="dahl", coulomb_force=LEVEL, bristle_stiffness=STIFFNESS, dahl_exponent=exponent
    )
    motion = Motion(lambda t: 1e-3 * t, lambda t: 1e-3 + 0.0 * t, lambda t: 0.0 * t)
    times = np.linspace(0.0, 0.7, 50)
    run = response(device, motion, times)
    power = 1.0 - exponent
    gap = (1.0 - power * STIFFNESS * run.displacement / LEVEL) ** (1.0 / power)
    np.testing.assert_allclose(run.force, LEVEL * (1.0 - gap), atol=1e-7 * LEVEL)


def test_bouc_wen_without_gamma_is_dahl() -> None:
    dahl = ReferenceDevice(friction="dahl", coulomb_force=LEVEL, bristle_stiffness=STIFFNESS)
    bouc_wen = ReferenceDevice(
        friction="bouc_wen", bw_beta=STIFFNESS / LEVEL, bw_gamma=0.0, bw_stiffness=STIFFNESS
    )
    motion = sum_of_sines([1e-3, 7e-4], [1.0, 2.7], [0.3, 1.0])
    times = np.linspace(0.0, 2.0, 400)
    one, other = response(dahl, motion, times), response(bouc_wen, motion, times)
    np.testing.assert_allclose(one.force, other.force, atol=1e-7 * LEVEL)


def test_bouc_wen_saturates_where_the_formula_says() -> None:
    device = ReferenceDevice(
        friction="bouc_wen", bw_alpha=1.2, bw_beta=2e6, bw_gamma=1e6, bw_exponent=2.0,
        bw_stiffness=1e4,
    )  # fmt: skip
    run = response(device, strokes([0.0, 0.02], [0.0], [1.0]), [0.0, 1.0])
    assert run.state[-1] == pytest.approx((1.2 / 3e6) ** 0.5, rel=1e-6)


@pytest.mark.parametrize("speed", [-0.05, -1e-3, 2e-4, 0.01])
def test_lugre_slides_on_the_stribeck_curve(speed: float) -> None:
    device = ReferenceDevice(
        friction="lugre", coulomb_force=10.0, static_force=15.0, stribeck_velocity=2e-3,
        bristle_stiffness=1e5, bristle_damping=300.0, viscous=4.0,
    )  # fmt: skip
    motion = Motion(lambda t: speed * t, lambda t: speed + 0.0 * t, lambda t: 0.0 * t)
    curve = 10.0 + 5.0 * np.exp(-((abs(speed) / 2e-3) ** 2))
    settle = curve / (1e5 * abs(speed))
    times = np.linspace(0.0, 40.0 * settle, 200)
    run = response(device, motion, times)

    # approach: z = g / sigma0 (1 - exp(-sigma0 |v| t / g)); end: F = g sgn v + sigma2 v
    state = np.sign(speed) * curve / 1e5 * -np.expm1(-times / settle)
    np.testing.assert_allclose(run.state, state, atol=1e-8 * curve / 1e5)
    assert run.force[-1] == pytest.approx(np.sign(speed) * curve + 4.0 * speed, rel=1e-9)


@pytest.mark.long
def test_lugre_leaps_over_no_stribeck_peak() -> None:
    # a curve much narrower than the time between reversals, against fifty times finer steps
    device = ReferenceDevice(
        friction="lugre", coulomb_force=10.0, static_force=15.0, stribeck_velocity=1e-3
    )
    motion = sum_of_sines([5e-3, 1e-3, 3e-4], [0.5, 2.3, 5.9], [0.3, 1.0, 2.0])
    times = np.arange(0.0, 3.0, 1e-3)
    run = response(device, motion, times)
    fine = response(device, motion, times, rtol=1e-12, scan_step=2e-5)
    np.testing.assert_allclose(run.state, fine.state, atol=1e-7 * 15.0 / 1e5)


def test_lugre_stick_slip_of_canudas_de_wit() -> None:
    # 1 kg pulled over LuGre friction by a spring of 2 N/m whose end moves at 0.1 m/s (fig. 4 of
    # the 1995 paper); reference numbers from Exudyn's own example, DOPRI5
    device = ReferenceDevice(
        friction="lugre", coulomb_force=1.0, static_force=1.5, stribeck_velocity=1e-3,
        bristle_stiffness=1e5, bristle_damping=float(np.sqrt(1e5)), viscous=0.4,
    )  # fmt: skip

    def rates(t: float, y: np.ndarray) -> list[float]:
        x, v, z = map(float, y)
        force = float(device.force(x, v, 0.0, z))
        return [v, 2.0 * (0.1 * t - x) - force, float(device.state_rate(x, v, z))]

    end = solve_ivp(rates, (0.0, 25.0), [0.0] * 3, method="LSODA", rtol=1e-12, atol=1e-15).y[:, -1]
    assert end[0] == pytest.approx(1.9088391992, abs=3e-10)
    assert end[1] == pytest.approx(9.42415459e-6, rel=1e-8)
    assert end[2] == pytest.approx(1.18167954559e-5, rel=1e-9)


PUBLISHED = {
    # identified sets of "Modelling and identification of the hysteretic dynamics of inerters";
    # peaks at 1, 2, 3, 4 Hz with 10, 8, 6, 4 mm
    "dahl": (
        {
            "friction": "dahl", "bristle_stiffness": 4.29e4, "coulomb_force": 62.0,
            "viscous": 10.2, "inertance": 174.0,
        },
        (96.2, 197.5, 314.8, 378.1),
    ),
    "lugre_as_printed": (
        # printed z' = v - |v| z / g: g_standard = sigma0 g_printed
        {
            "friction": "lugre", "bristle_stiffness": 149.21, "bristle_damping": 443.35,
            "viscous": 204.38, "static_force": 149.21 * 1.43, "coulomb_force": 149.21 * 1.0,
            "stribeck_velocity": 4.19e-2, "stribeck_exponent": 1.98, "inertance": 151.51,
        },
        (71.2, 201.1, 330.4, 387.7),
    ),
    "lugre_standard": (
        {
            "friction": "lugre", "bristle_stiffness": 149.21, "bristle_damping": 443.35,
            "viscous": 204.38, "static_force": 1.43, "coulomb_force": 1.0,
            "stribeck_velocity": 4.19e-2, "stribeck_exponent": 1.98, "inertance": 151.51,
        },
        (79.2, 211.4, 337.6, 391.1),
    ),
    "bouc_wen": (
        {
            "friction": "bouc_wen", "bw_alpha": 1.23, "bw_beta": 1.61, "bw_gamma": 1.35,
            "bw_exponent": 1.0, "bw_ratio": 341.81, "viscous": 132.0, "bw_stiffness": 1.01,
            "inertance": 154.36,
        },
        (62.3, 196.1, 329.9, 390.6),
    ),
    # b = (2 pi / P)^2 J with P = 4 mm, J = 6.43e-5 kg m^2
    "ideal": ({"inertance": (2.0 * np.pi / 4e-3) ** 2 * 6.43e-5}, (62.6, 200.4, 338.2, 400.9)),
}  # fmt: skip


@pytest.mark.parametrize("name", PUBLISHED)
def test_published_peak_forces(name: str) -> None:
    parameters, peaks = PUBLISHED[name]
    device = ReferenceDevice(**parameters)  # type: ignore[arg-type]
    for peak, amplitude, frequency in zip(
        peaks, (10e-3, 8e-3, 6e-3, 4e-3), (1.0, 2.0, 3.0, 4.0), strict=True
    ):
        times = np.linspace(0.0, 6.0, 19201)
        run = response(device, sine_motion(amplitude, frequency), times, rtol=1e-8)
        settled = abs(run.force[times > 4.0])
        assert np.max(settled) == pytest.approx(peak, abs=0.06)


def test_initial_state_and_bad_times() -> None:
    device = ReferenceDevice(friction="dahl", coulomb_force=LEVEL, bristle_stiffness=STIFFNESS)
    held = response(device, strokes([0.01], [], []), [0.0, 1.0], initial_state=1e-4)
    assert held.force[-1] == pytest.approx(5.0, rel=1e-12)
    with pytest.raises(ValueError, match="increase"):
        response(device, sine_motion(1e-3, 1.0), [0.0, 0.0])
