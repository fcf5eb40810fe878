"""A user's model with what a diagnosis changes in it, as numbers by name.

A coordinate is "ELEMENT.NAME": of a device ("strut.coulomb_force", see `catalogue.coordinates`), or
of a part of the vehicle ("road.tyre_damping", "sprung.body_mass").
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType

from inerter.catalogue.coordinates import NUISANCES
from inerter.catalogue.effects import EFFECTS

_FORMED = ("sensor_filter", "sensor_compliance")
BENT = EFFECTS["digressive_damping"].name
TYRES = "tyres"
"""Element of what all tyres have in common."""


@dataclass(frozen=True)
class Added:
    """One effect in a model: its contract name, the element it is in, its coordinates.

    law: of hysteretic friction, else None. displaced: coordinates of other elements that it says
    in their place, which are none beside it.
    """

    effect: str
    element: str
    coordinates: tuple[str, ...]
    law: str | None = None
    displaced: tuple[str, ...] = ()

    def is_friction_in(self, element: str) -> bool:
        """Whether this is the friction law of a device."""
        return self.element == element and self.effect in FRICTION

    def replaces(self, other: Added) -> bool:
        """Whether another effect is part of this one."""
        if self.displaced and {*other.coordinates} <= {*self.displaced}:
            return True
        if self.element != other.element:
            return False
        friction = self.effect in FRICTION and other.effect in FRICTION
        pair = self.effect, other.effect
        return friction or pair == ("backlash", "series_elasticity") or pair == (BENT, BENT)


# effects that say which friction law a device has
FRICTION = tuple(name for name, effect in EFFECTS.items() if effect.kind == "law")


@dataclass(frozen=True)
class VehicleModel:
    """Coordinates that differ from the user's model, which of them are free, and why.

    Attributes
    ----------
    values : mapping
        By "ELEMENT.NAME", SI units; what is not here is as the user states it.
    friction : mapping
        Friction law by device, where it is another than stated.
    free : tuple of str
        Coordinates that a fit may change.
    effects : tuple of Added
        What has been added to the user's model.
    """

    values: Mapping[str, float] = field(default_factory=dict)
    friction: Mapping[str, str] = field(default_factory=dict)
    free: tuple[str, ...] = ()
    effects: tuple[Added, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "values", MappingProxyType(dict(self.values)))
        object.__setattr__(self, "friction", MappingProxyType(dict(self.friction)))

    def __hash__(self) -> int:
        return hash((tuple(self.values.items()), tuple(self.friction.items()), self.effects))

    @property
    def complexity(self) -> int:
        """Number of free coordinates that say something; the width of sign(v) says nothing.

        An element of a channel counts one more: its form was chosen, too. A delay is plainer.
        """
        formed = sum(added.effect in _FORMED for added in self.effects)
        return formed + sum(name.rpartition(".")[2] not in NUISANCES for name in self.free)

    def at(self, values: Mapping[str, float]) -> VehicleModel:
        """The model with other values."""
        return replace(self, values={**self.values, **values})

    def adding(
        self, added: Added, values: Mapping[str, float], friction: str | None = None
    ) -> VehicleModel:
        """The model with one more effect; its coordinates are free."""
        laws = {**self.friction, added.element: friction} if friction else self.friction
        gone = added.displaced
        old = tuple(n for n in self.free if n not in gone)
        names = tuple(n for n in added.coordinates if n not in old)

        # friction laws replace one another, a gap has the series element in it; the rest adds up
        kept = [e for e in self.effects if not added.replaces(e)]
        values = {**self.values, **values, **dict.fromkeys(gone, 0.0)}
        # a bend that is drawn more sharply stays where it was: what came after it needs it
        same = [(e.effect, e.element) == (BENT, added.element) for e in self.effects]
        first = same.index(True) if added.effect == BENT and any(same) else len(same)
        place = sum(not added.replaces(e) for e in self.effects[:first])
        return VehicleModel(values, laws, old + names, (*kept[:place], added, *kept[place:]))

    def without(self, index: int) -> VehicleModel:
        """The model without one of its effects, the others at their values.

        What the effect stood in the place of is again as the user states it.
        """
        gone = self.effects[index]
        rest = tuple(added for i, added in enumerate(self.effects) if i != index)
        kept = {name for added in rest for name in added.coordinates}
        lost = {*gone.coordinates, *gone.displaced} - kept
        friction = dict(self.friction)
        values = {k: v for k, v in self.values.items() if k not in lost}
        if gone.is_friction_in(gone.element):
            friction.pop(gone.element, None)
            values.pop(f"{gone.element}.transition_velocity", None)
        if gone.effect == "gas_spring":
            values.pop(f"{gone.element}.gas_area", None)
        free = tuple(name for name in self.free if name not in lost)
        return VehicleModel(values, friction, free, rest)

    def bends(self, device: str) -> bool:
        """Whether a device's damping has been given a bend."""
        return f"{device}.damping_knee" in self.values

    def of(self, element: str) -> dict[str, float]:
        """Coordinates of one element, without its name."""
        prefix = element + "."
        return {k.removeprefix(prefix): v for k, v in self.values.items() if k.startswith(prefix)}


def key(element: str, names: Sequence[str]) -> tuple[str, ...]:
    """Names of coordinates with their element."""
    return tuple(f"{element}.{name}" for name in names)
