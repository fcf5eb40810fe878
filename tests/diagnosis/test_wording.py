"""The sentences of a diagnosis."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from bench_runs import measured
from inerter import Device
from inerter.diagnose import diagnose_bench
from inerter.diagnose.doubt import by_weight
from inerter.diagnose.result import Diagnosis, Finding, ParameterValue, Rival, StatedValue
from inerter.diagnose.wording import departure, effect_in_words, evidence, verdict
from inerter.printable import in_digits
from inerter.records import Record
from inerter.reference import ReferenceDevice, sum_of_sines


@pytest.mark.parametrize(
    ("value", "stated", "text"),
    [
        (25.0, 10.0, "stated 10, +15 N, +150 %"),
        (0.0, 100.0, "stated 100, -100 N, -100 %"),
        (92.3, 100.0, "stated 100, -7.7 N, -7.7 %"),
        (3.0, 0.0, "stated 0, +3 N"),
    ],
)
def test_departures_are_readable(value: float, stated: float, text: str) -> None:
    assert departure(StatedValue(value, 0.1, "N", stated)) == text


def test_numbers_are_written_out() -> None:
    said = "8.84e+03 N rms, 1e+05 N/m, 1.13e+06 N/m, 2e-05 m, run1e+03, 70 ± 2e+01"
    assert in_digits(said) == "8840 N rms, 100000 N/m, 1.13e+06 N/m, 2e-05 m, run1e+03, 70 ± 20"


def test_what_is_stated_and_other_is_called_so() -> None:
    value = StatedValue(60.0, 0.1, "N*s/m", 40.0)
    finding = Finding(
        effect="viscous_friction",
        law=None,
        confidence=1.0,
        parameters={"viscous": value},
        rmse_before=5.0,
        rmse_after=1.0,
        evidence="",
        rivals=[],
    )
    assert effect_in_words(finding) == "viscous friction other than stated"
    unstated = replace(finding, parameters={"viscous": replace(value, stated=None)})
    assert effect_in_words(unstated) == "viscous friction"


@pytest.mark.parametrize(
    ("frequency", "text"),
    [
        (50.05, "this is the frequency of the mains (50 Hz): hum"),
        (60.0, "this is the frequency of the mains (60 Hz): hum"),
        (150.2, "this is 3 times the frequency of the mains (50 Hz): hum"),
        (50.6, ""),
        (75.0, ""),
        (12.0, ""),
    ],
)
def test_a_tone_of_the_mains_is_called_hum(frequency: float, text: str) -> None:
    values = {
        "disturbance_amplitude": ParameterValue(3.0, 0.1, "N"),
        "disturbance_frequency": ParameterValue(frequency, 0.01, "Hz"),
    }
    finding = Finding(
        effect="periodic_disturbance", law=None, confidence=1.0, parameters=values,
        rmse_before=5.0, rmse_after=1.0, evidence="", rivals=[],
    )  # fmt: skip
    assert ("mains" in evidence(finding)) == bool(text)
    assert text in evidence(finding)


def test_an_error_that_rises_is_not_said_to_fall() -> None:
    """A play is judged by a loss that forgives impacts that come too late."""
    values = {"backlash": ParameterValue(6.6e-5, 4e-6, "m")}
    finding = Finding(
        effect="backlash", law=None, confidence=0.2, parameters=values,
        rmse_before=18.4, rmse_after=22.8, evidence="", rivals=[],
    )  # fmt: skip
    assert "rises from 18.4 N to 22.8 N" in evidence(finding)
    assert "falls from" not in evidence(finding)
    assert "impact" in evidence(finding)
    assert "impact" not in evidence(replace(finding, effect="series_elasticity"))
    lower = evidence(replace(finding, rmse_after=9.1))
    assert "falls from 18.4 N to 9.1 N" in lower
    assert "rises" not in lower


def slow_sampled(device: ReferenceDevice) -> list[Record]:
    """Two runs at 250 Hz."""
    motions = [
        sum_of_sines([0.01, 0.003, 0.001], [0.7, 1.9, 4.1], [phase, 1.0, 2.0])
        for phase in (0.0, 0.7)
    ]
    return measured(device, motions, np.arange(0, 8, 4e-3), force_noise=0.1)


@pytest.fixture(scope="module")
def spring_and_damper() -> Diagnosis:
    """A stiffness explains more than the damping that is added last, and takes a smaller share."""
    device = ReferenceDevice(inertance=50.0, viscous=60.0, stiffness=900.0)
    return diagnose_bench(slow_sampled(device), Device(inertance=50.0))


@pytest.mark.long
def test_the_main_cause_is_what_explains_most(spring_and_damper: Diagnosis) -> None:
    findings = spring_and_damper.findings
    assert {f.effect for f in findings} == {"viscous_friction", "parallel_stiffness"}
    assert [f.gain for f in findings] == sorted((f.gain for f in findings), reverse=True)
    main = by_weight(findings)[0]
    assert f"The main cause is {effect_in_words(main)}" in spring_and_damper.verdict


def test_an_experiment_is_named_only_where_it_tells_the_two_apart(
    spring_and_damper: Diagnosis,
) -> None:
    def text(effect: str, rival: str) -> str:
        finding = replace(
            spring_and_damper.findings[0],
            effect=effect, law=None, parameters={}, rivals=[Rival(rival, 0.3)],
        )  # fmt: skip
        return verdict(replace(spring_and_damper, findings=[finding]))

    assert "(dwell at mid-stroke" in text("coulomb_friction", "hysteretic_friction")
    # the rival's own experiment
    assert "(dwell at mid-stroke" in text("hysteretic_friction", "coulomb_friction")
    other = text("coulomb_friction", "quadratic_damping")
    assert "can hardly be told from" in other
    assert "dwell" not in other


@pytest.mark.long
def test_friction_at_a_low_rate_is_no_noise(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture
) -> None:
    """And what the engines think of a stiff bristle is neither printed nor logged."""
    monkeypatch.chdir(tmp_path)
    device = ReferenceDevice(
        inertance=50.0, friction="dahl", coulomb_force=10.0, bristle_stiffness=3e5
    )
    found = diagnose_bench(slow_sampled(device))
    assert found.noise_floor < 0.25
    assert list(tmp_path.iterdir()) == []
    assert capfd.readouterr().err == ""


@pytest.mark.parametrize(("lower", "slack"), [(-0.0007, True), (-55.0, False)])
def test_a_limit_at_no_force_is_called_slack(lower: float, slack: bool) -> None:
    finding = Finding(
        effect="sensor_saturation",
        law="lower",
        confidence=1.0,
        parameters={"force_minimum": ParameterValue(lower, 0.0012, "N")},
        rmse_before=2.0,
        rmse_after=1.0,
        evidence="",
        rivals=[],
    )
    assert ("goes slack" in evidence(finding)) == slack


def test_a_level_that_is_there_in_any_case_is_named_first() -> None:
    values = {
        "coulomb_force": ParameterValue(25.0, 0.03, "N"),
        "friction_asymmetry": ParameterValue(0.32, 0.06, "1"),
        "force_offset": ParameterValue(8.0, 1.5, "N"),
    }
    either = Finding(
        effect="asymmetric_friction", law=None, confidence=0.5, parameters=values,
        evidence="", rmse_before=30.0, rmse_after=3.0, rivals=[],
        members=("asymmetric_friction", "force_offset"),
    )  # fmt: skip
    assert effect_in_words(either).startswith("Coulomb friction, larger one way or beside a")
    assert "Coulomb friction = 25.00 ± 0.03 N, and beside it friction that is 32 %" in evidence(
        either
    )


def test_what_only_looks_like_a_cause_is_not_said_to_be_lacking(
    spring_and_damper: Diagnosis,
) -> None:
    first, second = by_weight(spring_and_damper.findings)
    described = replace(spring_and_damper, findings=[first, replace(second, looks_like=True)])
    name = effect_in_words(second)
    assert f"it also lacks {name}" in verdict(spring_and_damper)
    assert f"it also lacks what looks like {name}" in verdict(described)


@pytest.mark.parametrize(
    ("share", "text"),
    [
        (0.331, "(33.1 % of its variation)"),
        (1.084, "(all of its variation)"),
        (18.37, "(18 times its variation)"),
    ],
)
def test_an_error_above_the_variation_is_no_per_cent(
    spring_and_damper: Diagnosis, share: float, text: str
) -> None:
    made = spring_and_damper
    assert text in verdict(replace(made, baseline=replace(made.baseline, nrmse=share)))


def test_a_name_lists_two_members_and_counts_more() -> None:
    finding = Finding(
        effect="variable_inertance", law="polynomial", confidence=0.3, parameters={},
        rmse_before=2.0, rmse_after=1.0, evidence="", rivals=[],
        members=("variable_inertance", "position_force"),
    )  # fmt: skip
    two = "an inertance that is not constant or a force of the place along the stroke"
    assert effect_in_words(finding) == two
    more = replace(finding, members=(*finding.members, "gas_spring", "hardening_stiffness"))
    said = "an inertance that is not constant or one of 3 others that do the same here"
    assert effect_in_words(more) == said
