"""How much of a file is read at most, whatever its format; each reader asks before it unpacks.

What is counted are the columns that are wanted (`Wanted`): others are left in the file.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from inerter.input_file import Bound

from .record import RecordError

# of one file: five hours at 1 kHz. Whoever works on a record needs some 1 kB per row
ROWS = Bound("INERTER_MOST_ROWS", 20_000_000, "rows")
# a bench has tens of channels, a vehicle on its bus some thousands
COLUMNS = Bound("INERTER_MOST_COLUMNS", 4_096, "columns")
# of all columns that are wanted together, 8 bytes each
VALUES = Bound("INERTER_MOST_VALUES", 100_000_000, "values")
# of the file as it lies on the disk
BYTES = Bound("INERTER_MOST_BYTES", 4 << 30, "bytes")

# of what is unpacked beside the file, beyond UNPACKED: what was measured does not pack so well
PACKING = Bound("INERTER_MOST_PACKING", 30, "times its size when unpacked")
UNPACKED = 100_000_000  # bytes

LONGEST_NAME = 200  # characters of a column's name
LONGEST_TEXT = 200  # characters of a cell that is a text: the name of a run

Wanted = Callable[[str], bool]
"""Whether a column of this header is to be read."""

_ADVICE = {
    ROWS: "take every n-th row behind a low-pass, such as --decimate 10, or give a part of it",
    COLUMNS: "leave out those that are no channels",
    VALUES: "leave out columns, or give a part of it",
    BYTES: "give a part of it",
    PACKING: "save it without compression",
}


def everything(header: str) -> bool:
    """Want every column."""
    del header
    return True


def refuse_more(path: Path, bound: Bound, found: float, slack: float = 1.0) -> None:
    """Raise RecordError where a file has more than a bound, `slack` times of it where estimated."""
    try:
        if found > slack * bound.most:
            raise RecordError(bound.refusal(path, found, _ADVICE[bound]))
    except RecordError:
        raise
    except ValueError as error:
        raise RecordError(str(error)) from None


def refuse_packing(path: Path, unpacked: float) -> None:
    """Raise RecordError for a small file with a large content [bytes]."""
    if unpacked > UNPACKED:
        refuse_more(path, PACKING, unpacked / max(path.stat().st_size, 1))


def refuse_header(path: Path, header: Sequence[str]) -> None:
    """Raise RecordError for too many columns, or a name that is none."""
    refuse_more(path, COLUMNS, len(header))
    for number, name in enumerate(header, start=1):
        if len(name) > LONGEST_NAME:
            raise RecordError(
                f"{path}: the name of column {number} has {len(name)} characters, at most "
                f"{LONGEST_NAME} are read; correct the header"
            )


def refuse_table(path: Path, rows: float, columns: int, slack: float = 1.0) -> None:
    """Raise RecordError for too many rows, or too many values in the columns that are wanted."""
    refuse_more(path, ROWS, rows, slack)
    refuse_more(path, VALUES, rows * columns, slack)
