"""MATLAB files to raw tables."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl

from .bounds import Wanted, refuse_header, refuse_table
from .header import quantity_of
from .header_rows import RATES, STEPS
from .mat_layout import Variable, refuse_layout, variables
from .raw_table import RawTable, listed
from .record import RecordError

_WIDEST = 64  # columns of a matrix


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
    content, more = _unfolded(content)
    units = more | units
    structs = [fields for value in content.values() if (fields := _fields(value))]
    if not any(_is_vector(value) for value in content.values()) and len(structs) == 1:
        content = structs[0]
        units = _fields(content.pop("units", None)) or units

    vectors = {name: np.ravel(v) for name, v in content.items() if _is_vector(v)}
    for name, matrix in content.items():
        vectors |= _columns_of(name, matrix)
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
    table = RawTable(path=path, header=(*header, *left_out), columns=columns)
    return _on_stated_clock(table, content, length)


def _on_stated_clock(table: RawTable, content: Mapping[str, Any], rows: int) -> RawTable:
    """A table that has no time, with one from the file's interval or rate, where it states one."""
    stated = {name.casefold(): v for name, v in content.items() if np.size(v) == 1}
    if any(quantity_of(name, "time") for name in table.header):
        return table
    for names, inverse in ((STEPS, False), (RATES, True)):
        for name in names:
            value = stated.get(name.casefold())
            if isinstance(value, int | float | np.number) and value > 0:
                step = 1.0 / float(value) if inverse else float(value)
                start = stated.get("tstart", 0.0)
                begin = float(start) if isinstance(start, int | float | np.number) else 0.0
                made = pl.Series("time", begin + step * np.arange(rows))
                header = (*table.header, "time [s]")
                columns = {**table.columns, len(header) - 1: made}
                told = f"a sample every {step:g} s"
                return dataclasses.replace(table, header=header, columns=columns).telling(told)
    return table


def _unfolded(content: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, str]]:
    """Channels that are structs with a name and data, as ControlDesk writes them, and their units.

    `bench.X.Data` and `bench.Y(2).Name`, `.Data`: found in a struct, or in one within it.
    """
    made: dict[str, Any] = dict(content)
    units: dict[str, str] = {}
    for name, value in content.items():
        parts = [value, *_fields(value).values()]
        found = [channel for part in parts for channel in _named_channels(part)]
        if found:
            del made[name]
        for label, data, unit in found:
            made[label] = data
            units |= {label: unit} if unit else {}
    return made, units


def _named_channels(value: Any) -> list[tuple[str, Any, str]]:
    names = getattr(getattr(value, "dtype", None), "names", None) or ()
    if not {"Name", "Data"} <= set(names):
        return []
    found = []
    for each in np.ravel(value):
        label = each["Name"]
        label = label[()] if isinstance(label, np.ndarray) and label.ndim == 0 else label
        unit = each["Unit"] if "Unit" in names else ""
        data = each["Data"]
        data = data[()] if isinstance(data, np.ndarray) and data.dtype == object else data
        if isinstance(label, str) and _is_vector(data):
            # of a path in a model the last part is the name
            found.append((label.rsplit("/", 1)[-1].strip('"'), data, str(unit or "")))
    return found


def _columns_of(name: str, matrix: Any) -> dict[str, Any]:
    """Columns of a matrix that is much longer than wide: `data 1`, `data 2`."""
    if not isinstance(matrix, np.ndarray) or matrix.ndim != 2 or matrix.dtype.kind not in "biuf":
        return {}
    long = matrix if matrix.shape[0] >= matrix.shape[1] else matrix.T
    if long.shape[1] < 2 or long.shape[1] > _WIDEST or long.shape[0] < 10 * long.shape[1]:
        return {}
    return {f"{name} {k + 1}": long[:, k] for k in range(long.shape[1])}


def _content(path: Path, wanted: Wanted) -> tuple[dict[str, Any], list[str]]:
    """The variables that are wanted and whatever may hold some; names of vectors left out."""
    from scipy.io import loadmat

    found = list(variables(path))
    if not found:
        # of the format before version 5, in which nothing is packed
        found = _old_variables(path)
    refuse_header(path, [each.name for each in found])
    left_out = [
        each.name
        for each in found
        if each.is_vector and max(each.shape) == each.rows and not wanted(each.name)
    ]
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
