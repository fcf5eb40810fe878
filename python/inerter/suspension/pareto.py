"""Fronts of two indices: for each layout the designs of which none is better in both.

Between the design that is best in the second index and the one that is best in the first, the first
is minimised under a limit of the second, at equal steps of it. Each step begins from its neighbour
and from a search of its own, so a front does not get stuck in one valley. Rows are kept in a file
as they are found: a front that was interrupted goes on where it stood.
"""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from inerter.folder import write_files
from inerter.suspension.limited import Limited, LimitError, Problem, best_within, values_of
from inerter.suspension.optimum import finite
from inerter.suspension.problem import Array, SuspensionProblem
from inerter.suspension.study import Study, StudyError

FILE = "pareto.json"
Limits = tuple[tuple[str, float], ...]


@dataclass(frozen=True)
class FrontRow:
    """A design: `layout`, `step` along the front, `values` of every index (SI), `design`."""

    layout: str
    step: int
    values: dict[str, float]
    design: dict[str, Any]
    reached: tuple[str, ...] = ()

    def json(self) -> dict[str, Any]:
        """Plain data."""
        own = {"layout": self.layout, "step": self.step, "values": self.values}
        return {**own, "design": self.design, "reached": list(self.reached)}


@dataclass
class Front:
    """Rows by layout and step; `told` sentences on layouts that have none."""

    first: str
    second: str
    rows: list[FrontRow] = field(default_factory=list)
    told: list[str] = field(default_factory=list)

    def of(self, layout: str) -> list[FrontRow]:
        """The rows of a layout, none of which is worse than another in both indices."""
        rows = [row for row in self.rows if row.layout == layout]
        rows.sort(key=lambda row: (row.values[self.second], row.values[self.first]))
        kept, best = [], np.inf
        for row in rows:
            if row.values[self.first] < best * (1.0 - 1e-9):
                kept.append(row)
                best = row.values[self.first]
        return kept


def front(
    study: Study,
    second: str,
    points: int,
    folder: Path,
    progress: Callable[[float], None] = lambda share: None,
) -> Front:
    """The fronts of a study's layouts, kept in `folder` as they are found.

    Parameters
    ----------
    study
        One stiffness, one series pair, one index: the first. Its limits hold along the front.
    second
        The other index.
    points
        Of each layout, 2 or more.
    folder
        What of the same front is there already is not sought again.
    progress
        Called with the share that is done.

    Raises
    ------
    StudyError
        The study has more than one stiffness or pair, or the folder has another front.
    """
    cases = list(study.cases())
    first = study.indices[0]
    if len(cases) != len(study.layouts):
        raise StudyError("a front has one stiffness, one series pair, two indices: give one each")
    if first == second:
        raise StudyError(f"index {first!r} twice: a front is of two indices")
    settings = _settings(study, second, points)
    found = Front(first, second, _known(folder, settings))
    for n, case in enumerate(cases):
        done = {row.step for row in found.rows if row.layout == case.layout}
        if len(done) < points:
            try:
                for row in _layout(case.layout, case.problem, second, points, found, done):
                    found.rows.append(row)
                    _write(folder, settings, found)
                    progress((n + (row.step + 1) / points) / len(cases))
            except LimitError as error:
                found.told.append(str(error))
        progress((n + 1) / len(cases))
    return found


def _layout(
    layout: str, problem: Problem, second: str, points: int, known: Front, done: set[int]
) -> Iterator[FrontRow]:
    own = {row.step: row for row in known.rows if row.layout == layout}
    # values of both indices stand in every row
    both = (*problem.limits, (problem.index, np.inf), (second, np.inf))
    low = own.get(0) or _row(layout, 0, best_within(replace(problem, index=second)), both)
    if 0 not in done:
        yield low
    high = own.get(points - 1) or _row(layout, points - 1, best_within(problem), both)
    if points - 1 not in done:
        yield high
    a, b = low.values[second], high.values[second]
    start: list[Array] = []
    for step in range(1, points - 1):
        if step in done:
            continue
        level = a + (b - a) * step / (points - 1)
        limits = (*(each for each in problem.limits if each[0] != second), (second, level))
        found = best_within(replace(problem, limits=limits), start)
        start = [found.point] if found.problem.variables == problem.variables else []
        yield _row(layout, step, found, both)


