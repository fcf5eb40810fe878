"""What is named beside a large unexplained rest is not claimed as sure."""

from __future__ import annotations

from dataclasses import replace

import pytest
from inerter.blind_test.case import records_of
from inerter.diagnose import diagnose_bench
from inerter.diagnose.doubt import (
    as_sure_as_its_value,
    descriptions,
    doubted,
    note,
    of_one_sine,
    stand_ins,
    trust,
    warning,
    with_own_value,
)
from inerter.diagnose.result import Finding
from inerter.reference import NoiseLevels, hide_effect
from inerter.report.page import render_report
from unknown_forces import pulsing_friction, unknown_records

QUIET = NoiseLevels(0.0, 0.01, 1e-6)
# explains 3 N of 5
THREE = Finding(
    effect="viscous_friction",
    law=None,
    confidence=0.98,
    parameters={},
    rmse_before=5.0,
    rmse_after=4.0,
    evidence="c = 1.",
    rivals=[],
)


def test_trust_is_even_beside_an_equal_rest_and_whole_without_a_rest() -> None:
    assert trust(THREE, 0.0) == 1.0
    assert trust(THREE, 3.0) == pytest.approx(0.5)
    assert trust(THREE, 6.0) == pytest.approx(0.2)
    assert trust(THREE, 0.1) > 0.99


def test_beside_a_play_blows_do_not_count() -> None:
    """Blows hide what a friction takes away, as they hide what it leaves."""
    hidden = replace(THREE, rmse_before=37.3, rmse_after=37.9, takes=4.0)
    assert trust(hidden, 1.0) == pytest.approx(16 / 17)
    told = doubted(hidden, 1.0)
    assert "But for the blows of the play it takes 4 N away." in told.evidence
    # of the play itself they are what it makes
    play = doubted(replace(hidden, effect="backlash"), 1.0)
    assert "But for" not in play.evidence


def test_a_value_that_may_be_none_is_as_likely_not_there() -> None:
    doubtful = with_own_value(THREE, 0.98, is_distinct=False)
    assert doubtful.confidence == pytest.approx(0.49)
    assert doubtful.evidence == "c = 1. Its own value may be none."
    assert with_own_value(THREE, 0.98, is_distinct=True) is THREE
    # a counterpart told so already, and the values of a loop change together
    halved = replace(THREE, confidence=0.49)
    assert with_own_value(halved, 0.98, is_distinct=False) is halved
    loop = replace(THREE, effect="hysteretic_friction")
    assert with_own_value(loop, 0.98, is_distinct=False) is loop


def test_none_is_surer_than_its_own_value_is_there() -> None:
    """A value of two standard errors is one of noise alone once in twenty."""
    capped = as_sure_as_its_value(THREE, 2.0)
    assert capped.confidence == pytest.approx(0.9545, abs=1e-4)
    assert capped.evidence == "c = 1. Its own value differs from none by 2.0 standard errors."
    assert as_sure_as_its_value(THREE, 1.2).confidence == pytest.approx(0.770, abs=1e-3)
    # one that is known well, one that is less sure already, and what has been told to be none
    assert as_sure_as_its_value(THREE, 3.0) is THREE
    assert as_sure_as_its_value(THREE, float("inf")) is THREE
    unsure = replace(THREE, confidence=0.6)
    assert as_sure_as_its_value(unsure, 1.5) is unsure
    assert as_sure_as_its_value(THREE, 0.8) is THREE
    loop = replace(THREE, effect="hysteretic_friction")
    assert as_sure_as_its_value(loop, 1.5) is loop


@pytest.mark.long
def test_what_the_errors_of_its_values_hold_to_be_none_is_not_sure() -> None:
    """Friction that grows with the load, one sine behind filters: all else is next to none."""
    hidden = hide_effect(2316903413, "load_dependent_friction", noise=QUIET, realistic=True)
    found = {f.effect: f for f in diagnose_bench(records_of(hidden)).findings}
    assert found.pop("load_dependent_friction").confidence > 0.9
    assert all(f.confidence <= 0.5 for f in found.values())


def test_what_explains_nothing_is_not_trusted() -> None:
    worse = replace(THREE, rmse_after=5.5)
    assert trust(worse, 1.0) == 0.0
    assert trust(worse, 0.0) == 1.0


def test_confidence_falls_and_the_reason_is_told() -> None:
    less = doubted(THREE, 3.0)
    assert less.confidence == pytest.approx(0.49)
    assert less.gain == THREE.gain
    assert less.evidence.startswith("c = 1. ")
    assert "explains 1.0 times what stays unexplained" in less.evidence
    assert doubted(THREE, 0.0) == THREE


def test_warning_names_only_what_may_stand_in() -> None:
    large = replace(THREE, effect="coulomb_friction", rmse_before=50.0)
    assert stand_ins([large, THREE], 3.0) == [THREE]
    assert warning([]) == ""
    assert "a, b and c explain," in warning(["a", "b", "c"])
    assert "a explains," in warning(["a"])


def test_what_leaves_a_little_looks_like_what_is_there() -> None:
    """Sure as it is, another cause may look the same."""
    found = doubted(THREE, 0.3)
    assert found.confidence > 0.9
    assert found.looks_like
    assert found.json()["looks_like"] is True
    assert "may stand in" in found.evidence
    assert descriptions([THREE], 0.3) == [THREE]
    assert descriptions([THREE], 3.0) == descriptions([THREE], 0.0) == []
    assert "looks like a and b, and they take less" in note(["a", "b"])
    assert note([]) == ""
    surely = doubted(THREE, 0.1)
    assert not surely.looks_like
    assert "looks_like" not in surely.json()


def test_many_effects_along_one_sine_are_not_sure() -> None:
    """What goes with time alone is told beside them."""
    names = ["coulomb_friction", "gas_spring", "asymmetric_damping"]
    few = [replace(THREE, effect=name) for name in (*names, "force_drift", "periodic_disturbance")]
    assert of_one_sine(few) == few
    many = of_one_sine([*few, replace(THREE, effect="variable_inertance")])
    sure = {each.effect: each.confidence for each in many}
    assert sure["force_drift"] == sure["periodic_disturbance"] == 0.98
    for name in (*names, "variable_inertance"):
        assert sure[name] == pytest.approx(0.75 * 0.98)
    assert "4 effects can draw the force of a period" in many[0].evidence


@pytest.mark.long
def test_a_stand_in_for_an_unnamed_friction_is_doubted() -> None:
    """Friction that waxes and wanes with time: Coulomb friction is its mean."""
    records, _ = unknown_records(20261121, pulsing_friction, 0.2)
    found = diagnose_bench(records)
    assert found.unexplained.significant
    stand_in = next(each for each in found.findings if each.effect == "coulomb_friction")
    # of 1 + sin the mean is sqrt(2) times the rms of the rest
    assert stand_in.confidence == pytest.approx(2 / 3, abs=0.1)
    assert "may stand in" in stand_in.evidence
    assert "and may stand in for a cause that is not on the list. <a" in render_report(
        found, "", ""
    )
    assert "explains, what stays unexplained is large: it may stand in" in found.verdict


@pytest.mark.long
def test_a_named_effect_alone_is_not_doubted(effects_seed: int) -> None:
    case = hide_effect(effects_seed, "viscous_friction", noise=QUIET)
    found = diagnose_bench(records_of(case))
    assert [finding.effect for finding in found.findings] == ["viscous_friction"]
    assert found.findings[0].confidence > 0.95
    assert "may stand in" not in found.verdict
