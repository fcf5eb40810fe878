"""Terminals beyond points and coordinates: torsion, carried points, one-dimensional bodies."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

pytest.importorskip("exudyn.itemInterface")

from element_systems import (
    BLOCK,
    ROTATIONS,
    coordinate,
    double_pendulum,
    empty,
    exu,
    line,
    settings,
    solve,
)
from exudyn import itemInterface
from exudyn.rigidBodyUtilities import RotationMatrixX, RotationMatrixY
from inerter import DeviceError
from inerter.exudyn import CreateInerter

TORQUE, SPIN, SPRING = 2.0, 0.5, 0.05


@pytest.mark.parametrize("where", ["global", "local", "marker"])
@pytest.mark.parametrize("kind", ROTATIONS)
def test_torsion_over_turns(kind: str, where: str) -> None:
    """A body on a hinge, a torque, a spring: closed form, four turns far."""
    made = empty()
    mbs, ground = made.mbs, made.mbs.CreateGround()
    turned = np.eye(3) if where == "marker" else RotationMatrixX(0.7) @ RotationMatrixY(0.3)
    axis = turned @ [0.0, 0.0, 1.0]
    body = mbs.CreateRigidBody(
        inertia=BLOCK, referenceRotationMatrix=turned, nodeType=ROTATIONS[kind]
    )
    mbs.CreateRevoluteJoint(itemNumbers=[ground, body], position=[0, 0, 0], axis=list(axis))
    mbs.CreateTorque(itemNumber=body, loadVector=list(TORQUE * axis))
    device: dict[str, Any] = {"inertance": SPIN, "stiffness": SPRING}
    if where == "marker":
        marker = mbs.AddMarker(
            itemInterface.MarkerNodeRotationCoordinate(
                nodeNumber=mbs.GetObject(body)["nodeNumber"], rotationCoordinate=2
            )
        )
        strut = CreateInerter(mbs, "d", [None, marker], **device)
    elif where == "local":
        strut = CreateInerter(
            mbs, "d", [body, ground], axis=[0.0, 0.0, 2.0], useGlobalFrame=False, **device
        )
    else:
        strut = CreateInerter(mbs, "d", [ground, body], axis=axis, **device)
    chosen = settings(4.0, 2e-3)
    chosen.timeIntegration.generalizedAlpha.spectralRadius = 0.8
    solve(mbs, chosen, "GeneralizedAlpha")
    inertia = BLOCK.InertiaCOM()[2, 2] + SPIN
    true = TORQUE / SPRING * (1.0 - np.cos(np.sqrt(SPRING / inertia) * 4.0))
    assert true > 8.0 * np.pi
    sign = -1.0 if where == "local" else 1.0
    assert sign * strut.Evaluate()["displacement"] == pytest.approx(true, rel=2e-3)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"axis": [0.0, 0.0, 0.0]}, "axis: .* has no direction"),
        ({"axis": [0.0, 1.0]}, "axis: .* is not three finite numbers"),
    ],
)
def test_axes_that_cannot_be(arguments: dict[str, Any], message: str) -> None:
    made = empty()
    body = made.mbs.CreateRigidBody(inertia=BLOCK)
    with pytest.raises(ValueError, match=message):
        CreateInerter(made.mbs, "d", [None, body], inertance=1.0, **arguments)


def test_an_axis_through_a_point() -> None:
    made = empty()
    mass = made.mbs.CreateMassPoint(mass=1.0, referencePosition=[1, 0, 0])
    with pytest.raises(ValueError, match="NodePoint does not turn in space"):
        CreateInerter(made.mbs, "d", [None, mass], axis=[0, 0, 1], inertance=1.0)


@pytest.mark.parametrize("kind", ["Mass1D", "Rotor1D"])
def test_bodies_of_one_coordinate(kind: str) -> None:
    made = empty()
    node = made.mbs.AddNode(itemInterface.Node1D(referenceCoordinates=[0.0]))
    inertia = {"mass": 2.0} if kind == "Mass1D" else {"inertia": 2.0}
    item = made.mbs.AddObject(getattr(itemInterface, kind)(nodeNumber=node, **inertia))
    strut = CreateInerter(made.mbs, "d", [None, item], inertance=3.0)
    marker = coordinate(made.mbs, node)
    made.mbs.AddLoad(itemInterface.LoadCoordinate(markerNumber=marker, load=10.0))
    solve(made.mbs, settings(0.01, 1e-3))
    assert strut.Evaluate()["acceleration"] == pytest.approx(2.0)


def test_a_kinematic_tree() -> None:
    """A double pendulum: F = b x'' with x'' from the positions that Exudyn tells."""
    made = empty()
    mbs = made.mbs
    tip = double_pendulum(mbs, [1.0, 0.0])
    ground = np.array([0.5, -1.5, 0.0])
    strut = CreateInerter(mbs, "d", [None, tip], localPosition0=ground, inertance=2.0)
    place = mbs.AddSensor(
        itemInterface.SensorMarker(
            markerNumber=tip, outputVariableType=exu.OutputVariableType.Position, storeInternal=True
        )
    )
    force = strut.AddSensor("total")
    mbs.Assemble()
    assert strut.Evaluate()["velocity"] > 1.0
    chosen = settings(0.25, 2.5e-4)
    chosen.timeIntegration.generalizedAlpha.spectralRadius = 0.8
    solve(mbs, chosen, "GeneralizedAlpha")
    lengths = np.linalg.norm(mbs.GetSensorStoredData(place)[:, 1:] - ground, axis=1)
    forces = mbs.GetSensorStoredData(force)[:, 1]
    expected = 2.0 * np.diff(lengths, 2) / 2.5e-4**2
    np.testing.assert_allclose(forces[1:-1][50:], expected[50:], atol=1e-4 * np.abs(forces).max())
    with pytest.raises(ValueError, match="RK44 cannot solve the joint of its massless point"):
        solve(mbs, settings(0.01, 1e-3))


# keywords and manners


def test_keywords_of_exudyns_own() -> None:
    system = line([1.0, 1.0], [0.0, 0.5])
    made = CreateInerter(
        system.mbs, bodyNumbers=system.parts, inertance=1.0, damping=3.0, referenceLength=0.2,
        force=4.0,
    )  # fmt: skip
    assert made.device.given == {
        "inertance": 1.0, "viscous": 3.0, "rest_length": 0.2, "force_offset": 4.0,
    }  # fmt: skip


def test_a_name_that_is_no_name_and_twice_the_same() -> None:
    system = line([1.0, 1.0], [0.0, 0.5])
    with pytest.raises(ValueError, match=r"name: .* is no text; give the name first"):
        CreateInerter(system.mbs, system.parts, inertance=1.0)  # pyright: ignore[reportArgumentType]
    with pytest.raises(ValueError, match="itemNumbers: also given as bodyOrNodeList"):
        CreateInerter(system.mbs, "d", system.parts, bodyOrNodeList=system.parts, inertance=1.0)
    with pytest.raises(DeviceError, match="damping: is viscous, which is given as well"):
        CreateInerter(system.mbs, "d", system.parts, inertance=1.0, damping=1.0, viscous=1.0)


def test_the_rest_length_is_the_reference_distance() -> None:
    """As the native spring's: no force at the reference configuration."""
    made = empty()
    pair = [made.mbs.CreateMassPoint(mass=1.0, referencePosition=[x, 0, 0]) for x in (0.0, 1.0)]
    strut = CreateInerter(made.mbs, "d", pair, inertance=1.0, stiffness=800.0)
    made.mbs.Assemble()
    assert strut.Evaluate()["total"] == 0.0
    assert strut.device.rest_length == 1.0


def test_a_drawing_that_is_switched() -> None:
    made = empty()
    mass = made.mbs.CreateMassPoint(mass=1.0, referencePosition=[1, 0, 0])
    strut = CreateInerter(made.mbs, "d", [None, mass], inertance=1.0, show=False)
    made.mbs.Assemble()
    assert not made.mbs.GetObject(strut.drawingNumber)["Vshow"]
    strut.Show()
    assert made.mbs.GetObject(strut.drawingNumber)["Vshow"]
