"""Text to a raw table, a block of lines at a time, with errors that say which line and what to do.

A file may be larger than the memory would bear as text: what is kept of a block are its numbers.
"""

from __future__ import annotations

import codecs
import csv
import itertools
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from io import BytesIO
from pathlib import Path

import numpy as np
import polars as pl

from .bounds import Wanted, refuse_header, refuse_table
from .clocks import clock_seconds, counted, without_day_breaks
from .decimation import Decimator
from .decimation import told as decimated
from .header import guess
from .raw_table import OddCell, RawTable, is_number, quoted, to_numbers
from .record import Array, RecordError
from .text_layout import Asked, Layout, cells_of, encoding_of, find_layout, pointed
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


def read_text(
    path: Path,
    wanted: Wanted,
    asked: Asked | None = None,
    progress: Callable[[Path, float], None] = lambda path, share: None,
) -> RawTable:
    """The raw table of a text file; RecordError when it cannot be read or has too much."""
    layout = find_layout(path, asked)
    if layout is not None:
        _refuse_no_header(path, layout)
        table = _Growing(path, layout, wanted, asked.decimate if asked else 1)
        size, read = path.stat().st_size, 0
        for block in _blocks(path, layout):
            table.add(_from_line(block, layout.first))
            read += len(block.text)
            progress(path, read / max(size, read))
        return table.done()
    return _read_plain(path, wanted)


def _read_plain(path: Path, wanted: Wanted) -> RawTable:
    """A text at whose beginning no table was found, taken as CSV: most often for its error."""
    comments: list[str] = []
    table: _Growing | None = None
    above = 0
    with path.open("rb") as file:
        encoding, mark = encoding_of(file.read(4096)) or ("utf-8", 0)
    plain = Layout(encoding=encoding, mark=mark)
    for block in _blocks(path, plain):
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
            header = _split_header_line(path, line, number, comments)
            plain = replace(plain, header=header, header_line=number, comments=tuple(comments))
            table = _Growing(path, plain, wanted)
        number = block.number + block.text.count(b"\n", 0, start)
        table.add(_Block(number, block.text[start:], block.last))
    if table is None:
        raise RecordError(
            f"{path}: the file is empty (blanks and comments only); add header and data"
        )
    return table.done()


def _from_line(block: _Block, first: int) -> _Block:
    """The lines of a block from a number on."""
    start = 0
    for _ in range(first - block.number):
        start = block.text.find(b"\n", start) + 1
        if not start:
            return _Block(first, b"", block.last)
    return _Block(max(first, block.number), block.text[start:], block.last)


class _Growing:
    """The wanted columns of a table whose rows come block by block."""

    def __init__(self, path: Path, layout: Layout, wanted: Wanted, by: int = 1) -> None:
        header = layout.header
        refuse_header(path, header)
        self.path, self.header, self.rows, self.layout = path, header, 0, layout
        self.wanted = [index for index, name in enumerate(header) if wanted(name)]
        # names of runs stay what they are
        self.as_text = {index for index in self.wanted if split_header(header[index])[0] == "run"}
        self.numbers: dict[int, list[Array]] = {index: [] for index in self.wanted}
        self.texts: dict[int, list[pl.Series]] = {index: [] for index in self.as_text}
        self.odd: dict[int, OddCell] = {}
        self.clocks: set[int] = set()
        self.by = by
        if by > 1 and self.as_text:
            raise RecordError(f"{path}: a file with a column 'run' is not decimated; split it")
        self.decimators = {index: Decimator(by) for index in self.wanted}

    def add(self, block: _Block) -> None:
        """Take in the data lines of a block."""
        columns, rows = _columns(self.path, block, self.layout, self.wanted)
        if rows:
            self._refuse_long(block, rows)
        for index, column in columns.items():
            if index in self.as_text:
                self.texts[index].append(column)
                continue
            values, bad = to_numbers(pointed(column, self.layout))
            if len(bad) and (seconds := clock_seconds(column)) is not None:
                values, bad = seconds, bad[:0]
                self.clocks.add(index)
            self.numbers[index].append(self.decimators[index].add(values))
            if len(bad) and index not in self.odd:
                cells = _cells_of_row(self.path, block, int(bad[0]), self.layout.separator)
                self.odd[index] = OddCell(self.rows + int(bad[0]), cells)
        self.rows += rows

    def _refuse_long(self, block: _Block, rows: int) -> None:
        """RecordError where there is too much, or a first block tells that there will be."""
        refuse_table(self.path, (self.rows + rows) / self.by, len(self.wanted))
        if not self.rows:
            whole = rows * self.path.stat().st_size / len(block.text)
            refuse_table(self.path, whole / self.by, len(self.wanted), slack=1.5)

    def done(self) -> RawTable:
        """The table of all blocks; gives its own rows away."""
        columns = {}
        for index in self.wanted:
            numbers, texts = self.numbers.pop(index), self.texts.get(index, [])
            name = self.header[index]
            if index in self.as_text or not numbers:
                columns[index] = pl.concat([pl.Series(name, [], dtype=pl.String), *texts])
                continue
            values = np.concatenate(numbers)
            columns[index] = pl.Series(
                name, without_day_breaks(values) if index in self.clocks else values
            )
        header, layout = self.header, self.layout
        rows = len(next(iter(columns.values()), ())) if self.by > 1 else self.rows
        if layout.interval is not None and rows:
            step = layout.interval * self.by
            header, columns = counted(header, columns, rows, replace(layout, interval=step))
        elif self.by > 1 and self.wanted and not rows:
            raise RecordError(
                f"{self.path}: {self.rows} rows are too few for --decimate {self.by}; take less"
            )
        return RawTable(
            path=self.path,
            header=header,
            columns=columns,
            comments=self.layout.comments,
            told=", ".join(t for t in (layout.told(), decimated(self.by)) if t),
            separator=self.layout.separator,
            odd=self.odd,
            lines=partial(_data_lines_of, self.path, layout) if self.by == 1 else None,
            decimated=self.by,
        )


