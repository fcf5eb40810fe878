"""Coordinates by name as a vector of search variables, within bounds."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.coordinates import search_range
from inerter.catalogue.scales import Range, Scales

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Variables:
    """Names of some coordinates, and how each of them is searched."""

    names: tuple[str, ...]
    ranges: tuple[Range, ...]

    @classmethod
    def of(cls, names: Iterable[str], sizes: Scales) -> Variables:
        """Coordinates of the catalogue, given the sizes of the data's channels."""
        names = tuple(names)
        return cls(names, tuple(search_range(name, sizes) for name in names))

    @classmethod
    def among(cls, names: Iterable[str], ranges: Mapping[str, Range]) -> Variables:
        """Those of some ranges that have these names."""
        names = tuple(names)
        return cls(names, tuple(ranges[name] for name in names))

    def __len__(self) -> int:
        return len(self.names)

    @cached_property
    def bounds(self) -> tuple[Array, Array]:
        """Lower and upper bounds of the search variables, (p,) each."""
        lower, upper = np.array([each.bounds for each in self.ranges]).reshape(-1, 2).T
        return lower, upper

    def encode(self, values: Mapping[str, float]) -> Array:
        """Coordinates to search variables, (p,)."""
        pairs = zip(self.names, self.ranges, strict=True)
        return np.array([each.encode(values[name]) for name, each in pairs])

    def decode(self, variables: Sequence[float] | Array) -> dict[str, float]:
        """Search variables (p,) to coordinates."""
        point, (sizes, lower, upper) = np.asarray(variables, dtype=float), self._linear
        values = np.clip(point * sizes, lower, upper)
        if (among := self._logarithmic).size:
            low, high = self.bounds
            values[among] = np.exp(np.clip(point[among], low[among], high[among]))
        return dict(zip(self.names, values.tolist(), strict=True))

    @cached_property
    def _linear(self) -> tuple[Array, Array, Array]:
        """Typical sizes, lower and upper bounds of the coordinates, (p,) each."""
        rows = [(each.size, each.lower, each.upper) for each in self.ranges]
        sizes, lower, upper = np.array(rows).reshape(-1, 3).T
        return sizes, lower, upper

    @cached_property
    def _logarithmic(self) -> NDArray[np.intp]:
        """Which of them are searched over their logarithm."""
        return np.flatnonzero([each.logarithmic for each in self.ranges])

    def units(self, values: Mapping[str, float]) -> Array:
        """Coordinate per search variable at some values, (p,)."""
        pairs = zip(self.names, self.ranges, strict=True)
        return np.array([each.unit(values[name]) for name, each in pairs])
