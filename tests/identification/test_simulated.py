"""Fits by simulation: the measured force drives the model, the displacement is compared."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.identify.model import Model
from inerter.identify.simulated import Simulator, device_from, fit_simulated, start_from
from inerter.records import Record
from scipy.integrate import solve_ivp

H, N = 2e-3, 2500
TIME = np.asarray(H * np.arange(N), dtype=np.float64)
TRUTH = {"inertance": 5.0, "viscous": 40.0, "stiffness": 8e3, "coulomb_force": 6.0,
         "presliding": 3e-4}  # fmt: skip
MODEL = Model("dahl", TRUTH, tuple(TRUTH))


def drive(t: np.ndarray | float, phase: float = 0.0) -> np.ndarray:
    tones = ((30, 1.1, 0.0), (25, 4.3, 1.0 + phase), (15, 9.7, 2 * phase))
    force = sum(a * np.sin(2 * np.pi * f * t + p) for a, f, p in tones)
    return np.asarray(force * np.minimum(t / 0.5, 1.0))


def record(noise: float, phase: float = 0.0, name: str = "run") -> Record:
    """A Dahl oscillator by SciPy, which knows nothing of the plugin."""

    def rate(t: float, y: np.ndarray) -> list[float]:
        x, v, z = y
        stiffness = TRUTH["coulomb_force"] / TRUTH["presliding"]
        bristle = stiffness * z
        force = float(drive(t, phase)) - 40.0 * v - 8e3 * x - bristle
        return [v, force / 5.0, v - abs(v) * z / TRUTH["presliding"]]

    found = solve_ivp(
        rate, (0, TIME[-1]), [0, 0, 0], t_eval=TIME, method="LSODA", rtol=1e-9, atol=1e-12,
        max_step=1e-3,
    )  # fmt: skip
    random = np.random.default_rng(1)
    displacement = found.y[0] + noise * random.standard_normal(N)
    return Record(name=name, time=TIME, displacement=displacement, force=drive(TIME, phase))


def test_simulation_follows_the_equations() -> None:
    exact = record(0.0)
    x = Simulator(exact, finer=8).displacements([MODEL])[0]
    assert np.max(np.abs(x - exact.displacement)) < 3e-5 * np.std(x)


def test_it_converges_with_the_second_order_of_the_held_force() -> None:
    exact = record(0.0)
    errors = [
        np.max(np.abs(Simulator(exact, finer=n).displacements([MODEL])[0] - exact.displacement))
        for n in (2, 4)
    ]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.3)


def test_two_runs_with_noise_give_the_device_back() -> None:
    runs = [record(1e-5, name="one"), record(1e-5, 0.8, "two")]
    start = Model(
        "dahl",
        {name: v * (1.2 if i % 2 else 0.8) for i, (name, v) in enumerate(TRUTH.items())},
        tuple(TRUTH),
    )
    fit = fit_simulated([Simulator(run, finer=4) for run in runs], start)
    assert fit.error == pytest.approx(1e-5, rel=0.05)
    for i, name in enumerate(fit.model.free):
        error = float(np.sqrt(fit.covariance[i, i]))
        # the held force's own error is a thousandth
        assert abs(fit.model.values[name] - TRUTH[name]) < 4 * error + 1e-3 * TRUTH[name], name
        assert error < 0.01 * TRUTH[name]
    assert device_from(fit).friction == "dahl"


def test_a_delay_and_an_offset_are_no_matter_of_motion() -> None:
    values = {**TRUTH, "delay": 1e-3, "force_offset": 2.0}
    start = start_from(Model("dahl", values, tuple(values)))
    assert set(start.values) == set(start.free) == set(TRUTH)


def test_records_that_cannot_be_simulated_are_refused() -> None:
    exact = record(0.0)
    with pytest.raises(ValueError, match=r"no longer than the 9 s left to settle"):
        Simulator(exact, settle=9.0)
    uneven: np.ndarray = np.array(TIME, dtype=np.float64)
    uneven[1000:] += 5e-3
    gap = Record(name="gap", time=uneven, displacement=exact.displacement, force=exact.force)
    with pytest.raises(ValueError, match="gap: not uniformly sampled"):
        Simulator(gap)
    with pytest.raises(ValueError, match="until is"):
        fit_simulated([Simulator(exact)], MODEL, until=0.1)
