"""`inerter design`: JSON, files, refusals."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from inerter.commands import app
from inerter.core import Device
from inerter.device_file import read_device
from inerter.simulate.run import run_model
from typer.testing import CliRunner

FILES = ["design.html", "design.json", "design.png", "device.toml", "model.xml"]
COMMANDS = {
    "ball-screw": ["--measured", "paper"],
    "rack-pinion": [
        "--pinion-radius", "12 mm", "--stage",
        "ratio=4,inertia=1e-4,play=0.1 deg,stiffness=900 N*m/rad",
    ],
    "fluid": ["--stroke", "200 mm", "--gas-volume", "26 cm^3"],
}  # fmt: skip


# what a design may leave to its defaults, without gas and without a shaft
PLAIN = {
    "screw": ["ball-screw", "--lead", "10 mm", "--inertia", "1.1e-4"],
    "rack": ["rack-pinion", "--pinion-radius", "12 mm", "--stage", "ratio=4,inertia=1e-4"],
    "channel": ["fluid", "--channel-length", "1.7"],
}


def run(*words: str):
    return CliRunner().invoke(app, ["design", *words])


@pytest.mark.parametrize("kind", list(COMMANDS))
def test_json_files_and_device(kind: str, tmp_path: Path) -> None:
    folder = tmp_path / "results"
    done = run(kind, *COMMANDS[kind], "--json", "--out", str(folder))
    assert (done.exit_code, done.stderr) == (0, "")
    found = json.loads(done.stdout)
    assert found == json.loads((folder / "design.json").read_text())
    assert (found["schema"], found["kind"]) == ("inerter.design/1", kind)
    assert found["results"]["inertance"]["unit"] == "kg"
    assert sorted(path.name for path in folder.iterdir()) == FILES

    # the same device in the file, in the JSON and in the model
    device = read_device(folder / "device.toml")
    assert device.given == Device(**found["device"]).given
    assert device.inertance == pytest.approx(found["results"]["inertance"]["value"], rel=1e-12)
    simulated = run_model(folder / "model.xml", 0.01)
    assert simulated.model.na == device.nstate
    page = (folder / "design.html").read_text()
    assert "plotly" in page
    assert "<script src=" not in page


@pytest.mark.parametrize(
    "words", [*([kind, *words] for kind, words in COMMANDS.items()), *PLAIN.values()]
)
def test_a_designed_model_runs(words: list[str], tmp_path: Path) -> None:
    """Whatever is designed, `inerter simulate` moves it and writes its forces."""
    folder, moved = tmp_path / "design", tmp_path / "run"
    assert run(*words, "--out", str(folder)).exit_code == 0
    model = str(folder / "model.xml")
    done = CliRunner().invoke(app, ["simulate", model, "--duration", "0.02", "--out", str(moved)])
    assert (done.exit_code, done.stderr) == (0, "")
    assert any(path.suffix == ".csv" for path in moved.iterdir())


@pytest.mark.parametrize("kind", list(COMMANDS))
def test_table_in_the_terminal(kind: str) -> None:
    done = run(kind, *COMMANDS[kind])
    assert done.exit_code == 0
    assert "inertance" in done.stdout
    assert "defaults: " in done.stdout


@pytest.mark.parametrize("kind", list(COMMANDS))
def test_help_has_units_and_sources(kind: str) -> None:
    done = run(kind, "--help")
    text = " ".join(done.stdout.split())
    assert "[m]" in text
    assert "default" in text


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["ball-screw", "--lead", "-10 mm"], "lead is -10 mm"),
        (["ball-screw", "--lead", "10"], 'above 1 m write the unit, "10 mm" or "10 m"'),
        (["ball-screw", "--measured", "missing.csv"], "missing.csv"),
        (["fluid", "--static-pressure", "1 kPa"], "cavitates at rest"),
        (["rack-pinion"], "pinion_radius is not given"),
    ],
)
def test_refusals_write_nothing(words: list[str], message: str, tmp_path: Path) -> None:
    folder = tmp_path / "results"
    done = run(*words, "--out", str(folder), "--json")
    assert (done.exit_code, done.stdout) == (2, "")
    assert done.stderr.startswith("inerter: ")
    assert done.stderr.count("\n") == 1
    assert message in done.stderr
    assert not folder.exists()


def test_a_folder_that_is_a_file(tmp_path: Path) -> None:
    file = tmp_path / "taken"
    file.write_text("")
    done = run("fluid", "--out", str(file))
    assert done.exit_code == 2
    assert "choose --out" in done.stderr


def test_as_a_program() -> None:
    done = subprocess.run(
        [
            sys.executable, "-m", "inerter", "design", "ball-screw", "--lead", "4 mm", "--inertia",
            "6.43e-5", "--json",
        ],
        capture_output=True, text=True, timeout=120,
    )  # fmt: skip
    assert (done.returncode, done.stderr) == (0, "")
    value = json.loads(done.stdout)["results"]["inertance"]["value"]
    assert value == pytest.approx(158.65, abs=5e-3)
