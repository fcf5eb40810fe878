"""What a residual is linear in, solved for at every point of a search over the other coordinates.

Variable projection: a curve along the stroke has dozens of nodes, and where the force is in
proportion to each of them no search over them is needed. What they cannot take of a residual is
what is left beside an orthonormal basis of their columns, whatever the nodes are.

Source: Golub and Pereyra (1973), The differentiation of pseudo-inverses and nonlinear least squares
problems whose variables separate; without the part of the derivatives that comes of columns which
move (Kaufman 1975), for here they do not.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import svd

from inerter.catalogue.coordinates import search_range
from inerter.catalogue.scales import Scales
from inerter.identify.model import Model

Array = NDArray[np.float64]

# singular values below this share of the largest are none
_NONE = 1e-10


@dataclass(frozen=True, kw_only=True)
class Basis:
    """Columns (n, q) of coordinates, and their singular value decomposition.

    Their rows are the masked samples and what is counted of second differences (`smoothness`).
    """

    columns: Array
    left: Array
    inverse: Array

    @classmethod
    def of(cls, columns: Array) -> Basis:
        """Of columns (n, q)."""
        left, values, right = svd(columns, full_matrices=False)
        kept = values > _NONE * values[0]
        return cls(
            columns=columns, left=left[:, kept], inverse=right[kept].T / values[kept]
        )  # fmt: skip

    def rest(self, values: Array) -> Array:
        """What the columns cannot take of values in their rows, (n,) or (n, k)."""
        # a prediction that runs away leaves nothing that is finite, which a search steps back from
        with np.errstate(invalid="ignore", over="ignore"):
            return values - self.left @ (self.left.T @ values)


@dataclass(frozen=True)
class Apart:
    """Coordinates of a model that its residual is linear in.

    Attributes
    ----------
    names
        The coordinates, in the order of the basis.
    basis
        What one of each adds to the residual, but for a factor.
    of_inertance
        Whether this factor is the model's inertance.
    """

    names: Sequence[str]
    basis: Basis
    of_inertance: Sequence[bool]

    def rest(self, values: Array) -> Array:
        """What the coordinates cannot take of values in the basis' rows, (n,) or (n, k)."""
        return self.basis.rest(values)

    def columns(self, model: Model, sizes: Scales) -> Array:
        """Derivatives of what counts by the search variables, (n, q)."""
        units = np.array([search_range(name, sizes).size for name in self.names])
        return self.basis.columns * (units * self._factors(model))

    def solved(self, model: Model, residual: Array, sizes: Scales) -> Model | None:
        """The model with the coordinates that leave least of what counts of it (n,).

        None where one of them is beyond its bounds.
        """
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            change = -self.basis.inverse @ (self.basis.left.T @ residual) / self._factors(model)
        values = {}
        for name, more in zip(self.names, change, strict=True):
            bounds, value = search_range(name, sizes), model.values[name] + float(more)
            if not bounds.lower <= value <= bounds.upper:
                return None
            values[name] = value
        return replace(model, values={**model.values, **values})

    def _factors(self, model: Model) -> Array:
        inertance = model.values.get("inertance", 1.0)
        return np.where(self.of_inertance, inertance, 1.0)
