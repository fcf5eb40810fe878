"""Files to raw tables: CSV, Parquet and MATLAB, with errors that say what to do."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import cast

import polars as pl

from .csv_table import read_csv
from .mat_table import read_mat
from .raw_table import RawTable, listed, too_long
from .record import RecordError

EXTENSIONS = (".csv", ".parquet", ".mat")
# of one file: five hours at 1 kHz. Whoever works on a record needs some 1 kB per row
MAX_ROWS = 20_000_000


def read_table(path: Path) -> RawTable:
    """The raw table of a .csv, .parquet or .mat file; RecordError when it cannot be read."""
    readers = {
        ".csv": partial(read_csv, most_rows=MAX_ROWS),
        ".parquet": _read_parquet,
        ".mat": partial(read_mat, most_rows=MAX_ROWS),
    }
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
            f"{path}: there is a header ({listed(table.header)}) but no data below it; "
            "add rows or leave the file out"
        )
    return table


def _read_parquet(path: Path) -> RawTable:
    # pyarrow refuses a damaged file with an exception, where polars may panic
    import pyarrow
    import pyarrow.parquet

    try:
        rows = pyarrow.parquet.read_metadata(path).num_rows
        if rows > MAX_ROWS:
            raise RecordError(too_long(path, rows, MAX_ROWS))
        content = pyarrow.parquet.read_table(path)
        # names that are no text raise here
        names = tuple(content.column_names)
        columns = tuple(cast(pl.Series, pl.from_arrow(column)) for column in content.columns)
    except (FileNotFoundError, RecordError):
        raise
    except (pyarrow.ArrowException, pl.exceptions.PolarsError, OSError, ValueError, TypeError):
        raise RecordError(f"{path}: not a readable Parquet file; write it again") from None
    return RawTable(path=path, header=names, columns=columns)
