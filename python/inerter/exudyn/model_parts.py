"""What the shipped Exudyn models share: arguments, connectors of one coordinate, runs, pictures."""

from __future__ import annotations

import difflib
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import exudyn as exu
import exudyn.solver
import numpy as np
from exudyn.itemInterface import (
    CoordinateSpringDamper,
    LoadCoordinate,
    MarkerNodeCoordinate,
    NodePointGround,
    SensorNode,
)
from numpy.typing import NDArray

from inerter.core import Device

Array = NDArray[np.float64]
Drive = Callable[[float], float]
LAYOUTS = ("S1", "S2", "S3")


@dataclass(frozen=True)
class Model:
    """A model in `mbs`, not yet assembled.

    `coordinates`: name -> (node number, coordinate of that node), displacements from equilibrium
    in the order of the reference model. `inerters`: name -> what `CreateInerter` returned.
    """

    mbs: Any
    coordinates: dict[str, tuple[Any, int]]
    inerters: dict[str, Any]


@dataclass(frozen=True)
class Run:
    """A simulated run: `time` (times,) [s]; by name, arrays (times,) in SI units.

    `displacement` and `velocity` of the model's coordinates, `force` of its inerters.
    """

    time: Array
    displacement: dict[str, Array]
    velocity: dict[str, Array]
    force: dict[str, Array]


def named(what: str, given: Mapping[str, Any] | None, names: Sequence[str]) -> dict[str, Any]:
    """What was given by name, as a dict; a name that is not among `names` is a ValueError."""
    found = dict(given or {})
    for name in found:
        if name not in names:
            near = difflib.get_close_matches(name, names, n=1)
            hint = f"; did you mean {near[0]!r}?" if near else ""
            raise ValueError(f"{what}: no {name!r}, there is {', '.join(names)}{hint}")
    return found


def chosen(what: str, value: str, values: Iterable[str]) -> str:
    """The value, if it is one of the values, else ValueError."""
    if value not in values:
        raise ValueError(f"{what}: {value!r} is not one of {', '.join(values)}")
    return value


def device_parameters(
    layout: str, device: Mapping[str, Any] | None, inertance: float
) -> dict[str, Any]:
    """Parameters of the device in a strut: those given, else an ideal inerter [kg]; {} in S1.

    Raises
    ------
    ValueError
        An unknown layout, or a device for S1, which has none.
    """
    chosen("layout", layout, LAYOUTS)
    if layout == "S1" and device is not None:
        raise ValueError("device: layout S1 has no inerter; choose S2 or S3, or give no device")
    if layout == "S1":
        return {}
    return {"inertance": inertance} if device is None else dict(device)


def flywheel_at_rest(parameters: Mapping[str, Any]) -> dict[str, float]:
    """Initial states as in the other simulators, where a flywheel behind a shaft starts at rest."""
    there = "flywheel_velocity" in Device(**parameters).state_names
    return {"flywheel_velocity": 0.0} if there else {}


def coordinate_marker(mbs: Any, node: Any, coordinate: int = 0) -> Any:
    """Marker on a coordinate of a node, or on the ground for None."""
    if node is None:
        node = mbs.AddNode(NodePointGround())
    return mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate))


def spring_damper(
    mbs: Any,
    name: str,
    nodes: tuple[Any, Any],
    coordinates: tuple[int, int] = (0, 0),
    *,
    stiffness: float = 0.0,
    damping: float = 0.0,
) -> Any:
    """CoordinateSpringDamper between coordinates of two nodes, None for the ground."""
    markers = [coordinate_marker(mbs, *end) for end in zip(nodes, coordinates, strict=True)]
    return mbs.AddObject(
        CoordinateSpringDamper(
            name=name, markerNumbers=markers, stiffness=stiffness, damping=damping
        )
    )


def drive_coordinate(
    mbs: Any, name: str, node: Any, drive: Drive | None, gain: float, coordinate: int = 0
) -> None:
    """Load `gain` times the input `drive`(time [s]) on a coordinate; nothing without input."""
    if drive is None:
        return

    def push(mbs: Any, t: float, load: float) -> float:
        return load * float(drive(t))

    marker = coordinate_marker(mbs, node, coordinate)
    mbs.AddLoad(LoadCoordinate(name=name, markerNumber=marker, load=gain, loadUserFunction=push))


