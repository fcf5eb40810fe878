"""Runs with any columns over time, for models that name them themselves (`inerter diagnose`)."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from inerter.printable import text_of
from inerter.unit_text import parse_unit, unit_registry

from .calibration import Statement, applied, column_of, is_there
from .files import record_files
from .quality import check_records
from .raw_table import RawTable, listed
from .read import name_apart, numbers_of
from .record import AnyRecord, Array, RecordError, TimeRecord
from .runs import Part, split_runs
from .stated import stated_of
from .table import read_table
from .units import ACCELERATIONS, QUANTITIES, si_factor, split_header


@dataclass(frozen=True, eq=False, kw_only=True)
class FreeRecord(TimeRecord):
    """One run over time; its columns are in `extra`, SI units, under their own names."""

    kind: ClassVar[str] = "free"
    required: ClassVar[tuple[str, ...]] = ("time",)
    optional: ClassVar[tuple[str, ...]] = ()

    def channels(self) -> dict[str, Array]:
        """The columns without time, by name."""
        return dict(self.extra)


def column_names(paths: Sequence[str | Path]) -> list[str]:
    """Names of the columns of the first file, without units, time and run.

    Raises
    ------
    RecordError
        It cannot be read.
    """
    file = next(file for entry in paths for file in record_files(entry))
    stated = stated_of(file)
    names = _names(read_table(file, _wanted({"time"}, stated.columns), stated), stated.columns)
    return [name for name in names if name not in ("time", "run")]


def read_free_form(
    paths: Sequence[str | Path], columns: Sequence[str], units: Mapping[str, str] | None = None
) -> list[FreeRecord]:
    """Every run of the given files with the named columns, in SI units.

    Parameters
    ----------
    paths : sequence of str or Path
        Files, folders or globs.
    columns : sequence of str
        Names without units, beside `time`.
    units : mapping
        SI unit of the quantity that a column holds, where it is known.

    Raises
    ------
    RecordError
        Anything that cannot be used, one line.
    """
    records: list[Any] = []
    for path in [file for entry in paths for file in record_files(entry)]:
        stated = stated_of(path)
        says = stated.columns
        table = read_table(path, _wanted({"time", "run", *columns}, says), stated)
        at = _names(table, says)
        for name in ("time", *columns):
            if name not in at:
                raise RecordError(
                    f"{path}: no column {name!r} (found: {listed(list(at))}); every run needs it"
                    f"{_how(table, name)}"
                )
        values = {
            name: _si_values(table, at[name], name, says.get(name), (units or {}).get(name, ""))
            for name in ("time", *columns)
        }
        for run, rows in split_runs(table, at.get("run")):
            part = Part(table, run, rows)
            cls: type[AnyRecord] = FreeRecord  # type: ignore[assignment]
            filled, rows, notes = part.complete({n: v[rows] for n, v in values.items()}, cls)
            part.with_rows(rows).check(filled, cls)
            lost = [name for name in columns if name not in filled]
            if lost:
                raise RecordError(f"{path}: column {lost[0]!r} holds no number; record it")
            record = FreeRecord(
                name=text_of(path.stem) + ("" if run is None else f":{run}"),
                source=path,
                time=filled.pop("time"),
                extra=filled,
            )
            for note in notes:
                record = record.warn("missing_samples", note)
            records.append(record)
    # the type of the list is that of what stands in it
    named: list[Any] = list(name_apart(records))
    return check_records(named)


def _wanted(names: set[str], says: Mapping[str, Statement]) -> Callable[[str], bool]:
    """Whether a column has one of some names, or is stated to be a quantity."""
    own = [each for each in says.values() if each.column]
    return lambda header: _name(header) in names or any(is_there(each, (header,)) for each in own)


def _how(table: RawTable, name: str) -> str:
    """How to state which column is meant, of a quantity that has a name of its own."""
    if name not in QUANTITIES or not table.header:
        return ""
    # a logger writes the time first
    likely = table.header[0].strip() if name == "time" else "NAME"
    return f": say which it is, such as --column {name}={likely!r}"


def _names(table: RawTable, says: Mapping[str, Statement]) -> dict[str, int]:
    """Index by name; known names in lower case, others as written without their unit."""
    own = {
        name: column_of(each, table.header, name, table.path)
        for name, each in says.items()
        if each.column
    }
    counted = {name: -1 for name, each in says.items() if each.interval is not None}
    found = own | counted
    for index, header in enumerate(table.header):
        name = _name(header)
        if not name or index in own.values() or name in own or name in counted:
            continue
        if name in found:
            raise RecordError(f"{table.path}: two columns hold {name!r}; keep one of them")
        found[name] = index
    return found


def _si_values(table: RawTable, index: int, name: str, says: Statement | None, unit: str) -> Array:
    """Values of a column in SI units; `unit`: of its quantity, "" where that is not known."""
    if says is not None and says.interval is not None:
        return says.interval * np.arange(table.rows, dtype=np.float64)
    where = f"{table.path}: column {table.header[index].strip()!r}"
    values = numbers_of(table, index)
    if says is not None:
        if says.delay or says.cutoff is not None:
            raise RecordError(
                f"{where}: a delay and a filter of a column are stated of bench records alone; "
                "leave them out, the diagnosis tries a delay and a low-pass of every channel"
            )
        return applied(says, name, values, table.header[index], where)[0]
    return values * _factor(table, index, name, unit)


def _name(header: str) -> str:
    """A column's name without its unit; of those that are known in lower case."""
    name, _ = split_header(header)
    if name in QUANTITIES or name == "run":
        return name
    return re.sub(r"\s*[\[(].*$", "", header.strip().strip("\ufeff\"'").strip())


def _factor(table: RawTable, index: int, name: str, quantity: str) -> float:
    """Factor to SI units (rad for angles); quantity: the one that is wanted, "" for any."""
    _, unit = split_header(table.header[index])
    where = f"{table.path}: column {table.header[index].strip()!r}"
    if name in QUANTITIES:
        return si_factor(name, unit, where)
    if unit is None or unit in ("1", "-"):
        return 1.0
    wrong = RecordError(
        f"{where}: {unit!r} is no unit of what the model's sensor gives, {quantity}; correct the "
        "unit, or map the column to another sensor by --sensor"
    )
    if unit in ACCELERATIONS:
        if quantity not in ("", "m/s^2"):
            raise wrong
        return ACCELERATIONS[unit]
    parsed = parse_unit(unit)
    if parsed is None:
        raise RecordError(f"{where}: unknown unit {unit!r}; write an SI unit, or leave it out")
    wanted = parse_unit(quantity) if quantity else None
    if wanted is not None and wanted.dimensionality != parsed.dimensionality:
        raise wrong
    return float(unit_registry().Quantity(1.0, parsed).to_base_units().magnitude)
