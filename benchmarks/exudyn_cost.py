"""What one step in Exudyn costs, with the element and with user functions written by hand.

"element in C" evaluates in the package's library instead of by matrices and Exudyn's expressions.
`exudyn_native` compares with Exudyn's own spring-dampers. Two systems: a quarter-car, and the
stick-slip of Canudas de Wit et al. 1995 as one of Exudyn's own examples states it (a first-order
system in one Python function on NumPy arrays).
"""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from typing import Any

import numpy as np
from inerter.benchmark.laws import LAWS
from inerter.benchmark.rows import Row, spread_of
from inerter.benchmark.timing import Work, interleaved
from inerter.exudyn import CreateInerter
from inerter.exudyn.engine import exudyn

KEYS = (
    "bristle_stiffness", "bristle_damping", "coulomb_force", "static_force", "stribeck_velocity",
)  # fmt: skip
LUGRE = {key: LAWS["lugre"][key] for key in KEYS}
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
    "element in C, LuGre": "element, LuGre",
    "by hand in Python, LuGre": "element, LuGre",
    "element, series element": "no device",
    "element in C, series element": "element, series element",
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
    s0, s1, fc, fs, vs = (law[key] for key in KEYS)
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
            symbolic="in C" not in name, **ELEMENTS[name.split(", ")[1]],
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


def _work(name: str, solver: str, steps: int) -> Work:
    """A run; the model is built anew for each, untimed."""
    engine, made = exudyn(), []
    build = _stick_slip if name.startswith("stick-slip") else _quarter_car

    def prepare() -> None:
        made[:] = [build(name)]
        made[0].Assemble()

    def solve() -> None:
        settings = engine.SimulationSettings()
        settings.timeIntegration.numberOfSteps = steps
        settings.timeIntegration.endTime = steps * 1e-4
        settings.timeIntegration.verboseMode = 0
        settings.solution.file.write = False
        made[0].SolveDynamic(settings, solverType=getattr(engine.DynamicSolverType, solver))

    return Work(solve, steps, prepare)


def run(quick: bool = False) -> list[Row]:
    """Measure every variant under every solver.

    Returns
    -------
    list of dict
        solver, variant, microseconds, against (another variant or None), ratio to it.
    """
    rounds, steps = (3, 1000) if quick else (15, 5000)
    rows: list[Row] = []
    for solver in SOLVERS:
        works = {name: _work(name, solver, steps) for name in VARIANTS}
        times = interleaved(works, rounds, clock=time.process_time)
        for name, against in VARIANTS.items():
            row = {
                "solver": solver, "variant": name,
                **spread_of("microseconds", times[name].spread.times(1e6)), "against": against,
            }  # fmt: skip
            empty = dict.fromkeys(("ratio", "ratio_lower", "ratio_upper"))
            ratio = spread_of("ratio", times[name].ratio(times[against])) if against else empty
            rows.append(row | ratio)
    return rows
