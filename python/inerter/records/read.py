"""Paths to records: find the files, recognise the columns, convert units, split runs, check."""

from __future__ import annotations

import dataclasses
import difflib
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal, cast, overload

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import Akima1DInterpolator

from inerter.printable import text_of

from .bounds import Wanted, everything
from .files import record_files
from .quality import check_records
from .raw_table import RawTable, explain_cell, listed
from .record import AnyRecord, Array, BenchTable, Record, RecordError, TimeRecord, VehicleRecord
from .table import read_table
from .units import QUANTITIES, si_factor, split_header

MIN_SAMPLES = 50  # of a record over time
MIN_TABLE_ROWS = 3  # of a bench table
MAX_MISSING_SHARE = 0.01  # of the rows of a run; three rows are always allowed
MAX_SIZE = 1e12  # of any value, in SI units: beyond it no unit can be right
MAX_MISSING_STRETCH = 25  # rows in a row that are still interpolated
# samples that a run may have on an even clock, per row: pauses may take nine tenths of its time
MAX_FILLED = 10

Kind = Literal["bench", "vehicle", "table"]
Rows = NDArray[np.intp]

_CLASSES: dict[str, type[Record] | type[VehicleRecord] | type[BenchTable]] = {
    "bench": Record,
    "table": BenchTable,
    "vehicle": VehicleRecord,
}

