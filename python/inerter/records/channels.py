"""Channels brought onto each other's terms: delays taken out, one filter over all.

A channel that went through a low-pass is late and smooth where the others are not. The others are
passed through the same filter: linear laws then hold between them as before.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from scipy.interpolate import make_interp_spline
from scipy.signal import butter, sosfilt, sosfilt_zi

from .calibration import Statement
from .motion import uniform_channels
from .record import Array, RecordError
from .runs import MIN_SAMPLES, Part, Rows


def corrected(
    columns: dict[str, Array], rows: Rows, stated: Mapping[str, Statement], part: Part
) -> tuple[dict[str, Array], Rows, list[str]]:
    """Columns of a run with stated delays and filters dealt with, the rows left, what was done.

    Raises
    ------
    RecordError
        The clock is too uneven for a filter, or too little is left.
    """
    notes: list[str] = []
    late = {n: s.delay for n, s in stated.items() if s.delay and n in columns and n != "time"}
    if late:
        columns, rows = _without_delays(columns, rows, late, part)
        notes += [f"{n} taken {1e3 * d:g} ms earlier, as stated" for n, d in late.items()]
    filters = {
        n: (s.cutoff, s.order)
        for n, s in stated.items()
        if s.cutoff is not None and n in columns and n != "time"
    }
    if filters:
        columns = _alike(columns, filters, part)
        notes += [
            f"{n} was low-passed at {cutoff:g} Hz (order {order}), and now the others are, too"
            for n, (cutoff, order) in filters.items()
        ]
    return columns, rows, notes


def _without_delays(
    columns: dict[str, Array], rows: Rows, late: Mapping[str, float], part: Part
) -> tuple[dict[str, Array], Rows]:
    time = columns["time"]
    keep = np.ones(time.size, dtype=bool)
    moved = dict(columns)
    for name, delay in late.items():
        at = time + delay
        inside = (at >= time[0]) & (at <= time[-1])
        keep &= inside
        spline = make_interp_spline(time, columns[name], k=3)
        moved[name] = np.where(inside, spline(np.where(inside, at, time)), np.nan)
    if keep.sum() < MIN_SAMPLES:
        raise part.refuse(
            f"with its delays taken out {int(keep.sum())} samples are left, {MIN_SAMPLES} are "
            "needed; correct the delay"
        )
    return {n: v[keep] for n, v in moved.items()}, rows[keep]


def _alike(
    columns: dict[str, Array], filters: Mapping[str, tuple[float | None, int]], part: Part
) -> dict[str, Array]:
    time = columns["time"]
    channels = {n: v for n, v in columns.items() if n != "time"}
    spacing, even = uniform_channels(time, channels)
    if len(next(iter(even.values()))) != time.size or (
        even is not channels and any(even[n] is not channels[n] for n in channels)
    ):
        raise part.refuse("a stated filter needs an even clock; resample the record first")
    made = dict(columns)
    for owner, (cutoff, order) in filters.items():
        rate = 1.0 / spacing
        if cutoff is None or cutoff >= 0.5 * rate:
            raise RecordError(
                f"{part.table.path}: the filter of {owner} is stated as {cutoff:g} Hz, and there "
                f"are {rate:g} samples per second; stay below half of that"
            )
        sections = butter(order, cutoff, fs=rate, output="sos")
        rest = sosfilt_zi(sections)
        for name in channels:
            if filters.get(name) != (cutoff, order):
                values = made[name]
                made[name] = sosfilt(sections, values, zi=rest * values[0])[0]
    return made
