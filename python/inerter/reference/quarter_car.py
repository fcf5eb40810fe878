"""Quarter-car with an inerter in its strut.

    m_s zs'' = F_s - u,   m_u zu'' = u - F_t,   F_t = k_t (zu - zr)

Symbols: zs, zu, zr body, wheel, road displacement [m] from equilibrium, positive up; u the force
of the strut (layouts S1, S2, S3, see `strut.py`) at the elongation zs - zu; m_s, m_u [kg],
k_t [N/m]; F_s a force on the body [N].
Sign: u is tension positive: an extended strut pulls the body down and the wheel up.
Range: small motions about equilibrium.
Source: Wang and Su, "Inerter nonlinearities and the impact on suspension control", ACC 2008.
With a `static_load` the tyre leaves the road where it would have to pull by more: F_t <= load.
Not modelled: gravity, tyre damping; lift-off without `static_load`.

The device's force depends on the acceleration it causes; that is solved exactly, see
`structure.py`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from inerter.model_parameters import QUARTER_CAR

from .device import ReferenceDevice
from .structure import RunOptions, Structure, StructureRun
from .strut import LAYOUTS, Strut

__all__ = ["LAYOUTS", "QuarterCar", "QuarterCarResult"]


@dataclass(frozen=True, kw_only=True)
class QuarterCarResult:
    """A run of the quarter-car, arrays of shape (times,), SI units.

    `device_displacement`, `device_velocity`, `device_force`, `device_state` belong to the device:
    in S2 its displacement is the strut's, in S3 its own, in S1 (no device) zeros. `device_state` is
    the friction state, `device_states` has all of them, shape (times, nstate).
    """

    time: NDArray[np.float64]
    body_displacement: NDArray[np.float64]
    wheel_displacement: NDArray[np.float64]
    body_velocity: NDArray[np.float64]
    wheel_velocity: NDArray[np.float64]
    body_acceleration: NDArray[np.float64]
    wheel_acceleration: NDArray[np.float64]
    suspension_travel: NDArray[np.float64]
    strut_force: NDArray[np.float64]
    tyre_force: NDArray[np.float64]
    device_displacement: NDArray[np.float64]
    device_velocity: NDArray[np.float64]
    device_force: NDArray[np.float64]
    device_state: NDArray[np.float64]
    device_states: NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class QuarterCar:
    """Quarter-car of Wang and Su: the defaults are `QUARTER_CAR` with the damper of its S2.

    `device` stands in the strut as `layout` says; the default one does nothing. `static_load` [N]
    on the tyre; without end it pulls on the road, as in the paper.

    The state is (zs, zu, zs', zu'), for S3 then (y, y') (y alone if the device has a series
    element), then the device's states.

    Raises
    ------
    ValueError
        Unknown layout; a mass, tyre stiffness, static load or (S3) damping or inertance that is not
        positive.
    """

    layout: str = "S2"
    stiffness: float = QUARTER_CAR.stiffness
    damping: float = QUARTER_CAR.struts["S2"].damping
    device: ReferenceDevice = field(default_factory=ReferenceDevice)
    sprung_mass: float = QUARTER_CAR.sprung_mass
    unsprung_mass: float = QUARTER_CAR.unsprung_mass
    tyre_stiffness: float = QUARTER_CAR.tyre_stiffness
    static_load: float = np.inf

    def __post_init__(self) -> None:
        """Check what was given, see Raises."""
        for name in ("sprung_mass", "unsprung_mass", "tyre_stiffness", "static_load"):
            if not getattr(self, name) > 0.0:
                raise ValueError(f"{name}: {getattr(self, name)} must be above 0")
        _ = self.structure

    @cached_property
    def structure(self) -> Structure:
        """The car as coordinates (zs, zu) with one strut."""
        strut = Strut(
            layout=self.layout, stiffness=self.stiffness, damping=self.damping, device=self.device
        )
        return Structure(
            mass=np.diag([self.sprung_mass, self.unsprung_mass]),
            damping=np.zeros((2, 2)),
            stiffness=np.diag([0.0, self.tyre_stiffness]),
            directions=np.array([[1.0], [-1.0]]),
            struts=(strut,),
            pull=None if np.isinf(self.static_load) else np.array([np.inf, self.static_load]),
        )

    @property
    def nstate(self) -> int:
        """Number of states."""
        return self.structure.nstate

    def rates(
        self, state: NDArray[np.float64], road: float, body_force: float = 0.0
    ) -> NDArray[np.float64]:
        """Rate of the state, shape (nstate,), at road displacement [m] and body force [N]."""
        forces = np.array([body_force, self.tyre_stiffness * road])
        return self.structure.rates(np.asarray(state, dtype=np.float64), forces)

    def simulate(
        self,
        road: Callable[[float], float],
        times: ArrayLike,
        *,
        body_force: Callable[[float], float] | None = None,
        **options: Unpack[RunOptions],
    ) -> QuarterCarResult:
        """Drive over a road.

        Parameters
        ----------
        road
            zr(t) [m], called with one time [s].
        body_force
            F_s(t) [N] on the body; none if not given.
        times, options
            As for `Structure.simulate`.

        Raises
        ------
        ValueError
            A wrong initial state, or times that do not increase.
        RuntimeError
            The solver gave up.
        """
        push = body_force if body_force is not None else _no_force

        def forces(t: float) -> NDArray[np.float64]:
            return np.array([float(push(t)), self.tyre_stiffness * float(road(t))])

        run = self.structure.simulate(forces, times, **options)
        return self._result(run, np.array([float(road(t)) for t in run.time]))

    def _result(self, run: StructureRun, roads: NDArray[np.float64]) -> QuarterCarResult:
        """The run in the car's own words."""
        states = run.device_states[0]
        friction = "friction_state" in self.device.state_names and self.layout != "S1"
        return QuarterCarResult(
            time=run.time,
            body_displacement=run.position[:, 0],
            wheel_displacement=run.position[:, 1],
            body_velocity=run.velocity[:, 0],
            wheel_velocity=run.velocity[:, 1],
            body_acceleration=run.acceleration[:, 0],
            wheel_acceleration=run.acceleration[:, 1],
            suspension_travel=run.position[:, 0] - run.position[:, 1],
            strut_force=run.strut_force[:, 0],
            tyre_force=np.minimum(
                self.tyre_stiffness * (run.position[:, 1] - roads), self.static_load
            ),
            device_displacement=run.device_displacement[:, 0],
            device_velocity=run.device_velocity[:, 0],
            device_force=run.device_force[:, 0],
            device_state=states[:, 0] if friction else np.zeros(run.time.size),
            device_states=states,
        )


def _no_force(_: float) -> float:
    return 0.0
