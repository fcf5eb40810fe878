"""The plugin with every version of MuJoCo that it is built for, one wheel for all: `make versions`.

    python tests/versions/run.py FOLDER [pytest arguments]

FOLDER/wheel holds the wheel. Every version gets an environment of its own in FOLDER: engine and
wheel installed, the other packages linked from the environment that runs this. The oldest and the
newest version run the plugin's tests, one of them a day and with `--both` both; the others load and
drive the quarter-car. With 3.17 entities of dm_control's Composer have devices: it does not run on
a newer MuJoCo.
"""

from __future__ import annotations

import os
import runpy
import subprocess
import sys
import time
from datetime import date
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
ENGINES: dict[str, str] = runpy.run_path(str(ROOT / "plugin_c/packaging/engines.py"))["ENGINES"]
WHOLE = ["tests/plugin", "tests/versions"]
SOME = ["tests/versions", "tests/agreement/test_quarter_car.py"]
# what runs with one version only, and what of its requirements the development's environment lacks
BESIDE = {
    "3.17.0": (
        ["dm_control==1.0.50", "dm-env", "dm-tree", "labmaze", "lxml", "protobuf", "wrapt"],
        ["tests/neighbours/test_composer.py"],
    ),
}


def main() -> int:
    """Run the tests; 1 if a version fails."""
    folder, *arguments = (argument for argument in sys.argv[1:] if argument != "--both")
    (wheel,) = Path(folder).resolve().glob("wheel/*.whl")
    results, ends = [], [min(ENGINES, key=_numbers), max(ENGINES, key=_numbers)]
    if "--both" not in sys.argv:
        ends = [ends[date.today().toordinal() % 2]]
    for version, package in ENGINES.items():
        packages, beside = BESIDE.get(version, ([], []))
        tests = [*(WHOLE if version in ends else SOME), *beside]
        print(f"\n== MuJoCo {version}: {' '.join(tests)}", flush=True)
        started = time.monotonic()
        engine = f"{package}=={version}"
        python = _environment(wheel.parents[1] / version, wheel, engine, *packages)
        command = [python, "-m", "pytest", "-n", "auto", *tests, *arguments]
        environment = {**os.environ, "INERTER_TESTED_ENGINE": version}
        status = subprocess.run(command, cwd=ROOT, env=environment, check=False).returncode
        results.append((version, status, time.monotonic() - started))
    print()
    for name, status, seconds in results:
        print(f"MuJoCo {name:8} {'FAILED' if status else 'passed':7} {seconds:4.0f} s")
    return int(any(status for _, status, _ in results))


def _numbers(version: str) -> list[int]:
    return [int(number) for number in version.split(".")]


def _environment(place: Path, *packages: str | Path) -> Path:
    """An environment with an engine, the wheel and what else is named; its Python."""
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", place], check=True)
    python = place / "bin" / "python"
    mine, its = (_packages(each) for each in (sys.executable, python))
    for entry in mine.iterdir():
        if not entry.name.lower().startswith(("mujoco", "inerter", "__pycache__")):
            (its / entry.name).symlink_to(entry)
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "install", "--quiet"]
    subprocess.run([*pip, "--no-deps", "--target", its, *packages], check=True)
    return python


def _packages(python: str | Path) -> Path:
    code = "import sysconfig; print(sysconfig.get_path('purelib'))"
    done = subprocess.run([python, "-c", code], capture_output=True, text=True, check=True)
    return Path(done.stdout.strip())


if __name__ == "__main__":
    sys.exit(main())
