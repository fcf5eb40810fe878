"""Parquet to raw tables."""

from __future__ import annotations

from pathlib import Path
from typing import Any, cast

import numpy as np
import polars as pl

from .bounds import LONGEST_TEXT, Wanted, refuse_header, refuse_packing, refuse_table
from .decimation import Decimator, told
from .raw_table import RawTable, to_numbers
from .record import RecordError

# what stands at the end of a file about what is in it: pyarrow needs some ten times as much to read
LARGEST_FOOTER = 1 << 24  # bytes
# what it says of where it comes from, as comments above a text's header do
NOTES = "inerter.comments"


def read_parquet(path: Path, wanted: Wanted, by: int = 1) -> RawTable:
    """The wanted columns of the file; those that hold no numbers, times or texts hold nothing.

    Raises
    ------
    RecordError
        It cannot be read, or is larger than is read.
    """
    # pyarrow refuses a damaged file with an exception, where polars may panic
    import pyarrow
    import pyarrow.parquet

    _refuse_footer(path)
    try:
        with pyarrow.parquet.ParquetFile(path) as file:
            rows, names = file.metadata.num_rows, _names(file, path)
            notes = (file.metadata.metadata or {}).get(NOTES.encode(), b"")
            kinds = {i: file.schema_arrow.field(i).type for i, n in enumerate(names) if wanted(n)}
            refuse_table(path, rows / by, len(kinds))
            refuse_packing(path, 8.0 * rows / by * len(kinds))
        # texts as numbers of a list of texts: a column of one long text may be short in a file
        texts = [names[i] for i, kind in kinds.items() if _is_text(kind)]
        with pyarrow.parquet.ParquetFile(path, read_dictionary=texts) as file:
            columns = {
                i: _nothing(rows // by) if not _readable(kind)
                else _column(path, file, names[i]) if by == 1
                else _decimated(path, file, names[i], by)
                for i, kind in kinds.items()
            }  # fmt: skip
    except (FileNotFoundError, RecordError):
        raise
    except (
        pyarrow.ArrowException,
        pl.exceptions.PolarsError,
        OSError,
        ValueError,
        TypeError,
    ):
        raise RecordError(f"{path}: not a readable Parquet file; write it again") from None
    comments = tuple(notes.decode("utf-8", "replace").splitlines())
    return RawTable(
        path=path, header=names, columns=columns, comments=comments, told=told(by), decimated=by
    )


def _refuse_footer(path: Path) -> None:
    with path.open("rb") as file:
        size = file.seek(0, 2)
        file.seek(max(0, size - 8))
        end = file.read(8)
    length = int.from_bytes(end[:4], "little")
    if len(end) == 8 and end[4:] == b"PAR1" and length > LARGEST_FOOTER:
        raise RecordError(
            f"{path}: what describes the file has {length} bytes, at most {LARGEST_FOOTER} are "
            "read; write it again with fewer columns, in larger pieces"
        )


def _names(file: Any, path: Path) -> tuple[str, ...]:
    # the number of columns is asked for first: the names of a million take time
    refuse_header(path, [""] * file.metadata.num_columns)
    names = tuple(file.schema_arrow.names)
    refuse_header(path, names)
    return names


def _readable(kind: Any) -> bool:
    from pyarrow import types

    numbers = types.is_integer(kind) or types.is_floating(kind) or types.is_boolean(kind)
    return numbers or types.is_temporal(kind) or types.is_decimal(kind) or _is_text(kind)


def _is_text(kind: Any) -> bool:
    from pyarrow import types

    if types.is_dictionary(kind):
        return _is_text(kind.value_type)
    return types.is_string(kind) or types.is_large_string(kind)


def _column(path: Path, file: Any, name: str) -> pl.Series:
    column = file.read(columns=[name], use_threads=False).column(0)
    if _is_text(column.type):
        for chunk in column.chunks:
            texts = cast(pl.Series, pl.from_arrow(_texts(chunk)))
            longest = texts.str.len_chars().max() or 0
            if cast(int, longest) > LONGEST_TEXT:
                raise RecordError(
                    f"{path}: column {name[:40]!r} holds a text of {longest} characters, at most "
                    f"{LONGEST_TEXT} are read; give numbers, or names of runs"
                )
        column = column.cast("string")
    return cast(pl.Series, pl.from_arrow(column))


def _decimated(path: Path, file: Any, name: str, by: int) -> pl.Series:
    """Every n-th row behind a low-pass, read a piece at a time."""
    decimator, made = Decimator(by), []
    for batch in file.iter_batches(batch_size=1 << 20, columns=[name], use_threads=False):
        if _is_text(batch.column(0).type):
            raise RecordError(f"{path}: column {name[:40]!r} holds texts, which --decimate cannot")
        values, _ = to_numbers(cast(pl.Series, pl.from_arrow(batch.column(0))))
        made.append(decimator.add(values))
    return pl.Series(name, np.concatenate(made) if made else [])


def _texts(chunk: Any) -> Any:
    return chunk.dictionary if hasattr(chunk, "dictionary") else chunk


def _nothing(rows: int) -> pl.Series:
    return pl.Series([], dtype=pl.Float64).extend_constant(None, rows)
