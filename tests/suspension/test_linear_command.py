"""`inerter suspension optimize`: rows, files, refusals."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from inerter.commands import app
from inerter.suspension.figures import page
from inerter.suspension.study import Study, StudyError, read_series, read_stiffnesses
from inerter.suspension.sweep import sweep
from typer.testing import CliRunner

KEYS = ["layout", "index", "stiffness", "series", "value", "damping", "inertance"]


def command(*words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "inerter", "suspension", "optimize", *words],
        capture_output=True,
        text=True,
        timeout=300,
    )


def test_rows_of_json() -> None:
    done = command(
        "--layout", "S1,S2,S3", "--index", "J1,J3,J5", "--stiffness", "120e3",
        "--series", "soft,hard,none", "--json",
    )  # fmt: skip
    assert (done.returncode, done.stderr) == (0, "")
    rows = json.loads(done.stdout)
    assert len(rows) == 27
    assert all(list(row) == KEYS for row in rows)
    value = {(r["layout"], r["index"], r["series"]): r["value"] for r in rows}
    assert value["S2", "J1", "none"] == pytest.approx(2.5773, abs=5e-5)
    # S1 has no inerter: the pair does not touch it
    assert value["S1", "J5", "soft"] == value["S1", "J5", "none"]
    assert value["S3", "J1", "soft"] > value["S3", "J1", "hard"] > value["S3", "J1", "none"]


def test_richer_layouts_name_their_spring() -> None:
    done = command("--layout", "S4,S5", "--index", "J3", "--stiffness", "30e3", "--json")
    rows = json.loads(done.stdout)
    assert all(list(row) == [*KEYS, "relaxation_stiffness"] for row in rows)
    assert all(1e4 < row["relaxation_stiffness"] < 1e6 for row in rows)


def test_a_refusal_of_the_command_line() -> None:
    done = command("--layout", "S9")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("inerter: layout 'S9' is not known")


def test_a_range_writes_figures(tmp_path: Path) -> None:
    folder = tmp_path / "results"
    done = command(
        "--stiffness", "40e3:80e3:3", "--series", "none,1e6/3200", "--out", str(folder), "--jobs",
        "2",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert sorted(file.name for file in folder.iterdir()) == [
        "optimum.html", "optimum.json", "optimum.png",
    ]  # fmt: skip
    full = json.loads((folder / "optimum.json").read_text())
    assert full["schema"] == "inerter.suspension/1"
    assert full["series"]["1e6/3200"] == {"stiffness": 1e6, "damping": 3200.0}
    assert len(full["rows"]) == 3 * 3 * 2 * 3
    assert "S3" in done.stdout


def test_the_page_needs_no_network() -> None:
    study = Study(
        layouts=("S1", "S3"), indices=("J1",), stiffnesses=(50e3, 60e3), series={"none": None}
    )
    text = page(sweep(study, jobs=1))
    assert "<script src=" not in text
    assert "S3 ideal" in text


def test_processes_do_not_change_the_answer() -> None:
    study = Study(
        layouts=("S1", "S3"), indices=("J1", "J5"), stiffnesses=(60e3, 90e3), series={"none": None}
    )
    assert sweep(study, jobs=2) == sweep(study, jobs=1)


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (("--layout", "S2,S9"), ["layout 'S9'", "S1, S2, S3, S4, S5, S6"]),
        (("--index", "J2"), ["index 'J2'", "J1, J3, J5"]),
        (("--series", "medium"), ["series 'medium'", "none, soft, hard", "KS/CS"]),
        (("--series", "1e6/-3"), ["series damping is -3", "positive"]),
        (("--stiffness", "0"), ["stiffness is 0", "positive"]),
        (("--stiffness=-5e3",), ["stiffness is -5e3", "positive"]),
        (("--stiffness", "nan"), ["stiffness is nan", "positive"]),
        (("--stiffness", "much"), ["stiffness 'much' is not a number"]),
        (("--stiffness", "1e3:2e3"), ["'1e3:2e3'", "FIRST:LAST:COUNT"]),
        (("--stiffness", "1e3:2e3:1"), ["count '1'"]),
        (("--layout", ","), ["layout is empty"]),
        (("--sprung-mass", "0"), ["sprung_mass is 0", "positive"]),
        (
            ("--tyre-stiffness", "210"),
            [
                "--tyre-stiffness is 210 N/m",
                "30000 to 2e+06",
                "did you mean 210000 N/m?",
                'unusual = ["front.tyre_stiffness"]',
            ],
        ),
        (("--sprung-mass", "320e3"), ["--sprung-mass is 320000 kg", "did you mean 320 kg?"]),
        (("--unsprung-mass", "0.042"), ["--unsprung-mass is 0.042 kg", "did you mean 42 kg?"]),
        (("--hold", "damping=1.7"), ["--hold: damping is 1.7 N s/m", "mean 1700 N s/m?"]),
        (("--catalogue", "damping=0.9/1200"), ["damping is 0.9 N s/m", "mean 900 N s/m?"]),
        (("--roughness", "inf"), ["roughness is inf", "positive"]),
    ],
)
def test_what_cannot_be_used_is_refused_in_one_line(
    words: tuple[str, ...], told: list[str]
) -> None:
    done = CliRunner().invoke(app, ["suspension", "optimize", *words, "--json"])
    assert done.exit_code == 2
    assert done.stdout == ""
    assert len(done.stderr.splitlines()) == 1
    assert all(part in done.stderr for part in told), done.stderr


def test_centring_springs_are_shown() -> None:
    words = ["suspension", "optimize", "--layout", "SW7", "--index", "J3", "--hold", "inertance=60"]
    (row,) = json.loads(CliRunner().invoke(app, [*words, "--json"]).stdout)
    shown = CliRunner().invoke(app, words).stdout
    names = {"k_1": "damper_stiffness", "k_2": "inerter_stiffness", "beside": "parallel_stiffness"}
    parts = ", ".join(f"{short} {row[name] / 1e3:.5g}" for short, name in names.items())
    assert f"SW7 J3 none at k = 120 kN/m, springs [kN/m]: {parts}" in shown


def test_a_folder_that_is_a_file_is_refused_before_the_work(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_text("")
    done = CliRunner().invoke(app, ["suspension", "optimize", "--out", str(file)])
    assert done.exit_code == 2
    assert "not a folder" in done.stderr


def test_stiffnesses_and_pairs_in_words() -> None:
    assert read_stiffnesses("1e3, 2e3:4e3:3") == (1e3, 2e3, 3e3, 4e3)
    assert len(read_stiffnesses("10e3:300e3:59")) == 59
    pairs = read_series("Soft,none,1e6/3200")
    assert list(pairs) == ["soft", "none", "1e6/3200"]
    assert pairs["soft"] == pairs["1e6/3200"]
    with pytest.raises(StudyError, match="series"):
        read_series("1e6/2/3")
