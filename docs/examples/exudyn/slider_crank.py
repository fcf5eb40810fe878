"""A slider-crank with a torsional inerter at the crank: a flywheel without a flywheel's weight.

The crank starts with some speed and is left alone. The torsional inerter, between the ground and
the crank about the joint's axis, evens its speed out. Prints the spread of the speed and how well
energy is kept.
"""

from __future__ import annotations

from typing import Any

import exudyn as exu
import numpy as np
from exudyn.rigidBodyUtilities import InertiaCuboid
from inerter.exudyn import CreateInerter

CRANK, ROD, SPEED = 0.1, 0.4, 20.0


def build(inertance: float) -> tuple[Any, Any, list[Any], Any]:
    """System, container, moving bodies, the torsional device; inertance in kg m^2."""
    container = exu.SystemContainer()
    mbs: Any = container.AddSystem()
    ground = mbs.CreateGround()
    spin = SPEED * CRANK / ROD
    bar = {"density": 7800.0, "sideLengths": [CRANK, 0.02, 0.02]}
    crank = mbs.CreateRigidBody(
        inertia=InertiaCuboid(**bar),
        referencePosition=[CRANK / 2, 0, 0],
        initialVelocity=[0, SPEED * CRANK / 2, 0],
        initialAngularVelocity=[0, 0, SPEED],
    )
    rod = mbs.CreateRigidBody(
        inertia=InertiaCuboid(**{**bar, "sideLengths": [ROD, 0.02, 0.02]}),
        referencePosition=[CRANK + ROD / 2, 0, 0],
        initialVelocity=[0, SPEED * CRANK / 2, 0],
        initialAngularVelocity=[0, 0, -spin],
    )
    slider = mbs.CreateRigidBody(
        inertia=InertiaCuboid(7800.0, [0.05, 0.05, 0.05]),
        referencePosition=[CRANK + ROD, 0, 0],
    )
    axis = [0, 0, 1]
    mbs.CreateRevoluteJoint(itemNumbers=[ground, crank], position=[0, 0, 0], axis=axis)
    mbs.CreateRevoluteJoint(itemNumbers=[crank, rod], position=[CRANK, 0, 0], axis=axis)
    # free about one axis more, so that nothing is held twice
    mbs.CreateGenericJoint(
        itemNumbers=[rod, slider], position=[CRANK + ROD, 0, 0], constrainedAxes=[1, 1, 0, 0, 0, 0]
    )
    mbs.CreateGenericJoint(
        itemNumbers=[ground, slider],
        position=[CRANK + ROD, 0, 0],
        constrainedAxes=[0, 1, 1, 1, 1, 1],
    )
    strut = CreateInerter(mbs, "inerter", [ground, crank], axis=axis, inertance=inertance)
    mbs.Assemble()
    return mbs, container, [crank, rod, slider], strut


def energy(mbs: Any, bodies: list[Any], strut: Any) -> float:
    """Kinetic energy of the bodies and of the device [J]."""
    total = strut.Evaluate()["stored_energy"]
    for body in bodies:
        velocity, turning = (
            mbs.GetObjectOutputBody(body, kind, [0, 0, 0])
            for kind in (
                exu.OutputVariableType.Velocity,
                exu.OutputVariableType.AngularVelocityLocal,
            )
        )
        told = mbs.GetObject(body)
        i = told["inertia"] if "inertia" in told else told["physicsInertia"]
        mass = told["mass"] if "mass" in told else told["physicsMass"]
        total += 0.5 * mass * velocity @ velocity + 0.5 * i[:3] @ turning**2
    return float(total)


def main() -> dict[float, float]:
    """Spread of the crank's speed, relative to its mean, by inertance [kg m^2]."""
    spreads = {}
    for inertance in (0.0, 0.1):
        mbs, _container, bodies, strut = build(inertance)
        sensor = strut.AddSensor("velocity")
        mbs.Assemble()
        before = energy(mbs, bodies, strut)
        settings = exu.SimulationSettings()
        settings.timeIntegration.numberOfSteps = 4000
        settings.timeIntegration.endTime = 1.0
        settings.timeIntegration.verboseMode = 0
        settings.timeIntegration.generalizedAlpha.spectralRadius = 0.9
        settings.solution.file.write = False
        settings.solution.sensors.writePeriod = 1e-3
        mbs.SolveDynamic(settings)
        speed = mbs.GetSensorStoredData(sensor)[:, 1]
        spreads[inertance] = float((speed.max() - speed.min()) / speed.mean())
        lost = energy(mbs, bodies, strut) / before - 1.0
        assert abs(lost) < 1e-3, lost
        turns = strut.Evaluate()["displacement"] / 2 / np.pi
        print(
            f"b = {inertance} kg m^2: speed varies by {spreads[inertance]:.1%} in {turns:.1f} "
            f"turns, energy by {lost:.1e}"
        )
    return spreads


if __name__ == "__main__":
    main()
