"""The lines above a table of numbers: names of columns, their units, a clock that is stated.

Benches write them in many ways: names and units in two lines, units in brackets, pairs of columns
with a label before each (``Channel name;F;Channel name;x``), a clock as start and interval.
"""

from __future__ import annotations

import itertools
import re
from collections.abc import Sequence
from dataclasses import dataclass

from inerter.unit_text import parse_unit

from .header import bench_unit, quantity_of, split_header

MOST_ABOVE = 40  # lines above the data that may name columns

# attributes and scalars of binary files that state a clock
STEPS = (
    "dt", "interval", "wf_increment", "sampling_interval", "sample_interval", "delta_t",
    "Tinterval", "Ts",
)  # fmt: skip
RATES = ("fs", "rate", "sample_rate", "sampling_rate", "SamplingRate", "samplerate")

_LABELS = {
    "name": (
        "channel name", "channel names", "channel", "channels", "kanalname", "kanal", "name",
        "signal", "tracename",
    ),
    "unit": ("unit", "units", "einheit", "einheiten", "y_unit_label", "unité", "unidad", "vunit"),
    "interval": (
        "interval", "delta_x", "sampling interval", "sample interval", "sampling time interval",
        "time interval", "sampling time", "sampling period", "abtastintervall", "abtastzeit",
        "zeitintervall", "dt", "delta t", "tinterval", "wf_increment", "hresolution", "sampletime",
    ),
    "rate": (
        "sample rate", "sampling rate", "samplerate", "sampling frequency", "sample frequency",
        "abtastrate", "messrate", "fs", "rate", "frequency of sampling", "fréquence",
    ),
    "start": ("x0", "start", "t0", "start offset", "wf_start_offset"),
}  # fmt: skip
_LABEL_OF = {label: kind for kind, labels in _LABELS.items() for label in labels}

_CLOCK = re.compile(
    r"(?:\d{1,4}[-./]\d{1,2}[-./]\d{1,4}[T ]+)?\d{1,3}:\d{2}(?::\d{2})?(?:[.,:]\d+)?"
    r"(?: ?[AaPp][Mm])?(?:Z|[+-]\d{2}:?\d{2})?"
)


@dataclass(frozen=True)
class Heading:
    """What stands above the data.

    names: one for each column, units in brackets; line: of the lowest line that names, 0 where
    there is none, top: of the highest one; units_line; interval, start: of the clock [s] where only
    they are stated.
    """

    names: tuple[str, ...] = ()
    line: int = 0
    units_line: int | None = None
    interval: float | None = None
    start: float | None = None
    top: int = 0


def is_clock(cell: str) -> bool:
    """Whether a cell is a time of day, with a date or without."""
    return ":" in cell and len(cell) < 48 and _CLOCK.fullmatch(cell) is not None


def heading(
    above: Sequence[list[str] | None], width: int, body: Sequence[Sequence[str]]
) -> Heading:
    """What the rows above the data say; `above[i]` are the cells of line i + 1."""
    rows = [(number, row) for number, row in enumerate(above, start=1) if row]
    interval, start = _stated_clock(rows)
    rows = rows[-MOST_ABOVE:]
    if not rows:
        return Heading(interval=interval, start=start)
    for found in (_labelled(rows, width, body, interval), _named(rows, width, body)):
        if found is not None:
            names, line, units_line, top = found
            if interval is not None:
                names = tuple(
                    f"{name} (whole seconds)" if _is_time(name) and _stands(body, i) else name
                    for i, name in enumerate(names)
                )
            has_time = any(_is_time(name) for name in names)
            return Heading(
                names, line, units_line,
                None if has_time else interval, None if has_time else start, top,
            )  # fmt: skip
    number, row = rows[-1]
    return Heading(tuple(row), number, None, None, None, number)


def _is_time(name: str) -> bool:
    return bool(quantity_of(name, "time"))


def _stands(body: Sequence[Sequence[str]], index: int) -> bool:
    """Whether a clock stands still in the first rows: it tells whole seconds."""
    cells = [row[index] for row in body if index < len(row)]
    return len(cells) > 2 and is_clock(cells[0]) and len(set(cells)) == 1


def _fits(row: Sequence[str], width: int, body: Sequence[Sequence[str]] = ()) -> list[str] | None:
    """A row of as many cells as columns, where an empty one at the end does not count.

    Of one cell less the column without a name is the first where that counts rows, else the last.
    """
    cells = list(row)
    while len(cells) > width and not cells[-1]:
        cells.pop()
    if len(cells) == width:
        return cells
    if len(cells) == width - 1:
        firsts = [line[0] for line in body if line]
        counts = firsts in ([str(k + i) for i in range(len(firsts))] for k in (0, 1))
        return ["", *cells] if len(firsts) > 1 and counts else [*cells, ""]
    return None


