"""Loads the MuJoCo plugin; MuJoCo calls `load_plugin` by itself at the end of `import mujoco`."""

from __future__ import annotations

import re
from pathlib import Path

from inerter.core import library_path

# the version the library was compiled for; pyproject.toml pins the same
MUJOCO_VERSION = "4.0.0"

_loaded = False


def plugin_path() -> Path:
    """Path of the plugin library, for C programs and `simulate`.

    Raises
    ------
    ImportError
        The library is missing.
    """
    path = library_path("inerter_mujoco")
    if not path.exists():
        raise ImportError(
            f"{path} is missing: reinstall with `pip install --force-reinstall inerter`"
        )
    return path


def load_plugin() -> None:
    """Make `inerter.device` known to MuJoCo. Calling it again does nothing.

    Raises
    ------
    ImportError
        The installed MuJoCo is not the one the plugin was compiled for, or the library is missing.
    """
    global _loaded
    import mujoco

    if _loaded:
        return
    found = mujoco.mj_versionString()
    if _numbers(found) != _numbers(MUJOCO_VERSION):
        raise ImportError(
            f"inerter was compiled for MuJoCo {MUJOCO_VERSION}, installed is MuJoCo {found}; "
            f"run `pip install mujoco=={MUJOCO_VERSION}`, or an inerter made for MuJoCo {found}"
        )
    mujoco.mj_loadPluginLibrary(str(plugin_path()))
    _loaded = True


def _numbers(version: str) -> list[int]:
    return [int(number) for number in re.findall(r"\d+", version)[:3]]
