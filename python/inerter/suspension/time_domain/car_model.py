"""A compiled car of any number of axles: where things are in it, and what its step can follow.

The model of a design is that of `inerter.cars.mjcf`. Designs of one layout and case differ in
numbers alone, `FIELDS` of their models, which `mujoco.batch` expands: what the plugin reads from
its configuration is a live parameter, so that it is among them.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from inerter.cars.mjcf import NODES
from inerter.suspension.time_domain.cases import Case
from inerter.suspension.time_domain.design import Design, left_of

Array = NDArray[np.float64]

FIELDS = (
    "tendon_stiffness", "tendon_damping", "jnt_stiffness", "dof_damping", "actuator_armature",
    "numeric_data",
)  # fmt: skip
"""What of a model is of the design."""

# RK4 ends at a rate of 2.78 / step
_RATE = 2.5


@dataclass(frozen=True)
class WheelPlace:
    """`road` control, `height` sensor, `tyre_stiffness` [N/m], `behind` the first axle [m].

    `travel` sensor of the strut above; `static_load` [N] on the tyre; `side` 1 left, -1 right, 0
    where the car has one track; `axle` 0 front, 1 rear; `tyre_damping` [N s/m] and `rate` sensor of
    the wheel's velocity.
    """

    road: int
    height: int
    tyre_stiffness: float
    behind: float = 0.0
    travel: int = 0
    static_load: float = math.inf
    side: int = 0
    axle: int = 0
    tyre_damping: float = 0.0
    rate: int = 0

    @property
    def lead(self) -> float:
        """What the tyre's control has of the road's rate [s]."""
        return self.tyre_damping / self.tyre_stiffness


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
    of
        The model of another design.
    wheels
        Front to rear, of an axle left before right.
    load, body
        Control of a force on the body [N], sensor of the displacement under it [m].
    by_sensors, by_rates
        Accelerations of the body's points from sensor data, or from the rates of the velocities:
        shapes (points, nsensordata), (points, nv).
    mass, points, travels
        Linear coordinates (body, wheels): their mass matrix without inertance, and rows of the
        body's points and of the struts' travels.
    compliance
        (wheels,): share of each wheel's compliance 1/k + 1/kt under the load.
    """

    model: mujoco.MjModel
    one_sided: bool
    layout: str
    case: Case
    car: Any
    implicit: bool
    fineness: int
    of: Callable[[Design], mujoco.MjModel]
    wheels: tuple[WheelPlace, ...]
    load: int
    body: int
    by_sensors: Array
    by_rates: Array
    mass: Array
    points: Array
    travels: Array
    compliance: Array

    def strut(self, design: Design, wheel: WheelPlace) -> Design:
        """What of a design stands above a wheel."""
        return design.struts[min(wheel.axle, len(design.struts) - 1)]

    def accelerations_per_force(self, design: Design) -> Array:
        """Accelerations of the body's points at once per force on the wheels [1/kg].

        Shape (points, wheels). Only an inertance that is rigid between wheel and body hands
        forces on at once.
        """
        struts = [self.strut(design, wheel) for wheel in self.wheels]
        rigid = np.array([
            0.0 if self.case.has_series or left_of(self.layout, s) != "S2" else s.inertance
            for s in struts
        ])  # fmt: skip
        mass = self.mass + self.travels.T @ (rigid[:, None] * self.travels)
        found = self.points @ np.linalg.inv(mass)[:, -len(self.wheels) :]
        return np.where(rigid.any(), found, 0.0)

    def static_compliance(self, design: Design) -> float | None:
        """Displacement per load at rest [m/N]; None where something sticks there."""
        total = 0.0
        for wheel, share in zip(self.wheels, self.compliance, strict=True):
            strut = self.strut(design, wheel)
            values = {**self.case.parameters, **strut.parameters}
            layout = left_of(self.layout, strut)
            # behind a damper alone a device yields
            if layout not in ("S1", "SR", "S3", "S5") and self.case.friction != "none":
                return None
            stiffness = strut.stiffness + _held_by(layout, strut, values.get("stiffness", 0.0))
            total += share * (1.0 / stiffness + 1.0 / wheel.tyre_stiffness)
        return float(total)

    def refuse(self, design: Design, step: float) -> None:
        """Raise ValueError for a design that this model cannot be, or not with this step [s]."""
        axles = {wheel.axle for wheel in self.wheels}
        if len(design.struts) != len(axles):
            raise ValueError(f"the design has {len(design.struts)} struts, the car {len(axles)}")
        for wheel, travel in zip(self.wheels, self.travels, strict=True):
            effective = 1.0 / float(travel @ np.linalg.solve(self.mass, travel))
            self._refuse(self.strut(design, wheel), effective, step)

    def _refuse(self, strut: Design, effective: float, step: float) -> None:
        layout = left_of(self.layout, strut)
        if strut.inertance == 0.0 and (layout in NODES or self.case.has_series):
            raise ValueError(f"{self.layout}: inertance is 0; give one, or take layout S1")
        unknown = set(strut.parameters) - set(self.case.parameters)
        if unknown:
            raise ValueError(
                f"case {self.case.name!r} has no parameter {', '.join(sorted(unknown))}; "
                f"it has {', '.join(self.case.parameters) or 'none'}"
            )
        values = {**self.case.parameters, **strut.parameters}
        if self.implicit or layout in ("S1", "SR") or "transition_velocity" not in values:
            return
        level = max(values.get("coulomb_force", 0.0), values.get("static_force", 0.0))
        slope = level / values["transition_velocity"]
        mass = 0.0 if self.case.has_series else strut.inertance
        mass += effective if layout == "S2" else 0.0
        if slope * step > _RATE * mass:
            raise ValueError(
                f"friction of {level:g} N over a width of "
                f"{values['transition_velocity']:g} m/s is too sharp for steps of {step:g} s; "
                f"shorten the step below {_RATE * mass / slope:.2g} s or widen transition_velocity"
            )


def _held_by(layout: str, strut: Design, stiffness: float) -> float:
    """What a spring of the device [N/m] adds to the stiffness at rest."""
    if layout == "S2" or not stiffness:
        return stiffness
    springs = strut.springs
    kb = springs.get("relaxation_stiffness", math.inf)
    if layout in ("S4", "S6"):
        return 1.0 / (1.0 / kb + 1.0 / stiffness)
    if layout in ("SW7", "SW8"):
        k1, k2 = springs["damper_stiffness"], springs["inerter_stiffness"]
        yields = 1.0 / k1 + (1.0 / kb if layout == "SW8" else 0.0)
        return 1.0 / (yields + 1.0 / (k2 + stiffness)) - 1.0 / (yields + 1.0 / k2)
    return 0.0
