"""Least squares on the core: recovers what was put in, and knows how well."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from inerter import Device
from inerter.catalogue.coordinates import search_range
from inerter.identify.channel import delayed
from inerter.identify.fit import Problem, parameter_errors, rms
from inerter.identify.model import Model
from inerter.identify.runs import BenchRun, scales
from three_sines import TIME, H, N, motion, run_of


def run(device: Device, noise: float, seed: int = 0, delay: float = 0.0) -> BenchRun:
    """A run of a device along three sines, force noise only."""
    random = np.random.default_rng(seed)
    force = device.along(H, *motion(late=delay))["total"] + random.normal(0, noise, N)
    return run_of(force, motion())


def problem(one: BenchRun) -> Problem:
    return Problem([one], [np.ones(N, bool)])


def test_linear_parameters_to_rounding() -> None:
    truth = {"inertance": 50.0, "viscous": 80.0, "stiffness": 700.0, "force_offset": -3.0,
             "quadratic_damping": 40.0}  # fmt: skip
    start = dict.fromkeys(truth, 1.0)
    fit = problem(run(Device(**truth), 0.0)).fit(Model("none", start, tuple(truth)))
    for name, value in truth.items():
        assert fit.model.values[name] == pytest.approx(value, rel=1e-6)


def test_load_on_a_bristle_is_recovered() -> None:
    truth = {"inertance": 50.0, "friction": "dahl", "coulomb_force": 20.0,
             "bristle_stiffness": 1e4, "load_friction": 0.2}  # fmt: skip
    start = {"inertance": 40.0, "coulomb_force": 10.0, "presliding": 1e-3, "load_friction": 0.05}
    fit = problem(run(Device(**truth), 0.05)).fit(Model("dahl", start, tuple(start)))
    for name, (value, stderr) in parameter_errors(fit).items():
        if name in truth:
            assert value == pytest.approx(truth[name], rel=0.01, abs=4 * stderr), name


def test_rate_and_state_is_recovered() -> None:
    truth = {"inertance": 50.0, "coulomb_force": 60.0, "rate_effect": 0.02, "age_effect": 0.06,
             "age_distance": 3e-4}  # fmt: skip
    held = {"transition_velocity": 1e-3}
    start = {"inertance": 40.0, "coulomb_force": 30.0, "rate_effect": 0.01, "age_effect": 0.01,
             "age_distance": 1e-3}  # fmt: skip
    one = run(Device(friction="rate_state", **truth, **held), 0.05)
    fit = problem(one).fit(Model("rate_state", {**start, **held}, tuple(start)))
    for name, (value, stderr) in parameter_errors(fit).items():
        assert value == pytest.approx(truth[name], rel=0.02, abs=4 * stderr), name
        assert stderr < 0.2 * truth[name], name


@pytest.mark.parametrize("law", ["dahl", "lugre"])
def test_bristles_are_recovered(law: str) -> None:
    truth = {"inertance": 50.0, "friction": law, "coulomb_force": 20.0, "bristle_stiffness": 1e4}
    start = {"inertance": 40.0, "coulomb_force": 10.0, "presliding": 1e-3}
    if law == "lugre":
        truth |= {"static_force": 30.0, "stribeck_velocity": 0.02, "bristle_damping": 50.0}
        start |= {"static_excess": 3.0, "stribeck_velocity": 0.05, "bristle_damping": 10.0}
    fit = problem(run(Device(**truth), 0.05)).fit(Model(law, start, tuple(start)))
    found = {name: value for name, (value, _) in parameter_errors(fit).items()}
    for name, value in truth.items():
        if name != "friction":
            assert found[name] == pytest.approx(value, rel=0.03), name


def test_a_fit_is_given_up_when_told_so() -> None:
    """After a step, with the evaluations so far and the error; what it has found stays."""
    truth = {"inertance": 50.0, "friction": "dahl", "coulomb_force": 20.0, "bristle_stiffness": 1e4}
    start = Model("dahl", {"inertance": 40.0, "coulomb_force": 10.0, "presliding": 1e-3},
                  ("inertance", "coulomb_force", "presliding"))  # fmt: skip
    given, asked = problem(run(Device(**truth), 0.05)), []

    def give_up(evaluations: int, error: float) -> bool:
        asked.append((evaluations, error))
        return evaluations >= 3

    fit = given.fit(start, give_up=give_up)
    assert asked[-1] == (fit.evaluations, pytest.approx(fit.rmse(given.masks), rel=1e-9))
    assert fit.evaluations == 3
    assert fit.rmse(given.masks) < 0.5 * rms(given.residual(start), given.masks)


@pytest.mark.parametrize("loss", ["linear", "soft_l1"])
def test_the_covariance_is_that_of_the_end_of_a_search(loss: str) -> None:
    """And not of the step before: a search that begins at that end has the same."""
    truth = {"inertance": 50.0, "friction": "dahl", "coulomb_force": 20.0, "bristle_stiffness": 1e4}
    values = {"inertance": 40.0, "coulomb_force": 10.0, "presliding": 1e-3}
    given = problem(run(Device(**truth), 0.5))
    fit = given.fit(Model("dahl", values, tuple(values)), loss=loss)
    again = given.fit(fit.model, evaluations=1, loss=loss)
    assert fit.evaluations > 3
    assert again.covariance == pytest.approx(fit.covariance, rel=1e-6)


def test_delay_is_found() -> None:
    device = Device(inertance=50.0, viscous=100.0)
    start = {"inertance": 40.0, "viscous": 10.0, "delay": 0.0}
    fit = problem(run(device, 0.1, delay=0.0031)).fit(Model("none", start, tuple(start)))
    assert fit.model.delay == pytest.approx(0.0031, abs=2e-5)


def test_standard_errors_are_those_of_repeated_records() -> None:
    """Over 60 records the spread of estimates is the stated error, and 95 % intervals hold."""
    device = Device(inertance=50.0, viscous=100.0, friction="coulomb", coulomb_force=8.0)
    names = ("inertance", "viscous", "coulomb_force")
    start = {"inertance": 50.0, "viscous": 100.0, "coulomb_force": 8.0}
    scores = []
    for seed in range(60):
        fit = problem(run(device, 0.5, seed)).fit(Model("coulomb", start, names))
        for name, (value, error) in parameter_errors(fit).items():
            scores.append((value - getattr(device, name)) / error)
    scores = np.array(scores)
    assert 0.8 < np.std(scores) < 1.25
    assert 0.88 < np.mean(np.abs(scores) < 1.96) < 0.99


def test_delayed_is_a_shift_of_third_order() -> None:
    errors = []
    for h in (2e-2, 1e-2):
        t = h * np.arange(int(4 / h))
        late = delayed(np.sin(5 * t), 0.0137, h)
        errors.append(np.max(np.abs(late - np.sin(5 * (t - 0.0137)))[20:-20]))
    assert errors[1] < errors[0] / 7


def test_bounds_hold() -> None:
    """Friction that pushes cannot be fitted by a damper: it stays at zero."""
    force = run(Device(inertance=50.0, force_offset=1.0), 0.1)
    pushed = replace(force, force=force.force - 30 * force.velocity)
    fit = problem(pushed).fit(
        Model("none", {"inertance": 50.0, "viscous": 5.0}, ("inertance", "viscous"))
    )
    assert 0 <= fit.model.values["viscous"] < 1e-3


def test_a_fit_stays_within_limits_and_is_free_beside_them() -> None:
    truth = {"inertance": 50.0, "viscous": 80.0, "stiffness": 700.0}
    one = problem(run(Device(**truth), 0.0))
    start = Model("none", {"inertance": 45.0, "viscous": 60.0, "stiffness": 500.0}, tuple(truth))
    here, reach = one.variables(start).encode(start.values), np.array([np.inf, 0.01, np.inf])
    limits = here - reach, here + reach
    fit = one.fit(start, within=limits)
    there = one.variables(fit.model).encode(fit.model.values)
    assert there[1] == pytest.approx(here[1] + 0.01, abs=1e-6)
    assert fit.model.values["inertance"] == pytest.approx(50.0, rel=0.01)
    # limits that hold the truth change nothing
    wide = one.fit(start, within=(here - 100.0, here + 100.0))
    assert wide.model.values == pytest.approx(truth, rel=1e-6)


def test_one_large_stroke_to_one_side_leaves_the_stops_where_they_can_be() -> None:
    """Stops at -5 and 7 mm; the last run goes from -19 to 35 mm, of which 8 mm is the middle."""
    wave, plain = np.sin(7 * TIME), run(Device(inertance=1.0), 0.0)
    motions = (5e-3 * wave, 6e-3 * wave, (8e-3 + 27e-3 * wave) * TIME / TIME[-1])
    sizes = scales([replace(plain, displacement=x) for x in motions])
    assert sizes.travel[0] < -15e-3
    assert sizes.travel[1] > 30e-3
    assert search_range("stop_lower", sizes).upper > -5e-3
    assert search_range("stop_upper", sizes).lower < 7e-3
