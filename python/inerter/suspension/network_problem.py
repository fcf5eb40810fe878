"""The best values of a netlist's elements: what `problem` is for layouts."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inerter.suspension.netlist import Netlist, NetlistError
from inerter.suspension.problem import Array, SuspensionProblem
from inerter.suspension.rational import Rational

MOST = 5
"""Values that can be sought at once."""


@dataclass(frozen=True, kw_only=True)
class NetworkProblem(SuspensionProblem):
    """A `netlist` whose sought elements are free; its layout, stiffness and pair mean nothing.

    Raises
    ------
    NetlistError
        Nothing is sought, too much is, or the index is J5, whose bound needs a layout.
    """

    netlist: Netlist
    layout: str = "S1"
    stiffness: float = 1.0

    def __post_init__(self) -> None:
        """Check what was given, see Raises."""
        if not 1 <= len(self.variables) <= MOST:
            raise NetlistError(
                f"{len(self.variables)} values are sought: write ? for one to {MOST} of them"
            )
        if "J5" in (self.index, *dict(self.limits)):
            raise NetlistError("J5 is of the layouts; take J1, J1w, J3 or travel for a network")

    @property
    def variables(self) -> tuple[str, ...]:
        """Names of the sought elements."""
        return tuple(each.name for each in self.netlist.elements if each.sought)

    @property
    def bounds(self) -> Array:
        """As of the layouts, by kind of element."""
        mass = self.car.sprung_mass + self.car.unsprung_mass
        kt = self.car.tyre_stiffness
        ranges = {
            "damper": (math.sqrt(kt * mass), 1e-3, 1e3),
            "inerter": (mass, 1e-3, 1e6),
            "spring": (kt, 1e-3, 1e5),
        }
        chosen = (ranges[each.kind] for each in self.netlist.elements if each.sought)
        return np.log([[unit * low, unit * high] for unit, low, high in chosen])

    def variants(self) -> list[SuspensionProblem]:
        """The problem alone."""
        return [self]

    def inner(self) -> list[SuspensionProblem]:
        """Nothing is known of what a network contains."""
        return []

    def strut(self, points: NDArray[Any]) -> Rational:
        """Dynamic stiffness of the network of each point."""
        values = dict(zip(self.variables, np.moveaxis(np.exp(points), -1, 0), strict=True))
        return self.netlist.stiffness(values)
