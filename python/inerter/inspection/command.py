"""`inerter inspect`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer
from rich.table import Column, Table

from inerter.console import AsJson, Folder, out, progress_bar, refusing
from inerter.records.options import told_reading, with_reading

FILES = ("inspection.json", "inspection.png", "inspection.html")


@with_reading
def inspect_command(
    record: Annotated[
        list[str],
        typer.Argument(
            metavar="RECORD", help="Records: files, folders or globs; any known format."
        ),
    ],
    out_dir: Folder = Path("out/inspection"),
    as_json: AsJson = False,
    stated: Any = None,
) -> None:
    """Say what records hold and what they could tell, before any diagnosis.

    Channels with ranges, noise, steps, bands, hum and filters; strokes and how well they repeat;
    what a device could be known by, and the motion that would tell more. Writes inspection.json,
    inspection.png and inspection.html.

    \b
    Examples:
      inerter inspect run_1.csv
      inerter inspect card.csv --with servo.csv --column force='-200 N/V * u'
      inerter inspect runs/*.tdms --json
    """
    from inerter.folder import json_text, write_files
    from inerter.inspection.facts import SCHEMA, facts_of
    from inerter.inspection.page import page
    from inerter.inspection.picture import picture
    from inerter.records import read_records

    with refusing(out_dir, *FILES):
        with told_reading(**stated) as tell:
            records = read_records(record)
            tell()
        with progress_bar("inspecting", as_json) as progress:
            facts = []
            for index, each in enumerate(records):
                progress(index / len(records))
                facts.append(facts_of(each))
        said = {"schema": SCHEMA, "records": [each.json() for each in facts]}
        drawn = picture(facts)
        contents: tuple[str | bytes, ...] = (json_text(said), drawn, page(facts, drawn))
        write_files(out_dir, dict(zip(FILES, contents, strict=True)))
    if as_json:
        print(json_text(said), end="")
        return
    for each in facts:
        _print(each)
    out.print(f"Written to {out_dir}: {', '.join(FILES)}")


def _print(facts: Any) -> None:
    from inerter.inspection.facts import clock_words, motion_words
    from inerter.inspection.page import CHANNEL_HEADER, channel_rows
    from inerter.inspection.tells import clauses

    record = facts.record
    out.print(f"{record.name}: {clock_words(facts)}", style="bold", highlight=False)
    table = Table(Column(CHANNEL_HEADER[0], no_wrap=True, min_width=12), *CHANNEL_HEADER[1:])
    for row in channel_rows(facts):
        table.add_row(*row)
    out.print(table)
    if facts.motion is not None:
        out.print(f"motion: {motion_words(facts.motion, facts.record.motion)}", highlight=False)
    for clause in clauses(facts.tells):
        out.print(f"- {clause}", highlight=False)
    for warning in record.warnings:
        out.print(f"{warning.code}: {warning.text}", highlight=False)
