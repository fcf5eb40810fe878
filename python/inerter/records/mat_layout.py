"""What a MAT-file of version 5 holds, told by its tags, before anything of it is unpacked.

The file is a row of elements: a tag of 8 bytes (kind and size), then the data. A variable is a
matrix, plain or packed by zlib: class, dimensions and name, then numbers, or other matrices. The
sizes in the tags are those that a reader believes, so they are what is looked at.
"""

from __future__ import annotations

import math
import zlib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO, Literal

from .bounds import VALUES, refuse_more, refuse_packing
from .record import RecordError

# matrices within matrices; scipy reads them by recursion, in which a stack has an end
DEEPEST = 100
MOST_PARTS = 200_000
"""Matrices within cells and structs; each takes some 200 bytes in Python."""

# numbers of the format: kinds of elements, classes of matrices that hold others
_MATRIX, _COMPRESSED = 14, 15
_KINDS = (1, 2, 3, 4, 5, 6, 7, 9, 12, 13, 14, 16, 17, 18)
_NO_NUMBERS = (1, 2, 3, 4, 5, 17)  # cell, struct, object, characters, sparse, opaque
_HEAD = 512  # bytes in which class, dimensions and the beginning of the name stand
_PIECE = 1 << 16

Order = Literal["little", "big"]


@dataclass(frozen=True)
class Variable:
    """A variable: name, shape, whether it is a matrix of numbers; where it is in the file."""

    name: str
    shape: tuple[int, ...]
    is_number: bool
    start: int = 0
    size: int = 0
    packed: bool = False
    order: Order = "little"

    @property
    def is_vector(self) -> bool:
        """Whether it is a column by itself."""
        return self.is_number and math.prod(self.shape) > 1

    @property
    def rows(self) -> int:
        """Values of a vector."""
        return math.prod(self.shape) if self.is_number else 0


def variables(path: Path) -> Iterator[Variable]:
    """The variables of a file of version 5; none of another format.

    Raises
    ------
    RecordError
        The file ends within one.
    """
    with path.open("rb") as file:
        end = file.seek(0, 2)
        file.seek(0)
        head = file.read(128)
        orders: dict[bytes, Order] = {b"IM": "little", b"MI": "big"}
        order = orders.get(head[126:128])
        if order is None:
            return
        while len(tag := file.read(8)) == 8:
            kind, size = _tag(tag, order)
            start = file.tell()
            if start + size > end:
                raise RecordError(f"{path}: the file is cut off; copy it again")
            if kind != _COMPRESSED:
                _refuse_kind(kind)
            if kind in (_COMPRESSED, _MATRIX):
                data = file.read(min(size, _HEAD))
                if kind == _COMPRESSED:
                    data = zlib.decompressobj().decompress(data, _HEAD)[8:]
                name, shape, is_number = _described(data, order)
                yield Variable(name, shape, is_number, start, size, kind == _COMPRESSED, order)
            file.seek(start + size)


def refuse_layout(path: Path, needed: Sequence[Variable]) -> None:
    """Raise RecordError for what is deeper, larger or in more parts than is read.

    Data are unpacked piece by piece and forgotten.
    """
    total = parts = 0
    with path.open("rb") as file:
        for variable in needed:
            file.seek(variable.start)
            if not variable.size:
                continue
            data = _Data(file, variable)
            depth = _Depth(path, parts + 1)
            for place, kind, size in _elements(data, variable.order, 8 if variable.packed else 0):
                depth.see(place, kind, size)
                sofar = total + place + size * (kind != _MATRIX)
                refuse_more(path, VALUES, sofar / 8)
                refuse_packing(path, sofar)
            parts, total = depth.parts, total + data.passed


class _Depth:
    """How deep matrices stand within matrices, and how many there are."""

    def __init__(self, path: Path, parts: int) -> None:
        self.path, self.parts, self.ends = path, parts, [math.inf]

    def see(self, place: int, kind: int, size: int) -> None:
        """An element whose data begin at a place."""
        while self.ends and place > self.ends[-1]:
            self.ends.pop()
        if kind != _MATRIX:
            return
        self.ends.append(place + size)
        self.parts += 1
        if len(self.ends) > DEEPEST + 1:
            raise RecordError(
                f"{self.path}: cells within cells, more than {DEEPEST} deep; save numeric vectors"
            )
        if self.parts > MOST_PARTS:
            raise RecordError(
                f"{self.path}: cells or structs of more than {MOST_PARTS} parts; save numeric "
                "vectors"
            )


