"""Shear frame with inerters between its floors.

    m_i a_i = f_i - V_i + V_(i+1) - sum of device forces,   V_i = k_i d_i + c_i d_i'
    d_i = u_i - u_(i-1),   a_i = u_i'' + ground acceleration
    elongation of a device: u_upper - u_lower

Symbols: u_i displacement of floor i [m] relative to the ground (floor 0), m_i [kg], k_i [N/m],
c_i [N s/m] of storey i, f_i force on floor i [N]. A device with a series element is a tuned
inerter damper: spring and damper in series with the inertance.
Sign: device force tension positive.
Range: small sway; devices may skip floors.
Source: Lazar, Neild and Wagg, Earthquake Eng. Struct. Dyn. 43(8), 2014.
Not modelled: gravity (P-delta), bending of the columns, braces' masses.

For linear devices the answer is also there in closed form: `frame_state_matrix` for the matrix
exponential, `frame_receptance` from the devices' impedances. They share nothing with `simulate`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import eigh

from inerter.model_parameters import FRAME

from .device import ReferenceDevice
from .structure import Array, RunOptions, Structure
from .strut import Strut


@dataclass(frozen=True, kw_only=True)
class FloorDevice:
    """A device between floors `lower` and `upper`; 0 is the ground, floors need not be neighbours.

    Raises ValueError unless 0 <= lower < upper.
    """

    lower: int
    upper: int
    device: ReferenceDevice

    def __post_init__(self) -> None:
        """Check what was given."""
        if not 0 <= self.lower < self.upper:
            raise ValueError(
                f"lower: {self.lower} must be a floor below upper {self.upper}, 0 is the ground"
            )


FRAME_DEVICE = ReferenceDevice(
    inertance=FRAME.inertance,
    series_stiffness=FRAME.series_stiffness,
    series_damping=FRAME.series_damping,
)
"""The tuned inerter damper of `FRAME`."""


@dataclass(frozen=True, kw_only=True)
class FrameResult:
    """A run: floors of shape (times, floors), devices of shape (times, devices), SI units.

    Displacement, velocity and acceleration are relative to the ground; `absolute_acceleration`
    is not. `device_states` has one array (times, nstate) per device.
    """

    time: Array
    displacement: Array
    velocity: Array
    acceleration: Array
    absolute_acceleration: Array
    device_displacement: Array
    device_force: Array
    device_states: tuple[Array, ...]


@dataclass(frozen=True, kw_only=True)
class ShearFrame:
    """Frame of n storeys, tuples of length n from the lowest up; defaults: `FRAME`.

    The state is (u, u', states of each device in turn).

    Raises
    ------
    ValueError
        The tuples differ in length, a mass or stiffness is not positive, a device stands on a
        floor that is not there.
    """

    storey_mass: tuple[float, ...] = FRAME.storey_mass
    storey_stiffness: tuple[float, ...] = FRAME.storey_stiffness
    storey_damping: tuple[float, ...] = FRAME.storey_damping
    devices: tuple[FloorDevice, ...] = (FloorDevice(lower=0, upper=1, device=FRAME_DEVICE),)

    def __post_init__(self) -> None:
        """Check what was given, see Raises."""
        lengths = {
            len(part) for part in (self.storey_mass, self.storey_stiffness, self.storey_damping)
        }
        if len(lengths) != 1:
            raise ValueError(
                f"storey_mass, storey_stiffness, storey_damping: lengths {sorted(lengths)} differ"
            )
        for name in ("storey_mass", "storey_stiffness"):
            if min(getattr(self, name)) <= 0.0:
                raise ValueError(f"{name}: {getattr(self, name)} must be above 0")
        for placed in self.devices:
            if placed.upper > self.floors:
                raise ValueError(f"upper: {placed.upper}, but the frame has {self.floors} floors")

    @property
    def floors(self) -> int:
        """Number of floors above the ground."""
        return len(self.storey_mass)

    @property
    def directions(self) -> Array:
        """Elongation of each device per floor displacement, shape (floors, devices)."""
        found = np.zeros((self.floors, len(self.devices)))
        for i, placed in enumerate(self.devices):
            found[placed.upper - 1, i] = 1.0
            if placed.lower:
                found[placed.lower - 1, i] = -1.0
        return found

    @cached_property
    def structure(self) -> Structure:
        """The frame as coordinates u with its devices."""
        return Structure(
            mass=np.diag(self.storey_mass),
            damping=storey_matrix(self.storey_damping),
            stiffness=storey_matrix(self.storey_stiffness),
            directions=self.directions,
            struts=tuple(Strut(layout="S2", device=placed.device) for placed in self.devices),
        )

    @property
    def nstate(self) -> int:
        """Number of states."""
        return self.structure.nstate

    def simulate(
        self,
        times: ArrayLike,
        *,
        ground_acceleration: Callable[[float], float] | None = None,
        floor_forces: Callable[[float], ArrayLike] | None = None,
        **options: Unpack[RunOptions],
    ) -> FrameResult:
        """Shake the frame.

        Parameters
        ----------
        ground_acceleration
            time [s] -> acceleration of the ground [m/s^2].
        floor_forces
            time [s] -> forces on the floors [N], shape (floors,).
        times, options
            As for `Structure.simulate`.

        Raises
        ------
        ValueError
            A wrong initial state, or times that do not increase.
        RuntimeError
            The solver gave up.
        """
        mass = np.array(self.storey_mass)

        def ground(t: float) -> float:
            return 0.0 if ground_acceleration is None else float(ground_acceleration(t))

        def forces(t: float) -> Array:
            pushed = 0.0 if floor_forces is None else np.asarray(floor_forces(t), dtype=np.float64)
            return pushed - mass * ground(t)

        run = self.structure.simulate(forces, times, **options)
        below = np.array([[ground(float(t))] for t in run.time])
        return FrameResult(
            time=run.time,
            displacement=run.position,
            velocity=run.velocity,
            acceleration=run.acceleration,
            absolute_acceleration=run.acceleration + below,
            device_displacement=run.device_displacement,
            device_force=run.device_force,
            device_states=run.device_states,
        )


def storey_matrix(values: Sequence[float]) -> Array:
    """The matrix of a chain that begins at the ground, from one value per storey."""
    n = len(values)
    chain = np.eye(n) - np.eye(n, k=-1)
    return chain.T @ np.diag(values) @ chain


def frame_modes(frame: ShearFrame) -> tuple[Array, Array]:
    """Undamped modes of the bare frame: frequencies [Hz] (n,) and shapes (n, n) in columns."""
    squares, shapes = eigh(storey_matrix(frame.storey_stiffness), np.diag(frame.storey_mass))
    frequencies = np.asarray(np.sqrt(squares), dtype=np.float64) / (2.0 * np.pi)
    return frequencies, shapes


def frame_state_matrix(frame: ShearFrame) -> Array:
    """Matrix A of the linear frame's y' = A y, y as in `ShearFrame`.

    Only `inertance`, `viscous`, `stiffness`, `series_stiffness`, `series_damping` and
    `flywheel_viscous` of the devices are read.
    """
    n = frame.floors
    mass = np.diag(np.array(frame.storey_mass))
    damping, stiffness = storey_matrix(frame.storey_damping), storey_matrix(frame.storey_stiffness)
    tuned = [i for i, placed in enumerate(frame.devices) if placed.device.has_series]
    size = 2 * n + 2 * len(tuned)
    force_rows = np.zeros((n, size))
    own = np.zeros((2 * len(tuned), size))
    for i, placed in enumerate(frame.devices):
        device, e = placed.device, frame.directions[:, i]
        square = np.outer(e, e)
        damping = damping + device.viscous * square
        stiffness = stiffness + device.stiffness * square
        if i not in tuned:
            mass = mass + device.total_inertance * square
            damping = damping + device.flywheel_viscous * square
            continue

        # spring and damper between the floor and the flywheel: F_s = k_s s + c_s (v - w)
        at = 2 * n + 2 * tuned.index(i)
        pull = np.zeros(size)
        pull[n : 2 * n] = device.series_damping * e
        pull[at], pull[at + 1] = device.series_stiffness, -device.series_damping
        force_rows -= np.outer(e, pull)
        row = at - 2 * n
        own[row, n : 2 * n], own[row, at + 1] = e, -1.0
        own[row + 1] = pull / device.total_inertance
        own[row + 1, at + 1] -= device.flywheel_viscous / device.total_inertance

    force_rows[:, :n] -= stiffness
    force_rows[:, n : 2 * n] -= damping
    moving = np.zeros((n, size))
    moving[:, n : 2 * n] = np.eye(n)
    driven = np.asarray(np.linalg.solve(mass, force_rows), dtype=np.float64)
    return np.vstack((moving, driven, own))


def frame_receptance(frame: ShearFrame, frequencies: ArrayLike) -> NDArray[np.complex128]:
    """Floor displacement per ground acceleration [s^2], shape (frequencies, floors), in Hz.

    Each linear device is its dynamic stiffness: k + i w c + Z with the branch
    Z = 1 / (1 / (k_s + i w c_s) + 1 / (i w c_w - w^2 b)), the first term left out if rigid.
    """
    mass = np.diag(np.array(frame.storey_mass))
    found: list[NDArray[np.complex128]] = []
    for frequency in np.atleast_1d(np.asarray(frequencies, dtype=np.float64)):
        p = 2j * np.pi * frequency
        dynamic = mass * p * p + storey_matrix(frame.storey_damping) * p
        dynamic = dynamic + storey_matrix(frame.storey_stiffness)
        for placed, e in zip(frame.devices, frame.directions.T, strict=True):
            device = placed.device
            branch = (device.total_inertance * p + device.flywheel_viscous) * p
            if device.has_series:
                series = device.series_stiffness + device.series_damping * p
                branch = series * branch / (series + branch)
            beside = device.stiffness + device.viscous * p
            dynamic = dynamic + (beside + branch) * np.outer(e, e)
        found.append(np.linalg.solve(dynamic, -mass @ np.ones(frame.floors)).astype(np.complex128))
    return np.array(found)
