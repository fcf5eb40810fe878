"""A device and its force channel as coordinates, some of them free for a fit."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from types import MappingProxyType

from inerter.catalogue.coordinates import BENDS, JUMPS, NUISANCES, device_values
from inerter.catalogue.friction import FRICTION
from inerter.core import Device, DeviceError, lists, parameters
from inerter.identify.channel import clips
from inerter.records.motion import Shaft

_Stated = float | str | tuple[float, ...]


@dataclass(frozen=True)
class Part:
    """Some of what a device is made of, by name, and the device of that alone."""

    stated: tuple[tuple[str, _Stated], ...]

    @cached_property
    def device(self) -> Device:
        """Made when it is first asked for."""
        return Device(**dict(self.stated))


# a fit moves one coordinate after another, and most parts stay as they are
@functools.lru_cache(maxsize=64)
def _part_of(stated: tuple[tuple[str, _Stated], ...]) -> Part:
    return Part(stated)


@dataclass(frozen=True)
class Model:
    """A device and a channel delay as coordinates, and which of them are free.

    Attributes
    ----------
    friction : str
        Friction law.
    values : mapping
        Coordinates by name (see `coordinates`), SI units.
    free : tuple of str
        Names that a fit may change.
    texts : mapping
        What a device states in words beside the friction law, such as gas_law.
    """

    friction: str
    values: Mapping[str, float]
    free: tuple[str, ...]
    texts: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        object.__setattr__(self, "values", MappingProxyType(dict(self.values)))

    def __reduce__(self) -> tuple[type[Model], tuple[object, ...]]:
        """What another process is told: no view of a mapping, nothing worked out."""
        return Model, (self.friction, dict(self.values), self.free, dict(self.texts))

    def device(self) -> Device:
        """The device these coordinates stand for."""
        return self._device

    @cached_property
    def is_possible(self) -> bool:
        """Whether there is a device that these coordinates stand for."""
        try:
            return self._device is not None
        except DeviceError:
            return False

    def stated(self) -> dict[str, float | str]:
        """What a file of the device has to state: no width of sign(v) where nothing reads it."""
        given = dict(self._device.given)
        if self.friction == "none" and not self._device.has_load_friction:
            for unread in ("transition_velocity", "friction_side"):
                given.pop(unread, None)
        return given

    # worked out once, for all runs
    @cached_property
    def _device(self) -> Device:
        return Device(friction=self.friction, **self._stated)

    @cached_property
    def _stated(self) -> dict[str, _Stated]:
        """What the device is made of beside its friction law."""
        return _with_ends({**self.texts, **device_values(self.values)})

    @cached_property
    def smooth_part(self) -> Part:
        """The device's terms that are linear in the motion: no friction, no stops, no play.

        What bends or changes along the stroke is none of them: it is quicker than the motion, and
        the low-pass of the measured force takes some of that away.
        """
        known, rough = parameters(), {*JUMPS, *BENDS, "gas_law", *lists()}
        if "damping_exponent" in self.values:
            # a slope at rest that may be many times what the motion meets
            rough.add("viscous")
        if {"clutch_force", "leak_quadratic_damping"} & self._stated.keys():
            # how fast the flywheel turns at first would set it swinging on a spring that holds
            rough |= _BEFORE_FLYWHEEL
        return self._part(lambda n: n not in rough and not (n in known and known[n].laws))

    @cached_property
    def friction_part(self) -> Part:
        """The device's friction law between the terminals alone."""
        return self._part(lambda name: name in _OF_FRICTION, friction=self.friction)

    @cached_property
    def abrupt_parts(self) -> tuple[tuple[Part, Part], ...]:
        """What is quicker than the motion beside friction: parts, each with what of it is smooth.

        Springs, stops and forces of the place; dampers; the inertance with all that stands with it.
        Their forces add up.
        """
        smooth = dict(self.smooth_part.stated)
        named = {name for name in self._stated if name not in _OF_FRICTION or name in _OF_PLACES}
        groups = (_OF_SPRINGS, _OF_DAMPERS, named - _OF_SPRINGS - _OF_DAMPERS)
        found = []
        for group in groups:
            own = {name: self._stated[name] for name in named & (group | _OF_PLACES)}
            less = {name: smooth[name] for name in smooth if name in own}
            # what is neither 0 nor where something is
            rough = own.keys() - less.keys() - _OF_PLACES
            if any(own[name] for name in rough):
                found.append((_part_of(_items(own)), _part_of(_items(less))))
        return tuple(found)

    def _part(self, has: Callable[[str], bool], **also: str) -> Part:
        kept = {name: value for name, value in self._stated.items() if has(name)}
        return _part_of((*also.items(), *_items(kept)))

    @cached_property
    def has_jumps(self) -> bool:
        """Whether something beside friction makes the force jump, or bend with the motion."""
        device = self._device
        along = any(n in lists() and not n.startswith("friction") for n in self._stated)
        jumps = bool(device.backlash or device.clutch_force or device.stop_stiffness)
        return clips(self.values) or along or jumps or self._bends or self.rubs_behind

    @cached_property
    def rubs_behind(self) -> bool:
        """Whether friction acts on a flywheel behind a series element, and sets it swinging."""
        device = self._device
        behind = device.friction_side != "terminals" and self.has_series
        return bool(behind and (self.friction != "none" or device.has_load_friction))

    @cached_property
    def _bends(self) -> bool:
        return any(self._stated.get(name, 0.0) for name in BENDS)

    @property
    def shape(self) -> tuple[str, frozenset[str]]:
        """What a fit decides, whatever the values."""
        return self.friction, frozenset(self.free)

    @property
    def delay(self) -> float:
        """Time by which the force channel is late [s]."""
        return self.values.get("delay", 0.0)

    @property
    def shaft(self) -> Shaft | None:
        """Resonance [Hz] and damping ratio of the inertance on its series element, if any."""
        device = self.device()
        inertance, stiffness = device.inertance, device.series_stiffness
        if not (inertance > 0 and stiffness > 0):
            return None
        critical = 2 * math.sqrt(stiffness * inertance)
        damping = device.series_damping + device.flywheel_viscous
        return stiffness / (math.pi * critical), damping / critical

    @property
    def has_series(self) -> bool:
        """Whether there is a series element."""
        return not _SERIES.isdisjoint(self.values)

    @property
    def complexity(self) -> int:
        """Number of free coordinates that say something about the device."""
        return sum(name not in NUISANCES for name in self.free)

    def adding(self, friction: str | None = None, **values: float) -> Model:
        """The model with further free coordinates, under another friction law if given."""
        law = friction or self.friction
        names = tuple(name for name in values if name not in self.free)
        return Model(law, {**self.values, **values}, _useful(self.free + names, law), self.texts)

    def holding(self, **values: float) -> Model:
        """The model with further coordinates that a fit leaves as they are."""
        return Model(self.friction, {**self.values, **values}, self.free, self.texts)

    def without(self, names: Sequence[str], friction: str | None = None) -> Model:
        """The model without some coordinates, and what goes with them.

        Where nothing gives any more, a mass before what gave is inertance, and damping of the
        flywheel is between the terminals. Without a damper no spring stands before it.
        """
        if "viscous" in names:
            names = (*names, "damper_stiffness")
        law, rigid = friction or self.friction, _SERIES.isdisjoint(self.values.keys() - set(names))
        if rigid:
            names = (*names, "grip_mass")
        free = tuple(name for name in self.free if name not in names)
        values = {name: value for name, value in self.values.items() if name not in names}
        left = Model(law, values, _useful(free, law), self.texts)
        return left.damped_at("viscous") if rigid and BEHIND in left.free else left

    def damped_at(self, place: str) -> Model:
        """The model with all viscous damping at one place: "viscous" (terminals), or `BEHIND`."""
        other = BEHIND if place == "viscous" else "viscous"
        more = {place: self.values[other] + self.values.get(place, 0.0)}
        values = {name: value for name, value in self.values.items() if name != other} | more
        free = tuple(dict.fromkeys(place if name == other else name for name in self.free))
        return replace(self, values=values, free=free)


