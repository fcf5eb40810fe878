"""The repository itself: no path of one machine, no file too long to read."""

import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
LONGEST = 450

# folders of one machine, in two parts so that this file does not name them itself
FOLDERS = ["work" + "/", "root" + "/", "tmp" + "/dev", "tmp/bash" + "_jobs", "home" + r"/\w"]
MACHINE = re.compile(r"(?<![\w.])/(?:" + "|".join(FOLDERS) + ")")


@pytest.fixture(scope="module")
def tracked() -> list[Path]:
    """Files that git knows of and that exist."""
    listed = subprocess.run(
        ["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=False
    ) if (ROOT / ".git").exists() else None  # fmt: skip
    if listed is None or listed.returncode:
        pytest.skip("not a git checkout")
    paths = [ROOT / name for name in listed.stdout.split("\0") if name]
    return [path for path in paths if path.is_file()]


def test_no_path_of_one_machine(tracked: list[Path]) -> None:
    found = []
    for path in tracked:
        try:
            text = path.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            continue
        for number, line in enumerate(text.splitlines(), start=1):
            if MACHINE.search(line):
                found.append(f"{path.relative_to(ROOT)}:{number}: {line.strip()[:80]}")
    assert found == []


def test_no_module_is_too_long_to_read(tracked: list[Path]) -> None:
    long = {}
    for path in tracked:
        place = path.relative_to(ROOT)
        if path.suffix in (".py", ".c", ".h") and place.parts[0] != "tests":
            lines = len(path.read_text(encoding="utf-8").splitlines())
            if lines > LONGEST:
                long[str(place)] = lines
    assert long == {}


def test_nothing_that_is_built_is_tracked(tracked: list[Path]) -> None:
    built = {".so", ".dylib", ".dll", ".o", ".pyc", ".whl"}
    assert [str(path) for path in tracked if path.suffix in built] == []


def test_every_test_file_has_a_name_of_its_own(tracked: list[Path]) -> None:
    # pytest imports test modules by their bare names
    names = [path.name for path in tracked if "tests" in path.parts and path.suffix == ".py"]
    assert sorted(names) == sorted(set(names))
