"""The element on points of bodies: Exudyn's own kinematics and spring are the oracles.

Every kind of node, turned and turning; every way to name a terminal.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

pytest.importorskip("exudyn.itemInterface")

from element_systems import (
    LUGRE,
    ROTATIONS,
    Array,
    System,
    bodies,
    body,
    empty,
    exu,
    line,
    point,
    settings,
    solve,
)
from exudyn import itemInterface
from inerter.exudyn import CreateInerter

KINDS = ("Point", "Point2D", "RigidBody2D", *ROTATIONS)
TURNING = ("RigidBody2D", *ROTATIONS)
# explicit solvers do not take Euler parameters
SOLVER = dict.fromkeys(KINDS, "RK44") | {"RigidBodyEP": "GeneralizedAlpha"}


def arms(kind: str) -> tuple[list[float], list[float]]:
    """Points on the bodies, off their centres if they turn."""
    if kind.startswith("Point"):
        return [0.0] * 3, [0.0] * 3
    if kind == "RigidBody2D":
        return [0.05, 0.02, 0.0], [-0.04, 0.1, 0.0]
    return [0.05, 0.02, -0.03], [-0.04, 0.1, 0.02]


def connect(system: System, kind: str, **device: Any) -> Any:
    first, second = arms(kind)
    return CreateInerter(
        system.mbs, "d", system.parts, localPosition0=first, localPosition1=second, **device
    )


def state(system: System) -> Array:
    """Positions and rotations of all bodies, one row."""
    found = [
        point(system.mbs, part, what).ravel()
        for part in system.parts
        for what in ("Position", "Velocity", "RotationMatrix")
    ]
    return np.concatenate(found)


@pytest.mark.parametrize("kind", KINDS)
def test_length_and_its_rates_are_those_of_the_points(kind: str) -> None:
    """x, x', x'' from Exudyn's position, velocity, acceleration of the two points."""
    system = bodies(kind)
    made = connect(system, kind, inertance=3.0, stiffness=40.0, rest_length=0.5)
    solve(system.mbs, settings(0.2, 2e-3), SOLVER[kind])
    p, v, a = (
        np.subtract(*(point(system.mbs, system.parts[i], what, arms(kind)[i]) for i in (1, 0)))
        for what in ("Position", "Velocity", "Acceleration")
    )
    length = float(np.linalg.norm(p))
    rate = float(p @ v) / length
    across = (float(v @ v) - rate**2) / length
    said = made.Evaluate()
    assert abs(across) > 1e-3
    assert said["displacement"] == pytest.approx(length - 0.5, rel=1e-12)
    assert said["velocity"] == pytest.approx(rate, rel=1e-12)
    assert said["acceleration"] == pytest.approx(float(p @ a) / length + across, rel=1e-10)


@pytest.mark.parametrize("kind", KINDS)
def test_spring_and_damper_are_exudyns(kind: str) -> None:
    """Without inertance the element moves bodies as CreateSpringDamper does."""
    ends = []
    for ours in (True, False):
        system = bodies(kind)
        if ours:
            connect(system, kind, stiffness=80.0, viscous=2.0, rest_length=0.4)
        else:
            first, second = arms(kind)
            system.mbs.CreateSpringDamper(
                itemNumbers=system.parts,
                localPosition0=first,
                localPosition1=second,
                referenceLength=0.4,
                stiffness=80.0,
                damping=2.0,
            )
        solve(system.mbs, settings(0.2, 2e-3), SOLVER[kind])
        ends.append(state(system))
    np.testing.assert_allclose(ends[0], ends[1], rtol=1e-9, atol=1e-10)


def test_kinds_of_nodes_agree() -> None:
    """The same two bodies in three parametrisations of rotation, by an implicit solver."""
    ends = {}
    for kind in ROTATIONS:
        system = bodies(kind)
        connect(system, kind, inertance=5.0, stiffness=100.0, rest_length=0.5, **LUGRE)
        found = []
        for step in (2e-3, 1e-3):
            solve(system.mbs, settings(0.2, step), "GeneralizedAlpha")
            found.append(state(system))
        # second order: what is left is of fourth
        ends[kind] = (4.0 * found[1] - found[0]) / 3.0
    first, *others = ends.values()
    for other in others:
        np.testing.assert_allclose(other, first, atol=2e-6)


@pytest.mark.parametrize("kind", ["Point", "Point2D"])
def test_on_one_line_it_is_the_line(kind: str) -> None:
    """Two mass points moving along their connection are two coordinates."""
    device = {"inertance": 4.0, "stiffness": 90.0, **LUGRE}
    flat = line([1.0, 2.0], [0.3, -0.1])
    straight = CreateInerter(flat.mbs, "d", flat.parts, **device)
    solve(flat.mbs, settings(0.3, 1e-3))

    space = empty()
    along = np.array([0.6, 0.8, 0.0])
    for mass, speed, place in ((1.0, 0.3, 0.0), (2.0, -0.1, 0.7)):
        space.parts.append(
            space.mbs.CreateMassPoint(
                mass=mass,
                referencePosition=list(place * along),
                initialVelocity=list(speed * along),
                create2D=kind == "Point2D",
            )
        )
    slanted = CreateInerter(space.mbs, "d", space.parts, rest_length=0.7, **device)
    solve(space.mbs, settings(0.3, 1e-3))
    said, expected = slanted.Evaluate(), straight.Evaluate()
    for name in ("displacement", "velocity", "acceleration", "total", "friction"):
        assert said[name] == pytest.approx(expected[name], rel=1e-9)
    np.testing.assert_allclose(said["states"], expected["states"], rtol=1e-9)


def test_free_fall_by_hand() -> None:
    """A mass point of 4 kg on a vertical inerter of 2 kg under the ground's ceiling, 18 N."""
    system = empty()
    mass = system.mbs.CreateMassPoint(mass=4.0, referencePosition=[1.0, 0.0, -2.0])
    system.mbs.CreateForce(itemNumber=mass, loadVector=[0.0, 0.0, -18.0])
    made = CreateInerter(
        system.mbs, "d", [None, mass], localPosition0=[1.0, 0.0, 0.0], inertance=2.0,
        rest_length=2.0,
    )  # fmt: skip
    solve(system.mbs, settings(0.1, 0.01))
    said = made.Evaluate()
    assert said["total"] == pytest.approx(6.0, rel=1e-12)
    assert said["displacement"] == pytest.approx(0.015, rel=1e-9)