def _named(
    rows: Sequence[tuple[int, list[str]]], width: int, body: Sequence[Sequence[str]]
) -> tuple[tuple[str, ...], int, int | None, int] | None:
    """Names and units of the row or rows of text right above the data."""
    # below a row of another width, where there are any
    apart = next((i for i, (_, r) in reversed([*enumerate(rows)]) if _fits(r, width) is None), -1)
    fitting = [(n, c) for n, row in rows[apart + 1 :] or rows
               if (c := _fits(row, width, body)) is not None]  # fmt: skip
    fitting = [(n, c) for n, c in fitting if any(re.search(r"[^\W\d]", cell) for cell in c)][-6:]
    if not fitting:
        return None
    last = fitting[-1][0]
    units_at = next((i for i in range(len(fitting))[::-1] if _are_units(fitting[i][1])), None)
    named = [i for i in range(len(fitting)) if i != units_at]
    if not named:
        return tuple(fitting[-1][1]), last, None, last

    # of several rows the one with the names that are known, else the one next to the data
    def rank(i: int) -> tuple[int, int]:
        cells = fitting[i][1]
        known = [quantity_of(c) is not None and c not in ("V", "A", "N") for c in cells]
        units = [bench_unit(cell) is not None for cell in cells]
        return sum(known) - sum(u and not k for u, k in zip(units, known, strict=True)), i

    best = max(named, key=rank)
    names = fitting[best][1]
    if units_at is None and best + 1 < len(fitting) and best == len(fitting) - 2:
        mixed = _mixed(names, fitting[-1][1])
        if mixed is not None:
            return mixed, last, last, fitting[best][0]
    if units_at is None:
        return tuple(names), fitting[best][0], None, fitting[best][0]
    units = fitting[units_at][1]
    joined = tuple(_with_unit(n, u) for n, u in zip(names, units, strict=True))
    return joined, last, fitting[units_at][0], min(fitting[best][0], fitting[units_at][0])


def _mixed(upper: Sequence[str], lower: Sequence[str]) -> tuple[str, ...] | None:
    """Two rows of which the lower has a unit for some columns and names for others."""
    units = [bench_unit(cell) for cell in lower]
    if not any(units):
        return None
    count = {cell: list(lower).count(cell) for cell in lower}
    return tuple(
        _with_unit(name, cell) if unit or not cell
        else cell if count[cell] == 1
        else f"{name} {cell}"
        for name, cell, unit in zip(upper, lower, units, strict=True)
    )  # fmt: skip


# of columns without a unit; TS and RN are a logger's time stamp and number of the row
_NO_UNIT = ("", "-", "1", "[-]", "(-)", "[]", "()", "TS", "RN")


def _are_units(cells: Sequence[str]) -> bool:
    """Whether all cells are units, blanks or dashes, and one at least is a unit."""
    full = [cell for cell in cells if cell not in _NO_UNIT]
    # names of one letter are units, too: t, x, F
    if not full or all(quantity_of(c) is not None and c not in ("s", "N", "m") for c in full):
        return False
    return all(bench_unit(cell) is not None for cell in full)


def _with_unit(name: str, unit: str) -> str:
    name = name.strip()
    if split_header(name)[1] is not None:
        return name
    if unit in _NO_UNIT:
        return name
    unit = bench_unit(unit) or unit.strip("[]() ")
    return f"{name} [{unit}]" if unit and name else name


def _labelled(
    rows: Sequence[tuple[int, list[str]]],
    width: int,
    body: Sequence[Sequence[str]],
    interval: float | None,
) -> tuple[tuple[str, ...], int, int | None, int] | None:
    """Names of columns in rows that begin with what they hold."""
    found: dict[str, tuple[int, list[str]]] = {}
    for number, row in rows:
        kind = _LABEL_OF.get(_plain(row[0]))
        if kind == "unit" or (kind == "name" and len(row) > 1 and not _is_number(row[1])):
            found[kind] = (number, row)
    line = rows[-1][0]
    if "name" not in found:
        return _lvm(rows, width, found.get("unit"), body)
    number, row = found["name"]
    cells = row + [""] * (width - len(row))
    units_line, units = found.get("unit", (None, [""] * width))
    units = units + [""] * (width - len(units))
    if width % 2 == 0 and width >= 4 and _plain(cells[2]) == _plain(cells[0]):
        # a time and a value, side by side, for each channel
        unit = _unit_of_clock(body, interval)
        names = [
            f"time [{unit}]" if i == 0 else f"time {i // 2 + 1} [{unit}]" if i % 2 == 0
            else _with_unit(cells[i], units[i])
            for i in range(width)
        ]  # fmt: skip
        return tuple(names), line, units_line, line
    del number
    if len(row) == width + 1:
        # the label stands beside the columns
        units = units + [""] * (width + 1 - len(units))
        beside = [_with_unit(c, u) for c, u in zip(cells[1:], units[1 : width + 1], strict=True)]
        return tuple(beside), line, units_line, line
    # the label stands over the first column, which has no name of its own: a time, or nothing
    joined = [_with_unit(c, u) for c, u in zip(cells[1:width], units[1:width], strict=True)]
    first = "time [s]" if len(body) and len(body[0]) == width and body[0][0] else ""
    return (first, *joined), line, units_line, line


