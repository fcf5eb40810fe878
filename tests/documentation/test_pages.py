"""What the pages show runs: their Python, and the options of their command lines."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", ROOT / "plugin_c" / "README.md", *sorted((ROOT / "docs").glob("*.md"))]


def blocks(page: Path, language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", page.read_text(encoding="utf-8"), re.S)


def commands() -> list[tuple[str, str]]:
    """Page and command line of every `inerter` in the pages' shell blocks."""
    found = []
    for page in PAGES:
        for block in blocks(page, "sh"):
            for line in block.splitlines():
                words = shlex.split(line, comments=True)
                if words and words[0].endswith("inerter"):
                    found.append((page.name, shlex.join(words[1:])))
    return found


@cache
def help_of(names: tuple[str, ...]) -> str:
    """Help of a command; empty where there is none of that name."""
    done = subprocess.run(
        [sys.executable, "-m", "inerter", *names, "--help"],
        capture_output=True, text=True, check=False, env={"COLUMNS": "200", "PATH": ""},
    )  # fmt: skip
    return done.stdout if done.returncode == 0 else ""


@pytest.mark.parametrize("page", [p for p in PAGES if blocks(p, "python")], ids=lambda p: p.name)
def test_python_of_a_page_runs(page: Path, tmp_path: Path) -> None:
    """In the order of the page, as one program."""
    code = "\n".join(blocks(page, "python"))
    if "exudyn" in code:
        pytest.importorskip("exudyn")
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", code],
        cwd=tmp_path, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize(("page", "line"), commands())
def test_a_command_line_is_understood(page: str, line: str) -> None:
    """The command exists and knows every option."""
    words = shlex.split(line)
    names = tuple(word for word in words[:2] if re.fullmatch(r"[a-z-]+", word))
    text = help_of(names) or help_of(names[:1])
    assert text, f"{page}: there is no command {names[0]}"
    for option in (word.split("=")[0] for word in words if word.startswith("--")):
        assert re.search(rf"{option}\b", text), f"{page}: {line}"


def test_pages_name_commands() -> None:
    assert len(commands()) > 15