def _refuse_no_header(path: Path, layout: Layout) -> None:
    """RecordError for numbers in place of names."""
    if layout.header and not all(is_number(c.replace(",", ".")) for c in layout.header):
        return
    comments = layout.comments
    hint = ""
    if comments and any(guess(cell) for cell in cells_of(comments[-1], layout.separator)):
        hint = f" (the comment above, {quoted(comments[-1])}, may be it: remove its '#')"
    line = next((t for n, t in _data_lines_of(path, layout) if n >= layout.first), "")
    raise RecordError(
        f"{path}: line {layout.first}: no header, the first line holds numbers ({quoted(line)}); "
        f"add a line such as time,displacement,force{hint}"
    )


# --- text --------------------------------------------------------------------------------------


def _blocks(path: Path, layout: Layout) -> Iterator[_Block]:
    """The text as UTF-8 in whole lines that end in a line feed, without a byte order mark.

    RecordError for anything but text.
    """
    number, rest = 1, b""
    strip = re.compile(layout.strip.encode()) if layout.strip else None
    left = (layout.stop if layout.stop is not None else path.stat().st_size) - layout.mark
    decoder = None
    if layout.encoding != "utf-8":
        decoder = codecs.getincrementaldecoder(layout.encoding)("replace")
    with path.open("rb") as file:

        def read() -> bytes:
            nonlocal left
            data = file.read(max(0, min(BLOCK, left)))
            left -= len(data)
            return data if decoder is None else decoder.decode(data, left <= 0).encode()

        start = file.read(layout.mark)
        chunk = read()
        _refuse_binary(path, start + chunk)
        while chunk or rest:
            ahead = read()
            text = rest + chunk
            # line ends of any system; one that is cut in two waits for its other half
            cut = text.endswith(b"\r") and bool(ahead)
            if b"\r" in text:
                text = text[: len(text) - cut].replace(b"\r\n", b"\n").replace(b"\r", b"\n")
            stop = text.rfind(b"\n") + 1 if ahead else len(text)
            rest = text[stop:] + b"\r" * cut
            text = text[:stop]
            _refuse_no_text(path, text, number)
            if strip is not None:
                text = strip.sub(b"", text)
            if b"\x00" in rest or len(rest) > LONGEST_LINE:
                raise RecordError(_binary(path))
            if text or not ahead:
                yield _Block(number, text, not ahead)
            number += text.count(b"\n")
            chunk = ahead
            if not ahead:
                return


def _refuse_binary(path: Path, data: bytes) -> None:
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


