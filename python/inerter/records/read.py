"""Paths to records: find the files, recognise the columns, convert units, split runs, check."""

from __future__ import annotations

import dataclasses
import os
from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal, cast, overload

import numpy as np

from inerter.motion_units import ROTATION, TRANSLATION
from inerter.motion_units import Kind as Motion
from inerter.printable import text_of

from .bounds import Wanted, everything
from .calibration import Statement, applied, is_there, own_column
from .channels import corrected
from .columns import (
    Columns,
    Kind,
    choose_kind,
    is_known,
    recognise,
    refuse_missing,
    turns_by_name,
)
from .files import record_files
from .header import bare_name, guess, split_header
from .integrate import with_displacement
from .quality import check_records
from .raw_table import RawTable, explain_cell
from .record import AnyRecord, Array, BenchTable, Record, RecordError, VehicleRecord
from .runs import Part, split_runs
from .stated import Stated, announce, current, stated_of
from .table import read_table
from .together import joined
from .units import QUANTITIES, TURNING, motion_of_unit, quantity_in, si_factor


@overload
def read_records(
    paths: Sequence[str | Path] | str | Path,
    kind: Literal["bench"],
    *,
    check: bool = True,
    others: bool = True,
) -> list[Record]: ...
@overload
def read_records(
    paths: Sequence[str | Path] | str | Path,
    kind: Literal["vehicle"],
    *,
    check: bool = True,
    others: bool = True,
) -> list[VehicleRecord]: ...
@overload
def read_records(
    paths: Sequence[str | Path] | str | Path,
    kind: Literal["table"],
    *,
    check: bool = True,
    others: bool = True,
) -> list[BenchTable]: ...
@overload
def read_records(
    paths: Sequence[str | Path] | str | Path,
    kind: None = None,
    *,
    check: bool = True,
    others: bool = True,
) -> list[AnyRecord]: ...
def read_records(
    paths: Sequence[str | Path] | str | Path,
    kind: Kind | None = None,
    *,
    check: bool = True,
    others: bool = True,
) -> Sequence[AnyRecord]:
    """Read every run of the given files, folders and globs, in that order, in SI units.

    paths: one path or several; a folder stands for its files of known formats, sorted.
    kind: which records are wanted; None takes each file for what its columns say.
    check: add `check_records`' warnings. others: read further columns too, into `extra`. Raises
    RecordError (a ValueError), one line, for anything that cannot be used.
    """
    listed = [paths] if isinstance(paths, str | Path) else list(paths)
    if not listed:
        raise RecordError("no records given; name a file, a folder or a glob such as 'data/*.csv'")
    files = [file for entry in listed for file in record_files(entry)]
    stated = {path: stated_of(path) for path in files}
    # the partner of a file is no record of its own
    partners = {os.path.realpath(each.partner) for each in stated.values() if each.partner}
    files = [path for path in files if os.path.realpath(path) not in partners] or files
    records: list[AnyRecord] = []
    for path in files:
        records.extend(_read_file(path, kind, others, stated[path]))
        current().read.append(path)
    records = name_apart(records)
    records = check_records(records) if check else records
    announce(records)
    return records


def name_apart(records: list[AnyRecord]) -> list[AnyRecord]:
    """Give records of one name different ones: file name, then folder and file, then a count."""
    runs = [record.name.removeprefix(text_of(_source(record).stem)) for record in records]
    for folder in (False, True):
        count = Counter(record.name for record in records)
        for index, record in enumerate(records):
            if count[record.name] > 1:
                source = _source(record)
                base = f"{source.parent.name}/{source.name}" if folder else source.name
                records[index] = dataclasses.replace(record, name=text_of(base) + runs[index])
    seen: Counter[str] = Counter()
    for index, record in enumerate(records):
        seen[record.name] += 1
        if seen[record.name] > 1:
            records[index] = dataclasses.replace(record, name=f"{record.name}#{seen[record.name]}")
    return records


def _source(record: AnyRecord) -> Path:
    return cast(Path, record.source)


# --- one file ----------------------------------------------------------------------------------


