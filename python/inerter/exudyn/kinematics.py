"""How the length between two terminals follows from the coordinates of Exudyn's nodes.

    x = L - rest_length,  v = J q',  a = J q'' + bias

`Line`: coordinates of nodes on one line, J constant. `Span`: the distance of two points on bodies;
a point P at r in the body's frame has p = x + A r, partial velocities (unit vectors, g_k x A r) and
at q'' = 0 the acceleration (w' x A r + w x (w x A r)); g_k is the angular velocity per unit of
rotational velocity coordinate k.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from inerter.exudyn.functions import Functions, Value

Vector = tuple[Value, Value, Value]
Matrix = tuple[Vector, Vector, Vector]
Numbers = Sequence[Value]


class Motion(NamedTuple):
    """Length or displacement [m], its rate, J of shape (coordinates,), bias [m/s^2]."""

    length: Value
    rate: Value
    row: list[Value]
    bias: Value


class Rotation(NamedTuple):
    """A, the axes g_k, and the angular acceleration at q'' = 0 [rad/s^2]."""

    matrix: Matrix
    axes: list[Vector]
    bias: Vector


@dataclass(frozen=True)
class Line:
    """The coordinates at `places` times `weights`: a difference of two coordinates, or one."""

    size: int
    places: tuple[int, ...]
    weights: tuple[float, ...]

    @property
    def row(self) -> list[float]:
        """J, shape (size,)."""
        found: list[Value] = [0.0] * self.size
        for place, weight in zip(self.places, self.weights, strict=True):
            found[place] += weight
        return found

    def difference(self, values: Numbers) -> Value:
        """J times values of shape (size,) or longer."""
        found = 0.0
        for place, weight in zip(self.places, self.weights, strict=True):
            found = found + weight * values[place] if weight != 1.0 else values[place] + found
        return found

    def at(self, f: Functions, q: Numbers, q_t: Numbers) -> Motion:
        """The motion at coordinates and velocities of shape (size,) or longer."""
        return Motion(self.difference(q), self.difference(q_t), self.row, 0.0)


@dataclass(frozen=True)
class Point:
    """A point fixed to a node: its coordinates start at `start`, `reference` is their reference.

    `moves` says which of x, y, z the node's first coordinates are; `rotation` gives the rotation
    from the others; a point of the ground has no coordinates and stands at `local`.
    """

    start: int = 0
    reference: tuple[float, ...] = ()
    moves: int = 0
    rotation: Callable[[Functions, Numbers, Numbers], Rotation] | None = None
    local: Vector = (0.0, 0.0, 0.0)

    def at(
        self, f: Functions, q: Numbers, q_t: Numbers
    ) -> tuple[Vector, Vector, list[Vector], Vector]:
        """Position, velocity, partial velocities, acceleration at q'' = 0."""
        if not self.reference:
            return self.local, ZERO, [], ZERO
        end = self.start + len(self.reference)
        total = [a + b for a, b in zip(self.reference, q[self.start : end], strict=True)]
        rates = list(q_t[self.start : end])
        moves = self.moves
        rest = [0.0] * (3 - moves)
        origin, speed = (*total[:moves], *rest), (*rates[:moves], *rest)
        partial = list(UNITS[:moves])
        if self.rotation is None:
            position = add(origin, self.local)  # pyright: ignore[reportArgumentType]
            return position, speed, partial, ZERO  # pyright: ignore[reportReturnType]

        turned = self.rotation(f, total[moves:], rates[moves:])
        arm = apply(turned.matrix, self.local)
        spin = ZERO
        for axis, rate in zip(turned.axes, rates[moves:], strict=True):
            spin = add(spin, scale(axis, rate))
            partial.append(cross(axis, arm))
        swing = cross(spin, arm)
        bias = add(cross(turned.bias, arm), cross(spin, swing))
        return add(origin, arm), add(speed, swing), partial, bias  # pyright: ignore[reportArgumentType]


@dataclass(frozen=True)
class Span:
    """The distance between two points."""

    size: int
    first: Point
    second: Point

    def at(self, f: Functions, q: Numbers, q_t: Numbers) -> Motion:
        """The motion at coordinates and velocities of shape (size,) or longer."""
        p1, v1, partial1, bias1 = self.first.at(f, q, q_t)
        p2, v2, partial2, bias2 = self.second.at(f, q, q_t)
        between, relative = subtract(p2, p1), subtract(v2, v1)
        length = f.sqrt(dot(between, between))
        line = scale(between, 1.0 / f.greatest(length, SHORTEST))
        rate = dot(line, relative)
        row: list[Value] = [0.0] * self.size
        for point, partial, sign in ((self.first, partial1, -1.0), (self.second, partial2, 1.0)):
            for k, velocity in enumerate(partial):
                row[point.start + k] += sign * dot(line, velocity)
        across = f.greatest(0.0, dot(relative, relative) - rate * rate)
        bias = dot(line, subtract(bias2, bias1)) + across / f.greatest(length, SHORTEST)
        return Motion(length, rate, row, bias)


@dataclass(frozen=True)
class Frame:
    """A body that turns: as `Point`; without `rotation` it is the ground.

    `across` is a unit vector across the axis, in the body's frame.
    """

    start: int = 0
    reference: tuple[float, ...] = ()
    moves: int = 0
    rotation: Callable[[Functions, Numbers, Numbers], Rotation] | None = None
    across: Vector = (1.0, 0.0, 0.0)

    def at(self, f: Functions, q: Numbers, q_t: Numbers) -> tuple[Rotation, Vector]:
        """The rotation and the angular velocity."""
        if self.rotation is None:
            return Rotation(UNITS, [], ZERO), ZERO
        end = self.start + len(self.reference)
        total = [a + b for a, b in zip(self.reference, q[self.start : end], strict=True)]
        rates = list(q_t[self.start : end])[self.moves :]
        turned = self.rotation(f, total[self.moves :], rates)
        spin = ZERO
        for axis, rate in zip(turned.axes, rates, strict=True):
            spin = add(spin, scale(axis, rate))
        return turned, spin


@dataclass(frozen=True)
class Twist:
    """The angle by which the second body has turned about an axis, seen from the first [rad].

    `axis` is a unit vector in the first body's frame, or the ground's if `fixed`. The length of the
    motion is the angle within one turn.
    """

    size: int
    first: Frame
    second: Frame
    axis: Vector
    fixed: bool = False

    def at(self, f: Functions, q: Numbers, q_t: Numbers) -> Motion:
        """The motion at coordinates and velocities of shape (size,) or longer."""
        (turned1, spin1), (turned2, spin2) = self.first.at(f, q, q_t), self.second.at(f, q, q_t)
        line = self.axis if self.fixed else apply(turned1.matrix, self.axis)
        relative = subtract(spin2, spin1)
        row: list[Value] = [0.0] * self.size
        for frame, turned, sign in ((self.first, turned1, -1.0), (self.second, turned2, 1.0)):
            for k, axis in enumerate(turned.axes):
                row[frame.start + frame.moves + k] += sign * dot(line, axis)
        bias = dot(line, subtract(turned2.bias, turned1.bias))
        if not self.fixed:
            bias = bias + dot(cross(spin1, line), relative)
        one = apply(turned1.matrix, self.first.across)
        other = apply(turned2.matrix, self.second.across)
        angle = f.arctan2(dot(other, cross(line, one)), dot(other, one))
        return Motion(angle, dot(line, relative), row, bias)


SHORTEST = 1e-9
"""Distance of the terminals [m] below which their line has no direction."""

TURNED = 1e-8
"""Square of a rotation vector [rad^2] below which its series has all digits."""

ZERO: Vector = (0.0, 0.0, 0.0)
UNITS: Matrix = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def add(a: Vector, b: Vector) -> Vector:
    """A + b."""
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def subtract(a: Vector, b: Vector) -> Vector:
    """A - b."""
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def scale(a: Vector, factor: Value) -> Vector:
    """Factor a."""
    return (factor * a[0], factor * a[1], factor * a[2])


def dot(a: Vector, b: Vector) -> Value:
    """A . b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    """A x b."""
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def apply(matrix: Matrix, vector: Vector) -> Vector:
    """Matrix times vector."""
    return (dot(matrix[0], vector), dot(matrix[1], vector), dot(matrix[2], vector))


