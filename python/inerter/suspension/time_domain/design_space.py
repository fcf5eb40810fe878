"""What a search is free to choose, and designs run together although one may fail."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from inerter.suspension.layouts import LAYOUTS
from inerter.suspension.time_domain.design import Design, both
from inerter.suspension.time_domain.linear import SMALLEST_INERTANCE

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Space:
    """What is free of a design: logarithms of c, and of b where there is an inerter, per strut.

    Inner springs stay those of the start.

    `held`: "damping" or "inertance" that stay as they are at the start.
    """

    start: Design
    layout: str
    held: tuple[str, ...] = ()

    @property
    def _free(self) -> list[int]:
        names = ("damping", "inertance")[: 1 + LAYOUTS[self.layout].has_inerter]
        return [n for n, name in enumerate(names) if name not in self.held]

    @property
    def origin(self) -> Array:
        struts = self.start.struts
        each = np.array([(s.damping, max(s.inertance, SMALLEST_INERTANCE)) for s in struts])
        return np.log(each[:, self._free].ravel())

    def values(self, points: Array) -> Array:
        """Values of c and b, shape (designs, struts, 2)."""
        own = [(s.damping, s.inertance) for s in self.start.struts]
        each = np.tile(np.array(own), (len(points), 1, 1))
        each[:, :, self._free] = np.exp(points).reshape(len(points), len(own), -1)
        return each

    def design(self, point: Array) -> Design:
        (values,) = self.values(point[None])
        struts = [
            replace(strut, damping=float(c), inertance=float(b))
            for strut, (c, b) in zip(self.start.struts, values, strict=True)
        ]
        return both([replace(strut, rear=None) for strut in struts])


def each_or_one_by_one(
    run: Callable[[list[Design]], Array], designs: list[Design], width: int
) -> Array:
    """All at once; if one of them cannot be simulated, one by one. Infinite where it cannot."""
    try:
        return run(designs)
    except ValueError:
        shape = () if width == 1 else (width,)
        rows = []
        for design in designs:
            try:
                rows.append(run([design])[0])
            except ValueError:
                rows.append(np.full(shape, np.inf))
        return np.array(rows)
