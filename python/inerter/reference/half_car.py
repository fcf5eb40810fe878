"""Half-car: heave and pitch of a body on a front and a rear strut.

Equations and signs in `vehicle.py`; front at x = l_f, rear at x = -l_r, no roll.
Default parameters: `HALF_CAR` of `inerter/model_parameters.py`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Unpack

from numpy.typing import ArrayLike

from inerter.model_parameters import HALF_CAR

from .structure import RunOptions, Structure
from .vehicle import Corner, Road, VehicleResult, assemble, corner_of, drive, require_positive


@dataclass(frozen=True)
class HalfCarResult(VehicleResult):
    """A run of the half-car; wheels in the order front, rear."""


@dataclass(frozen=True, kw_only=True)
class HalfCar:
    """Half-car; the layouts of its two struts may differ.

    The state is (z, theta, w_f, w_r), their rates, then the own states of the front and the rear
    strut (see `Strut`).

    Raises
    ------
    ValueError
        A mass, inertia or distance is not positive.
    """

    body_mass: float = HALF_CAR.body_mass
    pitch_inertia: float = HALF_CAR.pitch_inertia
    front: Corner = field(default_factory=lambda: corner_of(HALF_CAR.front))
    rear: Corner = field(default_factory=lambda: corner_of(HALF_CAR.rear))

    def __post_init__(self) -> None:
        """Check what was given, see Raises."""
        require_positive(self, "body_mass", "pitch_inertia")

    @cached_property
    def structure(self) -> Structure:
        """The car as coordinates (z, theta, w_f, w_r) with two struts."""
        rows = [[1.0, -self.front.distance], [1.0, self.rear.distance]]
        return assemble((self.body_mass, self.pitch_inertia), rows, (self.front, self.rear))

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
    ) -> HalfCarResult:
        """Drive over a road.

        Parameters
        ----------
        roads
            Displacement [m] under the front and under the rear wheel, each called with a time.
        body_load
            time -> (force [N] up, pitch moment [N m]) on the body; none if not given.
        times, options
            As for `Structure.simulate`.

        Raises
        ------
        ValueError
            Not two roads, a wrong initial state, times that do not increase.
        RuntimeError
            The solver gave up.
        """
        _, shared = drive(
            self.structure,
            (self.front, self.rear),
            roads,
            times,
            body_load,
            **options,
        )
        return HalfCarResult(**shared)  # pyright: ignore[reportArgumentType]
