"""The optima in the terminal."""

from __future__ import annotations

from rich.console import Console
from rich.table import Table
from rich.text import Text

from inerter.suspension.indices import INDICES
from inerter.suspension.results import improvement, notes
from inerter.suspension.sweep import Row


def print_rows(rows: list[Row], console: Console) -> None:
    """Print a table of the optima, the peaks of J5 where they are few, and the remarks."""
    table = Table(box=None, padding=(0, 1, 0, 0), header_style="dim")
    for name in ("layout", "index", "series"):
        table.add_column(name, no_wrap=True)
    for name, unit in (
        ("k", "[kN/m]"), ("value", ""), ("unit", ""), ("over S1", "[%]"), ("c", "[N s/m]"),
        ("b", "[kg]"), ("k_b", "[kN/m]"),
    ):  # fmt: skip
        justify = "left" if name == "unit" else "right"
        table.add_column(f"{name}\n{unit}", justify=justify, no_wrap=True)
    gains = improvement(rows)
    for n, row in enumerate(rows):
        case, best = row.case, row.optimum
        spring = best.relaxation_stiffness
        table.add_row(
            case.layout,
            case.index,
            case.series,
            f"{case.stiffness / 1e3:g}",
            f"{best.value:.5g}",
            INDICES[case.index].unit,
            f"{gains[n]:.2f}" if n in gains else "",
            f"{best.damping:.5g}",
            f"{best.inertance:.5g}" if case.problem.network.has_inerter else "",
            "" if spring is None else f"{spring / 1e3:.5g}",
        )
    console.print(table)
    for row in rows if len(rows) <= 30 else []:
        if row.optimum.peaks:
            console.print(Text(_peaks(row), style="dim"), soft_wrap=True)
    for note in notes(rows):
        console.print(Text(note), soft_wrap=True)


def _peaks(row: Row) -> str:
    found = ", ".join(f"{g:.5g} at {f:.3g} Hz" for f, g in row.optimum.peaks)
    return f"{row.case.layout} {row.case.series}, peaks of J5 [m/N]: {found}"
