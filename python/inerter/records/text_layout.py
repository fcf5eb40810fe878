"""How a text holds a table: encoding, separator, decimal mark, preamble, header, units, footer.

Looked at are the beginning and the end of a file. A layout that is the only one possible is taken;
where two readings are possible, both are shown and the user is asked.
"""

from __future__ import annotations

import codecs
import csv
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import polars as pl

from .header import guess
from .header_rows import Heading, heading, is_clock
from .raw_table import MISSING_WORDS, SPREADSHEET_ERROR
from .record import RecordError

HEAD = 1 << 18  # bytes at the beginning that are looked at
TAIL = 1 << 13  # and at the end
MOST_PREAMBLE = 400  # lines above the data

SEPARATORS = {",": "comma", ";": "semicolon", "\t": "tab", "|": "bar", " ": "blanks"}
DECIMALS = {".": "point", ",": "comma"}

_POINT = re.compile(r"(?:[+-] *)?(?:\d+\.?\d*|\.\d+)(?:[eEdD][+-]?\d+)?")
_COMMA = re.compile(r"[+-]?(?:\d+,?\d*|,\d+)(?:[eEdD][+-]?\d+)?")
_COMMA_GROUPED = re.compile(r"[+-]?\d{1,3}(?:\.\d{3})+,\d+")
_POINT_GROUPED = re.compile(r"[+-]?\d{1,3}(?:,\d{3})+\.\d+")
_UNSURE = re.compile(r"[+-]?[1-9]\d{0,2},\d{3}")
_COMMENTS = "#%"
_MISSING = {*MISSING_WORDS, "-"}


# encodings that are tried where a text is no UTF-8, and what people call them
_CALLED = {
    "cp1252": "Latin-1", "gb18030": "GB 18030", "cp932": "Shift-JIS", "cp1251": "Windows-1251",
    "cp1250": "Windows-1250",
}  # fmt: skip
# what the serial monitor of a microcontroller writes before lines, and its plotter before values
_MONITOR = r"(?m)^[ \t]*\d{2}:\d{2}:\d{2}\.\d{3} -> ?"
_LABEL = r"[A-Za-z_][\w ]*:(?=\s*[-+.\d])"
_LABELLED = re.compile(rf"\s*(?:{_LABEL}\s*[-+.\deE]+[\s,;]*){{2,}}")


@dataclass(frozen=True, kw_only=True)
class Layout:
    """How a text is laid out.

    header: names with their units in brackets; header_line: number of the line that names, first:
    number of the first data line, both from 1; stop: byte of the file behind the last data line;
    comments: lines above the header; interval, start [s]: of a clock that only the preamble states;
    footer: lines below the data that are left out; preamble: lines above the names, blanks and
    comments not counted; strip: pattern of what a logger writes before lines or values; in_comment:
    whether a comment names the columns.
    """

    encoding: str = "utf-8"
    mark: int = 0
    separator: str = ","
    decimal: str = "."
    grouped: bool = False
    header: tuple[str, ...] = ()
    header_line: int = 0
    first: int = 0
    units_line: int | None = None
    comments: tuple[str, ...] = ()
    interval: float | None = None
    start: float | None = None
    stop: int | None = None
    footer: int = 0
    preamble: int = 0
    strip: str = ""
    in_comment: bool = False

    def told(self) -> str:
        """How the text was read, in words; empty where nothing of it is out of the ordinary."""
        parts = []
        if self.encoding not in ("utf-8", "ascii"):
            parts.append(_CALLED.get(self.encoding, self.encoding.upper()))
        if self.separator != ",":
            parts.append(SEPARATORS[self.separator])
        if self.decimal != ".":
            parts.append("decimal comma")
        if self.in_comment:
            parts.append(f"names from the comment in line {self.header_line}")
        if self.strip:
            parts.append("times of the monitor left out" if self.strip == _MONITOR
                         else "names from the labels")  # fmt: skip
        if self.preamble:
            parts.append(f"{self.preamble} preamble line" + "s" * (self.preamble > 1))
        if self.units_line:
            parts.append(f"units from line {self.units_line}")
        if self.interval is not None:
            parts.append(f"a sample every {self.interval:g} s")
        if self.footer:
            parts.append(f"{self.footer} footer line" + "s" * (self.footer > 1) + " left out")
        return ", ".join(parts)


@dataclass(frozen=True)
class Asked:
    """What the user says of a text: its separator and decimal mark, None where he does not.

    decimate: of how many rows one is kept, behind a low-pass.
    """

    separator: str | None = None
    decimal: str | None = None
    decimate: int = 1


