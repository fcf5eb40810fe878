"""Cars in the time domain: the MJCF of `inerter.cars.mjcf` with what a study needs of it."""

from __future__ import annotations

from functools import lru_cache
from typing import Any
from xml.etree import ElementTree as ET

import mujoco
import numpy as np
from numpy.typing import NDArray

from inerter.cars.mjcf import FAR, NODES, car_mjcf
from inerter.cars.parts import AxleParts, CarParts, StrutParts
from inerter.plugin import load_plugin
from inerter.simulate.checks import engine_warnings
from inerter.suspension.layouts import LAYOUTS
from inerter.suspension.quarter_car import QuarterCar
from inerter.suspension.time_domain.car_model import CarModel, WheelPlace
from inerter.suspension.time_domain.cases import Case
from inerter.suspension.time_domain.design import Design, left_of
from inerter.suspension.vehicle.cars import Axle, FullCar, HalfCar

__all__ = ["LAYOUTS", "Car", "CarModel", "Design", "car_parts", "compiled", "step_matrix"]

Array = NDArray[np.float64]

Car = QuarterCar | HalfCar | FullCar

_SMALL = 1e-6
# a step that grows: rounding of differences stays below
_GROWS = 1.0 + 1e-6
# a step that is short for every mode that rings [s], the fastest that counts [rad/s], the share of
# its damping that discrete may add, and the shortest steps
_SHORT, _FASTEST, _SHARE, _FINEST = 1e-5, 1000.0, 0.15, 40
_KEPT = ("body_acceleration", "body_angular_acceleration")
_SERIES = ("series_stiffness", "series_damping")


def compiled(
    layout: str,
    case: Case,
    car: Car | None = None,
    *,
    one_sided: bool = False,
    design: Design | None = None,
    step: float = 1e-3,
) -> CarModel:
    """The model of a layout with the law of a case, the quarter-car if not told.

    `one_sided`: a tyre leaves the road where it would have to pull by more than its static load;
    else it pulls, as in the linear study. `design`: what is to be simulated, with steps of about
    `step` [s]; where RK4 cannot follow its springs, discrete steps it.

    Raises
    ------
    ValueError
        A layout that is not known, or one without inerter with anything but the ideal case.
    """
    if layout not in LAYOUTS:
        raise ValueError(f"layout {layout!r} is not known: take {', '.join(LAYOUTS)}")
    layout = LAYOUTS[layout].own
    if not LAYOUTS[layout].has_inerter and not case.ideal:
        raise ValueError(f"layout {layout} has no inerter, so case {case.name!r} is not one of it")
    car = car or QuarterCar()
    first = design or _any_design(layout, car)

    def of(one: Design) -> mujoco.MjModel:
        return _compiled(car_parts(car, layout, case, one), one_sided)

    layouts = [left_of(layout, strut) for strut in first.struts]
    implicit = case.stiff or (case.has_series and any(each in NODES for each in layouts))
    fineness = 2 if isinstance(car, QuarterCar) else 4
    if design is not None:
        # friction only adds damping; its own bound is that of `refuse`
        series = {key: x for key, x in case.parameters.items() if key in _SERIES}
        bare = _compiled(car_parts(car, layout, Case("", "", "none", series), design), one_sided)
        if not implicit:
            growth = np.abs(np.linalg.eigvals(step_matrix(bare, step)))
            implicit = bool(growth.max() > _GROWS)
        fineness = max(fineness, _fineness(bare, step)) if implicit else fineness
    return _placed(of(first), layout, case, car, one_sided, implicit, fineness, of)


def _fineness(model: mujoco.MjModel, step: float) -> int:
    """How much shorter steps of discrete have to be.

    It adds w h / 2 to the damping ratio of a mode; of what that takes the extrapolation of
    `simulate` leaves the square.
    """
    integrator = model.opt.integrator
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_DISCRETE
    rates = np.log(np.linalg.eigvals(step_matrix(model, _SHORT)).astype(complex)) / _SHORT
    model.opt.integrator = integrator
    rings = (np.abs(rates.imag) > np.abs(rates.real)) & (np.abs(rates) < _FASTEST)
    if not rings.any():
        return 1
    share = np.abs(rates[rings]) ** 2 / (2.0 * np.maximum(-rates.real[rings], 1e-3))
    return min(int(np.ceil(step * share.max() / _SHARE)), _FINEST)


