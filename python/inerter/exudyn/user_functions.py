"""The user functions of the element: its forces and, where it is not constant, its mass matrix.

The coordinates of the object are those of the terminals' nodes, then the states: a state is the
velocity of a coordinate with unit mass, so that every solver of second order integrates it.

    M = B (1 + lambda) J' J (+ 1 for each state),   f = [-J' (forces + M-bias), rates of the states]

On 1D coordinates the forces can be recorded as expressions that Exudyn evaluates in C++.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from inerter.exudyn import device as law
from inerter.exudyn import flywheel, series
from inerter.exudyn.engine import exudyn
from inerter.exudyn.functions import NUMBERS, expressions
from inerter.exudyn.kinematics import Line, Motion, Span
from inerter.exudyn.parameters import Parameters

Kinematics = Callable[[Sequence[float], Sequence[float]], Motion]


@dataclass(frozen=True)
class Element:
    """What the user functions need: the device, its kinematics, whether heat is added up."""

    device: Parameters
    kinematics: Line | Span
    heat: bool = False

    @property
    def states(self) -> int:
        """Number of state coordinates, heat included."""
        return self.device.nstate + self.heat

    @property
    def size(self) -> int:
        """Number of coordinates of the object."""
        return self.kinematics.size + self.states

    @property
    def loaded(self) -> bool:
        """Whether load friction acts on a rigidly driven inertance, and needs accelerations."""
        return bool(self.device.load_friction) and not series.is_there(self.device)

    @property
    def constant_mass(self) -> bool:
        """Whether the mass matrix never changes."""
        rigid = not series.is_there(self.device) and self.device.inertance > 0.0
        if not rigid:
            return True
        straight = isinstance(self.kinematics, Line)
        return straight and not flywheel.varies(self.device) and not self.loaded

    @property
    def recordable(self) -> bool:
        """Whether Exudyn can evaluate the forces by itself."""
        return isinstance(self.kinematics, Line) and not self.loaded


def recalled(kinematics: Line | Span) -> Kinematics:
    """The kinematics with a memory of one: forces and mass matrix are asked at the same point."""
    last: list[Any] = [None, None, None]

    def at(q: Sequence[float], q_t: Sequence[float]) -> Motion:
        if q != last[0] or q_t != last[1]:
            last[:] = q, q_t, kinematics.at(q, q_t)
        return last[2]

    return at


def mass_matrix(element: Element) -> np.ndarray:
    """The mass matrix of a device at rest, shape (size, size); constant where it is constant."""
    matrix = np.zeros((element.size, element.size))
    first = element.kinematics.size
    matrix[range(first, element.size), range(first, element.size)] = 1.0
    if element.constant_mass and isinstance(element.kinematics, Line):
        row = np.array(element.kinematics.row)
        inertance = law.mass(NUMBERS, element.device, 0.0, 0.0)
        matrix[:first, :first] = inertance * np.outer(row, row)
    return matrix


def mass_function(element: Element, at: Kinematics | None = None) -> Callable[..., np.ndarray]:
    """massMatrixUserFunction(mbs, t, itemNumber, q, q_t)."""
    p, first = element.device, element.kinematics.size
    motion_at = at or recalled(element.kinematics)
    matrix = mass_matrix(element)

    def massMatrixUserFunction(  # noqa: N802 - Exudyn's name
        mbs: Any, t: float, itemNumber: int, q: Sequence[float], q_t: Sequence[float]
    ) -> np.ndarray:
        motion = motion_at(q, q_t)
        x, row = motion.length - p.rest_length, np.array(motion.row)
        sign = load_sign(mbs, itemNumber, element, x, motion.rate, motion.bias, motion.row)
        inertance = law.mass(NUMBERS, p, x, motion.rate, sign)
        matrix[:first, :first] = inertance * np.outer(row, row)
        return matrix

    return massMatrixUserFunction


def force_function(element: Element, at: Kinematics | None = None) -> Callable[..., list[float]]:
    """forceUserFunction(mbs, t, itemNumber, q, q_t), on numbers."""
    p, first = element.device, element.kinematics.size
    motion_at = at or recalled(element.kinematics)
    through_mass = not element.constant_mass

    def forceUserFunction(  # noqa: N802 - Exudyn's name
        mbs: Any, t: float, itemNumber: int, q: Sequence[float], q_t: Sequence[float]
    ) -> list[float]:
        motion = motion_at(q, q_t)
        x, v, z = motion.length - p.rest_length, motion.rate, q_t[first:]
        at_terminals = 0.0
        rates = [0.0] * element.states
        for term in law.terms(NUMBERS, p, x, v, z):
            at_terminals += term.terminals * term.value
            for place, share in term.rates:
                rates[place] += share * term.value
        sign = load_sign(mbs, itemNumber, element, x, v, motion.bias, motion.row)
        if through_mass:
            at_terminals += law.mass(NUMBERS, p, x, v, sign) * motion.bias
        if sign:
            at_terminals += law.load_rest(p, x, v, sign)
        if element.heat:
            a = (
                last_acceleration(mbs, itemNumber, motion.row, motion.bias)
                if element.loaded
                else 0.0
            )
            through = law.carried(p, x, v, a, z) if p.load_friction else 0.0
            rates[-1] = law.dissipated_power(NUMBERS, p, x, v, z, through)
        return [-share * at_terminals for share in motion.row] + rates

    return forceUserFunction


def last_acceleration(mbs: Any, itemNumber: int, row: Sequence[float], bias: float) -> float:
    """The latest relative acceleration that the solver knows [m/s^2]."""
    kind = exudyn().OutputVariableType.Coordinates_tt
    # one coordinate alone comes as a number
    found = np.atleast_1d(mbs.GetObjectOutputBody(itemNumber, kind, [0.0, 0.0, 0.0]))
    return float(np.dot(row, found[: len(row)])) + bias


def load_sign(
    mbs: Any,
    itemNumber: int,
    element: Element,
    x: float,
    v: float,
    bias: float,
    row: Sequence[float],
) -> float:
    """Sign of the force N that load friction goes with; 0 if it does not need one.

    N depends on the acceleration that is being solved for; its sign is that of the latest known
    acceleration. Where N changes sign the friction passes 0, so that a sign which is late by a
    step costs no more than a step across the corner of a force.
    """
    if not element.loaded:
        return 0.0
    a = last_acceleration(mbs, itemNumber, row, bias)
    return 1.0 if law.carried(element.device, x, v, a, ()) >= 0.0 else -1.0


def symbolic_force(element: Element, mbs: Any) -> Any:
    """The forces as a symbolic user function, every expression once; 0 if there are none."""
    symbolic = exudyn("symbolic")
    recording = symbolic.GetRecording()
    symbolic.SetRecording(True)
    try:
        arguments, result = _record(element, symbolic)
    finally:
        symbolic.SetRecording(recording)
    if result is None:
        return 0
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


def _record(element: Element, symbolic: Any) -> tuple[list[Any], Any]:
    """Arguments after mbs, and the vector of forces."""
    p, line, first = element.device, element.kinematics, element.kinematics.size
    assert isinstance(line, Line)
    q = symbolic.Vector("q", [0.0] * element.size)
    q_t = symbolic.Vector("q_t", [0.0] * element.size)

    def difference(values: Any) -> Any:
        found = 0.0
        for place, weight in zip(line.places, line.weights, strict=True):
            found = found + weight * values[place] if weight != 1.0 else values[place] + found
        return found

    x = difference(q) - p.rest_length if p.rest_length else difference(q)
    v = difference(q_t)
    z = [q_t[first + i] for i in range(p.nstate)]
    f = expressions()
    recorded = law.terms(f, p, x, v, z)
    if element.heat:
        through = 0.0
        if p.load_friction:
            state = law.states_of(p, z)
            through = series.at(f, p, state.deflection, v - state.speed, state.gap).force
        heat = law.dissipated_power(f, p, x, v, z, through)
        recorded.append(law.Term(heat, 0.0, ((element.states - 1, 1.0),)))

    result = None
    for term in recorded:
        if not isinstance(term.value, symbolic.Real) and term.value == 0.0:
            continue
        weights = np.zeros(element.size)
        weights[:first] = [-term.terminals * share for share in line.row]
        for place, share in term.rates:
            weights[first + place] += share
        value = term.value if isinstance(term.value, symbolic.Real) else symbolic.Real(term.value)
        part = value * symbolic.Vector(weights.tolist())
        result = part if result is None else result + part
    return [symbolic.Real("t", 0.0), symbolic.Real("itemNumber", 0), q, q_t], result
