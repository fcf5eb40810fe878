"""A cantilever of ANCF cable elements with a tuned inerter damper at its tip.

The device is an inertance behind a spring and a damper; CreateInerter holds it to the beam by a
massless point. Prints how much of the tip's motion is left after a second, with it and without.
"""

from __future__ import annotations

import warnings
from typing import Any

import exudyn
import numpy as np
from exudyn.beams import GenerateStraightLineANCFCable2D
from exudyn.itemInterface import ObjectANCFCable2D, SensorNode
from inerter.exudyn import CreateInerter

# what it says of its own types lacks much
exu: Any = exudyn
LENGTH, BENDING, DENSITY = 2.0, 200.0, 1.5
FIRST = 1.8751040687**2 * np.sqrt(BENDING / DENSITY) / LENGTH**2
"""First frequency of a cantilever [rad/s]."""
MODAL = DENSITY * LENGTH / 4.0
"""Modal mass at the tip [kg]."""


def tip_motion(inertance: float) -> np.ndarray:
    """The tip's displacement over a second [m], after a pull that is let go."""
    container = exu.SystemContainer()
    mbs: Any = container.AddSystem()
    template = ObjectANCFCable2D(
        massPerLength=DENSITY, bendingStiffness=BENDING, axialStiffness=1e6
    )
    # Exudyn's own helper still uses names that Exudyn has given up
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)
        nodes, cables, *_ = GenerateStraightLineANCFCable2D(
            mbs, [0, 0, 0], [LENGTH, 0, 0], 8, template, [0, 0, 0], [1, 1, 0, 1]
        )
    for node in nodes:
        # a parabola whose tip moves at 0.5 m/s
        told = mbs.GetNode(node)
        x = told["referenceCoordinates"][0] / LENGTH
        mbs.SetNodeParameter(node, "initialVelocities", [0.0, 0.5 * x**2, 0.0, 1.0 * x / LENGTH])
    if inertance:
        stiffness = inertance * FIRST**2
        CreateInerter(
            mbs, "damper", [cables[-1], None],
            localPosition0=[LENGTH / 8, 0, 0], localPosition1=[LENGTH, -0.5, 0],
            inertance=inertance, series_stiffness=stiffness,
            series_damping=0.35 * np.sqrt(stiffness * inertance),
        )  # fmt: skip
    sensor = mbs.AddSensor(
        SensorNode(
            nodeNumber=nodes[-1],
            outputVariableType=exu.OutputVariableType.Displacement,
            storeInternal=True,
        )
    )
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = 2000
    settings.timeIntegration.endTime = 2.0
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.6
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 1e-3
    mbs.SolveDynamic(settings)
    return mbs.GetSensorStoredData(sensor)[:, 2]


def main() -> dict[float, float]:
    """Share of the first swing that is left in the last half second, by inertance [kg]."""
    left = {}
    for inertance in (0.0, 0.1 * MODAL):
        swing = np.abs(tip_motion(inertance))
        left[inertance] = float(swing[-500:].max() / swing.max())
        print(f"b = {inertance:.3f} kg: {left[inertance]:.0%} of the swing is left")
    return left


if __name__ == "__main__":
    main()
