"""One coordinate of a fit: how it is searched, and what it stands for."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.combinations import Values
from inerter.catalogue.scales import Range, Scales

Array = NDArray[np.float64]
OfScales = Callable[[Scales], float]

_INFINITY = math.inf


@dataclass(frozen=True, kw_only=True)
class Coordinate:
    """One coordinate.

    Attributes
    ----------
    name, unit
        As in models and files.
    words
        Words of the device parameters that it stands for, by their names.
    size, lower, upper
        Typical size and bounds, of the sizes of the data.
    logarithmic
        Whether it is searched over its logarithm.
    start, start_unit
        Lowest and highest value at which searches begin, in that unit (1 by default). Starts are
        spread by their logarithm, or evenly where the lowest is negative.
    begin
        Where a trial with it begins that is otherwise none: just off a bound at zero, where the
        trust region would be stuck.
    none
        Value that means that it is not there, or the nearest within its bounds; None where it takes
        another coordinate to say so.
    column
        What it multiplies in the force, of (stretch, velocity, acceleration, elapsed time), where
        it enters linearly.
    also
        Parameters of a device that say the same in another way, and that no fit changes.
    to_parameters
        Puts parameters of a device in its place, where it is none itself.
    of_device
        Reads it off a device.
    belongs_to
        "device"; "channel", what stands between a device's force and the record; "run", how one
        begins.
    nuisance
        Whether it makes up for how a law is smoothed or a run begins, and names no effect.
    jumps
        Whether the force that it brings is not smooth in the motion.
    entangled
        Whether with it the force is no longer the inertance times the acceleration.
    proportional_to
        Coordinate to which it grows in proportion: "level" (of the friction), "inertance".
    """

    name: str
    unit: str
    size: OfScales = lambda s: 1.0
    lower: OfScales = lambda s: -_INFINITY
    upper: OfScales = lambda s: _INFINITY
    words: Mapping[str, str] = field(default_factory=dict)
    logarithmic: bool = False
    start: tuple[float, float] = (0.0, 0.0)
    start_unit: OfScales = lambda s: 1.0
    begin: OfScales = lambda s: 0.0
    none: float | None = 0.0
    column: Callable[[Array, Array, Array, Array], Array] | None = None
    also: tuple[str, ...] = ()
    to_parameters: Callable[[Values], None] | None = None
    of_device: Callable[[Any], float] | None = None
    belongs_to: str = "device"
    nuisance: bool = False
    jumps: bool = False
    entangled: bool = False
    proportional_to: str = ""

    def of(self, device: Any) -> float:
        """Its value of a device, by its rule or as the parameter of its name."""
        return float(self.of_device(device) if self.of_device else getattr(device, self.name))

    def range(self, sizes: Scales) -> Range:
        """How it is searched, given the sizes of the data's channels."""
        upper = self.upper(sizes)
        return Range(self.size(sizes), min(self.lower(sizes), upper), upper, self.logarithmic)

    def neutral(self, sizes: Scales) -> float | None:
        """Where it has no effect, within its bounds; None where it takes another to say so."""
        return None if self.none is None else max(self.none, self.lower(sizes))