class _Data:
    """The unpacked data of a variable, from the beginning to the end, never kept."""

    def __init__(self, file: BinaryIO, variable: Variable) -> None:
        self.file, self.left = file, variable.size
        self.unpacking = zlib.decompressobj() if variable.packed else None
        self.ready, self.at, self.passed = b"", 0, 0

    def _more(self) -> bool:
        """Have the next piece ready; False at the end."""
        while self.at == len(self.ready):
            piece, zipped = b"", self.unpacking
            if zipped is not None:
                piece = zipped.unconsumed_tail
            if not piece:
                piece = self.file.read(min(self.left, _PIECE))
                self.left -= len(piece)
            self.at, self.ready = 0, piece if zipped is None else zipped.decompress(piece, _PIECE)
            if not piece and not self.ready:
                return False
        return True

    def read(self, count: int) -> bytes:
        """So many bytes, or fewer at the end."""
        found = b""
        while len(found) < count and self._more():
            piece = self.ready[self.at : self.at + count - len(found)]
            self.at += len(piece)
            found += piece
        self.passed += len(found)
        return found

    def skip(self, count: int) -> int:
        """Pass over so many bytes; how many there were."""
        before = self.passed
        if self.unpacking is None and count > len(self.ready) - self.at:
            jump = min(count - (len(self.ready) - self.at), self.left)
            self.passed += len(self.ready) - self.at + jump
            self.file.seek(jump, 1)
            self.left -= jump
            self.at = len(self.ready)
        while self.passed - before < count and self._more():
            taken = min(count - (self.passed - before), len(self.ready) - self.at)
            self.passed, self.at = self.passed + taken, self.at + taken
        return self.passed - before


def _elements(data: _Data, order: Order, start: int) -> Iterator[tuple[int, int, int]]:
    """Where the data of each element begin, its kind and size; into matrices, over the others.

    ValueError where the data end within one.
    """
    data.skip(start)
    while len(tag := data.read(8)) == 8:
        kind, size = _tag(tag, order)
        _refuse_kind(kind & 0xFFFF)
        if kind > 0xFFFF:
            continue  # a small element: its data stand in the tag
        yield data.passed, kind, size
        if kind != _MATRIX and data.skip(size + -size % 8) < size:
            raise ValueError(f"an element of {size} bytes is cut off")


def _refuse_kind(kind: int) -> None:
    """ValueError for a kind that there is not: scipy looks it up without asking."""
    if kind not in _KINDS:
        raise ValueError(f"an element of kind {kind}")


def _tag(data: bytes, order: Any) -> tuple[int, int]:
    return int.from_bytes(data[:4], order), int.from_bytes(data[4:8], order)


def _described(data: bytes, order: Order) -> tuple[str, tuple[int, ...], bool]:
    """Name and shape of a matrix by its first bytes, and whether it holds numbers."""
    parts: list[bytes] = []
    place = 0
    while len(parts) < 3 and place + 8 <= len(data):
        kind, size = _tag(data[place : place + 8], order)
        _refuse_kind(kind & 0xFFFF)
        if kind > 0xFFFF:
            size = kind >> 16
            parts.append(data[place + 4 : place + 4 + min(size, 4)])
            place += 8
        else:
            parts.append(data[place + 8 : place + 8 + size])
            place += 8 + size + -size % 8
    if len(parts) < 3 or len(parts[0]) < 8:
        return "", (), False
    flags = int.from_bytes(parts[0][:4], order)
    shape = tuple(
        int.from_bytes(parts[1][i : i + 4], order) for i in range(0, len(parts[1]) - 3, 4)
    )
    is_number = flags & 0xFF not in _NO_NUMBERS
    return parts[2].decode("latin-1"), shape, is_number