BEHIND = "flywheel_viscous"
"""Damping of the flywheel, behind a shaft."""
# what says where a device is along its stroke
_OF_PLACES = {"rest_length", "curve_lower", "curve_upper"}
_SERIES = {
    "series_frequency", "series_stiffness", "series_damping",
    "leak_corner", "leak_damping", "leak_quadratic_damping",
}  # fmt: skip
_BEFORE_FLYWHEEL = {
    "series_stiffness", "series_damping", "series_hardening", "leak_damping", "clutch_asymmetry",
}  # fmt: skip
# forces of the place alone, and what damps between the terminals
_OF_SPRINGS = frozenset({
    "stiffness_cubic", "force_curve", "force_periods", "force_map",
    *(name for name in parameters() if name.startswith(("stop_", "force_map_"))),
})  # fmt: skip
_OF_DAMPERS = frozenset({
    "viscous", "quadratic_damping", "viscous_curve", "viscous_periods", "damper_stiffness",
    *(name for name in parameters() if name.startswith("damping_")),
})  # fmt: skip
_OF_FRICTION = {
    *(name for name, known in parameters().items() if known.laws),
    *(name for name, known in lists().items() if known.laws),
    *_OF_PLACES,
    "transition_velocity",
}


def stated_values(device: Device) -> tuple[dict[str, float], dict[str, str]]:
    """What a device states in numbers, and in words beside its friction law.

    Raises
    ------
    DeviceError
        The inertance comes from a channel: a fit has to be able to change it.
    """
    if device.inertance and "piston_area" in device.given and "inertance" not in device.given:
        raise DeviceError(
            f"inertance follows from piston_area {device.piston_area:g} m^2 and the channel; a "
            f"diagnosis varies it: state inertance = {device.inertance:g} in their place"
        )
    given = {name: value for name, value in device.given.items() if name != "friction"}
    words = {name: value for name, value in given.items() if isinstance(value, str)}
    return {name: float(value) for name, value in given.items() if name not in words}, words


def _with_ends(values: Mapping[str, _Stated]) -> dict[str, _Stated]:
    """What a device is made of, with the ends of its curves where it has one."""
    ends = () if any(name.endswith("_curve") for name in values) else ("curve_lower", "curve_upper")
    return {name: value for name, value in values.items() if name not in ends}


def _items(values: Mapping[str, _Stated]) -> tuple[tuple[str, _Stated], ...]:
    return tuple(_with_ends(values).items())


def _useful(free: tuple[str, ...], friction: str) -> tuple[str, ...]:
    # a law that reads the width of sign(v) has no bristle that begins in a play; that of the load
    # reads it where there is no other
    alone = friction == "none" and "load_friction" in free
    unread = "friction_place" if FRICTION[friction].smoothed or alone else "transition_velocity"
    return tuple(name for name in free if name != unread)
