"""The picture of a front: one line for each layout, better towards the lower left."""

from __future__ import annotations

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from inerter.pictures.palette import LIGHT
from inerter.pictures.png import png
from inerter.suspension.figures import colour
from inerter.suspension.indices import INDICES
from inerter.suspension.pareto import Front

_SCALES = {"J5": (1e5, "1e-5 m/N"), "travel": (1e3, "mm")}


def front_picture(found: Front, layouts: tuple[str, ...], title: str) -> bytes:
    """A PNG."""
    figure = Figure(figsize=(7.5, 5.5), dpi=150, layout="constrained", facecolor=LIGHT["page"])
    FigureCanvasAgg(figure)
    axes = figure.subplots()
    labels = []
    for index in (found.second, found.first):
        scale, unit = _SCALES.get(index, (1.0, INDICES[index].unit))
        labels.append((scale, f"{index} [{unit}], {INDICES[index].meaning}"))
    (across, below), (up, beside) = labels
    for layout in layouts:
        rows = found.of(layout)
        if rows:
            x = [across * row.values[found.second] for row in rows]
            y = [up * row.values[found.first] for row in rows]
            axes.plot(x, y, color=colour(layout), marker="o", ms=4, lw=1.6, label=layout)
    axes.set_xlabel(below, fontsize=9, color=LIGHT["soft"])
    axes.set_ylabel(beside, fontsize=9, color=LIGHT["soft"])
    axes.set_title(title, fontsize=10, loc="left", color=LIGHT["text"])
    axes.grid(color=LIGHT["grid"])
    axes.set_axisbelow(True)
    axes.tick_params(length=0, labelsize=9, labelcolor=LIGHT["soft"])
    axes.spines[:].set_visible(False)
    axes.legend(frameon=False, fontsize=9)
    return png(figure)
