"""Values from a catalogue: every choice tried by hand gives the same."""

from __future__ import annotations

import itertools
import json
from pathlib import Path

import numpy as np
import pytest
from inerter.suspension.commands import app
from inerter.suspension.indices import INDICES
from inerter.suspension.layouts import LAYOUTS
from inerter.suspension.quarter_car import QuarterCar, Road
from inerter.suspension.vehicle import VehicleStrut, half_car, vehicle_index
from typer.testing import CliRunner

B, C = (30.0, 60.0, 113.0), (900.0, 1500.0, 2600.0)
BOTH = "inertance=60/30/113,damping=900/1500/2600"


def run(words: str) -> list[dict]:
    answer = CliRunner().invoke(app, [*words.split(), "--json"], catch_exceptions=False)
    assert answer.exit_code == 0, answer.output
    return json.loads(answer.stdout)


@pytest.mark.parametrize("index", ["J1", "J5"])
def test_all_from_a_catalogue(index: str) -> None:
    for row in run(f"optimize --layout S2,S3 --index {index} --stiffness 30e3 --catalogue {BOTH}"):
        struts = {
            (c, b): LAYOUTS[row["layout"]].stiffness(30e3, c, b) for c, b in itertools.product(C, B)
        }
        values = {
            key: float(np.squeeze(INDICES[index].evaluate(QuarterCar(), Road(), strut)))
            for key, strut in struts.items()
        }
        best = min(values, key=lambda key: values[key])
        assert (row["damping"], row["inertance"]) == best
        assert row["value"] == pytest.approx(values[best], rel=1e-12)


def test_the_rest_is_sought() -> None:
    words = "optimize --layout S6 --index J3 --stiffness 30e3"
    (row,) = run(f"{words} --catalogue inertance=30/60/113")
    each = [run(f"{words} --hold inertance={b}")[0] for b in B]
    best = min(each, key=lambda other: other["value"])
    assert row["value"] == pytest.approx(best["value"], rel=1e-9)
    assert row["inertance"] == best["inertance"]
    (free,) = run(words)
    assert free["value"] <= row["value"] * (1.0 + 1e-9)


def test_each_axle_chooses_its_own() -> None:
    (row,) = run(f"optimize --car half --layout S2 --index J1 --catalogue {BOTH}")
    struts = list(itertools.product(C, B))
    k = (row["front"]["stiffness"], row["rear"]["stiffness"])
    values = {
        pair: vehicle_index(
            "J1", half_car(), "S2", (VehicleStrut(k[0], *pair[0]), VehicleStrut(k[1], *pair[1]))
        )
        for pair in itertools.product(struts, struts)
    }
    best = min(values, key=lambda pair: values[pair])
    found = tuple((row[n]["damping"], row[n]["inertance"]) for n in ("front", "rear"))
    assert found == best
    assert row["value"] == pytest.approx(values[best], rel=1e-10)


def test_a_limit_holds_in_a_catalogue(tmp_path: Path) -> None:
    words = f"optimize --layout S2 --stiffness 30e3 --catalogue {BOTH}"
    (free,) = run(f"{words} --index J3")
    (row,) = run(f"{words} --index J1 --limit J3={1.02 * free['value']}")
    (value,) = run(
        f"optimize --layout S2 --stiffness 30e3 --index J3 "
        f"--hold damping={row['damping']},inertance={row['inertance']}"
    )
    assert value["value"] <= 1.02 * free["value"] * (1 + 1e-6)
    front = run(
        f"pareto --layout S2 --index J1,J3 --stiffness 30e3 --points 3 --catalogue {BOTH} "
        f"--out {tmp_path}"
    )
    assert all(each["design"]["damping"] in C for each in front)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("inertance", "write NAME=VALUE/VALUE"),
        ("weight=3/4", "'weight' is not known"),
        ("inertance=3/-4", "catalogue of inertance is -4"),
        ("inertance=" + "/".join(map(str, range(1, 402))), "401 choices for S2, at most 400"),
    ],
)
def test_bad_words_are_told(text: str, told: str) -> None:
    answer = CliRunner().invoke(
        app, ["optimize", "--layout", "S2", "--catalogue", text], catch_exceptions=False
    )
    assert answer.exit_code == 2
    assert told in answer.output.replace("\n", " ")


@pytest.mark.long
def test_within_limits_the_choice_is_the_best_of_all_choices() -> None:
    """The search ends where what is left is no better without limits: nothing is lost by that."""
    words = "optimize --layout S6 --index J1 --stiffness 30e3 --limit J5=6e-4,J3=560"
    (row,) = run(f"{words} --catalogue inertance=30/60/113,damping=1500/2600")
    each = []
    for c, b in itertools.product((1500, 2600), (30, 60, 113)):
        held = f"{words} --hold inertance={b},damping={c}"
        answer = CliRunner().invoke(app, [*held.split(), "--json"])
        each += json.loads(answer.stdout) if answer.exit_code == 0 else []
    assert len(each) >= 2, "limits that leave no choice test nothing"
    best = min(each, key=lambda other: other["value"])
    assert row["value"] == pytest.approx(best["value"], rel=1e-8)
    assert (row["damping"], row["inertance"]) == (best["damping"], best["inertance"])
