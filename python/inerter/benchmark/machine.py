"""The machine and the software that a benchmark ran on."""

from __future__ import annotations

import ctypes
import importlib.metadata
import os
import platform
from pathlib import Path
from typing import Any

from inerter.core import library_path

PACKAGES = ("mujoco", "numpy", "scipy", "exudyn", "numba", "openseespy")


def machine() -> dict[str, Any]:
    """Processor, cores, system, versions, compiler of the library, load of the moment.

    Packages that are not installed are None, and so is what a system does not tell.
    """
    return {
        "processor": _processor(),
        "cores": _cores(),
        "load": _load(),
        "system": f"{platform.system()} {platform.machine()}",
        "python": f"{platform.python_implementation()} {platform.python_version()}",
        "compiler": _compiler(),
        **{name: _version(name) for name in ("inerter", *PACKAGES)},
    }


def busy(described: dict[str, Any]) -> str | None:
    """A remark where other programs were running at the start."""
    load, cores = described["load"], described["cores"]
    if load is None or load < 0.5 * cores:
        return None
    return (
        f"the machine is busy (load {load:.1f} on {cores} cores): ratios hold, times are too long"
    )


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        lines = []
    for line in lines:
        key, _, value = line.partition(":")
        if key.strip() == "model name":
            return value.strip()
    return platform.processor() or platform.machine()


def _cores() -> int:
    """Those that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _load() -> float | None:
    """Programs that wanted to run, over the last minute."""
    return os.getloadavg()[0] if hasattr(os, "getloadavg") else None


def _compiler() -> str:
    function = ctypes.CDLL(os.fspath(library_path("inerter_core"))).inerter_compiler
    function.restype = ctypes.c_char_p
    return function().decode()


def _version(name: str) -> str | None:
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return None
