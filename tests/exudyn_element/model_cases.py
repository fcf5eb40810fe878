"""The Exudyn models beside the reference: how each is built, started, driven, and its truth."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import exudyn as exu
import numpy as np
from inerter.exudyn.model_parts import Model, Run, simulate
from inerter.model_parameters import FLUID_INERTER, FRAME, FULL_CAR, HALF_CAR, QUARTER_CAR, SHAKER
from inerter.models import exudyn_model
from inerter.reference import (
    FRAME_DEVICE,
    FloorDevice,
    FluidInerterTest,
    FullCar,
    HalfCar,
    QuarterCar,
    ReferenceDevice,
    ShearFrame,
    Strut,
    complete_device,
    corner_of,
    dry_device,
)
from inerter.reference.structure import Structure, StructureRun
from numpy.typing import NDArray

Array = NDArray[np.float64]
LAYOUTS = ("S1", "S2", "S3")
TIMES = np.arange(0, 1.0 + 1e-9, 0.01)
CORNERS = ("front_left", "front_right", "rear_left", "rear_right")
# so small that the geometry is linear to 1e-8: relative travel over the strut's length
SMALL = 1e-6


@dataclass(frozen=True)
class Case:
    """A model, how it is built, its start, and the reference's structure of the same.

    `loads`: generalised force per input, of the reference's coordinates. `scale` shrinks start and
    inputs of models whose geometry is not linear.
    """

    name: str
    arguments: dict[str, Any]
    start: dict[str, float]
    structure: Structure
    loads: dict[str, Array]
    scale: float = 1.0


def unit(size: int, place: int, value: float) -> Array:
    found = np.zeros(size)
    found[place] = value
    return found


def quarter_car(layout: str) -> Case:
    strut = QUARTER_CAR.struts[layout]
    car = QuarterCar(
        layout=layout, damping=strut.damping, device=ReferenceDevice(inertance=strut.inertance)
    )
    loads = {"road": unit(2, 1, QUARTER_CAR.tyre_stiffness)}
    start = {"body": 0.1, "wheel": 0.3}
    return Case("quarter_car", {"layout": layout}, start, car.structure, loads)


def half_car(layout: str) -> Case:
    axles = {"front": HALF_CAR.front, "rear": HALF_CAR.rear}
    car = HalfCar(front=corner_of(axles["front"], layout), rear=corner_of(axles["rear"], layout))
    loads = {
        f"road_{name}": unit(4, 2 + i, axle.tyre_stiffness)
        for i, (name, axle) in enumerate(axles.items())
    }
    start = {"heave": 0.1, "pitch": 0.05, "wheel_front": 0.5, "wheel_rear": -0.2}
    return Case("half_car", {"layout": layout}, start, car.structure, loads, SMALL)


def full_car(layout: str) -> Case:
    axles = [FULL_CAR.front, FULL_CAR.front, FULL_CAR.rear, FULL_CAR.rear]
    corners: Any = {
        name: corner_of(axle, layout) for name, axle in zip(CORNERS, axles, strict=True)
    }
    loads = {
        f"road_{name}": unit(7, 3 + i, axles[i].tyre_stiffness) for i, name in enumerate(CORNERS)
    }
    start = {
        "heave": 0.1, "pitch": 0.05, "roll": -0.1, "wheel_front_left": 0.1,
        "wheel_front_right": 0.5, "wheel_rear_left": -0.2, "wheel_rear_right": 0.0,
    }  # fmt: skip
    structure = FullCar(**corners).structure
    return Case("full_car", {"layout": layout}, start, structure, loads, SMALL)


def frame(ground: bool) -> Case:
    lower, upper = (0, 1) if ground else (1, 3)
    made = ShearFrame(devices=(FloorDevice(lower=lower, upper=upper, device=FRAME_DEVICE),))
    loads = {"ground": -np.array(FRAME.storey_mass)}
    start = {"floor_1": 0.445, "floor_2": 0.802, "floor_3": 1.0}
    return Case("tuned_inerter_damper", {"ground": ground}, start, made.structure, loads)


def fluid_inerter(variant: str, shaker: bool) -> Case:
    device = {"dry": dry_device, "complete": complete_device}[variant]()
    arguments = {"variant": variant, "shaker": shaker}
    if shaker:
        start, loads = {"piston": 0.02, "charge": 0.1}, {"coil": np.array([0.0, 1.0])}
        structure = FluidInerterTest(device=device).structure
        return Case("fluid_inerter", arguments, start, structure, loads)
    structure = Structure(
        mass=np.array([[FLUID_INERTER.piston_mass]]),
        damping=np.zeros((1, 1)),
        stiffness=np.zeros((1, 1)),
        directions=np.array([[1.0]]),
        struts=(Strut(layout="S2", device=device),),
    )
    return Case("fluid_inerter", arguments, {"piston": 0.05}, structure, {"force": np.ones(1)})


CASES: dict[str, Callable[[], Case]] = {
    **{f"quarter_car {layout}": lambda layout=layout: quarter_car(layout) for layout in LAYOUTS},
    **{f"half_car {layout}": lambda layout=layout: half_car(layout) for layout in LAYOUTS},
    **{f"full_car {layout}": lambda layout=layout: full_car(layout) for layout in LAYOUTS},
    "frame ground": lambda: frame(True),
    "frame floors": lambda: frame(False),
    **{
        f"fluid_inerter {variant}{' shaker' * shaker}": lambda v=variant, s=shaker: fluid_inerter(
            v, s
        )
        for variant in ("dry", "complete")
        for shaker in (False, True)
    },
}
ELASTIC = {"series_stiffness": 1e6, "series_damping": 3200.0}
Drives = Mapping[str, Callable[[float], float]]


def bump(height: float, centre: float) -> Callable[[float], float]:
    return lambda t: height * float(np.exp(-(((t - centre) / 0.08) ** 2)))


def drives(case: Case) -> Drives:
    """An input for everything that can be driven: bumps, a pulse of the ground, a sweep."""
    known: Drives = {
        "ground": lambda t: 3.0 * float(np.sin(17 * t) * np.exp(-(((t - 0.5) / 0.2) ** 2))),
        "force": lambda t: 70.0 * float(np.sin(19 * t)),
        "coil": lambda t: SHAKER.gain * 0.5 * float(np.sin(6 * (1 + 2 * t) * t)),
    }
    roads = {
        name: bump(0.03 * case.scale * (-0.7) ** i, 0.25 + 0.06 * i)
        for i, name in enumerate(case.loads)
    }
    return {name: known.get(name, roads[name]) for name in case.loads}


@functools.cache
def truth(name: str, driven: bool) -> StructureRun:
    """The reference, from the start's velocities or at rest with the inputs."""
    case = CASES[name]()
    inputs, n = drives(case), len(case.structure.mass)
    state = np.zeros(case.structure.nstate)
    if not driven:
        state[n : 2 * n] = case.scale * np.array(list(case.start.values()))

    def forces(t: float) -> Array:
        pushes = [case.loads[key] * drive(t) for key, drive in inputs.items()]
        return np.sum(pushes, axis=0) if driven else np.zeros(n)

    return case.structure.simulate(
        forces,
        times(name),
        initial=state,
        method="DOP853",
        rtol=1e-11,
        atol=1e-14 * case.scale,
        max_step=0.01,
    )


