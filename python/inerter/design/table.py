"""A design in the terminal."""

from __future__ import annotations

from rich.console import Console
from rich.table import Table
from rich.text import Text

from inerter.design.result import Design

_DEFAULTS = "default"


def print_design(design: Design, console: Console) -> None:
    """Print results, the measured comparison, trends, inputs left at their defaults and notes."""
    table = _table("result", "value>", "unit", "meaning")
    for figure in design.figures:
        table.add_row(figure.name, f"{figure.value:.5g}", figure.unit, figure.meaning)
    console.print(table)
    for name, rows in design.tables.items():
        console.print()
        heads = list(rows[0])
        shown = _table(*[head.replace("_", " ") + ">" for head in heads])
        for column, head in zip(shown.columns, heads, strict=True):
            words = [_cell(row[head]) for row in rows] + head.split("_")
            column.width = max(map(len, words))
        for row in rows:
            shown.add_row(*[_cell(row[head]) for head in heads])
        console.print(Text(name, style="bold"))
        console.print(shown)
    stated = [
        f"{name} {_cell(item['value'])} {item['unit']}".strip()
        for name, item in design.inputs.json().items()
        if item["source"].startswith(_DEFAULTS)
    ]
    console.print()
    if stated:
        console.print(Text("defaults: " + ", ".join(stated), style="dim"), soft_wrap=True)
    for note in design.notes:
        console.print(Text(note), soft_wrap=True)


def _table(*columns: str) -> Table:
    """A plain table; a name that ends in > is set to the right."""
    table = Table(box=None, padding=(0, 1, 0, 0), header_style="dim")
    for column in columns:
        table.add_column(column.rstrip(">"), justify="right" if column.endswith(">") else "left")
    return table


def _cell(value: object) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, (int, float)):
        return f"{value:.4g}"
    return "-" if value is None else str(value)
