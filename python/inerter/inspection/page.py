"""The page of an inspection: one file with its picture, and tables; loads nothing."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from html import escape

from inerter.inspection.facts import Facts, clock_words, motion_words, size, span
from inerter.inspection.tells import Tell, words
from inerter.printable import printable, upright

_STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; margin: 2rem auto; max-width: 72rem; padding: 0 1rem;
  color: #1d232b; }
table { border-collapse: collapse; margin: .5rem 0 1.5rem; }
th, td { text-align: left; padding: .25rem .9rem .25rem 0; border-bottom: 1px solid #dfe3e8; }
img { width: 100%; } h2 { margin-top: 2.5rem; } .soft { color: #5b6571; }
.warning { border-left: 4px solid #b3261e; padding-left: .7rem; overflow-wrap: anywhere; }
table { display: block; overflow-x: auto; }
"""


def page(facts: Sequence[Facts], picture: bytes) -> str:
    """The page as HTML text."""
    image = base64.b64encode(picture).decode()
    parts = [
        "<!doctype html><html lang='en'><meta charset='utf-8'><title>Records inspected</title>",
        f"<style>{_STYLE}</style><h1>What the records hold</h1>",
        f"<img alt='each record over time, as loops and as spectra' "
        f"src='data:image/png;base64,{image}'>",
    ]
    for each in facts:
        parts += _record(each)
    return "\n".join(parts) + "\n"


def _text(text: object) -> str:
    return escape(str(upright(printable(str(text)))))


def _table(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    head = "".join(f"<th>{_text(cell)}</th>" for cell in header)
    body = "".join(
        "<tr>" + "".join(f"<td>{_text(cell)}</td>" for cell in row) + "</tr>" for row in rows
    )
    return f"<table><tr>{head}</tr>{body}</table>"


def _record(facts: Facts) -> list[str]:
    record = facts.record
    parts = [f"<h2>{_text(record.name)}</h2>", f"<p>{_text(clock_words(facts))}</p>"]
    if record.reading:
        parts.append(f"<p class='soft'>Read as: {_text(record.reading)}.</p>")
    parts += [
        f"<p class='warning'><b>Warning</b> ({_text(w.code)}): {_text(w.text)}</p>"
        for w in record.warnings
    ]
    parts.append(_table(CHANNEL_HEADER, channel_rows(facts)))
    if facts.motion is not None:
        parts.append(f"<p>Motion: {_text(motion_words(facts.motion, facts.record.motion))}.</p>")
    if facts.tells:
        parts.append("<h3>What it could tell</h3>")
        parts.append(_table(TELL_HEADER, tell_rows(facts.tells)))
        parts.append(
            "<p class='soft'>A first look by a linear model; <code>inerter diagnose</code> judges "
            "on held-out data.</p>"
        )
    return parts


CHANNEL_HEADER = ("channel", "range", "noise (rms)", "in steps of", "band", "in the spectrum")


def channel_rows(facts: Facts) -> list[tuple[str, ...]]:
    """Cells of the table of channels."""
    rows = []
    for c in facts.channels:
        seen = [f"{at:.0f} Hz, {size(rms, c.unit)} rms" for at, rms in c.hum]
        if c.corner is not None:
            seen.append(f"bends down at {c.corner:.3g} Hz: a low-pass, or the end of the motion")
        rows.append(
            (
                c.name,
                span(c.low, c.high, c.unit),
                size(c.noise, c.unit) if facts.rate is not None else "-",
                size(c.step, c.unit) if c.step is not None else "-",
                f"to {c.band:.3g} Hz" if c.band else "-",
                "; ".join(seen) or "-",
            )
        )
    return rows


TELL_HEADER = ("quantity", "this record", "motion that would tell more")


def tell_rows(tells: Sequence[Tell]) -> list[tuple[str, ...]]:
    """Cells of the table of what could be known."""
    rows = []
    for tell in tells:
        said = words(tell).removeprefix(tell.name).strip()
        if tell.verdict == "not told":
            said = f"not told: {tell.reason}"
        rows.append((tell.name, said, tell.motion or "-"))
    return rows
