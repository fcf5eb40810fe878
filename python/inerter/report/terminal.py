"""A diagnosis in the terminal."""

from __future__ import annotations

from rich.console import Console, Group, RenderableType
from rich.panel import Panel
from rich.table import Table
from rich.text import Text

from inerter.catalogue.coordinates import NUISANCES
from inerter.diagnose.doubt import by_weight
from inerter.diagnose.result import Diagnosis, ParameterValue
from inerter.diagnose.wording import curves_in_words, departure
from inerter.printable import printable
from inerter.report import text
from inerter.report.runs import role
from inerter.report.subject import subject


def print_summary(diagnosis: Diagnosis, console: Console) -> None:
    """Print `summary` on a console."""
    console.print(summary(diagnosis))


def summary(diagnosis: Diagnosis) -> RenderableType:
    """Verdict, findings, and records with their warnings, to print with rich."""
    before, after = diagnosis.baseline.rmse, diagnosis.extended.rmse
    about = subject(diagnosis)
    numbers = Text.assemble(
        f"{about.error} on held-out data  ",
        (about.figure(before), "bold yellow"),
        " → ",
        (about.figure(after), "bold cyan"),
        f"   ({text.percent(1 - after / before if before > 0 else 0.0)} less)",
    )
    parts: list[RenderableType] = [
        Panel(
            Group(numbers, Text(), _plain(diagnosis.verdict)),
            title="Diagnosis",
            title_align="left",
        )
    ]
    if diagnosis.findings:
        parts.append(_findings(diagnosis))
    if own := _own_values(diagnosis):
        parts.append(own)
    parts.append(_records(diagnosis))
    return Group(*parts)


def _findings(diagnosis: Diagnosis) -> Table:
    table = _table("What the simulation lacks")
    table.add_column("effect", ratio=3)
    table.add_column("parameters", ratio=4)
    about = subject(diagnosis)
    unit = "%" if about.share else about.newton
    table.add_column(f"error [{unit}]", justify="right", no_wrap=True)
    table.add_column("gain", justify="right", no_wrap=True)
    table.add_column("confidence", justify="right", no_wrap=True)
    for finding in by_weight(diagnosis.findings):
        effect = Text(text.finding_name(finding), style="bold")
        if finding.looks_like:
            effect = Text("looks like ", style="dim").append(effect)
        likely = [rival for rival in finding.other_rivals if rival.confidence >= 0.05]
        if likely:
            names = text.listed([*dict.fromkeys(map(text.rival_name, likely))][:2])
            effect.append(f"\nor {names}", style="dim not bold")
        curves, others = curves_in_words(text.told_values(finding))
        values = "\n".join(
            [
                *(
                    f"{n} {text.with_error(v)}{_departure(v)}{_unknown(n, v)}"
                    for n, v in others.items()
                ),
                *curves.values(),
            ]
        )
        table.add_row(
            effect,
            _plain(values),
            " → ".join(
                about.figure(value).removesuffix(f" {unit}")
                for value in (finding.rmse_before, finding.rmse_after)
            ),
            text.percent(finding.gain),
            text.confidence(finding.confidence),
        )
    return table


def _own_values(diagnosis: Diagnosis) -> Text | None:
    """What was fitted and is nothing that the simulation lacks, the inertance first of all."""
    told = {name for finding in diagnosis.findings for name in finding.parameters}
    own = {n: v for n, v in diagnosis.parameters.items() if n not in told and n not in NUISANCES}
    curves, others = curves_in_words(own)
    words = [f"{n} {text.with_error(v)}{_unknown(n, v)}" for n, v in others.items()]
    words += curves.values()
    if not words:
        return None
    return Text("The device itself  ", style="bold").append(_plain(", ".join(words), "not bold"))


def _unknown(name: str, value: ParameterValue) -> str:
    """That a value is smaller than its error, in brackets; empty where it is not."""
    return " (not determined)" if value.stderr > text.size_told(name, value) else ""


def _departure(value: ParameterValue) -> str:
    off = departure(value)
    return f" ({off})" if off else ""


def _records(diagnosis: Diagnosis) -> Table:
    table = _table("Records")
    table.add_column("record", ratio=3)
    table.add_column("role", no_wrap=True)
    table.add_column("samples", justify="right", no_wrap=True)
    table.add_column("rate [Hz]", justify="right", no_wrap=True)
    table.add_column("warnings", ratio=5)
    for record in diagnosis.records:
        warnings = "\n".join(f"{w['code']}: {w['text']}" for w in record.warnings)
        table.add_row(
            _plain(record.name),
            _plain(role(record, diagnosis)),
            text.count(record.samples),
            text.number(record.sample_rate or None, 4),
            _plain(warnings, "yellow"),
        )
    return table


def _table(title: str) -> Table:
    return Table(
        title=title,
        title_justify="left",
        title_style="bold",
        box=None,
        padding=(0, 2),
        header_style="dim",
        expand=True,
    )


def _plain(words: str, style: str = "") -> Text:
    # names come from files: no markup
    return Text(printable(words), style=style)
