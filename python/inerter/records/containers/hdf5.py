"""HDF5 files, MATLAB's v7.3 among them, by h5py. Links to other files are not followed."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from inerter.records.bounds import COLUMNS, refuse_more
from inerter.records.header_rows import RATES, STEPS
from inerter.records.record import RecordError

from .channels import Channel, with_unit

DEEPEST = 20  # groups within groups
# filters that HDF5 brings or h5py does; another one would load a library that is named in a file
_FILTERS = (1, 2, 3, 4, 5, 6, 32000)
_UNITS = ("unit", "units", "Unit", "Units", "UNIT", "unit_string")
_WIDEST = 64  # columns of a matrix


def channels(path: Path, sheet: str | None) -> list[Channel]:
    """Vectors of a file, columns of its matrices, fields of its compounds.

    Raises
    ------
    RecordError
        Data that lie in other files, or that a filter of others has packed.
    """
    import h5py

    del sheet
    # the file stays open: channels are loaded when they are chosen
    file = h5py.File(path, "r")
    units = _matlab_units(file)
    found: list[Channel] = []
    for group, name, data in _datasets(h5py, path, file, "", 0, set()):
        clock = _clock(data, data.parent)
        unit = next((data.attrs[key] for key in _UNITS if key in data.attrs), units.get(name))
        for part, rows, load in _parts(name, data):
            found.append(
                Channel(
                    name=with_unit(part, unit if part == name else None), rows=rows, group=group,
                    load=load, clock=clock,
                )
            )  # fmt: skip
        refuse_more(path, COLUMNS, len(found))
    return found


def _datasets(
    h5py: Any, path: Path, group: Any, place: str, depth: int, seen: set[int]
) -> Iterator[tuple[str, str, Any]]:
    if depth > DEEPEST:
        raise RecordError(f"{path}: groups within groups, more than {DEEPEST} deep; save vectors")
    refuse_more(path, COLUMNS, len(group))
    for name in group:
        # of MATLAB and pandas: what their own objects refer to
        if name in ("#refs#", "#subsystem#", "units"):
            continue
        if not isinstance(group.get(name, getlink=True), h5py.HardLink):
            continue
        item = group.get(name)
        address = h5py.h5o.get_info(item.id).addr
        if address in seen:
            continue
        seen.add(address)
        if isinstance(item, h5py.Group):
            yield from _datasets(h5py, path, item, f"{place}/{name}".strip("/"), depth + 1, seen)
        elif isinstance(item, h5py.Dataset):
            _refuse_elsewhere(path, name, item)
            yield place, name, item


def _refuse_elsewhere(path: Path, name: str, data: Any) -> None:
    if data.external or data.is_virtual:
        raise RecordError(
            f"{path}: the data of {name[:40]!r} lie in another file, which is not opened; save "
            "them in this one"
        )
    plan = data.id.get_create_plist()
    for index in range(plan.get_nfilters()):
        if plan.get_filter(index)[0] not in _FILTERS:
            raise RecordError(
                f"{path}: {name[:40]!r} is packed by a filter that HDF5 does not bring; save it "
                "with gzip, or not packed"
            )


def _parts(name: str, data: Any) -> Iterator[tuple[str, int, Any]]:
    """Name, length and loader of each column of a data set."""
    if data.dtype.names and data.ndim == 1:
        for field in data.dtype.names[:_WIDEST]:
            kind = data.dtype[field]
            if kind.subdtype is not None and len(kind.shape) == 1 and kind.shape[0] <= _WIDEST:
                for k in range(kind.shape[0]):
                    yield f"{field} {k + 1}", data.shape[0], _block(data, field, k)
            elif kind.kind in "biuf":
                yield field, data.shape[0], _field(data, field)
        return
    if data.dtype.kind not in "biuf" or data.attrs.get("MATLAB_class") == b"char":
        return
    if data.ndim == 1 or (data.ndim == 2 and 1 in data.shape):
        if data.size > 1:
            yield name, data.size, _whole(data)
    elif data.ndim == 2:
        # MATLAB turns matrices round; the long side is the time
        long = 0 if data.shape[0] >= data.shape[1] else 1
        if data.shape[1 - long] <= _WIDEST:
            names = _column_names(data, data.shape[1 - long])
            for k in range(data.shape[1 - long]):
                yield (
                    names[k] if names else f"{name} {k + 1}",
                    data.shape[long],
                    _column(data, long, k),
                )


def _column_names(data: Any, count: int) -> list[str] | None:
    """Names of a matrix's columns, where an attribute gives as many."""
    for key in ("columns", "names", "channels", "column_names", "labels"):
        given = data.attrs.get(key)
        if given is not None and getattr(given, "shape", None) == (count,):
            return [n.decode("utf-8", "replace") if isinstance(n, bytes) else str(n) for n in given]
    return None


def _whole(data: Any) -> Any:
    return lambda: data[()].ravel()


def _field(data: Any, field: str) -> Any:
    return lambda: data[field]


def _block(data: Any, field: str, column: int) -> Any:
    return lambda: data[field][:, column]


def _column(data: Any, long: int, column: int) -> Any:
    return lambda: data[:, column] if long == 0 else data[column, :]


def _clock(data: Any, group: Any) -> tuple[float, float] | None:
    for attributes in (data.attrs, group.attrs, group.file.attrs):
        for keys, inverse in ((STEPS, False), (RATES, True)):
            for key in keys:
                if key not in attributes:
                    continue
                try:
                    value = float(attributes[key])
                except (TypeError, ValueError):
                    continue
                if value > 0:
                    return 0.0, 1.0 / value if inverse else value
    return None


def _matlab_units(file: Any) -> dict[str, str]:
    """Of a MATLAB file's struct `units`: texts by name."""
    group = file.get("units")
    if group is None or not hasattr(group, "keys"):
        return {}
    found = {}
    for name in group:
        data = group.get(name)
        if getattr(data, "dtype", None) is not None and data.dtype.kind == "u" and data.size < 40:
            found[name] = "".join(map(chr, data[()].ravel().tolist()))
    return found
