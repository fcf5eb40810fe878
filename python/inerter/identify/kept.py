"""Arrays that are worked out once, and kept while they do not take too much memory."""

from __future__ import annotations

from collections.abc import Callable, Hashable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Kept:
    """Arrays that are worked out once, as long as they do not take too much memory."""

    def __init__(self, most: int) -> None:
        self.most, self.size = most, 0
        self.arrays: dict[Hashable, Array] = {}

    def found(self, key: Hashable, work_out: Callable[[], Array]) -> Array:
        """The array of a key."""
        known = self.arrays.get(key)
        if known is None:
            if self.size > self.most:
                self.arrays.clear()
                self.size = 0
            known = self.arrays[key] = work_out()
            self.size += known.nbytes
        return known
