"""The fluid inerter on its shaker: published numbers, the printed equations, the bare shaker."""

from typing import Any

import numpy as np
import pytest
from inerter.reference import (
    FLUID_INERTER,
    SHAKER,
    FluidInerterTest,
    ReferenceDevice,
    complete_device,
    dry_device,
    receptance,
    sweep_voltage,
)
from scipy.integrate import solve_ivp

LOOSE: dict[str, Any] = {"rtol": 1e-4, "atol": 1e-7}


@pytest.mark.often("0.35-0.55-0.117")
@pytest.mark.parametrize(
    ("first", "last", "published"),
    [(0.35, 0.55, 0.117), (0.40, 0.60, 0.145), (0.50, 0.70, 0.181), (0.60, 0.80, 0.203)],
)
def test_dry_receptance_at_one_hertz(first: float, last: float, published: float) -> None:
    # mm/N; the sweep passes 1 Hz after 2.6 s, so that its first 8 s say it all
    times = np.arange(0.0, 8.0, 1.0 / 200.0)
    run = FluidInerterTest().simulate(sweep_voltage(first, last), times, **LOOSE)
    frequencies, found = receptance(run)
    at = int(np.argmin(abs(frequencies - 1.0)))
    assert frequencies[at] == pytest.approx(1.0)
    assert abs(found[at]) * 1e3 == pytest.approx(published, abs=5e-4)


def lowest(air_damping: float, air_column: float) -> float:
    """Frequency [Hz] of the anti-resonance in the part of the sweep from 2.8 to 6.6 Hz."""
    device = complete_device(air_damping=air_damping, air_column=air_column)
    times = np.arange(12.0, 32.0, 1.0 / 128.0)
    run = FluidInerterTest(device=device).simulate(
        sweep_voltage(0.4, 0.6), times, method="LSODA", **LOOSE
    )
    assert run.inside.all()
    # one Hann window over all of it: every frequency seen as the sweep passes it
    frequencies, found = receptance(run, segment=20.0)
    near = (frequencies > 3.5) & (frequencies < 6.0)
    return float(frequencies[near][np.argmin(abs(found[near]))])


@pytest.mark.long
def test_anti_resonance_of_the_complete_test() -> None:
    without, weak, strong = lowest(300.0, 0.0), lowest(300.0, 0.016), lowest(700.0, 0.016)
    assert 4.4 < without < weak < strong < 4.9


def test_laws_of_the_device_are_the_printed_equations() -> None:
    # the paper's three coordinates (piston, water, charge), typed from it
    p, s = FLUID_INERTER, SHAKER
    b = 995.6 * 1.7 * 1.649e-3**2 / 2.827e-5
    volume, area = 1.649e-3 * 0.016, 1.649e-3
    voltage = sweep_voltage(0.3, 0.3, preload=0.05)

    def rates(t: float, y: np.ndarray) -> list[float]:
        x1, x2, _, v1, v2, i = y
        speed = v1 / 0.013
        peak = 25.0 * abs(speed) / (speed**2 / 4.0 + 0.75) ** 2
        friction = (25.0 * np.tanh(4.0 * abs(speed)) + peak) * np.sign(v1) + 515.0 * v1
        fluid = 1.25e5 * (1.0 - 43.0 * (x2 - x1)) * (x1 - x2) + 950.0 * (v1 - v2)
        air = 1.4 * 101325.0 * area**2 / volume * (1.0 - 1.2 * area / volume * x2) * x2
        return [
            v1, v2, i,
            (20.0 * i - 106.59 * x1 - 6.79 * v1 - friction - fluid) / 3.7,
            (fluid - air - 300.0 * v2) / b,
            (19.0 * voltage(t) - 1.75 * i - 20.0 * v1) / 0.022,
        ]  # fmt: skip

    times = np.linspace(0.0, 1.5, 31)
    exact = solve_ivp(
        rates, (0.0, 1.5), np.zeros(6), t_eval=times, method="DOP853", rtol=1e-9, atol=1e-12
    ).y
    test = FluidInerterTest(device=complete_device(air_damping=p.air_damping_preload[0]))
    run = test.simulate(voltage, times, rtol=1e-7, atol=1e-10)
    assert s.gain * 0.05 == pytest.approx(0.95)
    assert np.max(abs(exact[0])) > 1e-3
    assert run.inside.all()
    np.testing.assert_allclose(run.displacement, exact[0], atol=1e-8)
    np.testing.assert_allclose(run.displacement - run.device_states[:, 0], exact[1], atol=1e-8)
    np.testing.assert_allclose(run.current, exact[5], atol=1e-5)


def test_bare_shaker_has_its_transfer_function() -> None:
    # X / U = G alpha_1 / ((m p^2 + c p + k)(L p + R) + alpha_1 alpha_2 p)
    test = FluidInerterTest(device=ReferenceDevice(), piston_mass=0.0)
    p = 2j * np.pi * 4.0
    mechanical = 2.7 * p * p + 6.79 * p + 106.59
    transfer = 19.0 * 20.0 / (mechanical * (0.022 * p + 1.75) + 400.0 * p)
    # started on the harmonic solution, the run stays on it
    current = mechanical * transfer / 20.0
    start = [transfer.imag, 0.0, (p * transfer).imag, current.imag]
    times = np.linspace(0.0, 1.0, 33)
    run = test.simulate(lambda t: float(np.sin(8.0 * np.pi * t)), times, initial=start)
    exact = (transfer * np.exp(p * times)).imag
    np.testing.assert_allclose(run.displacement, exact, atol=1e-6 * abs(transfer))


def test_load_cell_and_shaker_balance() -> None:
    times = np.linspace(0.0, 1.0, 51)
    run = FluidInerterTest().simulate(sweep_voltage(0.5, 0.7), times, rtol=1e-6, atol=1e-9)
    coil = 20.0 * run.current
    beside = 2.7 * run.acceleration + 6.79 * run.velocity + 106.59 * run.displacement
    np.testing.assert_allclose(run.force, coil - beside, atol=1e-8)
    dry = dry_device()
    friction = dry.force(run.displacement, run.velocity, run.acceleration)
    np.testing.assert_allclose(run.device_force, np.asarray(friction), atol=1e-8)


def test_leaving_the_gas_law_is_said() -> None:
    device = complete_device(air_column=1e-3)
    start = np.zeros(FluidInerterTest(device=device).nstate)
    start[0] = 2e-3  # water and piston 2 mm out, beyond V0 / (2.4 A) = 0.42 mm
    run = FluidInerterTest(device=device).simulate(
        lambda t: 0.0, [0.0, 1e-3], initial=start, **LOOSE
    )
    assert not run.inside.any()
    assert np.all(np.isfinite(run.displacement))
