"""The programs of the work-precision comparison: each takes a setting and runs the car for 10 s.

A solver's settings go from coarse to fine: steps [s] or tolerances. Building a model is not timed.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
from inerter.benchmark.cars import CARS, car_xml
from inerter.benchmark.laws import INERTANCE, LAWS
from inerter.benchmark.timing import Work
from inerter.exudyn.engine import exudyn
from inerter.exudyn.engine import installed as has_exudyn
from inerter.reference import QuarterCar, ReferenceDevice
from scipy.integrate import odeint, solve_ivp

from benchmarks.precision_car import (
    DAMPING,
    DURATION,
    SPEED,
    SPRING,
    SPRUNG,
    TYRE,
    UNSPRUNG,
    Array,
    rates,
    start,
)


@dataclass(frozen=True)
class Attempt:
    """A run to be timed, and where the car is after it: (zs, zu) [m]."""

    work: Work
    end: Callable[[], Array]


@dataclass(frozen=True)
class Solver:
    """A program with one of its methods.

    `ours` where the device is this project's plugin or element; `problems` what it can.
    """

    name: str
    ours: bool
    settings: Sequence[float]
    attempt: Callable[[str, float], Attempt]
    problems: tuple[str, ...] = ("ideal", "lugre")


# coarse to fine, halved
STEPS = [2e-3 * 2.0**-k for k in range(14)]
TOLERANCES = [10.0 ** (-2 - k) for k in range(12)]


def solvers() -> list[Solver]:
    """What can run here."""
    found = [
        *(_mujoco(name) for name in ("Euler", "implicitfast", "discrete", "RK4")),
        *(_scipy(method) for method in ("LSODA", "Radau", "DOP853")),
        Solver("SciPy odeint", False, TOLERANCES, _odeint),
        Solver("SciPy LSODA, reference ODE", False, TOLERANCES, _reference),
    ]
    if has_exudyn():
        found += [
            _exudyn("RK44", "element"), _exudyn("GeneralizedAlpha", "element"),
            _exudyn("DOPRI5", "element"), _exudyn("RK67", "element"), _exudyn("RK44", "by hand"),
        ]  # fmt: skip
    if _opensees() is not None:
        found.append(Solver("OpenSees Newmark", False, STEPS, _newmark, ("ideal",)))
    return found


def absent() -> list[str]:
    """What cannot run here, and why."""
    reasons = []
    if not has_exudyn():
        reasons.append("Exudyn is left out: pip install exudyn")
    if _opensees() is None:
        reasons.append(
            "OpenSees is left out: pip install openseespy (on Debian with libblas3 and liblapack3)"
        )
    return reasons


# --------------------------- MuJoCo ---------------------------------------------------------------


def _mujoco(integrator: str) -> Solver:
    def attempt(problem: str, step: float) -> Attempt:
        made = "plugin none" if problem == "ideal" else "plugin lugre"
        model = mujoco.MjModel.from_xml_string(car_xml("quarter-car", made, integrator))
        model.opt.timestep = step
        model.tendon_damping[model.tendon("strut0").id] = DAMPING
        data, steps = mujoco.MjData(model), round(DURATION / step)

        def prepare() -> None:
            mujoco.mj_resetData(model, data)
            # the wheel stands in the body
            data.qvel[:] = [0.0, SPEED]

        def end() -> Array:
            return np.cumsum(data.qpos)

        return Attempt(Work(lambda: mujoco.mj_step(model, data, steps), prepare=prepare), end)

    assert CARS["quarter-car"].wheels[0].stiffness == SPRING
    return Solver(f"MuJoCo plugin, {integrator}", True, STEPS, attempt)


# --------------------------- SciPy ----------------------------------------------------------------


def _held(run: Callable[[], Array]) -> Attempt:
    """An attempt that keeps what a function returns: displacements at the end."""
    kept: list[Array] = []

    def timed() -> None:
        kept[:] = [run()]

    return Attempt(Work(timed), lambda: kept[0])


def _scipy(method: Any) -> Solver:
    def attempt(problem: str, tolerance: float) -> Attempt:
        right, first = rates(problem), start(problem)

        def run() -> Array:
            done = solve_ivp(
                right, (0.0, DURATION), first, method=method, t_eval=[DURATION], rtol=tolerance,
                atol=1e-3 * tolerance,
            )  # fmt: skip
            return done.y[:2, -1]

        return _held(run)

    return Solver(f"SciPy {method}", False, TOLERANCES, attempt)


def _odeint(problem: str, tolerance: float) -> Attempt:
    """LSODA too, but its loop is in Fortran."""
    right, first = rates(problem), start(problem)

    def run() -> Array:
        path = odeint(
            right, first, [0.0, DURATION], rtol=tolerance, atol=1e-3 * tolerance, mxstep=10**7,
            tfirst=True,
        )  # fmt: skip
        return path[-1, :2]

    return _held(run)


def _reference(problem: str, tolerance: float) -> Attempt:
    """The package's own readable equations."""
    law = {} if problem == "ideal" else {"friction": "lugre", **LAWS["lugre"]}
    car = QuarterCar(damping=DAMPING, device=ReferenceDevice(inertance=INERTANCE, **law))
    first = np.array(start(problem))

    def right(t: float, state: Array) -> Array:
        return car.rates(state, 0.0)

    def run() -> Array:
        done = solve_ivp(
            right, (0.0, DURATION), first, method="LSODA", t_eval=[DURATION], rtol=tolerance,
            atol=1e-3 * tolerance,
        )  # fmt: skip
        return done.y[:2, -1]

    return _held(run)


