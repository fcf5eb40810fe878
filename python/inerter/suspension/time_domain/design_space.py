"""What a search is free to choose, and designs run together although one may fail."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from inerter.suspension.time_domain.design import Design
from inerter.suspension.time_domain.linear import SMALLEST_INERTANCE

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Space:
    """What is free of a design: logarithms of c, and of b where there is an inerter, per strut."""

    start: Design
    layout: str

    @property
    def origin(self) -> Array:
        struts = self.start.struts
        if self.layout == "S1":
            return np.log([strut.damping for strut in struts])
        each = [(s.damping, max(s.inertance, SMALLEST_INERTANCE)) for s in struts]
        return np.log(np.ravel(each))

    def values(self, points: Array) -> Array:
        """Values of c and b, shape (designs, struts, 2)."""
        each = np.exp(points).reshape(len(points), len(self.start.struts), -1)
        if each.shape[2] == 1:
            each = np.concatenate([each, np.zeros_like(each)], axis=2)
        return each

    def design(self, point: Array) -> Design:
        (values,) = self.values(point[None])
        struts = [
            replace(strut, damping=float(c), inertance=float(b))
            for strut, (c, b) in zip(self.start.struts, values, strict=True)
        ]
        return replace(struts[0], rear=struts[1] if len(struts) == 2 else None)


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
