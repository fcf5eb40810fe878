"""Half- and full cars as linear bodies on two axles.

Up is positive, pitch is not a coordinate of its own: the heave-pitch body is described by its
displacements above the two axles, xf and xr. With mass m, pitch inertia I, distances lf, lr from
the centre of mass to the axles and L = lf + lr its kinetic energy is x'^T M x' / 2 with

    M = [[m lr^2 + I, m lf lr - I], [m lf lr - I, m lf^2 + I]] / L^2

so a body with I = m lf lr is two quarter-cars, m lr / L in front and m lf / L behind. The centre of
mass moves by (lr xf + lf xr) / L.

A full car that is alike on both sides splits exactly into the half-car of one side, driven by the
mean of the left and the right road, and a roll plane, driven by half their difference: a body with
one displacement x = phi track / 2 of mass 2 I_roll / track^2 on the same two axles.

Not modelled: loss of contact, large angles.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from inerter.model_parameters import FULL_CAR, HALF_CAR, AxleParameters
from inerter.suspension.quarter_car import GRAVITY, QuarterCar, not_negative, positive


@dataclass(frozen=True, kw_only=True)
class Axle:
    """One wheel and its place.

    `distance` [m] from the centre of mass to the axle, `wheel_mass` [kg], `tyre_stiffness` [N/m],
    `stiffness` [N/m] of the strut's spring as published; optima take their own.
    `anti_roll_stiffness` [N/m] on each wheel of the axle as the car rolls, of a full car.
    `tyre_damping` [N s/m] beside the tyre's spring.

    Raises
    ------
    ValueError
        A value is not positive, or a damping negative.
    """

    distance: float
    wheel_mass: float
    tyre_stiffness: float
    stiffness: float
    anti_roll_stiffness: float = 0.0
    tyre_damping: float = 0.0

    def __post_init__(self) -> None:
        positive(self, ("distance", "wheel_mass", "tyre_stiffness", "stiffness"))
        not_negative(self, ("tyre_damping",))


@dataclass(frozen=True)
class Plane:
    """A body of one or two displacements on two axles.

    Attributes
    ----------
    inertia
        Mass matrix [kg] of the body's coordinates, n x n: n = 2 above the axles; n = 1 is a body
        whose two points above the axles move as one.
    wheel_masses, tyre_stiffnesses
        [kg], [N/m], front and rear.
    weight
        Its share in mean squares over the wheels.
    bars
        Stiffness beside the struts, front and rear [N/m]: anti-roll bars.
    turn
        Angle per displacement [rad/m]: pitch per rise of the rear above the front, roll per rise.
    tyre_dampings
        [N s/m], front and rear.
    """

    inertia: tuple[tuple[float, ...], ...]
    wheel_masses: tuple[float, float]
    tyre_stiffnesses: tuple[float, float]
    weight: float = 1.0
    bars: tuple[float, float] = (0.0, 0.0)
    turn: float = 0.0
    tyre_dampings: tuple[float, float] = (0.0, 0.0)

    @property
    def shape(self) -> NDArray[np.float64]:
        """Displacements above the axles per coordinate of the body, shape (2, n)."""
        return np.eye(2) if len(self.inertia) == 2 else np.ones((2, 1))


@dataclass(frozen=True, kw_only=True)
class HalfCar:
    """One side of a car: `body_mass` m [kg], `pitch_inertia` I [kg m^2], one wheel of each axle.

    Raises
    ------
    ValueError
        A value is not positive.
    """

    body_mass: float
    pitch_inertia: float
    front: Axle
    rear: Axle
    name: str = field(default="half", init=False)

    def __post_init__(self) -> None:
        positive(self, ("body_mass", "pitch_inertia"))

    @property
    def wheelbase(self) -> float:
        """Distance between the axles [m]."""
        return self.front.distance + self.rear.distance

    @property
    def sides(self) -> int:
        """One: the load on the centre of mass is carried by the two struts."""
        return 1

    @property
    def side(self) -> HalfCar:
        """Itself."""
        return self

    @property
    def planes(self) -> tuple[Plane, ...]:
        """Heave and pitch."""
        return (self.heave_pitch(),)

    @property
    def lever(self) -> NDArray[np.float64]:
        """Displacement of the centre of mass per displacement above each axle, shape (2,)."""
        return np.array([self.rear.distance, self.front.distance]) / self.wheelbase

    def heave_pitch(self, weight: float = 1.0) -> Plane:
        """The plane of motion of the half-car."""
        lf, lr, m, i = self.front.distance, self.rear.distance, self.body_mass, self.pitch_inertia
        square = self.wheelbase**2
        across = (m * lf * lr - i) / square
        return Plane(
            (((m * lr * lr + i) / square, across), (across, (m * lf * lf + i) / square)),
            (self.front.wheel_mass, self.rear.wheel_mass),
            (self.front.tyre_stiffness, self.rear.tyre_stiffness),
            weight,
            turn=1.0 / self.wheelbase,
            tyre_dampings=(self.front.tyre_damping, self.rear.tyre_damping),
        )

    @property
    def static_loads(self) -> tuple[float, float]:
        """Weight on the tyre in front and at the rear [N]."""
        front, rear = (
            GRAVITY * (self.body_mass * float(share) + axle.wheel_mass)
            for share, axle in zip(self.lever, (self.front, self.rear), strict=True)
        )
        return front, rear

    def corners(self) -> tuple[QuarterCar, QuarterCar]:
        """The quarter-cars that the axles would be if the body were free between them."""
        front, rear = (
            QuarterCar(
                sprung_mass=self.body_mass * share,
                unsprung_mass=axle.wheel_mass,
                tyre_stiffness=axle.tyre_stiffness,
                tyre_damping=axle.tyre_damping,
            )
            for share, axle in zip(self.lever.tolist(), (self.front, self.rear), strict=True)
        )
        return front, rear

    def static_compliance(self, stiffnesses: tuple[float, float]) -> float:
        """Displacement of the centre of mass per load on it at rest [m/N], whatever the layout."""
        front, rear = (
            float(share) ** 2 * (1.0 / k + 1.0 / axle.tyre_stiffness)
            for share, k, axle in zip(self.lever, stiffnesses, (self.front, self.rear), strict=True)
        )
        return front + rear


@dataclass(frozen=True, kw_only=True)
class FullCar:
    """A car that is alike on both sides: `body_mass` [kg], inertias [kg m^2], `track` [m].

    `front` and `rear` are one of each axle's two wheels. `correlation`, 0 to 1, is that between the
    left and the right road at all wavelengths; a car with one track does not feel it, so it stands
    here. On a road that is rough alike in all directions it falls with the wavelength from 1
    to 0; at this track it is 0.5, the default, for waves of 7.5 m (3.3 Hz at 25 m/s), which lies
    between the modes of the body and those of the wheels.

    Raises
    ------
    ValueError
        A value is not positive, or the correlation not within 0 to 1.
    """

    body_mass: float
    pitch_inertia: float
    roll_inertia: float
    track: float
    front: Axle
    rear: Axle
    correlation: float = 0.5
    name: str = field(default="full", init=False)

    def __post_init__(self) -> None:
        positive(self, ("body_mass", "pitch_inertia", "roll_inertia", "track"))
        if not 0.0 <= self.correlation <= 1.0:
            raise ValueError(f"correlation is {self.correlation:g}: give a number from 0 to 1")

    @property
    def wheelbase(self) -> float:
        """Distance between the axles [m]."""
        return self.front.distance + self.rear.distance

    @property
    def sides(self) -> int:
        """Two: each carries half the load on the centre of mass."""
        return 2

    @property
    def side(self) -> HalfCar:
        """The half-car of one side."""
        return HalfCar(
            body_mass=self.body_mass / 2.0,
            pitch_inertia=self.pitch_inertia / 2.0,
            front=self.front,
            rear=self.rear,
        )

    @property
    def planes(self) -> tuple[Plane, ...]:
        """Heave and pitch, then roll; a plane that the road does not drive is left out."""
        together, apart = (1.0 + self.correlation) / 2.0, (1.0 - self.correlation) / 2.0
        side = self.side.heave_pitch(together)
        roll = Plane(
            ((2.0 * self.roll_inertia / self.track**2,),),
            side.wheel_masses,
            side.tyre_stiffnesses,
            apart,
            (self.front.anti_roll_stiffness, self.rear.anti_roll_stiffness),
            turn=2.0 / self.track,
            tyre_dampings=side.tyre_dampings,
        )
        return (side, roll) if apart > 0.0 else (side,)


Vehicle = HalfCar | FullCar


def half_car() -> HalfCar:
    """One side of the published car, see `HALF_CAR` of `inerter/model_parameters.py`."""
    return HalfCar(
        body_mass=HALF_CAR.body_mass,
        pitch_inertia=HALF_CAR.pitch_inertia,
        front=_axle(HALF_CAR.front),
        rear=_axle(HALF_CAR.rear),
    )


def full_car(correlation: float = 0.5) -> FullCar:
    """The published car, see `FULL_CAR` of `inerter/model_parameters.py`."""
    return FullCar(
        body_mass=FULL_CAR.body_mass,
        pitch_inertia=FULL_CAR.pitch_inertia,
        roll_inertia=FULL_CAR.roll_inertia,
        track=FULL_CAR.track,
        front=_axle(FULL_CAR.front),
        rear=_axle(FULL_CAR.rear),
        correlation=correlation,
    )


def _axle(axle: AxleParameters) -> Axle:
    return Axle(
        distance=axle.distance,
        wheel_mass=axle.wheel_mass,
        tyre_stiffness=axle.tyre_stiffness,
        stiffness=axle.stiffness,
    )
