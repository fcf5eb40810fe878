"""Mechanisms with inerters in every topology, and their motion from hand-written equations.

Every mechanism gives M, f, and for each device a row J with the part of its acceleration that the
velocities alone cause: a = J v' + j. Newton-Euler or Lagrange with a device F = b a + c l' + k l:

  (M + sum b J'J) v' = f - sum J' (b j + c l' + k (l - l0))

M, f, J, j come from the geometry below; no function of MuJoCo's takes part in the truths.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

Array = NDArray[np.floating]
Row = tuple[float, Array, float]  # length, J, part of the acceleration due to the velocities


@dataclass(frozen=True)
class Device:
    """Inertance b [kg] with a damper [N*s/m] and a spring [N/m] of free length `rest` [m]."""

    inertance: float
    viscous: float = 0.0
    stiffness: float = 0.0
    rest: float = 0.0

    def keys(self) -> dict[str, float | str]:
        """Keys of the plugin."""
        return {
            "inertance": self.inertance, "viscous": self.viscous, "stiffness": self.stiffness,
            "rest_length": self.rest,
        }  # fmt: skip


class Mechanism(Protocol):
    """What the truth is computed from; q in the layout of the oracle, v its velocities."""

    @property
    def devices(self) -> Sequence[Device]:
        """The devices, in the order of the rows."""
        ...

    def start(self) -> tuple[Array, Array]:
        """Coordinates and velocities at time 0."""
        ...

    def rate(self, q: Array, v: Array) -> Array:
        """dq/dt."""
        ...

    def equations(self, q: Array, v: Array) -> tuple[Array, Array, list[Row]]:
        """M, f and the rows of the devices."""
        ...

    def shown(self, q: Array) -> Array:
        """MuJoCo's qpos."""
        ...


def acceleration(mechanism: Mechanism, q: Array, v: Array) -> Array:
    """Rate of v with all devices."""
    mass, force, rows = mechanism.equations(q, v)
    for device, (length, row, bias) in zip(mechanism.devices, rows, strict=True):
        mass = mass + device.inertance * np.outer(row, row)
        spring = device.stiffness * (length - device.rest)
        force = force - row * (device.inertance * bias + device.viscous * (row @ v) + spring)
    return np.linalg.solve(mass, force)


def motion(mechanism: Mechanism, times: Array) -> Array:
    """Rows of qpos at the times."""
    q0, v0 = mechanism.start()
    n = len(q0)

    def slope(_: float, y: Array) -> Array:
        q, v = y[:n], y[n:]
        return np.concatenate([mechanism.rate(q, v), acceleration(mechanism, q, v)])

    y0 = np.concatenate([q0, v0])
    span = (times[0], times[-1])
    result = solve_ivp(slope, span, y0, "DOP853", times, rtol=1e-12, atol=1e-13)
    return np.array([mechanism.shown(q) for q in result.y[:n].T])


def segment(start: tuple[Array, Array, Array], end: tuple[Array, Array, Array], v: Array) -> Row:
    """Distance of two points (place, Jacobian, bias): l'' = u.a + (|w|^2 - (u.w)^2) / l."""
    (p0, j0, b0), (p1, j1, b1) = start, end
    distance = float(np.linalg.norm(p1 - p0))
    along, apart = (p1 - p0) / distance, (j1 - j0) @ v
    swing = (apart @ apart - (along @ apart) ** 2) / distance
    return distance, along @ (j1 - j0), float(along @ (b1 - b0) + swing)


# --------------------------- free rigid bodies ----------------------------------------------------

World = -1
Point = tuple[int, Sequence[float]]  # body (or World) and place in its frame
Path = Sequence[tuple[float, Sequence[Point]]]  # branches of a tendon: divisor and sites


def turn(quaternion: Array) -> Array:
    """Rotation matrix of a quaternion (w, x, y, z), normalised here."""
    w, x, y, z = quaternion / np.linalg.norm(quaternion)
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])  # fmt: skip


