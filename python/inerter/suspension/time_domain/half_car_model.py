"""The shipped half-car for the time domain, compiled once per layout and law.

Body, wheels and tyres are those of `mjcf_models/half_car/vehicle.xml`. The spatial tendons of the
struts give way to fixed ones, travel = heave -+ distance * pitch - wheel: the limit of small
motions, in which the linear study and the reference are written too. In S3 each wheel carries a
node without mass, as the quarter-car's does; its joint is the device's own displacement.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import mujoco
import numpy as np

from inerter.device_in_model import PLUGIN, device_of
from inerter.models import model_path
from inerter.plugin import load_plugin
from inerter.suspension.time_domain import build
from inerter.suspension.time_domain.car_model import CarModel, StrutPlace, WheelPlace
from inerter.suspension.time_domain.cases import Case
from inerter.suspension.vehicle.cars import HalfCar

AXLES = ("front", "rear")


def _lever(car: HalfCar, axle: str) -> float:
    """Rise of the body above an axle per pitch [m/rad]."""
    return -car.front.distance if axle == "front" else car.rear.distance


@lru_cache(maxsize=32)
def _compiled(layout: str, laws: build.Laws, car: HalfCar, one_sided: bool) -> Any:
    """The model with every parameter live; the values are overwritten by the designs."""
    load_plugin()
    spec: Any = mujoco.MjSpec.from_file(str(model_path("half_car", "vehicle.xml")))
    build.switch_off_contacts(spec)
    body = spec.body("sprung")
    body.mass = car.body_mass
    body.inertia[1] = car.pitch_inertia
    if layout != "S1":
        spec.activate_plugin(PLUGIN)
    for axle in AXLES:
        _set_wheel(spec, axle, car, one_sided)
        _add_strut(spec, layout, laws, axle, _lever(car, axle))
    build.add_load(spec, "heave", mujoco.mjtTrn.mjTRN_JOINT)
    build.keep_sensors(
        spec,
        ["heave", "body_acceleration", "body_angular_acceleration"],
        [(f"wheel_{axle}", "joint", f"wheel_{axle}") for axle in AXLES]
        + [(f"travel_{axle}", "tendon", f"spring_{axle}") for axle in AXLES],
    )
    return spec.compile()


def _set_wheel(spec: Any, axle: str, car: HalfCar, one_sided: bool) -> None:
    values = car.front if axle == "front" else car.rear
    spec.body(f"wheel_{axle}").mass = values.wheel_mass
    load = car.static_loads[AXLES.index(axle)] if one_sided else None
    build.set_tyre(spec.actuator(f"road_{axle}"), values.tyre_stiffness, load)


def _add_strut(spec: Any, layout: str, laws: build.Laws, axle: str, lever: float) -> None:
    """Tendons of spring and damper, and the device."""
    spec.delete(spec.tendon(f"strut_{axle}"))
    travel = {"heave": 1.0, "pitch": lever, f"wheel_{axle}": -1.0}
    _add_tendon(spec, f"spring_{axle}", travel).stiffness[0] = 1.0
    damped = f"spring_{axle}"
    if layout == "S3":
        node = spec.body(f"wheel_{axle}").add_body(name=f"node_{axle}")
        node.add_joint(
            name=f"device_{axle}", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[0.0, 0.0, 1.0]
        )
        node.mass, node.inertia, node.explicitinertial = 1e-9, [1e-9] * 3, True
        damped = f"damper_{axle}"
        _add_tendon(spec, damped, travel | {f"device_{axle}": -1.0})
    spec.tendon(damped).damping[0] = 1.0
    if layout == "S1":
        return

    name = f"strut_{axle}"
    instance = spec.add_plugin(name=name, plugin_name=PLUGIN, active=True)
    instance.config = build.configuration(laws)
    on_joint = layout == "S3"
    actuator = spec.add_actuator(
        name=name,
        target=f"device_{axle}" if on_joint else f"spring_{axle}",
        trntype=mujoco.mjtTrn.mjTRN_JOINT if on_joint else mujoco.mjtTrn.mjTRN_TENDON,
        gear=[1, 0, 0, 0, 0, 0],
    )
    states = build.number_of_states(laws)
    if states:
        actuator.actdim = states
    actuator.plugin.plugin_name, actuator.plugin.name = PLUGIN, name
    actuator.plugin.active = True
    # body and wheels are siblings: the plugin carries the inertance between them
    live = layout == "S2" or build.carried_by_plugin(laws)
    build.add_live(spec, name, [*laws[1], *(["inertance"] if live else [])])


def _add_tendon(spec: Any, name: str, joints: dict[str, float]) -> Any:
    tendon = spec.add_tendon(name=name)
    for joint, coefficient in joints.items():
        tendon.wrap_joint(joint, coefficient)
    tendon.springlength = [0.0, 0.0]
    return tendon


def half_car_model(layout: str, case: Case, car: HalfCar, one_sided: bool = False) -> CarModel:
    """The model of a layout with the law of a case; `one_sided` as for `compiled`."""
    model = _compiled(layout, build.laws_of(case), car, one_sided)
    levers = np.array([_lever(car, axle) for axle in AXLES])
    wheelbase = float(levers[1] - levers[0])
    upward = int(model.sensor("body_acceleration").adr[0]) + 2
    turning = int(model.sensor("body_angular_acceleration").adr[0]) + 1
    by_sensors = np.zeros((2, model.nsensordata))
    by_sensors[:, upward], by_sensors[:, turning] = 1.0, levers
    by_rates = np.zeros((2, model.nv))
    by_rates[:, int(model.joint("heave").dofadr[0])] = 1.0
    by_rates[:, int(model.joint("pitch").dofadr[0])] = levers
    points = np.column_stack([np.ones(2), levers, np.zeros((2, 2))])
    parts = {"front": car.front, "rear": car.rear}
    return CarModel(
        model=model,
        one_sided=one_sided,
        layout=layout,
        case=case,
        car=car,
        implicit=case.stiff or (layout == "S3" and case.has_series),
        fineness=4,
        struts=tuple(
            StrutPlace(
                model.tendon(f"spring_{axle}").id,
                model.tendon(f"{'damper' if layout == 'S3' else 'spring'}_{axle}").id,
                None if layout == "S1" else device_of(model, f"strut_{axle}"),
            )
            for axle in AXLES
        ),
        wheels=tuple(
            WheelPlace(
                build.control_of(model, f"road_{axle}"),
                int(model.sensor(f"wheel_{axle}").adr[0]),
                parts[axle].tyre_stiffness,
                0.0 if axle == "front" else wheelbase,
                int(model.sensor(f"travel_{axle}").adr[0]),
                load,
            )
            for axle, load in zip(AXLES, car.static_loads, strict=True)
        ),
        load=build.control_of(model, "load"),
        body=int(model.sensor("heave").adr[0]),
        by_sensors=by_sensors,
        by_rates=by_rates,
        mass=np.diag([car.body_mass, car.pitch_inertia, car.front.wheel_mass, car.rear.wheel_mass]),
        points=points,
        travels=points + np.array([[0.0, 0.0, -1.0, 0.0], [0.0, 0.0, 0.0, -1.0]]),
        # the nearer axle takes the larger share of a load at the centre of mass
        compliance=np.array([levers[1], levers[0]]) ** 2 / wheelbase**2,
    )