# --------------------------- Exudyn ---------------------------------------------------------------


def _exudyn(method: str, made: str) -> Solver:
    def attempt(problem: str, setting: float) -> Attempt:
        engine, kept = exudyn(), []
        settings = _exudyn_settings(method, setting)

        def prepare() -> None:
            mbs = exudyn().SystemContainer().AddSystem()
            read = _with_element(mbs, problem) if made == "element" else _by_hand(mbs, problem)
            mbs.Assemble()
            kept[:] = [mbs, read]

        def run() -> None:
            solver = getattr(engine.DynamicSolverType, method)
            kept[0].SolveDynamic(settings, solverType=solver)

        return Attempt(Work(run, prepare=prepare), lambda: kept[1]())

    text = "symbolic element" if made == "element" else "Python user function"
    # of order 6: coarse steps do
    steps = [8 * STEPS[0], 4 * STEPS[0], 2 * STEPS[0], *STEPS] if method == "RK67" else STEPS
    settings = TOLERANCES if method == "DOPRI5" else steps
    return Solver(f"Exudyn {text}, {method}", made == "element", settings, attempt)


def _exudyn_settings(method: str, setting: float) -> Any:
    settings = exudyn().SimulationSettings()
    settings.solution.file.write = False
    integration = settings.timeIntegration
    integration.endTime = DURATION
    integration.verboseMode = 0
    adaptive = method == "DOPRI5"
    integration.numberOfSteps = 100 if adaptive else round(DURATION / setting)
    integration.automaticStepSize = adaptive
    if adaptive:
        integration.initialStepSize = 1e-4
        integration.minimumStepSize = 1e-9
        # its relative tolerance fails for negative values
        integration.absoluteTolerance = setting
        integration.relativeTolerance = 0.0
    # nobody reads accelerations
    integration.explicit.computeEndOfStepAccelerations = False
    integration.generalizedAlpha.spectralRadius = 1.0
    integration.newton.useModifiedNewton = True
    return settings


