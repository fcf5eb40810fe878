"""`inerter blind-test` as a user runs it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from inerter.commands import app
from typer.testing import CliRunner


@pytest.mark.long
def test_command_end_to_end(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("INERTER_SEED", "20261121")
    # how the engines agree is asked elsewhere
    monkeypatch.setattr("inerter.diagnose.rig.simulate_engines", lambda *_: {})
    arguments = ["blind-test", "--effects", "viscous_friction,force_offset", "--count", "1"]
    arguments += ["--clean", "1", "--workers", "1", "--out", str(tmp_path), "--json"]
    result = CliRunner().invoke(app, arguments)
    assert result.exit_code == 0, result.output
    assert "3 cases, --seed 20261121" in result.stderr
    found = json.loads(result.stdout)
    assert found == json.loads((tmp_path / "blind_test.json").read_text(encoding="utf-8"))
    assert found["settings"]["noise"] == 0.01
    assert found["seed"] == 20261121
    assert found["confusion"]["counts"] == [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
    assert found["single"]["parameters_near"] == 1.0
    assert found["single"]["gain_on_truth"]["worst"] > 0.5
    assert found["failures"] == []
    assert {path.name for path in tmp_path.iterdir()} == {
        "blind_test.json", "confusion.png", "calibration.png", "cases",
    }  # fmt: skip


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--effects", "gremlins"], "'gremlins' is not one of"),
        (["--effects", "backlash", "--triples", "1"], "no 3 go together"),
        (["--noise", "7"], "--noise: 7"),
    ],
)
def test_mistakes_end_with_one_line(arguments: list[str], words: str, tmp_path: Path) -> None:
    target = tmp_path / "out"
    result = CliRunner().invoke(app, ["blind-test", *arguments, "--out", str(target)])
    assert result.exit_code == 2
    assert words in result.stderr
    assert result.stderr.count("\n") == 1
    assert not target.exists()


def test_a_seed_that_is_none_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("INERTER_SEED", "monday")
    result = CliRunner().invoke(app, ["blind-test", "--count", "1"])
    assert result.exit_code == 2
    assert "INERTER_SEED is 'monday'" in result.stderr
