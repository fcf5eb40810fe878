"""Exudyn itself, imported when it is needed; the rest of inerter does without it."""

from __future__ import annotations

import functools
import importlib
import importlib.util
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any


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
            'Exudyn is not installed; run `pip install "inerter[exudyn]"` '
            "(it has wheels for the usual Pythons)"
        )
    package = importlib.import_module("exudyn")
    if not module or hasattr(package, module):
        return getattr(package, module) if module else package
    return importlib.import_module(f"exudyn.{module}")


@contextmanager
def quiet() -> Iterator[None]:
    """Keep Exudyn from printing: its solvers remark on any user function."""
    config = exudyn().config
    before = config.printToConsole
    config.printToConsole = False
    try:
        yield
    finally:
        config.printToConsole = before
