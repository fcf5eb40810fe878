"""Expressions written down once, evaluated by the package's C library, with their derivatives.

A law or a geometry that is written with the names of `Functions` runs on `Number`s as it runs on
floats: what it works out is recorded, each expression once, and later evaluated at any inputs.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from inerter.exudyn.functions import NUMBERS, Functions
from inerter.exudyn.library import CTape, operations, run, run_slopes

Value: TypeAlias = "Number | float"
Key: TypeAlias = tuple[str, int]
"""Kind (input, constant, step) and number of a value; places follow when the tape is finished."""


class Number:
    """A value on a tape; `affine` where it is linear in the inputs, plus a constant."""

    __slots__ = ("affine", "key", "tape")

    def __init__(self, tape: Tape, key: Key, affine: bool) -> None:
        self.tape, self.key, self.affine = tape, key, affine

    def __add__(self, other: Value) -> Value:
        return self if _is(other, 0.0) else self.tape.record("add", self, other)

    def __radd__(self, other: float) -> Value:
        return self if _is(other, 0.0) else self.tape.record("add", other, self)

    def __sub__(self, other: Value) -> Value:
        return self if _is(other, 0.0) else self.tape.record("subtract", self, other)

    def __rsub__(self, other: float) -> Value:
        return -self if _is(other, 0.0) else self.tape.record("subtract", other, self)

    def __mul__(self, other: Value) -> Value:
        if _is(other, 0.0):
            return 0.0
        return self if _is(other, 1.0) else self.tape.record("multiply", self, other)

    def __rmul__(self, other: float) -> Value:
        if _is(other, 0.0):
            return 0.0
        return self if _is(other, 1.0) else self.tape.record("multiply", other, self)

    def __truediv__(self, other: Value) -> Value:
        return self if _is(other, 1.0) else self.tape.record("divide", self, other)

    def __rtruediv__(self, other: float) -> Value:
        return 0.0 if _is(other, 0.0) else self.tape.record("divide", other, self)

    def __neg__(self) -> Value:
        return self.tape.record("negate", self)

    def __lt__(self, other: Value) -> Value:
        return self.tape.record("less", self, other)

    def __gt__(self, other: Value) -> Value:
        return self.tape.record("less", other, self)

    def __le__(self, other: Value) -> Value:
        return self.tape.record("not_above", self, other)

    def __ge__(self, other: Value) -> Value:
        return self.tape.record("not_above", other, self)

    def __bool__(self) -> bool:
        raise TypeError("a recorded number is neither true nor false; use Functions.choose")


class Tape:
    """What is recorded over some inputs; `functions` are the elementary functions on its numbers.

    Parameters
    ----------
    inputs
        How many; `Tape.inputs` are they, as numbers to compute with.
    """

    def __init__(self, inputs: int) -> None:
        self.inputs = [Number(self, ("input", place), True) for place in range(inputs)]
        self._steps: dict[tuple[Any, ...], Number] = {}
        self._negated: dict[Key, Value] = {}
        self._constants: dict[float, int] = {}
        names = Functions.__dataclass_fields__
        self.functions = Functions(**{name: self._function(name) for name in names})

    def record(self, name: str, *operands: Value) -> Value:
        """Record an operation, or find it where it is recorded already.

        Signs stand outside of products, so that a product and its negative are worked out once.
        """
        if name == "multiply":
            (one, minus_one), (other, minus_other) = map(self._without_sign, operands)
            if _is(one, 1.0) or _is(other, 1.0):
                product = other if _is(one, 1.0) else one
            else:
                product = self._found(name, *sorted((one, other), key=self.key))
            return product if minus_one == minus_other else self._found("negate", product)
        if name == "negate":
            inside, signed = self._without_sign(operands[0])
            return inside if signed else self._found(name, inside)
        return self._found(name, *operands)

    def _found(self, name: str, *operands: Value) -> Number:
        recorded = (name, *(self.key(operand) for operand in operands))
        if recorded not in self._steps:
            key = ("step", len(self._steps))
            self._steps[recorded] = Number(self, key, _affine(name, operands))
            if name == "negate":
                self._negated[key] = operands[0]
        return self._steps[recorded]

    def _without_sign(self, value: Value) -> tuple[Value, bool]:
        """A value, or what it is the negative of; whether it is one."""
        if isinstance(value, Number):
            inside = self._negated.get(value.key)
            return (value, False) if inside is None else (inside, True)
        return abs(value), value < 0.0

    def key(self, value: Value) -> Key:
        """The key of a number, or of a constant."""
        if isinstance(value, Number):
            return value.key
        return "constant", self._constants.setdefault(float(value), len(self._constants))

    def definition(self, key: Key) -> tuple[str, Sequence[Any]]:
        """Operation and keys of its operands; "constant" and its value, "input" and its number."""
        kind, number = key
        if kind == "step":
            name, *operands = list(self._steps)[number]
            return name, operands
        return kind, [list(self._constants)[number] if kind == "constant" else number]

    def finish(self, sloped: Sequence[Key] | None = None) -> Finished:
        """What is recorded up to now, in the library's form.

        `sloped` are those whose derivatives are wanted; None, all.
        """
        return Finished(len(self.inputs), list(self._constants), list(self._steps), sloped)

    def _function(self, name: str) -> Callable[..., Value]:
        plain = getattr(NUMBERS, name)

        def function(*operands: Value) -> Value:
            if any(isinstance(operand, Number) for operand in operands):
                return self.record(name, *operands)
            return plain(*operands)

        return function


class Finished:
    """A tape as the library reads it, with room for its values and their derivatives.

    Steps are put in an order in which the same operations follow each other: the library is quick
    with these.
    """

    def __init__(
        self,
        inputs: int,
        constants: list[float],
        steps: list[Any],
        sloped: Sequence[Key] | None = None,
    ) -> None:
        order = _by_operation(steps)
        rank = dict(zip(order, range(len(order)), strict=True))
        self._first = {"input": 0, "constant": inputs, "step": inputs + len(constants)}
        self._rank = [rank[number] for number in range(len(steps))]
        rows, numbers = inputs + len(constants) + len(steps), operations()
        self.steps = np.zeros((len(steps), 4), dtype=np.int32)
        self._steps = steps
        wanted = self.beneath(sloped) if sloped is not None else None
        spans = np.zeros((rows, 2), dtype=np.int32)
        spans[:inputs] = [(place, place + 1) for place in range(inputs)]
        for row, number in zip(self.steps, order, strict=True):
            name, *operands = steps[number]
            places = [self.place(key) for key in operands]
            row[: 1 + len(places)] = numbers[name], *places
            if wanted is None or ("step", number) in wanted:
                spans[self.place(("step", number))] = _span(name, spans[places])
        self.spans = spans[inputs + len(constants) :].copy()
        self.values = np.zeros(rows)
        self.values[inputs : inputs + len(constants)] = constants
        self.slopes = np.zeros((rows, max(1, inputs)))
        self.slopes[range(inputs), range(inputs)] = 1.0
        arrays = (self.steps, self.spans, self.values, self.slopes)
        self.c = CTape(inputs, len(constants), len(steps), *(each.ctypes.data for each in arrays))
        self._reference = ctypes.byref(self.c)

    def place(self, key: Key) -> int:
        """Where a value lies among `values`."""
        kind, number = key
        return self._first[kind] + (self._rank[number] if kind == "step" else number)

    def beneath(self, keys: Sequence[Key]) -> set[Key]:
        """The keys of all that some are worked out from, and of these themselves."""
        found: set[Key] = set()
        waiting = list(keys)
        while waiting:
            key = waiting.pop()
            if key not in found:
                found.add(key)
                waiting += self._steps[key[1]][1:] if key[0] == "step" else ()
        return found

    def run(self, inputs: Sequence[float]) -> NDArray[np.float64]:
        """All values at some inputs; the array is this object's own."""
        self.values[: len(inputs)] = inputs
        return self.rerun()

    def rerun(self) -> NDArray[np.float64]:
        """All values at the inputs that stand in `values`."""
        run(self._reference)
        return self.values

    def run_slopes(self) -> NDArray[np.float64]:
        """Derivatives of all values by the inputs where `run` was last, shape (values, inputs)."""
        run_slopes(self._reference)
        return self.slopes