def _read_file(path: Path, kind: Kind | None, others: bool, stated: Stated) -> list[AnyRecord]:
    wanted: Wanted = everything if others else lambda name: is_known(name, stated.columns)
    table = read_table(path, wanted, stated)
    here, there = stated.columns, {}
    if stated.partner is not None:
        here, there = _by_file(table.header, stated.columns)
    found = recognise(table, kind, here)
    both = slice(None)
    if stated.partner is not None:
        # first, for it may lack a column that is stated
        other_path, other, theirs = _partner(stated.partner, there)
    values, notes, motions = si_values(table, found)
    if stated.partner is not None:
        motions = theirs | motions
        others_values, both, note = joined(path, values, other_path, other, stated.lag)
        for name in others_values:
            found.own.setdefault(name, -1)
        values, notes = values | others_values, [*notes, note]
    cls = choose_kind(table, found, kind)
    refuse_missing(table, found, cls)
    motion = _motion(path, motions if cls is not VehicleRecord else {}, table, found)
    names = [name for name in (*cls.required, *cls.optional) if name in values]
    names += [n for n in ("acceleration_1", "acceleration_2") if cls is Record and n in values]
    extra = _further(table, found, {n: v for n, v in values.items() if n not in names})
    records: list[AnyRecord] = []
    for run, rows in split_runs(table, found.own.get("run")):
        whole = run is None and both == slice(None)
        rows = rows[both] if run is None else rows
        part = Part(table, run, rows)
        name = text_of(path.stem) + ("" if run is None else f":{run}")
        # long records are many: no copies of a file that is one run
        own = {n: values[n] if whole else values[n][rows] for n in names}
        columns, rows, losses = part.complete(own, cls)
        part = part.with_rows(rows)
        part.check(columns, cls)
        said = list(notes)
        if cls is Record:
            columns, rows, more = corrected(columns, rows, found.stated, part)
            columns, made = with_displacement(columns, part, motion)
            said += more + made
        rest = {n: v[rows] for n, v in extra.items()}
        text = "; ".join(each for each in (table.told, *said) if each)
        fields: dict[str, Any] = {"extra": rest, "comments": table.comments, **columns}
        fields["motion"] = motion
        fields["headers"] = _headers(table, found, cls)
        record = cls(name=name, source=path, reading=text, **fields)
        for note in losses:
            record = record.warn("missing_samples", note)
        records.append(record)
        if text:
            current().tell(path, f"read as: {text}")
    return records


def _headers(table: RawTable, found: Columns, cls: type[AnyRecord]) -> dict[str, str]:
    """What a user writes to name each column: its header, or what was stated of it."""
    names = [n for n in (*cls.required, *cls.optional) if n in found.own]
    headers = {n: table.header[found.own[n]].strip() for n in names if found.own[n] >= 0}
    stated = {n: found.stated[n].text for n in names if n in found.stated and found.stated[n].text}
    return headers | {n: text for n, text in stated.items() if not text.startswith("{")}


def _by_file(
    header: tuple[str, ...], stated: Mapping[str, Statement]
) -> tuple[dict[str, Statement], dict[str, Statement]]:
    """Statements about columns of this file, and those about columns of its partner."""
    here = {
        name: each
        for name, each in stated.items()
        if not each.column or is_there(each, header) or own_column(each, header, name)
    }
    return here, {name: each for name, each in stated.items() if name not in here}


def _partner(
    path: Path, there: Mapping[str, Statement]
) -> tuple[Path, dict[str, Array], dict[str, Motion]]:
    """The channels of a file of the same test that has a clock of its own; motions they tell."""
    stated = stated_of(path)
    table = read_table(path, everything, stated)
    found = recognise(table, "bench", {**stated.columns, **there})
    current().read.append(path)
    values, _, motions = si_values(table, found)
    return path, values | _further(table, found, {}), motions


def _motion(path: Path, motions: dict[str, Motion], table: RawTable, found: Columns) -> Motion:
    """The motion of a record; RecordError where some columns move along a line and others turn."""
    names: dict[Motion, list[str]] = {}
    for name, each in motions.items():
        names.setdefault(each, []).append(name)
    if len(names) == 2:
        along, about = names[TRANSLATION], names[ROTATION]

        def told(some: list[str], motion: Motion) -> str:
            shown = [
                f"{table.header[found.own[n]].strip()!r}" if found.own.get(n, -1) >= 0 else repr(n)
                for n in some
            ]
            means = [quantity_in(motion, n).meaning for n in some]
            return " and ".join(f"{s} is {m}" for s, m in zip(shown, means, strict=True))

        fewer = min((along, about), key=len)
        other = ROTATION if fewer is along else TRANSLATION
        ways = " and ".join(f"{n}[{quantity_in(other, n).unit}]" for n in fewer)
        raise RecordError(
            f"{path}: {told(along, TRANSLATION)}, but {told(about, ROTATION)}: a device moves "
            f"along a line or it turns; write {ways}, or state the column by --column, such as "
            f"--column {fewer[0]}='NAME [{quantity_in(other, fewer[0]).unit}]'"
        )
    return next(iter(names), None) or TRANSLATION


