"""A channel on the times of another one."""

from __future__ import annotations

from typing import Any

import numpy as np


def on_times(values: Any, own: Any, times: Any) -> Any:
    """Values (n,) known at times `own` (n,), at `times` (m,): a cubic spline, NaN outside.

    Straight lines where the own times do not advance, or are too few.
    """
    length = min(len(own), len(values))
    own, values = own[:length], values[:length]
    known = np.isfinite(own) & np.isfinite(values)
    own, values = own[known], values[known]
    if len(own) < 4 or not np.all(np.diff(own) > 0):
        return (
            np.interp(times, own, values, left=np.nan, right=np.nan)
            if len(own)
            else np.full(len(times), np.nan)
        )
    from scipy.interpolate import make_interp_spline

    inside = (times >= own[0]) & (times <= own[-1])
    spline = make_interp_spline(own, values, k=3)
    return np.where(inside, spline(np.where(inside, times, own[0])), np.nan)
