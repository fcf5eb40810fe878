"""The element's user functions: matrices where it is linear, else what Exudyn calls.

On 1D coordinates linear terms stand in constant matrices, and the others are recorded as
expressions that Exudyn evaluates in C++. Elsewhere the package's C library evaluates a tape, in
built-in functions that Exudyn calls without running any Python.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inerter.exudyn import control
from inerter.exudyn import device as law
from inerter.exudyn.element import HEAT, Element
from inerter.exudyn.engine import exudyn
from inerter.exudyn.functions import Functions, Value, expressions
from inerter.exudyn.kinematics import SHORTEST, Line, Span
from inerter.exudyn.library import CElement, built_in, listed
from inerter.exudyn.tape import Number, Tape

Matrix = NDArray[np.float64]


MOST_SYMBOLIC = 7
"""Up to this size Exudyn's symbolic vectors hold; of eight elements they end the process (1.13)."""


class UserFunctions:
    """Matrices and user functions of an element; `name` is for its errors.

    Attributes
    ----------
    parameters
        Those of an ObjectGenericODE2, by name.
    """

    def __init__(self, mbs: Any, element: Element, name: str, symbolic: bool) -> None:
        self._symbolic = symbolic
        only_matrices = symbolic and element.constant_mass
        self._compiled = None if only_matrices else Compiled(element, name)
        self.parameters = self._made_of(mbs, element)

    def take(self, mbs: Any, objectNumber: Any, element: Element) -> None:
        """Let the object be this element from now on; it has the same coordinates."""
        if self._compiled is not None:
            self._compiled.take(element)
        before, self.parameters = self.parameters, self._made_of(mbs, element)
        for key, value in self.parameters.items():
            same = value is before[key] or (
                isinstance(value, np.ndarray) and np.array_equal(value, before[key])
            )
            if not same:
                mbs.SetObjectParameter(objectNumber, key, value)

    def _made_of(self, mbs: Any, element: Element) -> dict[str, Any]:
        found: dict[str, Any] = {"massMatrix": element.mass_matrix()}
        compiled, hold = self._compiled, element.hold_matrix()
        if compiled is not None and not element.constant_mass:
            found["massMatrixUserFunction"] = compiled.mass
        if compiled is not None and not self._symbolic:
            return found | {
                "stiffnessMatrix": hold,
                "forceUserFunction": compiled.force,
                "jacobianUserFunction": compiled.jacobian,
            }
        linear, rest = _split(element)
        return found | {
            "stiffnessMatrix": hold + linear.stiffness,
            "dampingMatrix": linear.damping,
            "forceVector": linear.force,
            "forceUserFunction": _symbolic(element, mbs, rest),
        }


class Compiled:
    """The built-in functions `force`, `mass` and `jacobian` of an element.

    Others hold these functions, so that `take` changes what they evaluate.
    """

    def __init__(self, element: Element, name: str) -> None:
        self._c = CElement()
        self._message = (
            f'inerter "{name}": its terminals are less than {SHORTEST:g} m apart, which leaves it '
            "without a direction; put them apart, or use 1D coordinates"
        ).encode()
        # what the built-in functions point to lives as long as they do
        self._kept: list[Any] = []
        self.take(element)
        made = [built_in(each, self._c, self._kept) for each in ("force", "mass", "jacobian")]
        self.force, self.mass, self.jacobian = made

    def take(self, element: Element) -> None:
        """Evaluate this element from now on; it has the same coordinates."""
        tape, recorded = _taped(element)
        forces = [tape.key(each) for each in recorded.forces]
        row = recorded.motion.row
        scaled = [recorded.inertance * each for each in row]
        # the triangle, so that what is symmetric is one expression
        products = [
            [tape.key(scaled[max(i, k)] * row[min(i, k)]) for k in range(len(row))]
            for i in range(len(row))
        ]
        every = dict.fromkeys(key for each in products for key in each)
        numbers = {key: i for i, key in enumerate(every)}
        length = tape.key(recorded.motion.length)
        finished = tape.finish(sloped=forces)
        size = element.size
        mass, jacobian = element.mass_matrix(), np.zeros((size, size))
        places = np.array([finished.place(key) for key in (*forces, *numbers)], dtype=np.int32)
        entries = np.array([[numbers[key] for key in each] for each in products], dtype=np.int32)
        c, address = self._c, places.ctypes.data
        c.tape, c.size, c.nrow = finished.c, size, len(row)
        c.loaded, c.known = element.loaded, 0
        c.forces, c.distinct = address, address + len(forces) * places.itemsize
        c.ndistinct, c.entries = len(numbers), entries.ctypes.data
        c.length = finished.place(length) if isinstance(element.kinematics, Span) else -1
        c.shortest, c.message = SHORTEST, self._message
        c.mass, c.jacobian = mass.ctypes.data, jacobian.ctypes.data
        c.mass_array, c.jacobian_array, c.none = mass, jacobian, None
        small = size <= listed()
        c.mass_list = mass.tolist() if small else None
        c.jacobian_list = jacobian.tolist() if small else None
        c.reader, c.error = latest_accelerations, ValueError
        self._kept[:] = [finished, places, entries, mass, jacobian]


