"""Workbooks (.xlsx, .xls, .ods), by python-calamine: values alone, no formula is worked out."""

from __future__ import annotations

import datetime
import zipfile
from pathlib import Path
from typing import Any

import numpy as np

from inerter.records.bounds import VALUES, refuse_more, refuse_packing
from inerter.records.header import guess
from inerter.records.record import RecordError
from inerter.records.text_layout import MOST_PREAMBLE, is_value, layout_of_cells

from .channels import Channel

LEAST_ROWS = 3


def channels(path: Path, sheet: str | None) -> list[Channel]:
    """The columns of the sheet that holds a record.

    Raises
    ------
    RecordError
        It is no workbook, unpacks to too much, or several sheets hold a record.
    """
    import python_calamine

    _refuse_bomb(path)
    try:
        book = python_calamine.CalamineWorkbook.from_path(str(path))
        names = list(book.sheet_names)
    except Exception:
        raise RecordError(
            f"{path}: not a readable workbook; save it again as .xlsx, or export CSV"
        ) from None
    if sheet is not None and sheet not in names:
        raise RecordError(
            f"{path}: no sheet {sheet!r}; there are {', '.join(map(repr, names[:8]))}; say --sheet"
        )
    found = []
    for name in [sheet] if sheet is not None else names:
        if (columns := _columns(path, book, name)) is not None:
            found.append(columns)
    if not found:
        raise RecordError(f"{path}: no sheet holds a table of numbers; export the record as CSV")
    if len(found) > 1:
        with_force = [c for c in found if any((g := guess(x.name)) and g[0] == "force" for x in c)]
        found = with_force or found
    if len(found) > 1:
        listed = ", ".join(repr(columns[0].group) for columns in found[:8])
        raise RecordError(
            f"{path}: several sheets hold a table ({listed}); say --sheet {found[0][0].group!r}"
        )
    return found[0]


def _refuse_bomb(path: Path) -> None:
    try:
        with zipfile.ZipFile(path) as archive:
            refuse_packing(path, float(sum(part.file_size for part in archive.infolist())))
    except (zipfile.BadZipFile, OSError, NotImplementedError, ValueError) as error:
        if isinstance(error, RecordError):
            raise
        # an old .xls is no zip
        with path.open("rb") as file:
            if file.read(4) == b"PK\x03\x04":
                raise RecordError(
                    f"{path}: not a readable workbook; save it again as .xlsx, or export CSV"
                ) from None


def _columns(path: Path, book: Any, name: str) -> list[Channel] | None:
    """The channels of a sheet; None where it holds no table."""
    try:
        sheet = book.get_sheet_by_name(name)
        refuse_more(path, VALUES, float(sheet.total_height) * float(sheet.total_width))
        rows = sheet.to_python(skip_empty_area=False)
    except RecordError:
        raise
    except Exception:
        return None
    if len(rows) < LEAST_ROWS:
        return None
    head = [[_text(cell) for cell in row] for row in rows[:MOST_PREAMBLE]]
    layout = layout_of_cells([_trimmed(cells) for cells in head])
    if layout is None:
        return None
    heading, first = layout
    if not heading.names:
        return None
    data = rows[first:]
    # text below the table, and empty rows
    while data and not _holds_number(data[-1]):
        data.pop()
    if len(data) < LEAST_ROWS:
        return None
    clock = (heading.start or 0.0, heading.interval) if heading.interval else None
    return [
        Channel(
            name=title, rows=len(data), group=name, clock=clock,
            load=lambda index=index: _values(data, index),
        )
        for index, title in enumerate(heading.names)
    ]  # fmt: skip


def _trimmed(cells: list[str]) -> list[str]:
    while cells and not cells[-1]:
        cells = cells[:-1]
    return cells


def _holds_number(row: list[Any]) -> bool:
    first = next((cell for cell in row if cell not in ("", None)), "")
    return not isinstance(first, str) or is_value(first)


def _text(cell: Any) -> str:
    if isinstance(cell, bool):
        return str(int(cell))
    if isinstance(cell, float):
        return f"{cell:.17g}"
    if isinstance(cell, datetime.datetime):
        return cell.isoformat(" ")
    if isinstance(cell, datetime.timedelta):
        return f"{cell.total_seconds():.9g}"
    return "" if cell is None else str(cell).strip()


def _values(rows: list[list[Any]], index: int) -> Any:
    """A column as numbers, or as texts where one of them is none."""
    cells = [row[index] if index < len(row) else None for row in rows]
    made = np.full(len(cells), np.nan)
    midnight: datetime.datetime | None = None
    for k, cell in enumerate(cells):
        if cell is None or cell == "":
            continue
        if isinstance(cell, bool | int | float):
            made[k] = float(cell)
        elif isinstance(cell, datetime.datetime):
            midnight = midnight or cell.replace(hour=0, minute=0, second=0, microsecond=0)
            made[k] = (cell - midnight).total_seconds()
        elif isinstance(cell, datetime.time):
            made[k] = 3600 * cell.hour + 60 * cell.minute + cell.second + 1e-6 * cell.microsecond
        elif isinstance(cell, datetime.timedelta):
            made[k] = cell.total_seconds()
        else:
            return [_text(each) for each in cells]
    return made
