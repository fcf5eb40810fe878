"""The versions of MuJoCo that the plugin is built for, and where their headers and libraries are.

    python engines.py FOLDER    # every version, unpacked into FOLDER/<version>/mujoco

prints the folders. The standard library and pip are enough.
"""

from __future__ import annotations

import argparse
import os
import site
import subprocess
import sys
import sysconfig
import tempfile
import zipfile
from collections.abc import Iterator
from pathlib import Path

# oldest first; what the package index calls the wheel that holds it. The range in pyproject.toml is
# from the first to the last.
ENGINES = {
    "3.16.0": "mujoco",
    "3.17.0": "mujoco",
    "4.0.0": "mujoco-core",
    "4.0.1": "mujoco-core",
}
# what brings the engine that `pip install inerter` would bring
REQUIREMENT = "mujoco>={},<={}".format(*(list(ENGINES)[i] for i in (0, -1)))
# folders to build for, instead of the engine that is installed
VARIABLE = "INERTER_MUJOCO"


def asked_for() -> list[Path]:
    """The folders that the environment variable names."""
    return [Path(text) for text in os.environ.get(VARIABLE, "").split(os.pathsep) if text]


def installed() -> Path | None:
    """Folder of the MuJoCo that stands where the package is going to, None without.

    pip hides it from an isolated build by sys.path; the interpreter's own folders are still known.
    """
    places = [sysconfig.get_path(name) for name in ("platlib", "purelib")]
    for place in [*places, site.getusersitepackages(), *sys.path]:
        folder = Path(place) / "mujoco"
        if place and (folder / "include" / "mujoco" / "mujoco.h").is_file():
            return folder
    return None


def download(folder: Path) -> Iterator[Path]:
    """Fetch every engine that is not in the folder yet; the folder of each."""
    for version, package in ENGINES.items():
        place = folder / version
        if not (place / "mujoco").is_dir():
            _unpack(place, f"{package}=={version}")
        yield place / "mujoco"


def _unpack(place: Path, requirement: str) -> None:
    place.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=place) as fetched:
        pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "--no-input"]
        wanted = ["--no-deps", "--only-binary", ":all:", "--dest", fetched, requirement]
        subprocess.run([*pip, "download", "--quiet", *wanted], check=True, stdout=sys.stderr)
        (wheel,) = Path(fetched).glob("*.whl")
        with zipfile.ZipFile(wheel) as archive:
            for name in archive.namelist():
                if name.startswith(("mujoco/include/", "mujoco/libmujoco")):
                    archive.extract(name, place)


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(description="fetch the engines that the plugin is built for")
    parser.add_argument("folder", type=Path)
    folder = parser.parse_args().folder.resolve()
    print(os.pathsep.join(map(str, download(folder))))


if __name__ == "__main__":
    main()
