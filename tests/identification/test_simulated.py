"""Fits by simulation: the measured force drives the model, the displacement is compared."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.identify.estimate import identify
from inerter.identify.model import Model
from inerter.identify.refine import simulated
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


@pytest.mark.long
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


def free(offset: float, name: str, frequency: float, late: float = 0.0) -> Record:
    """A damped inerter that nothing holds, its force known exactly; it begins within a stroke."""
    t = np.asarray(5e-3 * np.arange(800), dtype=np.float64)

    def motion(time: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        w, angle = 2 * np.pi * frequency, 2 * np.pi * frequency * time + 0.4
        return 3e-3 * np.sin(angle), 3e-3 * w * np.cos(angle), -3e-3 * w**2 * np.sin(angle)

    _, v, a = motion(t - late)
    x = motion(t)[0] + 1e-6 * np.random.default_rng(1).standard_normal(t.size)
    return Record(name=name, time=t, displacement=x, force=100.0 * a + 200.0 * v + offset)


def test_a_constant_force_is_kept_and_a_delay_is_held() -> None:
    """Both are in the measured force: without them a free device drifts, or moves too late."""
    values = {"inertance": 98.0, "viscous": 205.0, "force_offset": 4.9, "delay": 5e-3}
    start = start_from(Model("none", values, tuple(values)))
    assert start.values == values
    assert start.free == ("inertance", "viscous", "force_offset")
    runs = [free(5.0, "one", 1.0, 5e-3), free(5.0, "two", 1.5, 5e-3)]
    fit = fit_simulated([Simulator(run, delay=start.delay) for run in runs], start)
    assert fit.converged
    assert fit.error == pytest.approx(1e-6, rel=0.2)
    for name, truth in (("inertance", 100), ("viscous", 200), ("force_offset", 5)):
        assert fit.model.values[name] == pytest.approx(truth, rel=2e-3), name
    # the runs begin in the middle of a stroke
    for begin, w in zip(fit.begins, (2 * np.pi, 3 * np.pi), strict=True):
        assert begin == pytest.approx([3e-3 * np.sin(0.4), 3e-3 * w * np.cos(0.4)], rel=5e-3)


def test_a_run_begins_with_the_force_its_series_element_carries() -> None:
    """The flywheel of a tone that is already there, from its transfer function."""
    t = np.asarray(1e-3 * np.arange(3000), dtype=np.float64)
    w, b, k, c = 2 * np.pi * 3.0, 10.0, 4e4, 150.0
    # the spring and damper carry the force that moves the flywheel
    x = 40.0 * (1 / (-b * w**2) + 1 / (k + 1j * w * c))
    wave = np.exp(1j * (w * t + 0.7))
    model = Model("none", {"inertance": b, "series_stiffness": k, "series_damping": c}, ())
    run = Record(name="run", time=t, displacement=np.real(x * wave), force=np.real(40.0 * wave))
    fit = fit_simulated([Simulator(run)], model)
    assert fit.error < 5e-4 * np.std(run.displacement)


def test_figures_are_those_of_the_device_that_is_told() -> None:
    runs = [free(5.0, "one", 1.0), free(5.0, "two", 1.5)]
    bench = identify(runs, ["viscous+offset"], intervals="normal")
    after = simulated(bench)
    told = {each.law: each for each in after.results}
    new, old = told["viscous+offset, simulated"], told["viscous+offset"]
    assert new.device.inertance == pytest.approx(100.0, rel=2e-3)
    assert new.device.force_offset == pytest.approx(5.0, rel=2e-3)
    for each in (new, old):
        assert vars(each.judge(each.model)).items() <= vars(each).items()
    assert new.rmse != old.rmse
    # the better comes first
    assert [each.motion.rmse for each in after.results if each.motion] == sorted(
        each.motion.rmse for each in (new, old) if each.motion
    )


@pytest.mark.long
def test_a_simulation_that_drifts_away_is_not_the_best() -> None:
    """The law lacks the constant force; a huge inertance would keep the device in its place."""
    runs = [free(5.0, "one", 1.0), free(5.0, "two", 1.5)]
    best = simulated(identify(runs, ["viscous"], intervals="normal")).best
    assert best.law == "viscous"
    assert best.device.inertance == pytest.approx(100.0, rel=0.1)
    assert "a force that the law lacks (try +offset)" in best.notes[-1]


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
