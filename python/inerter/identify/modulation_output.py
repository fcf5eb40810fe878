"""Parameters that go with a third channel: the table, the JSON and the picture."""

from __future__ import annotations

from dataclasses import asdict
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from rich.console import Console
from rich.table import Table
from rich.text import Text

from inerter.folder import json_text, write_files
from inerter.identify.modulation import PARAMETERS, Modulation, Scaled
from inerter.measured_text import measured
from inerter.pictures.palette import LIGHT

SCHEMA = "inerter.modulation/1"


def json_of(found: Modulation) -> dict[str, Any]:
    """The content of modulation.json."""
    return {"schema": SCHEMA, **asdict(found), "notes": found.notes}


def law_in_words(found: Modulation, each: Scaled) -> str:
    """Such as "coulomb_force = 2.1 N + 0.8 N/bar (pressure - 4 bar)"."""
    per = f" {each.unit}/{found.unit}" if found.unit else f" {each.unit} per unit"
    text = f"{each.name} = {measured(each.value, each.stderr, digits=2)} {each.unit}"
    if not each.slope_stderr:
        return f"{text}, whatever {found.channel} is"
    sign = "-" if each.slope < 0 else "+"
    middle = f"({found.channel} - {found.middle:.4g} {found.unit})".replace(" )", ")")
    size = f"({measured(abs(each.slope), each.slope_stderr, digits=2)}){per}"
    return f"{text} {sign} {size} * {middle}"


def print_modulation(found: Modulation, console: Console) -> None:
    """Laws, and how well each run is predicted from the others."""
    for each in found.parameters:
        console.print(Text(law_in_words(found, each)), soft_wrap=True)
    for name, value in found.fixed.items():
        console.print(Text(f"{name} = {value:g} {PARAMETERS[name]}, as stated"), soft_wrap=True)
    table = Table(box=None, padding=(0, 2, 0, 0), header_style="dim")
    table.add_column("left out")
    for head in (found.channel, "error [N]", "with constant parameters", "constants of its own"):
        table.add_column(head, justify="right")
    for name, error in found.left_out.items():
        cells = (found.means[name], error, found.constant[name], found.own[name])
        table.add_row(name, *(f"{cell:.3g}" for cell in cells))
    console.print(table)
    for note in found.notes:
        console.print(Text(note), soft_wrap=True)


def write_modulation(found: Modulation, folder: Path) -> tuple[str, ...]:
    """Write modulation.json and modulation.png; their names."""
    files = {"modulation.json": json_text(json_of(found)), "modulation.png": _picture(found)}
    write_files(folder, files)
    return tuple(files)


def _picture(found: Modulation) -> bytes:
    """Each parameter over the channel: what every run by itself has, and the law."""
    figure = Figure(figsize=(3.4 * len(found.parameters), 3), dpi=110, layout="constrained")
    many = np.atleast_1d(figure.subplots(1, len(found.parameters)))
    q = np.array(list(found.means.values()))
    reach = np.linspace(q.min(), q.max(), 2)
    for axes, each in zip(many, found.parameters, strict=True):
        law = each.value + each.slope * (reach - found.middle)
        axes.plot(reach, law, color=LIGHT["after"], label="law")
        own = [each.own[name] for name in found.means]
        axes.plot(q, own, "o", color=LIGHT["measured"], label="each run by itself")
        axes.set_xlabel(f"{found.channel} [{found.unit}]" if found.unit else found.channel)
        axes.set_ylabel(f"{each.name} [{each.unit}]")
        axes.spines[["top", "right"]].set_visible(False)
    many[0].legend(fontsize=8, frameon=False)
    picture = BytesIO()
    FigureCanvasAgg(figure).print_png(picture, metadata={"Software": None})
    return picture.getvalue()
