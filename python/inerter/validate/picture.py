"""The picture of a validation: error by integrator and law, and the long runs."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from inerter.pictures.palette import LIGHT
from inerter.pictures.png import png
from inerter.validate.bounds import AGREEMENT
from inerter.validate.case import PUBLISHED
from inerter.validate.laws import LAWS
from inerter.validate.plan import ENGINES
from inerter.validate.result import Validation, largest
from inerter.validate.run import QUANTITIES
from inerter.validate.task import ValidationRow

_LOWEST, _HIGHEST = 1e-10, 1e-1
_ENGINES = {"mujoco": "MuJoCo", "exudyn": "Exudyn"}
_COLOURS = {"mujoco": LIGHT["before"], "exudyn": LIGHT["after"]}


def picture(validation: Validation) -> bytes:
    """A PNG: the largest displacement error of each law in each integrator, and the long runs."""
    laws = [law for law in (PUBLISHED, *LAWS) if any(row.law == law for row in validation.rows)]
    both = bool(laws) and bool(validation.headline)
    height = 1.6 + 0.32 * max(len(laws), len(_models(validation)), 6)
    figure = Figure(
        figsize=(14 if both else 8.5, height), dpi=150, layout="constrained",
        facecolor=LIGHT["page"],
    )  # fmt: skip
    FigureCanvasAgg(figure)
    axes = figure.subplots(1, 2 if both else 1, squeeze=False)[0].tolist()
    if laws:
        _laws(figure, axes.pop(0), validation.rows, laws)
    if validation.headline:
        _long_runs(axes.pop(0), validation)
    return png(figure)


def _laws(figure: Figure, axes: Any, rows: list[ValidationRow], laws: list[str]) -> None:
    there = {(row.engine, row.integrator) for row in rows}
    columns = [(engine, name) for engine, names in ENGINES.items() for name in names]
    columns = [column for column in columns if column in there]
    values, missed = np.full((len(laws), len(columns)), np.nan), []
    for i, law in enumerate(laws):
        for j, (engine, integrator) in enumerate(columns):
            cell = [
                row for row in rows
                if (row.law, row.engine, row.integrator) == (law, engine, integrator)
            ]  # fmt: skip
            worst = largest(cell, "displacement")
            values[i, j] = np.nan if worst is None else worst
            if any(not row.within for row in cell):
                missed.append((i, j))
    image = axes.imshow(
        np.clip(values, _LOWEST, None), norm=LogNorm(_LOWEST, _HIGHEST), cmap="YlGnBu",
        aspect="auto",
    )  # fmt: skip
    for i, j in np.ndindex(values.shape):
        if np.isfinite(values[i, j]):
            # the dark half of the colours wants light figures
            colour = "white" if values[i, j] > 1e-4 else LIGHT["text"]
            axes.text(
                j, i, f"{values[i, j]:.0e}", ha="center", va="center", fontsize=7, color=colour
            )
    for i, j in missed:
        axes.add_patch(Rectangle((j - 0.47, i - 0.46), 0.94, 0.92, fill=False, ec="red", lw=2))
    if len({engine for engine, _ in columns}) == 2:
        first = [engine for engine, _ in columns].index("exudyn")
        axes.axvline(first - 0.5, color=LIGHT["page"], lw=4)
    labels = [f"{_ENGINES[engine]}\n{integrator}" for engine, integrator in columns]
    axes.set_xticks(range(len(columns)), labels, fontsize=7.5, rotation=30, ha="right")
    axes.set_yticks(range(len(laws)), [law.replace("_", " ") for law in laws], fontsize=8.5)
    axes.set_title("largest displacement error of each law" + ("; red: out of bound" if missed
                   else ""), fontsize=10, loc="left")  # fmt: skip
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
    bar = figure.colorbar(image, ax=axes, shrink=0.6, pad=0.02)
    bar.outline.set_visible(False)
    bar.ax.tick_params(labelsize=7.5)


def _long_runs(axes: Any, validation: Validation) -> None:
    names = _models(validation)
    for engine in ENGINES:
        rows = [row for row in validation.headline if row.engine == engine]
        for n, row in enumerate(rows):
            found = [value for value in row.errors.values() if value is not None]
            if not found:
                continue
            y = names.index(_name(row)) + (-0.13 if engine == "mujoco" else 0.13)
            axes.plot([min(found), max(found)], [y, y], color=_COLOURS[engine], lw=1, alpha=0.5)
            axes.plot(
                found, [y] * len(found), "o", color=_COLOURS[engine], ms=4.5,
                label=f"{_ENGINES[engine]} {row.integrator}" if n == 0 else None,
            )  # fmt: skip
    axes.axvline(AGREEMENT, color=LIGHT["soft"], lw=1, ls="--")
    axes.set_xscale("log")
    axes.set_yticks(range(len(names)), names, fontsize=8.5)
    axes.set_ylim(len(names) - 0.5, -0.5)
    seconds = validation.headline[0].duration
    axes.set_title(
        f"smooth models over {seconds:g} s: {', '.join(QUANTITIES)}", fontsize=10, loc="left"
    )
    axes.set_xlabel("relative error", loc="right", fontsize=9)
    axes.grid(axis="x", color=LIGHT["grid"])
    axes.set_axisbelow(True)
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
    axes.legend(frameon=False, fontsize=8, loc="upper left", bbox_to_anchor=(0.0, -0.08), ncols=2)


def _models(validation: Validation) -> list[str]:
    return list(dict.fromkeys(_name(row) for row in validation.headline))


def _name(row: ValidationRow) -> str:
    return f"{row.model.replace('_', ' ')} {row.layout}"
