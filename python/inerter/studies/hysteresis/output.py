"""The files of the study, and its summary in the terminal."""

from __future__ import annotations

import json
from pathlib import Path

from rich.console import Console
from rich.table import Table as Printed

from inerter.folder import write_files
from inerter.studies.hysteresis.figures import pictures
from inerter.studies.hysteresis.page import render
from inerter.studies.hysteresis.study import Study
from inerter.studies.hysteresis.tables import Table, crossed, searches


def json_text(study: Study) -> str:
    """What --json prints."""
    return json.dumps(study.json(), indent=2, allow_nan=False) + "\n"


def write_study(study: Study, folder: Path) -> list[str]:
    """Write hysteresis.json, hysteresis.html and the pictures; their names.

    Raises
    ------
    OSError
        The folder cannot be written.
    """
    drawn = pictures(study)
    files: dict[str, bytes | str] = {
        "hysteresis.json": json_text(study),
        "hysteresis.html": render(study, drawn),
    }
    return write_files(folder, files | drawn)


def print_study(study: Study, out: Console) -> None:
    """Verdicts, the table of held-out errors and that of the searches."""
    for each in study.conclusions:
        out.print(f"{each.verdict}: {each.statement}", style="bold", markup=False)
        out.print(f"  {each.evidence}\n", markup=False)
    for table in (crossed(study), searches(study)):
        out.print(_printed(table))


def _printed(table: Table) -> Printed:
    printed = Printed(title=table.title)
    for head in table.heads:
        printed.add_column(head)
    for row in table.rows:
        printed.add_row(*row)
    return printed
