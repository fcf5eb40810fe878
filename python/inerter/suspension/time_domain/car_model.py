"""A compiled car of any number of axles: where things are in it, and what its step can follow.

| of a strut | field of the model |
| --- | --- |
| stiffness k, damping c | `tendon_stiffness`, `tendon_damping` |
| inertance b | `actuator_armature`, or the live parameter `inertance` where the plugin carries it |
| parameters of the device | live parameters, `numeric_data` |

All of them are fields that `mujoco.batch` expands.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from inerter.device_in_model import DeviceInModel
from inerter.suspension.time_domain.cases import Case
from inerter.suspension.time_domain.design import Design

Array = NDArray[np.float64]

# RK4 ends at a rate of 2.78 / step
_RATE = 2.5


@dataclass(frozen=True)
class StrutPlace:
    """Tendons `spring` and `damper` of a strut, its `device`; None in S1."""

    spring: int
    damper: int
    device: DeviceInModel | None


@dataclass(frozen=True)
class WheelPlace:
    """`road` control, `height` sensor, `tyre_stiffness` [N/m], `behind` the first axle [m].

    `travel` sensor of the strut above; `static_load` [N] on the tyre.
    """

    road: int
    height: int
    tyre_stiffness: float
    behind: float = 0.0
    travel: int = 0
    static_load: float = math.inf


@dataclass(frozen=True, eq=False, kw_only=True)
class CarModel:
    """A compiled car.

    Attributes
    ----------
    model, layout, case, car
        What it is.
    one_sided
        Tyres pull by at most their static load.
    implicit
        Stepped by discrete, because a node between damper and elastic shaft has no mass or the
        case is stiff; RK4 otherwise.
    fineness
        The longer step of discrete is the step of RK4 over this.
    struts, wheels
        Front to rear, as many of each.
    load, body
        Control of a force on the body [N], sensor of the displacement under it [m].
    by_sensors, by_rates
        Accelerations of the body's points from sensor data, or from the rates of the velocities:
        shapes (points, nsensordata), (points, nv).
    mass, points, travels
        Linear coordinates (body, wheels): their mass matrix without inertance, and rows of the
        body's points and of the struts' travels.
    compliance
        (struts,): share of each axle's compliance 1/k + 1/kt under the load.
    """

    model: mujoco.MjModel
    one_sided: bool
    layout: str
    case: Case
    car: Any
    implicit: bool
    fineness: int
    struts: tuple[StrutPlace, ...]
    wheels: tuple[WheelPlace, ...]
    load: int
    body: int
    by_sensors: Array
    by_rates: Array
    mass: Array
    points: Array
    travels: Array
    compliance: Array

    def accelerations_per_force(self, design: Design) -> Array:
        """Accelerations of the body's points at once per force on the wheels [1/kg].

        Shape (points, wheels). Only an inertance that is rigid between wheel and body hands
        forces on at once.
        """
        if self.layout != "S2" or self.case.has_series:
            return np.zeros((len(self.points), len(self.wheels)))
        inertances = np.array([strut.inertance for strut in design.struts])
        mass = self.mass + self.travels.T @ (inertances[:, None] * self.travels)
        return self.points @ np.linalg.inv(mass)[:, -len(self.wheels) :]

    def static_compliance(self, design: Design) -> float | None:
        """Displacement per load at rest [m/N]; None where something sticks there."""
        if self.layout == "S2" and self.case.friction != "none":
            return None
        total = 0.0
        for strut, wheel, share in zip(design.struts, self.wheels, self.compliance, strict=True):
            values = {**self.case.parameters, **strut.parameters}
            # a device in series with a damper yields
            beside = values.get("stiffness", 0.0) if self.layout == "S2" else 0.0
            total += share * (1.0 / (strut.stiffness + beside) + 1.0 / wheel.tyre_stiffness)
        return float(total)

    def refuse(self, design: Design, step: float) -> None:
        """Raise ValueError for a design that this model cannot be, or not with this step [s]."""
        if len(design.struts) != len(self.struts):
            raise ValueError(
                f"the design has {len(design.struts)} struts, the car {len(self.struts)}"
            )
        for strut, travel in zip(design.struts, self.travels, strict=True):
            self._refuse(strut, 1.0 / float(travel @ np.linalg.solve(self.mass, travel)), step)

    def _refuse(self, strut: Design, effective: float, step: float) -> None:
        if strut.inertance == 0.0 and (self.layout == "S3" or self.case.has_series):
            raise ValueError(f"{self.layout}: inertance is 0; give one, or take layout S1")
        unknown = set(strut.parameters) - set(self.case.parameters)
        if unknown:
            raise ValueError(
                f"case {self.case.name!r} has no parameter {', '.join(sorted(unknown))}; "
                f"it has {', '.join(self.case.parameters) or 'none'}"
            )
        values = {**self.case.parameters, **strut.parameters}
        if self.implicit or self.layout == "S1" or "transition_velocity" not in values:
            return
        level = max(values.get("coulomb_force", 0.0), values.get("static_force", 0.0))
        slope = level / values["transition_velocity"]
        mass = 0.0 if self.case.has_series else strut.inertance
        mass += effective if self.layout == "S2" else 0.0
        if slope * step > _RATE * mass:
            raise ValueError(
                f"friction of {level:g} N over a width of "
                f"{values['transition_velocity']:g} m/s is too sharp for steps of {step:g} s; "
                f"shorten the step below {_RATE * mass / slope:.2g} s or widen transition_velocity"
            )
