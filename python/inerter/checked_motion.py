"""A sampled motion as the core wants it."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray


def checked_motion(h: float, x: ArrayLike, v: ArrayLike, a: ArrayLike) -> list[NDArray[np.float64]]:
    """x, v, a as arrays in one piece.

    Raises
    ------
    ValueError
        Channels of different lengths, a number that is not finite, a spacing that is not > 0.
    """
    if not 0 < h < np.inf:
        raise ValueError(f"h is {h} s; give a finite sample spacing > 0 s")
    arrays = [np.ascontiguousarray(channel, dtype=float) for channel in (x, v, a)]
    shape = arrays[0].shape
    if len(shape) != 1 or any(array.shape != shape for array in arrays):
        shapes = ", ".join(str(array.shape) for array in arrays)
        raise ValueError(f"x, v, a must be arrays of one length; their shapes are {shapes}")
    with np.errstate(over="ignore", invalid="ignore"):
        sums = [array.sum() for array in arrays]
    for name, array, total in zip("xva", arrays, sums, strict=True):
        # of finite numbers too, a sum may overflow
        if not np.isfinite(total) and not np.isfinite(array).all():
            i = int(np.argmin(np.isfinite(array)))
            raise ValueError(f"{name} is {array[i]} at sample {i}; give finite numbers")
    return arrays