def latest_accelerations(mbs: Any, t: float, itemNumber: int, *others: Any) -> list[float]:
    """The latest accelerations that the solver knows, shape (size,); arguments of any of them."""
    kind = exudyn().OutputVariableType.Coordinates_tt
    # one coordinate alone comes as a number
    found = np.atleast_1d(mbs.GetObjectOutputBody(itemNumber, kind, [0.0, 0.0, 0.0]))
    return found.tolist()


def _taped(element: Element) -> tuple[Tape, Any]:
    n = element.size
    tape = Tape((3 if element.loaded else 2) * n)
    q, q_t, q_tt = (tape.inputs[i * n : (i + 1) * n] for i in range(3))
    return tape, element.record(tape.functions, q, q_t, q_tt)


@dataclass(frozen=True)
class Linear:
    """Constant part of an element: f = force - stiffness q - damping q'."""

    stiffness: Matrix
    damping: Matrix
    force: Matrix


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


def _split(element: Element) -> tuple[Linear, list[bool]]:
    """The linear part in matrices, and which of `_parts` are not in it."""
    n = element.size
    tape = Tape(2 * n)
    parts = _parts(element, tape.functions, tape.inputs[:n], tape.inputs[n:])
    rest = [isinstance(value, Number) and not value.affine for value, _ in parts]
    keys = [tape.key(0.0 if left else value) for (value, _), left in zip(parts, rest, strict=True)]
    finished = tape.finish()
    constant = finished.run([0.0] * (2 * n))
    finished.run_slopes()
    slopes = np.zeros((n, 2 * n))
    force = np.zeros(n)
    for key, (_, weights) in zip(keys, parts, strict=True):
        place = finished.place(key)
        force += weights * constant[place]
        slopes += np.outer(weights, finished.slopes[place, : 2 * n])
    return Linear(-slopes[:, :n], -slopes[:, n:], force), rest


def _symbolic(element: Element, mbs: Any, rest: Sequence[bool]) -> Any:
    """What is not linear as a symbolic user function, every expression once; 0 if there is none."""
    if not any(rest):
        return 0
    symbolic = exudyn("symbolic")
    recording = symbolic.GetRecording()
    symbolic.SetRecording(True)
    try:
        q = symbolic.Vector("q", [0.0] * element.size)
        q_t = symbolic.Vector("q_t", [0.0] * element.size)
        result: Value = None
        for (value, weights), left in zip(
            _parts(element, expressions(), q, q_t), rest, strict=True
        ):
            if left:
                part = value * symbolic.Vector(weights.tolist())
                result = part if result is None else result + part
        arguments = [symbolic.Real("t", 0.0), symbolic.Real("itemNumber", 0), q, q_t]
    finally:
        symbolic.SetRecording(recording)
    function = symbolic.UserFunction()
    contents = {
        "functionName": "forceUserFunction",
        # Exudyn never reads the system here; naming it would keep it alive for ever
        "argList": [None, *arguments],
        "argTypeList": ["MainSystem", "Real", "Index", "StdVector", "StdVector"],
        "returnValue": result,
        "returnType": "StdVector",
    }
    function.SetUserFunctionFromDict(mbs, contents, "forceUserFunction", None, "ObjectGenericODE2")
    return function