def cells_of(line: str, separator: str) -> list[str]:
    """Cells of one line, stripped; csv.Error where it is none."""
    if separator == " " and '"' not in line:
        return line.split()
    if '"' not in line:
        return [cell.strip() for cell in line.split(separator)]
    reader = csv.reader([line], delimiter=separator, skipinitialspace=True)
    return [cell.strip() for cell in next(reader, [])]


def pointed(column: pl.Series, layout: Layout) -> pl.Series:
    """Texts with a decimal point, without groups of digits."""
    if column.dtype != pl.String:
        return column
    if layout.grouped:
        column = column.str.replace_all("." if layout.decimal == "," else ",", "", literal=True)
    if layout.decimal == ",":
        column = column.str.replace_all(",", ".", literal=True)
    return column


def encoding_of(head: bytes) -> tuple[str, int] | None:
    """Encoding of a text and the length of its mark; None where it is no text."""
    for mark, name in (
        (b"\xef\xbb\xbf", "utf-8"), (b"\xff\xfe\x00\x00", "utf-32-le"),
        (b"\xff\xfe", "utf-16-le"), (b"\xfe\xff", "utf-16-be"),
    ):  # fmt: skip
        if head.startswith(mark):
            return name, len(mark)
    even, odd = head[:400:2].count(0), head[1:400:2].count(0)
    half = max(1, len(head[:400]) // 2)
    if len(head) >= 8 and max(even, odd) >= 0.45 * half and min(even, odd) <= 0.05 * half:
        return ("utf-16-le" if odd > even else "utf-16-be"), 0
    if re.search(rb"[\x00-\x08\x0e-\x1a\x1c-\x1f]", head):
        return None
    try:
        # a character may be cut in two at the end
        head.decode("utf-8") if len(head) < HEAD else head[:-4].decode("utf-8", "strict")
    except UnicodeDecodeError as error:
        if error.start >= len(head) - 8 and len(head) >= HEAD:
            return "utf-8", 0
        return _older_encoding(head)
    return "utf-8", 0


def _older_encoding(head: bytes) -> tuple[str, int] | None:
    """The encoding in which the lines name most of our quantities; of equals Latin-1."""
    best, most = None, -1
    for encoding in _CALLED:
        decoder = codecs.getincrementaldecoder(encoding)()
        try:
            text = decoder.decode(head, final=len(head) < HEAD)
        except UnicodeDecodeError:
            continue
        odd = [line for line in re.split(r"[\r\n]+", text)[:MOST_PREAMBLE] if not line.isascii()]
        known = sum(
            guess(cell) is not None for line in odd for cell in re.split(r"[;,\t|]", line)
            if len(cell) < 60
        ) + sum(
            guess(cell) is not None for line in odd for cell in re.split(r"[;\t|]", line)
            if len(cell) < 60
        )  # fmt: skip
        if known > most:
            best, most = encoding, known
    return None if best is None else (best, 0)


def find_layout(path: Path, asked: Asked | None = None) -> Layout | None:
    """The layout of a text file; None where its beginning holds no table.

    Raises
    ------
    RecordError
        Two readings are possible, or what the user says of it cannot be.
    """
    asked = asked or Asked()
    with path.open("rb") as file:
        head = file.read(HEAD)
        size = file.seek(0, 2)
        found = encoding_of(head)
        if found is None:
            return None
        encoding, mark = found
        file.seek(max(mark, size - TAIL - (size - TAIL) % 2))
        tail = file.read()
    whole = size <= HEAD
    text = head[mark:].decode(encoding, "replace").replace("\r\n", "\n").replace("\r", "\n")
    lines = text.split("\n")
    if not whole:
        lines = lines[:-1]
    strip, labels = _before_values(lines)
    if strip:
        lines = [re.sub(strip, "", line) for line in lines]
    layout = _best(path, [line.strip(" \ufeff") for line in lines], asked)
    if layout is None:
        return None
    layout = replace(layout, encoding=encoding, mark=mark, strip=strip)
    if labels:
        layout = replace(layout, header=labels, header_line=layout.first - 1, preamble=0)
    return _without_footer(layout, tail, encoding, size)


def _before_values(lines: Sequence[str]) -> tuple[str, tuple[str, ...]]:
    """What a serial monitor writes before lines or values, as a pattern; names from the latter."""
    full = [line for line in lines if line.strip()]
    if len(full) > 2 and 2 * sum(bool(re.match(_MONITOR, line)) for line in full) > len(full):
        return _MONITOR, ()
    labelled = [line for line in full[:200] if _LABELLED.fullmatch(line)]
    if len(labelled) > 2 and 2 * len(labelled) > len(full[:200]):
        names = [tuple(n[:-1].strip() for n in re.findall(_LABEL, line)) for line in labelled]
        if len(set(names)) == 1:
            return _LABEL, names[0]
    return "", ()


# --- rows and columns --------------------------------------------------------------------------


@dataclass(frozen=True)
class _Rows:
    """Cells of each line under one separator; None for blanks and comments."""

    separator: str
    cells: list[list[str] | None]
    first: int  # index of the first data line
    width: int
    count: int

    @property
    def named(self) -> bool:
        """Whether the line above the data has a name for each column."""
        above = [cells for cells in self.cells[: self.first] if cells]
        return bool(above) and len(above[-1]) == self.width


def _best(path: Path, lines: Sequence[str], asked: Asked) -> Layout | None:
    tried = [asked.separator] if asked.separator else list(SEPARATORS)
    found = [rows for sep in tried if (rows := _rows(lines, sep)) is not None]
    if not found:
        return None
    # the separator with which most lines are data; of equals the one that is tried first
    rows = max(found, key=lambda each: (each.count, each.named))
    body = [
        cells for cells in rows.cells[rows.first :] if cells and _is_data(cells)
        and len(cells) == rows.width
    ]  # fmt: skip
    decimal, grouped = _decimal(path, rows.separator, body, asked)
    head = heading(rows.cells[: rows.first], rows.width, body[:3])
    commented = None
    beside = _beside_labels(body[:40])
    if beside is not None:
        head = Heading(beside)
    elif len(head.names) != rows.width or all(is_value(name) for name in head.names):
        commented = _comment_names(lines[: rows.first], rows.separator, rows.width)
    if commented is not None:
        head = replace(head, names=commented[0], line=commented[1], top=0)
    comments = tuple(
        text.lstrip("#").strip() for text in lines[: head.line - 1 if head.line else rows.first]
        if text.strip()
    )[:MOST_PREAMBLE]  # fmt: skip
    return Layout(
        separator=rows.separator,
        decimal=decimal,
        grouped=grouped,
        header=head.names,
        header_line=head.line,
        first=rows.first + 1,
        units_line=head.units_line,
        comments=comments,
        interval=head.interval,
        start=head.start,
        preamble=sum(cells is not None for cells in rows.cells[: max(head.top - 1, 0)]),
        in_comment=commented is not None,
    )


def _beside_labels(body: Sequence[Sequence[str]]) -> tuple[str, ...] | None:
    """Names where an oscilloscope wrote what it knows into the first columns, beside the values."""
    if not body or body[0][0].casefold() != "record length" or len(body[0]) < 5:
        return None
    stated = {row[0].casefold(): row[1] for row in body if row[0]}
    time = f"time [{stated.get('horizontal units') or 's'}]"
    value = f"{stated.get('source') or 'value'} [{stated.get('vertical units') or 'V'}]"
    return ("", "", "", time, value, *[""] * (len(body[0]) - 5))


def _comment_names(
    lines: Sequence[str], separator: str, width: int
) -> tuple[tuple[str, ...], int] | None:
    """Names in the lowest comment that has one for each column, two known ones among them."""
    for number in range(len(lines), 0, -1):
        text = lines[number - 1].strip()
        if not text or text[0] not in _COMMENTS:
            continue
        text = text.lstrip(_COMMENTS).strip()
        for split in (separator, "\t", ";", ",", r"\s{2,}", r"\s+"):
            names = tuple(
                cell.strip().strip('"')
                for cell in re.split(
                    r"\s+" if split == " " else split if len(split) > 1 else re.escape(split), text
                )
            )
            if len(names) == width and sum(guess(name) is not None for name in names) >= 2:
                return names, number
    return None


def layout_of_cells(cells: Sequence[list[str] | None]) -> tuple[Heading, int] | None:
    """Heading and index of the first data row of a table that has cells already (a sheet)."""
    found = _first_data([c if c and any(c) else None for c in cells])
    if found is None:
        return None
    first, width, _ = found
    body = [row for row in cells[first:] if row and _is_data(row)][:3]
    return heading(list(cells[:first]), width, body), first


def _rows(lines: Sequence[str], separator: str) -> _Rows | None:
    cells: list[list[str] | None] = []
    for line in lines:
        if not line or line[0] in _COMMENTS:
            cells.append(None)
            continue
        try:
            cells.append(cells_of(line, separator))
        except csv.Error:
            cells.append([line])
    found = _first_data(cells)
    return None if found is None else _Rows(separator, cells, *found)


def _first_data(cells: Sequence[list[str] | None]) -> tuple[int, int, int] | None:
    """Index of the first data row, its width, and how many rows are data like it."""
    kinds = [0 if c is None else len(c) if _is_data(c) else -1 for c in cells]
    widths = Counter(kind for kind in kinds if kind > 0)
    if not widths:
        return None
    width = max(widths, key=lambda w: (widths[w], w))
    best, length, start, here, text_between = -1, 0, -1, 0, False
    for index, kind in enumerate([*kinds, -1]):
        if kind == width:
            start, here = (index, 1) if here == 0 else (start, here + 1)
            continue
        if here and (best < 0 or (text_between and here > 3 * length)):
            best, length, text_between = start, here, False
        here = here if kind == 0 else 0
        text_between = text_between or kind == -1
    return best, width, widths[width]


def is_value(cell: str) -> bool:
    """Whether a cell is a number in some way of writing, or says that there is none."""
    return (
        cell.casefold() in _MISSING
        or re.fullmatch(SPREADSHEET_ERROR, cell) is not None
        or _POINT.fullmatch(cell) is not None
        or _COMMA.fullmatch(cell) is not None
        or _COMMA_GROUPED.fullmatch(cell) is not None
        or _POINT_GROUPED.fullmatch(cell) is not None
        or is_clock(cell)
    )


def _is_data(cells: Sequence[str]) -> bool:
    """Two numbers at least and more numbers than texts, or one number and no text."""
    if len(cells) < 2:
        return False
    values = sum(map(is_value, cells))
    full = sum(bool(cell) and is_value(cell) for cell in cells)
    return (full >= 2 and 2 * values > len(cells)) or (full == 1 and values == len(cells))


def _decimal(
    path: Path, separator: str, body: Sequence[Sequence[str]], asked: Asked
) -> tuple[str, bool]:
    """The decimal mark, and whether the other one groups digits."""
    cells = [c for row in body for c in row if c and not is_clock(c)]
    commas = [c for c in cells if "," in c and (_COMMA.fullmatch(c) or _COMMA_GROUPED.fullmatch(c))]
    points = [c for c in cells if "." in c and _POINT.fullmatch(c)]
    both = [c for c in cells if "," in c and "." in c]
    if asked.decimal:
        return asked.decimal, bool(both) or bool(commas if asked.decimal == "." else points)
    if any(_COMMA_GROUPED.fullmatch(c) for c in both):
        return ",", True
    if any(_POINT_GROUPED.fullmatch(c) for c in both):
        return ".", True
    if not commas or (separator == "," and points) or points:
        return ".", False
    if all(_UNSURE.fullmatch(c) for c in commas):
        shown = commas[0]
        raise RecordError(
            f"{path}: {shown!r} may be {shown.replace(',', '.')} (decimal comma) or "
            f"{shown.replace(',', '')} (groups of thousands); say --decimal comma or "
            "--decimal point"
        )
    return ",", False


# --- the end -----------------------------------------------------------------------------------


def _without_footer(layout: Layout, tail: bytes, encoding: str, size: int) -> Layout:
    """The layout that ends before lines of text below the data."""
    end = size
    count = 0
    feed = "\n".encode(encoding)
    while tail and count <= 40:
        body = tail.removesuffix(feed)
        at = body.rfind(feed) + len(feed) if feed in body else 0
        if at == 0:
            break
        line = body[at:].decode(encoding, "replace").strip("\r\n ")
        line = re.sub(layout.strip, "", line) if layout.strip else line
        text = line.strip(layout.separator + " \t")
        if text and not text.startswith("#"):
            try:
                first = cells_of(text, layout.separator)[0]
            except (csv.Error, IndexError):
                break
            if is_value(first) or not re.search(r"[^\W\d]", text):
                break
            # a row of the table whose first cell is a text is none
            cells = cells_of(line, layout.separator)
            if _is_data(cells) or [c.casefold() for c in cells] == [
                re.sub(r"\s*\[.*", "", name).casefold() for name in layout.header
            ]:
                break
            count += 1
            stop = end - (len(tail) - at)
            layout = replace(layout, stop=stop, footer=count)
        end -= len(tail) - at
        tail = tail[:at]
    return layout
