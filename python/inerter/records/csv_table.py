"""CSV to a raw table, a block of lines at a time, with errors that say which line and what to do.

A file may be larger than the memory would bear as text: what is kept of a block are its numbers.
"""

from __future__ import annotations

import csv
import itertools
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from io import BytesIO
from pathlib import Path

import numpy as np
import polars as pl

from .bounds import Wanted, refuse_header, refuse_table
from .raw_table import OddCell, RawTable, is_number, quoted, to_numbers
from .record import Array, RecordError
from .units import split_header

BLOCK = 1 << 24  # bytes that are read at a time
LONGEST_LINE = 1 << 22  # bytes
LONGEST_PREAMBLE = 1 << 23  # bytes of blanks and comments above the header


@dataclass(frozen=True)
class _Block:
    """Whole lines of a UTF-8 text: the number of the first, and whether the file ends with them."""

    number: int
    text: bytes
    last: bool


def read_csv(path: Path, wanted: Wanted) -> RawTable:
    """The raw table of a CSV file; RecordError when it cannot be read or has too much."""
    comments: list[str] = []
    table: _Growing | None = None
    above = 0
    for block in _blocks(path):
        start = 0
        if table is None:
            line, start = _find_header(path, block, comments)
            above += start
            if line is None and above > LONGEST_PREAMBLE:
                raise RecordError(
                    f"{path}: no header in the first {LONGEST_PREAMBLE >> 20} MB, blanks and "
                    "comments only; take them out"
                )
            if line is None:
                continue
            number = block.number + block.text.count(b"\n", 0, start) - 1
            body = block.text[start : start + 4096]
            header = _split_header_line(path, line, number, comments, body)
            table = _Growing(path, header, wanted)
        number = block.number + block.text.count(b"\n", 0, start)
        table.add(_Block(number, block.text[start:], block.last))
    if table is None:
        raise RecordError(
            f"{path}: the file is empty (blanks and comments only); add header and data"
        )
    return table.done(comments)


