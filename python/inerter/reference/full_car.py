"""Full car: heave, pitch and roll of a body on four struts.

Equations and signs in `vehicle.py`; wheels in the order front left, front right, rear left, rear
right. Default parameters: `FULL_CAR` of `inerter/model_parameters.py`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Unpack

from numpy.typing import ArrayLike

from inerter.model_parameters import FULL_CAR

from .structure import Array, RunOptions, Structure
from .vehicle import Corner, Road, VehicleResult, assemble, corner_of, drive, require_positive


@dataclass(frozen=True, kw_only=True)
class FullCarResult(VehicleResult):
    """A run of the full car: as the half-car's, with the roll angle [rad]."""

    roll: Array
    roll_velocity: Array
    roll_acceleration: Array


@dataclass(frozen=True, kw_only=True)
class FullCar:
    """Full car; every strut may be another.

    The state is (z, theta, phi, four wheels), their rates, then the own states of the four struts
    (see `Strut`). `track` [m] is the distance between left and right wheels.

    Raises
    ------
    ValueError
        A mass, inertia or distance is not positive.
    """

    body_mass: float = FULL_CAR.body_mass
    pitch_inertia: float = FULL_CAR.pitch_inertia
    roll_inertia: float = FULL_CAR.roll_inertia
    track: float = FULL_CAR.track
    front_left: Corner = field(default_factory=lambda: corner_of(FULL_CAR.front))
    front_right: Corner = field(default_factory=lambda: corner_of(FULL_CAR.front))
    rear_left: Corner = field(default_factory=lambda: corner_of(FULL_CAR.rear))
    rear_right: Corner = field(default_factory=lambda: corner_of(FULL_CAR.rear))

    def __post_init__(self) -> None:
        """Check what was given, see Raises."""
        require_positive(self, "body_mass", "pitch_inertia", "roll_inertia", "track")

    @property
    def corners(self) -> tuple[Corner, Corner, Corner, Corner]:
        """The four corners in their order."""
        return self.front_left, self.front_right, self.rear_left, self.rear_right

    @cached_property
    def structure(self) -> Structure:
        """The car as coordinates (z, theta, phi, wheels) with four struts."""
        half = self.track / 2.0
        rows = [
            [1.0, -self.front_left.distance, half],
            [1.0, -self.front_right.distance, -half],
            [1.0, self.rear_left.distance, half],
            [1.0, self.rear_right.distance, -half],
        ]
        body = (self.body_mass, self.pitch_inertia, self.roll_inertia)
        return assemble(body, rows, self.corners)

    @property
    def nstate(self) -> int:
        """Number of states."""
        return self.structure.nstate

    def simulate(
        self,
        roads: Sequence[Road],
        times: ArrayLike,
        *,
        body_load: Callable[[float], ArrayLike] | None = None,
        **options: Unpack[RunOptions],
    ) -> FullCarResult:
        """Drive over a road.

        Parameters
        ----------
        roads
            Displacement [m] under each of the four wheels, each called with a time [s].
        body_load
            time -> (force [N] up, pitch moment, roll moment [N m]) on the body; none if not given.
        times, options
            As for `Structure.simulate`.

        Raises
        ------
        ValueError
            Not four roads, a wrong initial state, times that do not increase.
        RuntimeError
            The solver gave up.
        """
        run, shared = drive(
            self.structure,
            self.corners,
            roads,
            times,
            body_load,
            **options,
        )
        return FullCarResult(
            roll=run.position[:, 2],
            roll_velocity=run.velocity[:, 2],
            roll_acceleration=run.acceleration[:, 2],
            **shared,  # pyright: ignore[reportArgumentType]
        )