@pytest.mark.parametrize("kind", TURNING)
def test_both_terminals_on_one_body(kind: str) -> None:
    """Its length cannot change: the body flies as if the device were not there."""
    ends = []
    for there in (True, False):
        system = empty()
        system.parts.append(body(system.mbs, kind, 1))
        if there:
            made = CreateInerter(
                system.mbs, "d", system.parts * 2, localPosition0=[0.1, 0.0, 0.0],
                localPosition1=[0.0, 0.2, 0.0], inertance=50.0, stiffness=300.0, viscous=9.0,
            )  # fmt: skip
            solve(system.mbs, settings(0.2, 2e-3), SOLVER[kind])
            assert made.Evaluate()["velocity"] == pytest.approx(0.0, abs=1e-6)
            assert made.Evaluate()["length"] == pytest.approx(0.1 * 5**0.5, rel=1e-6)
        else:
            solve(system.mbs, settings(0.2, 2e-3), SOLVER[kind])
        ends.append(state(system))
    np.testing.assert_allclose(ends[0], ends[1], atol=1e-9)


# every way to name a terminal

WAYS = ("body", "node", "MarkerBodyPosition", "MarkerBodyRigid", "MarkerNodePosition",
        "MarkerNodeRigid")  # fmt: skip


def named(mbs: Any, part: Any, way: str) -> Any:
    node = exu.NodeIndex(int(mbs.GetObject(part)["nodeNumber"]))
    if way in ("body", "node"):
        return part if way == "body" else node
    on_body = {"bodyNumber": part, "localPosition": [0.0, 0.0, 0.0]}
    return mbs.AddMarker(
        getattr(itemInterface, way)(**(on_body if "Body" in way else {"nodeNumber": node}))
    )


def ground(mbs: Any, way: str) -> tuple[Any, list[float]]:
    """The point (1, 2, 0) of the ground, and its local position."""
    if way == "None":
        return None, [1.0, 2.0, 0.0]
    if way == "NodePointGround":
        return mbs.AddNode(itemInterface.NodePointGround(referenceCoordinates=[1.0, 2.0, 0.0])), [
            0.0
        ] * 3
    # turned by a right angle about z: local (2, -0.5, 0) stands at (1.5 - 0.5, 0 + 2, 0)
    turn = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]).T
    base = mbs.CreateGround(referencePosition=[0.5, 0.0, 0.0], referenceRotationMatrix=turn)
    if way == "ObjectGround":
        return base, [2.0, -0.5, 0.0]
    marker = itemInterface.MarkerBodyPosition(bodyNumber=base, localPosition=[2.0, -0.5, 0.0])
    return mbs.AddMarker(marker), [0.0] * 3


def flown(kind: str, way: str, fixed: str) -> Array:
    system = empty()
    system.parts.append(body(system.mbs, kind, 1))
    where, local = ground(system.mbs, fixed)
    terminal = named(system.mbs, system.parts[0], way)
    device: dict[str, Any] = {"inertance": 3.0, "stiffness": 40.0, "viscous": 1.0}
    CreateInerter(system.mbs, "d", [where, terminal], localPosition0=local, **device)
    solve(system.mbs, settings(0.02, 2e-3), SOLVER[kind])
    return state(system)


@pytest.mark.parametrize("kind", KINDS)
def test_ways_to_name_a_body(kind: str) -> None:
    expected = flown(kind, "body", "None")
    ways = WAYS if kind in TURNING else [way for way in WAYS if "Rigid" not in way]
    for way in ways[1:]:
        np.testing.assert_array_equal(flown(kind, way, "None"), expected, err_msg=way)


@pytest.mark.parametrize("fixed", ["ObjectGround", "NodePointGround", "MarkerBodyPosition"])
def test_ways_to_name_the_ground(fixed: str) -> None:
    expected = flown("RigidBodyRxyz", "body", "None")
    np.testing.assert_allclose(flown("RigidBodyRxyz", "body", fixed), expected, atol=1e-14)


def test_where_exudyn_evaluates_by_itself() -> None:
    """On a line; points on bodies need Python."""
    system = line([2.0], [0.0])
    assert CreateInerter(system.mbs, "d", [None, system.parts[0]], inertance=1.0).symbolic
    assert not connect(bodies("Point"), "Point", inertance=1.0).symbolic
