"""Files to raw tables, whatever their format, with errors that say what to do."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from pathlib import Path

import polars as pl

from inerter.input_file import refuse_special

from .bounds import BYTES, Wanted, everything, refuse_more
from .decimation import Decimator
from .decimation import told as decimated
from .foreign import foreign
from .isolated import read_isolated
from .mat_table import read_mat
from .one_clock import on_one_clock
from .parquet_table import read_parquet
from .raw_table import RawTable, listed
from .record import RecordError
from .stated import Stated, current
from .text_layout import encoding_of
from .text_table import read_text


def _isolated(kind: str) -> Callable[[Path, Wanted, Stated], RawTable]:
    return lambda path, wanted, stated: read_isolated(kind, path, wanted, stated.sheet)


def _text(path: Path, wanted: Wanted, stated: Stated) -> RawTable:
    return on_one_clock(read_text(path, wanted, stated.asked, current().progress))


def _parquet(path: Path, wanted: Wanted, stated: Stated) -> RawTable:
    return read_parquet(path, wanted, stated.asked.decimate)


def _mat(path: Path, wanted: Wanted, stated: Stated) -> RawTable:
    with path.open("rb") as file:
        start = file.read(10)
    if start[:4] == b"\x89HDF" or start == b"MATLAB 7.3":
        return read_isolated("hdf5", path, wanted, stated.sheet)
    return read_mat(path, wanted)


# what reads a format: the columns that are wanted, the bounds of `bounds` kept before unpacking
READERS: Mapping[str, Callable[[Path, Wanted, Stated], RawTable]] = {
    "text": _text,
    "parquet": _parquet,
    "MATLAB": _mat,
    "Arrow": _isolated("arrow"),
    "Excel": _isolated("excel"),
    "TDMS": _isolated("tdms"),
    "MDF4": _isolated("mdf"),
    "HDF5": _isolated("hdf5"),
}
_TEXT = (".csv", ".txt", ".tsv", ".dat", ".asc", ".lvm", ".tra", ".prn", ".tab", ".log")
_KINDS: Mapping[str, str] = {
    **dict.fromkeys(_TEXT, "text"),
    ".parquet": "parquet",
    ".mat": "MATLAB",
    ".feather": "Arrow", ".arrow": "Arrow", ".ipc": "Arrow",
    ".xlsx": "Excel", ".xlsm": "Excel", ".xls": "Excel", ".ods": "Excel",
    ".tdms": "TDMS",
    ".mf4": "MDF4", ".mdf": "MDF4",
    ".h5": "HDF5", ".hdf5": "HDF5", ".hdf": "HDF5",
}  # fmt: skip
EXTENSIONS = tuple(_KINDS)
# in a folder that is named as a whole, texts of other kinds stand beside records
OF_FOLDERS = tuple(
    suffix for suffix in EXTENSIONS if suffix not in (".txt", ".dat", ".prn", ".tab", ".log")
)

# how a file begins whose format shows itself
_BEGINNINGS: Mapping[bytes, str] = {
    b"PAR1": "parquet",
    b"MATLAB": "MATLAB",
    b"\x89HDF\r\n\x1a\n": "HDF5",
    b"TDSm": "TDMS",
    b"MDF     ": "MDF4",
    b"ARROW1": "Arrow",
    b"PK\x03\x04": "Excel",
    b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1": "Excel",
}


def read_table(path: Path, wanted: Wanted = everything, stated: Stated | None = None) -> RawTable:
    """The raw table of a file; RecordError when it cannot be read.

    Columns that are not wanted are in its header, and nowhere else. What a file holds counts, not
    what it is called.
    """
    kind = _KINDS.get(path.suffix.lower())
    told = ""
    try:
        size = refuse_special(path)
        refuse_more(path, BYTES, size)
        start = _start(path)
        found = _begins(start)
        if (kind is None or found == "Excel" or kind == "text") and (
            told_foreign := foreign(path, start)
        ) is not None:
            raise RecordError(told_foreign)
        if kind == "Excel" and found is None and encoding_of(start) is not None and size:
            # what some programs call a workbook is a text
            found = "text"
        if found is not None and found != kind and not (kind == "MATLAB" and found == "HDF5"):
            told = f"{found} file named {path.suffix or 'without an extension'}"
            kind = found
        if kind is None:
            raise RecordError(
                f"{path}: unknown extension {path.suffix!r}; "
                f"records are {', '.join(EXTENSIONS)} files"
            )
        table = None if size == 0 else READERS[kind](path, wanted, stated or Stated())
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
    if table.decimated == 1 and stated is not None and stated.asked.decimate > 1:
        table = _decimated(table, stated.asked.decimate)
    return table.telling(told)


def _decimated(table: RawTable, by: int) -> RawTable:
    """A table that was read as a whole, of which every n-th row is kept behind a low-pass."""
    columns: dict[int, pl.Series] = {}
    for index, series in table.columns.items():
        values, bad = table.numbers(index)
        if not len(bad):
            columns[index] = pl.Series(series.name, Decimator(by).add(values))
    told = ", ".join(text for text in (table.told, decimated(by)) if text)
    return dataclasses.replace(table, columns=columns, told=told, lines=None, decimated=by)


def _start(path: Path) -> bytes:
    with path.open("rb") as file:
        return file.read(512)


def _begins(start: bytes) -> str | None:
    """The format that the first bytes of a file show."""
    for beginning, kind in _BEGINNINGS.items():
        if start.startswith(beginning):
            return kind
    return None
