"""The shipped quarter-cars, compiled once per layout and law, with designs as model fields.

| of a design | field of the model |
| --- | --- |
| stiffness k, damping c | `tendon_stiffness`, `tendon_damping` |
| inertance b | `actuator_armature`; behind a series element the live parameter `inertance` |
| parameters of the device | live parameters, `numeric_data` |

All of them are fields that `mujoco.batch` expands. The device's own viscous damping is its live
parameter. Contacts and constraints, of which the model has none, are switched off for speed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any

import mujoco

from inerter.device_in_model import DeviceInModel, device_of
from inerter.model_parameters import QUARTER_CAR
from inerter.models import model_path
from inerter.plugin import load_plugin
from inerter.suspension.quarter_car import QuarterCar
from inerter.suspension.time_domain.cases import Case

LAYOUTS = ("S1", "S2", "S3")
"""Layouts of which there is a MuJoCo model."""

_TENDONS = {"S1": ("strut", "strut"), "S2": ("strut", "strut"), "S3": ("spring", "damper")}


@dataclass(frozen=True)
class Design:
    """k [N/m], c [N s/m], b [kg], and values in place of the case's own (SI, by key).

    Raises
    ------
    ValueError
        A stiffness or damping that is not positive, a negative inertance.
    """

    stiffness: float
    damping: float
    inertance: float = 0.0
    parameters: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Check what was given, see Raises."""
        for name in ("stiffness", "damping"):
            if not 0.0 < getattr(self, name) < float("inf"):
                raise ValueError(f"{name} is {getattr(self, name):g}: give a positive number")
        if not 0.0 <= self.inertance < float("inf"):
            raise ValueError(f"inertance is {self.inertance:g}: give a number that is 0 or above")


@dataclass(frozen=True)
class CarModel:
    """A compiled quarter-car and where things are in it.

    `implicit`: stepped by discrete, because its node between damper and elastic shaft has no
    mass; RK4 otherwise. `spring`, `damper` are tendons, `device` is None in S1. `road`, `load` are
    the addresses of the controls: the road's height [m], a force on the body [N].
    """

    model: mujoco.MjModel
    layout: str
    case: Case
    car: QuarterCar
    implicit: bool
    spring: int
    damper: int
    device: DeviceInModel | None
    road: int
    load: int

    def acceleration_per_force(self, inertance: float) -> float:
        """Acceleration of the body at once per force on the wheel [1/kg].

        Only an inertance that is rigid between wheel and body hands forces on at once.
        """
        if self.layout != "S2" or self.case.has_series:
            return 0.0
        ms, mu = self.car.sprung_mass, self.car.unsprung_mass
        return inertance / (ms * mu + inertance * (ms + mu))

    def refuse(self, design: Design, step: float) -> None:
        """Raise ValueError for a design that this model cannot be, or not with this step [s]."""
        if design.inertance == 0.0 and (self.layout == "S3" or self.case.has_series):
            raise ValueError(f"{self.layout}: inertance is 0; give one, or take layout S1")
        unknown = set(design.parameters) - set(self.case.parameters)
        if unknown:
            raise ValueError(
                f"case {self.case.name!r} has no parameter {', '.join(sorted(unknown))}; "
                f"it has {', '.join(self.case.parameters) or 'none'}"
            )
        values = {**self.case.parameters, **design.parameters}
        if self.implicit or self.layout == "S1" or "transition_velocity" not in values:
            return
        # RK4 ends at a rate of 2.78 / step
        slope = values["coulomb_force"] / values["transition_velocity"]
        ms, mu = self.car.sprung_mass, self.car.unsprung_mass
        mass = 0.0 if self.case.has_series else design.inertance
        mass += ms * mu / (ms + mu) if self.layout == "S2" else 0.0
        if slope * step > 2.5 * mass:
            raise ValueError(
                f"friction of {values['coulomb_force']:g} N over a width of "
                f"{values['transition_velocity']:g} m/s is too sharp for steps of {step:g} s; "
                f"shorten the step below {2.5 * mass / slope:.2g} s or widen transition_velocity"
            )