def si_values(
    table: RawTable, found: Columns
) -> tuple[dict[str, Array], list[str], dict[str, Motion]]:
    """The values of our quantities in SI units, what is to be told of them, motions they tell."""
    # units first: a wrong unit is one error, a wrong cell one among many
    factors = {}
    motions: dict[str, Motion] = {}
    for name, index in found.own.items():
        if name in QUANTITIES and name not in found.stated:
            where = f"{table.path}: column {table.header[index].strip()!r}"
            column = bare_name(table.header[index])
            factors[name] = si_factor(name, found.units[name], where, column)
            told = motion_of_unit(name, found.units[name])
            if told is None and name in TURNING and turns_by_name(table.header[index]):
                told = ROTATION
            if told is not None:
                motions[name] = told
    values: dict[str, Array] = {}
    notes: list[str] = []
    with np.errstate(over="ignore"):  # what overflows is refused with its row
        for name, index in found.own.items():
            if name not in QUANTITIES:
                continue
            column, header = numbers_of(table, index), table.header[index].strip()
            if name in factors:
                values[name] = column if factors[name] == 1.0 else column * factors[name]
            else:
                where = f"{table.path}: column {header!r}"
                values[name], told = applied(found.stated[name], name, column, header, where)
                if told is not None:
                    motions[name] = told
    motion = next(iter(motions.values()), None) or TRANSLATION
    for name, index in found.own.items():
        if name in QUANTITIES:
            told = _of_column(name, table.header[index].strip(), found, motion)
            notes.append(told + _rather_than(name, table.header[index].strip(), found, told))
    counted = found.stated.get("time")
    if counted is not None and counted.interval is not None:
        step = counted.interval * table.decimated
        values["time"] = step * np.arange(table.rows, dtype=np.float64)
        notes.append(f"a sample every {counted.interval:g} s, as stated")
    text = ", ".join(note for note in notes if note)
    return values, [text] if text else [], motions


def _of_column(name: str, header: str, found: Columns, motion: Motion) -> str:
    """What is told of a column that has not our name for it, or is calibrated."""
    statement = found.stated.get(name)
    if statement is not None and statement.text and statement.text != header:
        return f"{name} = {statement.text}"
    unit = found.units[name]
    if name == header.split("[")[0].split("(")[0].strip().casefold():
        return ""
    if unit is None and name != "time":
        return f"{name} = {header!r} (no unit: taken as {quantity_in(motion, name).unit})"
    return f"{name} = {header!r}"


def _rather_than(name: str, header: str, found: Columns, told: str) -> str:
    """The other columns that may hold the same quantity, where there are any."""
    if name in found.stated:
        return ""
    others = [
        other
        for other in found.extra
        if split_header(other)[0] == name or (guess(other) or ("",))[0] == name
    ]
    if not others:
        return ""
    shown = " or ".join(repr(other) for other in others[:4])
    return ("" if told else f"{name} = {header!r}") + f", not {shown}"


def _further(table: RawTable, found: Columns, left: dict[str, Array]) -> dict[str, Array]:
    """Further columns under the header that they had, where they hold numbers."""
    extra = {
        name: numbers
        for name, index in found.extra.items()
        if index in table.columns
        for numbers, bad in (table.numbers(index),)
        if not len(bad) and np.isfinite(numbers).any()
    }
    return extra | {name: v for name, v in left.items() if name not in extra}


def numbers_of(table: RawTable, index: int) -> Array:
    """Values of a column as written; RecordError for the first cell that is no number."""
    if index not in table.columns:
        raise RecordError(
            f"{table.path}: the channel {table.header[index].strip()!r} has not as many values as "
            "the others, and no clock that would tell when each was; save it with its time"
        )
    values, bad = table.numbers(index)
    if len(bad):
        row = int(bad[0])
        raise RecordError(
            f"{table.path}: {table.place(row)}, column {table.header[index].strip()!r}: "
            f"{explain_cell(table, index, row)}"
        )
    return values
