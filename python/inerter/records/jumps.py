"""`outliers` of another kind: a displacement that jumps within a sample, and stays.

A laser that loses its target holds its last value and leaps after it; a cable slips, a zero is set
anew. A device moves steadily: its acceleration there would be a thousandfold.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

from inerter.motion_units import words

from .even_clock import even_spacing
from .record import Array, Record

# a step differs from those about it by so many times what such differences are by, and by this
# share of the travel; samples about a step that are looked at
_TIMES, _SHARE, _ABOUT = 30.0, 5e-3, 11
# share of the samples above which it is how this record is
_MANY = 0.01


def find_displacement_jumps(record: Record) -> Record:
    """The record, with a warning where its displacement jumps."""
    rows = jump_rows(record.displacement)
    if not rows.size or not even_spacing(record.time):
        return record
    sizes = np.abs(np.diff(record.displacement)[rows])
    worst = int(np.argmax(sizes))
    metre = words(record.motion, "m")
    places = "1 place" if rows.size == 1 else f"{rows.size} places"
    text = (
        f"'displacement' jumps at {places}, such as by {sizes[worst]:.3g} {metre} within a sample "
        f"at t = {record.time[rows[worst] + 1]:.6g} s: a sensor that loses its target, or its "
        "zero; what is read as acceleration there is none of the device. Cut the record there"
    )
    return record.warn("outliers", text)


def jump_rows(values: Array) -> NDArray[np.intp]:
    """Samples before a jump; none of a spike, which comes back at once."""
    step = np.diff(values)
    if step.size < 5 * _ABOUT:
        return np.empty(0, dtype=np.intp)
    apart = step - median_filter(step, _ABOUT, mode="nearest")
    # of a converter's steps most are none, and the smallest is one
    usual = np.maximum(1.4826 * np.median(np.abs(apart)), _quantum(step))
    far = np.abs(apart) > max(_TIMES * usual, _SHARE * float(np.ptp(values)))
    rows = np.flatnonzero(far)
    back = [
        bool(np.any(np.abs(apart[i] + apart[max(i - 3, 0) : i + 4]) < 0.3 * abs(apart[i])))
        for i in rows
    ]
    rows = rows[~np.array(back, dtype=bool)] if rows.size else rows
    return rows if rows.size <= _MANY * step.size else rows[:0]


def _quantum(step: Array) -> float:
    """The smallest step that is none of 0: one of the converter, or next to nothing."""
    moved = np.abs(step[step != 0.0])
    return float(moved.min()) if moved.size else 0.0
