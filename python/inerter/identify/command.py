"""`inerter identify`: parameters of a device from bench records."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from inerter.console import AsJson, Filters, Folder, out, progress_bar, refusing
from inerter.core import WORDS
from inerter.records.options import told_reading, with_reading

_LAWS = ["ideal,viscous,coulomb,brown_mcphee,dahl,lugre,bouc_wen"]


@with_reading
def identify_command(
    record: Annotated[
        list[str],
        typer.Argument(
            metavar="RECORD",
            help="Records: files, folders or globs; several are fitted together.",
        ),
    ],
    law: Annotated[
        list[str],
        typer.Option(
            show_default="ideal, viscous, coulomb, brown_mcphee, dahl, lugre, bouc_wen",
            help="Laws, with commas or given again; parts joined by + as in "
            "lugre+series+offset. Laws: ideal, "
            "viscous, coulomb, stribeck, brown_mcphee, dahl, lugre, bouc_wen, bouc_wen_any, "
            "rate_state, fluid; parts: series, backlash, offset, stiffness, hardening, quadratic, "
            "load, asymmetry, position, variable, delay, play.",
        ),
    ] = _LAWS,
    fix: Annotated[
        list[str] | None, typer.Option(help="KEY=VALUE of a known parameter (SI); again for more.")
    ] = None,
    holdout: Annotated[
        list[str] | None, typer.Option(help="Name of a run to judge on; may be given again.")
    ] = None,
    filters: Filters = None,
    loss: Annotated[
        str, typer.Option(help="linear; or soft_l1, huber, cauchy: outliers count less.")
    ] = "linear",
    intervals: Annotated[
        str, typer.Option(help="profile, or normal: 1.96 standard errors, quicker.")
    ] = "profile",
    starts: Annotated[
        int | None, typer.Option(min=1, help="Starting points; default 24 per nonlinear parameter.")
    ] = None,
    simulate: Annotated[
        bool,
        typer.Option(
            "--simulate",
            help="Then fit the best law's motion under the measured force, without derivatives.",
        ),
    ] = False,
    scaled_by: Annotated[
        str | None,
        typer.Option(
            metavar="COLUMN",
            help="Instead: which parameters go with a further column of the records, such as a "
            "pressure or a voltage; of the other options --fix is known to it. Writes "
            "modulation.json and modulation.png.",
        ),
    ] = None,
    out_dir: Folder = Path("out/identification"),
    as_json: AsJson = False,
    stated: Any = None,
) -> None:
    """Find the parameters of a device, with errors, and compare laws on held-out data.

    Writes identification.json, identification.png, device.toml and model.xml of the best law.

    \b
    Examples:
      inerter identify runs/*.csv --law viscous,lugre+offset
      inerter identify bench.csv --fix inertance=113 --holdout slow
      inerter identify seals/*.csv --scaled-by pressure
    """
    if scaled_by is not None:
        others = {
            "--law": law != _LAWS, "--holdout": holdout, "--filter": filters,
            "--loss": loss != "linear", "--intervals": intervals != "profile",
            "--starts": starts is not None, "--simulate": simulate,
        }  # fmt: skip
        given = [name for name, is_given in others.items() if is_given]
        _modulation(record, scaled_by, fix or [], given, out_dir, as_json, stated)
        return
    from inerter.identify.channel_filter import stated_filters
    from inerter.identify.estimate import identify
    from inerter.identify.output import (
        json_text,
        print_identification,
        write_identification,
    )
    from inerter.identify.refine import simulated
    from inerter.records import read_records

    with refusing(out_dir, "identification.json", "identification.png", "device.toml"):
        with told_reading(**stated) as tell:
            records = read_records(record, "bench", others=False)
            tell()
        with progress_bar("identifying", as_json) as progress:
            result = identify(
                records, _names(law), fixed=_fixed(fix or []),
                filters=stated_filters(filters or ()), holdout=holdout or (), loss=loss,
                intervals=intervals, starts=starts, progress=progress,
            )  # fmt: skip
            if simulate:
                progress(1.0, f"simulating {result.best.law}")
                result = simulated(result)
        files = write_identification(result, out_dir)
    if as_json:
        print(json_text(result), end="")
        return
    print_identification(result, out)
    out.print(f"Written to {out_dir}: {', '.join(files)}")


def _modulation(
    record: list[str],
    channel: str,
    fix: list[str],
    others: list[str],
    folder: Path,
    as_json: bool,
    stated: dict[str, Any],
) -> None:
    from inerter.folder import json_text
    from inerter.identify.modulation import modulation
    from inerter.identify.modulation_output import json_of, print_modulation, write_modulation
    from inerter.records import Record, read_records

    with refusing(folder, "modulation.json", "modulation.png"):
        if others:
            raise ValueError(
                f"--scaled-by {channel} fits one linear law to all runs, and has no use for "
                f"{', '.join(others)}: leave out the one or the other"
            )
        with told_reading(**stated) as tell:
            records = read_records(record, "bench")
            tell()
        runs = [record for record in records if isinstance(record, Record)]
        found = modulation(runs, channel, _fixed(fix))
        files = write_modulation(found, folder)
    if as_json:
        print(json_text(json_of(found)), end="")
        return
    print_modulation(found, out)
    out.print(f"Written to {folder}: {', '.join(files)}")


def _names(given: list[str]) -> tuple[str, ...]:
    parts = (part.strip() for text in given for part in text.split(","))
    names = tuple(dict.fromkeys(part for part in parts if part))
    if not names:
        raise ValueError("--law is empty; see --help")
    return names


def _fixed(pairs: list[str]) -> dict[str, float | str]:
    """KEY=VALUE pairs; words for the names of laws."""
    found: dict[str, float | str] = {}
    for pair in pairs:
        key, sign, value = pair.partition("=")
        if not sign or not value.strip():
            raise ValueError(f"--fix {pair!r}: give KEY=VALUE, as in inertance=113")
        if key.strip() in WORDS:
            found[key.strip()] = value.strip()
            continue
        try:
            found[key.strip()] = float(value)
        except ValueError:
            raise ValueError(f"--fix {pair!r}: {value!r} is not a number") from None
    return found