# names other people give to our columns, for the advice in an error
_SYNONYMS = {
    "time": ("t", "time_s", "timestamp", "seconds", "zeit"),
    "displacement": ("x", "s", "disp", "position", "pos", "stroke", "travel", "displacement_mm"),
    "force": ("f", "load", "kraft", "force_n", "force_kn", "load_cell"),
    "frequency": ("f", "freq", "hz"),
    "force_amplitude": ("force", "amplitude"),
    "acceleration_amplitude": ("acceleration", "amplitude"),
    "road": ("z", "profile", "ground"),
}


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

    paths: one path or several; a folder stands for its .csv, .parquet and .mat files, sorted.
    kind: which records are wanted; None takes each file for what its columns say.
    check: add `check_records`' warnings. others: read further columns too, into `extra`. Raises
    RecordError (a ValueError), one line, for anything that cannot be used.
    """
    listed = [paths] if isinstance(paths, str | Path) else list(paths)
    if not listed:
        raise RecordError("no records given; name a file, a folder or a glob such as 'data/*.csv'")
    records: list[AnyRecord] = []
    for path in [file for entry in listed for file in record_files(entry)]:
        records.extend(_read_file(path, kind, everything if others else _is_known))
    records = _name_apart(records)
    return check_records(records) if check else records


def _name_apart(records: list[AnyRecord]) -> list[AnyRecord]:
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


@dataclass(frozen=True)
class _Columns:
    """Which column of a raw table holds what: index by name, unit by name, and the rest."""

    own: dict[str, int]
    units: dict[str, str | None]
    extra: dict[str, int]


def _is_known(header: str) -> bool:
    """Whether a column has a name that records know."""
    name = split_header(header)[0]
    return name in QUANTITIES or name == "run"


def _read_file(path: Path, kind: Kind | None, wanted: Wanted) -> list[AnyRecord]:
    table = read_table(path, wanted)
    found = _recognise(table)
    cls = _choose_kind(table, found, kind)
    _refuse_missing_columns(table, found, cls)
    names = [name for name in (*cls.required, *cls.optional) if name in found.own]

    # units first: a wrong unit is one error, a wrong cell one among many
    factors = {
        name: si_factor(name, found.units[name], f"{path}: column {table.header[i].strip()!r}")
        for name, i in found.own.items()
        if name in names
    }
    values = {name: _numbers(table, found.own[name]) for name in names}
    with np.errstate(over="ignore"):  # what overflows is refused with its row
        values = {n: v if factors[n] == 1.0 else v * factors[n] for n, v in values.items()}
    extra = {
        name: numbers
        for name, index in found.extra.items()
        if index in table.columns
        for numbers, bad in (table.numbers(index),)
        if not len(bad) and np.isfinite(numbers).any()
    }
    records: list[AnyRecord] = []
    for run, rows in _split_runs(table, found.own.get("run")):
        part = _Part(table, run, rows)
        name = text_of(path.stem) + ("" if run is None else f":{run}")
        # long records are many: no copies of a file that is one run
        own = values if run is None else {n: v[rows] for n, v in values.items()}
        columns, rows, notes = part.complete(own, cls)
        part.with_rows(rows).check(columns, cls)
        rest = {n: v[rows] for n, v in extra.items()}
        fields: dict[str, Any] = {"extra": rest, "comments": table.comments, **columns}
        record = cls(name=name, source=path, **fields)
        for note in notes:
            record = record.warn("missing_samples", note)
        records.append(record)
    return records


def _recognise(table: RawTable) -> _Columns:
    """Names and units of the columns; RecordError when two columns hold the same thing."""
    own: dict[str, int] = {}
    units: dict[str, str | None] = {}
    extra: dict[str, int] = {}
    for index, header in enumerate(table.header):
        name, unit = split_header(header)
        known = name in QUANTITIES or name == "run"
        key = name if known else header.strip()
        # a column without a name is the row number of some export
        if not key:
            continue
        target = own if known else extra
        if key in target:
            first = table.header[target[key]].strip()
            raise RecordError(
                f"{table.path}: columns {first!r} and {header.strip()!r} both hold {key!r}; "
                "keep one of them"
            )
        target[key] = index
        units[key] = unit
    return _Columns(own, units, extra)


def _choose_kind(table: RawTable, found: _Columns, kind: Kind | None) -> type[AnyRecord]:
    """The wanted class, else the first whose columns are complete, else the most likely one."""
    complete = [k for k, c in _CLASSES.items() if all(name in found.own for name in c.required)]
    if kind is not None:
        if complete and kind not in complete:
            raise RecordError(
                f"{table.path}: this is a {complete[0]} record, a {kind} record is needed "
                f"(columns {', '.join(_CLASSES[kind].required)}); give another file"
            )
        return _CLASSES[kind]
    if complete:
        return _CLASSES[complete[0]]
    share = {
        k: sum(n in found.own for n in c.required) / len(c.required) for k, c in _CLASSES.items()
    }
    if "road" not in found.own:
        share["vehicle"] = 0.0
    return _CLASSES[max(share, key=lambda k: share[k])]


def _refuse_missing_columns(table: RawTable, found: _Columns, cls: type[AnyRecord]) -> None:
    """RecordError for the first required column that is not there, with the likeliest stand-in."""
    for name in cls.required:
        if name in found.own:
            continue
        spare = {split_header(header)[0]: header.strip() for header in table.header}
        spare = {n: h for n, h in spare.items() if n and n not in cls.required and n != "run"}
        match = [n for n in spare if n in _SYNONYMS.get(name, ())]
        match = match or difflib.get_close_matches(name, list(spare), n=1, cutoff=0.6)
        advice = (
            f"rename {spare[match[0]]!r} to {_with_unit(name, spare[match[0]])!r}" if match
            else f"a {cls.kind} record needs the columns {', '.join(cls.required)}"
        )  # fmt: skip
        raise RecordError(
            f"{table.path}: no column {name!r} (found: {listed(table.header)}); {advice}"
        )


def _with_unit(name: str, header: str) -> str:
    """`name` with the unit that `header` states."""
    unit = split_header(header)[1]
    return name if unit is None else f"{name}[{unit}]"


def _numbers(table: RawTable, index: int) -> Array:
    """Values of a column as written; RecordError for the first cell that is no number."""
    values, bad = table.numbers(index)
    if len(bad):
        row = int(bad[0])
        raise RecordError(
            f"{table.path}: {table.place(row)}, column {table.header[index].strip()!r}: "
            f"{explain_cell(table, index, row)}"
        )
    return values


def _split_runs(table: RawTable, column: int | None) -> list[tuple[str | None, Rows]]:
    """Rows of each run, in order of first appearance; the rows of a run may be interleaved."""
    if column is None:
        return [(None, np.arange(table.rows))]
    cells = np.array(table.text(column))
    labels, first, member = np.unique(cells, return_index=True, return_inverse=True)
    if "" in labels:
        row = int(np.flatnonzero(cells == "")[0])
        raise RecordError(
            f"{table.path}: {table.place(row)}, column {table.header[column].strip()!r}: "
            "no run is named; fill the cell"
        )
    order = np.argsort(member, kind="stable")  # in place of a search per run
    parts = np.split(order, np.cumsum(np.bincount(member))[:-1])
    return [(str(labels[k]), parts[k]) for k in np.argsort(first)]


# --- one run -----------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Part:
    """Rows of a table that form one run, for errors that can say where they are."""

    table: RawTable
    run: str | None
    rows: Rows

    def refuse(self, text: str, row: int | None = None) -> RecordError:
        """The error for this run; row: index within the run."""
        where = str(self.table.path)
        if row is not None:
            where += f": {self.table.place(int(self.rows[row]))}"
        if self.run is not None:
            where += f"{', ' if row is not None else ': '}run {self.run!r}"
        return RecordError(f"{where}: {text}")

    def complete(
        self, columns: dict[str, Array], cls: type[AnyRecord]
    ) -> tuple[dict[str, Array], Rows, list[str]]:
        """Columns without gaps, the rows that are left, and what was done about gaps.

        Rows at the ends and rows without a time are dropped, short stretches are interpolated
        (Akima). RecordError when more than `MAX_MISSING_SHARE` of the rows, or more than
        `MAX_MISSING_STRETCH` rows in a row, lack a value.
        """
        notes: list[str] = []
        columns = dict(columns)
        for name in list(columns):
            if np.isfinite(columns[name]).any():
                continue
            if name in cls.required:
                raise self.refuse(
                    f"column {name!r} holds no number; record it, or leave this run out"
                )
            del columns[name]
            notes.append(f"column {name!r} holds no number and was left out")
        lost = {name: ~np.isfinite(values) for name, values in columns.items()}
        anywhere = np.logical_or.reduce(list(lost.values()))
        if not anywhere.any():
            return columns, self.rows, notes

        # too much is refused, with the place of the first loss
        count, total = int(anywhere.sum()), len(anywhere)
        first = int(np.argmax(anywhere))
        name = next(n for n, mask in lost.items() if mask[first])
        stretch = _longest_stretch(anywhere)
        over_time = issubclass(cls, TimeRecord)
        allowed = max(3, int(MAX_MISSING_SHARE * total)) if over_time else 0
        if count > allowed or stretch > MAX_MISSING_STRETCH:
            text = f"column {name!r} has no value here"
            if not over_time:
                raise self.refuse(f"{text}; write it, or remove the row", first)
            raise self.refuse(
                f"{text}; {count} of {total} rows lack one (longest stretch {stretch}), "
                f"at most {allowed} may, and {MAX_MISSING_STRETCH} together; "
                "cut the gap out by splitting the run",
                first,
            )

        # drop what cannot be interpolated: no time, or nothing on one side
        whole = np.flatnonzero(~anywhere)
        keep = ~lost["time"]
        keep[: whole[0]] = False
        keep[whole[-1] + 1 :] = False
        kept = {n: values[keep] for n, values in columns.items()}
        self.with_rows(self.rows[keep]).check_clock(kept["time"])
        for n, values in kept.items():
            gap = lost[n][keep]
            if gap.any():
                spline = Akima1DInterpolator(kept["time"][~gap], values[~gap], method="makima")
                values[gap] = spline(kept["time"][gap])
        filled, dropped = int((anywhere & keep).sum()), int((~keep).sum())
        done = [f"{filled} interpolated"] if filled else []
        done += [f"{dropped} dropped"] if dropped else []
        notes.append(
            f"{count} of {total} rows lack a value (first at "
            f"{self.table.place(int(self.rows[first]))}, column {name!r}): {', '.join(done)}"
        )
        return kept, self.rows[keep], notes

    def check(self, columns: dict[str, Array], cls: type[AnyRecord]) -> None:
        """RecordError for too few rows, a clock that does not advance, impossible amplitudes."""
        rows = len(self.rows)
        for name, values in columns.items():
            if rows and np.max(np.abs(values)) > MAX_SIZE:
                row = int(np.argmax(np.abs(values)))
                raise self.refuse(
                    f"column {name!r} is {values[row]:g}, which nothing measures; correct it", row
                )
        if cls is BenchTable:
            if rows < MIN_TABLE_ROWS:
                raise self.refuse(
                    f"only {rows} rows, a table needs {MIN_TABLE_ROWS}; measure more frequencies"
                )
            for name, values in columns.items():
                bad = values <= 0.0 if name == "frequency" else values < 0.0
                if bad.any():
                    row = int(np.argmax(bad))
                    kind = "positive" if name == "frequency" else "zero or positive"
                    raise self.refuse(
                        f"column {name!r} is {values[row]:g}, it has to be {kind}; correct it", row
                    )
            return
        if rows < MIN_SAMPLES:
            raise self.refuse(
                f"only {rows} samples, at least {MIN_SAMPLES} are needed; record longer or faster"
            )
        self.check_clock(columns["time"])

    def check_clock(self, time: Array) -> None:
        """RecordError for a time that stands still, repeats, goes back or leaps; times in s."""
        step = np.diff(time)
        if not len(step):
            return
        if (step > 0.0).all():
            self._check_pauses(time, step)
            return
        if not step.any():
            raise self.refuse(f"column 'time' is {time[0]:g} s in every row; record the time", 0)
        row = int(np.argmax(step <= 0.0)) + 1
        now, before = f"{time[row]:.9g}", f"{time[row - 1]:.9g}"
        if step[row - 1] == 0.0:
            raise self.refuse(
                f"time {now} s repeats the row before; remove the duplicate row, "
                "or write time with more digits",
                row,
            )
        if (step < 0.0).all():
            advice = "time runs backwards; sort the rows by time"
        elif time[row] <= time[0] and (step > 0.0).sum() >= 0.9 * len(step):
            advice = "runs behind each other? give them a 'run' column or a file each"
        else:
            advice = "sort the rows by time"
        raise self.refuse(f"time goes back from {before} s to {now} s; {advice}", row)

    def _check_pauses(self, time: Array, step: Array) -> None:
        """RecordError for pauses so long that an even clock would be mostly empty."""
        usual = float(np.median(step))
        filled = (time[-1] - time[0]) / usual
        if filled <= MAX_FILLED * len(time):
            return
        row = int(np.argmax(step)) + 1
        leap, before, now = step[row - 1], time[row - 1], time[row]
        raise self.refuse(
            f"time leaps by {leap:.4g} s, from {before:.9g} s to {now:.9g} s; "
            f"evenly sampled at the usual {usual:.3g} s the run would have {filled:.2g} samples, "
            f"not {len(time)}; correct the time, or split the run there with a 'run' column",
            row,
        )

    def with_rows(self, rows: Rows) -> _Part:
        return dataclasses.replace(self, rows=rows)


def _longest_stretch(mask: NDArray[np.bool_]) -> int:
    """Length of the longest run of True."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], mask.astype(np.int8), [0]))))
    return int((edges[1::2] - edges[::2]).max(initial=0))
