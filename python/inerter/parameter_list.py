"""The parameters of a device as lists, plain texts that are cut nowhere; needs no lab."""

from __future__ import annotations

import math
import textwrap
from typing import Any

from inerter.core import NumberList, Parameter, lists, parameters

UNSET, ANY = "unset", "any"
Entry = Parameter | NumberList


def chosen(part: str | None) -> list[Entry]:
    """Parameters and lists whose name, meaning or law has a part of a text; all for None.

    Raises
    ------
    ValueError
        None has.
    """
    everything: list[Entry] = [*parameters().values(), *lists().values()]
    if part is None:
        return everything
    wanted = part.casefold()
    named = [p for p in everything if wanted in p.name]
    found = named or [
        p for p in everything if wanted in p.meaning.casefold() or wanted in " ".join(p.laws)
    ]
    if not found:
        raise ValueError(f"no parameter has {part!r} in its name, meaning or laws; leave it out")
    return found


def rows(found: list[Entry]) -> list[dict[str, Any]]:
    """Parameters for JSON; what is not set or has no bound is null."""
    return [_row(p) for p in found]


def _row(p: Entry) -> dict[str, Any]:
    common = {"name": p.name, "unit": p.unit, "friction_laws": list(p.laws), "meaning": p.meaning}
    if isinstance(p, NumberList):
        return common | {"default": [], "most_numbers": p.most, "periods": p.periods}
    return common | {
        "default": _finite(p.initial),
        "lower": _finite(p.lower),
        "lower_open": p.lower_open,
        "upper": _finite(p.upper),
    }


def _finite(value: float) -> float | None:
    return float(value) if math.isfinite(value) and abs(value) < 1e300 else None


def _cells(p: Entry) -> tuple[str, str, str, str, str]:
    if isinstance(p, NumberList):
        most = f"1 to {p.most // 3} times 3" if p.periods else f"2 to {p.most}"
        return p.name, p.unit or "-", "none", f"{most} numbers", ",".join(p.laws) or "-"
    lower = f"{'>' if p.lower_open else '>='} {p.lower:g}" if p.lower > -1e300 else ""
    upper = f"<= {p.upper:g}" if p.upper < 1e300 else ""
    bounds = " ".join(part for part in (lower, upper) if part) or ANY
    initial = UNSET if p.initial != p.initial else f"{p.initial:g}"
    return p.name, p.unit or "-", initial, bounds, ",".join(p.laws) or "-"


_HEADER = ("name", "unit", "default", "range", "friction laws")


def text(found: list[Entry], width: int | None) -> str:
    """A line for each parameter; with a width [characters] its meaning wrapped below it.

    Without a width, for another program: columns apart by tabs, the meaning last.
    """
    if width is None:
        lines = ["\t".join((*_HEADER, "meaning"))]
        lines += ["\t".join((*_cells(p), p.meaning)) for p in found]
        return "\n".join(lines)
    table = [_HEADER, *map(_cells, found)]
    widths = [max(len(row[k]) for row in table) for k in range(4)]
    lines = []
    for k, row in enumerate(table):
        line = "  ".join(cell.ljust(size) for cell, size in zip(row, widths, strict=False))
        # the laws where there is room for them, else on a line of their own
        laws = row[4]
        if len(line) + 2 + len(laws) <= width:
            line = f"{line}  {laws}"
            laws = ""
        lines.append(line.rstrip())
        below = [] if k == 0 else [found[k - 1].meaning]
        below += [f"friction: {laws.replace(',', ', ')}"] if laws and laws != "-" and k else []
        for part in below:
            lines += textwrap.wrap(
                part, width, initial_indent="    ", subsequent_indent="    ",
                break_long_words=False, break_on_hyphens=False,
            )  # fmt: skip
    return "\n".join(lines)
