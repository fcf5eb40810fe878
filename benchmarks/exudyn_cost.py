"""What one step in Exudyn costs, with the element and with user functions written by hand.

Two systems: a quarter-car, and the stick-slip of Canudas de Wit et al. 1995 as one of Exudyn's
own examples states it (a first-order system in one Python function on NumPy arrays). Rounds go
through all variants in turn; a ratio is the median of the ratios within rounds.

    python -m benchmarks.exudyn_cost [--quick]
"""

from __future__ import annotations

import math
import statistics
import sys
import time
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from inerter.exudyn import CreateInerter
from inerter.exudyn.engine import exudyn

from benchmarks.step_cost import LUGRE

SOLVERS = ("RK44", "GeneralizedAlpha")
STIFFNESS, PULL = 2.0, 0.1
STICK_SLIP: dict[str, Any] = {
    "bristle_stiffness": 1e5, "bristle_damping": math.sqrt(1e5), "coulomb_force": 1.0,
    "static_force": 1.5, "stribeck_velocity": 1e-3,
}  # fmt: skip

# name: what it is compared with
VARIANTS: dict[str, str | None] = {
    "no device": None,
    "element, ideal": "no device",
    "element, LuGre": "no device",
    "element in Python, LuGre": "element, LuGre",
    "by hand in Python, LuGre": "element, LuGre",
    "element, series element": "no device",
    "element in Python, series element": "element, series element",
    "stick-slip, element": None,
    "stick-slip, Exudyn's example": "stick-slip, element",
}
ELEMENTS: dict[str, dict[str, Any]] = {
    "ideal": {},
    "LuGre": {"friction": "lugre", **LUGRE},
    "series element": {"series_stiffness": 1e6, "series_damping": 3200.0},
}


def _friction(v: float, z: float, law: dict[str, float]) -> tuple[float, float]:
    """Force and state rate of LuGre, as short as Python can say it."""
    s0, s1, fc, fs, vs = (law[key] for key in LUGRE)
    rate = v - s0 * abs(v) * z / (fc + (fs - fc) * math.exp(-((v / vs) ** 2)))
    return s0 * z + s1 * rate, rate


def _quarter_car(name: str) -> Any:
    """The car with a device; the wheel starts with 0.3 m/s."""
    items = exudyn("itemInterface")
    mbs = exudyn().SystemContainer().AddSystem()
    wheel = mbs.AddNode(items.Node1D(referenceCoordinates=[0.0], initialVelocities=[0.3]))
    body = mbs.AddNode(items.Node1D(referenceCoordinates=[0.0]))
    ground = mbs.AddNode(items.NodePointGround())
    markers = [
        mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=0))
        for node in (ground, wheel, body)
    ]
    mbs.AddObject(items.Mass1D(mass=25.0, nodeNumber=wheel))
    mbs.AddObject(items.Mass1D(mass=181.75, nodeNumber=body))
    mbs.AddObject(items.CoordinateSpringDamper(markerNumbers=markers[:2], stiffness=120e3))
    mbs.AddObject(
        items.CoordinateSpringDamper(markerNumbers=markers[1:], stiffness=60e3, damping=500.0)
    )
    if name.startswith("element"):
        CreateInerter(
            mbs, "strut", [wheel, body], inertance=113.0,
            symbolic="in Python" not in name, **ELEMENTS[name.split(", ")[1]],
        )  # fmt: skip
    if name.startswith("by hand"):
        state = mbs.AddNode(items.Node1D(referenceCoordinates=[0.0]))

        def forces(mbs: Any, t: float, item: int, q: Sequence[float], q_t: Sequence[float]) -> Any:
            force, rate = _friction(q_t[1] - q_t[0], q_t[2], LUGRE)
            return [force, -force, rate]

        mass = [[113.0, -113.0, 0.0], [-113.0, 113.0, 0.0], [0.0, 0.0, 1.0]]
        mbs.AddObject(
            items.ObjectGenericODE2(
                nodeNumbers=[wheel, body, state],
                massMatrix=np.array(mass),
                forceUserFunction=forces,
            )
        )
    return mbs


def _stick_slip(name: str) -> Any:
    """A mass pulled over a rough floor by a spring whose end moves at 0.1 m/s."""
    items = exudyn("itemInterface")
    mbs = exudyn().SystemContainer().AddSystem()
    if name.endswith("example"):
        node = mbs.AddNode(
            items.NodeGenericODE1(
                referenceCoordinates=[0.0] * 3,
                initialCoordinates=[0.0] * 3,
                numberOfODE1Coordinates=3,
            )
        )

        def rates(mbs: Any, t: float, item: int, q: Sequence[float]) -> Any:
            found = np.zeros(3)
            force, rate = _friction(q[1], q[2], STICK_SLIP)
            found[0] = q[1]
            found[1] = STIFFNESS * (PULL * t - q[0]) - force - 0.4 * q[1]
            found[2] = rate
            return found

        mbs.AddObject(items.ObjectGenericODE1(nodeNumbers=[node], rhsUserFunction=rates))
        return mbs
    mass = mbs.AddNode(items.Node1D(referenceCoordinates=[0.0]))
    mbs.AddObject(items.Mass1D(mass=1.0, nodeNumber=mass))
    marker = mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=mass, coordinate=0))
    CreateInerter(
        mbs, "floor", [None, mass], viscous=0.4, stiffness=STIFFNESS, friction="lugre",
        **STICK_SLIP,
    )  # fmt: skip
    load = mbs.AddLoad(items.LoadCoordinate(markerNumber=marker, load=1.0))
    pull = exudyn("advancedUtilities").CreateSymbolicUserFunction(
        mbs, lambda mbs, t, load: STIFFNESS * PULL * t, "loadUserFunction", load
    )
    mbs.SetLoadParameter(load, "loadUserFunction", pull)
    mbs.variables["pull"] = pull
    return mbs


def _seconds(build: Callable[[str], Any], name: str, solver: str, steps: int) -> float:
    """Time of one step."""
    engine = exudyn()
    mbs = build(name)
    mbs.Assemble()
    settings = engine.SimulationSettings()
    settings.timeIntegration.numberOfSteps = steps
    settings.timeIntegration.endTime = steps * 1e-4
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    start = time.perf_counter()
    mbs.SolveDynamic(settings, solverType=getattr(engine.DynamicSolverType, solver))
    return (time.perf_counter() - start) / steps


def run(quick: bool = False) -> list[dict[str, Any]]:
    """Measure every variant under every solver.

    Returns
    -------
    list of dict
        benchmark, solver, variant, microseconds (median), against, ratio (median within rounds).
    """
    rounds, steps = (3, 2000) if quick else (15, 10000)
    rows: list[dict[str, Any]] = []
    for solver in SOLVERS:
        times: dict[str, list[float]] = {name: [] for name in VARIANTS}
        for round_ in range(-1, rounds):  # the first one warms up
            for name in VARIANTS:
                build = _stick_slip if name.startswith("stick-slip") else _quarter_car
                seconds = _seconds(build, name, solver, steps)
                if round_ >= 0:
                    times[name].append(seconds)
        for name, against in VARIANTS.items():
            pairs = zip(times[name], times[against], strict=True) if against else ()
            rows.append(
                {
                    "benchmark": "exudyn_cost",
                    "solver": solver,
                    "variant": name,
                    "microseconds": 1e6 * statistics.median(times[name]),
                    "against": against,
                    "ratio": statistics.median(a / b for a, b in pairs) if against else None,
                }
            )
    return rows


if __name__ == "__main__":
    for row in run("--quick" in sys.argv):
        print(*row.values(), sep="\t")
