"""Results are there as a whole or not at all: full disks, folders in the way, interrupts."""

from __future__ import annotations

import json
import os
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest
from inerter.commands import app
from inerter.folder import file_names, refuse_folder, write_files
from inerter.models import data_path, model_path
from inerter.staging import Staging
from typer.testing import CliRunner

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="limits and signals of POSIX")
RECORD = str(data_path("bench_record.csv"))
TABLE = str(data_path("ball_screw_table.csv"))
SCENE = str(model_path("quarter_car", "scene.xml"))

# every command that writes, as short as it can be
COMMANDS = {
    "diagnose": ["diagnose", TABLE],
    "simulate": ["simulate", SCENE, "--duration", "0.5"],
    "identify": ["identify", RECORD, "--law", "ideal", "--intervals", "normal"],
    "prepare": ["prepare", RECORD],
    "design": ["design", "fluid"],
    "optimize": ["suspension", "optimize", "--layout", "S1", "--index", "J3", "--stiffness",
                 "60e3:80e3:2", "--jobs", "1"],
    "evaluate": ["suspension", "evaluate", "--layout", "S1", "--index", "J1", "--case", "ideal",
                 "--seeds", "2", "--jobs", "1"],
}  # fmt: skip


def inerter(
    *arguments: str | Path, before: Callable[[], None] | None = None, **options: object
) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "inerter", *map(str, arguments)],
        capture_output=True, text=True, timeout=300, check=False, preexec_fn=before,
        **options,  # type: ignore[call-overload]
    )  # fmt: skip


def only_line(text: str) -> str:
    (line,) = text.strip().splitlines()
    assert line.startswith("inerter: ")
    return line


def full_disk() -> None:
    """Let no file grow beyond 20 bytes."""
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (20, 20))


