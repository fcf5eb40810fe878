"""The whole study, small: its files, its JSON, its command."""

import json
import re
from pathlib import Path

import pytest
from inerter.commands import app
from inerter.studies.hysteresis.output import write_study
from inerter.studies.hysteresis.published import MAKERS, MODELS
from inerter.studies.hysteresis.settings import Settings
from inerter.studies.hysteresis.study import Study, study
from inerter.studies.hysteresis.tables import tables
from typer.testing import CliRunner

SMALL = Settings(rate=200.0, duration=4.0, draws=2, random_starts=1, starts=2)


@pytest.fixture(scope="module")
def small() -> Study:
    shares: list[float] = []
    found = study(SMALL, jobs=1, progress=shares.append)
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    return found


def test_files(small: Study, tmp_path: Path) -> None:
    names = write_study(small, tmp_path / "out")
    assert {p.name for p in (tmp_path / "out").iterdir()} == set(names)
    said = json.loads((tmp_path / "out" / "hysteresis.json").read_text())
    assert said["schema"] == "inerter.hysteresis_study/1"
    assert len(said["held_out"]) == 4 * 4 * 4
    assert said["published_loops"].keys() == {*MAKERS, "ideal"}
    assert said["mended"]["dahl"] == []
    page = (tmp_path / "out" / "hysteresis.html").read_text()
    # nothing is loaded from elsewhere
    assert not re.search(r"<(script|link|img)[^>]*(src|href)=[\"']https?:", page)
    assert all(each.statement in page for each in small.conclusions if "'" not in each.statement)
    for name in names:
        if name.endswith(".png"):
            assert (tmp_path / "out" / name).read_bytes().startswith(b"\x89PNG")


def test_tables_are_full(small: Study) -> None:
    made = tables(small)
    assert all(len(row) == len(table.heads) for table in made for row in table.rows)
    assert all(table.rows for table in made)
    by_title = {table.title.split(":")[0]: table for table in made}
    assert len(by_title["Fitted at 4 Hz alone"].rows) == len(MAKERS) * (len(MODELS) + 1)
    assert made[0].markdown().count("\n") == len(made[0].rows) + 1


def test_verdicts_are_words(small: Study) -> None:
    assert {each.verdict for each in small.conclusions} <= {"holds", "in part", "does not hold"}


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["--noise", "nan"], "noise"), (["--denoise", "fourier"], "lowpass"),
        (["--rate", "1"], "rate"),
    ],
)  # fmt: skip
def test_command_refuses(arguments: list[str], word: str, tmp_path: Path) -> None:
    target = tmp_path / "out"
    said = CliRunner().invoke(app, ["study", "hysteresis", "--out", str(target), *arguments])
    assert said.exit_code == 2
    assert word in said.stderr
    assert said.stderr.count("\n") == 1
    assert not target.exists()


def test_command_refuses_a_folder_it_cannot_make(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    said = CliRunner().invoke(app, ["study", "hysteresis", "--out", str(tmp_path / "file" / "x")])
    assert said.exit_code == 2
    assert "choose --out" in said.stderr
