"""The columns of one file as they stand in it, before anybody knows what they mean."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import polars as pl
from numpy.typing import NDArray

from .record import Array

# cells that say "no value here"
MISSING_WORDS = (
    "", "nan", "na", "n/a", "null", "none", "inf", "+inf", "-inf", "#n/a", "#nv", "#n/d",
)  # fmt: skip
# what a spreadsheet writes where a formula has no value, in any language: #DIV/0!, #WERT!, #NAME?
SPREADSHEET_ERROR = r"^#[^\s#]+[!?]$"


@dataclass(frozen=True)
class OddCell:
    """The first cell of a column that is no number: its row (from 0), and the texts of that row."""

    row: int
    cells: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class RawTable:
    """Columns as they stand in one file.

    header: column names as written; columns: by index, a series for each that was wanted; comments:
    the lines above the header; told: how it was read; decimated: of how many rows one was kept.

    Of a text file alone: separator; odd: by column, what is no number in it; lines: number and text
    of the header and of every data line, read anew. Without `lines` an error names a row.
    """

    path: Path
    header: tuple[str, ...]
    columns: Mapping[int, pl.Series]
    comments: tuple[str, ...] = ()
    told: str = ""
    separator: str = ","
    odd: Mapping[int, OddCell] = field(default_factory=dict)
    lines: Callable[[], Iterator[tuple[int, str]]] | None = None
    decimated: int = 1

    def telling(self, text: str) -> RawTable:
        """The same table, of which something more is told first."""
        told = "; ".join(part for part in (text, self.told) if part)
        return dataclasses.replace(self, told=told) if text else self

    @property
    def rows(self) -> int:
        """Number of data rows; 0 where no column was wanted."""
        return len(next(iter(self.columns.values()), ()))

    def place(self, row: int) -> str:
        """Where a row (from 0) stands: ``line 17`` of a CSV, ``row 16`` of other files."""
        # a file may be gone by now
        with suppress(OSError):
            for index, (number, _) in enumerate(self.lines() if self.lines else ()):
                if index == row + 1:
                    return f"line {number}"
        return f"row {row + 1}"

    def numbers(self, index: int) -> tuple[Array, NDArray[np.intp]]:
        """Values of a column, NaN where missing or infinite, and rows with no number.

        Of a text file only the first such row is told.
        """
        values, bad = to_numbers(self.columns[index])
        if index in self.odd:
            bad = np.array([self.odd[index].row])
        return values, bad

    def text(self, index: int) -> list[str]:
        """Cells of a column as stripped text; whole numbers lose their ``.0``."""
        return [
            f"{cell:.0f}" if isinstance(cell, float) and cell.is_integer()
            else "" if cell is None or cell != cell
            else str(cell).strip()
            for cell in self.columns[index].to_list()
        ]  # fmt: skip

    def row_texts(self, column: int, row: int) -> tuple[str, ...]:
        """The stripped cells of a row in which a column has no number."""
        if column in self.odd:
            return self.odd[column].cells
        columns = [self.columns.get(index) for index in range(len(self.header))]
        return tuple("" if series is None else str(series[row]).strip() for series in columns)


def to_numbers(series: pl.Series) -> tuple[Array, NDArray[np.intp]]:
    """Values of a series, NaN where missing or infinite, and the rows with no number."""
    values, bad = _to_float(series), np.empty(0, dtype=np.intp)
    if series.dtype == pl.String and values.null_count():
        # second try: blanks around the number or behind its sign, then the words for "missing"
        text = series.str.strip_chars().str.replace(r"^([+-]) +", "$1")
        values = text.cast(pl.Float64, strict=False)
        spared = text.str.to_lowercase().is_in(MISSING_WORDS) | text.is_null()
        spared |= text.str.contains(SPREADSHEET_ERROR)
        bad = np.flatnonzero((values.is_null() & ~spared).to_numpy())
    array = (values.fill_null(np.nan) if values.null_count() else values).to_numpy()
    finite = np.isfinite(array)
    # long records are many: no copy where none is needed
    return array if finite.all() else np.where(finite, array, np.nan), bad


def _to_float(series: pl.Series) -> pl.Series:
    """Numbers, texts, and durations or dates (in seconds) as Float64; null where impossible.

    Of a date the time of day counts, beyond midnight from the first day in the file on, so that
    files of one day share a clock.
    """
    if series.dtype == pl.Duration:
        return series.dt.total_nanoseconds().cast(pl.Float64) * 1e-9
    if isinstance(series.dtype, pl.Datetime):
        first = series.drop_nulls().head(1).dt.truncate("1d")
        midnight = first if len(first) else series
        return (series - midnight).dt.total_nanoseconds() * 1e-9
    if series.dtype == pl.String or series.dtype.is_numeric() or series.dtype == pl.Boolean:
        return series.cast(pl.Float64, strict=False)
    return pl.Series(series.name, [None] * len(series), dtype=pl.Float64)


def explain_cell(table: RawTable, column: int, row: int) -> str:
    """One clause on a cell that should have been a number, and what to do about it."""
    cells = table.row_texts(column, row)
    cell = cells[column]
    if re.fullmatch(r"[+-]?\d+,\d+([eE][+-]?\d+)?", cell) and table.separator != ",":
        advice = "other numbers have a decimal point: write this one so, too"
    elif re.fullmatch(r"[+-]?\d+,\d+([eE][+-]?\d+)?", cell):
        advice = "write numbers with a decimal point, not a comma"
    elif list(cells) == [name.strip() for name in table.header]:
        advice = "the header stands here again; give runs a 'run' column or a file each"
    elif row == 0 and not any(is_number(text) for text in cells):
        name = table.header[column].strip()
        advice = f"units go into the header, such as {name}[{cell}]; remove this line"
    else:
        advice = "write a number, or leave the cell empty where the value is missing"
    return f"{quoted(cell)} is not a number; {advice}"


def is_number(cell: str) -> bool:
    """Whether a text is one number."""
    try:
        float(cell)
    except ValueError:
        return False
    return True


def quoted(text: str) -> str:
    """A piece of the file for an error text, at most 40 characters."""
    return repr(text if len(text) <= 40 else text[:37] + "...")


def listed(names: tuple[str, ...] | list[str]) -> str:
    """Column names for an error text, at most twelve."""
    shown = ", ".join(name.strip() or "(blank)" for name in names[:12])
    return shown + (", ..." if len(names) > 12 else "")
