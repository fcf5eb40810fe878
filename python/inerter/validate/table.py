"""A validation in the terminal."""

from __future__ import annotations

from rich.console import Console
from rich.table import Table
from rich.text import Text

from inerter.validate import bounds
from inerter.validate.result import Validation
from inerter.validate.run import QUANTITIES
from inerter.validate.task import ValidationRow

_ENGINES = {"mujoco": "MuJoCo", "exudyn": "Exudyn"}


def print_validation(validation: Validation, console: Console) -> None:
    """Print the summary, the long runs, and what misses its bound."""
    console.print(_summary(validation))
    if validation.headline:
        console.print(_headline(validation))
    for row in validation.missed:
        console.print(_missed(row), soft_wrap=True)
    count = len(validation.all_rows)
    verdict = (
        f"all {count} results are within their bounds"
        if not validation.missed
        else f"{len(validation.missed)} of {count} results are not within their bounds"
    )
    console.print(Text(f"{verdict}; {validation.seconds:.0f} s", style="bold"))
    if validation.json()["versions"]["exudyn"] is None:
        advice = "Exudyn is not installed and was left out: pip install exudyn (the extra exudyn)"
        console.print(Text(advice))


def _summary(validation: Validation) -> Table:
    table = _table("Largest error against the reference, relative to the largest value")
    for name in ("integrator", "laws"):
        table.add_column(name, no_wrap=True)
    _add_numbers(table, "order", "within")
    for group in validation.summary:
        order = group["order"]
        style = "" if not group["missed"] else "bold red"
        table.add_row(
            f"{_ENGINES[group['engine']]} {group['integrator']}",
            "smooth" if group["kind"] == "smooth" else "others",
            *(_number(group["errors"][quantity]) for quantity in QUANTITIES),
            "" if order is None else f"{order[0]:.1f}",
            Text(f"{group['rows'] - group['missed']}/{group['rows']}", style=style),
        )
    return table


def _headline(validation: Validation) -> Table:
    seconds = validation.headline[0].duration
    table = _table(f"Smooth models over {seconds:g} s; {bounds.AGREEMENT:g} is asked for")
    for name in ("model", "integrator"):
        table.add_column(name, no_wrap=True)
    _add_numbers(table)
    for row in validation.headline:
        table.add_row(
            f"{row.model} {row.layout}",
            f"{_ENGINES[row.engine]} {row.integrator}",
            *(_number(row.errors[quantity]) for quantity in QUANTITIES),
        )
    return table


def _add_numbers(table: Table, *more: str) -> None:
    for name in ("x", "v", "force", "state", "energy", *more):
        table.add_column(name, justify="right", no_wrap=True)


def _missed(row: ValidationRow) -> Text:
    where = f"{row.model} {row.layout}, {row.law}, {row.input}, {_ENGINES[row.engine]} "
    where += f"{row.integrator}: "
    if not row.bound:
        return Text(where + (row.note or ""), style="red")
    beyond = [
        f"{name} {row.errors[name]:.2g} (bound {row.bound[name]:.2g})"
        for name in bounds.beyond(row.errors, row.bound)
    ]
    order = "" if row.order is None else f"order {row.order:.1f}"
    return Text(where + ", ".join(beyond or [order]), style="red")


def _table(title: str) -> Table:
    return Table(
        title=title,
        title_justify="left",
        title_style="bold",
        box=None,
        padding=(0, 1, 0, 0),
        header_style="dim",
    )


def _number(value: float | None) -> str:
    return "" if value is None else f"{value:.0e}"
