"""A cart on four rolling discs, with a torsional inerter at every axle.

An inertance between wheel and cart about the axle makes the cart harder to push, and no heavier:
a = F / (m + 4 m_w + 4 (J + b) / r^2). Prints the acceleration, and what the formula says.
"""

from __future__ import annotations

from typing import Any

import exudyn as exu
from exudyn.rigidBodyUtilities import InertiaCuboid, InertiaCylinder
from inerter.exudyn import CreateInerter

RADIUS, PUSH, GRAVITY = 0.2, 100.0, [0.0, 0.0, -9.81]
WHEEL = InertiaCylinder(density=500.0, length=0.05, outerRadius=RADIUS, axis=0)
CART = InertiaCuboid(density=200.0, sideLengths=[0.6, 1.2, 0.2])


def acceleration(inertance: float) -> float:
    """The cart's acceleration [m/s^2] from rest; inertance of each axle [kg m^2]."""
    container = exu.SystemContainer()
    mbs: Any = container.AddSystem()
    ground = mbs.CreateGround()
    cart = mbs.CreateRigidBody(inertia=CART, referencePosition=[0, 0, RADIUS], gravity=GRAVITY)
    for x, y in ((0.4, 0.5), (-0.4, 0.5), (0.4, -0.5), (-0.4, -0.5)):
        place = [x, y, RADIUS]
        wheel = mbs.CreateRigidBody(inertia=WHEEL, referencePosition=place, gravity=GRAVITY)
        mbs.CreateRevoluteJoint(itemNumbers=[cart, wheel], position=place, axis=[1, 0, 0])
        mbs.CreateRollingDiscPenalty(
            bodyNumbers=[ground, wheel], discRadius=RADIUS, axisPosition=[0, 0, 0],
            axisVector=[1, 0, 0],
            contactStiffness=1e5, contactDamping=1e3, dryFriction=[0.9, 0.9],
            dryFrictionProportionalZone=1e-3,
        )  # fmt: skip
        CreateInerter(mbs, f"axle {x} {y}", [cart, wheel], axis=[1, 0, 0], inertance=inertance)
    mbs.CreateForce(itemNumber=cart, loadVector=[0.0, PUSH, 0.0])
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = 2000
    settings.timeIntegration.endTime = 1.0
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.7
    settings.solution.file.write = False
    mbs.SolveDynamic(settings)
    speed = mbs.GetObjectOutputBody(cart, exu.OutputVariableType.Velocity, [0, 0, 0])
    return float(speed[1])


def main() -> dict[float, tuple[float, float]]:
    """Acceleration and what the formula says [m/s^2], by inertance [kg m^2]."""
    found = {}
    for inertance in (0.0, 0.5):
        turning = WHEEL.InertiaCOM()[0, 0] + inertance
        mass = CART.Mass() + 4.0 * WHEEL.Mass() + 4.0 * turning / RADIUS**2
        found[inertance] = (acceleration(inertance), PUSH / mass)
        print(f"b = {inertance} kg m^2: {found[inertance][0]:.4f}, {found[inertance][1]:.4f} m/s^2")
    return found


if __name__ == "__main__":
    main()
