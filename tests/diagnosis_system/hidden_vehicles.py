"""Vehicles with hidden effects, as records: SciPy only, nothing of the core and no MuJoCo.

A quarter-car with the strut's force u at x = zs - zu, v = x':

    u = k x + k3 x^3 + d(v) + F_c tanh(v / v_t) + b x''
    d = c(v) v, c: other in rebound (v > 0) than in bump; beyond a knee v_k only its share beta
    F = max(k_t (zr - zu) + c_t (zr' - zu'), -W)  of the tyre on the wheel, from the static load W

    m_s zs'' = -u,   m_u zu'' = u + F             solved together, as b couples them
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from inerter.diagnose.vehicle.build import read_model
from inerter.diagnose.vehicle.diagnosis import diagnose_system
from inerter.diagnose.vehicle.mapping import map_columns
from inerter.diagnose.vehicle.outcome import SystemDiagnosis
from inerter.model_parameters import QUARTER_CAR
from inerter.models import model_path
from inerter.records import VehicleRecord
from inerter.reference import QuarterCar
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

Array = NDArray[np.float64]
S2 = QUARTER_CAR.struts["S2"]


@dataclass(frozen=True)
class Road:
    """A road of random phases, its velocity white up to `top` [Hz] (ISO 8608, waviness 2).

    amplitude: rms of the vertical velocity of the road [m/s].
    """

    seed: int
    duration: float
    amplitude: float = 0.08
    top: float = 25.0

    @cached_property
    def waves(self) -> tuple[Array, Array, Array]:
        """Angular frequency [rad/s], size [m] and phase of every wave."""
        frequency = np.arange(1.0, self.top * self.duration) / self.duration
        size = self.amplitude * np.sqrt(2 / frequency.size) / (2 * np.pi * frequency)
        phase = np.random.default_rng(self.seed).uniform(0, 2 * np.pi, frequency.size)
        return 2 * np.pi * frequency, size, phase

    def __call__(self, t: float) -> float:
        """Height [m]; starts at 0."""
        omega, size, phase = self.waves
        return float(size @ (np.sin(omega * t + phase) - np.sin(phase)))

    def rate(self, t: float) -> float:
        """Its rate [m/s]."""
        omega, size, phase = self.waves
        return float((size * omega) @ np.cos(omega * t + phase))


@dataclass(frozen=True)
class Car:
    """A quarter-car as shipped, and the effects that may be hidden in it."""

    sprung_mass: float = QUARTER_CAR.sprung_mass
    unsprung_mass: float = QUARTER_CAR.unsprung_mass
    tyre_stiffness: float = QUARTER_CAR.tyre_stiffness
    stiffness: float = QUARTER_CAR.stiffness
    damping: float = S2.damping
    inertance: float = S2.inertance
    stiffness_cubic: float = 0.0
    rebound_damping: float | None = None
    bump_damping: float | None = None
    tyre_damping: float = 0.0
    static_load: float = np.inf
    knee: float = np.inf
    beyond: float = 1.0
    coulomb_force: float = 0.0

    def rates(self, t: float, state: Array, road: Road) -> Array:
        """Of (zs, zu, zs', zu')."""
        return np.concatenate([state[2:], self.accelerations(t, state, road)[:2]])

    def accelerations(self, t: float, state: Array, road: Road) -> Array:
        """zs'', zu'' [m/s^2] and the tyre's force on the wheel [N]."""
        x, v = state[0] - state[1], state[2] - state[3]
        damping = self.damping
        if self.rebound_damping is not None and self.bump_damping is not None:
            damping = self.rebound_damping if v > 0 else self.bump_damping
        past = max(abs(v) - self.knee, 0.0)
        bent = np.sign(v) * (abs(v) - (1.0 - self.beyond) * past)
        u = self.stiffness * x + self.stiffness_cubic * x**3 + damping * bent
        u += self.coulomb_force * np.tanh(v / 1e-3)
        force = self.tyre_stiffness * (road(t) - state[1])
        if self.tyre_damping:
            force += self.tyre_damping * (road.rate(t) - state[3])
        force = max(force, -self.static_load)
        b = self.inertance
        mass = np.array([[self.sprung_mass + b, -b], [-b, self.unsprung_mass + b]])
        return np.append(np.linalg.solve(mass, [-u, u + force]), force)


def record(
    car: Car, road: Road, name: str, noise: float = 0.01, rate: float = 250.0
) -> VehicleRecord:
    """A drive from rest, white noise of a share of each channel's spread on the accelerometers."""
    times = np.arange(0.0, road.duration, 1 / rate)
    run = solve_ivp(
        car.rates, (0, times[-1]), np.zeros(4), t_eval=times, args=(road,),
        rtol=1e-6, atol=1e-8, max_step=0.01,
    )  # fmt: skip
    found = np.array([car.accelerations(t, y, road) for t, y in zip(times, run.y.T, strict=True)])
    random = np.random.default_rng(1000 + road.seed)

    body, wheel, force = found.T
    return VehicleRecord(
        name=name,
        time=times,
        road=np.array([road(t) for t in times]),
        body_acceleration=noisy(body, noise, random),
        wheel_acceleration=noisy(wheel, noise, random),
        suspension_travel=run.y[0] - run.y[1],
        tyre_force=force,
    )


def noisy(values: Array, share: float, random: np.random.Generator) -> Array:
    """Values with white noise of a share of their spread."""
    return values + share * np.std(values) * random.standard_normal(values.size)


def reference_records(
    car: QuarterCar,
    runs: int = 3,
    duration: float = 4.0,
    seed: int = 11,
    noise: float = 0.01,
    **road: float,
) -> list[VehicleRecord]:
    """Drives of the reference quarter-car, noise on the accelerometers."""
    found = []
    for i in range(runs):
        height = Road(seed + i, duration, **road)
        times = np.arange(0.0, duration, 0.004)
        run = car.simulate(height, times, rtol=1e-6, atol=1e-8, max_step=0.01)
        random = np.random.default_rng(2000 + seed + i)
        found.append(
            VehicleRecord(
                name=f"run{i + 1}",
                time=times,
                road=np.array([height(t) for t in times]),
                body_acceleration=noisy(run.body_acceleration, noise, random),
                wheel_acceleration=noisy(run.wheel_acceleration, noise, random),
                suspension_travel=run.suspension_travel,
            )
        )
    return found


def diagnose(records: list[VehicleRecord], model: str = "model.xml") -> SystemDiagnosis:
    """Against a shipped quarter-car, with steps of 2 ms to save time."""
    user = read_model(model_path("quarter_car", model)).with_timestep(0.002)
    columns = list(records[0].channels())
    return diagnose_system(records, user, map_columns(user.model, columns, {}, {}))


def records(
    car: Car, runs: int = 3, duration: float = 4.0, seed: int = 1, **road: float
) -> list[VehicleRecord]:
    """Several drives over different roads."""
    return [record(car, Road(seed + i, duration, **road), f"run{i + 1}") for i in range(runs)]


def write(record: VehicleRecord, folder: Path, rename: Mapping[str, str] | None = None) -> Path:
    """A record as CSV, some columns renamed."""
    columns = {"time": record.time, **record.channels()}
    path = folder / f"{record.name}.csv"
    header = ",".join((rename or {}).get(name, name) for name in columns)
    table = np.column_stack(list(columns.values()))
    np.savetxt(path, table, "%.9g", ",", header=header, comments="")
    return path
