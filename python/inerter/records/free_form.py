"""Runs with any columns over time, for models that name them themselves (`inerter diagnose`)."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

from inerter.printable import text_of
from inerter.unit_text import parse_unit, unit_registry

from .files import record_files
from .quality import check_records
from .raw_table import RawTable, listed
from .read import name_apart, numbers_of
from .record import AnyRecord, Array, RecordError, TimeRecord
from .runs import Part, split_runs
from .stated import stated_of
from .table import read_table
from .units import _GRAVITY, QUANTITIES, si_factor, split_header


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
    table = read_table(file, lambda header: _name(header) == "time", stated_of(file))
    return [name for name in _names(table) if name not in ("time", "run")]


def read_free_form(paths: Sequence[str | Path], columns: Sequence[str]) -> list[FreeRecord]:
    """Every run of the given files with the named columns, in SI units.

    Parameters
    ----------
    paths : sequence of str or Path
        Files, folders or globs.
    columns : sequence of str
        Names without units, beside `time`.

    Raises
    ------
    RecordError
        Anything that cannot be used, one line.
    """
    records: list[Any] = []
    for path in [file for entry in paths for file in record_files(entry)]:
        table = read_table(
            path, lambda header: _name(header) in {"time", "run", *columns}, stated_of(path)
        )
        at = _names(table)
        for name in ("time", *columns):
            if name not in at:
                raise RecordError(
                    f"{path}: no column {name!r} (found: {listed(list(at))}); every run needs it"
                )
        values = {
            name: numbers_of(table, at[name]) * _factor(table, at[name], name)
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


def _names(table: RawTable) -> dict[str, int]:
    """Index by name; known names in lower case, others as written without their unit."""
    found: dict[str, int] = {}
    for index, header in enumerate(table.header):
        name = _name(header)
        if not name:
            continue
        if name in found:
            raise RecordError(f"{table.path}: two columns hold {name!r}; keep one of them")
        found[name] = index
    return found


def _name(header: str) -> str:
    """A column's name without its unit; of those that are known in lower case."""
    name, _ = split_header(header)
    if name in QUANTITIES or name == "run":
        return name
    return re.sub(r"\s*[\[(].*$", "", header.strip().strip("\ufeff\"'").strip())


def _factor(table: RawTable, index: int, name: str) -> float:
    """Factor to SI units (rad for angles)."""
    _, unit = split_header(table.header[index])
    where = f"{table.path}: column {table.header[index].strip()!r}"
    if name in QUANTITIES:
        return si_factor(name, unit, where)
    if unit is None or unit in ("1", "-"):
        return 1.0
    if unit in _GRAVITY:
        return _GRAVITY[unit] * 9.80665
    parsed = parse_unit(unit)
    if parsed is None:
        raise RecordError(f"{where}: unknown unit {unit!r}; write an SI unit, or leave it out")
    return float(unit_registry().Quantity(1.0, parsed).to_base_units().magnitude)