def car_parts(car: Car, layout: str, case: Case, design: Design) -> CarParts:
    """A car with a design's struts, their inerters those of a case."""

    def strut(own: Design) -> StrutParts:
        left = left_of(layout, own)
        springs: dict[str, Any] = dict(own.springs)
        springs.pop("parallel_stiffness", None)
        if left not in ("SR", "S4", "S5", "S6", "SW8"):
            springs.pop("relaxation_stiffness", None)
        if left not in ("SW7", "SW8"):
            springs = {n: x for n, x in springs.items() if n == "relaxation_stiffness"}
        device: dict[str, Any] = {}
        if LAYOUTS[left].has_inerter and not case.ideal:
            device = {"friction": case.friction, **case.parameters, **own.parameters}
        return StrutParts(
            layout=left,
            stiffness=own.stiffness,
            damping=own.damping,
            inertance=own.inertance if LAYOUTS[left].has_inerter else 0.0,
            device=tuple(device.items()),
            **springs,
        )

    if isinstance(car, QuarterCar):
        axle = AxleParts(
            wheel_mass=car.unsprung_mass,
            tyre_stiffness=car.tyre_stiffness,
            tyre_damping=car.tyre_damping,
            strut=strut(design),
        )
        return CarParts(kind="quarter", name="quarter", body_mass=car.sprung_mass, front=axle)

    def axle_of(own: Axle, values: Design) -> AxleParts:
        return AxleParts(
            distance=own.distance,
            wheel_mass=own.wheel_mass,
            tyre_stiffness=own.tyre_stiffness,
            anti_roll_stiffness=own.anti_roll_stiffness,
            tyre_damping=own.tyre_damping,
            strut=strut(values),
        )

    more: dict[str, float] = {}
    if isinstance(car, FullCar):
        more = {
            "roll_inertia": car.roll_inertia,
            "track": car.track,
            "correlation": car.correlation,
        }
    return CarParts(
        kind=car.name,
        name=car.name,
        body_mass=car.body_mass,
        pitch_inertia=car.pitch_inertia,
        front=axle_of(car.front, design.struts[0]),
        rear=axle_of(car.rear, design.struts[-1]),
        **more,
    )


def step_matrix(model: mujoco.MjModel, step: float | None = None) -> Array:
    """What a step of the engine makes of small states, made linear at rest, (n, n)."""
    data = mujoco.MjData(model)
    size = model.nq + model.nv + model.na
    kind = mujoco.mjtState.mjSTATE_PHYSICS
    matrix = np.empty((size, size))
    ends = np.empty((2, size))
    usual = model.opt.timestep
    model.opt.timestep = usual if step is None else step
    # what RK4 cannot follow is asked here, and answered by the eigenvalues
    with engine_warnings():
        for n in range(size):
            for end, change in zip(ends, (_SMALL, -_SMALL), strict=True):
                mujoco.mj_resetData(model, data)
                mujoco.mj_setState(model, data, change * np.eye(size)[n], kind)
                mujoco.mj_step(model, data)
                mujoco.mj_getState(model, data, end, kind)
            matrix[:, n] = (ends[0] - ends[1]) / (2.0 * _SMALL)
    model.opt.timestep = usual
    return matrix


def _any_design(layout: str, car: Car) -> Design:
    """One whose parts are all there; models of other designs differ from it in numbers."""
    more: dict[str, Any] = {
        name: value
        for name, value in {
            "relaxation_stiffness": 1e5, "centring_share": 0.5, "centring_ratio": 1.0,
        }.items()
        if name in LAYOUTS[layout].variables
    }  # fmt: skip
    inertance = 100.0 if LAYOUTS[layout].has_inerter else 0.0
    one = Design(1e5, 5e3, inertance, **more)
    rear = None if isinstance(car, QuarterCar) else one
    return Design(1e5, 5e3, inertance, rear=rear, **more)


@lru_cache(maxsize=512)
def _compiled(parts: CarParts, one_sided: bool) -> mujoco.MjModel:
    """The model of a car, with the sensors that are read and a load on the body."""
    load_plugin()
    root = ET.fromstring(car_mjcf(parts))
    _make_live(root)
    spec: Any = mujoco.MjSpec.from_string(ET.tostring(root, encoding="unicode"))
    flags = mujoco.mjtDisableBit
    # there are no contacts and no constraints; looking for them takes time
    spec.option.disableflags = int(flags.mjDSBL_CONTACT | flags.mjDSBL_CONSTRAINT)
    roads = [a.name for a in spec.actuators if a.name.split("_")[0] == "road"]
    for sensor in list(spec.sensors):
        if sensor.name not in _KEPT and not sensor.name.startswith("suspension_travel"):
            spec.delete(sensor)
    kind, joint = mujoco.mjtSensor.mjSENS_JOINTPOS, mujoco.mjtObj.mjOBJ_JOINT
    for name in ("heave", *(road.replace("road", "wheel") for road in roads)):
        spec.add_sensor(name=name, type=kind, objtype=joint, objname=name)
    for road in roads:
        wheel = road.replace("road", "wheel")
        speed = mujoco.mjtSensor.mjSENS_JOINTVEL
        spec.add_sensor(name=f"rate_{wheel}", type=speed, objtype=joint, objname=wheel)
        if not one_sided:
            spec.actuator(road).forcerange = [-FAR, FAR]
    load = spec.add_actuator(
        name="load", target="heave", trntype=mujoco.mjtTrn.mjTRN_JOINT, gear=[1, 0, 0, 0, 0, 0]
    )
    load.set_to_motor()
    return spec.compile()


