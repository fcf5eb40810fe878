"""Quarter-car with an inerter in its strut.

    m_s zs'' = F_s - u,   m_u zu'' = u - F_t,   F_t = k_t (zu - zr)
    S1: u = k x + c v             S2: u = k x + c v + F_device(x, v, a, z)
    S3: u = k x + F,  F = F_device(y, y', y'', z) = c (v - y')     (device in series with damper)

Symbols: zs, zu, zr body, wheel, road displacement [m] from equilibrium, positive up; x = zs - zu,
v = x', a = x''; y the device's own displacement in S3; m_s, m_u [kg], k, k_t [N/m], c [N s/m];
F_s a force on the body [N].
Sign: u is tension positive: an extended strut pulls the body down and the wheel up.
Range: small motions about equilibrium.
Source: Wang and Su, "Inerter nonlinearities and the impact on suspension control", ACC 2008.
Not modelled: gravity, tyre damping and lift-off, end stops, anything in series with the device
but the damper of S3.

The device's force depends on the acceleration it causes. That dependence is piecewise linear
(its corner is load friction at a = 0), so the acceleration is solved exactly:

    a (1 + w b) + w mu t b |a| = r   gives   a = r / (1 + w b (1 + mu t sign r)),

with w = 1/m_s + 1/m_u, t = tanh(v / v_t), r the relative acceleration without inertance.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import solve_ivp

from .device import ReferenceDevice

LAYOUTS = ("S1", "S2", "S3")


@dataclass(frozen=True)
class QuarterCarResult:
    """A run of the quarter-car, arrays of shape (times,), SI units.

    `device_displacement`, `device_velocity`, `device_force`, `device_state` belong to the device:
    in S2 its displacement is the strut's, in S3 its own, in S1 (no device) zeros.
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


