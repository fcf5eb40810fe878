"""What a fit of a curve along the stroke holds to where the data leave it open.

Nodes at places where few samples are, or where two curves do the same, are known together only:
least squares alone would let them swing against each other. A fit counts the second differences of
neighbouring nodes as well, so little that data on a node outweigh it by far.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.along_stroke import QUANTITIES
from inerter.identify.model import Model

Array = NDArray[np.float64]

# what a second difference of one typical size counts, in rms forces: ten sizes count like a sample
# that is missed by a tenth of the force
_WEIGHT = 0.01


def smoothness(model: Model) -> Array:
    """Second differences, as they count, by the search variables of free nodes, (k, p)."""
    place = {name: i for i, name in enumerate(model.free)}
    rows = []
    for names in _curves(model):
        for three in zip(names, names[1:], names[2:], strict=False):
            if place.keys().isdisjoint(three):
                continue
            row = np.zeros(len(place))
            for name, part in zip(three, (1.0, -2.0, 1.0), strict=True):
                if name in place:
                    row[place[name]] = _WEIGHT * part
            rows.append(row)
    return np.array(rows).reshape(-1, len(place))


def _curves(model: Model) -> Iterator[list[str]]:
    """Names of the nodes of every curve, those that are held at 0 among them."""
    for quantity in QUANTITIES:
        for nodes in (quantity.nodes, quantity.back_nodes):
            yield [name for name in nodes if name in model.values]