@lru_cache(maxsize=32)
def _compiled(layout: str, friction: str, keys: tuple[str, ...], car: QuarterCar) -> Any:
    """The model with every parameter in `keys` live; the values are overwritten by the designs."""
    load_plugin()
    file = f"model_{layout.lower()}.xml"
    spec: Any = mujoco.MjSpec.from_file(str(model_path("quarter_car", file)))
    flags = mujoco.mjtDisableBit
    spec.option.disableflags = int(flags.mjDSBL_CONTACT | flags.mjDSBL_CONSTRAINT)
    spec.geom("body").mass, spec.geom("wheel").mass = car.sprung_mass, car.unsprung_mass
    road, kt = spec.actuator("road"), car.tyre_stiffness
    road.gainprm[0], road.biasprm[1] = kt, -kt

    # spring and damper belong to the tendons in every layout, the device has the rest
    length = QUARTER_CAR.strut_length
    for name in dict.fromkeys(_TENDONS[layout]):
        tendon = spec.tendon(name)
        tendon.stiffness[0], tendon.damping[0] = (name == _TENDONS[layout][i] for i in (0, 1))
        rest = length if layout != "S3" else 0.0
        tendon.springlength = [rest, rest]

    if layout != "S1":
        (instance,) = [plugin for plugin in spec.plugins if plugin.name == "strut"]
        # compiled with 1 everywhere, so that every state is there
        values = dict.fromkeys(keys, 1.0)
        config = {"inertance": "1", "friction": friction} | {k: repr(v) for k, v in values.items()}
        if layout == "S2":
            config["rest_length"] = repr(length)
        instance.config = config
        states = Case("", "", friction, values).nstate
        if states:
            spec.actuator("strut").actdim = states
        live = [*values, "inertance"] if "series_stiffness" in values else list(values)
        for key in live:
            spec.add_numeric(name=f"strut.{key}", data=[values.get(key, 1.0)], size=1)

    # a force on the body: zs = wheel + travel
    heave = spec.add_tendon(name="heave")
    heave.wrap_joint("wheel", 1.0)
    heave.wrap_joint("travel", 1.0)
    load = spec.add_actuator(
        name="load", target="heave", trntype=mujoco.mjtTrn.mjTRN_TENDON, gear=[1, 0, 0, 0, 0, 0]
    )
    load.set_to_motor()

    # only what is read
    for sensor in list(spec.sensors):
        if sensor.name != "body_acceleration":
            spec.delete(sensor)
    for name, kind, target, of in (
        ("wheel", mujoco.mjtSensor.mjSENS_JOINTPOS, "wheel", mujoco.mjtObj.mjOBJ_JOINT),
        ("body", mujoco.mjtSensor.mjSENS_TENDONPOS, "heave", mujoco.mjtObj.mjOBJ_TENDON),
    ):
        spec.add_sensor(name=name, type=kind, objtype=of, objname=target)
    return spec.compile()


def compiled(layout: str, case: Case, car: QuarterCar | None = None) -> CarModel:
    """The model of a layout with the law of a case; compiled once.

    Raises
    ------
    ValueError
        A layout without a MuJoCo model, or S1 (no device) with anything but the ideal case.
    """
    if layout not in LAYOUTS:
        raise ValueError(f"layout {layout!r} has no MuJoCo model: take {', '.join(LAYOUTS)}")
    if layout == "S1" and (case.friction != "none" or case.parameters):
        raise ValueError(f"layout S1 has no inerter, so case {case.name!r} is not one of it")
    car = car or QuarterCar()
    model = _compiled(layout, case.friction, tuple(sorted(case.parameters)), car)
    spring, damper = (model.tendon(name).id for name in _TENDONS[layout])
    return CarModel(
        model=model,
        layout=layout,
        case=case,
        car=car,
        implicit=layout == "S3" and case.has_series,
        spring=spring,
        damper=damper,
        device=None if layout == "S1" else device_of(model, "strut"),
        road=int(model.actuator_ctrladr[model.actuator("road").id]),
        load=int(model.actuator_ctrladr[model.actuator("load").id]),
    )