def plane_rotation(f: Functions, angles: Numbers, rates: Numbers) -> Rotation:
    """Rotation about z, of a planar rigid body."""
    c, s = f.cos(angles[0]), f.sin(angles[0])
    return Rotation(((c, -s, 0.0), (s, c, 0.0), (0.0, 0.0, 1.0)), [UNITS[2]], ZERO)


def euler_parameters(f: Functions, p: Numbers, rates: Numbers) -> Rotation:
    """Euler parameters (e0, e1, e2, e3); E p'' is all of the angular acceleration."""
    e0, e1, e2, e3 = p
    matrix = (
        (1 - 2 * (e2 * e2 + e3 * e3), 2 * (e1 * e2 - e0 * e3), 2 * (e1 * e3 + e0 * e2)),
        (2 * (e1 * e2 + e0 * e3), 1 - 2 * (e1 * e1 + e3 * e3), 2 * (e2 * e3 - e0 * e1)),
        (2 * (e1 * e3 - e0 * e2), 2 * (e2 * e3 + e0 * e1), 1 - 2 * (e1 * e1 + e2 * e2)),
    )
    axes = [
        (-2 * e1, -2 * e2, -2 * e3),
        (2 * e0, 2 * e3, -2 * e2),
        (-2 * e3, 2 * e0, 2 * e1),
        (2 * e2, -2 * e1, 2 * e0),
    ]
    return Rotation(matrix, axes, ZERO)


