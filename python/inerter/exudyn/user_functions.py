"""The element's user functions: matrices where it is linear, else what Exudyn calls.

On 1D coordinates linear terms stand in constant matrices, and the others are recorded as
expressions that Exudyn evaluates in C++. Elsewhere the package's C library evaluates a tape, in
built-in functions that Exudyn calls without running any Python.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inerter.exudyn import connector
from inerter.exudyn.element import Element
from inerter.exudyn.engine import exudyn
from inerter.exudyn.expressions import split, vector_function
from inerter.exudyn.kinematics import SHORTEST, Span
from inerter.exudyn.library import CElement, built_in, listed
from inerter.exudyn.tape import Tape

MOST_SYMBOLIC = 7
"""Up to this size Exudyn's symbolic vectors hold; of eight elements they end the process (1.13)."""


class UserFunctions:
    """Matrices and user functions of an element; `name` is for its errors.

    Attributes
    ----------
    parameters
        Those of an ObjectGenericODE2, by name.
    spring_force
        The user function of the connector that has what is not linear, if there is one; else None.
    connector
        Its number, once it is added.
    """

    def __init__(self, mbs: Any, element: Element, name: str, symbolic: bool) -> None:
        self._symbolic = symbolic
        only_matrices = symbolic and element.constant_mass
        self._compiled = None if only_matrices else Compiled(element, name)
        self.spring_force, self.connector = None, None
        if symbolic and connector.fits(element):
            # 0 if there is nothing for it to do
            self.spring_force = connector.spring_force(mbs, element) or None
        self.parameters = self._made_of(mbs, element)

    def add_connector(self, mbs: Any, name: str, element: Element, nodes: Sequence[Any]) -> None:
        """Add the connector, if there is to be one."""
        if self.spring_force is not None:
            self.connector = connector.add(mbs, name, element, nodes, self.spring_force)

    def take(self, mbs: Any, objectNumber: Any, element: Element) -> None:
        """Let the object be this element from now on; it has the same coordinates."""
        if self._compiled is not None:
            self._compiled.take(element)
        if self.connector is not None:
            self.spring_force = connector.spring_force(mbs, element)
            mbs.SetObjectParameter(self.connector, "springForceUserFunction", self.spring_force)
        before, self.parameters = self.parameters, self._made_of(mbs, element)
        for key, value in self.parameters.items():
            same = value is before[key] or (
                isinstance(value, np.ndarray | list) and np.array_equal(value, before[key])
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
                "stiffnessMatrix": _unless_zero(hold),
                "forceUserFunction": compiled.force,
                "jacobianUserFunction": compiled.jacobian,
            }
        linear, rest = split(element)
        alone = self.spring_force is None
        return found | {
            "stiffnessMatrix": _unless_zero(hold + linear.stiffness),
            "dampingMatrix": _unless_zero(linear.damping),
            "forceVector": _unless_zero(linear.force),
            "forceUserFunction": vector_function(mbs, element.size, rest) if alone else 0,
        }


def _unless_zero(array: NDArray[np.float64]) -> NDArray[np.float64] | list[float]:
    """An array, or what stands for none: Exudyn would multiply with every 0."""
    return array if array.any() else []


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