class _Growing:
    """The wanted columns of a table whose rows come block by block."""

    def __init__(self, path: Path, header: tuple[str, ...], wanted: Wanted) -> None:
        refuse_header(path, header)
        self.path, self.header, self.rows = path, header, 0
        self.wanted = [index for index, name in enumerate(header) if wanted(name)]
        # names of runs stay what they are
        self.as_text = {index for index in self.wanted if split_header(header[index])[0] == "run"}
        self.numbers: dict[int, list[Array]] = {index: [] for index in self.wanted}
        self.texts: dict[int, list[pl.Series]] = {index: [] for index in self.as_text}
        self.odd: dict[int, OddCell] = {}

    def add(self, block: _Block) -> None:
        """Take in the data lines of a block."""
        columns, rows = _columns(self.path, block, len(self.header), self.wanted)
        if rows:
            self._refuse_long(block, rows)
        for index, column in columns.items():
            if index in self.as_text:
                self.texts[index].append(column)
                continue
            values, bad = to_numbers(column)
            self.numbers[index].append(values)
            if len(bad) and index not in self.odd:
                cells = _cells_of_row(self.path, block, int(bad[0]))
                self.odd[index] = OddCell(self.rows + int(bad[0]), cells)
        self.rows += rows

    def _refuse_long(self, block: _Block, rows: int) -> None:
        """RecordError where there is too much, or a first block tells that there will be."""
        refuse_table(self.path, self.rows + rows, len(self.wanted))
        if not self.rows:
            whole = rows * self.path.stat().st_size / len(block.text)
            refuse_table(self.path, whole, len(self.wanted), slack=1.5)

    def done(self, comments: list[str]) -> RawTable:
        """The table of all blocks; gives its own rows away."""
        columns = {}
        for index in self.wanted:
            numbers, texts = self.numbers.pop(index), self.texts.get(index, [])
            name = self.header[index]
            if index in self.as_text or not numbers:
                columns[index] = pl.concat([pl.Series(name, [], dtype=pl.String), *texts])
            else:
                columns[index] = pl.Series(name, np.concatenate(numbers))
        lines = partial(_data_lines_of, self.path)
        return RawTable(
            path=self.path,
            header=self.header,
            columns=columns,
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


def _columns(
    path: Path, block: _Block, width: int, wanted: Sequence[int]
) -> tuple[dict[int, pl.Series], int]:
    """The wanted columns of a block as text by index, and the number of data lines."""
    # what polars gets: no comments, no blank lines
    body = block.text.rstrip(b" \t\n")
    if b"#" in body:
        body = re.sub(rb"(?m)^[ \t]*#[^\n]*(\n|\Z)", b"", body).rstrip()
    blank = (b"\n\n", b"\n ", b"\n\t")
    if body[:1].isspace() or any(mark in body for mark in blank):
        body = re.sub(rb"(?m)^[ \t]*\n", b"", body)
    if not body:
        return {}, 0
    rows = body.count(b"\n") + 1

    # quoted cells are rare and take the slow reader, which knows blanks around quotes
    if b'"' in body:
        texts: dict[int, list[str]] = {index: [] for index in wanted}
        count = 0
        for cells in _rows(path, block, width):
            count += 1
            for index in wanted:
                texts[index].append(cells[index])
        return {i: pl.Series(f"c{i}", t, dtype=pl.String) for i, t in texts.items()}, count

    # count the commas, which is fast; look at single lines only when the count is off
    if body.count(b",") != rows * (width - 1):
        _refuse_ragged(path, block, width)
    if not wanted:
        return {}, rows
    names = [f"c{index}" for index in range(width)]
    try:
        frame = pl.read_csv(
            BytesIO(body),
            has_header=False,
            schema=dict.fromkeys(names, pl.String),
            columns=list(wanted),
        )
    except pl.exceptions.PolarsError as error:
        # a long row can hide behind a short one in the count
        _refuse_ragged(path, block, width)
        reason = str(error).splitlines()[0]
        raise RecordError(f"{path}: not readable as CSV ({reason}); write it again") from None
    return dict(zip(wanted, frame.get_columns(), strict=True)), rows


def _data_lines(block: _Block) -> Iterator[tuple[int, str]]:
    """Line number and text of every line that is neither blank nor a comment."""
    for number, line in enumerate(BytesIO(block.text), start=block.number):
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


def _rows(path: Path, block: _Block, width: int) -> Iterator[list[str]]:
    """Cells of every data row; RecordError for the first that has not `width` of them."""
    behind = _data_lines(block)
    ahead = next(behind, None)
    while ahead is not None:
        (number, line), ahead = ahead, next(behind, None)
        cells = _cells(path, number, line)
        if len(cells) == width:
            yield cells
            continue
        advice = "correct or remove the line"
        if len(cells) > width and all(re.fullmatch(r"\s*[+-]?\d*([eE][+-]?\d+)?\s*", c)
                                      for c in cells):  # fmt: skip
            advice = "numbers with decimal commas? write them with a point, such as 0.5"
        elif block.last and ahead is None and len(cells) < width:
            advice = "it is the last line, the file may be cut off: remove the line"
        raise RecordError(
            f"{path}: line {number}: {len(cells)} cells where the header has {width} "
            f"({quoted(line)}); {advice}"
        )


def _refuse_ragged(path: Path, block: _Block, width: int) -> None:
    """RecordError for the first data row that has not `width` cells."""
    for _ in _rows(path, block, width):
        pass


def _cells_of_row(path: Path, block: _Block, row: int) -> tuple[str, ...]:
    """The stripped cells of a data row of a block, from 0."""
    number, line = next(itertools.islice(_data_lines(block), row, None))
    return tuple(cell.strip() for cell in _cells(path, number, line))
