"""MATLAB files to raw tables."""

from __future__ import annotations

import math
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl

from .raw_table import RawTable, listed, too_long
from .record import RecordError

# matrices within matrices; scipy reads them by recursion, in which a stack has an end
DEEPEST = 100
LARGEST = 1 << 30  # bytes of a struct or cell

# numbers of a MAT-file 5: types of elements, classes of matrices that hold others
_MATRIX, _COMPRESSED = 14, 15
_HOLDERS = (1, 2, 3, 17)  # cell, struct, object, opaque


def read_mat(path: Path, most_rows: int) -> RawTable:
    """Vectors of the file, or the fields of its only struct; a struct `units` may name units.

    Raises
    ------
    RecordError
        It cannot be read, or has too many rows.
    """
    from scipy.io import loadmat, whosmat

    with path.open("rb") as file:
        start = file.read(10)
    if start[:4] == b"\x89HDF" or start == b"MATLAB 7.3":
        raise RecordError(_mat_73(path))
    try:
        if _depth(path) > DEEPEST:
            raise RecordError(
                f"{path}: cells within cells, more than {DEEPEST} deep; save numeric vectors"
            )
        longest = max((math.prod(shape) for _, shape, _ in whosmat(path)), default=0)
        if longest > most_rows:
            raise RecordError(too_long(path, longest, most_rows))
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
    return RawTable(path=path, header=header, columns=columns)


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


# --- how deep ----------------------------------------------------------------------------------


def _depth(path: Path) -> int:
    """How deep matrices stand within matrices, by the tags of the file; 0 for other formats."""
    with path.open("rb") as file:
        head = file.read(128)
        order = {b"IM": "little", b"MI": "big"}.get(head[126:128])
        if order is None:
            return 0
        deepest = 0
        while len(tag := file.read(8)) == 8:
            kind, size = _tag(tag, order)
            if kind == _COMPRESSED:
                # the class of the matrix stands near its beginning
                packed = file.read(size)
                start = zlib.decompressobj().decompress(packed, 64)
                if len(start) > 16 and start[16 if order == "little" else 19] in _HOLDERS:
                    unpacking = zlib.decompressobj()
                    data = unpacking.decompress(packed, LARGEST)
                    if unpacking.unconsumed_tail:
                        raise RecordError(
                            f"{path}: a struct or cell of more than 1 GB; save numeric vectors"
                        )
                    deepest = max(deepest, _nesting(data, order))
            elif kind == _MATRIX:
                deepest = max(deepest, _nesting(tag + file.read(size), order))
            else:
                break
    return deepest


def _tag(data: bytes, order: Any) -> tuple[int, int]:
    return int.from_bytes(data[:4], order), int.from_bytes(data[4:8], order)


def _nesting(data: bytes, order: Any) -> int:
    """How deep the matrices in one element stand."""
    ends: list[int] = []
    place = deepest = 0
    while place + 8 <= len(data):
        kind, size = _tag(data[place : place + 8], order)
        if kind == _MATRIX:
            ends.append(place + 8 + size)
            deepest = max(deepest, len(ends))
            place += 8
        elif kind > 0xFFFF:
            # a small element: its data stand in the tag
            place += 8
        else:
            place += 8 + size + -size % 8
        while ends and place >= ends[-1]:
            ends.pop()
    return deepest
