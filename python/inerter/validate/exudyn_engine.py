"""A case in Exudyn: the shipped model, the law in its inerters, inputs as loads.

DOPRI5 chooses its own steps; its samples are where its steps end, so that a run carries its own
times and the truth is asked for at those. Its tolerance is absolute alone:
Exudyn 1.13 scales the relative one with the larger of the old and the new value, not of their
sizes, so that for negative values it shrinks and can pass through zero.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from inerter.models import exudyn_model
from inerter.validate.case import SAMPLE, Case
from inerter.validate.run import Array, RunError, ValidationRun

ORDERS = {"RK44": 4.0, "DOPRI5": None, "RK67": 6.0, "GeneralizedAlpha": 2.0}
"""The integrators and their nominal orders; a method with adaptive steps has none."""

INTEGRATORS = tuple(ORDERS)

LATE = (
    "load friction goes with a force that depends on the acceleration being solved for, of which "
    "the element knows the last one: late by a stage, of order 1 to 2 with explicit solvers"
)
"""What limits the element where `is_late`."""

TOLERANCE = 1e-10
"""Absolute tolerance of DOPRI5 [m, m/s, rad ...], for motions of the reference's size."""


def is_late(case: Case, integrator: str) -> bool:
    """Whether the element works with the acceleration of an evaluation before, see `LATE`.

    An adaptive solver sees no error there that it could adapt to, so DOPRI5 takes fixed steps.
    """
    device = case.device() or {}
    rigid = not {"series_stiffness", "series_damping"} & device.keys()
    loaded = {"load_friction", "mu_forward", "mu_backward"} & device.keys()
    return bool(loaded) and rigid and integrator != "GeneralizedAlpha"


def run_exudyn(case: Case, integrator: str, step: float) -> ValidationRun:
    """Run a case.

    Parameters
    ----------
    case
        What to run.
    integrator
        One of `INTEGRATORS`.
    step
        Time step [s]; the first one of DOPRI5.

    Raises
    ------
    RunError
        The solver gave up or diverged.
    """
    import exudyn as exu

    setup, scale = case.setup, case.setup.scale
    container = exu.SystemContainer()
    mbs: Any = container.AddSystem()
    model = exudyn_model(setup.folder).build(
        mbs,
        device=case.device(scale),
        inputs=case.signals(scale),
        **(setup.variant or {"layout": setup.layout}),
    )
    motion = {
        (name, kind): mbs.AddSensor(_node_sensor(exu, model.coordinates[name][0], kind))
        for name in setup.coordinates
        for kind in ("Coordinates", "Coordinates_t")
    }
    inerters = [model.inerters[name] for name in setup.inerters]
    force = [inerter.AddSensor("total") for inerter in inerters]
    energy = [inerter.AddSensor("stored_energy") for inerter in inerters]
    states = {
        (i, name): inerter.AddSensor(name)
        for i, inerter in enumerate(inerters)
        for name in inerter.device.state_names
    }
    mbs.Assemble()
    told = case.command(scale)
    for inerter in inerters if not math.isnan(told) else ():
        inerter.SetControl(told)
    settings = _settings(exu, case, integrator, step)
    try:
        done = mbs.SolveDynamic(settings, solverType=getattr(exu.DynamicSolverType, integrator))
    except (RuntimeError, ValueError) as error:
        raise RunError(" ".join(str(error).split())[:200]) from None
    if not done:
        raise RunError(f"{integrator} did not reach {case.duration:g} s")

    def read(sensor: Any, column: int = 0) -> Array:
        return np.array(mbs.GetSensorStoredData(sensor)[1:, 1 + column], dtype=np.float64)

    def coordinates(kind: str) -> Array:
        found = [read(motion[name, kind], model.coordinates[name][1]) for name in setup.coordinates]
        return np.column_stack(found) / scale

    time = read(next(iter(motion.values())), -1)
    nothing = np.empty((time.size, 0))
    run = ValidationRun(
        time=np.clip(time, 0.0, case.duration),
        displacement=coordinates("Coordinates"),
        velocity=coordinates("Coordinates_t"),
        force=np.column_stack([read(s) for s in force]) / scale if force else nothing,
        state={key: read(s) / case.state_size(key[1], scale) for key, s in states.items()},
        energy=np.column_stack([read(s) for s in energy]) / scale**2 if energy else nothing,
    )
    if not (np.isfinite(run.displacement).all() and np.isfinite(run.force).all()):
        raise RunError("the run diverges")
    return run


def _node_sensor(exu: Any, node: Any, kind: str) -> Any:
    from exudyn.itemInterface import SensorNode

    return SensorNode(
        nodeNumber=node,
        outputVariableType=getattr(exu.OutputVariableType, kind),
        storeInternal=True,
        writeToFile=False,
    )


def _settings(exu: Any, case: Case, integrator: str, step: float) -> Any:
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = SAMPLE
    integration = settings.timeIntegration
    integration.endTime = case.duration
    adaptive = integrator == "DOPRI5" and not is_late(case, integrator)
    integration.numberOfSteps = round(case.duration / (SAMPLE if adaptive else step))
    integration.verboseMode = 0
    integration.automaticStepSize = adaptive
    integration.initialStepSize = step if adaptive else 0.0
    integration.absoluteTolerance = TOLERANCE * case.setup.scale
    integration.relativeTolerance = 0.0
    # where damped teeth meet the force jumps: a step that stays too wrong at the least one is tried
    # again without end
    integration.minimumStepSize = 1e-12
    # no damping of its own; where a contact starts and stops Newton cannot get below its jump and
    # would cut the step again and again
    integration.generalizedAlpha.spectralRadius = 1.0
    integration.newton.useModifiedNewton = True
    coarser = 1e3 if case.kind == "contact" else 1.0
    integration.newton.relativeTolerance = 1e-10 * coarser
    integration.newton.absoluteTolerance = 1e-12 * coarser * case.setup.scale
    return settings