def tait_bryan(f: Functions, angles: Numbers, rates: Numbers) -> Rotation:
    """Rotations about x, the new y, the new z."""
    (c1, s1), (c2, s2), (c3, s3) = ((f.cos(a), f.sin(a)) for a in angles)
    matrix = (
        (c2 * c3, -c2 * s3, s2),
        (c1 * s3 + s1 * s2 * c3, c1 * c3 - s1 * s2 * s3, -s1 * c2),
        (s1 * s3 - c1 * s2 * c3, s1 * c3 + c1 * s2 * s3, c1 * c2),
    )
    second, third = (0.0, c1, s1), (s2, -s1 * c2, c1 * c2)
    turn = scale(UNITS[0], rates[0])
    both = add(turn, scale(second, rates[1]))
    # each axis is carried by the rotations before it
    bias = add(scale(cross(turn, second), rates[1]), scale(cross(both, third), rates[2]))
    return Rotation(matrix, [UNITS[0], second, third], bias)


def rotation_vector(f: Functions, vector: Numbers, rates: Numbers) -> Rotation:
    """Rotation vector; the velocity coordinates are the angular velocity in the body's frame."""
    x, y, z = vector
    square = x * x + y * y + z * z
    # near no rotation the quotients are their series
    small, angle = square < TURNED, f.sqrt(f.greatest(square, TURNED))
    sine = f.choose(small, 1.0 - square / 6.0, f.sin(angle) / angle)
    cosine = f.choose(small, 0.5 - square / 24.0, (1.0 - f.cos(angle)) / (angle * angle))
    matrix = (
        (1 - cosine * (y * y + z * z), cosine * x * y - sine * z, cosine * x * z + sine * y),
        (cosine * x * y + sine * z, 1 - cosine * (x * x + z * z), cosine * y * z - sine * x),
        (cosine * x * z - sine * y, cosine * y * z + sine * x, 1 - cosine * (x * x + y * y)),
    )
    axes = [(matrix[0][k], matrix[1][k], matrix[2][k]) for k in range(3)]
    return Rotation(matrix, axes, ZERO)
