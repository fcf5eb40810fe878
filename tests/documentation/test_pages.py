"""What the pages show runs: their Python, their notebook, the options of their command lines.

Of the how-to pages everything runs, commands too, in the order of the page and in one folder.
"""

from __future__ import annotations

import json
import re
import shlex
import subprocess
import sys
from functools import cache
from importlib.util import find_spec
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
PAGES = [ROOT / "README.md", ROOT / "plugin_c" / "README.md", *sorted(DOCS.glob("*.md"))]
HOW_TO = sorted((DOCS / "how_to").glob("*.md"))

# a page's blocks and commands as one program; what is shown as a file is written
PROGRAM = """
import json, sys
from pathlib import Path
from inerter.commands import app

names = {}
for kind, content in json.load(sys.stdin):
    if kind == "python":
        exec(compile(content, "the page", "exec"), names)
    elif kind == "sh":
        code = app(content, standalone_mode=False)
        assert not code, content
    else:
        Path(kind).write_text(content, encoding="utf-8")
"""


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


def steps(page: Path) -> list[tuple[str, object]]:
    """Blocks of a page in order: python, sh (a command's words), or the name of a file to write."""
    found: list[tuple[str, object]] = []
    text = page.read_text(encoding="utf-8")
    for language, content in re.findall(r"^```(\w+)\n(.*?)^```", text, re.S | re.M):
        if language == "python":
            found.append(("python", content))
        elif language == "sh":
            lines = [shlex.split(line, comments=True) for line in content.splitlines()]
            assert all(words[0] == "inerter" for words in lines), content
            found += [("sh", words[1:]) for words in lines]
        else:
            named = re.match(r"(?:<!--|#) ([\w.]+)", content)
            assert named, f"{page.name}: a block of {language} that names no file"
            found.append((named[1], content))
    return found


@pytest.mark.rarely("bench.md")
@pytest.mark.parametrize("page", [page for page in HOW_TO if steps(page)], ids=lambda p: p.name)
def test_a_how_to_works_as_it_stands(page: Path, tmp_path: Path) -> None:
    todo = steps(page)
    if any("exudyn" in str(content) for _, content in todo):
        pytest.importorskip("exudyn")
    if find_spec("gymnasium") is None:
        todo = [(kind, what) for kind, what in todo if "gymnasium" not in str(what)]
    # a viewer that serves until it is ended is tested on its own
    todo = [(kind, what) for kind, what in todo if kind != "sh" or not serves(what)]
    (tmp_path / "mjcf_models").symlink_to(ROOT / "mjcf_models")
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", PROGRAM], input=json.dumps(todo),
        cwd=tmp_path, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr


def test_every_how_to_is_in_the_index() -> None:
    index = (DOCS / "how_to" / "index.md").read_text(encoding="utf-8")
    for page in (page for page in HOW_TO if page.name != "index.md"):
        assert f"[{page.stem}]({page.name})" in index, f"{page.name}: not in the table"
        assert re.search(rf"^{page.stem}$", index, re.M), f"{page.name}: not in the toctree"


@pytest.mark.parametrize("page", [page for page in HOW_TO if "{include}" in page.read_text()])
def test_what_a_how_to_includes_is_there(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    for name, start, end in re.findall(
        r'^```{include} (\S+)\n:start-after: "(.*)"\n:end-before: "(.*)"\n```', text, re.M
    ):
        whole = (page.parent / name).read_text(encoding="utf-8")
        assert whole.count(start) == 1, f"{name}: {start}"
        included = whole.split(start)[1].split(end)[0]
        # links would lead elsewhere from the page
        assert len(included) > 1000
        assert "](" not in included, f"{page.name}: a link"


def test_files_that_a_guide_names_are_there() -> None:
    """Those of CONTRIBUTING.md with a folder, from the root or from where such files are."""
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    named = set(re.findall(r"`([\w./]+/[\w.]+\.(?:py|c|h|md|toml))`", text))
    made_up = {name for name in named if "karnopp" in name or name.startswith("../")}
    folders = [ROOT / each for each in ("", "python/inerter", "plugin_c", "tests")]
    missing = [
        name for name in sorted(named - made_up)
        if not any((folder / name).is_file() for folder in folders)
    ]  # fmt: skip
    assert len(named) > 40
    assert missing == []


def serves(words: object) -> bool:
    assert isinstance(words, list)
    return words[0] == "view" and "--picture" not in words


@pytest.mark.parametrize("path", sorted(DOCS.rglob("*.ipynb")), ids=lambda path: path.name)
def test_a_notebook_runs(path: Path, tmp_path: Path) -> None:
    """Its cells as one program; the page builder runs it in a kernel."""
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    assert not any(cell.get("outputs") for cell in cells), "store it without outputs"
    code = "\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code")
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", "import matplotlib; matplotlib.use('agg')\n" + code],
        cwd=tmp_path, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