def _unit_of_clock(body: Sequence[Sequence[str]], interval: float | None) -> str:
    """Seconds, or milliseconds where the first column goes on by as many as the interval has."""
    try:
        first, second = (float(row[0].replace(",", ".")) for row in body[:2])
    except (ValueError, IndexError):
        return "s"
    return "ms" if interval and abs((second - first) / (1e3 * interval) - 1) < 1e-3 else "s"


def _lvm(
    rows: Sequence[tuple[int, list[str]]],
    width: int,
    units: tuple[int, list[str]] | None,
    body: Sequence[Sequence[str]],
) -> tuple[tuple[str, ...], int, int | None, int] | None:
    """A LabVIEW measurement file: X_Value, names, Comment; the units stand further above."""
    number, row = rows[-1]
    if _plain(row[0]) != "x_value":
        return None
    names = [cell for cell in row if _plain(cell) != "comment"]
    cells = units[1][1:] if units else []
    columns = iter(cells)
    joined = []
    for name in names[:width]:
        if _plain(name) == "x_value" and not joined and body and not body[0][0]:
            joined.append("")
        elif _plain(name) == "x_value":
            joined.append(f"time {len(joined)} [s]" if joined else "time [s]")
        else:
            joined.append(_with_unit(name, next(columns, "")))
    joined += [""] * (width - len(joined))
    return tuple(joined), number, units[0] if units else None, number


def _is_number(cell: str) -> bool:
    return re.fullmatch(r"\s*\d+([.,]\d+)?\s*", cell) is not None


def _is_value(cell: str) -> bool:
    return re.fullmatch(r"\s*[+-]?\d+(\.\d*)?([eE][+-]?\d+)?\s*", cell) is not None


def _plain(cell: str) -> str:
    return cell.strip().strip('"').rstrip(":").strip().casefold()


def _stated_clock(rows: Sequence[tuple[int, list[str]]]) -> tuple[float | None, float | None]:
    """Interval and start [s] that a line states, as in ``Sample rate (Hz): 1000``."""
    interval = start = None
    # names and values one below the other, as in ``X,CH1,Start,Increment``
    for (_, row), (_, below) in itertools.pairwise(rows):
        stated = dict(zip(map(_plain, row), below, strict=False))
        if len(row) > 2 and _is_value(stated.get("increment", "")):
            interval, start = float(stated["increment"]), None
            start = float(stated["start"]) if _is_value(stated.get("start", "")) else None
    for _, row in rows:
        text = " ".join(cell for cell in row if cell)
        match = re.match(
            r"\s*\"?([A-Za-z_éè][\w éè]*?)\s*(?:[\[(]([^\])]*)[\])])?\"?\s*[:=,;\t ]\s*\"?"
            r"([+-]?\d*[.,]?\d+(?:[eE][+-]?\d+)?)\s*([A-Za-zµ/]*)", text,
        )  # fmt: skip
        if match is None:
            continue
        kind = _LABEL_OF.get(match[1].strip().casefold())
        value, unit = float(match[3].replace(",", ".")), match[2] or match[4]
        if kind == "interval" and value > 0:
            interval = value * _factor(unit, "s")
        elif kind == "rate" and value > 0:
            interval = 1 / (value * _factor(unit, "Hz"))
        elif kind == "start":
            start = value * _factor(unit, "s")
    return interval, start


def _factor(unit: str, into: str) -> float:
    """Factor to a unit of time or frequency; 1 for what is none."""
    parsed = parse_unit(unit) if unit else None
    if parsed is None or parsed.dimensionality != parse_unit(into).dimensionality:
        return 1.0
    from inerter.unit_text import unit_registry

    return float(unit_registry().Quantity(1.0, parsed).to(into).magnitude)
