"""Small systems for the tests of the element: masses on a line, bodies in space, one way to run."""

from __future__ import annotations

import sys
from dataclasses import dataclass, field
from typing import Any

import exudyn
import exudyn.solver
import numpy as np
from exudyn import itemInterface
from exudyn.rigidBodyUtilities import InertiaCuboid, RotationMatrixX, RotationMatrixZ
from numpy.typing import NDArray

Array = NDArray[np.float64]
# what it says of its own types lacks much
exu: Any = exudyn
ROTATIONS = {
    "RigidBodyRxyz": exu.NodeType.RotationRxyz,
    "RigidBodyRotVecLG": exu.NodeType.RotationRotationVector,
    "RigidBodyEP": exu.NodeType.RotationEulerParameters,
}
BLOCK = InertiaCuboid(1000, [0.1, 0.2, 0.05])
"""1 kg, without symmetry."""

LUGRE: dict[str, Any] = {
    "friction": "lugre", "bristle_stiffness": 1e4, "bristle_damping": 50.0, "coulomb_force": 10.0,
    "static_force": 15.0, "stribeck_velocity": 0.05,
}  # fmt: skip
ELASTIC: dict[str, Any] = {"series_stiffness": 5e3, "series_damping": 50.0}
PLAY: dict[str, Any] = {**ELASTIC, "backlash": 2e-3}


@dataclass(frozen=True)
class System:
    """A system and the nodes (masses on a line) or bodies (in space) in it.

    The container owns the system: keep it.
    """

    mbs: Any
    parts: list[Any]
    container: Any
    masses: list[float] = field(default_factory=list)

    @property
    def positions(self) -> Array:
        """Coordinates of the masses on the line [m]."""
        return self._of_nodes("Coordinates")

    @property
    def velocities(self) -> Array:
        """Their velocities [m/s]."""
        return self._of_nodes("Coordinates_t")

    def _of_nodes(self, kind: str) -> Array:
        what = getattr(exu.OutputVariableType, kind)
        return np.array([float(self.mbs.GetNodeOutput(node, what)) for node in self.parts])


def empty() -> System:
    """A system with nothing in it."""
    container = exu.SystemContainer()
    return System(container.AddSystem(), [], container)


def line(masses: list[float], velocities: list[float], spring: float = 0.0) -> System:
    """Masses [kg] at velocities [m/s], with a spring [N/m] each to the ground."""
    made = empty()
    mbs = made.mbs
    ground = coordinate(mbs, mbs.AddNode(itemInterface.NodePointGround())) if spring else None
    for mass, velocity in zip(masses, velocities, strict=True):
        node = mbs.AddNode(
            itemInterface.Node1D(referenceCoordinates=[0.0], initialVelocities=[velocity])
        )
        mbs.AddObject(itemInterface.Mass1D(mass=mass, nodeNumber=node))
        made.parts.append(node)
        if ground is not None:
            markers = [ground, coordinate(mbs, node)]
            mbs.AddObject(
                itemInterface.CoordinateSpringDamper(markerNumbers=markers, stiffness=spring)
            )
    return System(mbs, made.parts, made.container, list(masses))


def coordinate(mbs: Any, node: Any, which: int = 0) -> Any:
    """Marker on a coordinate of a node."""
    return mbs.AddMarker(itemInterface.MarkerNodeCoordinate(nodeNumber=node, coordinate=which))


def push(mbs: Any, node: Any, force: float) -> None:
    """A constant force [N] on a node of the line."""
    mbs.AddLoad(itemInterface.LoadCoordinate(markerNumber=coordinate(mbs, node), load=force))


