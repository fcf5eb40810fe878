"""MATLAB files to raw tables."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import polars as pl

from .bounds import Wanted, refuse_header, refuse_table
from .mat_layout import Variable, refuse_layout, variables
from .raw_table import RawTable, listed
from .record import RecordError


def read_mat(path: Path, wanted: Wanted) -> RawTable:
    """Vectors of the file, or the fields of its only struct; a struct `units` may name units.

    Raises
    ------
    RecordError
        It cannot be read, or is larger than is read.
    """
    with path.open("rb") as file:
        start = file.read(10)
    if start[:4] == b"\x89HDF" or start == b"MATLAB 7.3":
        raise RecordError(_mat_73(path))
    try:
        content, left_out = _content(path, wanted)
    except NotImplementedError:
        raise RecordError(_mat_73(path)) from None
    except (OSError, RecordError, MemoryError):
        raise
    # loadmat lets struct, zlib, index and many other errors of a broken file through
    except Exception:
        raise RecordError(
            f"{path}: not a readable MATLAB file; save it with save(..., '-v7')"
        ) from None
    units = _fields(content.pop("units", None))
    structs = [fields for value in content.values() if (fields := _fields(value))]
    if not any(_is_vector(value) for value in content.values()) and len(structs) == 1:
        content = structs[0]
        units = _fields(content.pop("units", None)) or units

    vectors = {name: np.ravel(v) for name, v in content.items() if _is_vector(v)}
    if not vectors and not left_out:
        raise RecordError(
            f"{path}: no vectors found (variables: {listed(list(content)) or 'none'}); "
            "save time, displacement and force as numeric vectors, not as a table or timeseries"
        )
    # a vector of another length is left out, unless it is one of the record's own columns
    lengths = [len(v) for v in vectors.values()] or [0]
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
    refuse_header(path, header)
    refuse_table(path, length, sum(map(wanted, header)))
    columns = {
        index: pl.Series(
            name, v.tolist() if v.dtype.kind in "OU" else v.astype(np.float64), strict=False
        )
        for index, (name, v) in enumerate(vectors.items())
        if wanted(header[index])
    }
    return RawTable(path=path, header=(*header, *left_out), columns=columns)


def _content(path: Path, wanted: Wanted) -> tuple[dict[str, Any], list[str]]:
    """The variables that are wanted and whatever may hold some; names of vectors left out."""
    from scipy.io import loadmat

    found = list(variables(path))
    if not found:
        # of the format before version 5, in which nothing is packed
        found = _old_variables(path)
    refuse_header(path, [each.name for each in found])
    left_out = [each.name for each in found if each.is_vector and not wanted(each.name)]
    needed = [each for each in found if each.name not in left_out]
    longest = max((each.rows for each in needed), default=0)
    refuse_table(path, longest, max(1, sum(each.is_vector for each in needed)))
    refuse_layout(path, needed)
    content = loadmat(path, squeeze_me=True, variable_names=[each.name for each in needed])
    return {n: value for n, value in content.items() if not n.startswith("__")}, left_out


def _old_variables(path: Path) -> list[Variable]:
    from scipy.io import whosmat

    return [Variable(name, tuple(shape), kind == "double") for name, shape, kind in whosmat(path)]


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
