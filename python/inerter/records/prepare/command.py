"""`inerter prepare`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.table import Table

from inerter.console import AsJson, Folder, number, out, parts_of, refuse, refusing, status
from inerter.measured_text import measured
from inerter.records.options import told_reading, with_reading


@with_reading
def prepare_command(
    record: Annotated[
        list[str],
        typer.Argument(
            metavar="RECORD", help="Records: files, folders or globs; any known format."
        ),
    ],
    denoise: Annotated[str, typer.Option(help="emd, savgol, lowpass, spline or none.")] = "none",
    channel: Annotated[
        list[str] | None,
        typer.Option(help="Columns to denoise, with commas or given again. Default: force."),
    ] = None,
    noise: Annotated[
        float | None,
        number("SI units", "Rms of the channel's white noise, SI units. Default: estimated."),
    ] = None,
    resample: Annotated[
        float | None, number("samples per second", "Samples per second of the result.")
    ] = None,
    derivatives: Annotated[
        bool,
        typer.Option("--derivatives", help="Add velocity and acceleration where not measured."),
    ] = False,
    cutoff: Annotated[
        float | None,
        number(
            "hertz",
            "Cut-off [Hz] of lowpass, derivatives and delay. Default: chosen from the data.",
        ),
    ] = None,
    delay: Annotated[
        str | None,
        typer.Option(help="Seconds by which the force is late, or 'auto' to estimate them."),
    ] = None,
    form: Annotated[str, typer.Option("--format", help="csv or parquet.")] = "csv",
    out_dir: Folder = Path("out/prepared"),
    as_json: AsJson = False,
    stated: Any = None,
) -> None:
    """Even out the clock of records, take out a delay, denoise, derive, resample; draw each.

    Writes NAME.csv (SI units), NAME.png and preparation.json. A diagnosis wants the records as
    measured: denoise for the eye, not for a fit.

    \b
    Examples:
      inerter prepare bench.csv --delay auto --derivatives
      inerter prepare runs/*.csv --denoise lowpass --channel force,displacement
    """
    from inerter.records import read_records
    from inerter.records.prepare.options import Options
    from inerter.records.prepare.output import FILE, Format, summary, write_prepared
    from inerter.records.prepare.pipeline import prepare_records

    forms: dict[str, Format] = {"csv": "csv", "parquet": "parquet"}
    if form not in forms:
        refuse(f"--format is {form!r}; take one of {', '.join(forms)}")
    with refusing(out_dir, "preparation.json"):
        chosen: dict[str, Any] = {"channels": parts_of(channel)} if channel else {}
        options = Options(
            denoise=denoise, noise=noise, rate=resample, derivatives=derivatives, cutoff=cutoff,
            delay=_delay(delay), **chosen,
        )  # fmt: skip
        with status(as_json) as progress:
            progress("reading")
            with told_reading(**stated) as tell:
                records = read_records(record)
                tell()
            progress("preparing")
            prepared = prepare_records(records, options)
            progress("writing")
            files = write_prepared(prepared, options, out_dir, forms[form])
    said = summary(prepared, options, forms[form])
    if as_json:
        print(json.dumps(said, indent=2, allow_nan=False))
        return
    _print(said)
    count = (len(files) - 1) // 2
    records = "1 record, a picture of it" if count == 1 else f"{count} records, a picture of each"
    out.print(f"Written to {out_dir}: {records}, {FILE}")


def _delay(given: str | None) -> float | str | None:
    if given is None or given == "auto":
        return given
    try:
        return float(given)
    except ValueError:
        return given


def _print(said: dict[str, Any]) -> None:
    table = Table(
        "record", "samples", "per second", "taken away (rms)", "delay [ms]", "derivatives"
    )
    for row in said["records"]:
        denoised = [
            f"{name}: {_taken(d)}, noise {d['noise']:.3g}" for name, d in row["denoised"].items()
        ]
        derived = row["derivatives"]
        table.add_row(
            row["name"],
            f"{row['samples'][1]}",
            f"{row['sample_rate'][1]:.6g}",
            "\n".join(denoised) or "-",
            _delay_text(row["delay"]),
            f"cut-off {derived['cutoff']:.3g} Hz" if derived else "-",
        )
    out.print(table)
    for row in said["records"]:
        for warning in row["warnings"]:
            out.print(f"{row['name']}: {warning['code']}: {warning['text']}", markup=False)
        for note in row["notes"]:
            out.print(f"{row['name']}: {note}", markup=False)


def _taken(denoised: dict[str, Any]) -> str:
    """Rms that a denoiser took away; what is rounding is nothing."""
    removed = denoised["removed_rms"]
    return f"{removed:.3g}" if removed > 1e-6 * denoised["noise"] else "nothing"


def _delay_text(delay: dict[str, Any] | None) -> str:
    if delay is None:
        return "-"
    if delay["how"] == "stated":
        return f"{1e3 * delay['applied']:.4g} as stated"
    mine = delay["this_record"]
    text = measured(1e3 * mine["value"], 1e3 * mine["stderr"], digits=2)
    return text if delay["significant"] else f"{text}, left as it is"
