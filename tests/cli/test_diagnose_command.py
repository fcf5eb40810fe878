"""`inerter diagnose` as a user runs it: files, exit status, one clear line for a mistake."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from inerter.exudyn.engine import installed


def inerter(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "inerter", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two short runs with a constant force of 5 N, b = 60 kg, in millimetres and kilonewtons."""
    folder = tmp_path_factory.mktemp("records")
    random = np.random.default_rng(8)
    t = np.arange(0, 6, 4e-3)
    for i, frequency in enumerate((0.9, 1.6)):
        omega = 2 * np.pi * np.array([[frequency], [2.6 * frequency]])
        size = np.array([[8.0], [1.5]])
        x = np.sum(size * np.sin(omega * t), axis=0)
        force = 5 - 60e-3 * np.sum(size * omega**2 * np.sin(omega * t), axis=0)
        rows = np.column_stack(
            [t, x + random.normal(0, 1e-3, t.size), (force + random.normal(0, 0.1, t.size)) / 1e3]
        )
        np.savetxt(
            folder / f"run_{i}.csv",
            rows,
            delimiter=",",
            comments="",
            header="time,displacement[mm],force[kN]",
        )
    return folder


@pytest.fixture(scope="module")
def diagnosed(folder: Path, tmp_path_factory: pytest.TempPathFactory):
    out = tmp_path_factory.mktemp("out")
    return inerter("diagnose", folder, "--out", out, "--json"), out


def test_json_alone_on_stdout(diagnosed) -> None:
    done, out = diagnosed
    assert done.returncode == 0, done.stderr
    printed = json.loads(done.stdout)
    assert printed == json.loads((out / "diagnosis.json").read_text())
    assert printed["schema"] == "inerter.diagnosis/1"
    assert [finding["effect"] for finding in printed["findings"]] == ["force_offset"]
    offset = printed["findings"][0]["parameters"]["force_offset"]
    assert offset["value"] == pytest.approx(5, abs=0.1)
    assert offset["unit"] == "N"
    assert {record["role"] for record in printed["records"]} == {"fit", "holdout"}
    for engine in ("mujoco", "reference", *(["exudyn"] if installed() else [])):
        rmse = printed["engines"][engine]["rmse"]
        assert rmse == pytest.approx(printed["extended"]["rmse"], rel=1e-3), engine


def test_contract_keys(diagnosed) -> None:
    printed = json.loads(diagnosed[0].stdout)
    assert {"schema", "records", "baseline", "findings", "extended", "noise", "unexplained",
            "engines", "verdict"} <= set(printed)  # fmt: skip
    assert {"name", "samples", "sample_rate", "role", "warnings"} <= set(printed["records"][0])
    # the clock's rounding is left out
    assert [record["sample_rate"] for record in printed["records"]] == [250.0, 250.0]
    assert {"device", "rmse", "nrmse"} <= set(printed["baseline"])
    assert {"effect", "law", "confidence", "parameters", "rmse_before", "rmse_after", "gain",
            "evidence", "rivals"} <= set(printed["findings"][0])  # fmt: skip
    assert {"significant", "fraction", "depends_on", "summary"} <= set(printed["unexplained"])


def test_four_files_and_nothing_else(diagnosed) -> None:
    names = sorted(path.name for path in diagnosed[1].iterdir())
    assert names == ["device.toml", "diagnosis.json", "model.xml", "report.html"]


def test_summary_for_people(folder: Path, tmp_path: Path) -> None:
    done = inerter("diagnose", folder / "run_0.csv", "--out", tmp_path / "deep" / "out")
    assert done.returncode == 0, done.stderr
    assert "constant force" in " ".join(done.stdout.split())
    assert (tmp_path / "deep" / "out" / "report.html").exists()


def test_quick_writes_nothing(folder: Path, tmp_path: Path) -> None:
    done = inerter("diagnose", folder / "run_0.csv", "--quick", "--out", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    assert "constant force" in " ".join(done.stdout.split())
    assert "Written" not in done.stdout
    assert not (tmp_path / "out").exists()


@pytest.mark.long
def test_model_and_device_as_baseline(folder: Path, diagnosed, tmp_path: Path) -> None:
    for option, file in (("--device", "device.toml"), ("--model", "model.xml")):
        done = inerter("diagnose", folder, option, diagnosed[1] / file, "--json",
                       "--out", tmp_path / file)  # fmt: skip
        assert done.returncode == 0, done.stderr
        assert json.loads(done.stdout)["findings"] == []


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["{folder}/none.csv"], "no such file"),
        (["{folder}", "--holdout", "run_7"], "no such run"),
        (["{folder}", "--holdout", "run_0", "--holdout", "run_1"], "names every run"),
        (["{folder}", "--device", "{folder}/none.toml"], "cannot be opened"),
        (["{folder}", "--device", "{folder}/run_0.csv"], "is it another file?"),
        (["{folder}", "--model", "{folder}/none.xml"], "no such file"),
        (["{folder}", "--model", "{folder}/m.xml", "--device", "{folder}/d.toml"], "both given"),
        (["{bad}/text.csv"], "line 3"),
        (["{bad}/still.csv"], "does not move"),
        (["{bad}/table.csv", "{folder}/run_0.csv"], "different kinds"),
        (["{bad}/vehicle.csv"], "vehicle"),
        (["{folder}", "--time-limit", "0"], "give more than 0 s"),
        (["{bad}/table.csv", "--time-limit", "5"], "is of bench records over time; leave it out"),
    ],
)
def test_mistakes_get_one_line_and_status_2(
    folder: Path, tmp_path: Path, arguments: list[str], words: str
) -> None:
    t = np.arange(0, 1, 0.01)
    (tmp_path / "text.csv").write_text("time,displacement,force\n0,0,0\n0.1,x,0\n")
    still = "".join(f"{a:.2f},0.001,0\n" for a in t)
    (tmp_path / "still.csv").write_text("time,displacement,force\n" + still)
    (tmp_path / "table.csv").write_text(
        "frequency,force_amplitude,acceleration_amplitude\n1,1,1\n2,2,2\n3,3,3\n4,4,4\n"
    )
    drive = "".join(f"{a:.2f},{np.sin(a)},{np.cos(a)}\n" for a in t)
    (tmp_path / "vehicle.csv").write_text("time,road,body_acceleration\n" + drive)
    out = tmp_path / "out"
    filled = [a.format(folder=folder, bad=tmp_path) for a in arguments]
    done = inerter("diagnose", *filled, "--out", out)
    assert done.returncode == 2
    assert len(done.stderr.strip().splitlines()) == 1, done.stderr
    assert words in done.stderr
    assert "Traceback" not in done.stderr
    assert not out.exists()


def test_plugin_path_and_parameters() -> None:
    done = inerter("plugin-path")
    assert Path(done.stdout.strip()).is_file()
    assert "inertance" in inerter("parameters").stdout
