"""Derivatives that follow a search, in the place of some that take long."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# share of the change of a residual by a step that secants have to foretell; at 0.5, and where fits
# to be followed ended without true derivatives, a search on a measured rack took 2.5 times as many
# predictions
_FORETOLD = 0.7


class Secants:
    """A Jacobian that follows a search from point to point by what the residual did (Broyden 1965).

    It is worked out anew where too little of a step was foretold: the columns that bend most first,
    where there are such, and all of them where that is not enough, but in a rough search.

    Parameters
    ----------
    residual, jacobian
        Of a point (p,): residual (n,) and derivatives (n, p).
    enough
        Relative fall of the cost below which a step is the last one, and its derivatives are not
        asked for.
    rough
        Whether a search may end without true derivatives.
    first
        Derivatives (n, p) that are near those at the first point, if there are such.
    bending
        Of a point (p,): numbers of the columns that bend most (m,), and these (n, m).
    """

    def __init__(
        self,
        residual: Callable[[Array], Array],
        jacobian: Callable[[Array], Array],
        enough: float = 0.0,
        rough: bool = False,
        first: Array | None = None,
        bending: Callable[[Array], tuple[Sequence[int], Array]] | None = None,
    ) -> None:
        self._residual, self._jacobian, self._enough, self.rough = residual, jacobian, enough, rough
        self._known: tuple[Array, Array, Array] | None = None
        self._first, self._bending = first, bending
        self._was_poor = False
        self.stale = False

    def forget(self) -> None:
        """Be worked out anew at the next point."""
        self._known = None

    def __call__(self, point: Array) -> Array:
        """Derivatives at a point, (n, p)."""
        here = self._residual(point)
        if self._known is None:
            found, self._first = self._first, None
        else:
            found = self._followed(point, here, *self._known)
        self.stale = found is not None
        if found is None:
            found = self._jacobian(point)
        self._known = point.copy(), here, found
        return found

    def _followed(
        self, point: Array, here: Array, last: Array, was: Array, old: Array
    ) -> Array | None:
        step, change = point - last, here - was
        length, before = float(step @ step), float(was @ was)
        if not length or before - float(here @ here) < self._enough * before:
            return old
        miss = change - old @ step
        is_poor = not np.linalg.norm(miss) < (1 - _FORETOLD) * np.linalg.norm(change)
        if is_poor and (self._bending is None or (self._was_poor and not self.rough)):
            self._was_poor = False
            return None
        found = old + np.outer(miss / length, step)
        if is_poor and self._bending:
            which, columns = self._bending(point)
            found[:, which] = columns
        self._was_poor = is_poor
        return found
