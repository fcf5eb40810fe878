"""The memoryless laws of a device on 1D coordinates, in one of Exudyn's own connectors.

A CoordinateSpringDamper hands numbers to its user function, an ObjectGenericODE2 hands it vectors,
which takes Exudyn 0.1 us instead of 0.4.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from inerter.exudyn import control
from inerter.exudyn import device as law
from inerter.exudyn.element import Element
from inerter.exudyn.engine import exudyn, version
from inerter.exudyn.expressions import Expressions, symbolic_function
from inerter.exudyn.functions import Value
from inerter.exudyn.kinematics import Line
from inerter.exudyn.tape import Number, Tape

ARGUMENTS = ("displacement", "velocity", "stiffness", "damping", "offset")


OLDEST = (1, 13)
"""Exudyn 1.11 takes no expressions for this connector."""


def fits(element: Element) -> bool:
    """Whether what is not linear follows from the difference of the terminals and its rate."""
    straight = isinstance(element.kinematics, Line) and not element.own
    return straight and version(exudyn()) >= OLDEST


def spring_force(mbs: Any, element: Element) -> Any:
    """The springForceUserFunction for what is not linear; 0 if there is nothing."""
    tape = Tape(2)
    u, v = tape.inputs
    p = control.present(tape.functions, element.device, [])
    total: Value = 0.0
    for term in law.terms(tape.functions, p, u - p.rest_length, v, []):
        if isinstance(term.value, Number) and not term.value.affine:
            total = total + term.terminals * term.value
    if not isinstance(total, Number):
        return 0

    def made(symbolic: Any) -> tuple[list[Any], Value]:
        arguments = [symbolic.Real(name, 0.0) for name in ARGUMENTS]
        return arguments, Expressions(tape, arguments.__getitem__).of(total.key)

    item = "ObjectConnectorCoordinateSpringDamper"
    return symbolic_function(mbs, item, "springForceUserFunction", "Real", made)


def add(mbs: Any, name: str, element: Element, nodes: Sequence[Any], function: Any) -> Any:
    """Add the connector between the coordinates of the terminals, and return its ObjectIndex."""
    items = exudyn("itemInterface")
    line = element.kinematics
    assert isinstance(line, Line)
    owners: list[tuple[Any, int]] = []
    for node in nodes:
        count = len(mbs.GetNode(node)["referenceCoordinates"])
        owners += [(node, coordinate) for coordinate in range(count)]
    ends = {weight: owners[place] for place, weight in zip(line.places, line.weights, strict=True)}
    markers = []
    for i, weight in enumerate((-1.0, 1.0)):
        node, coordinate = ends.get(weight, (None, 0))
        if node is None:
            node = mbs.AddNode(items.NodePointGround(name=f"{name}_ground"))
        marker = items.MarkerNodeCoordinate(
            name=f"{name}_{i}", nodeNumber=node, coordinate=coordinate
        )
        markers.append(mbs.AddMarker(marker))
    return mbs.AddObject(
        items.CoordinateSpringDamper(
            name=f"{name}_law",
            markerNumbers=markers,
            springForceUserFunction=function,
            visualization=items.VCoordinateSpringDamper(show=False),
        )
    )