def times(name: str) -> Array:
    """The fluid inerter's friction makes the reference slow: a third of the time."""
    return TIMES[:36] if "fluid" in name else TIMES


def build(case: Case, *, driven: bool, **arguments: Any) -> tuple[Any, Model]:
    """The model in a new system; keep the container, it owns the system."""
    container = exu.SystemContainer()
    moving = {name: case.scale * value for name, value in case.start.items()}
    made = exudyn_model(case.name).build(
        container.AddSystem(),
        **{**case.arguments, **arguments},
        inputs=drives(case) if driven else None,
        initial_velocities=None if driven else moving,
    )
    return container, made


def run(name: str, solver: str, step: float, *, driven: bool) -> Run:
    _container, model = build(CASES[name](), driven=driven)
    return simulate(model, times(name)[-1], step, 0.01, solver)


def error(found: Array, true: Array) -> float:
    """Largest error over the largest value, the worst of all columns."""
    scale = np.abs(true).max(axis=0)
    return float((np.abs(found - true).max(axis=0) / scale).max())


def motion_error(found: Run, true: StructureRun) -> float:
    """The worst of displacements and velocities."""
    return max(
        error(np.column_stack(list(found.displacement.values())), true.position),
        error(np.column_stack(list(found.velocity.values())), true.velocity),
    )
