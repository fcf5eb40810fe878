"""`inerter suspension optimize --car half|full`: rows, files, refusals."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from inerter.commands import app
from inerter.suspension.figures import page
from inerter.suspension.study import Study, StudyError, read_axle_stiffnesses
from inerter.suspension.sweep import sweep
from inerter.suspension.vehicle import half_car
from typer.testing import CliRunner

KEYS = ["car", "layout", "index", "stiffness", "series", "value", "front", "rear"]


def command(*words: str) -> Any:
    return CliRunner().invoke(app, ["suspension", "optimize", *words])


def test_rows_of_json() -> None:
    done = command("--car", "half", "--layout", "S1,S4", "--index", "J1", "--json", "--jobs", "1")
    assert (done.exit_code, done.stderr) == (0, "")
    rows = json.loads(done.stdout)
    assert all(list(row) == KEYS and row["car"] == "half" for row in rows)
    assert [row["stiffness"] for row in rows] == [19960.0, 19960.0]
    assert list(rows[0]["rear"]) == ["stiffness", "damping", "inertance"]
    assert list(rows[1]["front"])[-1] == "relaxation_stiffness"
    assert rows[0]["rear"]["stiffness"] == 17500.0
    assert rows[0]["front"]["inertance"] == 0.0


def test_a_pair_of_stiffnesses_and_equal_struts() -> None:
    done = command(
        "--car", "full", "--layout", "S1", "--index", "J3", "--stiffness", "30e3/40e3", "--equal",
        "--correlation", "1", "--json",
    )  # fmt: skip
    (row,) = json.loads(done.stdout)
    assert (row["front"]["stiffness"], row["rear"]["stiffness"]) == (30e3, 40e3)
    assert row["front"]["damping"] == row["rear"]["damping"]


def test_a_table_names_the_axles() -> None:
    done = command("--car", "half", "--layout", "S1,S3", "--index", "J1", "--stiffness", "60e3")
    assert done.exit_code == 0
    assert "front" in done.stdout
    assert "rear" in done.stdout


def test_a_range_writes_figures(tmp_path: Path) -> None:
    done = command(
        "--car", "half", "--layout", "S1,S3", "--index", "J1,J3", "--stiffness", "40e3:60e3:2",
        "--out", str(tmp_path), "--jobs", "1",
    )  # fmt: skip
    assert done.exit_code == 0, done.stderr
    assert sorted(file.name for file in tmp_path.iterdir()) == [
        "optimum.html", "optimum.json", "optimum.png",
    ]  # fmt: skip
    full = json.loads((tmp_path / "optimum.json").read_text())
    assert full["car"]["pitch_inertia"] == half_car().pitch_inertia
    assert full["equal"] is False
    assert len(full["rows"]) == 2 * 2 * 2


def test_processes_do_not_change_the_answer() -> None:
    study = Study(
        layouts=("S1", "S3"),
        indices=("J1", "J5"),
        stiffnesses=((6e4, 5e4), (1.2e5, 1e5)),
        series={"none": None},
        car=half_car(),
    )
    rows = sweep(study, jobs=2)
    assert rows == sweep(study, jobs=1)
    assert "front stiffness" in page(rows)


def test_stiffnesses_in_words() -> None:
    car = half_car()
    assert read_axle_stiffnesses(None, car) == ((19960.0, 17500.0),)
    pairs = read_axle_stiffnesses("2e4:4e4:3, 3e4/1e4", car)
    assert [front for front, _ in pairs] == [2e4, 3e4, 4e4, 3e4]
    assert pairs[0][1] == pytest.approx(2e4 * 17500.0 / 19960.0)
    assert pairs[3] == (3e4, 1e4)
    with pytest.raises(StudyError, match="KF/KR"):
        read_axle_stiffnesses("1/2/3", car)


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("--car", "tractor"), ["car 'tractor'", "quarter, half, full"]),
        (("--car", "half,full"), ["choose one"]),
        (("--car", "half", "--sprung-mass", "200"), ["--sprung-mass", "quarter-car"]),
        (("--car", "full", "--tyre-stiffness", "2e5"), ["--tyre-stiffness", "quarter-car"]),
        (("--car", "half", "--correlation", "0.5"), ["--correlation", "--car full"]),
        (("--car", "full", "--correlation", "2"), ["correlation is 2", "0 to 1"]),
        (("--equal",), ["--equal", "--car half"]),
        (("--stiffness", "1e4/2e4"), ["KF/KR", "--car half"]),
        (("--car", "half", "--stiffness", "1e4/0"), ["stiffness is 0", "positive"]),
    ],
)
def test_what_cannot_be_used_is_refused_in_one_line(
    words: tuple[str, ...], told: list[str]
) -> None:
    done = command(*words, "--json")
    assert (done.exit_code, done.stdout) == (2, "")
    assert len(done.stderr.splitlines()) == 1
    assert all(part in done.stderr for part in told), done.stderr
