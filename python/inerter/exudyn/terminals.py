"""From the items that a user names to nodes and the kinematics between them.

An item is a body (ObjectIndex), a node (NodeIndex), a marker (MarkerIndex) or None, the ground.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from inerter.exudyn.engine import exudyn
from inerter.exudyn.functions import NUMBERS
from inerter.exudyn.kinematics import (
    UNITS,
    Frame,
    Line,
    Matrix,
    Point,
    Span,
    Twist,
    Vector,
    apply,
    cross,
    dot,
    euler_parameters,
    plane_rotation,
    rotation_vector,
    scale,
    tait_bryan,
)

NO_ROTATION: dict[str, tuple[int, Any]] = {
    "Point": (3, None), "Point2D": (2, None), "Point2DSlope1": (2, None),
    "PointSlope1": (3, None), "PointSlope12": (3, None), "PointSlope23": (3, None),
}  # fmt: skip
WITH_ROTATION: dict[str, tuple[int, Any]] = {
    "RigidBody2D": (2, plane_rotation),
    "RigidBodyEP": (3, euler_parameters),
    "RigidBodyRxyz": (3, tait_bryan),
    "RigidBodyRotVecLG": (3, rotation_vector),
}
POINT_NODES = NO_ROTATION | WITH_ROTATION
"""Nodes of points and bodies: number of translations, rotation."""

BODIES = ("MassPoint", "MassPoint2D", "RigidBody", "RigidBody2D")


@dataclass(frozen=True)
class Place:
    """Where a terminal is: a coordinate of a node, a point on a node, or on the ground.

    `node` is None on the ground, `coordinate` is None for a point; `turns` is the axis about which
    a rotation coordinate turns.
    """

    node: Any = None
    coordinate: int | None = None
    local: tuple[float, float, float] = (0.0, 0.0, 0.0)
    turns: int | None = None


@dataclass(frozen=True)
class Terminals:
    """What a user names: items, local positions, for torsion an axis and whose frame it is in."""

    items: tuple[Any, ...]
    local: tuple[ArrayLike, ...]
    axis: ArrayLike | None = None
    useGlobalFrame: bool = True  # noqa: N815 - Exudyn's name


def terminals(mbs: Any, given: Terminals) -> tuple[list[Any], Line | Span | Twist]:
    """The nodes, each once, and the kinematics over their coordinates in this order.

    Raises
    ------
    ValueError
        Items that cannot carry a terminal, or do not fit together; the message says why.
    """
    places = [
        _place(mbs, item, _vector(point, f"localPosition{i}"))
        for i, (item, point) in enumerate(zip(given.items, given.local, strict=True))
    ]
    if all(place.node is None for place in places):
        forgotten = " (itemNumbers=[...] was perhaps forgotten)"
        named = any(item is not None for item in given.items)
        raise ValueError(
            "itemNumbers: both are the ground; give at least one body or node"
            + ("" if named else forgotten)
        )
    nodes: list[Any] = []
    starts: dict[int, int] = {}
    size = 0
    for place in places:
        if place.node is not None and int(place.node) not in starts:
            starts[int(place.node)] = size
            nodes.append(place.node)
            size += len(mbs.GetNode(place.node)["referenceCoordinates"])
    turning = [place.turns is not None for place in places if place.node is not None]
    if given.axis is not None or any(turning):
        return nodes, _twist(mbs, given, places, starts, size)
    straight = [place.coordinate is not None for place in places if place.node is not None]
    if any(straight) != all(straight):
        raise ValueError(
            "itemNumbers: one terminal is a coordinate, the other a point on a body; give two "
            "coordinates (Node1D, MarkerNodeCoordinate) or two points"
        )
    if any(straight):
        for item, place in zip(given.items, places, strict=True):
            if place.node is None and any(place.local):
                raise ValueError(
                    f"itemNumbers: {item!r} is a point of the ground at {list(place.local)}, the "
                    "other terminal a coordinate, which knows no places; give None for the ground, "
                    "and the distance as rest_length"
                )
        return nodes, _line(mbs, places, starts, size)
    return nodes, Span(size, *(_point(mbs, place, starts) for place in places))


def check(mbs: Any, given: Terminals, left_out: Sequence[bool]) -> None:
    """Raise what `terminals` would raise of the items that are not left out."""
    for i, (item, point, out) in enumerate(zip(given.items, given.local, left_out, strict=True)):
        if not out:
            _place(mbs, item, _vector(point, f"localPosition{i}"))


def _twist(
    mbs: Any, given: Terminals, places: list[Place], starts: dict[int, int], size: int
) -> Twist:
    """The angle between two bodies about an axis."""
    frames = [_frame(mbs, place, starts) for place in places]
    turns = {place.turns for place in places if place.turns is not None}
    if given.axis is None:
        if len(turns) != 1 or any(
            place.turns is None and place.node is not None for place in places
        ):
            raise ValueError(
                "itemNumbers: rotation coordinates about different axes, or one rotation and one "
                "other terminal; give two MarkerNodeRotationCoordinate of one rotationCoordinate, "
                "or two rigid bodies and axis=[x, y, z]"
            )
        axis, fixed = UNITS[turns.pop()], True
    else:
        told = _vector(given.axis, "axis")
        length = math.sqrt(dot(told, told))
        if not length:
            raise ValueError(f"axis: {list(told)} has no direction; give a vector, as [0, 0, 1]")
        axis, fixed = scale(told, 1.0 / length), False
    matrices = [_reference_rotation(frame) for frame in frames]
    if not fixed and given.useGlobalFrame:
        axis = _back(matrices[0], axis)
    line = axis if fixed else apply(matrices[0], axis)
    least = min(range(3), key=lambda k: abs(line[k]))
    across = cross(line, UNITS[least])
    across = scale(across, 1.0 / math.sqrt(dot(across, across)))
    first, second = (
        replace(frame, across=_back(matrix, across))
        for frame, matrix in zip(frames, matrices, strict=True)
    )
    return Twist(size, first, second, axis, fixed)


def _frame(mbs: Any, place: Place, starts: dict[int, int]) -> Frame:
    if place.node is None:
        return Frame()
    node = mbs.GetNode(place.node)
    if node["nodeType"] not in WITH_ROTATION:
        names = ", ".join(f"Node{name}" for name in WITH_ROTATION)
        raise ValueError(
            f"itemNumbers: a Node{node['nodeType']} does not turn in space; with an axis an "
            f"inerter takes rigid bodies ({names}) and the ground; leave the axis out on 1D "
            "coordinates"
        )
    moves, rotation = WITH_ROTATION[node["nodeType"]]
    reference = tuple(float(value) for value in node["referenceCoordinates"])
    return Frame(starts[int(place.node)], reference, moves, rotation)


def _reference_rotation(frame: Frame) -> Matrix:
    nothing = [0.0] * (frame.start + len(frame.reference))
    return frame.at(NUMBERS, nothing, nothing)[0].matrix


def _back(matrix: Matrix, vector: Vector) -> Vector:
    """The transposed matrix times vector."""
    rows = tuple(zip(*matrix, strict=True))
    return apply(rows, vector)  # pyright: ignore[reportArgumentType]


def _vector(point: ArrayLike, what: str) -> tuple[float, float, float]:
    try:
        found = np.asarray(point, dtype=float)
    except (TypeError, ValueError):
        found = np.empty(0)
    if found.shape != (3,) or not np.all(np.isfinite(found)):
        raise ValueError(f"{what}: {point!r} is not three finite numbers")
    return tuple(float(value) for value in found)  # pyright: ignore[reportReturnType]


def _place(mbs: Any, item: Any, local: tuple[float, float, float]) -> Place:
    """The place that an item means."""
    engine = exudyn()
    if item is None:
        return Place(local=local)
    if isinstance(item, engine.MarkerIndex):
        if any(local):
            raise ValueError(
                f"localPosition: {list(local)} beside marker {int(item)}, which has a place of its "
                "own; give the point to the marker, or name its body"
            )
        return _marker_place(mbs, item)
    if isinstance(item, engine.NodeIndex):
        return _node_place(mbs, item, local)
    if isinstance(item, engine.ObjectIndex):
        return _body_place(mbs, item, local)
    raise ValueError(
        f"itemNumbers: {item!r} is no body, node or marker of Exudyn; give what mbs.Add... or "
        "mbs.Create... returned, or None for the ground"
    )


def _marker_place(mbs: Any, item: Any) -> Place:
    marker = mbs.GetMarker(item)
    kind = marker["markerType"]
    if kind == "NodeCoordinate":
        node = _index("NodeIndex", marker["nodeNumber"])
        if mbs.GetNode(node)["nodeType"] == "PointGround":
            return Place()
        return Place(node, int(marker["coordinate"]))
    if kind == "NodeRotationCoordinate":
        node = _index("NodeIndex", marker["nodeNumber"])
        return Place(node, turns=int(marker["rotationCoordinate"]))
    if kind in ("NodePosition", "NodeRigid"):
        return _node_place(mbs, _index("NodeIndex", marker["nodeNumber"]), (0.0, 0.0, 0.0))
    if kind in ("BodyPosition", "BodyRigid"):
        local = tuple(float(value) for value in marker["localPosition"])
        body = _index("ObjectIndex", marker["bodyNumber"])
        return _body_place(mbs, body, local)  # pyright: ignore[reportArgumentType]
    raise ValueError(
        f"itemNumbers: marker {int(item)} is a Marker{kind}; an inerter takes MarkerBodyPosition, "
        "MarkerBodyRigid, MarkerNodePosition, MarkerNodeRigid or MarkerNodeCoordinate"
    )


def _body_place(mbs: Any, item: Any, local: tuple[float, float, float]) -> Place:
    body = mbs.GetObject(item)
    kind = body["objectType"]
    if kind == "Ground":
        turned = np.asarray(body["referenceRotation"]) @ np.asarray(local)
        position = np.asarray(body["referencePosition"]) + turned
        return Place(local=tuple(float(value) for value in position))  # pyright: ignore[reportArgumentType]
    if kind in ("Mass1D", "RotationalMass1D"):
        if any(local):
            raise ValueError(
                f"localPosition: {list(local)} on object {int(item)}, a {kind}, which is one "
                "coordinate; give [0, 0, 0]"
            )
        return Place(_index("NodeIndex", body["nodeNumber"]), 0)
    if kind not in BODIES:
        raise ValueError(
            f"itemNumbers: object {int(item)} is a {kind}; an inerter takes the bodies "
            f"{', '.join(BODIES)}, Ground, and nodes"
        )
    return _node_place(mbs, _index("NodeIndex", body["nodeNumber"]), local)


def _node_place(mbs: Any, item: Any, local: tuple[float, float, float]) -> Place:
    node = mbs.GetNode(item)
    kind = node["nodeType"]
    if kind in ("1D", "PointGround", *NO_ROTATION) and any(local):
        raise ValueError(
            f"localPosition: {list(local)} on node {int(item)}, a Node{kind}, which does not turn; "
            "give [0, 0, 0]"
        )
    if kind == "1D":
        return Place(item, 0)
    if kind == "PointGround":
        return Place(local=tuple(float(value) for value in node["referenceCoordinates"]))  # pyright: ignore[reportArgumentType]
    if kind not in POINT_NODES:
        names = ", ".join(f"Node{name}" for name in ("1D", "PointGround", *POINT_NODES))
        raise ValueError(
            f"itemNumbers: node {int(item)} is a Node{kind}; an inerter takes {names}, or one of "
            "its coordinates by a MarkerNodeCoordinate"
        )
    return Place(item, None, local)


def _index(kind: str, number: Any) -> Any:
    return getattr(exudyn(), kind)(int(number))


def _line(mbs: Any, places: list[Place], starts: dict[int, int], size: int) -> Line:
    found: list[tuple[int, float]] = []
    for place, weight in zip(places, (-1.0, 1.0), strict=True):
        if place.node is None:
            continue
        count = len(mbs.GetNode(place.node)["referenceCoordinates"])
        coordinate = place.coordinate or 0
        if not 0 <= coordinate < count:
            raise ValueError(
                f"itemNumbers: coordinate {coordinate} of node {int(place.node)}, which has "
                f"{count}, counted from 0"
            )
        found.append((starts[int(place.node)] + coordinate, weight))
    return Line(size, tuple(place for place, _ in found), tuple(weight for _, weight in found))


def _point(mbs: Any, place: Place, starts: dict[int, int]) -> Point:
    if place.node is None:
        return Point(local=place.local)
    node = mbs.GetNode(place.node)
    moves, rotation = POINT_NODES[node["nodeType"]]
    reference = tuple(float(value) for value in node["referenceCoordinates"])
    start = starts[int(place.node)]
    return Point(start, reference, moves, rotation, place.local)
