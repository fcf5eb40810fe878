"""A device's response along a motion that is imposed on it.

    z' = state_rate(x(t), v(t), z, a(t)),   F(t) = force(x(t), v(t), a(t), z(t))

The motion is analytic, so only the device's states are integrated. A friction law has a corner
where the velocity changes sign; each stretch between two corners is therefore integrated on its
own, and within it the right-hand side is smooth. Contacts of a backlash, and the edges of a free
play before the friction, are located as events.
Not modelled: the test rig; the motion is followed exactly whatever the force.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import odeint, solve_ivp
from scipy.optimize import brentq

from .contacts import Clutch, Contacts, integrate
from .device import ReferenceDevice
from .laws import Quantity, branches, load, maxwell_slip

Signal = Callable[[Quantity], Quantity]


@dataclass(frozen=True)
class Motion:
    """An imposed motion as three analytic functions of time [s].

    Attributes
    ----------
    displacement, velocity, acceleration
        Callables of a time or an array of times, giving x [m], v [m/s], a [m/s^2] of that shape.
        They have to be each other's derivatives; nothing checks it.
    kinks
        Times [s] at which a derivative of the acceleration or the motion's formula jumps.
    """

    displacement: Signal
    velocity: Signal
    acceleration: Signal
    kinks: Sequence[float] = field(default=())


@dataclass(frozen=True, kw_only=True)
class Response:
    """A device's answer, arrays of shape (times,).

    `state` is the friction law's (first) state, zero for a law without one; `states` holds
    all states of the device in its order, shape (times, nstate).
    """

    time: NDArray[np.float64]
    displacement: NDArray[np.float64]
    velocity: NDArray[np.float64]
    acceleration: NDArray[np.float64]
    state: NDArray[np.float64]
    force: NDArray[np.float64]
    states: NDArray[np.float64]


def sine_motion(amplitude: float, frequency: float, phase: float = 0.0) -> Motion:
    """A sin(2 pi f t + phase) with A [m], f [Hz], phase [rad]."""
    omega = 2.0 * np.pi * frequency
    return Motion(
        lambda t: amplitude * np.sin(omega * t + phase),
        lambda t: amplitude * omega * np.cos(omega * t + phase),
        lambda t: -amplitude * omega**2 * np.sin(omega * t + phase),
    )


def velocity_crossings(
    motion: Motion, speed: float, start: float, end: float, step: float
) -> list[float]:
    """Times [s] inside (start, end) where the velocity passes, reaches or leaves `speed` [m/s].

    The sign of v - speed is scanned every `step` seconds and each change of sign refined; two
    crossings within one step cancel and are missed. With `speed` zero these are the reversals.
    """
    count = max(2, int(np.ceil((end - start) / step)) + 1)
    grid = np.linspace(start, end, count)
    signs = np.sign(np.broadcast_to(motion.velocity(grid), grid.shape) - speed)
    times: list[float] = []
    for i in np.flatnonzero(signs[1:] != signs[:-1]):
        left, right = float(grid[i]), float(grid[i + 1])
        excess = [float(motion.velocity(t)) - speed for t in (left, right)]
        if excess[0] * excess[1] < 0.0:
            root = brentq(lambda t: float(motion.velocity(t)) - speed, left, right, xtol=1e-14)
            times.append(float(root))  # pyright: ignore[reportArgumentType]
        else:
            # a zero exactly on the grid, or the edge of a dwell: the grid point is the corner
            times.append(left if signs[i] == 0.0 else right)
    return times


def marked_speeds(device: ReferenceDevice) -> list[float]:
    """Velocities [m/s] at which a stretch has to end: corners, and the flanks of steep features.

    A solver that slides at a steady friction level has no reason for small steps and would leap
    over a Stribeck curve or a change of direction much narrower than its step.
    """
    flanks: list[float] = []
    if device.friction == "lugre" and device.breakaway_force != device.coulomb_force:
        flanks += [device.stribeck_velocity, 4.0 * device.stribeck_velocity]
    if device.friction == "rate_state":
        # at the width of sign(v) the logarithm begins
        flanks += [device.transition_velocity, 10.0 * device.transition_velocity]
    if device.friction in ("dahl", "lugre") and device.friction_asymmetry != 0.0:
        flanks += [device.transition_velocity, 10.0 * device.transition_velocity]
    return [0.0, *flanks, *(-speed for speed in flanks)]


def response(
    device: ReferenceDevice,
    motion: Motion,
    times: ArrayLike,
    *,
    initial_state: ArrayLike = 0.0,
    method: str = "LSODA",
    rtol: float = 1e-10,
    scan_step: float = 1e-3,
) -> Response:
    """Response of `device` along `motion` at `times`.

    Parameters
    ----------
    device
        The device; only its states are integrated.
    motion
        The imposed motion.
    times
        Requested times [s], shape (n,), increasing; the state starts at `times[0]`.
    initial_state
        States at `times[0]`, shape (nstate,); a number stands for each of them.
    method
        "LSODA" (fast; RK23 in its place for maxwell_slip) or any stiff method of
        `scipy.integrate.solve_ivp`, for instance "Radau".
    rtol
        Relative tolerance; the absolute one is `rtol` times the state's own scale.
    scan_step
        Step [s] at which velocity reversals are looked for, and the solver's largest step.

    Raises
    ------
    ValueError
        The times do not increase, or the friction level reaches zero on the way and a law with
        a bristle cannot follow.
    RuntimeError
        The solver gave up; the message carries the interval.
    """
    at = np.atleast_1d(np.asarray(times, dtype=np.float64))
    if at.ndim != 1 or np.any(np.diff(at) <= 0.0):
        raise ValueError("times: they have to increase strictly; sort them and drop duplicates")

    x = _along(motion.displacement, at)
    v = _along(motion.velocity, at)
    a = _along(motion.acceleration, at)
    states = np.empty((at.size, device.nstate))
    states[:] = np.asarray(initial_state, dtype=np.float64)
    if method == "LSODA" and device.friction == "maxwell_slip":
        # every element that begins to slip is a corner, at which a method of many steps stumbles
        method = "RK23"
    if device.nstate and at.size > 1:
        _integrate(device, motion, at, states, method, rtol, scan_step)
    force = np.asarray(device.force(x, v, a, device.state_argument(states)), dtype=np.float64)
    friction = device.friction_states > 0
    state = states[:, 0].copy() if friction else np.zeros(at.shape)
    return Response(
        time=at, displacement=x, velocity=v, acceleration=a, state=state, force=force, states=states
    )


def state_scales(device: ReferenceDevice) -> NDArray[np.float64]:
    """Size of each state, for tolerances, shape (nstate,)."""
    # a series deflection that matters carries ten newtons or is a millimetre
    stiffness = device.series_stiffness
    sizes = {
        "friction_state": state_scale,
        "series_deflection": lambda _: min(1e-3, 10.0 / stiffness) if stiffness else 1e-3,
        "flywheel_velocity": lambda _: 1e-2,
        "gap_position": lambda d: min(d.backlash, 10.0 / stiffness),
        "slip_position": lambda _: 1e-3,
    }
    elements = maxwell_slip.elements(device)
    for i, (spring, slip) in enumerate(zip(*elements, strict=True)):
        sizes[f"friction_state_{i + 1}"] = lambda _, size=slip / spring: size
    for i in range(branches.count(device)):
        sizes[f"branch_deflection_{i + 1}"] = lambda _: 1e-3
    sizes["damper_velocity"] = lambda _: 1e-2
    sizes["control_change"] = lambda d: d.control_upper - d.control_lower
    return np.array([sizes[name](device) for name in device.state_names])


def state_scale(device: ReferenceDevice) -> float:
    """Deflection [m] at which the friction law's state saturates; 1 mm if it does not."""
    if device.friction == "bouc_wen":
        narrowing = device.bw_beta + device.bw_gamma
        if narrowing > 0.0:
            return min(1e-3, (device.bw_alpha / narrowing) ** (1.0 / device.bw_exponent))
        return 1e-3
    if device.friction == "rate_state":
        return 1.0
    level = max(device.coulomb_force, device.breakaway_force if device.friction == "lugre" else 0.0)
    return level / device.bristle_stiffness


