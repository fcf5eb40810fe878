"""What a blind test counts, on diagnoses that are made up and counted by hand."""

from __future__ import annotations

import io
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from inerter.blind_test.case import Named, Outcome, ParameterError
from inerter.blind_test.output import write_blind_test
from inerter.blind_test.picture import wilson
from inerter.blind_test.plan import BENCHES, Plan
from inerter.blind_test.score import calibration, is_failure, score, trust
from inerter.blind_test.table import print_blind_test
from made_up import outcome
from rich.console import Console

A, B, C = "viscous_friction", "coulomb_friction", "hysteretic_friction"
PLAN = Plan(
    effects=(A, B, C, "force_offset"), count=3, clean=2, pairs=2, triples=1, unknown=4, seed=11
)
OUTCOMES = [
    outcome("single", (A,), ((A, 0.97),), seed=1, gain=0.9, errors=(
        ParameterError(A, "viscous", 10.0, 10.4, 0.01),)),
    outcome("single", (A,), ((B, 0.6), (A, 0.92)), seed=2, gain=0.5, errors=(
        ParameterError(A, "viscous", 10.0, 12.0, 0.7),)),
    outcome("single", (A,), (), seed=3, gain=0.0, seconds=9.0),
    outcome("single", (B,), ((B, 0.93),), seed=4, gain=0.8, errors=(
        ParameterError(B, "coulomb_force", 5.0, 6.0, 0.1),)),
    outcome("single", (B,), ((C, 0.55),), seed=5, laws=(None, "dahl"), gain=0.7),
    outcome("single", (B,), (), seed=6, error="ValueError: no luck"),
    outcome("single", (C,), ((C, 0.999),), seed=7, laws=("dahl", "lugre"), gain=0.9),
    outcome("single", (C,), ((C, 1.0),), seed=8, laws=("lugre", "lugre"), gain=0.9),
    outcome("single", (C,), ((A, 0.91),), seed=9, laws=("bouc_wen", None), gain=0.1),
    outcome("clean", seed=20),
    outcome("clean", (), ((B, 0.4),), seed=21),
    outcome("pairs", (A, B), ((B, 0.98), (A, 0.98)), seed=30, gain=0.9),
    outcome("pairs", (A, C), ((C, 0.85), (B, 0.3)), seed=31, laws=("dahl", "dahl"), gain=0.6),
    outcome("triples", (A, B, "force_offset"), ((A, 0.9),), seed=40, gain=0.3),
    outcome("unknown", kind="beating", unexplained=True, seed=50),
    outcome("unknown", (), ((A, 0.95),), kind="beating", unexplained=True, seed=51),
    outcome("unknown", (), ((A, 0.5),), kind="squeal", unexplained=True, seed=52),
    outcome("unknown", kind="squeal", unexplained=False, seed=53),
]  # fmt: skip


@pytest.fixture(scope="module")
def result() -> dict:
    return score(PLAN, OUTCOMES, 12.0)


def test_confusion_counts_what_is_named_first(result: dict) -> None:
    matrix = result["confusion"]
    assert matrix["hidden"] == [A, B, C, "none"]
    assert matrix["named"] == [A, B, C, "none", "failed"]
    assert matrix["counts"] == [
        [1, 1, 0, 1, 0],
        [0, 1, 1, 0, 1],
        [1, 0, 2, 0, 0],
        [0, 1, 0, 1, 0],
    ]
    assert result["laws"]["named"] == ["dahl", "lugre", "bouc_wen", "other"]
    assert result["laws"]["counts"] == [[0, 1, 0, 0], [0, 1, 0, 0], [0, 0, 0, 1]]


def test_shares_of_an_effect(result: dict) -> None:
    viscous, all_single = result["effects"][A], result["single"]
    assert viscous["named_first"] == pytest.approx(1 / 3)
    assert viscous["found"] == pytest.approx(2 / 3)
    assert viscous["alone"] == pytest.approx(1 / 3)
    assert viscous["gain_on_truth"] == {"median": 0.5, "worst": 0.0}
    assert (viscous["seconds"]["median"], viscous["seconds"]["worst_seed"]) == (1.0, 3)
    assert all_single["named_first"] == pytest.approx(4 / 9)

    # 4 % off; 20 % off, within three standard errors; 20 % off, beyond them
    value = viscous["parameters"]["viscous"]
    assert value["median_error"] == pytest.approx(0.12)
    assert value["worst_error"] == pytest.approx(0.2)
    assert value["near"] == 1.0
    assert result["effects"][B]["parameters"]["coulomb_force"]["near"] == 0.0


