"""A quarter-car over a kerb: the same spring and damper with an inerter beside them, and without.

Prints natural frequencies, by Exudyn's default eigenvalues, and the body's peak acceleration.
"""

from __future__ import annotations

from typing import Any

import exudyn as exu
import numpy as np
from exudyn.itemInterface import (
    CoordinateSpringDamper,
    LoadCoordinate,
    MarkerNodeCoordinate,
    Mass1D,
    Node1D,
    NodePointGround,
)
from inerter.exudyn import CreateInerter

BODY, WHEEL, SPRING, DAMPER, TYRE = 181.75, 25.0, 120e3, 1500.0, 120e3
KERB = 0.02


def build(inertance: float) -> tuple[Any, Any, Any]:
    """The system, its container, and the sensor of the body's acceleration."""
    container = exu.SystemContainer()
    mbs: Any = container.AddSystem()
    wheel, body = (mbs.AddNode(Node1D(referenceCoordinates=[0.0])) for _ in range(2))
    mbs.AddObject(Mass1D(mass=WHEEL, nodeNumber=wheel))
    mbs.AddObject(Mass1D(mass=BODY, nodeNumber=body))
    nodes = (mbs.AddNode(NodePointGround()), wheel, body)
    ground, low, high = (
        mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=0)) for node in nodes
    )
    mbs.AddObject(CoordinateSpringDamper(markerNumbers=[ground, low], stiffness=TYRE))
    mbs.AddObject(
        CoordinateSpringDamper(markerNumbers=[low, high], stiffness=SPRING, damping=DAMPER)
    )
    mbs.AddLoad(LoadCoordinate(markerNumber=low, load=TYRE * KERB))
    strut = CreateInerter(mbs, "strut", [wheel, body], inertance=inertance)
    # on one coordinate: the body's own acceleration, from the ground to it
    probe = CreateInerter(mbs, "probe", [None, body], inertance=0.0)
    sensor = probe.AddSensor("acceleration")
    mbs.Assemble()
    assert strut.symbolic
    return mbs, container, sensor


def main() -> dict[float, float]:
    """Peaks of the body's acceleration [m/s^2] by inertance [kg]."""
    peaks = {}
    for inertance in (0.0, 50.0):
        mbs, _container, sensor = build(inertance)
        found = np.sort(np.sqrt(mbs.ComputeODE2Eigenvalues()[0]))
        mass = np.array([[WHEEL + inertance, -inertance], [-inertance, BODY + inertance]])
        stiffness = np.array([[SPRING + TYRE, -SPRING], [-SPRING, SPRING]])
        true = np.sort(np.sqrt(np.linalg.eigvals(np.linalg.solve(mass, stiffness))))
        assert np.allclose(found, true, rtol=1e-6)
        settings = exu.SimulationSettings()
        settings.timeIntegration.numberOfSteps = 2000
        settings.timeIntegration.endTime = 1.0
        settings.timeIntegration.verboseMode = 0
        settings.solution.file.write = False
        settings.solution.sensors.writePeriod = 1e-3
        mbs.SolveDynamic(settings)
        peaks[inertance] = float(np.abs(mbs.GetSensorStoredData(sensor)[:, 1]).max())
        print(f"b = {inertance:4.0f} kg: {found / 2 / np.pi} Hz, peak {peaks[inertance]:.2f} m/s^2")
    return peaks


if __name__ == "__main__":
    main()
