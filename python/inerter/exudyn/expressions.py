"""A device on 1D coordinates as constant matrices and expressions that Exudyn evaluates in C++."""

from __future__ import annotations

import operator
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from inerter.exudyn import control
from inerter.exudyn import device as law
from inerter.exudyn.element import HEAT, Element
from inerter.exudyn.engine import exudyn
from inerter.exudyn.functions import Functions, Value, expressions
from inerter.exudyn.kinematics import Line
from inerter.exudyn.tape import Key, Number, Tape

Matrix = NDArray[np.float64]


@dataclass(frozen=True)
class Linear:
    """Constant part of an element: f = force - stiffness q - damping q'."""

    stiffness: Matrix
    damping: Matrix
    force: Matrix


class Rest(NamedTuple):
    """What is not linear: recorded values, each with its factors on all coordinates."""

    tape: Tape
    terms: list[tuple[Number, Matrix]]


def _parts(element: Element, f: Functions, q: Any, q_t: Any) -> list[tuple[Any, Matrix]]:
    """Every expression of an element on a line, with its factors on all coordinates."""
    p, line = element.device, element.kinematics
    assert isinstance(line, Line)
    x, v = line.difference(q) - p.rest_length, line.difference(q_t)
    z = element.states(x, q, q_t)
    p = control.present(f, p, z)
    found = []
    for term in law.terms(f, p, x, v, z):
        weights = np.zeros(element.size)
        weights[: element.first] = [-term.terminals * share for share in line.row]
        for place, share in element.own_shares(term):
            weights[place] += share
        found.append((term.value, weights))
    if element.heat:
        # with load friction only behind a series element: it asks for no acceleration there
        through = law.carried(f, p, x, v, 0.0, z) if law.rubs_by_load(p) else 0.0
        weights = np.zeros(element.size)
        weights[element.first + element.own.index(HEAT)] = 1.0
        found.append((law.dissipated_power(f, p, x, v, z, through), weights))
    return found


def split(element: Element) -> tuple[Linear, Rest]:
    """The linear part in matrices, and the rest."""
    n = element.size
    tape = Tape(2 * n)
    parts = _parts(element, tape.functions, tape.inputs[:n], tape.inputs[n:])
    terms = [
        (value, weights)
        for value, weights in parts
        if isinstance(value, Number) and not value.affine
    ]
    left = {id(value) for value, _ in terms}
    keys = [tape.key(0.0 if id(value) in left else value) for value, _ in parts]
    finished = tape.finish()
    constant = finished.run([0.0] * (2 * n))
    finished.run_slopes()
    slopes = np.zeros((n, 2 * n))
    force = np.zeros(n)
    for key, (_, weights) in zip(keys, parts, strict=True):
        place = finished.place(key)
        force += weights * constant[place]
        slopes += np.outer(weights, finished.slopes[place, : 2 * n])
    return Linear(-slopes[:, :n], -slopes[:, n:], force), Rest(tape, terms)


def vector_function(mbs: Any, size: int, rest: Rest) -> Any:
    """A symbolic forceUserFunction of an ObjectGenericODE2; 0 if nothing is left for it."""
    if not rest.terms:
        return 0

    def made(symbolic: Any) -> tuple[list[Any], Value]:
        q = symbolic.Vector("q", [0.0] * size)
        q_t = symbolic.Vector("q_t", [0.0] * size)
        recorded = Expressions(
            rest.tape, lambda place: q[place] if place < size else q_t[place - size]
        )
        result: Value = None
        for value, weights in rest.terms:
            part = recorded.of(value.key) * symbolic.Vector(weights.tolist())
            result = part if result is None else result + part
        return [q, q_t], result

    return symbolic_function(mbs, "ObjectGenericODE2", "forceUserFunction", "StdVector", made)


def symbolic_function(
    mbs: Any, item: str, name: str, kind: str, made: Callable[[Any], tuple[list[Any], Value]]
) -> Any:
    """A user function (mbs, t, itemNumber, ...) of further arguments and a value of a kind."""
    symbolic = exudyn("symbolic")
    recording = symbolic.GetRecording()
    symbolic.SetRecording(True)
    try:
        arguments, result = made(symbolic)
        arguments = [symbolic.Real("t", 0.0), symbolic.Real("itemNumber", 0), *arguments]
    finally:
        symbolic.SetRecording(recording)
    function = symbolic.UserFunction()
    contents = {
        "functionName": name,
        # Exudyn never reads the system here; naming it would keep it alive for ever
        "argList": [None, *arguments],
        "argTypeList": ["MainSystem", "Real", "Index", *[kind] * (len(arguments) - 2)],
        "returnValue": result,
        "returnType": kind,
    }
    function.SetUserFunctionFromDict(mbs, contents, name, None, item)
    return function


class Expressions:
    """What stands on a tape as expressions of Exudyn, without what it has folded.

    `leaf` gives the expression of an input.
    """

    def __init__(self, tape: Tape, leaf: Callable[[int], Value]) -> None:
        self._tape, self._leaf, self._functions = tape, leaf, expressions()
        self._found: dict[Key, Value] = {}

    def of(self, key: Key) -> Value:
        """The expression of a value."""
        if key not in self._found:
            self._found[key] = self._made(*self._tape.definition(key))
        return self._found[key]

    def _made(self, name: str, operands: Sequence[Any]) -> Value:
        if name == "constant":
            return exudyn("symbolic").Real(operands[0])
        if name == "input":
            return self._leaf(operands[0])
        values = [self.of(key) for key in operands]
        if name in OPERATORS:
            return OPERATORS[name](*values)
        return getattr(self._functions, name)(*values)


OPERATORS: dict[str, Callable[..., Value]] = {
    "add": operator.add,
    "subtract": operator.sub,
    "multiply": operator.mul,
    "divide": operator.truediv,
    "negate": operator.neg,
    "less": operator.lt,
    "not_above": operator.le,
}
"""The operations of a tape that are no `Functions`."""
