"""Every kind of terminal: F is b times the acceleration of the length that Exudyn's marker tells.

One moving thing, an inerter from a point of the ground to it, nothing of the element in the
measure: the marker's position at every step, differenced twice. As a program it prints the table
of docs/exudyn.md.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

pytest.importorskip("exudyn.itemInterface")

from element_systems import BLOCK, ROTATIONS, Array, double_pendulum, empty, exu, settings, solve
from exudyn import itemInterface
from inerter.exudyn import CreateInerter

GROUND = np.array([0.3, -0.9, 0.5])
B, END, STEP = 0.4, 0.05, 5e-5
LENGTH, COUNT = 1.0, 4
Made = tuple[Any, Any]
"""The terminal as `itemNumbers` has it, and a marker at its place."""

ALONG: dict[str, Callable[[Any], Made]] = {}


def terminal(make: Callable[[Any], Made]) -> Callable[[Any], Made]:
    """A terminal of the table, by its words."""
    assert make.__doc__
    ALONG[make.__doc__.rstrip(".")] = make
    return make


def body_marker(mbs: Any, body: Any, place: tuple[float, ...] = (0.0, 0.0, 0.0)) -> Any:
    return mbs.AddMarker(
        itemInterface.MarkerBodyPosition(bodyNumber=body, localPosition=list(place))
    )


def tied(mbs: Any, marker: Any) -> None:
    """A spring to the ground, so that it accelerates."""
    ground = mbs.AddMarker(
        itemInterface.MarkerBodyPosition(
            bodyNumber=mbs.CreateGround(), localPosition=[0.2, 0.4, -0.3]
        )
    )
    mbs.AddObject(
        itemInterface.ObjectConnectorCartesianSpringDamper(
            markerNumbers=[ground, marker], stiffness=[30.0, 20.0, 25.0], damping=[0.0] * 3
        )
    )


@terminal
def mass_point(mbs: Any) -> Made:
    """Body MassPoint."""
    body = mbs.CreateMassPoint(mass=1.0, referencePosition=[1, 0, 0], initialVelocity=[0, 1, 0.5])
    marker = body_marker(mbs, body)
    tied(mbs, marker)
    return body, marker


def flat(mbs: Any, kind: str) -> Any:
    node = mbs.AddNode(
        itemInterface.NodePoint2D(referenceCoordinates=[1, 0], initialVelocities=[0, 1])
        if kind == "MassPoint2D"
        else itemInterface.NodeRigidBody2D(
            referenceCoordinates=[1, 0, 0.2], initialVelocities=[0, 1, 2]
        )
    )
    if kind == "MassPoint2D":
        return mbs.AddObject(itemInterface.MassPoint2D(mass=1.0, nodeNumber=node))
    return mbs.AddObject(itemInterface.RigidBody2D(mass=1.0, inertia=0.1, nodeNumber=node))


@terminal
def mass_point_2d(mbs: Any) -> Made:
    """Body MassPoint2D."""
    body = flat(mbs, "MassPoint2D")
    marker = body_marker(mbs, body)
    tied(mbs, marker)
    return body, marker


@terminal
def marker_on_flat_body(mbs: Any) -> Made:
    """MarkerBodyRigid of a RigidBody2D."""
    body = flat(mbs, "RigidBody2D")
    marker = mbs.AddMarker(
        itemInterface.MarkerBodyRigid(bodyNumber=body, localPosition=[0.3, 0.1, 0])
    )
    tied(mbs, marker)
    return marker, marker


def rigid(kind: str) -> Callable[[Any], Made]:
    def make(mbs: Any) -> Made:
        body = mbs.CreateRigidBody(
            inertia=BLOCK, referencePosition=[1, 0, 0], initialVelocity=[0, 1, 0.5],
            initialAngularVelocity=[0.5, -1.0, 0.3], nodeType=ROTATIONS[kind],
        )  # fmt: skip
        marker = body_marker(mbs, body, (0.1, 0.2, 0.0))
        tied(mbs, marker)
        return marker, marker

    return make


for each in ROTATIONS:
    ALONG[f"MarkerBodyPosition of a RigidBody ({each})"] = rigid(each)


@terminal
def node(mbs: Any) -> Made:
    """MarkerNodePosition of a NodePoint."""
    body = mbs.CreateMassPoint(mass=1.0, referencePosition=[1, 0, 0], initialVelocity=[0, 1, 0.5])
    marker = mbs.AddMarker(
        itemInterface.MarkerNodePosition(nodeNumber=mbs.GetObject(body)["nodeNumber"])
    )
    tied(mbs, marker)
    return marker, marker


def clamped(mbs: Any, node: Any, count: int) -> None:
    """All coordinates of a node held."""
    ground = mbs.AddMarker(
        itemInterface.MarkerNodeCoordinate(
            nodeNumber=mbs.AddNode(itemInterface.NodePointGround()), coordinate=0
        )
    )
    for i in range(count):
        own = mbs.AddMarker(itemInterface.MarkerNodeCoordinate(nodeNumber=node, coordinate=i))
        mbs.AddObject(itemInterface.CoordinateConstraint(markerNumbers=[ground, own]))


def chain(mbs: Any, kind: str) -> tuple[Any, float]:
    """A clamped beam of `COUNT` elements along x that is hit at its end: the last, its length."""
    part, axial, bending, mass = LENGTH / COUNT, 2e3, 5.0, 0.5
    three = kind in ("ANCFCable", "ANCFBeam", "BeamGeometricallyExact")
    nodes = []
    for i in range(COUNT + 1):
        hit = 1.0 if i == COUNT else 0.0
        x = i * part
        if kind == "ANCFCable2D":
            made = itemInterface.NodePoint2DSlope1(
                referenceCoordinates=[x, 0, 1, 0], initialVelocities=[0, hit, 0, 0]
            )
        elif kind == "ANCFCable":
            made = itemInterface.NodePointSlope1(
                referenceCoordinates=[x, 0, 0, 1, 0, 0],
                initialVelocities=[0, hit, 0.5 * hit, 0, 0, 0],
            )
        elif kind == "ANCFBeam":
            made = itemInterface.NodePointSlope23(
                referenceCoordinates=[x, 0, 0, 0, 1, 0, 0, 0, 1],
                initialVelocities=[0, hit, 0.5 * hit] + [0.0] * 6,
            )
        elif kind == "BeamGeometricallyExact":
            made = itemInterface.NodeRigidBodyRotVecLG(
                referenceCoordinates=[x, 0, 0, 0, 0, 0],
                initialVelocities=[0, hit, 0.5 * hit, 0, 0, 0],
            )
        else:
            made = itemInterface.NodeRigidBody2D(
                referenceCoordinates=[x, 0, 0], initialVelocities=[0, hit, 0]
            )
        nodes.append(mbs.AddNode(made))
    section = exu.BeamSection()
    section.massPerLength = mass
    section.stiffnessMatrix = np.diag([axial, axial, axial, 2 * bending, bending, bending])
    section.inertia = np.diag([2e-3, 1e-3, 1e-3])
    last = None
    for pair in pairwise(nodes):
        common: dict[str, Any] = {"nodeNumbers": list(pair), "length": part}
        plain: dict[str, Any] = {
            "massPerLength": mass,
            "bendingStiffness": bending,
            "axialStiffness": axial,
        }
        if kind in ("ANCFCable2D", "ANCFCable"):
            made = getattr(itemInterface, f"Object{kind}")(**common, **plain)
        elif kind == "BeamGeometricallyExact2D":
            made = itemInterface.ObjectBeamGeometricallyExact2D(
                **common, **plain, shearStiffness=axial, crossSectionInertia=1e-3
            )
        else:
            made = getattr(itemInterface, f"Object{kind}")(**common, sectionData=section)
        last = mbs.AddObject(made)
    clamped(mbs, nodes[0], len(mbs.GetNode(nodes[0])["referenceCoordinates"]))
    assert three or kind.endswith("2D")
    return last, part


def beam(kind: str, at: float) -> Callable[[Any], Made]:
    def make(mbs: Any) -> Made:
        body, part = chain(mbs, kind)
        marker = body_marker(mbs, body, (at * part, 0.0, 0.0))
        return marker, marker

    return make


for each, share in (
    ("ANCFCable2D", 1.0), ("ANCFCable", 1.0), ("ANCFBeam", 0.5),
    ("BeamGeometricallyExact2D", 0.5), ("BeamGeometricallyExact", 0.5),
):  # fmt: skip
    ALONG[f"MarkerBodyPosition of a {each}"] = beam(each, share)


def node_of_beam(kind: str) -> Callable[[Any], Made]:
    def make(mbs: Any) -> Made:
        body, _ = chain(mbs, kind)
        end = int(mbs.GetObject(body)["nodeNumbers"][1])
        marker = mbs.AddMarker(itemInterface.MarkerNodePosition(nodeNumber=end))
        return marker, marker

    return make


for each, kind_of_node in (
    ("ANCFCable2D", "Point2DSlope1"), ("ANCFCable", "PointSlope1"), ("ANCFBeam", "PointSlope23"),
):  # fmt: skip
    ALONG[f"MarkerNodePosition of a Node{kind_of_node}"] = node_of_beam(each)


def lattice(mbs: Any) -> Any:
    """Four points, masses and springs in matrices: what Exudyn calls a superelement."""
    places = np.array([[1, 0, 0], [1.3, 0, 0], [1, 0.3, 0], [1, 0, 0.3]], dtype=float)
    nodes = [
        mbs.AddNode(
            itemInterface.NodePoint(
                referenceCoordinates=list(p), initialVelocities=[0.1, 1.0 - p[2], 0.5]
            )
        )
        for p in places
    ]
    stiff = np.zeros((12, 12))
    for i in range(4):
        for j in range(i):
            line = (places[i] - places[j]) / np.linalg.norm(places[i] - places[j])
            block = 500.0 * np.outer(line, line)
            for a, b, sign in ((i, i, 1), (j, j, 1), (i, j, -1), (j, i, -1)):
                stiff[3 * a : 3 * a + 3, 3 * b : 3 * b + 3] += sign * block
    stiff += 200.0 * np.eye(12)
    return mbs.AddObject(
        itemInterface.ObjectGenericODE2(
            nodeNumbers=nodes, massMatrix=0.3 * np.eye(12), stiffnessMatrix=stiff
        )
    )


@terminal
def superelement(mbs: Any) -> Made:
    """MarkerSuperElementPosition."""
    marker = mbs.AddMarker(
        itemInterface.MarkerSuperElementPosition(
            bodyNumber=lattice(mbs), meshNodeNumbers=[0, 1, 2], weightingFactors=[0.5, 0.25, 0.25]
        )
    )
    return marker, marker


@terminal
def superelement_rigid(mbs: Any) -> Made:
    """MarkerSuperElementRigid."""
    marker = mbs.AddMarker(
        itemInterface.MarkerSuperElementRigid(
            bodyNumber=lattice(mbs), meshNodeNumbers=[0, 1, 2, 3], weightingFactors=[0.25] * 4
        )
    )
    return marker, marker


@terminal
def kinematic_tree(mbs: Any) -> Made:
    """MarkerKinematicTreeRigid."""
    marker = double_pendulum(mbs, [1.0, 0.5])
    return marker, marker


@terminal
def ale_cable(mbs: Any) -> Made:
    """MarkerBodyPosition of a ALEANCFCable2D."""
    shift = mbs.AddNode(
        itemInterface.NodeGenericODE2(
            referenceCoordinates=[0.0], initialCoordinates=[0.0], initialCoordinates_t=[0.0],
            numberOfODE2Coordinates=1,
        )
    )  # fmt: skip
    ends = [
        mbs.AddNode(
            itemInterface.NodePoint2DSlope1(
                referenceCoordinates=[x, 0, 1, 0], initialVelocities=[0, x, 0, 0]
            )
        )
        for x in (0.0, 1.0)
    ]
    cable = mbs.AddObject(
        itemInterface.ObjectALEANCFCable2D(
            nodeNumbers=[*ends, shift],
            length=1.0,
            massPerLength=0.5,
            bendingStiffness=5.0,
            axialStiffness=2e3,
        )
    )
    clamped(mbs, ends[0], 4)
    clamped(mbs, shift, 1)
    marker = body_marker(mbs, cable, (1.0, 0.0, 0.0))
    return marker, marker


def force_error(name: str, step: float) -> float:
    """Of F and b x'', relative to the largest force."""
    made = empty()
    mbs = made.mbs
    item, marker = ALONG[name](mbs)
    strut = CreateInerter(mbs, "d", [None, item], localPosition0=GROUND, inertance=B, show=False)
    place = mbs.AddSensor(
        itemInterface.SensorMarker(
            markerNumber=marker, outputVariableType=exu.OutputVariableType.Position,
            storeInternal=True, writeToFile=False,
        )
    )  # fmt: skip
    force = strut.AddSensor("total")
    chosen = settings(END, step)
    chosen.timeIntegration.generalizedAlpha.spectralRadius = 0.8
    solve(mbs, chosen, "GeneralizedAlpha")
    lengths = np.linalg.norm(mbs.GetSensorStoredData(place)[:, 1:] - GROUND, axis=1)
    told: Array = mbs.GetSensorStoredData(force)[:, 1]
    expected = B * np.diff(lengths, 2) / step**2
    # from the second tenth on: generalized-alpha starts from an acceleration of its own
    settled = slice(told.size // 5, None)
    assert np.abs(told).max() > 0.05
    return float(np.abs(told[1:-1] - expected)[settled].max() / np.abs(told).max())


@pytest.mark.parametrize("name", ALONG)
def test_force_is_the_inertance_times_the_acceleration(name: str) -> None:
    """The difference is the solver's and that of differencing: it goes with the step squared."""
    coarse, fine = force_error(name, 4.0 * STEP), force_error(name, STEP)
    assert fine < 5e-3
    assert fine < coarse / 6.0 or fine < 1e-5


if __name__ == "__main__":
    for name in ALONG:
        print(f"| {name} | {force_error(name, STEP):.0e} |")
