"""Files to raw tables: CSV, Parquet and MATLAB, with errors that say what to do."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

from inerter.input_file import refuse_special

from .bounds import BYTES, Wanted, everything, refuse_more
from .csv_table import read_csv
from .mat_table import read_mat
from .parquet_table import read_parquet
from .raw_table import RawTable, listed
from .record import RecordError

# what reads a format: the columns that are wanted, the bounds of `bounds` kept before unpacking
READERS: Mapping[str, Callable[[Path, Wanted], RawTable]] = {
    ".csv": read_csv,
    ".parquet": read_parquet,
    ".mat": read_mat,
}
EXTENSIONS = tuple(READERS)


def read_table(path: Path, wanted: Wanted = everything) -> RawTable:
    """The raw table of a .csv, .parquet or .mat file; RecordError when it cannot be read.

    Columns that are not wanted are in its header, and nowhere else.
    """
    reader = READERS.get(path.suffix.lower())
    try:
        size = refuse_special(path)
        if reader is None:
            raise RecordError(
                f"{path}: unknown extension {path.suffix!r}; "
                f"records are {', '.join(EXTENSIONS)} files"
            )
        refuse_more(path, BYTES, size)
        table = None if size == 0 else reader(path, wanted)
    except FileNotFoundError:
        raise RecordError(f"{path}: no such file; check the path") from None
    except OSError as error:
        reason = error.strerror or str(error)
        raise RecordError(f"{path}: cannot be opened ({reason}); check the file") from None
    except MemoryError:
        raise RecordError(
            f"{path}: the memory does not suffice for it; give a part of it, or leave out columns"
        ) from None
    if table is None:
        raise RecordError(f"{path}: the file is empty; give a file with a header line and data")
    if not table.header or (table.columns and table.rows == 0):
        raise RecordError(
            f"{path}: there is a header ({listed(table.header)}) but no data below it; "
            "add rows or leave the file out"
        )
    return table
