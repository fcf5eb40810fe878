"""One step of Gauss and Newton foretells what a candidate can gain."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from inerter.catalogue.effects import EFFECTS
from inerter.diagnose.candidates import Candidate, candidates
from inerter.diagnose.promise import Known, Promise
from inerter.diagnose.trials import FEW, Trials
from inerter.identify.fit import Fit, Problem, rms
from inerter.identify.model import Model
from inerter.identify.runs import BenchRun

RATE = 500.0
IDEAL = Model("none", {"inertance": 60.0, "transition_velocity": 1e-4}, ("inertance",))
SINES = ((0.02, 3.1), (0.01, 8.3), (0.005, 17.7))


# a low-pass is far as well, and is sought by itself (low_passes.py); a play is one of a bristle
FAR = {name for name, effect in EFFECTS.items() if effect.far} - {"sensor_filter", "friction_play"}


def problem(force: str, noise: float = 0.5) -> Problem:
    """A run of 10 s; `force` is what 60 kg have beside them, of x, v, a."""
    t = np.arange(0, 10, 1 / RATE)
    x, v, a = np.zeros((3, t.size))
    for phase, (size, rate) in enumerate(SINES):
        x += size * np.sin(rate * t + phase)
        v += size * rate * np.cos(rate * t + phase)
        a -= size * rate**2 * np.sin(rate * t + phase)
    beside = {"nothing": 0 * x, "viscous": 40 * v, "stiffness": 500 * x, "cubic": 2e6 * x**3}[force]
    total = 60 * a + beside + noise * np.random.default_rng(1).standard_normal(t.size)
    run = BenchRun(
        name="run",
        start=0.0,
        spacing=1 / RATE,
        displacement=x,
        velocity=v,
        acceleration=a,
        force=total,
        inner=np.ones(t.size, bool),
        first_force=float(total[0]),
        cutoff=np.inf,
    )
    return Problem([run], [np.ones(t.size, bool)])


def fitted(given: Problem) -> tuple[Fit, list[Candidate]]:
    fit = given.fit(IDEAL)
    return fit, list(candidates(fit.model, given.scales))


def holding(given: Problem, share: float) -> set[str]:
    fit, trials = fitted(given)
    promise, limit = Promise(given, Known(given, fit.model)), (1 - share) * fit.rmse(given.masks)
    return {trial.effect for trial in trials if promise.foretold(trial) < limit}


def test_noise_promises_nothing() -> None:
    assert holding(problem("nothing"), 0.02) == FAR


@pytest.mark.parametrize(
    ("force", "effect"),
    [
        ("viscous", "viscous_friction"),
        ("stiffness", "parallel_stiffness"),
        ("cubic", "hardening_stiffness"),
    ],
)
def test_what_is_there_is_promised(force: str, effect: str) -> None:
    assert effect in holding(problem(force), 0.5)


def test_of_a_linear_term_the_step_tells_what_the_fit_gains() -> None:
    """To the limit that the fit reaches a candidate holds, to one just below it does not."""
    given = problem("viscous")
    fit, trials = fitted(given)
    viscous = next(trial for trial in trials if trial.effect == "viscous_friction")
    reached = given.fit(viscous.starts[0])
    error = rms(reached.residual, given.masks)
    told = Promise(given, Known(given, fit.model)).foretold(viscous)
    assert told == pytest.approx(error, rel=1e-3)


def test_only_what_comes_near_the_best_is_followed_to_its_end() -> None:
    given = problem("viscous")
    fit, trials = fitted(given)
    found = Trials(given).fit_all(trials, fit)
    errors = [each.rmse(given.masks) for _, each in found]
    # what is near: damping, and what can be damping; the others stay as a few steps left them
    near = ("viscous_friction", "coulomb_friction", "stribeck_friction")
    dampers = ("asymmetric_damping", "digressive_damping", "viscous_drift")
    assert found[0][0].effect in (*near, *dampers)
    far = [each for (_, each), error in zip(found, errors, strict=True) if error > 2 * errors[0]]
    assert len(far) > 3
    assert all(each.evaluations <= FEW for each in far)
    # a rival that stays far above what it has to reach is rough as well
    aim = found[0][1]
    better = replace(aim, residual=[0.1 * each for each in aim.residual])
    rivals = Trials(given).fit_all(trials, fit, better)
    assert all(each.evaluations <= FEW for _, each in rivals)


def test_a_start_without_a_finite_force_promises_nothing() -> None:
    """A hysteresis that hardens without end, tried beside one that does not."""
    given = problem("viscous")
    fit, (candidate, *_) = fitted(given)
    promise = Promise(given, Known(given, fit.model))
    values = {
        "inertance": 60.0,
        "bw_alpha": 1.0,
        "bw_beta": -1e9,
        "bw_gamma": 0.0,
        "bw_stiffness": 1e3,
    }
    endless = Model("bouc_wen", {**fit.model.values, **values}, ("inertance", "bw_beta"))
    assert not np.isfinite(given.residual(endless)[0]).all()
    one, both = (replace(candidate, effect="viscous_friction", starts=s)
                 for s in ([endless], [endless, candidate.starts[0]]))  # fmt: skip
    assert promise.foretold(one) == np.inf
    assert promise.foretold(both) == promise.foretold(replace(one, starts=[candidate.starts[0]]))


def test_a_start_whose_force_runs_away_later_in_the_run_is_given_up() -> None:
    """On the part that starting points are compared on nothing is wrong."""
    given = problem("nothing")
    run = given.runs[0]
    far = run.displacement.copy()
    far[run.force.size // 2 :] = 1e110
    given = Problem([replace(run, displacement=far)], given.masks, given.scales)
    values = {
        **IDEAL.values, "stiffness_cubic": 1e3, "coulomb_force": 2.0, "bristle_stiffness": 1e4,
    }  # fmt: skip
    start = Model("dahl", values, ("inertance", "stiffness_cubic"))
    other = replace(start, values={**start.values, "coulomb_force": 5.0})
    trial = Candidate("hardening_stiffness", None, (start, other))
    with np.errstate(over="ignore", invalid="ignore"):
        fit = Trials(given).fit(trial)
        assert fit.rmse(given.masks) == np.inf
