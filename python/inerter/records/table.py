"""Files to raw tables: CSV, Parquet and MATLAB, with errors that say what to do."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any, cast

import numpy as np
import polars as pl

from .csv_table import read_csv, too_long
from .raw_table import RawTable, listed
from .record import RecordError

EXTENSIONS = (".csv", ".parquet", ".mat")
# of one file: five hours at 1 kHz. Whoever works on a record needs some 1 kB per row
MAX_ROWS = 20_000_000


def read_table(path: Path) -> RawTable:
    """The raw table of a .csv, .parquet or .mat file; RecordError when it cannot be read."""
    readers = {
        ".csv": partial(read_csv, most_rows=MAX_ROWS),
        ".parquet": _read_parquet,
        ".mat": _read_mat,
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


# --- Parquet and MATLAB ------------------------------------------------------------------------


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
    return RawTable(path, names, columns)


def _read_mat(path: Path) -> RawTable:
    """Vectors of the file, or the fields of its only struct; a struct `units` may name units."""
    from scipy.io import loadmat, whosmat

    with path.open("rb") as file:
        start = file.read(10)
    if start[:4] == b"\x89HDF" or start == b"MATLAB 7.3":
        raise RecordError(_mat_73(path))
    try:
        longest = max((max(shape) for _, shape, _ in whosmat(path)), default=0)
        if longest > MAX_ROWS:
            raise RecordError(too_long(path, longest, MAX_ROWS))
        content: dict[str, Any] = loadmat(path, squeeze_me=True)
    except NotImplementedError:
        raise RecordError(_mat_73(path)) from None
    except (OSError, RecordError):
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
            f"{path}: no vectors found (variables: {listed(list(content)) or 'none'}); "
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