@dataclass(frozen=True)
class Body:
    """A rigid body; velocity of its frame in the world's axes, spin in its own."""

    place: Sequence[float]
    velocity: Sequence[float] = (0, 0, 0)
    spin: Sequence[float] = (0, 0, 0)
    mass: float = 1.0
    centre: Sequence[float] = (0, 0, 0)
    inertia: Sequence[float] = (0.1, 0.1, 0.1, 0, 0, 0)  # xx yy zz xy xz yz about the centre
    attitude: Sequence[float] = (1, 0, 0, 0)

    def matrix(self) -> Array:
        """Inertia about the centre of mass, in the body's axes."""
        xx, yy, zz, xy, xz, yz = self.inertia
        return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]], float)


@dataclass(frozen=True)
class FreeBodies:
    """Free bodies and spatial tendons. q: centres and quaternions, v: velocities and body spins."""

    bodies: Sequence[Body]
    paths: Sequence[Path]
    devices: Sequence[Device]
    gravity: Sequence[float] = (0, 0, 0)

    def start(self) -> tuple[Array, Array]:
        """Coordinates and velocities at time 0."""
        q, v = [], []
        for body in self.bodies:
            attitude, centre = np.array(body.attitude, float), np.array(body.centre, float)
            rotation = turn(attitude)
            q += [np.array(body.place) + rotation @ centre, attitude / np.linalg.norm(attitude)]
            v += [np.array(body.velocity) + rotation @ np.cross(body.spin, centre), body.spin]
        return np.concatenate(q), np.concatenate(v)

    def rate(self, q: Array, v: Array) -> Array:
        """dq/dt."""
        rates = np.empty_like(q)
        for i in range(len(self.bodies)):
            w, x, y, z = q[7 * i + 3 : 7 * i + 7]
            rates[7 * i : 7 * i + 3] = v[6 * i : 6 * i + 3]
            spread = np.array([[-x, -y, -z], [w, -z, y], [z, w, -x], [-y, x, w]])
            rates[7 * i + 3 : 7 * i + 7] = spread @ v[6 * i + 3 : 6 * i + 6] / 2
        return rates

    def point(self, q: Array, v: Array, point: Point) -> tuple[Array, Array, Array]:
        """Position, Jacobian and velocity-caused acceleration of a site."""
        i, place = point
        jacobian = np.zeros((3, len(v)))
        if i == World:
            return np.array(place, float), jacobian, np.zeros(3)
        arm = np.array(place, float) - self.bodies[i].centre
        rotation, spin = turn(q[7 * i + 3 : 7 * i + 7]), v[6 * i + 3 : 6 * i + 6]
        x, y, z = arm
        jacobian[:, 6 * i : 6 * i + 3] = np.eye(3)
        cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        jacobian[:, 6 * i + 3 : 6 * i + 6] = -rotation @ cross
        bias = rotation @ np.cross(spin, np.cross(spin, arm))
        return q[7 * i : 7 * i + 3] + rotation @ arm, jacobian, bias

    def row(self, q: Array, v: Array, path: Path) -> Row:
        """Length of a tendon with its derivatives."""
        length, row, bias = 0.0, np.zeros(len(v)), 0.0
        for divisor, points in path:
            ends = [self.point(q, v, point) for point in points]
            for one, other in pairwise(ends):
                distance, along, turning = segment(one, other, v)
                length += distance / divisor
                row = row + along / divisor
                bias += turning / divisor
        return length, row, bias

    def equations(self, q: Array, v: Array) -> tuple[Array, Array, list[Row]]:
        """M, f and the rows of the devices."""
        mass, force = np.zeros((len(v), len(v))), np.zeros(len(v))
        for i, body in enumerate(self.bodies):
            inertia, spin = body.matrix(), v[6 * i + 3 : 6 * i + 6]
            mass[6 * i : 6 * i + 3, 6 * i : 6 * i + 3] = body.mass * np.eye(3)
            mass[6 * i + 3 : 6 * i + 6, 6 * i + 3 : 6 * i + 6] = inertia
            force[6 * i : 6 * i + 3] = body.mass * np.array(self.gravity)
            force[6 * i + 3 : 6 * i + 6] = -np.cross(spin, inertia @ spin)
        return mass, force, [self.row(q, v, path) for path in self.paths]

    def shown(self, q: Array) -> Array:
        """Places of the bodies' frames and normalised quaternions."""
        rows = []
        for i, body in enumerate(self.bodies):
            attitude = q[7 * i + 3 : 7 * i + 7] / np.linalg.norm(q[7 * i + 3 : 7 * i + 7])
            centre = turn(attitude) @ np.array(body.centre, float)
            rows += [q[7 * i : 7 * i + 3] - centre, attitude]
        return np.concatenate(rows)

    def mjcf(self) -> tuple[str, str, list[str]]:
        """The MJCF texts of bodies and tendons, and the devices' targets."""
        sites: dict[int, str] = dict.fromkeys(range(-1, len(self.bodies)), "")
        tendons = ""
        for k, path in enumerate(self.paths):
            steps = ""
            for number, (divisor, points) in enumerate(path):
                steps += f'<pulley divisor="{divisor}"/>' if len(path) > 1 else ""
                for at, (i, place) in enumerate(points):
                    name = f"s{k}_{number}_{at}"
                    sites[i] += f'<site name="{name}" pos="{text(place)}"/>'
                    steps += f'<site site="{name}"/>'
            tendons += f'<spatial name="t{k}">{steps}</spatial>'
        bodies = sites[World]
        for i, body in enumerate(self.bodies):
            bodies += f"""
    <body name="b{i}" pos="{text(body.place)}" quat="{text(body.attitude)}">
      <freejoint/>
      <inertial pos="{text(body.centre)}" mass="{body.mass}" {moments(body.inertia)}/>
      {sites[i]}
    </body>"""
        return bodies, tendons, [f'tendon="t{k}"' for k in range(len(self.paths))]


