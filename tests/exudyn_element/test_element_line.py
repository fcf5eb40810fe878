"""The element on coordinates: signs by hand, closed forms, every way to name a terminal."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

pytest.importorskip("exudyn.itemInterface")

from element_systems import LUGRE, PLAY, coordinate, empty, exu, line, push, settings, solve
from exudyn import itemInterface
from inerter.exudyn import CreateInerter

BOTH = pytest.mark.parametrize("symbolic", [True, False])
SOLVERS = ("RK44", "GeneralizedAlpha")


@BOTH
@pytest.mark.parametrize("solver", SOLVERS)
def test_two_kilograms_at_three_metres_per_second_squared(solver: str, symbolic: bool) -> None:
    """18 N on 4 kg and an inerter of 2 kg: 3 m/s^2, tension +6 N."""
    system = line([4.0], [0.0])
    push(system.mbs, system.parts[0], 18.0)
    made = CreateInerter(system.mbs, "d", [None, system.parts[0]], inertance=2.0, symbolic=symbolic)
    solve(system.mbs, settings(0.1, 0.01), solver)
    said = made.Evaluate()
    assert said["acceleration"] == pytest.approx(3.0, rel=1e-12)
    assert said["total"] == said["inertance"] == pytest.approx(6.0, rel=1e-12)
    assert said["displacement"] == pytest.approx(0.5 * 3.0 * 0.1**2, rel=1e-9)
    assert said["velocity"] == pytest.approx(0.3, rel=1e-12)
    assert said["stored_energy"] == pytest.approx(0.5 * 2.0 * 0.3**2, rel=1e-12)


@BOTH
@pytest.mark.parametrize("solver", SOLVERS)
def test_the_same_from_the_other_side(solver: str, symbolic: bool) -> None:
    """Terminal 1 moves away from terminal 2, the ground: shorter, -3 m/s^2, -6 N."""
    system = line([4.0], [0.0])
    push(system.mbs, system.parts[0], 18.0)
    made = CreateInerter(system.mbs, "d", [system.parts[0], None], inertance=2.0, symbolic=symbolic)
    solve(system.mbs, settings(0.1, 0.01), solver)
    said = made.Evaluate()
    assert said["acceleration"] == pytest.approx(-3.0, rel=1e-12)
    assert said["total"] == pytest.approx(-6.0, rel=1e-12)


@BOTH
@pytest.mark.parametrize(
    ("device", "tension"),
    [
        ({"force_offset": 5.0}, 5.0),
        ({"stiffness": 50.0, "rest_length": -0.1}, 5.0),
        ({"viscous": 10.0}, -2.0),
    ],
)
def test_tension_pulls_the_terminals_together(
    device: dict[str, Any], tension: float, symbolic: bool
) -> None:
    """Masses 2 and 3 kg at 0.2 and 0 m/s: the first step's accelerations are +F/2 and -F/3."""
    system = line([2.0, 3.0], [0.2, 0.0])
    made = CreateInerter(system.mbs, "d", system.parts, symbolic=symbolic, **device)
    solve(system.mbs, settings(1e-6, 1e-6))
    assert made.Evaluate()["total"] == pytest.approx(tension, rel=1e-4)
    gained = (system.velocities - [0.2, 0.0]) / 1e-6
    np.testing.assert_allclose(gained, [tension / 2.0, -tension / 3.0], rtol=1e-4)


@BOTH
def test_an_ideal_inerter_between_two_masses(symbolic: bool) -> None:
    """By hand: M = [[m1 + b, -b], [-b, m2 + b]]."""
    system = line([2.0, 3.0], [0.0, 0.0])
    push(system.mbs, system.parts[1], 7.0)
    CreateInerter(system.mbs, "d", system.parts, inertance=5.0, symbolic=symbolic)
    solve(system.mbs, settings(1.0, 0.1))
    expected = np.linalg.solve([[7.0, -5.0], [-5.0, 8.0]], [0.0, 7.0])
    np.testing.assert_allclose(system.velocities, expected, rtol=1e-13)
    np.testing.assert_allclose(system.positions, expected / 2.0, rtol=1e-13)


@BOTH
def test_inerter_and_spring_oscillate(symbolic: bool) -> None:
    """Frequency sqrt(k / (m + b)), here with the spring of the device."""
    system = line([2.0], [0.3])
    CreateInerter(
        system.mbs, "d", [None, system.parts[0]], inertance=6.0, stiffness=800.0, symbolic=symbolic
    )
    solve(system.mbs, settings(1.0, 1e-3))
    assert system.positions[0] == pytest.approx(0.03 * math.sin(10.0), rel=1e-8)


# every way to name the ground and a coordinate is the same system, to the last bit

Choose = Callable[[Any], Any]
GROUNDS: dict[str, Choose] = {
    "None": lambda mbs: None,
    "ObjectGround": lambda mbs: mbs.CreateGround(),
    "NodePointGround": lambda mbs: mbs.AddNode(itemInterface.NodePointGround()),
    "marker": lambda mbs: coordinate(mbs, mbs.AddNode(itemInterface.NodePointGround())),
}


def moved(ground: str, by_marker: bool, turned: bool, device: dict[str, Any]) -> list[float]:
    system = line([2.0], [0.3], spring=200.0)
    mbs, node = system.mbs, system.parts[0]
    ends = [GROUNDS[ground](mbs), coordinate(mbs, node) if by_marker else node]
    made = CreateInerter(mbs, "d", ends[::-1] if turned else ends, **device)
    solve(mbs, settings(0.2, 1e-3))
    return [*system.positions, *system.velocities, *made.GetStates()]