def _with_element(mbs: Any, problem: str) -> Callable[[], Array]:
    """The car with this project's element; what reads its displacements."""
    from inerter.exudyn import CreateInerter

    items = exudyn("itemInterface")
    wheel = mbs.AddNode(items.Node1D(referenceCoordinates=[0.0], initialVelocities=[SPEED]))
    body = mbs.AddNode(items.Node1D(referenceCoordinates=[0.0]))
    ground = mbs.AddNode(items.NodePointGround())
    ends = [
        mbs.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=0))
        for node in (ground, wheel, body)
    ]
    mbs.AddObject(items.Mass1D(mass=UNSPRUNG, nodeNumber=wheel))
    mbs.AddObject(items.Mass1D(mass=SPRUNG, nodeNumber=body))
    mbs.AddObject(items.CoordinateSpringDamper(markerNumbers=ends[:2], stiffness=TYRE))
    mbs.AddObject(
        items.CoordinateSpringDamper(markerNumbers=ends[1:], stiffness=SPRING, damping=DAMPING)
    )
    law = {} if problem == "ideal" else {"friction": "lugre", **LAWS["lugre"]}
    CreateInerter(mbs, "strut", [wheel, body], inertance=INERTANCE, **law)
    what = exudyn().OutputVariableType.Coordinates
    # one coordinate comes as a number
    return lambda: np.array([np.ravel(mbs.GetNodeOutput(n, what))[0] for n in (body, wheel)])


def _by_hand(mbs: Any, problem: str) -> Callable[[], Array]:
    """The same equations that SciPy gets, as the user function of a first-order object."""
    items, first, right = exudyn("itemInterface"), start(problem), rates(problem)
    node = mbs.AddNode(
        items.NodeGenericODE1(
            referenceCoordinates=[0.0] * len(first),
            initialCoordinates=first,
            numberOfODE1Coordinates=len(first),
        )
    )

    def user_function(mbs: Any, t: float, item: int, q: Sequence[float]) -> Any:
        return right(t, q)

    mbs.AddObject(items.ObjectGenericODE1(nodeNumbers=[node], rhsUserFunction=user_function))
    what = exudyn().OutputVariableType.Coordinates
    return lambda: np.asarray(mbs.GetNodeOutput(node, what))[:2]


# --------------------------- OpenSees -------------------------------------------------------------


def _opensees() -> Any:
    """The interpreter of OpenSees, or None."""
    try:
        return importlib.import_module("openseespy.opensees")
    except (ImportError, RuntimeError):
        # its package turns a missing library into the latter
        return None


def _newmark(problem: str, step: float) -> Attempt:
    """Average acceleration, `InertiaTruss`; it starts with the acceleration of the equations."""
    ops = _opensees()
    _, _, *acceleration = rates(problem)(0.0, start(problem))

    def prepare() -> None:
        ops.wipe()
        ops.model("basic", "-ndm", 1, "-ndf", 1)
        for tag in range(3):
            ops.node(tag, float(tag))
        ops.fix(0, 1)
        # ground, wheel, body on a line, 1 m apart: a bar of area 1 and modulus E is a spring E
        ops.mass(1, UNSPRUNG)
        ops.mass(2, SPRUNG)
        ops.uniaxialMaterial("Elastic", 1, TYRE)
        ops.uniaxialMaterial("Elastic", 2, SPRING, DAMPING)
        ops.element("Truss", 1, 0, 1, 1.0, 1)
        ops.element("Truss", 2, 1, 2, 1.0, 2)
        ops.element("InertiaTruss", 3, 1, 2, INERTANCE)
        for tag, speed, a in ((1, SPEED, acceleration[1]), (2, 0.0, acceleration[0])):
            ops.setNodeVel(tag, 1, speed, "-commit")
            ops.setNodeAccel(tag, 1, a, "-commit")
        ops.constraints("Plain")
        ops.numberer("Plain")
        ops.system("FullGeneral")
        ops.algorithm("Linear")
        ops.integrator("Newmark", 0.5, 0.25)
        ops.analysis("Transient")

    work = Work(lambda: ops.analyze(round(DURATION / step), step), prepare=prepare)
    return Attempt(work, lambda: np.array([ops.nodeDisp(2, 1), ops.nodeDisp(1, 1)]))
