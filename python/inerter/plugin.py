"""Loads the MuJoCo plugin; MuJoCo calls `load_plugin` by itself at the end of `import mujoco`.

mjModel and mjData differ between versions of MuJoCo, so there is a library for every one of them:
lib/VERSION/libinerter_mujoco.so. The one of the running engine is taken.
"""

from __future__ import annotations

import ctypes
import re
import sys
from collections.abc import Sequence
from importlib import metadata
from pathlib import Path

from inerter import core_library

_STEM = "inerter_mujoco"
# built anew for the engine that is installed; from a wheel: for all of them
_REINSTALL = "pip install --force-reinstall --no-deps --no-cache-dir inerter"

_loaded = False


def plugin_versions() -> list[str]:
    """The versions of MuJoCo that this installation has a library for, oldest first."""
    found = core_library.LIBRARY_FOLDER.glob(f"*/{core_library.library_path(_STEM).name}")
    return sorted((path.parent.name for path in found), key=_numbers)


def plugin_path(version: str | None = None) -> Path:
    """Path of the plugin library, for C programs and `simulate`.

    Parameters
    ----------
    version : str, optional
        Version of MuJoCo, such as "4.0.0"; by default that of the installed package.

    Raises
    ------
    ImportError
        There is no library for this version; the message lists the versions that there are.
    """
    if version is None:
        version = _installed()
    there = plugin_versions()
    for each in there:
        if _numbers(each) == _numbers(version):
            return core_library.library_path(_STEM, each)
    if not there:
        missing = core_library.LIBRARY_FOLDER / "VERSION" / core_library.library_path(_STEM).name
        raise ImportError(f"{missing} is missing for every VERSION: reinstall with `{_REINSTALL}`")
    raise ImportError(
        f"inerter has no library for MuJoCo {version}; there is one for MuJoCo {_listed(there)}: "
        f"run `pip install mujoco=={there[-1]}`, or, if inerter supports MuJoCo {version}, "
        f"`{_REINSTALL}`, which builds it for the installed version"
    )


def _installed() -> str:
    """Version of MuJoCo here, without loading it where its package tells."""
    for package in ("mujoco", "mujoco-core") if "mujoco" not in sys.modules else ():
        try:
            return metadata.version(package)
        except metadata.PackageNotFoundError:
            continue
    import mujoco

    return str(mujoco.mj_versionString())


def load_plugin() -> None:
    """Make `inerter.device` known to MuJoCo. Calling it again does nothing.

    Raises
    ------
    ImportError
        There is no library for the installed MuJoCo, or it is missing or damaged.
    """
    global _loaded
    import mujoco

    if _loaded:
        return
    found = mujoco.mj_versionString()
    path = str(plugin_path(found))
    try:
        mujoco.mj_loadPluginLibrary(path)
        built_for = ctypes.CDLL(path).inerter_built_for()
    except (mujoco.FatalError, OSError, AttributeError) as error:
        raise ImportError(
            f"{path} cannot be loaded ({str(error).strip()}): it was not compiled for MuJoCo "
            f"{found}, or is damaged; reinstall with `{_REINSTALL}`"
        ) from None
    if built_for != mujoco.mj_version():
        raise ImportError(
            f"{path} was compiled for MuJoCo {_text(built_for)}, installed is MuJoCo {found}; "
            f"reinstall with `{_REINSTALL}`, or run `pip install mujoco=={_text(built_for)}`"
        )
    _loaded = True


def _text(version: int) -> str:
    """A version as MuJoCo numbers it: 4001002 is 4.1.2."""
    return f"{version // 1_000_000}.{version // 1000 % 1000}.{version % 1000}"


def _numbers(version: str) -> list[int]:
    return [int(number) for number in re.findall(r"\d+", version)[:3]]


def _listed(versions: Sequence[str]) -> str:
    *others, last = versions
    return f"{', '.join(others)} and {last}" if others else last


def supported_text() -> str:
    """What the command line says of the versions."""
    there = plugin_versions()
    return f"MuJoCo {_listed(there)}" if there else "no MuJoCo (the libraries are missing)"