def test_a_full_disk_leaves_nothing(tmp_path: Path) -> None:
    out = tmp_path / "new" / "out"
    done = inerter(*COMMANDS["simulate"], "--out", out, before=full_disk, cwd=tmp_path)
    assert done.returncode == 1
    assert only_line(done.stderr).startswith(f"inerter: {out}: cannot be written (File too large)")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_leaves_nothing_on_a_full_disk(
    command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(path: Path, data: bytes) -> None:
        raise OSError(28, "No space left on device", str(path))

    monkeypatch.setattr(Path, "write_bytes", full)
    out = tmp_path / "new" / "out"
    done = CliRunner().invoke(app, [*COMMANDS[command], "--out", str(out)])
    assert done.exit_code == 1
    assert only_line(done.stderr) == (
        f"inerter: {out}: cannot be written (No space left on device); choose --out"
    )
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("command", COMMANDS)
def test_a_file_for_a_folder_is_refused_first(command: str, tmp_path: Path) -> None:
    (tmp_path / "out").write_text("mine")
    done = CliRunner().invoke(app, [*COMMANDS[command], "--out", str(tmp_path / "out" / "deep")])
    assert done.exit_code == 2
    assert "not a folder" in only_line(done.stderr)
    assert (tmp_path / "out").read_text() == "mine"


def test_a_folder_that_nobody_can_write_is_refused() -> None:
    # root may write anywhere but where the kernel has no files
    if not Path("/proc/self").is_dir():
        pytest.skip("no /proc here")
    with pytest.raises(OSError, match="/proc"):
        refuse_folder(Path("/proc/inerter/out"))


def test_a_full_stdout_is_one_line() -> None:
    if not Path("/dev/full").exists():
        pytest.skip("no /dev/full here")
    with open("/dev/full", "w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "inerter", "parameters"],
            stdout=full, stderr=subprocess.PIPE, text=True, timeout=100, check=False,
        )  # fmt: skip
    assert done.returncode == 1
    assert "standard output: cannot be written (No space left" in only_line(done.stderr)


def test_a_reader_that_goes_away_is_no_error_to_tell() -> None:
    reading, writing = os.pipe()
    os.close(reading)
    done = subprocess.run(
        [sys.executable, "-m", "inerter", "parameters"],
        stdout=writing, stderr=subprocess.PIPE, text=True, timeout=100, check=False,
    )  # fmt: skip
    os.close(writing)
    assert done.returncode == 1
    assert done.stderr == ""


# --- write_files -------------------------------------------------------------------------------


def listing(folder: Path) -> dict[str, str]:
    return {
        str(path.relative_to(folder)): path.read_text() if path.is_file() else "/"
        for path in folder.rglob("*")
    }


FILES = {"a.txt": "new a", "deep/b.txt": "new b", "c.txt": "new c"}


def test_files_are_exchanged_together(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("old a")
    (tmp_path / "mine.txt").write_text("mine")
    assert write_files(tmp_path, FILES) == list(FILES)
    assert listing(tmp_path) == {**FILES, "deep": "/", "mine.txt": "mine"}


@pytest.mark.parametrize("failing", [1, 2, 3])
@pytest.mark.parametrize("error", [OSError(5, "Input/output error"), KeyboardInterrupt()])
def test_what_fails_between_two_files_brings_the_old_ones_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, failing: int, error: BaseException
) -> None:
    out = tmp_path / "out"
    out.mkdir()
    (out / "a.txt").write_text("old a")
    (out / "c.txt").write_text("old c")
    before, replace, calls = listing(out), os.replace, []

    def fail(source: Path, target: Path) -> None:
        if "new" in source.parts:
            calls.append(target)
            if len(calls) == failing:
                raise error
        replace(source, target)

    monkeypatch.setattr(os, "replace", fail)
    with pytest.raises(type(error)):
        write_files(out, FILES)
    assert len(calls) == failing
    assert listing(out) == before


def test_a_folder_in_the_place_of_a_file_is_named(tmp_path: Path) -> None:
    (tmp_path / "c.txt").mkdir()
    before = listing(tmp_path)
    with pytest.raises(IsADirectoryError) as caught:
        write_files(tmp_path, FILES)
    assert str(tmp_path / "c.txt") in str(caught.value)
    assert listing(tmp_path) == before


@pytest.mark.parametrize("name", ["../b.txt", "/b.txt", "a/../../b.txt"])
def test_no_name_leads_out_of_the_folder(tmp_path: Path, name: str) -> None:
    with pytest.raises(ValueError, match="leads out of"):
        write_files(tmp_path / "out", {name: "b"})
    assert listing(tmp_path) == {}


NAMES = ["a/../../x", "front", "Front", "", "..", "/etc/passwd", "né e", "a\0b", "..."]


def test_files_after_names_of_a_model_are_all_there(tmp_path: Path) -> None:
    found = file_names(NAMES, "device")
    write_files(tmp_path, {f"{name}.csv": "" for name in found})
    assert listing(tmp_path) == {f"{name}.csv": "" for name in found}
    # different also where a file system does not tell capitals apart
    assert len({name.casefold() for name in found}) == len(NAMES)
    assert found[1:4] == ["front", "Front_2", "device_3"]


SIGNALS = ["SIGKILL", "SIGTERM"]
MORE_SIGNALS = ["SIGHUP", "SIGINT", "SIGQUIT", "SIGUSR1", "SIGUSR2", "SIGALRM", "SIGXCPU"]


@pytest.mark.parametrize("name", [*SIGNALS, *MORE_SIGNALS])
def test_a_signal_at_any_step_leaves_all_or_nothing(
    name: str, tmp_path: Path, long_run: bool
) -> None:
    """At each call of the system that writing makes, into a folder that is new and one that is not.

    What `kill -9` and a power cut leave behind in a folder that was there, the next run ends.
    """
    if name in MORE_SIGNALS and not long_run:
        pytest.skip("with --long")
    program = Path(__file__).with_name("killed.py")
    done = subprocess.run(
        [sys.executable, program, tmp_path, name],
        capture_output=True, text=True, timeout=300, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    for case, (wrong, steps) in json.loads(done.stdout).items():
        assert wrong == [], case
        assert steps > 40, case


def test_what_a_run_that_lives_is_making_is_left_alone(tmp_path: Path) -> None:
    with Staging(tmp_path) as staging:
        (staging.new / "a.txt").write_text("a")
        os.utime(staging.place, (0, 0))
        write_files(tmp_path, {"b.txt": "b"})
        assert (staging.new / "a.txt").read_text() == "a"
    assert listing(tmp_path) == {"b.txt": "b"}


def test_a_note_from_elsewhere_moves_nothing_out_of_the_folder(tmp_path: Path) -> None:
    out = tmp_path / "out"
    left = out / f"{Staging.PREFIX}x"
    (left / "new").mkdir(parents=True)
    (left / "lock").touch()
    (tmp_path / "mine.txt").write_text("mine")
    (left / "mine.txt").write_text("theirs")
    (left / "commit").write_text('{"../mine.txt": true}')
    write_files(out, {"a.txt": "a"})
    assert listing(tmp_path) == {"mine.txt": "mine", "out": "/", "out/a.txt": "a"}


# --- Ctrl-C ------------------------------------------------------------------------------------

LONG = {
    "simulate": ["simulate", SCENE, "--duration", "1e5", "--rate", "1"],
    "diagnose": ["diagnose", RECORD],
    "blind-test": ["blind-test", "--effects", "coulomb_friction", "--count", "4", "--seed", "1",
                   "--workers", "2"],
    "validate": ["validate", "--quick", "--jobs", "2"],
}  # fmt: skip


@cache
def start_up() -> float:
    """Seconds that the program takes to begin here and now."""
    begun = time.monotonic()
    subprocess.run([sys.executable, "-m", "inerter", "--version"], check=True, capture_output=True)
    return time.monotonic() - begun


@pytest.mark.parametrize(
    ("command", "after"),
    [("simulate", 0.7), *((command, 3.5) for command in LONG)],
)
def test_ctrl_c_ends_in_order(command: str, after: float, tmp_path: Path) -> None:
    """A terminal sends it to every process of a command: one line, status 130, no results."""
    out = tmp_path / "out"
    # with a display, `import mujoco` has pyGLFW ask another Python for its version, which hears
    # Ctrl-C too and says so by a traceback
    without_display = {**os.environ, "MUJOCO_GL": "disabled"}
    run = subprocess.Popen(
        [sys.executable, "-m", "inerter", *LONG[command], "--out", str(out)],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
        cwd=tmp_path, env=without_display,
    )  # fmt: skip
    # what the interpreter says while it loads the program is not the program's
    time.sleep(max(after, 2 * start_up()))
    os.killpg(run.pid, signal.SIGINT)
    stdout, stderr = run.communicate(timeout=60)
    assert run.returncode == 130, stderr
    # how the record looks is told before the work
    told = [line for line in stdout.splitlines() if not line.startswith((" ", "bench_record: "))]
    assert told == []
    lines = stderr.strip().splitlines()
    assert lines[-1] == "inerter: interrupted"
    # the blind test says its seed, and that it can go on
    assert len(lines) <= (3 if command == "blind-test" else 1), stderr
    left = [path.name for path in out.rglob("*")] if out.exists() else []
    assert [name for name in left if name.endswith((".json", ".html", ".toml", ".png"))] == []
    assert not any(name.startswith(Staging.PREFIX) for name in left)
