"""Files to raw tables: CSV, Parquet and MATLAB, with errors that say which line and what to do."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any, cast

import numpy as np
import polars as pl
from numpy.typing import NDArray

from .record import Array, RecordError

EXTENSIONS = (".csv", ".parquet", ".mat")

# cells that say "no value here"
MISSING_WORDS = ("", "nan", "na", "n/a", "null", "none", "inf", "+inf", "-inf", "#n/a")


@dataclass(frozen=True)
class RawTable:
    """Columns as they stand in one file.

    header: column names as written; columns: one series each (text for CSV); comments: the ``#``
    lines above the header; data: the bytes of a CSV, kept to find line numbers again.
    """

    path: Path
    header: tuple[str, ...]
    columns: tuple[pl.Series, ...]
    comments: tuple[str, ...] = ()
    data: bytes | None = None

    @property
    def rows(self) -> int:
        """Number of data rows."""
        return len(self.columns[0])

    def place(self, row: int) -> str:
        """Where a row (from 0) stands: ``line 17`` of a CSV, ``row 16`` of other files."""
        if self.data is None:
            return f"row {row + 1}"
        for index, (number, _) in enumerate(_data_lines(self.data)):
            if index == row + 1:
                return f"line {number}"
        return f"row {row + 1}"

    def numbers(self, index: int) -> tuple[Array, NDArray[np.intp]]:
        """Values of a column, NaN where missing or infinite, and the rows with no number."""
        series = self.columns[index]
        values = _to_float(series)
        if series.dtype == pl.String and values.null_count():
            # second try: blanks around the number, then the words for "missing"
            text = series.str.strip_chars()
            values = text.cast(pl.Float64, strict=False)
            spared = text.str.to_lowercase().is_in(MISSING_WORDS) | text.is_null()
            bad = np.flatnonzero((values.is_null() & ~spared).to_numpy())
        else:
            bad = np.empty(0, dtype=np.intp)
        array = values.fill_null(np.nan).to_numpy().astype(np.float64)
        array[~np.isfinite(array)] = np.nan
        return array, bad

    def text(self, index: int) -> list[str]:
        """Cells of a column as stripped text; whole numbers lose their ``.0``."""
        return [
            f"{cell:.0f}" if isinstance(cell, float) and cell.is_integer()
            else "" if cell is None or cell != cell
            else str(cell).strip()
            for cell in self.columns[index].to_list()
        ]  # fmt: skip


def read_table(path: Path) -> RawTable:
    """The raw table of a .csv, .parquet or .mat file; RecordError when it cannot be read."""
    readers = {".csv": _read_csv, ".parquet": _read_parquet, ".mat": _read_mat}
    reader = readers.get(path.suffix.lower())
    try:
        size = path.stat().st_size
        if reader is None:
            raise RecordError(
                f"{path}: unknown extension {path.suffix!r}; "
                f"records are {', '.join(EXTENSIONS)} files"
            )
        table = None if size == 0 else reader(path)
    except FileNotFoundError:
        raise RecordError(f"{path}: no such file; check the path") from None
    except OSError as error:
        reason = error.strerror or str(error)
        raise RecordError(f"{path}: cannot be opened ({reason}); check the file") from None
    if table is None:
        raise RecordError(f"{path}: the file is empty; give a file with a header line and data")
    if not table.columns or table.rows == 0:
        raise RecordError(
            f"{path}: there is a header ({_listed(table.header)}) but no data below it; "
            "add rows or leave the file out"
        )
    return table


def _to_float(series: pl.Series) -> pl.Series:
    """Numbers, texts, and durations or dates (in seconds) as Float64; null where impossible."""
    if series.dtype == pl.Duration:
        return series.dt.total_nanoseconds().cast(pl.Float64) * 1e-9
    if isinstance(series.dtype, pl.Datetime):
        return (series - series.drop_nulls().first()).dt.total_nanoseconds() * 1e-9
    if series.dtype == pl.String or series.dtype.is_numeric() or series.dtype == pl.Boolean:
        return series.cast(pl.Float64, strict=False)
    return pl.Series(series.name, [None] * len(series), dtype=pl.Float64)


def _listed(names: tuple[str, ...] | list[str]) -> str:
    """Column names for an error text, at most twelve."""
    shown = ", ".join(name.strip() or "(blank)" for name in names[:12])
    return shown + (", ..." if len(names) > 12 else "")


# --- CSV ---------------------------------------------------------------------------------------


def _read_csv(path: Path) -> RawTable:
    data = _clean_bytes(path)
    comments, first, start = _find_header(path, data)
    number = data.count(b"\n", 0, start) if start else 1
    header = _split_header_line(path, first, number, comments, data[start : start + 4096])

    # what polars gets: no header, no comments, no blank lines
    stop = len(data)
    while stop > start and data[stop - 1] in b" \t\r\n":
        stop -= 1
    body = data[start:stop]
    if b"#" in body:
        body = re.sub(rb"(?m)^[ \t]*#[^\n]*(\n|\Z)", b"", body).rstrip()
    blank = (b"\n\n", b"\n ", b"\n\t")
    if body[:1].isspace() or any(mark in body for mark in blank):
        body = re.sub(rb"(?m)^[ \t]*\n", b"", body)
    rows = body.count(b"\n") + 1 if body else 0
    if rows == 0:
        empty = tuple(pl.Series(name, [], dtype=pl.String) for name in header)
        return RawTable(path, header, empty, comments, data)

    # quoted cells are rare and take the slow reader, which knows blanks around quotes
    if b'"' in body:
        cells = zip(*_split_rows(path, data, len(header)), strict=True)
        texts = [pl.Series(n, c, dtype=pl.String) for n, c in zip(header, cells, strict=True)]
        return RawTable(path, header, tuple(texts), comments, data)

    # count the commas, which is fast; look at single lines only when the count is off
    if body.count(b",") != rows * (len(header) - 1):
        _split_rows(path, data, len(header))
    names = [f"c{index}" for index in range(len(header))]
    try:
        frame = pl.read_csv(BytesIO(body), has_header=False, schema=dict.fromkeys(names, pl.String))
    except pl.exceptions.PolarsError as error:
        # a long row can hide behind a short one in the count
        _split_rows(path, data, len(header))
        reason = str(error).splitlines()[0]
        raise RecordError(f"{path}: not readable as CSV ({reason}); write it again") from None
    return RawTable(path, header, tuple(frame.get_columns()), comments, data)


def _clean_bytes(path: Path) -> bytes:
    """The bytes of a UTF-8 text without BOM; RecordError for anything else."""
    data = path.read_bytes()
    kinds = {b"PAR1": "a Parquet", b"PK\x03\x04": "an Excel or zip", b"MATLAB": "a MATLAB"}
    for magic, kind in kinds.items():
        if data.startswith(magic):
            raise RecordError(
                f"{path}: this is {kind} file named .csv; rename it or export it as CSV"
            )
    if data.startswith((b"\xff\xfe", b"\xfe\xff")) or _looks_utf16(data[:200]):
        raise RecordError(f"{path}: the text is UTF-16; save it as UTF-8 (CSV UTF-8)")
    if re.search(rb"[\x00-\x08\x0e-\x1a\x1c-\x1f]", data[:65536]) or b"\x00" in data:
        raise RecordError(f"{path}: this is a binary file, not CSV; export the record as CSV text")
    data = data.removeprefix(b"\xef\xbb\xbf")
    if not data.isascii():
        try:
            data.decode("utf-8")
        except UnicodeDecodeError as error:
            line = data.count(b"\n", 0, error.start) + 1
            raise RecordError(
                f"{path}: line {line}: byte 0x{data[error.start]:02x} is not UTF-8; "
                "save the file as UTF-8"
            ) from None
    # line ends of any system
    return data.replace(b"\r\n", b"\n").replace(b"\r", b"\n") if b"\r" in data else data


def _looks_utf16(start: bytes) -> bool:
    """Every second byte zero and no other: UTF-16 without a BOM."""
    zeros = sorted((start[::2].count(0), start[1::2].count(0)))
    return len(start) >= 8 and zeros[0] == 0 and zeros[1] >= 0.45 * len(start)


def _find_header(path: Path, data: bytes) -> tuple[tuple[str, ...], str, int]:
    """Leading comments, the header line, and the offset behind it."""
    comments: list[str] = []
    start = 0
    while start < len(data):
        end = data.find(b"\n", start)
        end = len(data) if end < 0 else end
        line = data[start:end].decode("utf-8").strip()
        start = end + 1
        if line.startswith("#"):
            comments.append(line.lstrip("#").strip())
        elif line:
            if start > len(data):
                raise RecordError(
                    f"{path}: only one line ({_quoted(line)}) and no data; "
                    "give a header line and rows below it"
                )
            return tuple(comments), line, start
    raise RecordError(f"{path}: the file is empty (blanks and comments only); add header and data")


def _split_header_line(
    path: Path, line: str, number: int, comments: tuple[str, ...], body: bytes
) -> tuple[str, ...]:
    """Header cells; RecordError for another delimiter or for numbers in place of names."""
    names = {";": "semicolons", "\t": "tabs", "|": "bars"}
    other = max(names, key=line.count)
    if line.count(other) > line.count(","):
        comma = re.search(rb"\d,\d", body) is not None
        also = " and with a point, not a comma, in the numbers" if comma else ""
        raise RecordError(
            f"{path}: line {number}: columns are separated by {names[other]}; "
            f"write them with commas{also}"
        )
    cells = tuple(_cells(path, number, line))
    if len(cells) == 1 and len(line.split()) > 1 and not re.search(r"[\[(]", line):
        raise RecordError(
            f"{path}: line {number}: columns are separated by blanks; write them with commas"
        )
    if all(_is_number(cell) for cell in cells):
        hint = ""
        if comments and len(comments[-1].split(",")) == len(cells):
            hint = f" (the comment above, {_quoted(comments[-1])}, may be it: remove its '#')"
        raise RecordError(
            f"{path}: line {number}: no header, the first line holds numbers ({_quoted(line)}); "
            f"add a line such as time,displacement,force{hint}"
        )
    return cells


def _data_lines(data: bytes) -> Iterator[tuple[int, str]]:
    """Line number and text of the header and of every data line."""
    for number, line in enumerate(data.split(b"\n"), start=1):
        text = line.strip()
        if text and not text.startswith(b"#"):
            yield number, text.decode("utf-8")


def _cells(path: Path, number: int, line: str) -> list[str]:
    """Cells of one line."""
    try:
        return next(csv.reader([line], skipinitialspace=True))
    except csv.Error as error:
        raise RecordError(f"{path}: line {number}: not CSV ({error}); correct the line") from None


def _split_rows(path: Path, data: bytes, width: int) -> list[list[str]]:
    """Cells of every data row; RecordError for the first that has not `width` of them."""
    lines = list(_data_lines(data))
    rows: list[list[str]] = []
    for index, (number, line) in enumerate(lines[1:], start=2):
        cells = _cells(path, number, line)
        if len(cells) == width:
            rows.append(cells)
            continue
        advice = "correct or remove the line"
        if len(cells) > width and all(re.fullmatch(r"\s*[+-]?\d*([eE][+-]?\d+)?\s*", c)
                                      for c in cells):  # fmt: skip
            advice = "numbers with decimal commas? write them with a point, such as 0.5"
        elif index == len(lines) and len(cells) < width:
            advice = "it is the last line, the file may be cut off: remove the line"
        raise RecordError(
            f"{path}: line {number}: {len(cells)} cells where the header has {width} "
            f"({_quoted(line)}); {advice}"
        )
    return rows


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True


def _quoted(text: str) -> str:
    """A piece of the file for an error text, at most 40 characters."""
    return repr(text if len(text) <= 40 else text[:37] + "...")


def explain_cell(table: RawTable, column: int, row: int) -> str:
    """One clause on a cell that should have been a number, and what to do about it."""
    cell = str(table.columns[column][row]).strip()
    firsts = [str(series[row]).strip() for series in table.columns]
    if re.fullmatch(r"[+-]?\d+,\d+([eE][+-]?\d+)?", cell):
        advice = "write numbers with a decimal point, not a comma"
    elif firsts == [name.strip() for name in table.header]:
        advice = "the header stands here again; give runs a 'run' column or a file each"
    elif row == 0 and not any(_is_number(text) for text in firsts):
        name = table.header[column].strip()
        advice = f"units go into the header, such as {name}[{cell}]; remove this line"
    else:
        advice = "write a number, or leave the cell empty where the value is missing"
    return f"{_quoted(cell)} is not a number; {advice}"


# --- Parquet and MATLAB ------------------------------------------------------------------------


def _read_parquet(path: Path) -> RawTable:
    # pyarrow refuses a damaged file with an exception, where polars may panic
    import pyarrow
    import pyarrow.parquet

    try:
        content = pyarrow.parquet.read_table(path)
        # names that are no text raise here
        names = tuple(content.column_names)
        columns = tuple(cast(pl.Series, pl.from_arrow(column)) for column in content.columns)
    except FileNotFoundError:
        raise
    except (pyarrow.ArrowException, pl.exceptions.PolarsError, OSError, ValueError, TypeError):
        raise RecordError(f"{path}: not a readable Parquet file; write it again") from None
    return RawTable(path, names, columns)


def _read_mat(path: Path) -> RawTable:
    """Vectors of the file, or the fields of its only struct; a struct `units` may name units."""
    from scipy.io import loadmat

    if path.read_bytes()[:4] == b"\x89HDF" or path.read_bytes()[:10] == b"MATLAB 7.3":
        raise RecordError(_mat_73(path))
    try:
        content: dict[str, Any] = loadmat(path, squeeze_me=True)
    except NotImplementedError:
        raise RecordError(_mat_73(path)) from None
    except OSError:
        raise
    # loadmat lets struct, zlib, index and many other errors of a broken file through
    except Exception:
        raise RecordError(
            f"{path}: not a readable MATLAB file; save it with save(..., '-v7')"
        ) from None
    content = {name: value for name, value in content.items() if not name.startswith("__")}
    units = _fields(content.pop("units", None))
    structs = [fields for value in content.values() if (fields := _fields(value))]
    if not any(_is_vector(value) for value in content.values()) and len(structs) == 1:
        content = structs[0]
        units = _fields(content.pop("units", None)) or units

    vectors = {name: np.ravel(v) for name, v in content.items() if _is_vector(v)}
    if not vectors:
        raise RecordError(
            f"{path}: no vectors found (variables: {_listed(list(content)) or 'none'}); "
            "save time, displacement and force as numeric vectors, not as a table or timeseries"
        )
    # a vector of another length is left out, unless it is one of the record's own columns
    lengths = [len(v) for v in vectors.values()]
    length = len(vectors["time"]) if "time" in vectors else max(lengths, key=lengths.count)
    own = {"displacement", "force", "velocity", "acceleration", "run", "road"}
    for name, vector in list(vectors.items()):
        if len(vector) == length:
            continue
        if name.casefold() in own:
            raise RecordError(
                f"{path}: {name!r} has {len(vector)} values where others have {length}; "
                "save vectors of one length"
            )
        del vectors[name]
    header = tuple(f"{name}[{units[name]}]" if name in units else name for name in vectors)
    columns = tuple(
        pl.Series(name, v.tolist() if v.dtype.kind in "OU" else v.astype(np.float64), strict=False)
        for name, v in vectors.items()
    )
    return RawTable(path, header, columns)


def _mat_73(path: Path) -> str:
    return (
        f"{path}: a MATLAB v7.3 (HDF5) file, which is not read; "
        "save it with save(..., '-v7') or export CSV"
    )


def _fields(value: Any) -> dict[str, Any]:
    """Fields of a 1x1 MATLAB struct, else nothing."""
    names = getattr(getattr(value, "dtype", None), "names", None)
    if not names or np.size(value) != 1:
        return {}
    struct = np.ravel(value)[0]
    fields = {name: struct[name] for name in names}
    return {n: f[()] if isinstance(f, np.ndarray) else f for n, f in fields.items()}


def _is_vector(value: Any) -> bool:
    """A real numeric vector, or a vector of texts (for `run`), of two or more values."""
    if not isinstance(value, np.ndarray) or value.dtype.names or value.size < 2:
        return False
    if value.ndim != 1 and max(value.shape) != value.size:
        return False
    if value.dtype.kind == "O":
        return all(isinstance(cell, str) for cell in value.ravel())
    return value.dtype.kind in "biufU"
