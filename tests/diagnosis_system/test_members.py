"""Causes that the records of a vehicle cannot tell apart are told together."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hidden_vehicles import Car, records
from inerter.catalogue.scales import Range
from inerter.diagnose.doubt import doubted
from inerter.diagnose.result import Finding, StatedValue, Unexplained
from inerter.diagnose.vehicle import wording
from inerter.diagnose.vehicle.build import model_of_text
from inerter.diagnose.vehicle.candidate import candidate
from inerter.diagnose.vehicle.diagnosis import diagnose_system
from inerter.diagnose.vehicle.mapping import map_columns
from inerter.diagnose.vehicle.members import exchangeable, with_members
from inerter.diagnose.vehicle.model import VehicleModel
from inerter.diagnose.vehicle.outcome import ChannelError, SystemAccuracy
from inerter.diagnose.vehicle.problem import VehicleFit
from inerter.diagnose.vehicle.search import VehicleScored
from inerter.diagnose.vehicle.values import parameter_values
from inerter.models import model_path
from inerter.report.text import finding_name


def _scored(effect: str, element: str, name: str, squares: np.ndarray) -> VehicleScored:
    one = candidate(effect, element, [{name: 1.0}], {name: Range(1.0, 0.0)}, (name,))
    model = one.model(VehicleModel(), one.starts[0])
    fit = VehicleFit(model, np.ones(8), np.ones((8, 1)), 1.0, one.sizes)
    return VehicleScored(fit, squares, one)


def test_another_effect_that_does_as_well_is_a_member() -> None:
    squares = 1.0 + 0.1 * np.random.default_rng(1).standard_normal(48)
    chosen = _scored("body_mass_error", "body:sprung", "mass", squares)
    added = chosen.model.effects[-1]
    shaken = squares * (1 + 0.003 * np.random.default_rng(2).standard_normal(48))
    same = _scored("parallel_stiffness", "tendon:spring", "stiffness", shaken)
    worse = _scored("tyre_stiffness_error", "tyre:road", "tyre_stiffness", 1.1 * squares)
    itself = _scored("body_mass_error", "body:sprung", "mass", squares)
    assert exchangeable(chosen, added, [same, worse, itself]) == [same]

    # one with more parameters is no other explanation, however well it does
    more = replace(same.fit, model=replace(same.model, free=("a.x", "a.y")))
    assert exchangeable(chosen, added, [replace(same, fit=more)]) == []


FINDING = Finding(
    effect="body_mass_error", law=None, confidence=0.5, rmse_before=0.2, rmse_after=0.01,
    parameters={"body_mass": StatedValue(110.0, 0.5, "kg", 100.0)}, evidence="It fits.", rivals=[],
)  # fmt: skip


def test_a_finding_tells_its_members_with_their_values() -> None:
    added = _scored("parallel_stiffness", "tendon:spring", "stiffness", np.ones(4)).model.effects[0]
    value = StatedValue(9.09e4, 400.0, "N/m", 1e5)
    told = with_members(FINDING, [(added, {"stiffness": value})])
    assert told.json()["members"] == ["body_mass_error", "parallel_stiffness"]
    assert told.parameters["stiffness"] is value
    assert "in spring (stiffness = " in told.evidence
    assert "cannot tell them apart" in told.evidence
    # neither the page nor the verdict names one of them alone
    assert finding_name(told) == wording.finding_in_words(told)
    assert " or " in finding_name(told)
    channels = {"travel": ChannelError(0.1, "m", 0.1)}
    before, after = (SystemAccuracy({}, e, e, channels=channels) for e in (0.2, 0.01))
    rest = Unexplained(significant=False, fraction=0.0, depends_on=[], summary="Noise.")
    text = wording.verdict(before, after, [told], [""], rest, [])
    assert f"The main cause is {finding_name(told)}." in text
    assert with_members(FINDING, []) is FINDING


def test_what_takes_less_than_all_looks_like_what_is_there() -> None:
    told = replace(FINDING, confidence=0.97)
    channels = {"travel": ChannelError(0.1, "m", 0.1)}
    before, after = (SystemAccuracy({}, e, e, channels=channels) for e in (0.2, 0.03))
    summary = "What remains is not noise."
    # it explains a fifth of the spread: ten times what is left
    rest = Unexplained(
        significant=True, fraction=0.9, depends_on=["velocity"], summary=summary, structure=0.02
    )
    seen = doubted(told, rest.structure)
    assert seen.looks_like
    text = wording.verdict(before, after, [seen], [""], rest, [])
    assert f"The main cause looks like {finding_name(seen)}." in text
    assert "What is there looks like" in text
    assert "may stand in" not in text
    # of all that is there it is said as before
    sure = doubted(told, 0.001)
    text = wording.verdict(before, after, [sure], [""], rest, [])
    assert f"The main cause is {finding_name(sure)}." in text


@pytest.mark.long
def test_two_dampers_between_the_same_bodies_are_not_told_apart() -> None:
    text = model_path("quarter_car", "model.xml").read_text(encoding="utf-8")
    for old, new in (
        ('key="viscous" value="3705.4"', 'key="viscous" value="2000"'),
        ("</instance>", '</instance><instance name="twin"><config key="inertance" value="0"/>'
         '<config key="viscous" value="1705.4"/><config key="rest_length" value="0.5"/>'
         "</instance>"),
        ("</actuator>", '<plugin name="twin" plugin="inerter.device" instance="twin" '
         'tendon="strut"/></actuator>'),
    ):  # fmt: skip
        assert text.count(old) == 1
        text = text.replace(old, new)
    user = model_of_text(text, model_path("quarter_car", "model.xml")).with_timestep(0.002)
    runs = records(Car(damping=3200.0), runs=2)
    channels = map_columns(user.model, list(runs[0].channels()), {}, {})
    found = diagnose_system(runs, user, channels)
    (finding,) = found.findings
    assert finding.effect == "viscous_friction"
    assert "cannot tell them apart" in finding.evidence
    values = {name: value.value for name, value in finding.parameters.items()}
    assert values["strut.viscous"] == pytest.approx(3200.0 - 1705.4, rel=0.01)
    assert values["twin.viscous"] == pytest.approx(3200.0 - 2000.0, rel=0.01)


def test_standard_errors_reach_the_values_of_finer_steps() -> None:
    user = model_of_text(
        model_path("quarter_car", "model.xml").read_text(encoding="utf-8"), Path("car.xml")
    )
    user.with_roads([0])
    random = np.random.default_rng(5)
    one = candidate("inertance_error", "strut", [{"inertance": 130.0}],
                    {"inertance": Range(100.0, 0.0)}, ("inertance",))  # fmt: skip
    jacobian, residual = random.standard_normal((400, 1)), random.standard_normal(400)
    fit = VehicleFit(one.model(VehicleModel(), one.starts[0]), residual, jacobian, 1.0, one.sizes)
    scored = VehicleScored(fit, np.ones(48), one)
    (plain,) = parameter_values(user, scored)
    (same,) = parameter_values(user, scored, residual)
    assert same["inertance"].stderr == pytest.approx(plain["inertance"].stderr)
    # half the step moves the fit by 0.5; errors that fall with its square are 4/3 of that
    (moved,) = parameter_values(user, scored, residual - 0.5 * jacobian[:, 0])
    shift = 4 / 3 * 0.5 * fit.units()[0]
    assert moved["inertance"].value == plain["inertance"].value
    assert moved["inertance"].stderr == pytest.approx(np.hypot(plain["inertance"].stderr, shift))