def body(mbs: Any, kind: str, place: int = 0) -> Any:
    """A tumbling body with a node of the kind "Point", "RigidBodyEP" ...; 2D ones stay in z = 0.

    Bodies of different `place` stand and move differently.
    """
    spread, flat = 1.0 if place else -1.0, kind.endswith("2D")
    start = [0.6 * place, 0.1 * place, 0.0 if flat else 0.2 * place]
    moving = [0.2 * spread, 0.1 + 0.2 * place, 0.0 if flat else 0.4]
    if kind.startswith("Point"):
        return mbs.CreateMassPoint(
            referencePosition=start,
            initialDisplacement=[0.01, -0.02, 0.0],
            initialVelocity=moving,
            mass=1.0 + place,
            create2D=flat,
        )
    turned = RotationMatrixZ(0.3 + place)
    return mbs.CreateRigidBody(
        inertia=BLOCK,
        referencePosition=start,
        initialDisplacement=[0.01, -0.02, 0.0],
        referenceRotationMatrix=turned if flat else RotationMatrixX(0.4) @ turned,
        initialVelocity=moving,
        initialAngularVelocity=[0.0 if flat else spread, 0.0 if flat else 2.0, -1.5 * spread],
        create2D=flat,
        **({} if flat else {"nodeType": ROTATIONS[kind]}),
    )


def bodies(kind: str) -> System:
    """Two tumbling bodies with nodes of one kind, without a joint."""
    made = empty()
    made.parts.extend(body(made.mbs, kind, place) for place in (0, 1))
    return made


def point(mbs: Any, part: Any, what: str, local: Any = (0.0, 0.0, 0.0)) -> Array:
    """What Exudyn says of a point on a body: Position, Velocity, Acceleration ..."""
    kind = getattr(exu.OutputVariableType, what)
    return np.array(mbs.GetObjectOutputBody(part, kind, list(local)))


def settings(end: float, step: float, newton: float = 1e-12) -> Any:
    """Settings for a run with a fixed step, no files; generalized-alpha without its own damping."""
    made = exu.SimulationSettings()
    made.solution.file.write = False
    made.solution.sensors.writePeriod = step
    made.timeIntegration.endTime = end
    made.timeIntegration.numberOfSteps = round(end / step)
    made.timeIntegration.verboseMode = 0
    made.timeIntegration.automaticStepSize = False
    made.timeIntegration.generalizedAlpha.spectralRadius = 1.0
    made.timeIntegration.newton.relativeTolerance = newton
    made.timeIntegration.newton.absoluteTolerance = newton
    return made


def solve(mbs: Any, chosen: Any, solver: str = "RK44") -> None:
    """Assemble if need be, and run; a failure is an error."""
    if not mbs.systemIsConsistent:
        mbs.Assemble()
    # Exudyn counts the vectors that user functions hand over, and tells of them in long runs
    enough = exudyn.solver.solverCheckMemoryAllocationsThreshold
    exudyn.solver.solverCheckMemoryAllocationsThreshold = sys.maxsize
    try:
        assert mbs.SolveDynamic(chosen, solverType=getattr(exu.DynamicSolverType, solver))
    finally:
        exudyn.solver.solverCheckMemoryAllocationsThreshold = enough


def double_pendulum(mbs: Any, speeds: list[float]) -> int:
    """A kinematic tree of two links that turn at these speeds [rad/s]: a marker at its tip."""
    node = mbs.AddNode(
        itemInterface.NodeGenericODE2(
            referenceCoordinates=[0.0, 0.0], initialCoordinates=[0.3, 0.2],
            initialCoordinates_t=speeds, numberOfODE2Coordinates=2,
        )
    )  # fmt: skip
    eye = np.eye(3)
    tree = mbs.AddObject(
        itemInterface.ObjectKinematicTree(
            nodeNumber=node, jointTypes=[exudyn.JointType.RevoluteZ] * 2, linkParents=[-1, 0],
            jointTransformations=exu.Matrix3DList([eye] * 2),
            jointOffsets=exu.Vector3DList([[0, 0, 0], [1, 0, 0]]),
            linkInertiasCOM=exu.Matrix3DList([0.1 * eye] * 2),
            linkCOMs=exu.Vector3DList([[0.5, 0, 0]] * 2), linkMasses=[1.0, 1.0],
            baseOffset=[0, 0, 0], gravity=[0, -9.81, 0],
        )
    )  # fmt: skip
    return mbs.AddMarker(
        itemInterface.MarkerKinematicTreeRigid(
            objectNumber=tree, linkNumber=1, localPosition=[1, 0, 0]
        )
    )
