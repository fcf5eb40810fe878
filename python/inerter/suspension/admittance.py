"""A strut as an admittance, force per velocity: a bicubic beside a spring and an inerter at most.

    [admittance]
    numerator = [25e3, 1500.0, 60.0]     # rising powers of s; SI units
    denominator = [0.0, 1.0]

Y(s) is one of springs, dampers and inerters if and only if it is positive real (Brune 1931, Smith
2002). `ladder` takes what is at s = 0 and without limit off Y and 1/Y in turn, as springs and
inerters, and dampers where what is left stays positive real; of all ways the one with the fewest
elements. S1 to S6 and SR come back so. Not every positive real Y has such a ladder: SW7 and SW8,
two of whose springs share the load at rest, have not, nor where Re Y is least at a frequency
between. Then Y is used as it is: transfer functions ask for nothing else.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inerter.input_file import read_toml
from inerter.suspension.netlist import Element, Netlist, is_positive_real
from inerter.suspension.rational import Rational, shift

Array = NDArray[Any]

DEGREE = 3
_ZERO = 1e-9
_DEEPEST = 12
_LETTERS = {"spring": "k", "damper": "c", "inerter": "b"}


class AdmittanceError(ValueError):
    """An admittance that is no strut; one line."""


@dataclass(frozen=True)
class _Part:
    kind: str
    value: float
    beside: bool


def read_admittance(path: Path) -> Rational:
    """Y(s) of a file.

    Raises
    ------
    AdmittanceError
        The file cannot be read; Y is of a higher degree, not positive real, or carries no load.
    """
    try:
        table = read_toml(path).get("admittance")
    except ValueError as error:
        raise AdmittanceError(str(error)) from None
    if not isinstance(table, dict) or set(table) != {"numerator", "denominator"}:
        raise AdmittanceError(f"{path}: write numerator and denominator under [admittance]")
    top, below = (_numbers(path, key, table[key]) for key in ("numerator", "denominator"))
    admittance = Rational(top, below)
    if not is_positive_real(admittance):
        raise AdmittanceError(
            f"{path}: not positive real: no springs, dampers and inerters have this admittance, it "
            "would have to bring energy"
        )
    if below[0] != 0.0 or top[0] <= 0.0:
        raise AdmittanceError(
            f"{path}: no pole at s = 0: the strut carries no load at rest; the first number of the "
            "denominator has to be 0, that of the numerator above"
        )
    return admittance


def _numbers(path: Path, key: str, value: Any) -> Array:
    numbers = value if isinstance(value, list) else []
    good = all(isinstance(x, (int, float)) and math.isfinite(x) for x in numbers)
    if not good or not any(numbers):
        raise AdmittanceError(f"{path}: {key} is {value!r}: give numbers for rising powers of s")
    found = np.trim_zeros(np.array(numbers, dtype=np.float64), "b")
    if len(found) > DEGREE + 2:
        raise AdmittanceError(f"{path}: {key} has degree {len(found) - 1}, at most {DEGREE + 1}")
    return found


def stiffness_of(admittance: Rational) -> Rational:
    """D(s) = s Y(s)."""
    top, below = admittance.numerator, admittance.denominator
    return Rational(top, below[1:]) if below[0] == 0.0 else Rational(shift(top, 1), below)


def ladder(admittance: Rational) -> Netlist | None:
    """A network that has the admittance, between "body" and "wheel"; None where none is known."""
    top, below = (np.trim_zeros(np.real(p).ravel(), "b") for p in
                  (admittance.numerator, admittance.denominator))  # fmt: skip
    # in a time in which poles and zeros are about 1
    ends = [p[np.flatnonzero(p)[0]] / p[-1] for p in (top, below)]
    orders = [len(p) - 1 - np.flatnonzero(p)[0] for p in (top, below)]
    unit = abs(math.prod(ends)) ** (1.0 / max(sum(orders), 1)) or 1.0
    top, below = top * unit ** np.arange(len(top)), below * unit ** np.arange(len(below))
    parts = _ladder(top, below, 0)
    if parts is None:
        return None
    factors = {"spring": unit, "damper": 1.0, "inerter": 1.0 / unit}
    elements, node, count = [], "body", 0
    for n, part in enumerate(parts):
        inner = part.beside or n == len(parts) - 1
        other = "wheel" if inner else f"n{(count := count + 1)}"
        name = f"{_LETTERS[part.kind]}{n + 1}"
        value = float(part.value * factors[part.kind])
        elements.append(Element(part.kind, name, (node, other), value))
        node = node if inner else other
    found = Netlist(tuple(elements))
    return found if _same(found.stiffness(), stiffness_of(admittance), unit) else None


def _same(one: Rational, other: Rational, unit: float) -> bool:
    s = 1j * unit * np.geomspace(1e-2, 1e2, 41)
    return bool(np.allclose(one(s), other(s), rtol=1e-6))


def _ladder(top: Array, below: Array, depth: int) -> list[_Part] | None:
    """Elements from the body on: beside what follows, or before it in series."""
    top, below = _clean(top), _clean(below)
    while len(top) > 1 and len(below) > 1 and not top[0] and not below[0]:
        top, below = top[1:], below[1:]
    if depth > _DEEPEST:
        return None
    if len(top) == 1 and len(below) == 1:
        return [_Part("damper", top[0] / below[0], True)]
    for taken, beside in ((_ends(top, below), True), (_ends(below, top), False)):
        for kind, value, rest in taken:
            # impedances of spring and inerter are those of the other's admittance
            own = kind if beside else {"spring": "inerter", "inerter": "spring"}[kind]
            part = _Part(own, value if beside else 1.0 / value, beside)
            if not np.any(_clean(rest[0])):
                return [part]
            over, under = rest if beside else rest[::-1]
            follow = _ladder(over, under, depth + 1)
            return None if follow is None else [part, *follow]
    return _resistive(top, below, depth)


def _ends(top: Array, below: Array) -> list[tuple[str, float, tuple[Array, Array]]]:
    """Poles at 0 ("spring") and without limit ("inerter") of top/below, and what is left."""
    if not below[0]:
        value = top[0] / below[1]
        left = _minus(top, value * below[1:])
        return [("spring", value, (left[1:] if len(left) > 1 else left, below[1:]))]
    if len(top) > len(below):
        value = top[-1] / below[-1]
        return [("inerter", value, (_minus(top, value * np.append(0.0, below))[:-1], below))]
    return []


def _resistive(top: Array, below: Array, depth: int) -> list[_Part] | None:
    """A damper beside or before; what is left has to be positive real. The shorter way."""
    ways = []
    for over, under, beside in ((top, below, True), (below, top, False)):
        least = min(over[0] / under[0], over[-1] / under[-1])
        left = _clean(_minus(over, least * under), np.abs(over).max())
        if least <= 0.0 or not is_positive_real(Rational(left, under), 1e-8):
            continue
        rest = (left, under) if beside else (under, left)
        follow = _ladder(rest[0], rest[1], depth + 1)
        if follow is not None:
            ways.append([_Part("damper", least if beside else 1.0 / least, beside), *follow])
    return min(ways, key=len, default=None)


def _minus(one: Array, other: Array) -> Array:
    size = max(len(one), len(other))
    a, b = (np.append(p, np.zeros(size - len(p))) for p in (one, other))
    left = a - b
    return np.asarray(
        np.where(np.abs(left) <= _ZERO * np.maximum(np.abs(a), np.abs(b)), 0.0, left),
        dtype=np.float64,
    )


def _clean(p: Array, size: float | None = None) -> Array:
    largest = np.abs(p).max(initial=0.0) if size is None else size
    kept = np.where(np.abs(p) <= _ZERO * largest, 0.0, p)
    last = np.flatnonzero(kept)
    return kept[: last[-1] + 1] if last.size else kept[:1]
