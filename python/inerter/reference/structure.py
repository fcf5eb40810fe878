"""Bodies on linear springs and dampers, with struts between them: what all models share.

    M q'' + C q' + K q + sum_i e_i u_i = f(t),   x_i = e_i . q
    u_i = known_i + N_i + lambda_i |N_i|,   N_i = B_i x_i'' + r_i,   lambda_i by the sign of N_i

Symbols: q coordinates (nq,), M, C, K matrices (nq, nq), e_i the strut's direction: its elongation
per coordinate, u_i its force (tension positive), f generalised forces (nq,).
Range: small motions, constant M and e_i.

The struts' forces depend on the accelerations that they cause, all of them jointly. With
W = e^T M^-1 e this is (B D)^-1 g + W g = const for the forces g = D N, D = 1 + lambda sign(N):
positive definite for every choice of signs (lambda < 1), so the piecewise linear system has
exactly one solution. It is found by trying signs, and solved exactly.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise, product
from typing import TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .contacts import Clutch, Contacts, integrate
from .laws import Quantity
from .strut import Strut, StrutPoint

Array = NDArray[np.float64]
Forces = Callable[[float], Array]


MOST_ROUNDS = 200
"""In which the load on a bristle with a damper has to settle."""


class RunOptions(TypedDict, total=False):
    """What the models hand on to `Structure.simulate`; meaning and defaults stand there."""

    initial: ArrayLike | None
    method: str
    rtol: float
    atol: float
    max_step: float
    breakpoints: Sequence[float]


@dataclass(frozen=True, kw_only=True)
class StructureRun:
    """A run: arrays of shape (times, coordinates) or (times, struts), SI units.

    `device_states` has one array (times, nstate) for each strut, empty for S1.
    """

    time: Array
    position: Array
    velocity: Array
    acceleration: Array
    strut_force: Array
    device_displacement: Array
    device_velocity: Array
    device_force: Array
    device_states: tuple[Array, ...]


@dataclass(frozen=True, eq=False, kw_only=True)
class Structure:
    """Matrices of shape (nq, nq), `directions` of shape (nq, struts); see the module.

    `pull` (nq,): how far the ground may pull a coordinate down through its stiffness and damping
    and the load on it [N], as a tyre by its static load; without limit if not given.

    The state is (q, q', own states of each strut in turn).
    """

    mass: Array
    damping: Array
    stiffness: Array
    directions: Array
    struts: tuple[Strut, ...]
    pull: Array | None = None

    @cached_property
    def mobility(self) -> Array:
        """M^-1."""
        return np.asarray(np.linalg.inv(self.mass), dtype=np.float64)

    @cached_property
    def strut_mobility(self) -> Array:
        """W: acceleration of the elongations per strut force, with the sign turned."""
        return self.directions.T @ self.mobility @ self.directions

    @cached_property
    def slices(self) -> tuple[slice, ...]:
        """Where each strut's own states stand."""
        ends = 2 * len(self.mass) + np.cumsum([0, *(s.nstate for s in self.struts)])
        return tuple(slice(int(a), int(b)) for a, b in pairwise(ends))

    @property
    def nstate(self) -> int:
        """Number of states."""
        return 2 * len(self.mass) + sum(strut.nstate for strut in self.struts)

    @cached_property
    def clutches(self) -> tuple[Clutch, ...]:
        """The backlashes, in the order of their struts."""
        return tuple(self._clutch(i) for i in self._loose)

    @property
    def _loose(self) -> list[int]:
        return [i for i, s in enumerate(self.struts) if s.layout != "S1" and s.device.backlash > 0]

    def points(
        self, state: Array, contacts: Contacts | None = None, bent: Array | None = None
    ) -> list[StrutPoint]:
        """What each strut does, at accelerations (struts,) of the elongations."""
        x, v = self._elongations(state)
        held: list[int | None] = [None] * len(self.struts)
        for i, contact in zip(self._loose, contacts or (), strict=False):
            held[i] = contact
        return [
            strut.at(x[i], v[i], state[self.slices[i]], held[i], 0.0 if bent is None else bent[i])
            for i, strut in enumerate(self.struts)
        ]

    def solve(self, state: Array, forces: Array, points: list[StrutPoint]) -> tuple[Array, Array]:
        """The strut forces u (struts,) and accelerations q'' (nq,) that belong together."""
        nq = len(self.mass)
        known = np.array([p.known for p in points])
        inner = self.damping @ state[nq : 2 * nq] + self.stiffness @ state[:nq]
        outer = forces - inner if self.pull is None else np.maximum(forces - inner, -self.pull)
        free = self.mobility @ (outer - self.directions @ known)
        carried = joint_branch_forces(
            np.array([p.mass for p in points]),
            np.array([p.rest for p in points]),
            np.array([p.share for p in points]).T,
            self.directions.T @ free,
            self.strut_mobility,
        )
        return known + carried, free - self.mobility @ (self.directions @ carried)

    def joint(
        self, state: Array, forces: Array, contacts: Contacts | None = None
    ) -> tuple[list[StrutPoint], Array, Array]:
        """What the struts do, their forces and the accelerations, all at each other.

        Raises
        ------
        RuntimeError
            The damper of a bristle grows too fast with its load for the rounds to end.
        """
        points = self.points(state, contacts)
        strut, acceleration = self.solve(state, forces, points)
        if not any(each.bends for each in self.struts):
            return points, strut, acceleration
        bent = [self.directions.T @ acceleration]
        for turn in range(MOST_ROUNDS):
            before = np.array([p.known for p in points])
            points = self.points(state, contacts, bent[-1])
            strut, acceleration = self.solve(state, forces, points)
            moved = abs(np.array([p.known for p in points]) - before)
            if np.all(moved <= 1e-13 * abs(before)):
                return points, strut, acceleration
            bent.append(self.directions.T @ acceleration)
            if turn % 2:
                bent = [_limit(*bent[-3:])]
        raise RuntimeError(
            "the load on a bristle and the acceleration do not settle; is load_friction "
            "bristle_damping |v| below the friction level?"
        )

    def rates(self, state: Array, forces: Array, contacts: Contacts | None = None) -> Array:
        """Rate of the state, shape (nstate,), under the generalised forces (nq,)."""
        nq = len(self.mass)
        points, _, acceleration = self.joint(state, forces, contacts)
        return np.concatenate((state[nq : 2 * nq], acceleration, *(p.rates for p in points)))

    def simulate(
        self,
        forces: Forces,
        times: ArrayLike,
        *,
        initial: ArrayLike | None = None,
        method: str = "Radau",
        rtol: float = 1e-9,
        atol: float = 1e-12,
        max_step: float = np.inf,
        breakpoints: Sequence[float] = (),
    ) -> StructureRun:
        """Integrate under `forces`: time [s] -> generalised forces of shape (nq,).

        Parameters
        ----------
        forces
            Called with one time.
        times
            Requested times [s], shape (n,), increasing; the run starts at `times[0]`.
        initial
            State at `times[0]`, shape (nstate,); rest if not given.
        method
            A method of `scipy.integrate.solve_ivp`: "Radau" for friction, which is stiff,
            "DOP853" for smooth devices.
        rtol, atol, max_step
            Of the solver; `atol` [m, m/s] is for every state alike.
        breakpoints
            Times [s] where the forces jump or kink; the solver restarts there.

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
            raise ValueError(f"initial: shape {now.shape}, but this model has {self.nstate} states")

        def rates(t: float, state: Array, contacts: Contacts) -> Array:
            return self.rates(state, forces(t), contacts)

        # one stretch from breakpoint to breakpoint
        path = np.empty((at.size, self.nstate))
        path[0] = now
        inner = [float(b) for b in breakpoints if at[0] < b < at[-1]]
        edges = np.unique([float(at[0]), *inner, float(at[-1])])
        for left, right in pairwise(edges):
            first, last = np.searchsorted(at, [left, right], side="right")
            stops = np.unique(np.concatenate(([left], at[first:last], [right])))
            stretch = integrate(
                rates,
                now,
                stops,
                self.clutches,
                method=method,
                rtol=rtol,
                atol=atol,
                max_step=max_step,
            )
            path[first:last] = stretch[1 : 1 + last - first]
            now = stretch[-1]
        return self._run(at, path, forces)

    def _run(self, at: Array, path: Array, forces: Forces) -> StructureRun:
        """Everything that follows from the states."""
        nq, count = len(self.mass), len(self.struts)
        acceleration = np.empty((at.size, nq))
        rows = np.empty((4, at.size, count))
        for n, state in enumerate(path):
            points, strut, acceleration[n] = self.joint(state, forces(float(at[n])))
            x, v = self._elongations(state)
            for i, p in enumerate(points):
                beside = self.struts[i].stiffness * x[i]
                if self.struts[i].layout == "S2":
                    beside += self.struts[i].damping * v[i]
                through = 0.0 if self.struts[i].layout == "S1" else strut[i] - beside
                rows[:, n, i] = strut[i], p.device_displacement, p.device_velocity, through
        states = tuple(
            path[:, where][:, strut.own_motion :]
            for where, strut in zip(self.slices, self.struts, strict=True)
        )
        return StructureRun(
            time=at,
            position=path[:, :nq],
            velocity=path[:, nq : 2 * nq],
            acceleration=acceleration,
            strut_force=rows[0],
            device_displacement=rows[1],
            device_velocity=rows[2],
            device_force=rows[3],
            device_states=states,
        )

    def _elongations(self, state: Array) -> tuple[list[float], list[float]]:
        nq = len(self.mass)
        x, v = self.directions.T @ state[:nq], self.directions.T @ state[nq : 2 * nq]
        return x.tolist(), v.tolist()

    def _clutch(self, index: int) -> Clutch:
        strut, where = self.struts[index], self.slices[index]
        first = where.start + strut.own_motion
        names = strut.device.state_names

        def terminals(t: float, state: Array, contact: int) -> tuple[float, Quantity]:
            x, v = self._elongations(state)
            return strut.device_terminals(x[index], v[index], state[where], contact)

        return Clutch(
            strut.device,
            terminals,
            first + names.index("gap_position"),
            first + names.index("series_deflection"),
        )


def _limit(first: Array, second: Array, third: Array) -> Array:
    """Where three numbers of a geometric row lead (Aitken)."""
    bend = third - 2.0 * second + first
    safe = np.where(bend == 0.0, 1.0, bend)
    return np.where(bend == 0.0, third, third - (third - second) ** 2 / safe)


def joint_branch_forces(
    mass: Array, rest: Array, share: Array, free: Array, mobility: Array
) -> Array:
    """Forces N + lambda |N| [N] of all branches with N = B (free - W force) + r.

    `mass` B, `rest` r, `free` (the elongations' accelerations without these forces) have shape
    (struts,), `share` lambda (struts,) or, for N > 0 and for N < 0, (2, struts), `mobility` W
    (struts, struts).
    """
    push = mass * free + rest
    coupled = mass[:, None] * mobility
    eye = np.eye(len(mass))
    shares = np.broadcast_to(share, (2, len(mass)))

    def factor(signs: Array) -> Array:
        return np.asarray(1.0 + np.where(signs < 0.0, shares[1], shares[0]) * signs)

    def branch(signs: Array) -> Array:
        found = np.linalg.solve(eye + coupled * factor(signs), push)
        return np.asarray(found, dtype=np.float64)

    # the signs of the solution before usually are right at once
    signs = np.sign(push)
    for _ in range(3):
        found = branch(signs)
        if np.all(np.all(shares == 0.0, axis=0) | (found * signs >= 0.0)):
            return factor(np.sign(found)) * found
        signs = np.sign(found)
    for choice in product((-1.0, 1.0), repeat=len(mass)):
        found = branch(np.array(choice))
        if np.all(found * np.array(choice) >= 0.0):
            return factor(np.sign(found)) * found
    raise RuntimeError("no signs of the branch forces agree with themselves; is load_friction < 1?")