def text(numbers: Sequence[float]) -> str:
    """Numbers for an attribute."""
    return " ".join(repr(float(number)) for number in numbers)


def moments(inertia: Sequence[float]) -> str:
    """The attribute that states an inertia; diagonal ones leave the body "simple"."""
    if any(inertia[3:]):
        return f'fullinertia="{text(inertia)}"'
    return f'diaginertia="{text(inertia[:3])}"'


# --------------------------- planar chains of links -----------------------------------------------


@dataclass(frozen=True)
class Link:
    """A link in the xz plane: its centre and the next joint along it, its joint at time 0."""

    angle: float
    speed: float
    length: float = 0.4
    centre: float = 0.25
    mass: float = 1.0
    inertia: float = 0.03


Place = tuple[int, int, float] | tuple[float, float]  # chain, link, distance; or x, z


@dataclass(frozen=True)
class Chains:
    """Chains of hinged links. q: angles of the links to the x axis, not to their parents."""

    chains: Sequence[tuple[tuple[float, float], Sequence[Link]]]
    devices: Sequence[Device]
    angles: Sequence[Mapping[tuple[int, int], float]] = ()  # coefficients of joint angles
    cables: Sequence[tuple[Place, Place]] = ()
    gravity: float = 9.81

    def index(self, chain: int, link: int) -> int:
        """Place of a link in q."""
        return sum(len(links) for _, links in self.chains[:chain]) + link

    def start(self) -> tuple[Array, Array]:
        """Angles and speeds of the links at time 0."""
        angles = [np.cumsum([link.angle for link in links]) for _, links in self.chains]
        speeds = [np.cumsum([link.speed for link in links]) for _, links in self.chains]
        return np.concatenate(angles), np.concatenate(speeds)

    def rate(self, q: Array, v: Array) -> Array:
        """dq/dt."""
        return v

    def point(self, q: Array, v: Array, place: Place) -> tuple[Array, Array, Array]:
        """Position, Jacobian and velocity-caused acceleration of a place on a link."""
        jacobian, bias = np.zeros((2, len(q))), np.zeros(2)
        if len(place) == 2:
            return np.array(place), jacobian, bias
        chain, last, distance = place
        anchor, links = self.chains[chain]
        position = np.array(anchor, float)
        for i in range(last + 1):
            reach = distance if i == last else links[i].length
            k = self.index(chain, i)
            along = reach * np.array([np.cos(q[k]), np.sin(q[k])])
            position = position + along
            jacobian[:, k] = -along[1], along[0]
            bias -= along * v[k] ** 2
        return position, jacobian, bias

    def equations(self, q: Array, v: Array) -> tuple[Array, Array, list[Row]]:
        """M, f and the rows of the devices: those of `angles`, then those of `cables`."""
        mass, force = np.zeros((len(q), len(q))), np.zeros(len(q))
        for c, (_, links) in enumerate(self.chains):
            for i, link in enumerate(links):
                _, jacobian, bias = self.point(q, v, (c, i, link.centre))
                k = self.index(c, i)
                mass += link.mass * jacobian.T @ jacobian
                mass[k, k] += link.inertia
                force -= link.mass * jacobian.T @ (bias + np.array([0, self.gravity]))
        rows = []
        for coefficients in self.angles:
            row = np.zeros(len(q))
            for (c, i), coefficient in coefficients.items():
                row[self.index(c, i)] += coefficient
                if i:
                    row[self.index(c, i - 1)] -= coefficient
            rows.append((float(row @ q), row, 0.0))
        for start, end in self.cables:
            rows.append(segment(self.point(q, v, start), self.point(q, v, end), v))
        return mass, force, rows

    def shown(self, q: Array) -> Array:
        """Angles of the joints."""
        return np.concatenate([
            np.diff(q[self.index(c, 0) : self.index(c, 0) + len(links)], prepend=0)
            for c, (_, links) in enumerate(self.chains)
        ])  # fmt: skip

    def mjcf(self, targets: Sequence[str] | None = None) -> tuple[str, str, list[str]]:
        """The MJCF texts of bodies and tendons, and the devices' targets."""
        sites: dict[object, str] = {}
        tendons, found = "", list(targets or [])
        for k, coefficients in enumerate(self.angles[len(found) :], start=len(found)):
            joints = "".join(
                f'<joint joint="j{c}_{i}" coef="{coef}"/>' for (c, i), coef in coefficients.items()
            )
            tendons += f'<fixed name="f{k}">{joints}</fixed>'
            found.append(f'tendon="f{k}"')
        for k, ends in enumerate(self.cables):
            steps = ""
            for end, place in enumerate(ends):
                free = len(place) == 2
                key, (x, z) = (World, place) if free else (place[:2], (place[2], 0))
                site = f'<site name="s{k}_{end}" pos="{x} 0 {z}"/>'
                sites[key] = sites.get(key, "") + site
                steps += f'<site site="s{k}_{end}"/>'
            tendons += f'<spatial name="c{k}">{steps}</spatial>'
            found.append(f'tendon="c{k}"')
        bodies = sites.get(World, "")
        for c, ((x, z), links) in enumerate(self.chains):
            place = f"{x} 0 {z}"
            for i, link in enumerate(links):
                moment = f"{link.inertia} {link.inertia} {link.inertia}"
                bodies += f"""
    <body name="l{c}_{i}" pos="{place}">
      <joint name="j{c}_{i}" axis="0 -1 0"/>
      <inertial pos="{link.centre} 0 0" mass="{link.mass}" diaginertia="{moment}"/>
      {sites.get((c, i), "")}"""
                place = f"{link.length} 0 0"
            bodies += "</body>" * len(links)
        return bodies, tendons, found