def test_a_parameter_not_reported_is_not_near() -> None:
    missing = ParameterError(A, "viscous", 10.0, None, None)
    assert not missing.near
    assert ParameterError(A, "viscous", 10.0, 10.4, float("nan")).near
    assert not ParameterError(A, "viscous", 10.0, 12.0, float("nan")).near
    found = score(PLAN, [outcome("single", (A,), ((A, 1.0),), errors=(missing,))])
    value = found["effects"][A]["parameters"]["viscous"]
    assert (value["not_reported"], value["median_error"], value["near"]) == (1, None, 0.0)


def test_clean_sets_and_unknown(result: dict) -> None:
    assert result["clean"]["without_findings"] == 0.5
    assert result["clean"]["invented"] == {B: 1}
    pairs = result["pairs"]
    assert (pairs["all_found"], pairs["any_found"], pairs["with_extras"]) == (0.5, 1.0, 0.5)
    assert (pairs["missed"], pairs["extras"]) == ({A: 1}, {B: 1})
    triples = result["triples"]
    assert (triples["all_found"], triples["any_found"], triples["with_extras"]) == (0.0, 1.0, 0.0)
    unknown = result["unknown"]
    assert (unknown["significant"], unknown["wrong_claim"]) == (0.75, 0.25)
    assert unknown["kinds"]["beating"] == {
        "cases": 2, "significant": 1.0, "wrong_claim": 0.5, "named": {A: 1},
    }  # fmt: skip


def test_calibration_bins_hold_every_finding_once(result: dict) -> None:
    bins = result["calibration"]
    known = [one for one in OUTCOMES if one.task.group != "unknown"]
    assert sum(part["findings"] for part in bins) == sum(len(one.named) for one in known) == 14
    by_lower = {part["from"]: part for part in bins}
    assert by_lower[0.9]["findings"] == 4
    assert by_lower[0.9]["right"] == 0.75
    assert by_lower[0.9]["confidence"] == pytest.approx((0.92 + 0.93 + 0.91 + 0.9) / 4)
    assert (by_lower[0.5]["findings"], by_lower[0.5]["right"]) == (2, 0.0)
    assert by_lower[0.99]["findings"] == 2
    assert by_lower[0.7]["right"] is None

    # confidences that are right as often as they say
    draw = np.random.default_rng(1)
    made = [
        outcome("single", (A if draw.uniform() < confidence else B,), ((A, confidence),))
        for confidence in draw.uniform(0.5, 1.0, 2000)
    ]
    for part in calibration(made):
        if part["findings"]:
            lower, upper = wilson(part["right"], part["findings"])
            assert lower - 0.02 < part["confidence"] < upper + 0.02


def test_failures_are_listed_with_their_seed(result: dict) -> None:
    listed = {one["seed"]: one for one in result["failures"]}
    assert sorted(listed) == [2, 3, 5, 6, 9, 21, 31, 40, 51, 53]
    assert listed[6]["error"] == "ValueError: no luck"
    assert listed[5]["hidden"] == [B]
    assert listed[5]["named"] == [{"effect": C, "law": "dahl", "confidence": 0.55}]
    assert listed[53]["hidden"] == ["squeal"]
    assert listed[2]["verdict"] == "a verdict"


def test_wilson_interval_of_a_sure_share() -> None:
    # z^2 / (n + z^2) at both ends
    assert wilson(0.0, 10) == pytest.approx((0.0, 3.8415 / 13.8415), abs=1e-4)
    assert wilson(1.0, 10) == pytest.approx((10 / 13.8415, 1.0), abs=1e-4)


