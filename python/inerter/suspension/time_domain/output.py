"""Evaluations as JSON, as a CSV file and in the terminal."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Sequence
from dataclasses import fields
from pathlib import Path

from rich import box
from rich.console import Console
from rich.table import Table

from inerter.folder import write_files
from inerter.measured_text import measured
from inerter.suspension.indices import INDICES
from inerter.suspension.layouts import LAYOUTS
from inerter.suspension.own_index import is_own
from inerter.suspension.quarter_car import QuarterCar
from inerter.suspension.time_domain.evaluation import Evaluation
from inerter.suspension.time_domain.plan import Plan
from inerter.suspension.time_domain.samples import CONFIDENCE
from inerter.suspension.time_domain.varied import summary

SCHEMA = "inerter.suspension.evaluation/1"

_SCALE = {"J5": (1e5, "1e-5 m/N"), "travel": (1e3, "mm")}
_NOT_FLAT = ("peaks", "notes", "springs", "rear_springs", "variations")
_FLAT = [f.name for f in fields(Evaluation) if f.name not in _NOT_FLAT]


def json_text(plan: Plan, rows: Sequence[Evaluation]) -> str:
    """The whole evaluation, one document; SI units."""
    document = {
        "schema": SCHEMA,
        "car": plan.car_name,
        "road": plan.road.name,
        "roads": plan.seeds,
        "confidence": CONFIDENCE,
        "amplitude": plan.amplitude,
        "reoptimise": plan.reoptimise,
        **({"vary": {name: list(x) for name, x in plan.vary}} if plan.vary else {}),
        "rows": [row.json() for row in rows],
    }
    return json.dumps(document, indent=2, allow_nan=False) + "\n"


def write_evaluation(plan: Plan, rows: Sequence[Evaluation], folder: Path) -> list[str]:
    """Write evaluation.json and evaluation.csv, of variations also theirs; names of the files.

    Raises
    ------
    OSError
        The folder cannot be written.
    """
    table = io.StringIO()
    writer = csv.writer(table, lineterminator="\n")
    springs = [
        {**row.springs, **{f"rear_{name}": k for name, k in row.rear_springs.items()}}
        for row in rows
    ]
    more = list(dict.fromkeys(name for each in springs for name in each))
    writer.writerow([*_FLAT, *more])
    for row, own in zip(rows, springs, strict=True):
        values = [getattr(row, name) for name in _FLAT]
        shown = ["rigid" if own.get(name) == math.inf else own.get(name, "") for name in more]
        writer.writerow([*values, *shown])
    texts = {"evaluation.json": json_text(plan, rows), "evaluation.csv": table.getvalue()}
    if plan.vary:
        texts["variations.csv"] = _variations_csv(rows)
    return write_files(folder, texts)


def print_evaluation(plan: Plan, rows: Sequence[Evaluation], console: Console) -> None:
    """A table for each index and stiffness."""
    groups = dict.fromkeys((row.stiffness, row.index) for row in rows)
    for stiffness, index in groups:
        scale, unit = _SCALE.get(index, (1.0, INDICES[index].unit))
        head = index + (f" ({unit})" if unit else "")
        of = f"{plan.seeds} roads {plan.road.name}" if index != "J5" else f"{plan.amplitude:g} N"
        table = Table(
            title=f"{head} at k = {stiffness / 1e3:g} kN/m, {of}",
            title_justify="left",
            box=box.SIMPLE_HEAD,
            pad_edge=False,
            show_edge=False,
            padding=(0, 1, 0, 0),
        )
        quarter = plan.car == QuarterCar()
        for name in ("strut", "case", *(["paper"] if quarter else [])):
            table.add_column(name, no_wrap=True)
        for name in (
            "value ± 95 %" if is_own(index) else f"{index} ± 95 %",
            "exact",
            "loss %",
            "c",
            "b",
        ):
            table.add_column(name, justify="right", no_wrap=True)
        digits = ".4g" if quarter else ".3g"
        for row in rows:
            if (row.stiffness, row.index) != (stiffness, index):
                continue
            ideal = row.case == "ideal" and not row.change
            table.add_row(
                row.layout,
                row.case,
                *([row.numbers] if quarter else []),
                _with_error(scale * row.value, 0.5 * scale * (row.high - row.low)),
                _exact(row, scale),
                "" if ideal else _change(row),
                _both(f"{row.damping:.0f}", row.rear_damping, ".0f"),
                _both(f"{row.inertance:{digits}}", row.rear_inertance, digits)
                if LAYOUTS[row.layout].has_inerter
                else "",
            )
        console.print(table, "", sep="\n")
        told = [
            row for row in rows if row.springs and (row.stiffness, row.index) == (stiffness, index)
        ]
        for row in told:
            text = f"{row.layout} {row.case}: {_springs(row)}"
            console.print(text, markup=False, highlight=False, soft_wrap=True)
        if told:
            console.print()
        if plan.vary:
            some = [row for row in rows if (row.stiffness, row.index) == (stiffness, index)]
            console.print(_variations(some, scale, f"{head} over the variations"), "", sep="\n")
    console.print(
        ("paper: table.case of Wang and Su. " if plan.car == QuarterCar() else "")
        + "exact: norm of the transfer function; in brackets, that of the same design without "
        "friction and play. loss: against the ideal inerter at its own optimum, road by road. "
        "c [N s/m], b [kg]" + ("; front/rear." if plan.car_name != "quarter" else "."),
        markup=False,
    )
    for note in dict.fromkeys(note for row in rows for note in row.notes):
        console.print(note, markup=False, soft_wrap=True)


def _variations(rows: Sequence[Evaluation], scale: float, title: str) -> Table:
    """Nominal, mean and worst of each design."""
    table = Table(
        title=title, title_justify="left", box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False,
        padding=(0, 1, 0, 0),
    )  # fmt: skip
    for name in ("strut", "case"):
        table.add_column(name, no_wrap=True)
    for name in ("nominal", "mean", "worst"):
        table.add_column(name, justify="right", no_wrap=True)
    table.add_column("worst when", overflow="fold")
    for row in rows:
        told = summary(row.value, row.variations)
        ends = [(row.low, row.high)]
        ends += [(told[f"{name}_low"], told[f"{name}_high"]) for name in ("mean", "worst")]
        values = (told["nominal"], told["mean"], told["worst"])
        cells = [
            _with_error(scale * value, 0.5 * scale * (high - low))
            for value, (low, high) in zip(values, ends, strict=True)
        ]
        table.add_row(row.layout, row.case, *cells, told["worst_when"])
    return table


def _variations_csv(rows: Sequence[Evaluation]) -> str:
    """A line for each design and variation, SI units."""
    table = io.StringIO()
    writer = csv.writer(table, lineterminator="\n")
    names = ("layout", "case", "index", "stiffness")
    own = ("name", "value", "low", "high", "linear")
    writer.writerow([*names, "variation", *own[1:]])
    for row in rows:
        for each in row.variations:
            writer.writerow(
                [getattr(x, n) for x, some in ((row, names), (each, own)) for n in some]
            )
    return table.getvalue()


def _exact(row: Evaluation, scale: float) -> str:
    """The exact value, in brackets where it is that of the design without friction and play."""
    if row.exact is not None:
        return f"{scale * row.exact:.5g}"
    return "" if row.linear is None else f"({scale * row.linear:.5g})"


def _springs(row: Evaluation) -> str:
    """Inner springs in kN/m, of two axles front and rear."""
    names = {"relaxation_stiffness": "k_b", "damper_stiffness": "k_1", "inerter_stiffness": "k_2"}
    found = []
    for name, short in names.items():
        axles = [own[name] for own in (row.springs, row.rear_springs) if name in own]
        shown = ["rigid" if k == math.inf else f"{k / 1e3:.4g} kN/m" for k in axles]
        found += [f"{short} {' / '.join(shown)}"] if shown else []
    return ", ".join(found)


def _both(front: str, rear: float | None, form: str) -> str:
    """The front strut's value, and after a slash the rear strut's."""
    return front if rear is None else f"{front}/{rear:{form}}"


def _with_error(value: float, half: float) -> str:
    return f"{value:.5g}" if half < 5e-6 * abs(value) else measured(value, half, least=4)


def _change(row: Evaluation) -> str:
    half = 50.0 * (row.change_high - row.change_low)
    text = f"{100.0 * row.change:+.2f}"
    return text if half < 0.005 else f"{text} ± {half:.2f}"
