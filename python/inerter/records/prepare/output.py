"""The files of a preparation: all of them or none."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from io import BytesIO
from pathlib import Path
from typing import Any, Literal

import polars as pl

import inerter
from inerter.folder import write_files
from inerter.printable import printable
from inerter.records.prepare.options import Options
from inerter.records.prepare.picture import picture
from inerter.records.prepare.pipeline import PreparedRecord
from inerter.records.record import RecordError, TimeRecord
from inerter.records.turning import own_columns

SCHEMA = "inerter.preparation/1"
FILE = "preparation.json"
Format = Literal["csv", "parquet"]


def summary(
    prepared: Sequence[PreparedRecord], options: Options, form: Format = "csv"
) -> dict[str, Any]:
    """What was asked, done and found, for JSON."""
    rows = []
    for p, name in zip(prepared, file_names(prepared), strict=True):
        rows.append(
            {
                "name": p.source.name,
                "source": str(p.source.source) if p.source.source else None,
                "file": f"{name}.{form}",
                "picture": f"{name}.png",
                "samples": [p.source.samples, p.record.samples],
                "sample_rate": [p.source.sample_rate, p.record.sample_rate],
                **p.found,
                "warnings": _warnings(p.source),
                "warnings_after": _warnings(p.record),
            }
        )
    asked = {
        "denoise": options.denoise,
        "channels": list(options.channels) if options.denoise != "none" else [],
        "noise": options.noise,
        "derivatives": options.derivatives,
        "cutoff": options.cutoff,
        "delay": options.delay,
        "resample": options.rate,
    }
    return {"schema": SCHEMA, "options": asked, "records": rows}


def _warnings(record: TimeRecord) -> list[dict[str, str]]:
    return [{"code": w.code, "text": w.text} for w in record.warnings]


def file_names(prepared: Sequence[PreparedRecord]) -> list[str]:
    """File names, without extension, of the records: what a file may be called, all different."""
    names: list[str] = []
    for i, p in enumerate(prepared):
        name = re.sub(r"[^\w.+-]+", "_", p.source.name).strip("._") or f"record_{i + 1}"
        while name.casefold() in [other.casefold() for other in names]:
            name += "_2"
        names.append(name)
    return names


def table(record: TimeRecord) -> pl.DataFrame:
    """The columns of a record: time, the channels in SI units, then further columns as read."""
    columns = {"time": record.time, **own_columns(record), **record.extra}
    return pl.DataFrame({name: pl.Series(values) for name, values in columns.items()})


def record_csv(prepared: PreparedRecord) -> str:
    """Text of a prepared record; its comments say what was done."""
    notes = [*prepared.source.comments, *_history(prepared)]
    # names come from files: the text must be one that can be read again
    head = "".join(f"# {printable(' '.join(note.split()))}\n" for note in notes)
    return head + table(prepared.record).write_csv()


def _history(prepared: PreparedRecord) -> list[str]:
    found = prepared.found
    lines = [f"prepared by inerter {inerter.__version__} from {prepared.source.name}; SI units"]
    if found["delay"] and found["delay"]["applied"]:
        lines.append(f"force moved by {-found['delay']['applied']:.6g} s")
    for name, said in found["denoised"].items():
        lines.append(
            f"{name} denoised by {said['method']}: {said['removed_rms']:.4g} rms taken away"
        )
    if found["derivatives"] and found["derivatives"]["columns"]:
        names = " and ".join(found["derivatives"]["columns"])
        lines.append(
            f"{names} not measured: from displacement, cut-off "
            f"{found['derivatives']['cutoff']:.4g} Hz"
        )
    return lines


def write_prepared(
    prepared: Sequence[PreparedRecord], options: Options, folder: Path, form: Format = "csv"
) -> list[str]:
    """Write NAME.csv (or .parquet) and NAME.png of every record, and preparation.json.

    Everything is written into a temporary folder first and moved when complete.

    Returns
    -------
    list of str
        The files, relative to the folder.

    Raises
    ------
    RecordError
        A file would replace one of the records themselves.
    OSError
        The folder cannot be written.
    """
    said = summary(prepared, options, form)
    sources = {p.source.source.resolve() for p in prepared if p.source.source}
    for row in said["records"]:
        if (folder / row["file"]).resolve() in sources:
            raise RecordError(
                f"{folder / row['file']}: this is the record itself; choose another folder by --out"
            )
    files: dict[str, bytes | str] = {}
    for p, row in zip(prepared, said["records"], strict=True):
        files[row["file"]] = _content(p, form)
        files[row["picture"]] = picture(p)
    files[FILE] = (json.dumps(said, indent=2, allow_nan=False) + "\n").encode()
    return write_files(folder, files)


def _content(prepared: PreparedRecord, form: Format) -> bytes:
    if form == "csv":
        return record_csv(prepared).encode("utf-8", "replace")
    target = BytesIO()
    table(prepared.record).write_parquet(target)
    return target.getvalue()
