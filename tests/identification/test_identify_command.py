"""`inerter identify`: files, JSON, terminal, and what it refuses."""

from __future__ import annotations

import json
import os
from pathlib import Path

import mujoco
import pytest
from inerter import load_plugin
from inerter.commands import app
from inerter.device_file import read_device
from random_devices import Drawn, drawn
from typer.testing import CliRunner

RUNNER = CliRunner()


@pytest.fixture(scope="module")
def case() -> Drawn:
    return drawn("dahl", 3)


@pytest.fixture(scope="module")
def folder(case: Drawn, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("records")
    for record in case.records:
        columns = {"displacement": record.displacement, "force": record.force}
        rows = zip(record.time, *columns.values(), strict=True)
        lines = ["time,displacement,force", *(",".join(map(repr, map(float, r))) for r in rows)]
        (path / f"{record.name}.csv").write_text("\n".join(lines) + "\n")
    return path


def run(*arguments: object) -> tuple[int, str, str]:
    result = RUNNER.invoke(app, ["identify", *map(str, arguments)])
    return result.exit_code, result.stdout, result.stderr


def test_files_and_json_say_the_same(case: Drawn, folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    status, stdout, stderr = run(folder, "--law", "viscous,dahl", "--out", out, "--json")
    assert status == 0, stderr
    said = json.loads(stdout)
    assert said == json.loads((out / "identification.json").read_text())
    assert said["schema"] == "inerter.identification/1"
    assert [each["law"] for each in said["results"]] == ["dahl", "viscous"]
    best = said["results"][0]
    for name, truth in case.parameters.items():
        low, high = best["parameters"][name]["interval"]
        assert low < best["parameters"][name]["value"] < high
        assert abs(best["parameters"][name]["value"] / truth - 1) < 0.05
    assert set(os.listdir(out)) == {
        "identification.json", "identification.png", "device.toml", "model.xml",
    }  # fmt: skip
    device = read_device(out / "device.toml")
    assert device.coulomb_force == pytest.approx(best["device"]["coulomb_force"], rel=1e-12)
    load_plugin()
    mujoco.MjModel.from_xml_path(str(out / "model.xml"))
    assert (out / "identification.png").read_bytes().startswith(b"\x89PNG")


def test_the_terminal_shows_laws_and_parameters(folder: Path, tmp_path: Path) -> None:
    status, stdout, _ = run(
        folder, "--law", "viscous", "--intervals", "normal", "--fix", "viscous=3",
        "--out", tmp_path / "o",
    )  # fmt: skip
    assert status == 0
    assert "held out" in stdout
    assert "inertance" in stdout


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--law", "dhal"], "did you mean dahl"),
        (["--law", ","], "--law is empty"),
        (["--fix", "inertance"], "KEY=VALUE"),
        (["--fix", "inertance=heavy"], "not a number"),
        (["--fix", "inertance=-3"], "inertance"),
        (["--holdout", "nothing"], "nothing"),
        (["--loss", "huge"], "linear"),
    ],
)
def test_a_mistake_gets_one_line_and_no_files(
    folder: Path, tmp_path: Path, arguments: list[str], message: str
) -> None:
    status, _, stderr = run(folder, "--out", tmp_path / "o", *arguments)
    assert status == 2
    assert message in stderr
    assert "Traceback" not in stderr
    assert not (tmp_path / "o").exists()


def test_a_table_is_not_a_record(tmp_path: Path) -> None:
    path = tmp_path / "table.csv"
    path.write_text("frequency,force_amplitude,acceleration_amplitude\n1,2,3\n2,3,4\n3,4,5\n")
    status, _, stderr = run(path, "--out", tmp_path / "o")
    assert status == 2
    assert "table.csv" in stderr
