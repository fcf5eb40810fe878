"""Two standard errors hold the truth, also where no residual shows what is wrong."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from inerter.diagnose.stages import search_in
from inerter.diagnose.start import Given, prepared
from inerter.identify.choices import covered
from inerter.identify.fit import parameter_errors
from plain_benches import Case, by_fit, by_identify, drawn, table


def off(case: Case, found: dict[str, tuple[float, float]]) -> dict[str, float]:
    """Standard errors by which each true parameter is missed."""
    pairs = {name: (found[name], truth) for name, truth in case.parameters.items() if name in found}
    return {name: (value - truth) / error for name, ((value, error), truth) in pairs.items()}


def test_what_smoothing_and_reversals_do_is_in_the_errors() -> None:
    """Viscous, quadratic and Coulomb friction make up for the blur of a filter's jumps."""
    case = drawn(38)
    assert case.bench.kind == "filter of the force"
    assert set(case.parameters) >= {"coulomb_force", "viscous", "quadratic_damping"}
    missed = off(case, by_fit(case))
    assert max(map(abs, missed.values())) < 2, missed


def test_a_filter_that_is_taken_for_a_delay_is_in_the_errors() -> None:
    case = drawn(27)
    missed = off(case, by_identify(case))
    assert {"inertance", "stiffness"} <= set(missed)
    assert max(map(abs, missed.values())) < 2, missed


def test_errors_of_a_right_model_hardly_grow() -> None:
    """Without a filter, friction or a nonlinear term nothing hangs on the choices."""
    case = drawn(23, "no filter")
    assert case.law == "none"
    start = prepared(Given(records=case.records))
    search = search_in(start, start.weighed)
    terms = {name: v for name, v in case.parameters.items() if name != "inertance"}
    fit = search.problem.fit(start.baseline.adding(None, **terms))
    before = parameter_errors(fit)
    after = parameter_errors(covered(search.problem, fit, start.data.records))
    assert set(before) == set(case.parameters)
    for name in before:
        assert before[name][1] <= after[name][1] < 3 * before[name][1]


def test_forces_compared_above_the_motion_are_so_with_less_smoothing() -> None:
    """It is the motion that is smoothed less: its noise is not let in with the wider band."""
    case = drawn(11, "no filter")
    assert case.law == "coulomb"
    random = np.random.default_rng(1)
    records = [
        replace(r, displacement=r.displacement + random.normal(0, 3e-5, r.displacement.size))
        for r in case.records
    ]
    start = prepared(Given(records=records))
    search = search_in(start, replace(start.weighed, force_band=8 * start.weighed.cutoff))
    assert all(run.cutoff == pytest.approx(8 * run.quiet) for run in search.problem.runs)
    terms = {name: v for name, v in case.parameters.items() if name != "inertance"}
    fit = search.problem.fit(start.baseline.adding(case.law, **terms))
    before = parameter_errors(fit)
    after = parameter_errors(covered(search.problem, fit, start.data.records))
    for name in case.parameters:
        assert before[name][1] <= after[name][1] < 3 * before[name][1]


def test_a_tone_does_not_hang_on_the_smoothing() -> None:
    """It is fitted to the force as measured: above the band a step would say nothing."""
    case = drawn(23, "no filter")
    start = prepared(Given(records=case.records))
    search = search_in(start, start.weighed)
    terms = {name: v for name, v in case.parameters.items() if name != "inertance"}
    tone = {"disturbance_amplitude": 1.0, "disturbance_frequency": 150.0}
    fit = search.problem.fit(start.baseline.adding(None, **terms))
    model = fit.model.adding(None, **tone)
    known = np.diag([*np.diag(fit.covariance), 1e-4, 1e-6])
    both = covered(search.problem, replace(fit, model=model, covariance=known), start.data.records)
    errors = parameter_errors(both)
    assert errors["disturbance_amplitude"][1] == pytest.approx(1e-2)
    assert errors["viscous"][1] > np.sqrt(known[1, 1])


@pytest.mark.long
def test_two_errors_hold_the_truth_on_benches() -> None:
    rows = []
    for seed in range(2001, 2041):
        case = drawn(seed)
        rows.append({"kind": "all", "parameters": dict(case.parameters), "found": by_fit(case)})
    print(table(rows))
    for name in ("inertance", "coulomb_force", "viscous", "stiffness"):
        seen = [
            abs(row["found"][name][0] - row["parameters"][name]) < 2 * row["found"][name][1]
            for row in rows
            if row["parameters"].get(name)
        ]
        # chance leaves out one in twenty
        assert np.mean(seen) >= 0.9, name