def tyre(
    mbs: Any,
    name: str,
    node: Any,
    stiffness: float,
    drive: Drive | None,
    coordinate: int = 0,
    static_load: float | None = None,
) -> None:
    """Tyre k (zr - w) between a wheel's coordinate and the road `drive`(time [s]) [m].

    With a `static_load` [N] it leaves the road where it would have to pull by more.
    """
    if static_load is None:
        spring_damper(mbs, f"tyre{name}", (None, node), (0, coordinate), stiffness=stiffness)
        drive_coordinate(mbs, f"road{name}", node, drive, stiffness, coordinate)
        return
    load, road = float(static_load), drive or _flat

    def pull(
        mbs: Any,
        t: float,
        itemNumber: int,
        displacement: float,
        velocity: float,
        stiffness: float,
        damping: float,
        offset: float,
    ) -> float:
        return min(stiffness * (displacement - float(road(t))), load)

    markers = [coordinate_marker(mbs, None), coordinate_marker(mbs, node, coordinate)]
    mbs.AddObject(
        CoordinateSpringDamper(
            name=f"tyre{name}",
            markerNumbers=markers,
            stiffness=stiffness,
            springForceUserFunction=pull,
        )
    )


def _flat(_: float) -> float:
    return 0.0


def simulation_settings(end_time: float, step: float, write_period: float) -> Any:
    """Settings for a run with a fixed step, sensors every `write_period` [s], no files written.

    Generalized-alpha is set to no damping of its own and to a Newton that goes to rounding.
    """
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = write_period
    integration = settings.timeIntegration
    integration.endTime = end_time
    integration.numberOfSteps = round(end_time / step)
    integration.automaticStepSize = False
    integration.generalizedAlpha.spectralRadius = 1.0
    integration.newton.relativeTolerance = 1e-12
    integration.newton.absoluteTolerance = 1e-13
    return settings


def simulate(
    model: Model,
    end_time: float,
    step: float = 1e-3,
    write_period: float = 1e-2,
    solver: str = "RK44",
    settings: Any = None,
) -> Run:
    """Assemble a model and run it.

    Parameters
    ----------
    model
        From `build`, not yet assembled.
    end_time, step, write_period
        End, time step and spacing of the answer [s].
    solver
        A member of `exudyn.DynamicSolverType`: "RK44", "DOPRI5", "RK67", "GeneralizedAlpha".
    settings
        Simulation settings in place of `simulation_settings(end_time, step, write_period)`.

    Raises
    ------
    RuntimeError
        The solver gave up.
    """
    mbs = model.mbs
    sensors = {
        (name, kind): mbs.AddSensor(
            SensorNode(
                nodeNumber=node,
                outputVariableType=getattr(exu.OutputVariableType, kind),
                storeInternal=True,
                writeToFile=False,
            )
        )
        for name, (node, _) in model.coordinates.items()
        for kind in ("Coordinates", "Coordinates_t")
    }
    forces = {name: inerter.AddSensor("total") for name, inerter in model.inerters.items()}
    mbs.Assemble()
    chosen_settings = settings or simulation_settings(end_time, step, write_period)
    # Exudyn counts the vectors that user functions hand over, and warns of them in long runs
    threshold = exudyn.solver.solverCheckMemoryAllocationsThreshold
    exudyn.solver.solverCheckMemoryAllocationsThreshold = sys.maxsize
    try:
        done = mbs.SolveDynamic(chosen_settings, solverType=getattr(exu.DynamicSolverType, solver))
    finally:
        exudyn.solver.solverCheckMemoryAllocationsThreshold = threshold
    if not done:
        raise RuntimeError(f"{solver} did not reach {end_time} s; take a smaller step")

    def column(name: str, kind: str) -> Array:
        stored = mbs.GetSensorStoredData(sensors[name, kind])
        return np.array(stored[:, 1 + model.coordinates[name][1]])

    any_sensor = next(iter(sensors.values()))
    return Run(
        time=np.array(mbs.GetSensorStoredData(any_sensor)[:, 0]),
        displacement={name: column(name, "Coordinates") for name in model.coordinates},
        velocity={name: column(name, "Coordinates_t") for name in model.coordinates},
        force={name: np.array(mbs.GetSensorStoredData(s)[:, 1]) for name, s in forces.items()},
    )


def save_picture(name: str, run: Run, folder: str | Path = "out/exudyn_models") -> Path:
    """Draw coordinates and forces of a run over time into a PNG; returns its path."""
    # only scripts draw, matplotlib is of the lab
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8, 6), layout="constrained")
    FigureCanvasAgg(figure)
    panels = [("displacement [mm, mrad]", 1e3, run.displacement)]
    if run.force:
        panels.append(("force of the inerter [N]", 1.0, run.force))
    rows = figure.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0]
    for axes, (label, scale, curves) in zip(rows, panels, strict=True):
        for curve, values in curves.items():
            axes.plot(run.time, scale * values, label=curve)
        axes.set_ylabel(label)
        axes.legend(loc="best")
    rows[0].set_title(name)
    rows[-1].set_xlabel("time [s]")
    path = Path(folder) / f"{name}.png"
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=120)
    return path
