"""Exudyn itself, imported when it is needed; the rest of inerter does without it."""

from __future__ import annotations

import functools
import importlib
import importlib.util
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

OLDEST, NEWEST = (1, 9), (1, 13)
"""Versions of Exudyn that are tested; 1.8 gives wrong forces, 1.7 has no expressions."""


def installed() -> bool:
    """Whether Exudyn can be imported; a mere folder of its name does not count."""
    found = importlib.util.find_spec("exudyn")
    return found is not None and found.origin is not None


@functools.cache
def exudyn(module: str = "") -> Any:
    """The package, or one of its modules.

    Raises
    ------
    ImportError
        It is not installed; the message says how to install it.
    """
    if not installed():
        raise ImportError(
            "Exudyn is not installed; run `pip install exudyn` (the extra `exudyn`) "
            "(it has wheels for the usual Pythons)"
        )
    package = importlib.import_module("exudyn")
    _check_version(package)
    if not module or hasattr(package, module):
        return getattr(package, module) if module else package
    return importlib.import_module(f"exudyn.{module}")


def version(package: Any) -> tuple[int, ...]:
    """Major and minor version of Exudyn's package."""
    return tuple(int(part) for part in _told(package).split(".")[:2] if part.isdigit())


def _told(package: Any) -> str:
    return str(getattr(package, "__version__", None) or package.GetVersionString())


def _check_version(package: Any) -> None:
    """Raise ImportError for a version that does not work as those which are tested."""
    told, numbers = _told(package), version(package)
    if not OLDEST <= numbers <= NEWEST:
        raise ImportError(
            f"Exudyn {told} is not one of the versions that inerter works with, "
            f"{OLDEST[0]}.{OLDEST[1]} to {NEWEST[0]}.{NEWEST[1]}; run `pip install "
            f"exudyn=={NEWEST[0]}.{NEWEST[1]}.*` (the extra `exudyn`)"
        )


@contextmanager
def quiet() -> Iterator[None]:
    """Keep Exudyn from printing: its solvers remark on any user function."""
    config = getattr(exudyn(), "config", None)
    if config is None:
        # Exudyn 1.9, which cannot tell how it is set
        exudyn().SetWriteToConsole(False)
        try:
            yield
        finally:
            exudyn().SetWriteToConsole(True)
        return
    before = config.printToConsole
    config.printToConsole = False
    try:
        yield
    finally:
        config.printToConsole = before
