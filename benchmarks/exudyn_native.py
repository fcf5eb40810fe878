"""What devices cost in Exudyn, beside Exudyn's own spring-damper: points, bodies, 1D; 1, 10, 100.

Each system is a number of free pairs with a spring-damper between them; the device comes beside the
spring. With 100 pairs the linear solver is the sparse one, in both. `EMPTY` is what any element of
this kind costs at least: its user functions return constants.
"""

from __future__ import annotations

import sys
import time
from typing import Any

import numpy as np
from inerter.benchmark.rows import Row, spread_of
from inerter.benchmark.timing import Work, interleaved
from inerter.exudyn import CreateInerter
from inerter.exudyn.engine import exudyn

SOLVERS = ("RK44", "GeneralizedAlpha")
LUGRE: dict[str, Any] = {
    "friction": "lugre", "bristle_stiffness": 1e4, "bristle_damping": 50.0, "coulomb_force": 1.0,
    "static_force": 1.5, "stribeck_velocity": 0.05,
}  # fmt: skip
SHAFT: dict[str, Any] = {"series_stiffness": 5e3, "series_damping": 10.0}
NATIVE = "native spring-damper"
DEVICES: dict[str, dict[str, Any]] = {
    "ideal": {},
    "Coulomb": {"friction": "coulomb", "coulomb_force": 1.0},
    "LuGre": LUGRE,
    "series element": SHAFT,
    "series element, LuGre": {**SHAFT, **LUGRE},
}
EMPTY = "user functions of constants, no device"
SENSOR = "ideal, a sensor of force at every step"
KINDS = ("points", "bodies", "1D")
MANY = 100
STEP = 1e-4


def _pair(mbs: Any, kind: str, number: int) -> list[Any]:
    """Two free bodies, or two masses on a line."""
    items = exudyn("itemInterface")
    pair = []
    for end in (0, 1):
        place = [float(end), 0.1 * number, 0.2 * end]
        if kind == "1D":
            node = mbs.AddNode(
                items.Node1D(referenceCoordinates=[0.0], initialVelocities=[0.1 * end])
            )
            mbs.AddObject(items.Mass1D(mass=1.0 + end, nodeNumber=node))
            pair.append(node)
        elif kind == "points":
            speed = [0.1 * (1 - 2 * end), 0.2 * end, 0.05]
            pair.append(
                mbs.CreateMassPoint(referencePosition=place, initialVelocity=speed, mass=1.0 + end)
            )
        else:
            pair.append(
                mbs.CreateRigidBody(
                    inertia=exudyn("rigidBodyUtilities").InertiaCuboid(1000, [0.1, 0.2, 0.05]),
                    referencePosition=place,
                    initialVelocity=[0.1 * (1 - 2 * end), 0.2 * end, 0.05],
                    initialAngularVelocity=[0.2, 0.1, 0.3],
                    nodeType=exudyn().NodeType.RotationRxyz,
                )
            )
    return pair


def _system(kind: str, name: str, count: int) -> Any:
    items = exudyn("itemInterface")
    mbs = exudyn().SystemContainer().AddSystem()
    for number in range(count):
        pair = _pair(mbs, kind, number)
        local: dict[str, Any] = {}
        if kind == "1D":
            markers = [
                mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=0))
                for node in pair
            ]
            mbs.AddObject(
                items.CoordinateSpringDamper(markerNumbers=markers, stiffness=100.0, damping=1.0)
            )
        else:
            if kind == "bodies":
                local = {"localPosition0": [0.05, 0.02, 0.01], "localPosition1": [-0.05, 0.03, 0.0]}
            mbs.CreateSpringDamper(itemNumbers=pair, stiffness=100.0, damping=1.0, **local)
        if name == EMPTY:
            _add_empty(mbs, pair, kind)
        elif name != NATIVE:
            device = DEVICES[name.removesuffix(SENSOR) or "ideal"]
            made = CreateInerter(
                mbs, f"d{number}", pair, inertance=0.5, show=False, **local, **device
            )
            if name == SENSOR:
                made.AddSensor("total")
    return mbs


