"""Fronts of several layouts, resumed where a folder has some of them already, and their files."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from inerter.folder import write_files
from inerter.pictures.palette import LIGHT
from inerter.pictures.png import png
from inerter.suspension.figures import colour_of
from inerter.suspension.front import front_of
from inerter.suspension.indices import INDICES
from inerter.suspension.problem import SuspensionProblem

SCHEMA = "inerter.suspension.pareto/1"


def fronts(
    problems: Sequence[SuspensionProblem],
    second: str,
    limits: Mapping[str, float],
    points: int,
    folder: Path,
    progress: Callable[[float, str], None] = lambda share, text: None,
) -> dict[str, Any]:
    """The fronts as a document, which is written after each layout so that work can go on from it.

    Parameters as in `front_of`, with a folder whose pareto.json is taken where its question is the
    same.
    """
    first = problems[0]
    question = {
        "car": asdict(first.car),
        "road": asdict(first.road),
        "stiffness": first.stiffness,
        "index": [first.index, second],
        "limits": dict(limits),
        "points": points,
    }
    before = _before(folder, question)
    document: dict[str, Any] = {
        "schema": SCHEMA,
        **question,
        "layouts": {},
        "rows": [],
        "empty": [],
    }
    for n, problem in enumerate(problems):
        progress(n / len(problems), f"front of {problem.layout}")
        key = json.loads(json.dumps(_key(problem)))
        rows = [row for row in before.get("rows", []) if row["layout"] == problem.layout]
        if before.get("layouts", {}).get(problem.layout) != key:
            rows = [
                {
                    "layout": problem.layout,
                    "limit": None if p.found.layout == problem.layout else p.found.layout,
                    "indices": dict(p.found.indices),
                    "design": dict(p.found.design),
                }
                for p in front_of(problem, second, limits, points)
            ]
        document["layouts"][problem.layout] = key
        document["rows"] += rows
        if not rows:
            document["empty"].append(problem.layout)
        write_files(folder, {"pareto.json": json_text(document)})
    return document


def _key(problem: SuspensionProblem) -> dict[str, Any]:
    elements = [asdict(one) for one in problem.network.elements.elements]
    return {"elements": elements, "fixed": problem.fixed, "ranges": problem.ranges}


def _before(folder: Path, question: Mapping[str, Any]) -> dict[str, Any]:
    try:
        found = json.loads((folder / "pareto.json").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    same = isinstance(found, dict) and all(
        found.get(key) == json.loads(json.dumps(value)) for key, value in question.items()
    )
    return found if same and found.get("schema") == SCHEMA else {}


def json_text(document: Mapping[str, Any]) -> str:
    """The document as text; SI units."""
    return json.dumps(document, indent=2, allow_nan=False) + "\n"


def write_front(document: Mapping[str, Any], folder: Path) -> list[str]:
    """Write pareto.csv, pareto.json and pareto.png; their names.

    Raises
    ------
    OSError
        The folder cannot be written.
    """
    names = list(dict.fromkeys(name for row in document["rows"] for name in row["design"]))
    table = io.StringIO()
    writer = csv.writer(table, lineterminator="\n")
    writer.writerow(["layout", *INDICES, *names])
    for row in document["rows"]:
        indices = [row["indices"][name] for name in INDICES]
        writer.writerow([row["layout"], *indices, *(row["design"].get(x, "") for x in names)])
    files: dict[str, str | bytes] = {
        "pareto.json": json_text(document),
        "pareto.csv": table.getvalue(),
        "pareto.png": picture(document),
    }
    return write_files(folder, files)


def picture(document: Mapping[str, Any]) -> bytes:
    """The fronts as a PNG: the first index across, the second upwards; lower left is better."""
    first, second = document["index"]
    figure = Figure(figsize=(7.5, 5.2), dpi=150, layout="constrained", facecolor=LIGHT["page"])
    FigureCanvasAgg(figure)
    axes = figure.subplots()
    for layout in document["layouts"]:
        rows = [row["indices"] for row in document["rows"] if row["layout"] == layout]
        axes.plot(
            [x[first] for x in rows], [x[second] for x in rows], color=colour_of(layout),
            marker="o", ms=3.5, lw=1.6, label=layout,
        )  # fmt: skip
    for name, put in ((first, axes.set_xlabel), (second, axes.set_ylabel)):
        unit = "" if INDICES[name].unit == "1" else f" [{INDICES[name].unit}]"
        put(f"{name}: {INDICES[name].meaning.split(': ')[-1]}{unit}", color=LIGHT["soft"])
    limits = ", ".join(f"{name} at most {value:g}" for name, value in document["limits"].items())
    title = f"k = {document['stiffness'] / 1e3:g} kN/m; lower left is better"
    axes.set_title(title + (f"; {limits}" if limits else ""), fontsize=10, loc="left")
    axes.grid(color=LIGHT["grid"])
    axes.set_axisbelow(True)
    axes.spines[:].set_visible(False)
    if document["rows"]:
        axes.legend(frameon=False)
    return png(figure)