def _along(signal: Signal, at: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.array(np.broadcast_to(signal(at), at.shape), dtype=np.float64)


def _integrate(
    device: ReferenceDevice,
    motion: Motion,
    at: NDArray[np.float64],
    states: NDArray[np.float64],
    method: str,
    rtol: float,
    scan_step: float,
) -> None:
    """Fill `states` at the times `at`, one smooth stretch after another."""
    start, end = float(at[0]), float(at[-1])
    corners = [float(kink) for kink in motion.kinks]
    for speed in marked_speeds(device):
        corners += velocity_crossings(motion, speed, start, end, scan_step)
    if load.bends(device):
        # where the load changes sign its size has a corner
        bent = replace(motion, velocity=motion.acceleration)
        corners += velocity_crossings(bent, 0.0, start, end, scan_step)
    edges = np.unique([start, *(c for c in corners if start < c < end), end])

    # a corner within rounding of a requested time is that time, else the solver's step vanishes
    nearest = at[np.clip(np.searchsorted(at, edges), 1, at.size - 1) + np.array([[-1], [0]])]
    for candidate in nearest:
        edges = np.where(abs(edges - candidate) < 1e-10, candidate, edges)
    edges = np.unique(edges)
    edges = edges[np.concatenate(([True], np.diff(edges) > 1e-10))]
    edges[-1] = end

    level_varies = device.friction_gradient != 0.0 or device.friction_curvature != 0.0
    level_varies |= "friction" in device.along or "friction_back" in device.along
    bends = load.bends(device)
    needs_displacement = level_varies or device.has_series or bends
    displacement, velocity = motion.displacement, motion.velocity
    absolute = rtol * state_scales(device)

    def rate(
        t: float,
        z: NDArray[np.float64],
        contacts: Contacts = (),
        of: ReferenceDevice = device,
    ) -> NDArray[np.float64]:
        x = float(displacement(t)) if needs_displacement else 0.0
        contact = contacts[0] if contacts else None
        a = float(motion.acceleration(t)) if bends else 0.0
        v, states = float(velocity(t)), of.state_argument(z)
        found = of.state_rate(x, v, states, a=a, contact=contact)
        return np.atleast_1d(found)

    clutches: tuple[Clutch, ...] = ()
    if device.backlash > 0.0:
        names = device.state_names
        clutches = (
            Clutch(
                device,
                lambda t, z, _: (float(velocity(t)), z),
                names.index("gap_position"),
                names.index("series_deflection"),
            ),
        )

    z = states[0].copy()
    for left, right in pairwise(edges):
        first, last = np.searchsorted(at, [left, right], side="right")
        inside = at[first:last]
        stops = np.unique(np.concatenate(([left], inside, [right])))
        if clutches:
            path = integrate(
                rate,
                z,
                stops,
                clutches,
                method=method,
                rtol=max(rtol, 1e-12),
                atol=absolute,
                max_step=scan_step,
            )
        elif device.friction_backlash > 0.0 and not device.rubs_flywheel:
            direction = float(np.sign(velocity(0.5 * (left + right))))
            path = _through_play(
                device, rate, velocity, direction, z, stops, method, rtol, absolute, scan_step
            )
        else:
            path = _stretch(rate, z, stops, method, rtol, absolute, scan_step)
        states[first:last] = path[np.searchsorted(stops, inside)]
        z = path[-1].copy()


def _stretch(
    rate: Callable[[float, NDArray[np.float64]], NDArray[np.float64]],
    z: NDArray[np.float64],
    stops: NDArray[np.float64],
    method: str,
    rtol: float,
    atol: NDArray[np.float64],
    max_step: float,
) -> NDArray[np.float64]:
    """The states at `stops` (first = start, last = end) over one smooth stretch."""
    where = f"between {stops[0]:.9g} s and {stops[-1]:.9g} s"
    if method == "LSODA":
        path, report = odeint(
            rate,
            z,
            stops,
            tfirst=True,
            rtol=rtol,
            atol=atol,
            tcrit=[stops[-1]],
            hmax=max_step,
            mxstep=100_000,
            full_output=True,
        )
        if not str(report["message"]).startswith("Integration successful"):
            raise RuntimeError(f"LSODA stopped {where}: {report['message']}")
        return path
    solution = solve_ivp(
        rate,
        (float(stops[0]), float(stops[-1])),
        z,
        method=method,  # pyright: ignore[reportArgumentType]
        t_eval=stops,
        rtol=rtol,
        atol=atol,
        max_step=max_step,
    )
    if not solution.success:
        raise RuntimeError(f"{method} stopped {where}: {solution.message}")
    return solution.y.T


def _through_play(
    device: ReferenceDevice,
    rate: Callable[..., NDArray[np.float64]],
    velocity: Signal,
    direction: float,
    z: NDArray[np.float64],
    stops: NDArray[np.float64],
    method: str,
    rtol: float,
    atol: NDArray[np.float64],
    max_step: float,
) -> NDArray[np.float64]:
    """As `_stretch`, the velocity of one sign, behind a free play before the friction.

    Engaged on a side, the bristle is that of the device without play; the place where it is
    straight, and the far edge of the play, are events.
    """
    half, rigid = device.friction_backlash, replace(device, friction_backlash=0.0)
    path, state, done = np.empty((stops.size, z.size)), z.copy(), 1
    path[0], now = z, float(stops[0])
    outwards = direction * state[0] >= half
    side = float(np.sign(state[0])) if abs(state[0]) > half or outwards else 0.0

    def rates(t: float, y: NDArray[np.float64]) -> NDArray[np.float64]:
        if side:
            return rate(t, np.concatenate(([y[0] - side * half], y[1:])), of=rigid)
        found = rate(t, np.concatenate(([0.0], y[1:])))
        found[0] = float(velocity(t))
        return found

    def remaining(t: float, y: NDArray[np.float64]) -> float:
        return side * y[0] - half if side else half - direction * y[0]

    remaining.terminal, remaining.direction = True, -1.0  # pyright: ignore[reportFunctionMemberAccess]
    # straight, across, bent again
    for _ in range(3):
        solution = solve_ivp(
            rates,
            (now, float(stops[-1])),
            state,
            method=method,  # pyright: ignore[reportArgumentType]
            t_eval=stops[done:],
            events=[remaining],
            rtol=max(rtol, 1e-12),
            atol=atol,
            max_step=max_step,
        )
        if not solution.success:
            raise RuntimeError(f"{method} stopped after {now:.9g} s: {solution.message}")
        if len(solution.t):
            path[done : done + len(solution.t)] = solution.y.T
            done += len(solution.t)
        if done == stops.size:
            break
        now, state = float(solution.t_events[0][-1]), np.array(solution.y_events[0][-1])
        state[0] = side * half if side else direction * half
        side = 0.0 if side else direction
    return path