def _split_header_line(path: Path, line: str, number: int, comments: list[str]) -> tuple[str, ...]:
    """Header cells; RecordError for numbers in place of names."""
    cells = tuple(_cells(path, number, line, ","))
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
    path: Path, block: _Block, layout: Layout, wanted: Sequence[int]
) -> tuple[dict[int, pl.Series], int]:
    """The wanted columns of a block as text by index, and the number of data lines."""
    width, separator = len(layout.header), layout.separator
    # what polars gets: no comments, no blank lines
    body = block.text.rstrip(b" \t\n" if separator != "\t" else b" \n")
    if b"#" in body:
        body = re.sub(rb"(?m)^[ \t]*#[^\n]*(\n|\Z)", b"", body).rstrip()
    blank = (b"\n\n", b"\n ", b"\n\t")
    if body[:1].isspace() or any(mark in body for mark in blank):
        body = re.sub(rb"(?m)^[ \t]*\n", b"", body)
    if not body:
        return {}, 0
    rows = body.count(b"\n") + 1
    # some programs end the lines with a separator, others pad their columns
    if separator == " ":
        body = re.sub(rb"(?m)^ +| +$", b"", re.sub(rb"[ \t]+", b" ", body))

    # quoted cells are rare and take the slow reader, which knows blanks around quotes
    if b'"' in body:
        texts: dict[int, list[str]] = {index: [] for index in wanted}
        count = 0
        for cells in _rows(path, block, width, separator):
            count += 1
            for index in wanted:
                texts[index].append(cells[index])
        return {i: pl.Series(f"c{i}", t, dtype=pl.String) for i, t in texts.items()}, count

    # count the separators, which is fast; look at single lines only when the count is off
    if body.count(separator.encode()) != rows * (width - 1):
        body = _evened(path, block, width, separator)
    if not wanted:
        return {}, rows
    names = [f"c{index}" for index in range(width)]
    try:
        frame = pl.read_csv(
            BytesIO(body),
            has_header=False,
            separator=separator,
            schema=dict.fromkeys(names, pl.String),
            columns=list(wanted),
        )
    except pl.exceptions.PolarsError as error:
        # a long row can hide behind a short one in the count
        _evened(path, block, width, separator)
        reason = str(error).splitlines()[0]
        raise RecordError(f"{path}: not readable as text ({reason}); write it again") from None
    return dict(zip(wanted, frame.get_columns(), strict=True)), rows


def _data_lines(block: _Block) -> Iterator[tuple[int, str]]:
    """Line number and text of every line that is neither blank nor a comment.

    Tabs at its ends stay: they may part cells that are empty.
    """
    for number, line in enumerate(BytesIO(block.text), start=block.number):
        text = line.strip(b" \r\n\f\v")
        if text.strip() and not text.lstrip().startswith(b"#"):
            yield number, text.decode("utf-8")


def _data_lines_of(path: Path, layout: Layout) -> Iterator[tuple[int, str]]:
    """The same of a whole file, the header first."""
    above = layout.header_line or layout.first - 1
    for block in _blocks(path, layout):
        for number, line in _data_lines(block):
            if number >= above and not above < number < layout.first:
                yield number, line


def _cells(path: Path, number: int, line: str, separator: str) -> list[str]:
    """Cells of one line."""
    if separator == " " and '"' not in line:
        return line.split()
    if separator != "\t":
        line = line.strip()
    try:
        return next(csv.reader([line], delimiter=separator, skipinitialspace=True))
    except csv.Error as error:
        raise RecordError(f"{path}: line {number}: not CSV ({error}); correct the line") from None


def _rows(path: Path, block: _Block, width: int, separator: str) -> Iterator[list[str]]:
    """Cells of every data row; RecordError for the first that has not `width` of them.

    Empty cells at the end may be too many, or too few: where all before them are there.
    """
    behind = _data_lines(block)
    ahead = next(behind, None)
    while ahead is not None:
        (number, line), ahead = ahead, next(behind, None)
        cells = _cells(path, number, line, separator)
        while len(cells) > width and not cells[-1].strip():
            cells.pop()
        if len(cells) == width:
            yield cells
            continue
        advice = "correct or remove the line"
        if (
            separator == ","
            and len(cells) > width
            and all(re.fullmatch(r"\s*[+-]?\d*([eE][+-]?\d+)?\s*", c) for c in cells)
        ):
            advice = "numbers with decimal commas? write them with a point, such as 0.5"
            if len(cells) == 2 * width:
                halves = [".".join(pair) for pair in zip(cells[::2], cells[1::2], strict=True)]
                advice = (
                    f"{len(cells)} whole numbers, or {width} with decimal commas "
                    f"({', '.join(halves)[:60]})? write the numbers with a point, or export with "
                    "semicolons"
                )
        elif block.last and ahead is None and len(cells) < width:
            advice = "it is the last line, the file may be cut off: remove the line"
        raise RecordError(
            f"{path}: line {number}: {len(cells)} cells where the header has {width} "
            f"({quoted(line)}); {advice}"
        )


def _evened(path: Path, block: _Block, width: int, separator: str) -> bytes:
    """The rows of a block with `width` cells each; RecordError for one that has others."""
    sign = separator
    lines = (sign.join(cells) for cells in _rows(path, block, width, separator))
    return "\n".join(lines).encode()


def _cells_of_row(path: Path, block: _Block, row: int, separator: str) -> tuple[str, ...]:
    """The stripped cells of a data row of a block, from 0."""
    number, line = next(itertools.islice(_data_lines(block), row, None))
    return tuple(cell.strip() for cell in _cells(path, number, line, separator))
