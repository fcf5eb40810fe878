"""A search that has no time left judges and tells what it has found."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from bench_runs import measured
from inerter.diagnose import diagnose_bench
from inerter.diagnose.time_limit import TimeLimit
from inerter.diagnose.trials import Trials
from inerter.records import Record
from inerter.reference import ReferenceDevice, sum_of_sines
from inerter.report.page import render_report


@pytest.fixture(scope="module")
def records() -> list[Record]:
    truth = ReferenceDevice(inertance=80.0, viscous=60.0, friction="coulomb", coulomb_force=12.0)
    motions = [
        sum_of_sines([0.01, 0.003, 0.001], [0.7, 1.9, 4.1], [0.0, 1.0, phase])
        for phase in (0.0, 2.0)
    ]
    return measured(truth, motions, np.arange(0, 6, 4e-3))


def test_without_time_nothing_is_added_and_that_is_said(records: list[Record]) -> None:
    found = diagnose_bench(records, time_limit=1e-9)
    assert found.findings == []
    assert found.baseline.rmse == pytest.approx(found.extended.rmse)
    assert "ended after the 1e-09 s of --time-limit" in found.verdict
    assert "not compared" not in found.verdict
    assert found.json()["method"]["time_limit"] == 1e-9


def test_what_was_found_in_time_stands_without_comparison(
    records: list[Record], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A limit that is over when it is asked for the third time: two effects are searched for."""
    asked = iter([False, False])

    def is_over(limit: TimeLimit) -> bool:
        limit.was_felt = limit.was_felt or next(asked, True)
        return limit.was_felt

    monkeypatch.setattr(TimeLimit, "is_over", is_over)
    found = diagnose_bench(records, time_limit=3600.0)
    assert {finding.effect for finding in found.findings} == {
        "viscous_friction",
        "coulomb_friction",
    }
    assert all(finding.confidence <= 0.5 for finding in found.findings)
    assert "2 findings were not compared" in found.verdict
    assert all(told["compared"] is False for told in found.json()["findings"])
    page = render_report(found, "", "")
    assert page.count("There was no time to ask what else") == 2
    assert "No rival explains" not in page
    assert found.extended.rmse < 0.5 * found.baseline.rmse


def test_a_step_is_left_when_the_time_is_over(
    records: list[Record], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Amid the second step: what the first has found stands."""
    begun, fit_all = 0, Trials.fit_all

    def fitted(trials: Trials, *given: Any, **also: Any) -> Any:
        nonlocal begun
        begun += 1
        if begun == 2:
            # as the clock does in a while
            trials._time._ends = 0.0
        return fit_all(trials, *given, **also)

    monkeypatch.setattr(Trials, "fit_all", fitted)
    found = diagnose_bench(records, time_limit=3600.0)
    # a law that grows with the speed was exchanged for two effects
    assert {each.effect for each in found.findings} == {"viscous_friction", "coulomb_friction"}
    assert "ended after the 3600 s of --time-limit" in found.verdict
    assert not any(each["compared"] for each in found.json()["findings"])
    assert begun == 2


def test_with_time_enough_it_is_the_same(records: list[Record]) -> None:
    usual, limited = diagnose_bench(records), diagnose_bench(records, time_limit=3600.0)
    assert limited.json() == usual.json()


@pytest.mark.parametrize("seconds", [0.0, -5.0, np.nan])
def test_a_limit_is_above_none(records: list[Record], seconds: float) -> None:
    with pytest.raises(ValueError, match=r"--time-limit is .* give more than 0 s"):
        diagnose_bench(records, time_limit=seconds)


def test_one_finding_is_told_as_one() -> None:
    limit = TimeLimit(30.0)
    assert limit.in_words(1) == ""
    limit.was_felt = True
    assert "A finding was not compared" in limit.in_words(1)
    assert "30 s" in limit.in_words(0)


def test_a_summary_claims_no_more_than_was_tried() -> None:
    limit = TimeLimit(1e-9)
    text = "It goes with the place. No effect that is known here explains it."
    assert limit.tried(text) == text
    assert limit.is_over()
    assert limit.tried(text).endswith("No effect that was tried in the time given explains it.")