FLAT = ("sign", "round", "less", "not_above")
"""Operations without a slope."""


def _by_operation(steps: list[Any]) -> list[int]:
    """The numbers of the steps, each after its operands, in few rows of the same operation."""
    operands = [[number for kind, number in step[1:] if kind == "step"] for step in steps]
    waiting = [len(each) for each in operands]
    users: list[list[int]] = [[] for _ in steps]
    for number, each in enumerate(operands):
        for operand in each:
            users[operand].append(number)
    ready: dict[str, list[int]] = {}
    for number, (name, *_) in enumerate(steps):
        if not waiting[number]:
            ready.setdefault(name, []).append(number)
    order: list[int] = []
    while ready:
        row = ready[max(ready, key=lambda name: len(ready[name]))]
        name = steps[row[0]][0]
        # what a step makes ready may join the row
        for number in row:
            order.append(number)
            for user in users[number]:
                waiting[user] -= 1
                if not waiting[user]:
                    ready.setdefault(steps[user][0], []).append(user)
        del ready[name]
    return order


def _span(name: str, spans: NDArray[np.int32]) -> tuple[int, int]:
    """First and end of the inputs that a step depends on, from those of its operands."""
    if name in FLAT:
        return 0, 0
    taken = spans[1:] if name == "choose" else spans
    there = taken[taken[:, 0] < taken[:, 1]]
    return (int(there[:, 0].min()), int(there[:, 1].max())) if len(there) else (0, 0)


def _is(value: Value, number: float) -> bool:
    return not isinstance(value, Number) and value == number


def _affine(name: str, operands: Sequence[Value]) -> bool:
    """Whether a step is a linear function of the inputs plus a constant."""
    linear = [not isinstance(each, Number) or each.affine for each in operands]
    if name in ("add", "subtract", "negate"):
        return all(linear)
    if name == "multiply":
        return all(linear) and any(not isinstance(each, Number) for each in operands)
    return name == "divide" and linear[0] and not isinstance(operands[1], Number)
