"""Dampers behind a spring, as on a damper bench: asked for, told from a delay, taken apart."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from inerter.catalogue.effects import EFFECTS
from inerter.diagnose import diagnose_bench
from inerter.diagnose.candidates import candidates
from inerter.diagnose.composition import distinction, effects_of, without_effect
from inerter.diagnose.plainer import as_dampers_that_lag, as_plain_part
from inerter.identify.fit import Problem
from inerter.identify.model import Model
from inerter.identify.runs import thin
from inerter.records.preparation import prepare
from inerter.records.record import Record
from scipy.integrate import solve_ivp

# a damper of its own: two tanh for the valves, the deflection of its spring as the state
SLOPES = {1.0: (2600.0, 700.0, 0.1), -1.0: (1200.0, 350.0, 0.12)}
STIFFNESS, NOISE = 6e5, 2.0
EFFECT = "damper_elasticity"
VALVE = {"viscous": 1900.0, "damping_knee": 0.12, "damping_beyond": 0.3, "damping_asymmetry": 0.35}
"""Where a fit begins."""
HELD = {"inertance": 0.0, "transition_velocity": 1e-3}


def valve(w: float) -> float:
    slope, beyond, knee = SLOPES[1.0 if w > 0 else -1.0]
    return beyond * w + (slope - beyond) * knee * float(np.tanh(w / knee))


def record(name: str, size: float, frequency: float, seed: int) -> Record:
    """A sine of so many metres, some periods of it at 500 Hz."""
    rng, rate = np.random.default_rng(seed), 2.0 * np.pi * frequency
    t = np.arange(int(500 * max(3.0 / frequency, 1.0))) / 500.0
    speeds = np.linspace(-3.0, 3.0, 6001)
    forces = np.array([valve(w) for w in speeds])

    def bent(s: float, e: np.ndarray) -> list[float]:
        return [size * rate * np.cos(rate * s) - float(np.interp(STIFFNESS * e[0], forces, speeds))]

    begin = [valve(size * rate) / STIFFNESS]
    e = solve_ivp(bent, (0, t[-1]), begin, "LSODA", t, rtol=1e-7, atol=1e-10, max_step=2e-3).y[0]
    x = size * np.sin(rate * t)
    return Record(
        name=name,
        time=t,
        displacement=x + rng.normal(0.0, 1e-6, t.size),
        force=STIFFNESS * e + 1500.0 * x + rng.normal(0.0, NOISE, t.size),
    )


@pytest.fixture(scope="module")
def bench() -> list[Record]:
    strokes = ((0.025, 0.6), (0.025, 1.7), (0.025, 4.0), (0.005, 12.0))
    return [record(f"sine{i}", *stroke, i) for i, stroke in enumerate(strokes)]


@pytest.fixture(scope="module")
def problem(bench: list[Record]) -> Problem:
    runs = [thin(motion) for motion in prepare(bench).motions]
    return Problem(runs, [np.ones(run.force.size, bool) for run in runs])


def with_valve(**more: float) -> Model:
    values = VALVE | {"stiffness": 1500.0} | more
    return Model("none", HELD | values, tuple(values))


def test_it_is_asked_for_where_dampers_bend(problem: Problem) -> None:
    sizes = problem.scales
    asked = [each for each in candidates(with_valve(), sizes) if each.effect == EFFECT]
    assert len(asked) == 1
    assert all(each.values["damper_stiffness"] > 0.0 for each in asked[0].starts)
    # a straight one behind a spring is a spring that relaxes
    straight = with_valve().without(EFFECTS["digressive_damping"].coordinates)
    straight = straight.without(("damping_asymmetry",))
    falling = with_valve(damping_power_knee=0.1, damping_exponent=-0.5)
    for model in (straight, falling, with_valve(damper_stiffness=1e5)):
        assert not [each for each in candidates(model, sizes) if each.effect == EFFECT]


def test_its_fit_finds_the_spring_and_a_delay_does_not(problem: Problem) -> None:
    start = 20.0 * problem.scales.force / problem.scales.displacement
    fit = problem.fit(with_valve(damper_stiffness=start), 80)
    late = problem.fit(with_valve(delay=2e-3), 80)
    masks = problem.masks
    assert fit.model.values["damper_stiffness"] == pytest.approx(STIFFNESS, rel=0.02)
    assert fit.rmse(masks) < 0.75 * late.rmse(masks)
    baseline = Model("none", HELD, ())
    assert distinction(EFFECT, fit, baseline) > 20.0
    assert (EFFECT, None) in effects_of(fit.model, baseline)
    rigid = without_effect(fit.model, EFFECT, baseline)[0]
    assert "damper_stiffness" not in rigid.values
    assert "damping_knee" in rigid.values
    # what is tried in the place of the delay comes to it
    (tried,) = as_dampers_that_lag(late.model)
    best = problem.fit(tried, 80)
    assert best.model.values["damper_stiffness"] == pytest.approx(STIFFNESS, rel=0.02)
    assert "delay" not in best.model.values
    # a force that comes early is none of a damper
    assert not as_dampers_that_lag(late.model.holding(delay=-1e-3))


def test_a_branch_beside_a_valve_may_be_the_spring_before_it() -> None:
    model = with_valve(branch_stiffness_1=5e5, branch_time_1=1e-3)
    tried = as_plain_part(model, 10.0, 3.0)
    springs = [each for each in tried if "damper_stiffness" in each.values]
    assert len(springs) == 1
    assert springs[0].values["damper_stiffness"] == 5e5
    assert springs[0].values["viscous"] == pytest.approx(1900.0 + 500.0)
    assert springs[0].complexity == model.complexity - 1


def test_without_its_damper_there_is_no_spring_before_it() -> None:
    bare = with_valve(damper_stiffness=5e5).without(("viscous",))
    assert "damper_stiffness" not in bare.values
    assert bare.is_possible


@pytest.mark.long
def test_a_damper_bench_is_explained(bench: list[Record]) -> None:
    result = diagnose_bench(bench)
    told: dict[str, Any] = {each.effect: each for each in result.findings}
    assert EFFECT in told
    assert told[EFFECT].confidence > 0.9
    found = result.parameters["damper_stiffness"].value
    assert found == pytest.approx(STIFFNESS, rel=0.03)
    assert result.extended.rmse < 1.3 * NOISE
    assert EFFECTS[EFFECT].plain in result.verdict
    assert result.engines["mujoco"] == pytest.approx(result.extended.rmse, rel=0.05)
