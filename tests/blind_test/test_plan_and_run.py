"""Which cases there are, and that none is lost on the way."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from inerter.blind_test import case as blind_case
from inerter.blind_test.case import (
    Named,
    Outcome,
    ParameterError,
    compare,
    hide,
    plainer_forms,
    shown_parameters,
    solve,
)
from inerter.blind_test.plan import Plan, Task
from inerter.blind_test.run import run_tasks
from inerter.core import Device
from inerter.diagnose.result import Accuracy, Diagnosis, Finding, ParameterValue, Unexplained
from inerter.reference import EFFECTS, UNKNOWN, HiddenCase, compatible, hide_effect
from inerter.reference.bench_realistic import Chain
from made_up import solve_or_die


def test_plan_counts_and_seeds() -> None:
    plan = Plan(count=2, clean=3, pairs=30, triples=20, unknown=12, seed=5)
    tasks = plan.tasks()
    assert Counter(task.group for task in tasks) == {
        "single": 2 * len(EFFECTS), "clean": 3, "pairs": 30, "triples": 20, "unknown": 12,
    }  # fmt: skip
    assert all(compatible(task.effects) for task in tasks if task.effects)
    assert all(len(task.effects) == 3 for task in tasks if task.group == "triples")
    assert len({task.effects for task in tasks if task.group == "pairs"}) == 30
    assert {task.kind for task in tasks if task.group == "unknown"} == set(UNKNOWN)
    laws = [task.law for task in tasks if task.effects == ("hysteretic_friction",)]
    assert laws == ["dahl", "lugre"]
    assert len({task.seed for task in tasks}) == len(tasks)

    # a case does not depend on what else is asked for
    alone = Plan(effects=("backlash",), count=2, seed=5).tasks()
    assert alone == [task for task in tasks if task.effects == ("backlash",)]
    assert alone != Plan(effects=("backlash",), count=2, seed=6).tasks()


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"effects": ("gremlins",)}, "gremlins"),
        ({"effects": ("backlash", "backlash")}, "twice"),
        ({"noise": 2.0}, "--noise: 2"),
        ({"count": -1}, "--count"),
        ({"count": 0}, "no case"),
        ({"effects": ("coulomb_friction", "stribeck_friction"), "pairs": 1}, "--pairs"),
    ],
)
def test_impossible_plans_are_refused(wrong: dict, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        Plan(**wrong)


def test_noise_levels() -> None:
    levels = Task(group="clean", seed=1, noise=0.05).levels
    assert (levels.force, levels.force_share) == (0.0, 0.05)
    assert levels.displacement == pytest.approx(5e-6)


def test_a_process_that_dies_is_a_failure_of_its_case_alone() -> None:
    tasks = [Task(group="clean", seed=seed, noise=0.01) for seed in (1, 2, 3)]
    shares: list[float] = []
    first, died, last = run_tasks(tasks, 2, shares.append, solve_or_die)
    assert (first.verdict, last.verdict) == ("1", "3")
    assert died.first == "failed"
    assert died.error == "the process ended without a result (exit status 9)"
    assert all(0.0 <= share <= 1.0 for share in shares)


CALLS: list[int] = []


def solve_and_count(task: Task) -> Outcome:
    CALLS.append(task.seed)
    named = (Named("backlash", None, 0.75),)
    errors = (ParameterError("backlash", "backlash", 1e-4, float("nan"), None),)
    return Outcome(task=task, named=named, parameters=errors, gain=0.5, verdict=str(task.seed))


def test_a_test_that_was_broken_off_goes_on(tmp_path: Path) -> None:
    """What was found by the same code is taken as it is; the rest, and what is torn, is done."""
    tasks = [
        Task(group="single", seed=seed, noise=0.01, effects=("backlash",)) for seed in (1, 2, 3)
    ]
    CALLS.clear()
    before = run_tasks(tasks[:2], 1, work=solve_and_count, folder=tmp_path)
    torn = next(tmp_path.glob("*-2.json"))
    torn.write_text(torn.read_text()[:50])
    after = run_tasks(tasks, 1, work=solve_and_count, folder=tmp_path)
    assert CALLS == [1, 2, 2, 3]
    assert repr(after[:2]) == repr(before)
    assert [outcome.verdict for outcome in after] == ["1", "2", "3"]

    # another code
    kept = next(tmp_path.glob("*-1.json"))
    kept.write_text(kept.read_text().replace('"code": "', '"code": "x'))
    run_tasks(tasks, 1, work=solve_and_count, folder=tmp_path)
    assert CALLS[4:] == [1]
    assert len(list(tmp_path.iterdir())) == 3


def test_effects_take_turns() -> None:
    plan = Plan(effects=("coulomb_friction", "backlash"), count=2)
    assert [task.effects[0] for task in plan.tasks()] == ["coulomb_friction", "backlash"] * 2
    assert len({task.name for task in plan.tasks()}) == 4


def test_a_diagnosis_that_raises_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(records: object, device: Device | None) -> None:
        assert device is not None
        raise RuntimeError("two\nlines")

    monkeypatch.setattr(blind_case, "diagnose_bench", fail)
    found = solve(Task(group="single", seed=3, noise=0.01, effects=("inertance_error",)))
    assert found.error == "RuntimeError: two lines"
    assert found.first == "failed"
    assert "inertance" in found.truth


def _diagnosis(effect: str, law: str | None, values: dict[str, tuple[float, float]]) -> Diagnosis:
    named = {name: ParameterValue(value, error, "") for name, (value, error) in values.items()}
    finding = Finding(
        effect=effect,
        law=law,
        confidence=0.9,
        parameters=named,
        rmse_before=2.0,
        rmse_after=1.0,
        evidence="",
        rivals=[],
    )
    device: dict[str, float | str] = {name: value for name, (value, _) in values.items()}
    return Diagnosis(
        records=[],
        baseline=Accuracy({}, 2.0, 1.0),
        findings=[finding],
        extended=Accuracy(device, 1.0, 0.5),
        noise_floor=0.1,
        unexplained=Unexplained(significant=False, fraction=0.0, depends_on=[], summary=""),
        engines={},
        verdict="words",
    )


def test_parameters_are_compared_by_name() -> None:
    task = Task(group="single", seed=4, noise=0.0, effects=("hysteretic_friction",), law="dahl")
    case = hide(task)
    level = case.parameters["coulomb_force"]
    right = {"coulomb_force": (1.1 * level, level), "bristle_stiffness": (1.0, 0.1)}
    found = compare(task, case, _diagnosis("hysteretic_friction", "dahl", right))
    errors = {error.name: error for error in found.parameters}
    assert errors["coulomb_force"].relative == pytest.approx(0.1)
    assert errors["coulomb_force"].near
    assert not errors["bristle_stiffness"].near

    # another law's parameters mean something else
    other = compare(task, case, _diagnosis("hysteretic_friction", "lugre", right))
    assert other.parameters == ()
    assert other.first == "hysteretic_friction"


def test_gas_is_compared_by_what_the_data_see() -> None:
    task = Task(group="single", seed=5, noise=0.0, effects=("gas_spring",))
    case = hide(task)
    p = case.parameters
    # twice the area, half the pressure, twice the volume: the same spring
    same = {
        "gas_pressure": (p["gas_pressure"] / 2, 0.0), "gas_area": (p["gas_area"] * 2, 0.0),
        "gas_volume": (p["gas_volume"] * 2, 0.0), "gas_exponent": (p["gas_exponent"], 0.0),
    }  # fmt: skip
    errors = compare(task, case, _diagnosis("gas_spring", None, same)).parameters
    assert {error.name for error in errors} == {"gas_force", "gas_reach", "gas_exponent"}
    assert all(error.relative < 1e-12 for error in errors)


def realistic(effect: str, **chain: float) -> HiddenCase:
    """A case on a bench that does what is said to its records, and nothing else."""
    case = hide_effect(5, effect, realistic=True)
    return replace(case, chain=Chain(**chain))  # pyright: ignore[reportArgumentType]


def test_a_bench_without_filters_shows_its_mass_and_drift_with_those_hidden() -> None:
    drifting = realistic("force_drift", drift=0.5)
    hidden, run = drifting.parameters["force_drift"], drifting.runs[0]
    shown = shown_parameters(drifting)["force_drift"]
    assert drifting.chain is not None
    added = drifting.chain.force(run.truth) - run.truth.force
    slope = np.polyfit(run.truth.time - run.truth.time[0], added, 1)[0]
    assert shown - hidden == pytest.approx(slope)

    loaded = realistic("load_dependent_friction", grip_mass=3.0)
    assert loaded.chain is not None
    b, mu = loaded.device.inertance, shown_parameters(loaded)["load_friction"]
    a = loaded.runs[0].truth.acceleration
    # mu |b a| of the device is mu' |(b + m) a| of what is measured
    np.testing.assert_allclose(
        mu * np.abs((b + 3.0) * a), loaded.parameters["load_friction"] * np.abs(b * a)
    )
    assert shown_parameters(realistic("inertance_error", grip_mass=3.0))["inertance"] == (
        pytest.approx(realistic("inertance_error").parameters["inertance"] + 3.0)
    )


def test_a_mass_that_is_not_told_makes_a_shaft_stiffer_and_a_ratio_more_even() -> None:
    case = realistic("series_elasticity", grip_mass=2.0)
    device, told = case.device, shown_parameters(case)
    s = 2j * np.pi * 0.02 * np.sqrt(device.series_stiffness / device.inertance) / (2 * np.pi)

    def per_acceleration(b: float, k: float, c: float) -> complex:
        return b * (k + c * s) / (b * s**2 + c * s + k)

    true = 2.0 + per_acceleration(device.inertance, device.series_stiffness, device.series_damping)
    alone = [told[name] for name in ("series_stiffness", "series_damping")]
    seen = per_acceleration(device.inertance + 2.0, *alone)
    assert abs(seen - true) < 1e-3 * abs(true - device.inertance - 2.0)

    drawn = (hide_effect(seed, "variable_inertance", realistic=True) for seed in range(30))
    case = next(each for each in drawn if "inertance_gradient" in each.parameters)
    case = replace(case, chain=Chain(grip_mass=2.0))
    b, hidden, told = case.device.inertance, case.parameters, shown_parameters(case)
    gradient = "inertance_gradient"
    assert (b + 2.0) * told[gradient] == pytest.approx(b * hidden[gradient])


def test_what_has_no_value_of_its_own_on_a_bench_is_not_counted() -> None:
    assert "force_offset" not in shown_parameters(realistic("force_offset", drift=0.5))
    late = {"force_filter": 50.0, "order": 2.0}
    assert "delay" not in shown_parameters(realistic("sensor_delay", **late))
    both = {**late, "displacement_filter": 50.0}
    assert "delay" in shown_parameters(realistic("sensor_delay", **both))


def with_device(case: HiddenCase, **changes: float | str) -> HiddenCase:
    return replace(case, device=replace(case.device, **changes))  # pyright: ignore[reportArgumentType]


def test_a_peak_that_noise_hides_may_be_called_coulomb_friction() -> None:
    case = realistic("coulomb_friction")
    level = case.parameters["coulomb_force"]
    assert plainer_forms(case) == ("coulomb_friction",)
    for speed, height, hidden in ((1e-5, 1.3, True), (0.1, 1.3, False), (0.1, 1.0001, True)):
        peak = {"static_force": height * level, "stribeck_velocity": speed}
        stribeck = with_device(case, friction="stribeck", **peak)
        assert (plainer_forms(stribeck) == ("coulomb_friction",)) is hidden
    # what rests shows a constant force alone
    uneven = with_device(case, friction_asymmetry=0.4)
    moving = tuple(run for run in case.runs if run.kind != "strokes")
    assert plainer_forms(replace(uneven, runs=moving)) == ("coulomb_friction",)
    assert plainer_forms(with_device(case, load_friction=0.5)) == ()
    assert plainer_forms(realistic("parallel_stiffness")) == ()
    # soft bristles, ageing of several per cent
    assert plainer_forms(realistic("hysteretic_friction")) == ()
    assert plainer_forms(realistic("series_elasticity")) == ()
    drawn = [hide_effect(seed, "rate_state_friction", realistic=True) for seed in range(4)]
    assert {plainer_forms(each) for each in drawn} <= {(), ("coulomb_friction",)}


def test_of_a_tone_a_filter_of_both_channels_leaves_less() -> None:
    late = {"force_filter": 20.0, "displacement_filter": 20.0, "order": 2.0}
    hidden = realistic("periodic_disturbance", **late)
    frequency = hidden.parameters["disturbance_frequency"]
    gain = 1.0 / np.sqrt(1.0 + (frequency / 20.0) ** 4)
    shown = shown_parameters(hidden)["disturbance_amplitude"]
    assert shown == pytest.approx(gain * hidden.parameters["disturbance_amplitude"])