@dataclass(frozen=True, kw_only=True)
class QuarterCar:
    """Quarter-car of Wang and Su; the default masses and tyre are theirs.

    The state is (zs, zu, zs', zu'), for S3 then (y, y'), then the friction state if there is one.

    Raises
    ------
    ValueError
        Unknown layout; a mass, tyre stiffness or (S3) damping or inertance that is not positive.
    """

    layout: str = "S2"
    stiffness: float = 120e3
    damping: float = 3705.4
    device: ReferenceDevice = field(default_factory=ReferenceDevice)
    sprung_mass: float = 181.75
    unsprung_mass: float = 25.0
    tyre_stiffness: float = 120e3

    def __post_init__(self) -> None:
        """Check what was given, see Raises."""
        if self.layout not in LAYOUTS:
            raise ValueError(f"layout: '{self.layout}' is not one of {', '.join(LAYOUTS)}")
        for name in ("sprung_mass", "unsprung_mass", "tyre_stiffness"):
            if not getattr(self, name) > 0.0:
                raise ValueError(f"{name}: {getattr(self, name)} must be above 0")
        if self.layout == "S3" and not (self.damping > 0.0 and self.device.inertance > 0.0):
            raise ValueError(
                f"S3: damping {self.damping} N s/m and inertance {self.device.inertance} kg stand "
                "in series and both have to be above 0"
            )

    @property
    def nstate(self) -> int:
        """Number of states."""
        return 4 + (2 if self.layout == "S3" else 0) + self._friction_states

    @property
    def _friction_states(self) -> int:
        return 0 if self.layout == "S1" else self.device.nstate

    def rates(
        self, state: NDArray[np.float64], road: float, body_force: float = 0.0
    ) -> NDArray[np.float64]:
        """Rate of the state, shape (nstate,), at road displacement [m] and body force [N]."""
        zs, zu, vs, vu = (float(value) for value in state[:4])
        z = float(state[-1]) if self._friction_states else 0.0
        x, v = zs - zu, vs - vu
        tyre = self.tyre_stiffness * (zu - road)
        tail: list[float] = []

        # the strut force, and what the friction state sees
        if self.layout == "S1":
            strut = self.stiffness * x + self.damping * v
        elif self.layout == "S2":
            rest = self.stiffness * x + self.damping * v + float(self.device.rest_force(x, v, z))
            strut = rest + self._inertial_force(x, v, rest, tyre, body_force)
            tail = [float(self.device.state_rate(x, v, z))]
        else:
            y, y_rate = float(state[4]), float(state[5])
            series = self.damping * (v - y_rate)
            strut = self.stiffness * x + series
            tail = [
                y_rate,
                float(self.device.acceleration(y, y_rate, series, z)),
                float(self.device.state_rate(y, y_rate, z)),
            ]

        head = [
            vs,
            vu,
            (body_force - strut) / self.sprung_mass,
            (strut - tyre) / self.unsprung_mass,
        ]
        return np.array((head + tail)[: self.nstate])

    def _inertial_force(
        self, x: float, v: float, rest: float, tyre: float, body_force: float
    ) -> float:
        """S2: the device's force that depends on the acceleration, F_b + mu |F_b| t [N].

        F_b = b a + s with s = b' v^2 / 2, and a = free - mobility * force.
        """
        mobility = 1.0 / self.sprung_mass + 1.0 / self.unsprung_mass
        free = body_force / self.sprung_mass + tyre / self.unsprung_mass - mobility * rest
        inertance, slope = (float(value) for value in self.device.inertance_at(x))
        push = inertance * free + 0.5 * slope * v * v
        share = 1.0 + float(self.device.load_share(v)) * np.sign(push)
        return float(share * push / (1.0 + mobility * inertance * share))

    def simulate(
        self,
        road: Callable[[float], float],
        times: ArrayLike,
        *,
        initial: ArrayLike | None = None,
        body_force: Callable[[float], float] | None = None,
        method: str = "Radau",
        rtol: float = 1e-9,
        atol: float = 1e-12,
        breakpoints: Sequence[float] = (),
    ) -> QuarterCarResult:
        """Drive over a road.

        Parameters
        ----------
        road
            zr(t) [m], called with one time [s].
        times
            Requested times [s], shape (n,), increasing; the run starts at `times[0]`.
        initial
            State at `times[0]`, shape (nstate,); rest if not given.
        body_force
            F_s(t) [N] on the body; none if not given.
        method
            A method of `scipy.integrate.solve_ivp`: "Radau" for friction, which is stiff,
            "DOP853" for smooth devices.
        rtol, atol
            Tolerances of the solver; `atol` [m, m/s] is for every state alike.
        breakpoints
            Times [s] where road or body force jump or kink; the solver restarts there.

        Raises
        ------
        ValueError
            `initial` has the wrong length, or the times do not increase.
        RuntimeError
            The solver gave up.
        """
        at = np.atleast_1d(np.asarray(times, dtype=np.float64))
        if at.ndim != 1 or np.any(np.diff(at) <= 0.0):
            raise ValueError("times: they have to increase strictly; sort them, drop duplicates")
        now = np.zeros(self.nstate) if initial is None else np.array(initial, dtype=np.float64)
        if now.shape != (self.nstate,):
            raise ValueError(f"initial: shape {now.shape}, but this car has {self.nstate} states")
        push = body_force if body_force is not None else _no_force

        def rates(t: float, state: NDArray[np.float64]) -> NDArray[np.float64]:
            return self.rates(state, float(road(t)), float(push(t)))

        # one stretch from breakpoint to breakpoint
        path = np.empty((self.nstate, at.size))
        path[:, 0] = now
        inner = [float(b) for b in breakpoints if at[0] < b < at[-1]]
        edges = np.unique([float(at[0]), *inner, float(at[-1])])
        for left, right in pairwise(edges):
            first, last = np.searchsorted(at, [left, right], side="right")
            stops = np.unique(np.concatenate((at[first:last], [right])))
            solution = solve_ivp(
                rates,
                (left, right),
                now,
                method=method,  # pyright: ignore[reportArgumentType]
                t_eval=stops,
                rtol=rtol,
                atol=atol,
            )
            if not solution.success:
                raise RuntimeError(f"{method} stopped after {left:.9g} s: {solution.message}")
            path[:, first:last] = solution.y[:, : last - first]
            now = solution.y[:, -1]
        return self._result(at, path, road, push)

    def _result(
        self,
        at: NDArray[np.float64],
        path: NDArray[np.float64],
        road: Callable[[float], float],
        push: Callable[[float], float],
    ) -> QuarterCarResult:
        """Everything that follows from the states."""
        roads = np.array([float(road(t)) for t in at])
        pushes = np.array([float(push(t)) for t in at])
        rates = np.array([self.rates(path[:, i], roads[i], pushes[i]) for i in range(at.size)]).T
        zs, zu, vs, vu = path[:4]
        strut = pushes - self.sprung_mass * rates[2]
        nothing = np.zeros(at.size)
        state = path[-1] if self._friction_states else nothing
        x, v = zs - zu, vs - vu
        if self.layout == "S1":
            own = (nothing, nothing, nothing)
        elif self.layout == "S2":
            own = (x, v, np.asarray(self.device.force(x, v, rates[2] - rates[3], state)))
        else:
            own = (path[4], path[5], self.damping * (v - path[5]))
        return QuarterCarResult(
            time=at,
            body_displacement=zs,
            wheel_displacement=zu,
            body_velocity=vs,
            wheel_velocity=vu,
            body_acceleration=rates[2],
            wheel_acceleration=rates[3],
            suspension_travel=x,
            strut_force=strut,
            tyre_force=self.tyre_stiffness * (zu - roads),
            device_displacement=own[0],
            device_velocity=own[1],
            device_force=own[2],
            device_state=state,
        )


def _no_force(_: float) -> float:
    return 0.0
