"""CSV to a raw table, a block of lines at a time, with errors that say which line and what to do.

A file may be larger than the memory would bear as text: what is kept of a block are its numbers.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from io import BytesIO
from pathlib import Path

import numpy as np
import polars as pl

from .raw_table import OddCell, RawTable, is_number, quoted, to_numbers, too_long
from .record import Array, RecordError
from .units import split_header

BLOCK = 1 << 24  # bytes that are read at a time
LONGEST_LINE = 1 << 22  # bytes


@dataclass(frozen=True)
class _Block:
    """Whole lines of a UTF-8 text: the number of the first, and whether the file ends with them."""

    number: int
    text: bytes
    last: bool


def read_csv(path: Path, most_rows: int) -> RawTable:
    """The raw table of a CSV file; RecordError when it cannot be read or has too many rows."""
    comments: list[str] = []
    table: _Growing | None = None
    for block in _blocks(path):
        start = 0
        if table is None:
            line, start = _find_header(path, block, comments)
            if line is None:
                continue
            number = block.number + block.text.count(b"\n", 0, start) - 1
            body = block.text[start : start + 4096]
            table = _Growing(path, _split_header_line(path, line, number, comments, body))
        number = block.number + block.text.count(b"\n", 0, start)
        table.add(_Block(number, block.text[start:], block.last), most_rows)
    if table is None:
        raise RecordError(
            f"{path}: the file is empty (blanks and comments only); add header and data"
        )
    return table.done(comments)


class _Growing:
    """A table whose rows come block by block."""

    def __init__(self, path: Path, header: tuple[str, ...]) -> None:
        self.path, self.header, self.rows = path, header, 0
        # names of runs stay what they are
        self.as_text = [split_header(name)[0] == "run" for name in header]
        self.numbers: list[list[Array]] = [[] for _ in header]
        self.texts: list[list[pl.Series]] = [[] for _ in header]
        self.odd: dict[int, OddCell] = {}

    def add(self, block: _Block, most_rows: int) -> None:
        """Take in the data lines of a block."""
        columns = _columns(self.path, block, len(self.header))
        rows = len(columns[0]) if columns else 0
        if rows:
            self._refuse_long(block, rows, most_rows)
        for index, column in enumerate(columns):
            if self.as_text[index]:
                self.texts[index].append(column)
                continue
            values, bad = to_numbers(column)
            self.numbers[index].append(values)
            if len(bad) and index not in self.odd:
                cells = tuple(str(series[int(bad[0])]).strip() for series in columns)
                self.odd[index] = OddCell(self.rows + int(bad[0]), cells)
        self.rows += rows

    def _refuse_long(self, block: _Block, rows: int, most_rows: int) -> None:
        """RecordError where there are too many rows, or a first block tells that there will be."""
        whole = rows * self.path.stat().st_size / len(block.text)
        if self.rows + rows > most_rows or (not self.rows and whole > 1.5 * most_rows):
            raise RecordError(too_long(self.path, max(whole, self.rows + rows), most_rows))

    def done(self, comments: list[str]) -> RawTable:
        """The table of all blocks; gives its own rows away."""
        columns = []
        for name, is_text in zip(self.header, self.as_text, strict=True):
            numbers, texts = self.numbers.pop(0), self.texts.pop(0)
            if is_text or not numbers:
                columns.append(pl.concat([pl.Series(name, [], dtype=pl.String), *texts]))
            else:
                columns.append(pl.Series(name, np.concatenate(numbers)))
        lines = partial(_data_lines_of, self.path)
        return RawTable(
            path=self.path,
            header=self.header,
            columns=tuple(columns),
            comments=tuple(comments),
            odd=self.odd,
            lines=lines,
        )


# --- text --------------------------------------------------------------------------------------


def _blocks(path: Path) -> Iterator[_Block]:
    """The text in whole lines that end in a line feed, without a byte order mark.

    RecordError for anything but UTF-8 text.
    """
    number, rest = 1, b""
    with path.open("rb") as file:
        chunk = file.read(BLOCK)
        _refuse_other_formats(path, chunk)
        chunk = chunk.removeprefix(b"\xef\xbb\xbf")
        while chunk or rest:
            ahead = file.read(BLOCK)
            text = rest + chunk
            # line ends of any system; one that is cut in two waits for its other half
            cut = text.endswith(b"\r") and bool(ahead)
            if b"\r" in text:
                text = text[: len(text) - cut].replace(b"\r\n", b"\n").replace(b"\r", b"\n")
            stop = text.rfind(b"\n") + 1 if ahead else len(text)
            rest = text[stop:] + b"\r" * cut
            text = text[:stop]
            _refuse_no_text(path, text, number)
            if b"\x00" in rest or len(rest) > LONGEST_LINE:
                raise RecordError(_binary(path))
            if text or not ahead:
                yield _Block(number, text, not ahead)
            number += text.count(b"\n")
            chunk = ahead
            if not ahead:
                return


def _refuse_other_formats(path: Path, data: bytes) -> None:
    kinds = {b"PAR1": "a Parquet", b"PK\x03\x04": "an Excel or zip", b"MATLAB": "a MATLAB"}
    for magic, kind in kinds.items():
        if data.startswith(magic):
            raise RecordError(
                f"{path}: this is {kind} file named .csv; rename it or export it as CSV"
            )
    if data.startswith((b"\xff\xfe", b"\xfe\xff")) or _looks_utf16(data[:200]):
        raise RecordError(f"{path}: the text is UTF-16; save it as UTF-8 (CSV UTF-8)")
    if re.search(rb"[\x00-\x08\x0e-\x1a\x1c-\x1f]", data[:65536]):
        raise RecordError(_binary(path))


def _refuse_no_text(path: Path, text: bytes, number: int) -> None:
    if b"\x00" in text:
        raise RecordError(_binary(path))
    if not text.isascii():
        try:
            text.decode("utf-8")
        except UnicodeDecodeError as error:
            line = number + text.count(b"\n", 0, error.start)
            raise RecordError(
                f"{path}: line {line}: byte 0x{text[error.start]:02x} is not UTF-8; "
                "save the file as UTF-8"
            ) from None


def _binary(path: Path) -> str:
    return f"{path}: this is a binary file, not CSV; export the record as CSV text"


def _looks_utf16(start: bytes) -> bool:
    """Every second byte zero and no other: UTF-16 without a BOM."""
    zeros = sorted((start[::2].count(0), start[1::2].count(0)))
    return len(start) >= 8 and zeros[0] == 0 and zeros[1] >= 0.45 * len(start)


# --- header ------------------------------------------------------------------------------------


def _find_header(path: Path, block: _Block, comments: list[str]) -> tuple[str | None, int]:
    """The header line and the offset behind it; comments above it are added to the others."""
    start = 0
    while start < len(block.text):
        end = block.text.find(b"\n", start)
        end = len(block.text) if end < 0 else end
        line = block.text[start:end].decode("utf-8").strip()
        start = end + 1
        if line.startswith("#"):
            comments.append(line.lstrip("#").strip())
        elif line:
            if start > len(block.text):
                raise RecordError(
                    f"{path}: only one line ({quoted(line)}) and no data; "
                    "give a header line and rows below it"
                )
            return line, start
    return None, start


def _split_header_line(
    path: Path, line: str, number: int, comments: list[str], body: bytes
) -> tuple[str, ...]:
    """Header cells; RecordError for another delimiter or for numbers in place of names."""
    names = {";": "semicolons", "\t": "tabs", "|": "bars"}
    other = max(names, key=line.count)
    if line.count(other) > line.count(","):
        comma = re.search(rb"\d,\d", body) is not None
        also = " and with a point, not a comma, in the numbers" if comma else ""
        raise RecordError(
            f"{path}: line {number}: columns are separated by {names[other]}; "
            f"write them with commas{also}"
        )
    cells = tuple(_cells(path, number, line))
    if len(cells) == 1 and len(line.split()) > 1 and not re.search(r"[\[(]", line):
        raise RecordError(
            f"{path}: line {number}: columns are separated by blanks; write them with commas"
        )
    if all(is_number(cell) for cell in cells):
        hint = ""
        if comments and len(comments[-1].split(",")) == len(cells):
            hint = f" (the comment above, {quoted(comments[-1])}, may be it: remove its '#')"
        raise RecordError(
            f"{path}: line {number}: no header, the first line holds numbers ({quoted(line)}); "
            f"add a line such as time,displacement,force{hint}"
        )
    return cells


# --- rows --------------------------------------------------------------------------------------


def _columns(path: Path, block: _Block, width: int) -> list[pl.Series]:
    """The columns of a block as text; none where it has no data line."""
    # what polars gets: no comments, no blank lines
    body = block.text.rstrip(b" \t\n")
    if b"#" in body:
        body = re.sub(rb"(?m)^[ \t]*#[^\n]*(\n|\Z)", b"", body).rstrip()
    blank = (b"\n\n", b"\n ", b"\n\t")
    if body[:1].isspace() or any(mark in body for mark in blank):
        body = re.sub(rb"(?m)^[ \t]*\n", b"", body)
    if not body:
        return []
    names = [f"c{index}" for index in range(width)]

    # quoted cells are rare and take the slow reader, which knows blanks around quotes
    if b'"' in body:
        cells = zip(*_split_rows(path, block, width), strict=True)
        return [pl.Series(n, c, dtype=pl.String) for n, c in zip(names, cells, strict=True)]

    # count the commas, which is fast; look at single lines only when the count is off
    if body.count(b",") != (body.count(b"\n") + 1) * (width - 1):
        _split_rows(path, block, width)
    try:
        frame = pl.read_csv(BytesIO(body), has_header=False, schema=dict.fromkeys(names, pl.String))
    except pl.exceptions.PolarsError as error:
        # a long row can hide behind a short one in the count
        _split_rows(path, block, width)
        reason = str(error).splitlines()[0]
        raise RecordError(f"{path}: not readable as CSV ({reason}); write it again") from None
    return frame.get_columns()


def _data_lines(block: _Block) -> Iterator[tuple[int, str]]:
    """Line number and text of every line that is neither blank nor a comment."""
    for number, line in enumerate(block.text.split(b"\n"), start=block.number):
        text = line.strip()
        if text and not text.startswith(b"#"):
            yield number, text.decode("utf-8")


def _data_lines_of(path: Path) -> Iterator[tuple[int, str]]:
    """The same of a whole file, the header first."""
    for block in _blocks(path):
        yield from _data_lines(block)


def _cells(path: Path, number: int, line: str) -> list[str]:
    """Cells of one line."""
    try:
        return next(csv.reader([line], skipinitialspace=True))
    except csv.Error as error:
        raise RecordError(f"{path}: line {number}: not CSV ({error}); correct the line") from None


def _split_rows(path: Path, block: _Block, width: int) -> list[list[str]]:
    """Cells of every data row; RecordError for the first that has not `width` of them."""
    lines = list(_data_lines(block))
    rows: list[list[str]] = []
    for index, (number, line) in enumerate(lines, start=1):
        cells = _cells(path, number, line)
        if len(cells) == width:
            rows.append(cells)
            continue
        advice = "correct or remove the line"
        if len(cells) > width and all(re.fullmatch(r"\s*[+-]?\d*([eE][+-]?\d+)?\s*", c)
                                      for c in cells):  # fmt: skip
            advice = "numbers with decimal commas? write them with a point, such as 0.5"
        elif block.last and index == len(lines) and len(cells) < width:
            advice = "it is the last line, the file may be cut off: remove the line"
        raise RecordError(
            f"{path}: line {number}: {len(cells)} cells where the header has {width} "
            f"({quoted(line)}); {advice}"
        )
    return rows
