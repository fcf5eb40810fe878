"""The shipped quarter-car for the time domain, compiled once per layout and law."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import mujoco
import numpy as np

from inerter.device_in_model import device_of
from inerter.model_parameters import QUARTER_CAR
from inerter.models import model_path
from inerter.plugin import load_plugin
from inerter.suspension.quarter_car import QuarterCar
from inerter.suspension.time_domain import build
from inerter.suspension.time_domain.car_model import CarModel, StrutPlace, WheelPlace
from inerter.suspension.time_domain.cases import Case

_TENDONS = {"S1": ("strut", "strut"), "S2": ("strut", "strut"), "S3": ("spring", "damper")}


@lru_cache(maxsize=32)
def _compiled(layout: str, laws: build.Laws, car: QuarterCar, one_sided: bool) -> Any:
    """The model with every parameter live; the values are overwritten by the designs."""
    load_plugin()
    file = f"model_{layout.lower()}.xml"
    spec: Any = mujoco.MjSpec.from_file(str(model_path("quarter_car", file)))
    build.switch_off_contacts(spec)
    spec.geom("body").mass, spec.geom("wheel").mass = car.sprung_mass, car.unsprung_mass
    build.set_tyre(
        spec.actuator("road"), car.tyre_stiffness, car.static_load if one_sided else None
    )

    # spring and damper belong to the tendons in every layout, the device has the rest
    length = QUARTER_CAR.strut_length
    for name in dict.fromkeys(_TENDONS[layout]):
        tendon = spec.tendon(name)
        tendon.stiffness[0], tendon.damping[0] = (name == _TENDONS[layout][i] for i in (0, 1))
        rest = length if layout != "S3" else 0.0
        tendon.springlength = [rest, rest]

    if layout != "S1":
        (instance,) = [plugin for plugin in spec.plugins if plugin.name == "strut"]
        config = build.configuration(laws)
        if layout == "S2":
            config["rest_length"] = repr(length)
        instance.config = config
        states = build.number_of_states(laws)
        if states:
            spec.actuator("strut").actdim = states
        build.add_live(
            spec, "strut", [*laws[1], *(["inertance"] if build.carried_by_plugin(laws) else [])]
        )

    # a force on the body: zs = wheel + travel
    heave = spec.add_tendon(name="heave")
    heave.wrap_joint("wheel", 1.0)
    heave.wrap_joint("travel", 1.0)
    build.add_load(spec, "heave", mujoco.mjtTrn.mjTRN_TENDON)
    build.keep_sensors(
        spec,
        ["body_acceleration"],
        [("wheel", "joint", "wheel"), ("body", "tendon", "heave"), ("travel", "joint", "travel")],
    )
    return spec.compile()


def quarter_car_model(
    layout: str, case: Case, car: QuarterCar, one_sided: bool = False
) -> CarModel:
    """The model of a layout with the law of a case; `one_sided` as for `compiled`."""
    model = _compiled(layout, build.laws_of(case), car, one_sided)
    spring, damper = (model.tendon(name).id for name in _TENDONS[layout])
    by_sensors = np.zeros((1, model.nsensordata))
    by_sensors[0, int(model.sensor("body_acceleration").adr[0]) + 2] = 1.0
    by_rates = np.zeros((1, model.nv))
    by_rates[0, [int(model.joint(name).dofadr[0]) for name in ("wheel", "travel")]] = 1.0
    return CarModel(
        model=model,
        one_sided=one_sided,
        layout=layout,
        case=case,
        car=car,
        implicit=case.stiff or (layout == "S3" and case.has_series),
        fineness=2,
        struts=(StrutPlace(spring, damper, None if layout == "S1" else device_of(model, "strut")),),
        wheels=(
            WheelPlace(
                build.control_of(model, "road"),
                int(model.sensor("wheel").adr[0]),
                car.tyre_stiffness,
                travel=int(model.sensor("travel").adr[0]),
                static_load=car.static_load,
            ),
        ),
        load=build.control_of(model, "load"),
        body=int(model.sensor("body").adr[0]),
        by_sensors=by_sensors,
        by_rates=by_rates,
        mass=np.diag([car.sprung_mass, car.unsprung_mass]),
        points=np.array([[1.0, 0.0]]),
        travels=np.array([[1.0, -1.0]]),
        compliance=np.ones(1),
    )
