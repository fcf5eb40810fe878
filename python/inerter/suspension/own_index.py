"""A user's own index, from a file: a weighted rms of a signal, or a function of other indices.

seat.toml, a transfer function W(s) beside a signal: || W s zs/zr ||_2 for J1

    [index]
    signal = "J1"                  # J1 body's acceleration, J3 tyre force, travel; pitch, roll
    numerator = [0.0, 1.0]         # of W, rising powers of s
    denominator = [1.0, 0.1, 2e-3]
    unit = "m/s^2"                 # the last two are for tables
    meaning = "at the driver's head"

mine.py:cost, a function of the indices that its arguments name, values in SI units

    def cost(J1w, J3, travel):
        return J1w + 1e-3 * J3 + 20.0 * travel

It is called with numbers; its slopes in them are found by differences, those of the indices in the
design stay exact. What it gives has to be positive and finite, for designs that are poor too.
"""

from __future__ import annotations

import importlib.util
import inspect
import math
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from inerter.input_file import read_toml
from inerter.suspension.rational import Rational

_STEP = 1e-6
_KEYS = {"signal", "numerator", "denominator", "unit", "meaning"}


class OwnIndexError(ValueError):
    """An own index that cannot be used; one line: file, what is wrong, what to do."""


def is_own(name: str) -> bool:
    """Whether a name is that of an own index: file.toml, or file.py:function."""
    return name.lower().endswith(".toml") or ".py:" in name


def filter_in(path: str, signals: tuple[str, ...]) -> tuple[str, Rational, str, str]:
    """Signal, W(s), unit and meaning of a file.

    Raises
    ------
    OwnIndexError
        The file cannot be read, a key is missing or not known, W is not proper or not stable.
    """
    try:
        table = read_toml(Path(path)).get("index")
    except ValueError as error:
        raise OwnIndexError(str(error)) from None
    if not isinstance(table, dict):
        raise OwnIndexError(f"{path}: no table [index]; write signal, numerator, denominator there")
    if extra := set(table) - _KEYS:
        raise OwnIndexError(f"{path}: {min(extra)} is not known: there are {', '.join(_KEYS)}")
    signal = table.get("signal")
    if signal not in signals:
        raise OwnIndexError(f"{path}: signal is {signal!r}: give one of {', '.join(signals)}")
    top, below = (_coefficients(path, key, table.get(key)) for key in ("numerator", "denominator"))
    if len(top) > len(below):
        raise OwnIndexError(f"{path}: the numerator has a higher power of s than the denominator")
    poles = np.roots(below[::-1])
    if len(poles) and poles.real.max() >= 0.0:
        pole = poles[poles.real.argmax()]
        raise OwnIndexError(
            f"{path}: the pole {pole:.4g} is not stable: its real part has to be < 0"
        )
    words = str(table.get("unit", "")), str(table.get("meaning", f"{signal}, weighted"))
    return signal, Rational(top, below), *words


def _coefficients(path: str, key: str, value: Any) -> np.ndarray:
    numbers = value if isinstance(value, list) else []
    good = all(isinstance(x, (int, float)) and math.isfinite(x) for x in numbers)
    if not numbers or not good or not numbers[-1]:
        raise OwnIndexError(
            f"{path}: {key} is {value!r}: give numbers for rising powers of s, the last not 0"
        )
    return np.array(numbers, dtype=np.float64)


@cache
def function_in(name: str, known: tuple[str, ...]) -> tuple[Callable[..., Any], tuple[str, ...]]:
    """The function of file.py:function, and the indices that its arguments name.

    Raises
    ------
    OwnIndexError
        The file cannot be run, has no such function, or an argument is no index.
    """
    path, _, function = name.rpartition(":")
    spec = importlib.util.spec_from_file_location("inerter_own_index", path)
    if spec is None or spec.loader is None or not Path(path).is_file():
        raise OwnIndexError(f"index {name!r}: there is no file {path}")
    module = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except Exception as error:  # whatever a user's file does
        raise OwnIndexError(f"{path}: {type(error).__name__}: {error}") from None
    found = getattr(module, function, None)
    if not callable(found):
        raise OwnIndexError(f"{path}: no function {function!r} in it")
    parts = tuple(inspect.signature(found).parameters)
    for part in parts:
        if part not in known:
            raise OwnIndexError(f"{name}: argument {part!r} is no index: take {', '.join(known)}")
    if not parts:
        raise OwnIndexError(f"{name}: it has no arguments; name indices, as in {function}(J1w, J3)")
    return found, parts


def combined(name: str, function: Callable[..., Any], values: Mapping[str, Any]) -> Any:
    """A function of indices that are arrays of designs, complex where they carry a complex step."""
    every = dict(zip(values, np.broadcast_arrays(*values.values()), strict=True))
    shape = next(iter(every.values())).shape
    complex_step = any(np.iscomplexobj(x) for x in every.values())
    found = np.full(shape, np.inf, dtype=complex if complex_step else float)
    for place in np.ndindex(shape):
        at = {part: x[place] for part, x in every.items()}
        real = {part: float(np.real(x)) for part, x in at.items()}
        if not all(map(math.isfinite, real.values())):
            continue
        value: Any = _called(name, function, real)
        if complex_step:
            for part, slope in slopes(name, function, real).items():
                value = value + 1j * slope * np.imag(at[part])
        found[place] = value
    return found


def slopes(
    name: str, function: Callable[..., Any], values: Mapping[str, float]
) -> dict[str, float]:
    """Derivative of the function in each index, by differences of fourth order."""
    found = {}
    for part, value in values.items():
        h = _STEP ** (2.0 / 3.0) * abs(value) or _STEP
        moved = [
            _called(name, function, {**values, part: value + n * h}) for n in (-2.0, -1.0, 1.0, 2.0)
        ]
        found[part] = (moved[0] - 8.0 * moved[1] + 8.0 * moved[2] - moved[3]) / (12.0 * h)
    return found


def _called(name: str, function: Callable[..., Any], values: Mapping[str, float]) -> float:
    try:
        value = float(function(**values))
    except Exception as error:  # whatever a user's function does
        raise OwnIndexError(f"{name}: {type(error).__name__}: {error}") from None
    if not (math.isfinite(value) and value > 0.0):
        at = ", ".join(f"{part} = {x:.4g}" for part, x in values.items())
        raise OwnIndexError(f"{name} gives {value:g} at {at}: it has to be positive and finite")
    return value
