"""A file of a program, and how its rows and stamps are written."""

from __future__ import annotations

import datetime
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from bench_files import DISPLACEMENT, FORCE, ROWS, Writer


@dataclass(frozen=True)
class Export:
    """A file of a program: what writes it, what a user states of it, or how it is refused.

    columns: `--column` texts; refused: part of the one line that refuses it; within: of the motion
    and the force, where the file itself keeps fewer digits or a clock of its own.
    """

    write: Writer
    columns: Sequence[str] = ()
    refused: str = ""
    within: tuple[float, float] = (2e-12, 1e-8)


# of what a scope sees: 10 mm and 100 N a volt
VOLTS = (100 * DISPLACEMENT, 0.01 * FORCE)


def scope(first: str = "CH1", second: str = "CH2") -> tuple[str, str]:
    """What a user states of two channels in volts."""
    return f"displacement=10 mm/V * {first}", f"force=100 N/V * {second}"


def rows(*columns: Any, separator: str = ",", form: str = "{:.9g}", decimal: str = ".",
         before: str = "", after: str = "") -> str:  # fmt: skip
    """Lines of columns of numbers, or of texts as they are."""
    made = []
    for cells in zip(*columns, strict=True):
        shown = [c if isinstance(c, str) else form.format(c).replace(".", decimal) for c in cells]
        made.append(before + separator.join(shown) + after)
    return "\n".join(made)


def stamps(form: str) -> list[str]:
    """Times of a day; %3 are milliseconds."""
    start = datetime.datetime(2024, 5, 3, 10, 40, 52)
    every = [start + datetime.timedelta(milliseconds=k) for k in range(ROWS)]
    return [at.strftime(form).replace("%3", f"{at.microsecond // 1000:03d}") for at in every]


MM = 1e3 * DISPLACEMENT
KN = 1e-3 * FORCE
