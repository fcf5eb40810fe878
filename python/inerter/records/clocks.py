"""Times as benches write them: of the day, with a date, or only as a start and an interval."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
import polars as pl

from .header import quantity_of
from .record import Array

if TYPE_CHECKING:
    from .text_layout import Layout

_DAY = 86400.0
_NEAR = 18262.0  # 1 January 2020, in days since 1970

# a date in one of the usual orders, then hours, minutes, perhaps seconds, a fraction, am or pm
_STAMP = (
    r"^\s*(?:(\d{1,4})[-./](\d{1,2})[-./](\d{1,4})[T ]+)?(\d{1,3}):(\d{2})(?::(\d{2}))?"
    r"(?:[.,:](\d+))?\s*([AaPp])?[Mm]?\s*(?:Z|[+-]\d{2}:?\d{2})?\s*$"
)


# a duration with its unit behind it, as MATLAB writes timetables
_WITH_UNIT = r"^\s*([+-]?\d+(?:\.\d*)?(?:[eE][+-]?\d+)?)\s*(ms|s|sec|min|hr)\s*$"
_OF_UNIT = {"ms": 1e-3, "s": 1.0, "sec": 1.0, "min": 60.0, "hr": 3600.0}


def clock_seconds(column: pl.Series) -> Array | None:
    """Seconds of times of day, from one midnight on where dates are given, or of durations.

    None where a cell is neither a time nor empty. Of hh:mm, mm:ss.fff is meant where there is a
    fraction. A time of day without a date goes back at midnight: see `without_day_breaks`.
    """
    if column.dtype != pl.String or not len(column):
        return None
    empty = column.is_null() | (column.str.strip_chars() == "")
    spans = column.str.extract_groups(_WITH_UNIT).struct.unnest()
    if bool((spans["2"].is_not_null() | empty).all()):
        factor = spans["2"].replace_strict(_OF_UNIT, return_dtype=pl.Float64)
        return (spans["1"].cast(pl.Float64) * factor).to_numpy()
    parts = column.str.extract_groups(_STAMP)
    names = [f"g{i}" for i in range(1, 9)]
    frame = parts.struct.rename_fields(names).struct.unnest()
    if not bool((frame["g5"].is_not_null() | empty).all()):
        return None
    first, minute = (frame[name].cast(pl.Float64) for name in ("g4", "g5"))
    second = frame["g6"].cast(pl.Float64)
    fraction = ("0." + frame["g7"].fill_null("0")).cast(pl.Float64)
    # two parts and a fraction: minutes and seconds
    short = second.is_null() & frame["g7"].is_not_null()
    whole = (3600.0 * first + 60.0 * minute + second.fill_null(0.0)).to_numpy().copy()
    pair = (60.0 * first + minute).to_numpy()
    whole = np.where(short.to_numpy(), pair, whole)
    half = frame["g8"].str.to_lowercase()
    hour = first.to_numpy()
    whole = whole + np.where((half == "p").fill_null(False).to_numpy() & (hour < 12), 43200.0, 0.0)
    whole = whole - np.where((half == "a").fill_null(False).to_numpy() & (hour == 12), 43200.0, 0.0)
    days = _days(frame)
    return whole + fraction.to_numpy() + (0.0 if days is None else _DAY * days)


def _days(frame: pl.DataFrame) -> Array | None:
    """Day numbers; None where there are no dates. Of 3/4/2020 the order does not matter here:

    a record of several days goes on at midnight, which is all that its days tell.
    """
    if frame["g1"].null_count():
        return None
    text = frame["g1"] + "-" + frame["g2"] + "-" + frame["g3"]
    if frame["g1"].str.len_chars().min() == 4:
        days = text.str.to_date("%Y-%m-%d", strict=False)
        if not days.null_count():
            # from a near day on, so that the fraction keeps its digits
            return days.cast(pl.Int32).cast(pl.Float64).to_numpy() - _NEAR
    return np.concatenate([[0.0], np.cumsum(text[1:].to_numpy() != text[:-1].to_numpy())])


def without_day_breaks(seconds: Array) -> Array:
    """Seconds since midnight of the first day; a jump back by half a day is a new day."""
    seconds = seconds - _DAY * np.floor(seconds[0] / _DAY) if np.isfinite(seconds[0]) else seconds
    back = np.diff(seconds) < -0.5 * _DAY
    if not back.any():
        return seconds
    return seconds + _DAY * np.concatenate([[0.0], np.cumsum(back)])


def counted(
    header: tuple[str, ...], columns: Mapping[int, pl.Series], rows: int, layout: Layout
) -> tuple[tuple[str, ...], dict[int, pl.Series]]:
    """A time column of a stated start and interval, where no column is a time."""
    if layout.interval is None or any(quantity_of(name, "time") for name in header):
        return header, dict(columns)
    time = (layout.start or 0.0) + layout.interval * np.arange(rows)
    return (*header, "time [s]"), {**columns, len(header): pl.Series("time", time)}
