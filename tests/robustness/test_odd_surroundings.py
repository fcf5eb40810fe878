"""Terminals without characters, closed streams, odd variables: one line, and no traceback."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from inerter.commands import app
from inerter.models import data_path
from inerter.printable import plain
from inerter.records import RecordError, read_records
from typer.testing import CliRunner

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="streams of POSIX")
TABLE = str(data_path("ball_screw_table.csv"))
RECORD = str(data_path("bench_record.csv"))


def inerter(*arguments: str, shell: str = "", **variables: str) -> subprocess.CompletedProcess[str]:
    """A command, with streams as a shell redirects them."""
    command = [sys.executable, "-m", "inerter", *arguments]
    if shell:
        command = ["sh", "-c", f'exec "$@" {shell}', "sh", *command]
    return subprocess.run(
        command, capture_output=True, encoding="utf-8", errors="replace", timeout=300, check=False,
        env={**os.environ, **variables},
    )  # fmt: skip


ENCODINGS = ["ascii", "latin-1", "cp437", "utf-16", "koi8-r", "shift_jis"]


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_every_encoding_shows_something(encoding: str, tmp_path: Path, long_run: bool) -> None:
    if encoding != "ascii" and not long_run:
        pytest.skip("with --long")
    out = tmp_path / "out → ü"
    done = inerter("diagnose", TABLE, "--out", str(out), PYTHONIOENCODING=encoding)
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    assert (out / "report.html").exists()
    if encoding == "ascii":
        assert "out -> u" in " ".join(done.stdout.split())


def test_a_character_that_cannot_be_shown_has_another() -> None:
    assert (
        plain("a → b × c² ± 3 µm ≤ 5\u00a0% – ü 道 \udcff")
        == "a -> b x c^2 +/- 3 um <= 5 % - u ? ?"
    )


def test_a_closed_stdout_is_told_and_results_are_there(tmp_path: Path) -> None:
    done = inerter("design", "fluid", "--out", str(tmp_path / "out"), shell=">&-")
    assert done.returncode == 1
    assert done.stderr == "inerter: standard output: cannot be written (Bad file descriptor)\n"
    assert (tmp_path / "out" / "design.json").read_text().startswith("{")


@pytest.mark.parametrize("shell", ["2>&-", "<&-"])
def test_other_streams_may_be_closed(shell: str, tmp_path: Path) -> None:
    done = inerter("design", "fluid", "--out", str(tmp_path / "out"), shell=shell)
    assert done.returncode == 0
    assert done.stderr == ""


ODD = {"MPLBACKEND": "nonsense", "COLUMNS": "0", "LINES": "x"}


def test_odd_variables_change_nothing(tmp_path: Path) -> None:
    usual = inerter("diagnose", TABLE, "--out", str(tmp_path / "out"))
    odd = inerter("diagnose", TABLE, "--out", str(tmp_path / "out"), **ODD)
    assert (odd.returncode, odd.stdout, odd.stderr) == (0, usual.stdout, "")


def test_a_number_of_processors_that_is_none_is_named(tmp_path: Path) -> None:
    done = inerter("diagnose", RECORD, "--out", str(tmp_path / "out"), LOKY_MAX_CPU_COUNT="abc")
    assert done.returncode == 2
    assert "environment variable LOKY_MAX_CPU_COUNT is 'abc'; give a whole number" in done.stderr
    assert done.stderr.count("\n") == 1


@pytest.mark.parametrize("command", [["identify", "--law", "ideal", "--intervals", "normal"],
                                     ["prepare"], ["diagnose", "--quick"]])  # fmt: skip
def test_a_name_that_is_not_utf8(command: list[str], tmp_path: Path) -> None:
    path = os.path.join(os.fsencode(tmp_path), b"r\xff\xe4.csv")
    with open(path, "wb") as file:
        file.write(Path(RECORD).read_bytes())
    out = tmp_path / "out"
    more = [] if "--quick" in command else ["--out", str(out)]
    done = inerter(command[0], os.fsdecode(path), *command[1:], *more)
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""


def test_a_folder_that_may_not_be_entered_is_no_matter_of_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def shut(path: Path, *_: object, **__: object) -> None:
        raise PermissionError(13, "Permission denied", str(path))

    monkeypatch.setattr(Path, "is_dir", shut)
    with pytest.raises(RecordError, match=r"x.csv: cannot be opened \(Permission denied\); check"):
        read_records(tmp_path / "shut" / "x.csv")


def test_a_record_that_goes_away_while_it_is_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from inerter.records import raw_table, table

    path = tmp_path / "r.csv"
    path.write_text(Path(RECORD).read_text() + "1,x,2\n")

    read = table.READERS["text"]

    def read_and_remove(file: Path, *how: Any) -> raw_table.RawTable | None:
        found = read(file, *how)
        file.unlink()
        return found

    monkeypatch.setattr(table, "READERS", {"text": read_and_remove})
    with pytest.raises(RecordError, match=r"r\.csv: row \d+, column 'displacement': 'x' is not a"):
        read_records(path)


@pytest.mark.parametrize("what", ["link", "folder", "long"])
def test_what_is_wrong_with_out_is_told_first(
    what: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import inerter.diagnose

    monkeypatch.setattr(inerter.diagnose, "diagnose", lambda *_: pytest.fail("has begun"))
    out = tmp_path / ("x" * 300 if what == "long" else "out")
    if what == "link":
        out.symlink_to(tmp_path / "nowhere")
    if what == "folder":
        (out / "report.html").mkdir(parents=True)
    said = {"link": "a link that leads nowhere", "folder": "is a folder", "long": "name too long"}
    done = CliRunner().invoke(app, ["diagnose", TABLE, "--out", str(out)])
    assert done.exit_code == 2
    assert f"cannot be written ({said[what]}); choose --out" in done.stderr.replace("File ", "")


def test_too_long_a_run_says_what_is_allowed(tmp_path: Path) -> None:
    from inerter.models import model_path

    scene = str(model_path("quarter_car", "scene.xml"))
    command = ["simulate", scene, "--duration", "1e9", "--out", str(tmp_path / "out")]
    done = CliRunner().invoke(app, command)
    assert done.exit_code == 2
    assert "--duration is 1e+09: give seconds above 0, below 1e9" in done.stderr
