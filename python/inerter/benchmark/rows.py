"""Rows of a benchmark as tables, and its aims beside what was measured.

A row is a dict of texts and numbers, the same keys in every row of a benchmark. Some keys mean the
same everywhere: `ratio` (with its quartiles `ratio_lower`, `ratio_upper`), `aim`, a text such as
"<= 1.05" or ">= 20" for the ratio or None, and `met`, whether the ratio reaches it. Rows with an
aim have a `question` too: what is held against what. Where there is no ratio, the aim is one for
the `exponent`, or else for the `seconds`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from rich.box import SIMPLE_HEAD
from rich.table import Table

from inerter.benchmark.timing import Spread

Row = dict[str, Any]


def aimed(ratio: float, aim: str | None) -> dict[str, Any]:
    """The keys `aim` and `met` of a row.

    Parameters
    ----------
    ratio
        What was measured.
    aim
        "<= number" or ">= number", or None where there is no aim.

    Raises
    ------
    ValueError
        An aim of another form.
    """
    if aim is None:
        return {"aim": None, "met": None}
    relation, _, number = aim.partition(" ")
    if relation not in ("<=", ">="):
        raise ValueError(f"aim is {aim!r}; it is '<= number' or '>= number'")
    bound = float(number)
    return {"aim": aim, "met": bool(ratio <= bound if relation == "<=" else ratio >= bound)}


def spread_of(key: str, spread: Spread) -> dict[str, float]:
    """The keys `key`, `key_lower`, `key_upper` of a row: median and quartiles."""
    return {key: spread.median, f"{key}_lower": spread.lower, f"{key}_upper": spread.upper}


def table(title: str, rows: Sequence[Row]) -> Table:
    """Rows as a table; columns that are empty throughout and quartiles are left out."""
    shown = [
        key
        for key in rows[0]
        if not key.endswith(("_lower", "_upper")) and any(row[key] is not None for row in rows)
    ]
    made = Table(title=title or None, title_justify="left", box=SIMPLE_HEAD, pad_edge=False)
    for key in shown:
        numbers = all(isinstance(row[key], int | float | None) for row in rows)
        made.add_column(key.replace("_", " "), justify="right" if numbers else "left")
    for row in rows:
        made.add_row(*(_text(row, key) for key in shown))
    return made


def aims(results: Mapping[str, Sequence[Row]]) -> list[Row]:
    """The aims of benchmarks and what was measured: one row for each question of a benchmark.

    Rows with an aim have a `question`, a text; those of one question share an aim.
    """
    found: dict[tuple[str, str, str], list[Row]] = {}
    for name, rows in results.items():
        for row in rows:
            if row.get("aim") is not None:
                found.setdefault((name, row["question"], row["aim"]), []).append(row)
    return [
        {
            "benchmark": name, "question": question, "aim": aim,
            "met": f"{sum(row['met'] for row in rows)} of {len(rows)}",
            "least": min(map(_measured, rows)),
            "median": Spread.of([_measured(row) for row in rows]).median,
            "most": max(map(_measured, rows)),
        }
        for (name, question, aim), rows in found.items()
    ]  # fmt: skip


def _measured(row: Row) -> float:
    """What the aim of a row is about."""
    return next(row[key] for key in ("ratio", "exponent", "seconds") if row.get(key) is not None)


def _text(row: Row, key: str) -> str:
    value = row[key]
    if value is None:
        return ""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if not isinstance(value, float):
        return str(value)
    text = _number(value)
    if f"{key}_lower" in row and row[f"{key}_lower"] is not None:
        # half the distance of the quartiles, relative
        half = 0.5 * (row[f"{key}_upper"] - row[f"{key}_lower"])
        text += f" ±{100 * half / abs(value):.0f}%" if value else ""
    return text


def _number(value: float) -> str:
    """Three significant digits, without an exponent where that is short."""
    if not math.isfinite(value):
        return str(value)
    if value == 0 or 1e-3 <= abs(value) < 1e6:
        digits = 2 if value == 0 else max(0, 2 - math.floor(math.log10(abs(value))))
        return f"{value:.{digits}f}"
    return f"{value:.2e}"
