"""Arrays that are worked out once: all while they do not take too much memory, or the last one."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Sequence
from typing import Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

Result = TypeVar("Result")
Array = NDArray[np.float64]
Number = TypeVar("Number", np.float64, np.complex128)


def last_kept(function: Callable[[Array], Result]) -> Callable[[Array], Result]:
    """A function of a point (p,) that at the point where it was asked last is not worked out."""
    known: dict[bytes, Result] = {}

    def kept(point: Array) -> Result:
        key = point.tobytes()
        if key not in known:
            found = function(point)
            known.clear()
            known[key] = found
        return known[key]

    return kept


class Kept(Generic[Number]):
    """Arrays that are worked out once, as long as they do not take too much memory."""

    def __init__(self, most: int) -> None:
        self.most, self.size = most, 0
        self.arrays: dict[Hashable, NDArray[Number]] = {}

    def found(self, key: Hashable, work_out: Callable[[], NDArray[Number]]) -> NDArray[Number]:
        """The array of a key."""
        known = self.arrays.get(key)
        return self._keep(key, work_out()) if known is None else known

    def all_found(
        self, keys: Sequence[Hashable], work_out: Callable[[list[int]], Iterable[NDArray[Number]]]
    ) -> NDArray[Number]:
        """The arrays of keys, one below another; those that are missing are worked out at once."""
        known = [self.arrays.get(key) for key in keys]
        missing = [i for i, each in enumerate(known) if each is None]
        for i, array in zip(missing, work_out(missing) if missing else (), strict=True):
            known[i] = self._keep(keys[i], array)
        return np.array(known)

    def _keep(self, key: Hashable, array: NDArray[Number]) -> NDArray[Number]:
        if self.size > self.most:
            self.arrays.clear()
            self.size = 0
        self.arrays[key] = array
        self.size += array.nbytes
        return array