def _add_empty(mbs: Any, pair: list[Any], kind: str) -> None:
    """Between points and bodies force and mass matrix in Python, on lines an expression."""
    nodes = pair if kind == "1D" else [mbs.GetObject(body)["nodeNumber"] for body in pair]
    size = sum(len(mbs.GetNode(node)["referenceCoordinates"]) for node in nodes)
    row = np.zeros(size)
    row[[0, size // 2]] = -1.0, 1.0
    matrix, force = 0.5 * np.outer(row, row), [0.0] * size
    functions: dict[str, Any] = {"massMatrix": matrix}
    if kind == "1D":
        symbolic = exudyn("symbolic")
        functions["forceUserFunction"] = _constant_expression(mbs, symbolic, force)
    else:
        entries = matrix.tolist()
        functions["forceUserFunction"] = lambda *arguments: force
        functions["massMatrixUserFunction"] = lambda *arguments: entries
        functions["jacobianUserFunction"] = lambda *arguments: np.zeros((size, size))
    mbs.AddObject(exudyn("itemInterface").ObjectGenericODE2(nodeNumbers=nodes, **functions))


def _constant_expression(mbs: Any, symbolic: Any, force: list[float]) -> Any:
    recording = symbolic.GetRecording()
    symbolic.SetRecording(True)
    names = ("q", "q_t")
    arguments = [symbolic.Real("t", 0.0), symbolic.Real("itemNumber", 0)]
    arguments += [symbolic.Vector(name, force) for name in names]
    result = symbolic.Vector(force) + symbolic.Vector(force)
    symbolic.SetRecording(recording)
    function = symbolic.UserFunction()
    contents = {
        "functionName": "forceUserFunction", "argList": [None, *arguments],
        "argTypeList": ["MainSystem", "Real", "Index", "StdVector", "StdVector"],
        "returnValue": result, "returnType": "StdVector",
    }  # fmt: skip
    function.SetUserFunctionFromDict(mbs, contents, "forceUserFunction", None, "ObjectGenericODE2")
    return function


def _work(kind: str, name: str, count: int, solver: str, steps: int) -> Work:
    """A run; the system is built anew for each, untimed."""
    engine, made = exudyn(), []

    def prepare() -> None:
        made[:] = [_system(kind, name, count)]
        made[0].Assemble()

    def solve() -> None:
        settings = engine.SimulationSettings()
        settings.timeIntegration.numberOfSteps = steps
        settings.timeIntegration.endTime = steps * STEP
        settings.timeIntegration.verboseMode = 0
        settings.solution.file.write = False
        settings.solution.sensors.writePeriod = STEP
        if count >= MANY:
            settings.linearSolverType = engine.LinearSolverType.EigenSparse
        made[0].SolveDynamic(settings, solverType=getattr(engine.DynamicSolverType, solver))

    return Work(solve, steps, prepare)


def run(quick: bool = False) -> list[Row]:
    """Measure devices beside native spring-dampers, alternating.

    Returns
    -------
    list of dict
        solver, terminals, devices (their number), variant, microseconds a step, ratio to the native
        spring-damper's step.
    """
    solver_module = exudyn("solver")
    threshold = solver_module.solverCheckMemoryAllocationsThreshold
    # Exudyn counts the vectors that user functions hand over, and warns of them in long runs
    solver_module.solverCheckMemoryAllocationsThreshold = sys.maxsize
    try:
        return [row for kind in KINDS for row in _rows(kind, quick)]
    finally:
        solver_module.solverCheckMemoryAllocationsThreshold = threshold


def _rows(kind: str, quick: bool) -> list[Row]:
    rounds, total = (3, 300) if quick else (9, 3000)
    rows: list[Row] = []
    for solver in SOLVERS:
        for count in (1, 10) if quick else (1, 10, MANY):
            names = [NATIVE, *(DEVICES if count == 1 else ("ideal", "LuGre"))]
            names += [EMPTY, SENSOR] if count == 1 else []
            steps = max(50, total // count)
            works = {name: _work(kind, name, count, solver, steps) for name in names}
            times = interleaved(works, rounds, clock=time.process_time)
            for name in names:
                rows.append({
                    "solver": solver, "terminals": kind, "devices": count, "variant": name,
                    **spread_of("microseconds", times[name].spread.times(1e6)),
                    "against": None if name == NATIVE else NATIVE,
                    **_ratio(times, name),
                })  # fmt: skip
    return rows


def _ratio(times: Any, name: str) -> dict[str, Any]:
    if name == NATIVE:
        return dict.fromkeys(("ratio", "ratio_lower", "ratio_upper"))
    return spread_of("ratio", times[name].ratio(times[NATIVE]))
