"""The fluid inerter on its shaker: dry (piston and friction) and complete (filled with water).

    (m_a + m_p) x'' + c x' + k x = alpha_1 q' - F_device(x, x', z)
    L q'' + R q' + alpha_2 x' = G u(t)

Symbols: x piston displacement [m], q charge [C] (with it, unlike the current, the mass matrix
diag(m_a + m_p, L) is regular), u input voltage [V], others in `ShakerParameters`. The device
stands between piston (terminal 2) and ground.
Dry: Brown-McPhee friction with its viscous part. Complete: behind the same friction the water in
its channel, b = rho l A1^2 / A2, coupled by the compressible column k_f = k0 [1 + k' (x - x2)],
c_f, and held by the trapped air: k_a of the expanded gas law and c_a; x2 is the displacement of
the water. All of them are laws of the device (series element, gas, flywheel_viscous).
Sign: tension positive: F_device > 0 pulls the piston back to where the device is shorter.
Source: fluid inerter experiment (shaker, friction, sweep, air and water laws and their numbers).
Not modelled: channel losses beyond c_f and c_a, cavitation that makes the air column grow.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.signal import csd

from inerter.model_parameters import FLUID_INERTER, SHAKER, FluidInerterParameters, ShakerParameters

from .device import ReferenceDevice
from .structure import Array, RunOptions, Structure
from .strut import Strut

SWEEP_START, SWEEP_END, SWEEP_TIME = 0.5, 12.0, 60.0
"""The sweep's frequencies [Hz] and its duration [s]."""


def dry_device(parameters: FluidInerterParameters = FLUID_INERTER) -> ReferenceDevice:
    """The device without water: its friction."""
    return ReferenceDevice(
        friction="brown_mcphee",
        coulomb_force=parameters.coulomb_force,
        static_force=parameters.static_force,
        stribeck_velocity=parameters.stribeck_velocity,
        viscous=parameters.viscous,
    )


def complete_device(
    parameters: FluidInerterParameters = FLUID_INERTER,
    *,
    air_damping: float = FLUID_INERTER.air_damping_preload[0],
    air_column: float | None = None,
) -> ReferenceDevice:
    """The device with water and trapped air.

    `air_damping` c_a [N s/m]; `air_column` [m], that of `parameters` if not given, 0 for no air
    spring.
    """
    column = parameters.air_column if air_column is None else air_column
    gas: dict[str, float | str] = {}
    if column > 0.0:
        gas = {
            "gas_law": "expanded",
            "gas_pressure": parameters.gas_pressure,
            "gas_exponent": parameters.gas_exponent,
            "gas_volume": parameters.piston_area * column,
        }
    return ReferenceDevice(
        friction="brown_mcphee",
        coulomb_force=parameters.coulomb_force,
        static_force=parameters.static_force,
        stribeck_velocity=parameters.stribeck_velocity,
        viscous=parameters.viscous,
        piston_area=parameters.piston_area,
        channel_area=parameters.channel_area,
        channel_length=parameters.channel_length,
        fluid_density=parameters.fluid_density,
        series_stiffness=parameters.series_stiffness,
        series_hardening=parameters.series_hardening,
        series_damping=parameters.series_damping,
        flywheel_viscous=air_damping,
        **gas,  # pyright: ignore[reportArgumentType]
    )


def sweep_voltage(first: float, last: float, preload: float = 0.0) -> Callable[[float], float]:
    """The published input: a sine of 0.5 to 12 Hz in 60 s, amplitude from `first` to `last` [V].

    `preload` [V] is a constant voltage added to it.
    """
    rate = (SWEEP_END - SWEEP_START) / SWEEP_TIME

    def voltage(t: float) -> float:
        phase = 2.0 * np.pi * (SWEEP_START + 0.5 * rate * t) * t
        amplitude = first + (last - first) * t / SWEEP_TIME
        return float(preload + amplitude * np.sin(phase))

    return voltage


@dataclass(frozen=True, kw_only=True)
class FluidInerterResult:
    """A run, arrays of shape (times,), SI units.

    `force` is what the load cell between armature and piston sees: it moves the piston and
    loads the device, m_p x'' + F_device. `device_states` has the shape (times, nstate);
    `inside` says where the gas law is inside its validity.
    """

    time: Array
    displacement: Array
    velocity: Array
    acceleration: Array
    current: Array
    force: Array
    device_force: Array
    device_states: Array
    inside: Array


@dataclass(frozen=True, kw_only=True)
class FluidInerterTest:
    """Shaker, piston and device; the state is (x, q, x', q', states of the device)."""

    device: ReferenceDevice = field(default_factory=dry_device)
    shaker: ShakerParameters = SHAKER
    piston_mass: float = FLUID_INERTER.piston_mass

    @cached_property
    def structure(self) -> Structure:
        """The test as coordinates (x, q)."""
        shaker = self.shaker
        return Structure(
            mass=np.diag([shaker.armature_mass + self.piston_mass, shaker.inductance]),
            damping=np.array(
                [
                    [shaker.damping, -shaker.force_constant],
                    [shaker.voltage_constant, shaker.resistance],
                ]
            ),
            stiffness=np.diag([shaker.stiffness, 0.0]),
            directions=np.array([[1.0], [0.0]]),
            struts=(Strut(layout="S2", device=self.device),),
        )

    @property
    def nstate(self) -> int:
        """Number of states."""
        return self.structure.nstate

    def simulate(
        self,
        voltage: Callable[[float], float],
        times: ArrayLike,
        **options: Unpack[RunOptions],
    ) -> FluidInerterResult:
        """Drive the shaker with `voltage`: time [s] -> input [V] before the gain.

        Other arguments and what is raised: as for `Structure.simulate`, but rtol is 1e-7 and atol
        1e-10 unless given.
        """

        def forces(t: float) -> Array:
            return np.array([0.0, self.shaker.gain * float(voltage(t))])

        options = RunOptions(rtol=1e-7, atol=1e-10) | options
        run = self.structure.simulate(forces, times, **options)
        x, states = run.position[:, 0], run.device_states[0]
        inside = self.device.gas_valid(x, self.device.state_argument(states))
        return FluidInerterResult(
            time=run.time,
            displacement=x,
            velocity=run.velocity[:, 0],
            acceleration=run.acceleration[:, 0],
            current=run.velocity[:, 1],
            force=self.piston_mass * run.acceleration[:, 0] + run.device_force[:, 0],
            device_force=run.device_force[:, 0],
            device_states=states,
            inside=np.asarray(inside),
        )


def receptance(
    result: FluidInerterResult, segment: float = 8.0
) -> tuple[Array, NDArray[np.complex128]]:
    """Receptance displacement / force of a run: frequencies [Hz] and H [m/N].

    H = G_Fx / G_FF by Welch's method: Hann segments of `segment` seconds, half overlapping, the
    mean of each taken out. Equally spaced samples are taken for granted.
    """
    rate = 1.0 / (result.time[1] - result.time[0])
    length = round(segment * rate)
    frequencies, cross = csd(result.force, result.displacement, rate, nperseg=length)
    _, power = csd(result.force, result.force, rate, nperseg=length)
    found = np.asarray(cross, dtype=np.complex128) / np.asarray(power, dtype=np.complex128)
    return np.asarray(frequencies, dtype=np.float64), found
