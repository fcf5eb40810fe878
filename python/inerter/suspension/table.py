"""The optima in the terminal."""

from __future__ import annotations

import math
from collections.abc import Sequence

from rich.console import Console
from rich.table import Table
from rich.text import Text

from inerter.suspension.indices import INDICES
from inerter.suspension.results import improvement, missed_notes, notes
from inerter.suspension.sweep import Missed, SweepRow
from inerter.suspension.vehicle.optimum import VehicleOptimum
from inerter.suspension.vehicle.strut import VehicleStrut


def print_rows(rows: list[SweepRow], console: Console, missed: Sequence[Missed] = ()) -> None:
    """Print a table of the optima, the peaks of J5 where they are few, and the remarks.

    Struts of a half- or full car stand one below the other, the front's first.
    """
    vehicles = any(isinstance(row.optimum, VehicleOptimum) for row in rows)
    table = Table(box=None, padding=(0, 1, 0, 0), header_style="dim")
    for name in ("layout", "index", "series"):
        table.add_column(name, no_wrap=True)
    if vehicles:
        table.add_column("axle", no_wrap=True)
    # two axles are wide enough without a column that is empty
    sprung = not vehicles or any("relaxation_stiffness" in _names(row) for row in rows)
    columns = [
        ("k", "[kN/m]"), ("value", ""), ("unit", ""), ("over S1", "[%]"), ("c", "[N s/m]"),
        ("b", "[kg]"), *([("k_b", "[kN/m]")] if sprung else []),
    ]  # fmt: skip
    for name, unit in columns:
        justify = "left" if name == "unit" else "right"
        table.add_column(f"{name}\n{unit}", justify=justify, no_wrap=True)
    gains = improvement(rows)
    digits = ".4g" if vehicles else "g"
    for n, row in enumerate(rows):
        case, struts = row.case, _struts(row)
        springs = [strut.relaxation_stiffness for strut in struts]
        inerter = case.problem.network.has_inerter
        table.add_row(
            case.layout,
            case.index,
            case.series,
            *(["front\nrear"] if vehicles else []),
            "\n".join(f"{strut.stiffness / 1e3:{digits}}" for strut in struts),
            f"{row.optimum.value:.5g}",
            INDICES[case.index].unit,
            # what rounding leaves of nothing has no sign
            f"{round(gains[n], 2) + 0.0:.2f}" if n in gains else "",
            "\n".join(f"{strut.damping:.5g}" for strut in struts),
            "\n".join(f"{strut.inertance:.5g}" for strut in struts) if inerter else "",
            *([_lines(springs)] if sprung else []),
        )
    console.print(table)
    for row in rows if len(rows) <= 30 else []:
        if row.optimum.peaks:
            console.print(Text(_peaks(row), style="dim"), soft_wrap=True)
    for row in rows:
        if told := _centring(row):
            console.print(Text(told, style="dim"), soft_wrap=True)
    for note in notes(rows):
        console.print(Text(note), soft_wrap=True)
    for told in missed_notes(missed):
        console.print(Text(told), soft_wrap=True)


def _struts(row: SweepRow) -> tuple[VehicleStrut, ...]:
    """The strut of a quarter-car, or those of both axles."""
    best = row.optimum
    if isinstance(best, VehicleOptimum):
        return best.struts
    k = row.case.stiffness
    return (VehicleStrut(k, best.damping, best.inertance, best.relaxation_stiffness),)


def _names(row: SweepRow) -> tuple[str, ...]:
    return row.case.problem.network.variables


def _lines(springs: list[float | None]) -> str:
    texts = ("" if x is None else "rigid" if math.isinf(x) else f"{x / 1e3:.5g}" for x in springs)
    return "\n".join(texts)


def _centring(row: SweepRow) -> str:
    """Centring springs and what is beside them, of two axles front and rear; empty without."""
    designs = row.optimum.design()
    axles = [designs] if "damping" in designs else [designs["front"], designs["rear"]]
    if any("damper_stiffness" not in each for each in axles):
        return ""
    names = {"k_1": "damper_stiffness", "k_2": "inerter_stiffness", "beside": "parallel_stiffness"}
    parts = [
        f"{short} {' / '.join(f'{each[name] / 1e3:.5g}' for each in axles)}"
        for short, name in names.items()
    ]
    case = row.case
    return (
        f"{case.layout} {case.index} {case.series} at k = {case.stiffness / 1e3:g} kN/m, springs "
        f"[kN/m]: {', '.join(parts)}"
    )


def _peaks(row: SweepRow) -> str:
    found = ", ".join(f"{g:.5g} at {f:.3g} Hz" for f, g in row.optimum.peaks)
    return f"{row.case.layout} {row.case.series}, peaks of J5 [m/N]: {found}"
