"""A model of a vehicle to try: an effect, where its fits start, what its sizes are."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from inerter.catalogue.scales import Range, Scales
from inerter.diagnose.vehicle.model import Added, VehicleModel, key


@dataclass(frozen=True, kw_only=True)
class Scale:
    """Of one device along the recorded road: force [N], displacement, velocity, acceleration.

    largest, smallest: displacement [m]; step: of the model [s]; explicit: its integrator does not
    resolve a force law that is steeper than a step.
    """

    force: float
    x: float
    v: float
    a: float
    largest: float
    smallest: float
    step: float
    explicit: bool

    @property
    def of_data(self) -> Scales:
        """The same as sizes of a data set's channels."""
        return Scales(
            force=self.force, displacement=self.x, velocity=self.v, acceleration=self.a
        )  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class VehicleCandidate:
    """A model to try: an effect, its coordinates, where fits start, what a start's size is.

    starts: values by coordinate. amplitudes: coordinates that a start is strong or weak by.
    telling: amplitudes of which one has to differ from none; all by default.
    """

    added: Added
    starts: tuple[Mapping[str, float], ...]
    amplitudes: tuple[str, ...]
    sizes: Mapping[str, Range]
    friction: str | None = None
    telling: tuple[str, ...] = ()

    def model(self, base: VehicleModel, start: Mapping[str, float]) -> VehicleModel:
        """The base with the effect at a start."""
        return base.adding(self.added, start, self.friction)


def candidate(
    effect: str,
    element: str,
    starts: list[dict[str, float]],
    sizes: dict[str, Range],
    amplitudes: tuple[str, ...],
    friction: str | None = None,
    law: str | None = None,
    telling: tuple[str, ...] = (),
    displaced: tuple[str, ...] = (),
) -> VehicleCandidate:
    names = tuple(sizes)
    return VehicleCandidate(
        added=Added(effect, element, key(element, names), law, displaced),
        starts=tuple({f"{element}.{n}": v for n, v in start.items()} for start in starts),
        amplitudes=key(element, amplitudes),
        sizes={f"{element}.{n}": size for n, size in sizes.items()},
        friction=friction,
        telling=key(element, telling or amplitudes),
    )
