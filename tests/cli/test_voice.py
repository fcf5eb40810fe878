"""The command line in one voice: help that is whole, lists that can be copied, names that hold."""

from __future__ import annotations

import json
import time
from pathlib import Path

import pytest
from inerter.commands import app
from inerter.console import EVERY_VARIABLE, progress_bar, status
from inerter.core import lists, parameters
from inerter.models import model_names
from typer.main import get_command
from typer.testing import CliRunner

TOP = get_command(app)


def commands() -> list[tuple[str, ...]]:
    found: list[tuple[str, ...]] = []
    for name, command in TOP.commands.items():  # type: ignore[attr-defined]
        if command.hidden:
            continue
        inner = getattr(command, "commands", None)
        found += [(name,)] if inner is None else [(name, each) for each in inner]
    return found


def output(*arguments: str) -> str:
    done = CliRunner().invoke(app, list(arguments), env={"COLUMNS": "80"})
    assert done.exit_code == 0, done.output
    return done.stdout


def test_the_list_of_commands_is_cut_nowhere() -> None:
    text = output("--help")
    assert "..." not in text.split("Commands:")[1]
    assert max(map(len, text.splitlines())) <= 80
    for name in ("inspect", "convert", "models", "benchmark", "parameters"):
        assert f"\n  {name} " in text
    assert "\n  bench " not in text


@pytest.mark.parametrize("name", commands())
def test_every_help_has_an_example_in_80_columns(name: tuple[str, ...]) -> None:
    text = output(*name, "--help")
    assert max(map(len, text.splitlines())) <= 80
    assert f"inerter {' '.join(name)}" in text.split("Example")[1]
    # what each option takes, in plain words
    assert not {"<str>", "<path>", "<list[str]>", "<int", "<float"} & set(text.split())


def test_names_of_before_are_understood(tmp_path: Path) -> None:
    """--velocity of a suspension is --speed, --reoptimise --reoptimize; help shows the new ones."""
    for words in (["optimize"], ["pareto"], ["network"]):
        help_text = output("suspension", *words, "--help")
        assert "--speed" in help_text
        assert "--velocity" not in help_text
    found = [
        json.loads(
            output("suspension", "optimize", "--layout=S1", "--index=J1", "--json", option, "20")
        )
        for option in ("--speed", "--velocity")
    ]
    assert found[0] == found[1]
    assert "--reoptimise" not in output("suspension", "evaluate", "--help")
    done = CliRunner().invoke(app, ["suspension", "evaluate", "--reoptimise", "--damping=3000",
                                    "--inertance=30", f"--out={tmp_path}"])  # fmt: skip
    assert "cannot be sought anew" in done.stderr


def test_parameters_are_whole_in_a_pipe() -> None:
    rows = [line.split("\t") for line in output("parameters").splitlines()]
    assert [row[0] for row in rows[1:]] == [*parameters(), *lists()]
    assert {len(row) for row in rows} == {6}


def test_parameters_of_a_part() -> None:
    found = json.loads(output("parameters", "series", "--json"))
    assert {each["name"] for each in found} == {name for name in parameters() if "series" in name}
    assert CliRunner().invoke(app, ["parameters", "nothing of this"]).exit_code == 2


def test_parameters_on_a_terminal_keep_their_names() -> None:
    from inerter.parameter_list import chosen, text

    shown = text(chosen(None), 80)
    assert max(map(len, shown.splitlines())) <= 80
    assert all(f"\n{name} " in shown for name in parameters())


def test_shipped_models_go_by_name() -> None:
    found = {each["name"]: each for each in json.loads(output("models", "--json"))}
    assert list(found) == model_names()
    assert found["half_car"]["keyframes"] == ["kerb"]
    done = CliRunner().invoke(app, ["simulate", "nobody"])
    assert done.exit_code == 2
    assert "half_car" in done.stderr


def test_progress_is_a_line_now_and_then_without_a_terminal(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv(EVERY_VARIABLE, "1")
    with progress_bar("working", False) as progress:
        progress(0.25, "on it")
        time.sleep(1.3)
    assert "on it: 25 % done, about" in capsys.readouterr().err
    monkeypatch.setenv(EVERY_VARIABLE, "0")
    with status(False) as say:
        say("nothing")
    assert capsys.readouterr().err == ""
