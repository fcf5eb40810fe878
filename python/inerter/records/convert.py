"""`inerter convert`: any readable file as the record format."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path
from typing import Annotated, Any

import typer

from inerter.console import AsJson, Folder, out, refuse, refusing, status
from inerter.records.options import told_reading, with_reading

FILE = "conversion.json"
SCHEMA = "inerter.conversion/1"


@with_reading
def convert_command(
    record: Annotated[
        list[str],
        typer.Argument(
            metavar="RECORD", help="Records: files, folders or globs; any known format."
        ),
    ],
    form: Annotated[
        str, typer.Option("--format", metavar="FORMAT", help="What to write: csv or parquet.")
    ] = "csv",
    out_dir: Folder = Path("out/converted"),
    as_json: AsJson = False,
    stated: Any = None,
) -> None:
    """Write any readable file as the record format: SI units, one file for each run.

    The comments of each file say where it comes from and how it was read. Writes NAME.csv (or
    NAME.parquet) and conversion.json.

    \b
    Examples:
      inerter convert test.xlsx --out records
      inerter convert card.csv --with servo.csv --column force='-200 N/V * u'
    """
    from inerter.folder import file_names, json_text, write_files
    from inerter.records import read_records

    if form not in ("csv", "parquet"):
        refuse(f"--format is {form!r}; take csv or parquet")
    with refusing(out_dir, FILE):
        with status(as_json) as progress, told_reading(**stated) as tell:
            progress("reading")
            records = read_records(record)
            tell()
        rows = []
        files: dict[str, bytes | str] = {}
        sources = {r.source.resolve() for r in records if r.source}
        for each, name in zip(records, file_names([r.name for r in records], "run"), strict=True):
            target = f"{name}.{form}"
            if (out_dir / target).resolve() in sources:
                refuse(f"{out_dir / target}: this is the record itself; choose another --out")
            files[target] = _content(each, form)
            rows.append(
                {
                    "name": each.name, "source": str(each.source), "file": target,
                    "samples": each.samples, "reading": each.reading,
                    "columns": ["time", *each.channels(), *each.extra]
                    if each.kind != "table" else [each.required[0], *each.channels()],
                    "warnings": [{"code": w.code, "text": w.text} for w in each.warnings],
                }
            )  # fmt: skip
        said = {"schema": SCHEMA, "records": rows}
        files[FILE] = json_text(said)
        write_files(out_dir, files)
    if as_json:
        print(json_text(said), end="")
        return
    for row in rows:
        out.print(f"{row['file']}: {row['samples']} samples, {', '.join(row['columns'][:12])}")
    out.print(f"Written to {out_dir}: {len(rows)} records, {FILE}")


def _content(record: Any, form: str) -> bytes:
    import polars as pl

    import inerter
    from inerter.printable import printable
    from inerter.records.parquet_table import NOTES
    from inerter.records.turning import own_columns

    first = record.required[0]
    columns = {first: getattr(record, first), **own_columns(record)}
    columns |= {n: v for n, v in record.extra.items() if n.strip() and n not in columns}
    frame = pl.DataFrame({name: pl.Series(values) for name, values in columns.items()})
    notes = [
        *record.comments,
        f"converted by inerter {inerter.__version__} from {record.source.name}; SI units",
    ]
    if record.reading:
        notes.append(f"read as: {record.reading}")
    notes = [printable(" ".join(note.split())) for note in notes]
    if form == "parquet":
        target = BytesIO()
        frame.write_parquet(target, metadata={NOTES: "\n".join(notes)})
        return target.getvalue()
    head = "".join(f"# {note}\n" for note in notes)
    return (head + frame.write_csv()).encode("utf-8", "replace")
