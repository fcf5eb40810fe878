"""A vehicle on recorded roads with everything that may be hidden in it.

`body` on one, two or four corners: the equations of `structure.py`, with damping of the tyres,
    M q'' + C q' + K q + sum_i e_i u_i = K r + C r' + f,   q = (heave[, pitch[, roll]], wheels)
`arm`: one wheel on a trailing arm that turns on the body, exact for any angle th:
    (m_s + m_u) z'' + m_u L (cos th th'' - sin th th'^2) = F_t + F_b
    m_u L cos th z'' + (m_u L^2 + J) th'' = F_t L cos th - l'(th) u,   x = l(th) - l(th_0)
    F_t = k_t (r - z - L (sin th - sin th_0)) + c_t (r' - z' - L cos th th') >= -W

Symbols: u force of a strut, tension positive; l its length between a point (0, h) over the pivot
and one `reach` along the arm [m]; r road [m]; W static load [N]; F_b force on the body [N].
Friction of a guide is a device between a wheel (of an arm: the body) and the ground.
A sensor that leans forward by the angle a shows z_w'' cos(a) + x_w'' sin(a) of the wheel, x_w
forward along the arm, which stands at th_0 when nothing moves.
Sign: as `vehicle.py`; z and th grow upward.
Range: the body on corners: small angles. Not modelled: gravity, steering, anti-roll bars.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from .device import ReferenceDevice
from .structure import Structure
from .strut import Strut, StrutPoint
from .vehicle_roads import Track

Array = NDArray[np.float64]
Signal = Callable[[float], float]
KINDS = ("quarter", "half", "full", "arm")


@dataclass(frozen=True, kw_only=True)
class DrawnCorner:
    """A wheel: masses [kg], stiffnesses [N/m], damping [N s/m], place forward and left [m]."""

    wheel_mass: float
    tyre_stiffness: float
    stiffness: float
    damping: float
    inertance: float
    x: float = 0.0
    y: float = 0.0

    @property
    def device(self) -> ReferenceDevice:
        """The strut as it is stated: spring, damper and inerter in one."""
        return ReferenceDevice(
            inertance=self.inertance, viscous=self.damping, stiffness=self.stiffness
        )


@dataclass(frozen=True, kw_only=True)
class Changed:
    """What a corner has beside its numbers: hidden, told to nobody.

    device: in place of the stated one; guide: between wheel and ground; static_load [N] with which
    the tyre stands on the road; extra: a further force of the strut, (x, v) -> [N].
    """

    device: ReferenceDevice | None = None
    guide: ReferenceDevice | None = None
    tyre_damping: float = 0.0
    static_load: float = np.inf
    extra: Callable[[float, float], float] | None = None


@dataclass(frozen=True, kw_only=True)
class DrawnVehicle:
    """A vehicle, see the module.

    names: of the corners, "" for a single one, else "_front_left" and so on. arm_length,
    arm_inertia [m, kg m^2], strut_reach, strut_height [m] and arm_angle [rad] are those of the
    arm. wheel_lean [rad]: of the accelerometer on an arm's wheel. rider: mass [kg],
    spring [N/m] and damper [N s/m] of one who sits over the centre of mass, not on an arm.
    """

    kind: str
    body_mass: float
    corners: tuple[DrawnCorner, ...]
    names: tuple[str, ...] = ("",)
    pitch_inertia: float = 0.0
    roll_inertia: float = 0.0
    arm_length: float = 0.5
    arm_inertia: float = 1.0
    strut_reach: float = 0.4
    strut_height: float = 0.4
    arm_angle: float = 0.0
    wheel_lean: float = 0.0
    rider: tuple[float, float, float] | None = None
    changed: Mapping[int, Changed] = field(default_factory=dict)

    def change(self, corner: int) -> Changed:
        """What a corner has beside its numbers."""
        return self.changed.get(corner, Changed())

    def drive(
        self,
        tracks: Sequence[Track],
        times: Array,
        active: Signal | None = None,
        on_body: Signal | None = None,
        on_wheel: Signal | None = None,
    ) -> dict[str, Array]:
        """Noise-free channels by name, each of the shape of `times`.

        active: force that lengthens the first strut [N]; on_body, on_wheel: up on the body and on
        the first wheel [N].

        Raises
        ------
        RuntimeError
            The solver gave up.
        """
        loads = tuple(each or _nothing for each in (active, on_body, on_wheel))
        if self.kind == "arm":
            return _Arm(self, tracks[0], loads).run(times)
        return self._on_corners(tracks, times, loads)

    # --- a body on corners ------------------------------------------------------------------

    def _on_corners(
        self, tracks: Sequence[Track], times: Array, loads: tuple[Signal, ...]
    ) -> dict[str, Array]:
        wheels, rows = len(self.corners), self._rows()
        parts = rows.shape[1]
        stiffness = np.array([c.tyre_stiffness for c in self.corners])
        damping = np.array([self.change(i).tyre_damping for i in range(wheels)])
        struts, directions = self._struts(rows)
        pull = np.array([np.inf] * parts + [self.change(i).static_load for i in range(wheels)])
        body = (self.body_mass, self.pitch_inertia, self.roll_inertia)[:parts]
        mass = np.array([*body, *(c.wheel_mass for c in self.corners)])
        of_tyres = np.zeros((2, parts + wheels, parts + wheels))
        of_tyres[:, parts:, parts:] = np.diag(stiffness), np.diag(damping)
        if self.rider is not None:
            mass, of_tyres = _with_rider(self.rider, mass, of_tyres)
            directions = np.vstack((directions, np.zeros(directions.shape[1])))
            pull = np.append(pull, np.inf)
        structure = Structure(
            mass=np.diag(mass), stiffness=of_tyres[0], damping=of_tyres[1],
            directions=directions, struts=struts,
            pull=None if np.isinf(pull).all() else pull,
        )  # fmt: skip
        active, on_body, on_wheel = loads

        def forces(t: float) -> Array:
            road = np.array([track(t) for track in tracks])
            rate = np.array([track.rate(t) for track in tracks])
            up = np.zeros(len(mass))
            up[0] = on_body(t)
            up[parts : parts + wheels] = stiffness * road + damping * rate
            up[parts] += on_wheel(t)
            return up + directions[:, 0] * active(t)

        run = structure.simulate(forces, times, method="LSODA", rtol=1e-7, atol=1e-9, max_step=0.01)
        road = np.array([[track(t) for track in tracks] for t in times])
        rate = np.array([[track.rate(t) for track in tracks] for t in times])
        own = slice(parts, parts + wheels)
        w, v = run.position[:, own], run.velocity[:, own]
        tyre = np.maximum(stiffness * (road - w) + damping * (rate - v), -pull[own])
        travel = run.position @ directions[:, :wheels]
        found = {"body_acceleration": run.acceleration[:, 0]}
        if parts > 1:
            found["body_angular_acceleration"] = run.acceleration[:, 1]
        for i, name in enumerate(self.names):
            found[f"wheel_acceleration{name}"] = run.acceleration[:, parts + i]
            found[f"suspension_travel{name}"] = travel[:, i]
            found[f"tyre_force{name}"] = tyre[:, i]
        return found

    def _rows(self) -> Array:
        """How heave, pitch and roll lift the body over each wheel."""
        columns = {"quarter": 1, "half": 2, "full": 3}[self.kind]
        return np.array([[1.0, -c.x, c.y][:columns] for c in self.corners])

    def _struts(self, rows: Array) -> tuple[tuple[Strut, ...], Array]:
        """Struts and guides with their directions."""
        parts, wheels = rows.shape[1], len(self.corners)
        struts: list[Strut] = []
        directions = list(np.vstack((rows.T, -np.eye(wheels))).T)
        for i, corner in enumerate(self.corners):
            change = self.change(i)
            device = change.device or corner.device
            struts.append(_Strut(device=device, extra=change.extra or _no_force))
        for i in range(wheels):
            if (guide := self.change(i).guide) is not None:
                struts.append(Strut(device=guide))
                directions.append(np.eye(parts + wheels)[parts + i])
        return tuple(struts), np.array(directions).T


def _nothing(t: float) -> float:
    del t
    return 0.0


def _no_force(x: float, v: float) -> float:
    del x, v
    return 0.0


@dataclass(frozen=True, kw_only=True)
class _Strut(Strut):
    """A strut with a further force of its elongation and rate."""

    extra: Callable[[float, float], float] = _no_force

    def at(
        self, x: float, v: float, own: Array, contact: int | None = None, a: float = 0.0
    ) -> StrutPoint:
        """What the strut does."""
        point = super().at(x, v, own, contact, a)
        return replace(point, known=point.known + self.extra(x, v))


def _with_rider(
    rider: tuple[float, float, float], mass: Array, matrices: Array
) -> tuple[Array, Array]:
    """Masses, and stiffness and damping (2, nq, nq), with a last coordinate on the heave."""
    weight, *between = rider
    found = np.pad(matrices, ((0, 0), (0, 1), (0, 1)))
    for matrix, value in zip(found, between, strict=True):
        matrix[0, 0] += value
        matrix[-1, -1] += value
        matrix[0, -1] -= value
        matrix[-1, 0] -= value
    return np.append(mass, weight), found


# --- a trailing arm ------------------------------------------------------------------------------


class _Arm:
    """One drive of a wheel on a trailing arm; the state is (z, th, z', th', the device's)."""

    def __init__(self, vehicle: DrawnVehicle, track: Track, loads: tuple[Signal, ...]) -> None:
        self.vehicle, self.track = vehicle, track
        self.active, self.on_body, self.on_wheel = loads
        self.corner, self.changed = vehicle.corners[0], vehicle.change(0)
        self.device = self.changed.device or self.corner.device
        self.rest = self._length(vehicle.arm_angle)[0]

    def _length(self, angle: float) -> tuple[float, float, float]:
        """The strut's length and its two derivatives by the angle."""
        reach, height = self.vehicle.strut_reach, self.vehicle.strut_height
        length = float(np.sqrt(reach**2 + height**2 - 2.0 * reach * height * np.sin(angle)))
        slope = -reach * height * np.cos(angle) / length
        bend = (reach * height * np.sin(angle) - slope**2) / length
        return length, slope, bend

    def _tyre(self, t: float, state: Array) -> float:
        z, th, dz, dth = state[:4]
        length, first = self.vehicle.arm_length, self.vehicle.arm_angle
        rise, rate = z + length * (np.sin(th) - np.sin(first)), dz + length * np.cos(th) * dth
        force = self.corner.tyre_stiffness * (self.track(t) - rise)
        force += self.changed.tyre_damping * (self.track.rate(t) - rate)
        return float(max(force, -self.changed.static_load))

    def accelerations(self, t: float, state: Array) -> Array:
        """Of the body upward and of the arm's angle, (2,)."""
        v, c = self.vehicle, self.corner
        _, th, dz, dth = state[:4]
        length, slope, bend = self._length(th)
        x, rate = length - self.rest, slope * dth
        z = self.device.state_argument(state[4:])
        mass, rest = self.device.branch(x, rate, z)
        known = float(self.device.rest_force(x, rate, z)) - self.active(t)
        if self.changed.extra is not None:
            known += self.changed.extra(x, rate)
        share = float(self.device.load_share(rate, 1.0, z))
        tyre = self._tyre(t, state) + self.on_wheel(t)
        body = self.on_body(t)
        if self.changed.guide is not None:
            body -= float(self.changed.guide.rest_force(0.0, dz))
        arm = v.arm_length
        inertia = np.array(
            [[v.body_mass + c.wheel_mass, c.wheel_mass * arm * np.cos(th)],
             [c.wheel_mass * arm * np.cos(th), c.wheel_mass * arm**2 + v.arm_inertia]]
        )  # fmt: skip
        whirl = c.wheel_mass * arm * np.sin(th) * dth**2
        found = np.zeros(2)
        # the load friction has the sign of the branch's force, which one of both signs leaves
        for sign in (1.0, -1.0) if share else (0.0,):
            factor = 1.0 + sign * share
            coupled = inertia.copy()
            coupled[1, 1] += factor * mass * slope**2
            carried = factor * (float(rest) + float(mass) * bend * dth**2)
            right = [tyre + body + whirl, tyre * arm * np.cos(th) - slope * (known + carried)]
            found = np.linalg.solve(coupled, right)
            branch = float(rest) + float(mass) * (slope * found[1] + bend * dth**2)
            if branch * sign >= 0.0:
                break
        return found

    def rates(self, t: float, state: Array) -> Array:
        """Of the state."""
        length, slope, _ = self._length(state[1])
        found = np.concatenate((state[2:4], self.accelerations(t, state)))
        if not self.device.nstate:
            return found
        z = self.device.state_argument(state[4:])
        own = self.device.state_rate(length - self.rest, slope * state[3], z)
        return np.concatenate((found, np.atleast_1d(np.asarray(own, dtype=float))))

    def run(self, times: Array) -> dict[str, Array]:
        """The channels."""
        begin = np.zeros(4 + self.device.nstate)
        begin[1] = self.vehicle.arm_angle
        run = solve_ivp(
            self.rates, (float(times[0]), float(times[-1])), begin, t_eval=times,
            method="LSODA", rtol=1e-7, atol=1e-9, max_step=0.01,
        )  # fmt: skip
        if not run.success:
            raise RuntimeError(f"LSODA stopped: {run.message}")
        arm, states = self.vehicle.arm_length, run.y.T
        acc = np.array([self.accelerations(t, y) for t, y in zip(times, states, strict=True)])
        th, dth, lean = states[:, 1], states[:, 3], self.vehicle.wheel_lean
        up = acc[:, 0] + arm * (np.cos(th) * acc[:, 1] - np.sin(th) * dth**2)
        forward = -arm * (np.sin(th) * acc[:, 1] + np.cos(th) * dth**2)
        return {
            "body_acceleration": acc[:, 0],
            "wheel_acceleration": np.cos(lean) * up + np.sin(lean) * forward,
            "suspension_travel": np.array([self._length(a)[0] for a in th]) - self.rest,
            "tyre_force": np.array([self._tyre(t, y) for t, y in zip(times, states, strict=True)]),
        }