@pytest.mark.parametrize("by_marker", [True, False])
@pytest.mark.parametrize("ground", GROUNDS)
def test_ways_to_name_a_terminal(ground: str, by_marker: bool) -> None:
    device = {"inertance": 3.0, **LUGRE, **PLAY}
    expected = moved("None", False, False, device)
    assert moved(ground, by_marker, False, device) == expected
    # an odd device does the same when it is turned round
    turned = moved(ground, by_marker, True, device)
    np.testing.assert_allclose(turned[:2], expected[:2], rtol=1e-12)
    np.testing.assert_allclose(turned[2:], -np.array(expected[2:]), rtol=1e-11, atol=1e-15)


# coordinates of other nodes


def test_a_coordinate_of_a_point() -> None:
    """The vertical coordinate of a mass point, with a force across that does not matter."""
    made = empty()
    mass = made.mbs.CreateMassPoint(mass=4.0, referencePosition=[1.0, 2.0, 3.0])
    made.mbs.CreateForce(itemNumber=mass, loadVector=[10.0, 0.0, 18.0])
    node = exu.NodeIndex(int(made.mbs.GetObject(mass)["nodeNumber"]))
    strut = CreateInerter(
        made.mbs, "d", [None, coordinate(made.mbs, node, 2)], inertance=2.0, viscous=0.0
    )
    solve(made.mbs, settings(0.1, 0.01))
    velocity = made.mbs.GetNodeOutput(node, exu.OutputVariableType.Velocity)
    np.testing.assert_allclose(velocity, [0.25, 0.0, 0.3], rtol=1e-12)
    assert strut.Evaluate()["total"] == pytest.approx(6.0, rel=1e-12)


def test_two_coordinates_of_one_point() -> None:
    """M = [[m + b, -b], [-b, m + b]] couples x and y of the same node."""
    made = empty()
    mass = made.mbs.CreateMassPoint(mass=4.0)
    made.mbs.CreateForce(itemNumber=mass, loadVector=[10.0, 0.0, 0.0])
    node = exu.NodeIndex(int(made.mbs.GetObject(mass)["nodeNumber"]))
    ends = [coordinate(made.mbs, node, which) for which in (0, 1)]
    CreateInerter(made.mbs, "d", ends, inertance=2.0)
    solve(made.mbs, settings(1.0, 0.1))
    velocity = made.mbs.GetNodeOutput(node, exu.OutputVariableType.Velocity)
    expected = np.linalg.solve([[6.0, -2.0], [-2.0, 6.0]], [10.0, 0.0])
    np.testing.assert_allclose(velocity, [*expected, 0.0], rtol=1e-12)


def test_a_turning_inerter() -> None:
    """On the angle of a planar body: kg m^2, rad, N m; 6 N m on 1 + 2 kg m^2."""
    made = empty()
    node = made.mbs.AddNode(itemInterface.NodeRigidBody2D(referenceCoordinates=[0.0, 0.0, 0.5]))
    made.mbs.AddObject(itemInterface.RigidBody2D(mass=1.0, inertia=1.0, nodeNumber=node))
    angle = coordinate(made.mbs, node, 2)
    made.mbs.AddLoad(itemInterface.LoadCoordinate(markerNumber=angle, load=6.0))
    wheel = CreateInerter(made.mbs, "d", [None, angle], inertance=2.0)
    solve(made.mbs, settings(0.1, 0.01))
    said = wheel.Evaluate()
    assert said["displacement"] == pytest.approx(0.01, rel=1e-9)
    assert said["total"] == pytest.approx(4.0, rel=1e-12)


@pytest.mark.parametrize("symbolic", [True, False])
def test_rest_length_shifts_the_displacement(symbolic: bool) -> None:
    """A spring of rest length L at rest at coordinate L; reference coordinates do not count."""
    made = empty()
    node = made.mbs.AddNode(
        itemInterface.Node1D(referenceCoordinates=[5.0], initialCoordinates=[0.2])
    )
    made.mbs.AddObject(itemInterface.Mass1D(mass=1.0, nodeNumber=node))
    strut = CreateInerter(
        made.mbs, "d", [None, node], stiffness=100.0, rest_length=0.2, symbolic=symbolic
    )
    solve(made.mbs, settings(0.1, 0.01))
    assert strut.Evaluate()["displacement"] == 0.0
    assert strut.Evaluate()["total"] == 0.0


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize(
    "device",
    [LUGRE, PLAY, {"friction": "coulomb", "coulomb_force": 10.0, "transition_velocity": 0.01}],
    ids=["lugre", "play", "coulomb"],
)
def test_symbolic_and_python_run_alike(device: dict[str, Any], solver: str) -> None:
    ends = []
    for symbolic in (True, False):
        system = line([2.0, 3.0], [0.5, -0.2], spring=300.0)
        made = CreateInerter(
            system.mbs, "d", system.parts, inertance=4.0, symbolic=symbolic, **device
        )
        assert made.symbolic is symbolic
        solve(system.mbs, settings(0.3, 1e-3), solver)
        ends.append([*system.positions, *system.velocities, *made.GetStates()])
    np.testing.assert_allclose(ends[0], ends[1], rtol=1e-9, atol=1e-13)
