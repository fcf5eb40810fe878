"""Texts that write a time beside each channel: all channels on the first of these clocks."""

from __future__ import annotations

import dataclasses
import re

import numpy as np
import polars as pl

from .interpolate import on_times
from .raw_table import RawTable


def on_one_clock(table: RawTable) -> RawTable:
    """The table without its further times; channels on another clock are interpolated."""
    times = [i for i, name in enumerate(table.header) if re.fullmatch(r"time \d+ \[s\]", name)]
    first = next((i for i, name in enumerate(table.header) if name == "time [s]"), None)
    if first is None or not times or first not in table.columns:
        return table
    time = table.numbers(first)[0]
    columns, header = dict(table.columns), list(table.header)
    moved = []
    for index in times:
        header[index] = ""
        own = table.numbers(index)[0] if index in columns else time
        columns.pop(index, None)
        both = np.isfinite(own) & np.isfinite(time)
        step = float(np.median(np.diff(time[both]))) if both.sum() > 2 else 0.0
        if np.all(np.abs(own[both] - time[both]) <= 1e-3 * abs(step)) or index + 1 not in columns:
            continue
        values, bad = table.numbers(index + 1)
        known = np.isfinite(own) & np.isfinite(values)
        if len(bad) or known.sum() < 2 or not np.all(np.diff(own[known]) > 0):
            continue
        made = on_times(values[known], own[known], time)
        columns[index + 1] = pl.Series(header[index + 1], made)
        moved.append(header[index + 1])
    told = f"{', '.join(moved)} brought to the clock of the first channel" if moved else ""
    made_table = dataclasses.replace(table, header=tuple(header), columns=columns)
    parts = [part for part in (table.told, told) if part]
    return dataclasses.replace(made_table, told="; ".join(parts))
