"""A car as plain data, SI units.

Forces count from rest, displacements from the ride height, upward. A strut moves by `motion_ratio`
times what the body moves against the wheel: springs and dampers count for the wheel with its
square. Damper tables are pairs of strut speed and force, both positive: bump while the strut
shortens, rebound while it lengthens; from the origin, straight between the points and beyond the
last with its last slope. Not modelled: geometry that bends.
"""

from __future__ import annotations

from dataclasses import dataclass

GRAVITY = 9.81
"""[m/s^2]."""

Table = tuple[tuple[float, float], ...]


@dataclass(frozen=True, kw_only=True)
class StrutParts:
    """What stands between body and wheel.

    Attributes
    ----------
    layout
        "S1" ... of `inerter.suspension.layouts`, with `stiffness` k [N/m] of all of it at rest,
        `damping` c [N s/m], `inertance` b [kg], `relaxation_stiffness` k_b, `damper_stiffness` k_1
        and `inerter_stiffness` k_2 [N/m] where the layout has them.
    damper_bump, damper_rebound
        Tables ([m/s], [N]) in place of c.
    motion_ratio
        Travel of the strut per travel of the wheel.
    device
        What the inerter has beside its inertance, by the keys of a device.toml (SI): friction,
        play, a shaft.
    bump_stop_gap, bump_stop_stiffness, rebound_stop_gap, rebound_stop_stiffness
        Stops after so much travel of the strut [m] with [N/m]; no stop at stiffness 0.
    """

    layout: str = "S1"
    stiffness: float
    damping: float = 0.0
    inertance: float = 0.0
    relaxation_stiffness: float = 0.0
    damper_stiffness: float = 0.0
    inerter_stiffness: float = 0.0
    damper_bump: Table = ()
    damper_rebound: Table = ()
    motion_ratio: float = 1.0
    device: tuple[tuple[str, float | str], ...] = ()
    bump_stop_gap: float = 0.0
    bump_stop_stiffness: float = 0.0
    rebound_stop_gap: float = 0.0
    rebound_stop_stiffness: float = 0.0

    @property
    def wheel_rate(self) -> float:
        """Stiffness at the wheel [N/m]."""
        return self.stiffness * self.motion_ratio**2

    @property
    def mean_damping(self) -> float:
        """Damping [N s/m]: as stated, or the mean of the tables' slopes up to their last points."""
        slopes = [
            table[-1][1] / table[-1][0]
            for table in (self.damper_bump, self.damper_rebound)
            if table
        ]
        return sum(slopes) / len(slopes) if slopes else self.damping


@dataclass(frozen=True, kw_only=True)
class AxleParts:
    """One wheel of an axle: `distance` [m] from the centre of mass, wheel, tyre and strut.

    `tyre_damping` [N s/m]: spring and damper of a tyre act side by side.
    `anti_roll_stiffness` [N/m]: force on each wheel per its travel where both wheels of the axle
    move against each other.
    """

    distance: float = 0.0
    wheel_mass: float
    tyre_stiffness: float
    tyre_damping: float = 0.0
    anti_roll_stiffness: float = 0.0
    strut: StrutParts


@dataclass(frozen=True, kw_only=True)
class CarParts:
    """A car: `kind` "quarter", "half" or "full".

    `body_mass` [kg] of all that is sprung: over one wheel, of one side, of the whole car.
    `pitch_inertia`, `roll_inertia` [kg m^2], `track` [m]. `front` is the only axle of a
    quarter-car, and one of the two wheels of a full car's axle. `correlation` is that of the left
    and the right road.
    """

    kind: str
    name: str
    body_mass: float
    pitch_inertia: float = 0.0
    roll_inertia: float = 0.0
    track: float = 0.0
    correlation: float = 0.5
    front: AxleParts
    rear: AxleParts | None = None

    @property
    def axles(self) -> dict[str, AxleParts]:
        """Front and, if there is one, rear."""
        return {"front": self.front} | ({"rear": self.rear} if self.rear else {})

    @property
    def static_loads(self) -> dict[str, float]:
        """Weight on one tyre of each axle [N]."""
        if self.rear is None:
            return {"front": GRAVITY * (self.body_mass + self.front.wheel_mass)}
        base = self.front.distance + self.rear.distance
        side = self.body_mass / (2.0 if self.kind == "full" else 1.0)
        front, rear = self.rear.distance / base, self.front.distance / base
        return {
            "front": GRAVITY * (side * front + self.front.wheel_mass),
            "rear": GRAVITY * (side * rear + self.rear.wheel_mass),
        }
