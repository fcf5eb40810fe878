"""Loads the MuJoCo plugin; MuJoCo calls `load_plugin` by itself at the end of `import mujoco`."""

from __future__ import annotations

import ctypes
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
        The installed MuJoCo is not the one the plugin was compiled for, or the library is missing
        or damaged.
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
    path = str(plugin_path())
    try:
        mujoco.mj_loadPluginLibrary(path)
        built_for = ctypes.CDLL(path).inerter_built_for()
    except (mujoco.FatalError, OSError, AttributeError) as error:
        raise ImportError(
            f"{path} cannot be loaded ({str(error).strip()}): it was not compiled for MuJoCo "
            f"{found}, or is damaged; reinstall with `pip install --force-reinstall inerter`"
        ) from None
    if built_for != mujoco.mj_version():
        raise ImportError(
            f"{path} was compiled for MuJoCo {_text(built_for)}, installed is MuJoCo {found}; "
            f"run `pip install --force-reinstall inerter`, or `pip install "
            f"mujoco=={_text(built_for)}`"
        )
    _loaded = True


def _text(version: int) -> str:
    """A version as MuJoCo numbers it: 4001002 is 4.1.2."""
    return f"{version // 1_000_000}.{version // 1000 % 1000}.{version % 1000}"


def _numbers(version: str) -> list[int]:
    return [int(number) for number in re.findall(r"\d+", version)[:3]]