def _make_live(root: ET.Element) -> None:
    """Numbers of the devices into numerics, which a batch can vary; not what the engine holds."""
    custom = ET.SubElement(root, "custom")
    on = {a.get("name"): a for a in root.findall("actuator/plugin")}
    for instance in root.findall("extension/plugin/instance"):
        name = instance.get("name", "")
        config = {each.get("key", ""): each.get("value", "") for each in instance}
        # between body and wheel, two branches of the tree, the plugin carries the inertance
        carried = on[name].get("tendon") is not None or any(
            key in _SERIES or key.startswith("inertance_") for key in config
        )
        for key, value in config.items():
            if _is_number(value) and (key != "inertance" or carried):
                ET.SubElement(custom, "numeric", name=f"{name}.{key}", data=value)


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _placed(
    model: mujoco.MjModel,
    layout: str,
    case: Case,
    car: Car,
    one_sided: bool,
    implicit: bool,
    fineness: int,
    of: Any,
) -> CarModel:
    """Where everything is in a compiled model."""
    sides = (1, -1) if isinstance(car, FullCar) else (0,)
    axles = (None,) if isinstance(car, QuarterCar) else ("front", "rear")
    # the body's coordinates: heave, then roll and pitch as far as it has them
    names = ["heave", *(["roll"] if len(sides) == 2 else []), *(["pitch"] if axles[0] else [])]
    track = car.track if isinstance(car, FullCar) else 0.0
    wheels, points = [], []
    for n, axle in enumerate(axles):
        for side in sides:
            place = "" if axle is None else f"_{axle}"
            place += {1: "_left", -1: "_right", 0: ""}[side]
            if isinstance(car, QuarterCar):
                tyre, behind, load, x = car.tyre_stiffness, 0.0, car.static_load, 0.0
                damping = car.tyre_damping
            else:
                own = (car.front, car.rear)[n]
                tyre, behind = own.tyre_stiffness, n * car.wheelbase
                damping = own.tyre_damping
                load, x = car.side.static_loads[n], (own.distance, -own.distance)[n]
            wheels.append(
                WheelPlace(
                    int(model.actuator_ctrladr[model.actuator(f"road{place}").id]),
                    int(model.sensor(f"wheel{place}").adr[0]),
                    tyre,
                    behind,
                    int(model.sensor(f"suspension_travel{place}").adr[0]),
                    load,
                    side,
                    n,
                    damping,
                    int(model.sensor(f"rate_wheel{place}").adr[0]),
                )
            )
            per = {"heave": 1.0, "roll": 0.5 * side * track, "pitch": -x}
            points.append([per[name] for name in names])
    of_points = np.array(points)
    count = len(wheels)
    by_sensors = np.zeros((count, model.nsensordata))
    upward = int(model.sensor("body_acceleration").adr[0]) + 2
    by_sensors[:, upward] = 1.0
    for name, column in zip(names[1:], of_points.T[1:], strict=True):
        turning = int(model.sensor("body_angular_acceleration").adr[0])
        by_sensors[:, turning + ("roll", "pitch").index(name)] = column
    by_rates = np.zeros((count, model.nv))
    by_rates[:, [int(model.joint(name).dofadr[0]) for name in names]] = of_points
    if isinstance(car, QuarterCar):
        masses = [car.sprung_mass, car.unsprung_mass]
        shares = np.ones(1)
    else:
        inertia = {"heave": car.body_mass, "pitch": car.pitch_inertia}
        if isinstance(car, FullCar):
            inertia["roll"] = car.roll_inertia
        unsprung = [(car.front, car.rear)[wheel.axle].wheel_mass for wheel in wheels]
        masses = [*(inertia[name] for name in names), *unsprung]
        # the nearer axle takes the larger share of a load at the centre of mass
        lever = car.side.lever
        shares = np.array([lever[wheel.axle] ** 2 for wheel in wheels]) / len(sides) ** 2
    return CarModel(
        model=model,
        one_sided=one_sided,
        layout=layout,
        case=case,
        car=car,
        implicit=implicit,
        fineness=fineness,
        of=of,
        wheels=tuple(wheels),
        load=int(model.actuator_ctrladr[model.actuator("load").id]),
        body=int(model.sensor("heave").adr[0]),
        by_sensors=by_sensors,
        by_rates=by_rates,
        mass=np.diag(masses),
        points=np.hstack([of_points, np.zeros((count, count))]),
        travels=np.hstack([of_points, -np.eye(count)]),
        compliance=shares,
    )
