"""A command loads what it needs, and no other command's libraries: the help comes at once."""

from __future__ import annotations

import subprocess
import sys

import pytest

HEAVY = ("matplotlib", "mujoco", "pint", "plotly", "polars", "scipy")
DIAGNOSIS = ("inerter.diagnose", "inerter.identify", "inerter.reference", "inerter.simulate")
CASES = {
    "--help": HEAVY,
    "design --help": HEAVY,
    "design ball-screw --help": HEAVY,
    "diagnose --help": HEAVY,
    "plugin-path": HEAVY,
    "design ball-screw": ("matplotlib", "mujoco", "pint", "plotly", "polars", *DIAGNOSIS),
    "design fluid --bore 0.06": ("matplotlib", "mujoco", "pint", "plotly", "polars", *DIAGNOSIS),
}


def run(script: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=False
    )  # fmt: skip


@pytest.mark.parametrize("words", CASES)
def test_a_command_loads_no_other_ones_libraries(words: str) -> None:
    done = run(
        "import sys\n"
        f"sys.argv[1:] = {words.split()!r}\n"
        "from inerter.commands import app\n"
        "app(standalone_mode=False)\n"
        "print('loaded', *sys.modules, file=sys.stderr)"
    )
    assert done.returncode == 0, done.stderr
    loaded = done.stderr.split()
    assert loaded[0] == "loaded"
    # a package with nothing of it loaded costs nothing: inerter.identify holds a command
    heavy = [name for name in CASES[words] if name in loaded and _weighs(name, loaded)]
    assert heavy == []


def _weighs(name: str, loaded: list[str]) -> bool:
    below = {module for module in loaded if module.startswith(f"{name}.")}
    return not name.startswith("inerter.") or bool(below - {f"{name}.command"})


def test_part_of_the_lab_missing_is_told_when_it_is_needed() -> None:
    done = run(
        "import sys; sys.modules['scipy'] = None; sys.argv[1:] = ['design', 'ball-screw']\n"
        "from inerter.__main__ import main; main()"
    )
    assert done.returncode == 2
    assert "scipy is not installed; install inerter again with it" in done.stderr
    assert done.stderr.count("\n") == 1
