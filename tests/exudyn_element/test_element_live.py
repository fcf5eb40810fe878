"""What follows the system: geometry, parameters, the flywheel's start, the solver's Jacobian."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest
from inerter import Device, DeviceError

pytest.importorskip("exudyn.itemInterface")

from element_systems import LUGRE, bodies, coordinate, empty, exu, line, push, settings, solve
from exudyn import itemInterface
from exudyn.rigidBodyUtilities import InertiaSphere
from inerter.exudyn import CreateInerter

# geometry


def strut(**device: Any) -> tuple[Any, Any, Any, Any]:
    """A mass 1 m beside a marker on the ground: system, marker, node, device."""
    made = empty()
    mbs = made.mbs
    ground, mass = mbs.CreateGround(), mbs.CreateMassPoint(referencePosition=[1, 0, 0], mass=2.0)
    marker = mbs.AddMarker(itemInterface.MarkerBodyPosition(bodyNumber=ground))
    node = mbs.GetObject(mass)["nodeNumber"]
    return made, marker, node, CreateInerter(mbs, "d", [marker, mass], inertance=1.0, **device)


def test_geometry_that_changes_before_assembly() -> None:
    made, marker, node, device = strut()
    made.mbs.SetNodeParameter(node, "referenceCoordinates", [1.5, 0.0, 0.0])
    made.mbs.SetMarkerParameter(marker, "localPosition", [0.0, 2.0, 0.0])
    made.mbs.Assemble()
    # the rest length is the distance anew
    assert device.Evaluate()["length"] == pytest.approx(2.5)
    assert device.Evaluate()["displacement"] == pytest.approx(0.0)


def test_a_rest_length_that_was_given_stays() -> None:
    made, _, node, device = strut(rest_length=0.7, stiffness=10.0)
    made.mbs.SetNodeParameter(node, "referenceCoordinates", [1.5, 0.0, 0.0])
    made.mbs.Assemble()
    assert device.Evaluate()["total"] == pytest.approx(8.0)


def test_geometry_that_changes_in_a_run() -> None:
    made, marker, _, device = strut()

    def pre_step(mbs: Any, t: float) -> bool:
        mbs.SetMarkerParameter(marker, "localPosition", [-2.26 if t > 0.05 else 0.0, 0.0, 0.0])
        return True

    made.mbs.SetPreStepUserFunction(pre_step)
    solve(made.mbs, settings(0.1, 1e-3))
    assert device.Evaluate()["length"] == pytest.approx(3.26)
    assert device.Evaluate()["displacement"] == pytest.approx(2.26)


# parameters


@pytest.mark.parametrize("symbolic", [True, False])
def test_parameters_change_after_assembly(symbolic: bool) -> None:
    """20 N on 2 kg and an inertance of 1, 6, 8 kg; then a damper that holds it."""
    system = line([2.0], [0.0])
    push(system.mbs, system.parts[0], 20.0)
    made = CreateInerter(
        system.mbs, "d", [None, system.parts[0]], symbolic=symbolic, inertance=1.0,
        quadratic_damping=1e-12,
    )  # fmt: skip
    assert accelerates(system, made) == pytest.approx(20.0 / 3.0)
    made.set(inertance=6.0)
    assert accelerates(system, made) == pytest.approx(20.0 / 8.0)
    system.mbs.SetObjectParameter(made.objectNumber, "inertance", 8.0)
    assert accelerates(system, made) == pytest.approx(20.0 / 10.0)
    assert made.device.inertance == 8.0
    made.set(viscous=1e3)
    solve(system.mbs, settings(0.2, 1e-3), "GeneralizedAlpha")
    assert made.Evaluate()["velocity"] == pytest.approx(0.02, rel=1e-6)


def accelerates(system: Any, made: Any) -> float:
    solve(system.mbs, settings(0.01, 1e-3))
    return made.Evaluate()["acceleration"]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"inertance": -1.0}, 'inertance is "-1.0": out of range'),
        ({"nonsense": 1.0}, '"nonsense" is not a parameter'),
        (LUGRE, "would change its states from none to friction_state, which are frozen"),
        ({"inertance_gradient": 0.2}, "a constant inertance a varying one"),
    ],
)
def test_changes_that_are_refused(change: dict[str, Any], message: str) -> None:
    system = line([2.0], [0.0])
    made = CreateInerter(system.mbs, "d", [None, system.parts[0]], inertance=1.0)
    system.mbs.Assemble()
    with pytest.raises((DeviceError, ValueError), match=message):
        made.set(**change)
    assert made.device.given == {"inertance": 1.0}
    assert accelerates(system, made) == 0.0


def test_a_device_does_not_change_and_can_be_pickled() -> None:
    device = Device(inertance=3.0, friction="dahl", coulomb_force=1.0, bristle_stiffness=1e4)
    with pytest.raises(AttributeError, match=r"inertance: a device does not change; .*strut.set"):
        device.inertance = 50.0  # type: ignore[misc]
    assert pickle.loads(pickle.dumps(device)).given == device.given


# the start


@pytest.mark.parametrize("kind", ["line", "Point"])
def test_the_flywheel_starts_with_the_terminals(kind: str) -> None:
    """Behind a stiff shaft: no force on a mass that flies, also where its speed is set later."""
    system = line([2.0, 3.0], [0.0, 0.0]) if kind == "line" else bodies(kind)
    made = CreateInerter(system.mbs, "d", system.parts, inertance=1.0, series_stiffness=1e6)
    node = made.nodeNumbers[1]
    speed = [1.0] if kind == "line" else [1.0, 0.0, 0.0]
    system.mbs.SetNodeParameter(node, "initialVelocities", speed)
    system.mbs.Assemble()
    found = made.Evaluate()
    assert abs(found["velocity"]) > 0.3
    np.testing.assert_allclose(made.GetStates(), [0.0, found["velocity"]], atol=1e-15)
    assert found["total"] == pytest.approx(0.0, abs=1e-8)


def test_a_flywheel_that_is_told_to_rest() -> None:
    system = line([2.0], [1.0])
    made = CreateInerter(
        system.mbs, "d", [None, system.parts[0]], inertance=1.0, series_stiffness=1e6,
        initialStates={"flywheel_velocity": 0.0},
    )  # fmt: skip
    system.mbs.Assemble()
    np.testing.assert_array_equal(made.GetStates(), [0.0, 0.0])


# the solver


def steps_through_impacts(kind: str) -> int:
    """Steps of a ball that falls, with an inertance aslant to the ground."""
    made = empty()
    mbs, radius, floor = made.mbs, 0.05, 10.0
    ground = mbs.CreateGround()
    ball = mbs.CreateRigidBody(
        inertia=InertiaSphere(1.6, radius), referencePosition=[0.3, 0.0, 0.4],
        gravity=[0.0, 0.0, -9.81],
    )  # fmt: skip
    node = mbs.GetObject(ball)["nodeNumber"]
    data = mbs.AddNode(
        itemInterface.NodeGenericData(
            numberOfDataCoordinates=4, initialCoordinates=[0.1, 0.0, 0.0, 0.0]
        )
    )
    below = mbs.AddMarker(
        itemInterface.MarkerBodyRigid(bodyNumber=ground, localPosition=[0.3, 0.0, -floor])
    )
    mbs.AddObject(
        itemInterface.ObjectContactSphereSphere(
            markerNumbers=[below, mbs.AddMarker(itemInterface.MarkerNodeRigid(nodeNumber=node))],
            nodeNumber=data, spheresRadii=[floor, radius], contactStiffness=1e6, impactModel=2,
            restitutionCoefficient=0.6, minimumImpactVelocity=1e-3,
        )
    )  # fmt: skip
    if kind == "inerter":
        CreateInerter(mbs, "d", [ground, ball], inertance=1.0)
    else:
        along = np.array([0.6, 0.0, 0.8])
        mass = np.zeros((7, 7))
        mass[:3, :3] = np.outer(along, along)
        mbs.AddObject(itemInterface.ObjectGenericODE2(nodeNumbers=[node], massMatrix=mass))
    count = [0]

    def pre_step(mbs: Any, t: float) -> bool:
        count[0] += 1
        assert count[0] < 5000, f"the step has collapsed at {t} s"
        return True

    mbs.SetPreStepUserFunction(pre_step)
    mbs.Assemble()
    chosen = exu.SimulationSettings()
    chosen.timeIntegration.numberOfSteps, chosen.timeIntegration.endTime = 500, 1.0
    chosen.timeIntegration.verboseMode = 0
    chosen.solution.file.write = False
    solve(mbs, chosen, "GeneralizedAlpha")
    assert not chosen.timeIntegration.newton.modifiedNewtonJacUpdatePerStep
    return count[0]


def test_impacts_under_default_settings() -> None:
    """No more than 1.3 times the steps of the same inertance as a constant mass matrix."""
    assert steps_through_impacts("inerter") <= 1.3 * steps_through_impacts("constant")


def test_a_constraint_under_an_explicit_solver_is_told() -> None:
    system = bodies("Point")
    CreateInerter(system.mbs, "strut", system.parts, inertance=1.0)
    node = system.mbs.GetObject(system.parts[0])["nodeNumber"]
    ground = system.mbs.AddNode(itemInterface.NodePointGround())
    ends = [coordinate(system.mbs, ground), coordinate(system.mbs, node)]
    system.mbs.AddObject(itemInterface.CoordinateConstraint(name="lock", markerNumbers=ends))
    with pytest.warns(UserWarning, match='inerter "strut": RK44 puts .* constraint "lock" back'):
        solve(system.mbs, settings(0.01, 1e-3))