def _row(layout: str, step: int, found: Limited, asked: Limits) -> FrontRow:
    problem = found.problem
    values = values_of(replace(problem, limits=asked), found.point)
    if isinstance(problem, SuspensionProblem):
        from inerter.suspension.layouts import springs_of

        design = problem.held | dict(
            zip(problem.variables, np.exp(found.point).tolist(), strict=True)
        )
        design.setdefault("inertance", 0.0)
        shown = {**design, **springs_of(problem.stiffness, design)}
        plain: dict[str, Any] = finite({name: float(f"{x:.13g}") for name, x in shown.items()})
    else:
        plain = {
            axle: finite({"stiffness": strut.stiffness, **strut.layout_values()})
            for axle, strut in zip(("front", "rear"), problem.struts(found.point), strict=True)
        }
    return FrontRow(layout, step, values, plain, found.reached)


def _settings(study: Study, second: str, points: int) -> dict[str, Any]:
    return json.loads(
        json.dumps(
            {
                "schema": "inerter.suspension.pareto/1",
                "car": repr(study.car),
                "road": repr(study.road),
                "stiffness": study.stiffnesses[0],
                "series": list(study.series),
                "equal": study.equal,
                "first": study.indices[0],
                "second": second,
                "points": points,
                "limits": study.limits,
                "fixed": study.fixed,
                "catalogue": study.catalogue,
                "vary": study.vary,
            }
        )
    )


def _known(folder: Path, settings: dict[str, Any]) -> list[FrontRow]:
    path = folder / FILE
    if not path.is_file():
        return []
    try:
        content = json.loads(path.read_text())
        rows = [
            FrontRow(r["layout"], r["step"], r["values"], r["design"], tuple(r["reached"]))
            for r in content["rows"]
        ]
    except (ValueError, KeyError, TypeError):
        raise StudyError(f"{path}: not a front that can go on; remove it or give --out") from None
    different = [key for key in settings if content["settings"].get(key) != settings[key]]
    if different:
        raise StudyError(
            f"{path}: a front of another {different[0]}; give another --out, or remove it"
        )
    return rows


def _write(folder: Path, settings: dict[str, Any], found: Front) -> None:
    rows = [row.json() for row in found.rows]
    text = json.dumps({"settings": settings, "rows": rows}, indent=1, allow_nan=False) + "\n"
    write_files(folder, {FILE: text})


def front_csv(found: Front, layouts: tuple[str, ...]) -> str:
    """The fronts as a table, SI units; designs of a half- or full car with the axle before."""
    rows = [row for layout in layouts for row in found.of(layout)]
    flat = [_flat(row.design) for row in rows]
    indices = list(dict.fromkeys(name for row in rows for name in row.values))
    names = list(dict.fromkeys(name for design in flat for name in design))
    table = io.StringIO()
    writer = csv.writer(table, lineterminator="\n")
    writer.writerow(["layout", *indices, *names, "reached"])
    for row, design in zip(rows, flat, strict=True):
        values = [row.values.get(name, "") for name in indices]
        parts = [design.get(name, "") for name in names]
        writer.writerow([row.layout, *values, *parts, " ".join(row.reached)])
    return table.getvalue()


def _flat(design: dict[str, Any]) -> dict[str, Any]:
    flat: dict[str, Any] = {}
    for name, value in design.items():
        if isinstance(value, dict):
            flat |= {f"{name}_{inner}": x for inner, x in value.items()}
        else:
            flat[name] = "rigid" if value is None else value
    return flat
