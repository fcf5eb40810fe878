"""The rows of one run: without gaps, on a clock that advances, of possible sizes."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import Akima1DInterpolator

from .raw_table import RawTable
from .record import AnyRecord, Array, BenchTable, RecordError, TimeRecord

MIN_SAMPLES = 50  # of a record over time
MIN_TABLE_ROWS = 3  # of a bench table
MAX_MISSING_SHARE = 0.01  # of the rows of a run; three rows are always allowed
MAX_SIZE = 1e12  # of any value, in SI units: beyond it no unit can be right
MAX_MISSING_STRETCH = 25  # rows in a row that are still interpolated
# samples that a run may have on an even clock, per row: pauses may take nine tenths of its time
MAX_FILLED = 10

Rows = NDArray[np.intp]


def split_runs(table: RawTable, column: int | None) -> list[tuple[str | None, Rows]]:
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


@dataclass(frozen=True)
class Part:
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

    def with_rows(self, rows: Rows) -> Part:
        return dataclasses.replace(self, rows=rows)


def _longest_stretch(mask: NDArray[np.bool_]) -> int:
    """Length of the longest run of True."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], mask.astype(np.int8), [0]))))
    return int((edges[1::2] - edges[::2]).max(initial=0))
