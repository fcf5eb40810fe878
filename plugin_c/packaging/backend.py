"""Builds the package: scikit-build-core, told which engines to compile for, and with what.

Engines: those of the folders in INERTER_MUJOCO, else the one that is installed where the package
goes to, else the one that pip is going to install with it. Compiler: that of CC, else cc, gcc or
clang, else the one of the package `ziglang`, which pip fetches for this build.
"""

from __future__ import annotations

import os
import shlex
import shutil
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

sys.path.insert(0, os.fspath(Path(__file__).parent))

import engines
from scikit_build_core import build as base
from scikit_build_core.build import (
    build_sdist,
    get_requires_for_build_sdist,
    prepare_metadata_for_build_editable,
    prepare_metadata_for_build_wheel,
)

__all__ = [
    "build_editable",
    "build_sdist",
    "build_wheel",
    "get_requires_for_build_editable",
    "get_requires_for_build_sdist",
    "get_requires_for_build_wheel",
    "prepare_metadata_for_build_editable",
    "prepare_metadata_for_build_wheel",
]

ZIG = "ziglang>=0.13"
Settings = dict[str, Any] | None


def get_requires_for_build_wheel(config_settings: Settings = None) -> list[str]:
    """What a wheel is built with."""
    return [*base.get_requires_for_build_wheel(config_settings), *_needed()]


def get_requires_for_build_editable(config_settings: Settings = None) -> list[str]:
    """What an installation in place is built with."""
    return [*base.get_requires_for_build_editable(config_settings), *_needed()]


def build_wheel(
    wheel_directory: str, config_settings: Settings = None, metadata_directory: str | None = None
) -> str:
    """Build a wheel; returns its name."""
    with _compiler():
        return base.build_wheel(wheel_directory, _settings(config_settings), metadata_directory)


def build_editable(
    wheel_directory: str, config_settings: Settings = None, metadata_directory: str | None = None
) -> str:
    """Build what an installation in place consists of; returns its name."""
    with _compiler():
        return base.build_editable(wheel_directory, _settings(config_settings), metadata_directory)


# ------------------------------ engines ------------------------------


def _needed() -> list[str]:
    needed = [] if engines.asked_for() or engines.installed() else [engines.REQUIREMENT]
    return needed if _has_compiler() else [*needed, ZIG]


def _settings(given: Settings) -> dict[str, Any]:
    key, settings = "cmake.define.MUJOCO_DIRS", dict(given or {})
    if key not in settings:
        found = engines.asked_for() or [engines.installed()]
        settings[key] = ";".join(folder.as_posix() for folder in found if folder)
    return settings


# ------------------------------ compiler ------------------------------


def _has_compiler() -> bool:
    if os.environ.get("CC"):
        return shutil.which(shlex.split(os.environ["CC"])[0]) is not None
    return any(map(shutil.which, ("cc", "gcc", "clang", "cl")))


@contextmanager
def _compiler() -> Iterator[None]:
    """CC for the build: what the machine has, or the compiler of the package ziglang."""
    if _has_compiler():
        yield
        return
    print("no C compiler here: taking the one of the package ziglang", file=sys.stderr)
    before = dict(os.environ)
    with tempfile.TemporaryDirectory(prefix="inerter_zig_") as folder:
        # its undefined behaviour sanitizer is on by default
        compiler, library = Path(folder, "zig-cc"), Path(folder, "zig-ar")
        for path, command in ((compiler, 'cc -fno-sanitize=undefined "$@"'), (library, 'ar "$@"')):
            python = shlex.quote(sys.executable)
            path.write_text(f"#!/bin/sh\nexec {python} -m ziglang {command}\n")
            path.chmod(0o755)
        os.environ["CC"] = os.fspath(compiler)
        os.environ["AR"] = os.fspath(library)
        os.environ.setdefault("ZIG_GLOBAL_CACHE_DIR", folder)
        try:
            yield
        finally:
            os.environ.clear()
            os.environ.update(before)