def test_files_and_terminal(result: dict, tmp_path: Path) -> None:
    assert write_blind_test(result, tmp_path) == [
        "blind_test.json", "confusion.png", "calibration.png",
    ]  # fmt: skip
    read = json.loads((tmp_path / "blind_test.json").read_text(encoding="utf-8"))
    assert read["schema"] == "inerter.blind_test/1"
    assert read["seed"] == 11
    assert read == json.loads(json.dumps(result))
    for name in ("confusion.png", "calibration.png"):
        assert (tmp_path / name).read_bytes()[:4] == b"\x89PNG"
    console = Console(record=True, width=120, file=io.StringIO())
    print_blind_test(result, console)
    text = console.export_text()
    assert "seed 11" in text
    assert "failed: coulomb_friction, seed 6: ValueError: no luck" in text

    # nothing but unknown effects: no matrix to draw
    only = score(Plan(effects=(A,), count=0, unknown=1), OUTCOMES[-1:])
    write_blind_test(only, tmp_path)
    print_blind_test(only, console)


def test_trust_counts_what_the_bench_brings_and_what_cannot_be_told_apart() -> None:
    errors = tuple(ParameterError(A, "viscous", 10.0, 10.0 + off, 1.0) for off in (0.5, 1.9, 2.1))
    right = outcome("single", (A,), ((A, 0.95), ("periodic_disturbance", 0.99)), errors=errors)
    right = replace(right, brings=("periodic_disturbance",))
    alike = outcome("single", (A,), (("sensor_delay", 0.9),))
    alike = replace(alike, named=(Named("sensor_delay", None, 0.9, (A, "sensor_delay")),))
    wrong = outcome("single", (A,), ((B, 0.97), (C, 0.5)))
    found = trust([right, alike, wrong, outcome("clean")])
    assert found["found"] == 0.75
    assert found["nothing_false"] == 0.75
    assert found["claims"] == 4
    assert found["wrong_claims"] == 0.25
    assert found["covered"] == pytest.approx(2 / 3)
    assert found["wrong"] == {B: 1, C: 1}
    assert found["missed"] == {A: 1}
    # as it is kept in a file
    again = Outcome.of_json(json.loads(json.dumps(alike.json())))
    assert again == alike


def test_what_only_looks_like_what_is_there_is_no_claim() -> None:
    sure = outcome("unknown", (), ((B, 0.97),))
    describes = replace(sure, named=(Named(B, None, 0.97, looks_like=True),))
    assert is_failure(replace(sure, unexplained=True))
    assert not is_failure(replace(describes, unexplained=True))
    found = trust([replace(sure, task=outcome("clean").task), describes])
    assert (found["claims"], found["wrong_claims"]) == (1, 1.0)
    assert (found["described"], found["wrong_described"]) == (1, 1.0)
    assert Outcome.of_json(json.loads(json.dumps(describes.json()))) == describes


def test_what_the_motion_cannot_tell_is_counted_apart() -> None:
    missed = outcome("pairs", (A, "parallel_stiffness"), ((A, 0.95),))
    said = replace(missed, cannot_tell=("parallel_stiffness", "series_elasticity"))
    other = replace(said, named=())
    assert [trust([one])["cannot_tell"] for one in (missed, said, other)] == [0, 1, 0]
    assert [trust([one])["found"] for one in (missed, said, other)] == [0.0, 0.0, 0.0]
    assert Outcome.of_json(json.loads(json.dumps(said.json()))) == said


def test_benches_are_named_and_have_files_of_their_own() -> None:
    ideal, realistic = (Plan(effects=(A,), count=1, seed=5, bench=b).tasks()[0] for b in BENCHES)
    assert ideal.seed == realistic.seed
    assert realistic.name == f"realistic-{ideal.name}"
    with pytest.raises(ValueError, match=r"--bench: 'dirty' is not one of ideal, realistic"):
        Plan(bench="dirty")


def test_a_level_beside_what_is_uneven_or_a_constant_force_is_right() -> None:
    uneven = outcome("single", ("asymmetric_friction",))
    level = Named("coulomb_friction", None, 1.0)
    either = Named("force_offset", None, 0.5, ("force_offset", "asymmetric_friction"))
    told = replace(uneven, named=(level, either))
    assert told.found
    assert told.nothing_false
    # that it is uneven has to be said
    assert not replace(uneven, named=(level,)).nothing_false
    assert not replace(uneven, named=(level, replace(either, members=()))).nothing_false
