"""Linear analysis and static solutions, against closed forms."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

pytest.importorskip("exudyn.itemInterface")

from element_systems import coordinate, empty, exu
from exudyn import itemInterface
from inerter.exudyn import CreateInerter

MASS, SPRING, PULL = 2.0, 200.0, 7.0
INERTANCE, SHAFT = 3.0, 500.0
KINDS = pytest.mark.parametrize("kind", ["line", "points"])
BRISTLE: dict[str, Any] = {
    "friction": "lugre", "bristle_stiffness": 1e4, "bristle_damping": 50.0, "coulomb_force": 10.0,
}  # fmt: skip
DEVICES: dict[str, dict[str, Any]] = {
    "ideal": {},
    "shaft": {"series_stiffness": SHAFT},
    "damper alone": {"series_damping": 4.0},
    "play": {"series_stiffness": SHAFT, "series_damping": 5.0, "backlash": 1e-4},
    "lugre": BRISTLE,
    "everything": {
        "series_stiffness": SHAFT, "inertance_gradient": 0.1, "dissipatedEnergy": True, **BRISTLE,
    },
}  # fmt: skip


def pulled(kind: str, **device: Any) -> tuple[Any, Any]:
    """A mass on a spring that is pulled, with a device beside the spring."""
    made = empty()
    mbs = made.mbs
    if kind == "line":
        node = mbs.AddNode(itemInterface.Node1D(referenceCoordinates=[0.0]))
        mbs.AddObject(itemInterface.Mass1D(mass=MASS, nodeNumber=node))
        ends, rest = [None, node], 0.0
    else:
        mass = mbs.CreateMassPoint(referencePosition=[1.0, 0.0, 0.0], mass=MASS)
        node = mbs.GetObject(mass)["nodeNumber"]
        ends, rest = [mbs.CreateGround(), mass], 1.0
    ground = coordinate(mbs, mbs.AddNode(itemInterface.NodePointGround()))
    moving = coordinate(mbs, node)
    mbs.AddObject(
        itemInterface.CoordinateSpringDamper(markerNumbers=[ground, moving], stiffness=SPRING)
    )
    mbs.AddLoad(itemInterface.LoadCoordinate(markerNumber=moving, load=PULL))
    if kind == "points":
        for which in (1, 2):
            ends_of = [ground, coordinate(mbs, node, which)]
            mbs.AddObject(itemInterface.CoordinateConstraint(markerNumbers=ends_of))
    strut = CreateInerter(mbs, "d", ends, rest_length=rest, inertance=INERTANCE, **device)
    mbs.Assemble()
    # the container owns the system
    mbs.variables["container"] = made.container
    return mbs, strut


def frequencies(mbs: Any) -> Any:
    """Default eigenvalues as angular frequencies [rad/s], without those of pure rates."""
    found = np.sqrt(np.abs(mbs.ComputeODE2Eigenvalues(ignoreAlgebraicEquations=False)[0]))
    return np.sort(found[found > 1e-3])


@KINDS
def test_frequency_of_an_ideal_inerter(kind: str) -> None:
    mbs, _ = pulled(kind)
    np.testing.assert_allclose(frequencies(mbs), [np.sqrt(SPRING / (MASS + INERTANCE))], rtol=1e-6)


@KINDS
@pytest.mark.parametrize("name", ["shaft", "everything"])
def test_frequencies_with_a_shaft(kind: str, name: str) -> None:
    """Two masses, two springs: by the default computation, without asking for complex values."""
    mbs, _ = pulled(kind, **DEVICES[name])
    stiffness = np.array([[SPRING + SHAFT, -SHAFT], [-SHAFT, SHAFT]])
    true = np.linalg.eigvals(np.linalg.solve(np.diag([MASS, INERTANCE]), stiffness))
    np.testing.assert_allclose(frequencies(mbs), np.sort(np.sqrt(true)), rtol=1e-5)


@KINDS
def test_a_sticking_bristle_is_in_the_complex_ones(kind: str) -> None:
    mbs, _ = pulled(kind, **BRISTLE)
    found = mbs.ComputeODE2Eigenvalues(
        computeComplexEigenvalues=True, ignoreAlgebraicEquations=False
    )[0]
    expected = np.sqrt((SPRING + BRISTLE["bristle_stiffness"]) / (MASS + INERTANCE))
    assert np.max(np.abs(found)) == pytest.approx(expected, rel=1e-3)


@KINDS
@pytest.mark.parametrize("name", DEVICES)
def test_static_solution(kind: str, name: str) -> None:
    """The spring alone carries; the device's states hold."""
    mbs, strut = pulled(kind, **DEVICES[name])
    chosen = exu.SimulationSettings()
    chosen.solution.file.write = False
    chosen.staticSolver.verboseMode = 0
    mbs.SolveStatic(chosen)
    found = strut.Evaluate()
    assert found["displacement"] == pytest.approx(PULL / SPRING, rel=1e-8)
    assert found["total"] == pytest.approx(0.0, abs=1e-7)
