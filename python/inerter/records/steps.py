"""The steps in which a converter wrote a channel down."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

MOST_LEVELS = 200_000


def converter_step(values: NDArray[np.floating]) -> float | None:
    """The smallest step of a channel (n,), where nearly all values are multiples of it apart."""
    some = np.unique(values[:MOST_LEVELS])
    steps = np.diff(some)
    size = float(np.ptp(values))
    steps = steps[steps > 1e-9 * size] if size else steps[:0]
    if len(steps) < 3:
        return None
    # cells of a text are rounded, so that steps differ in their last digits
    step = float(np.quantile(steps, 0.02))
    step = float(np.median(steps[steps < 1.5 * step]))
    whole = np.abs(steps / step - np.round(steps / step))
    distinct = len(some) < 0.5 * min(len(values), MOST_LEVELS)
    return step if distinct and np.quantile(whole, 0.9) < 0.1 else None
