"""The panels for print, as PNG."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter

from inerter.pictures.palette import LIGHT
from inerter.pictures.png import png
from inerter.studies.fluid_rig.panels import Panel, Picture

COLOURS = {"measured": LIGHT["measured"], "fitted": LIGHT["after"]}
_WIDTHS = {"measured": 2.6, "fitted": 1.1}


def picture(of: Picture) -> bytes:
    """A picture's panels as a PNG."""
    rows, columns = len(of.rows), len(of.rows[0])
    figure = Figure(
        figsize=(max(3.3 * columns, 9.0), 2.35 * rows + 0.9), dpi=150, layout="constrained",
        facecolor=LIGHT["page"],
    )  # fmt: skip
    FigureCanvasAgg(figure)
    grid = figure.subplots(rows, columns, squeeze=False)
    for axes_row, panels in zip(grid, of.rows, strict=True):
        for axes, panel in zip(axes_row, panels, strict=True):
            _draw(axes, panel)
        if of.name != "levels":
            # one scale for all tests, so that they can be compared
            limits = np.array([axes.get_ylim() for axes in axes_row])
            for axes in axes_row:
                axes.set_ylim(limits[:, 0].min(), limits[:, 1].max())
    figure.suptitle(of.title, fontsize=12, x=0.01, ha="left", color=LIGHT["text"])
    labels = [line.label for line in of.rows[0][0].lines]
    if labels == ["measured", "fitted"]:
        handles = grid[0][0].get_lines()
        figure.legend(
            handles, labels, loc="outside lower center", ncols=2, frameon=False, fontsize=9
        )
    else:
        for axes_row in grid:
            axes_row[0].legend(loc="best", frameon=False, fontsize=7, handlelength=3.2)
    return png(figure)


def _draw(axes: Axes, panel: Panel) -> None:
    for line in panel.lines:
        style = (0, (4, 2)) if line.dashed else "-"
        axes.plot(
            line.x, line.y, color=COLOURS[line.kind], lw=_WIDTHS[line.kind], ls=style,
            label=line.label,
        )  # fmt: skip
    if panel.logarithmic:
        axes.set_yscale("log")
        axes.yaxis.set_major_formatter("{x:g}")
        axes.yaxis.set_minor_formatter(NullFormatter())
        low, high = axes.get_ylim()
        if high < 100 * low:
            axes.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axes.set_title(panel.title, fontsize=9, loc="left", color=LIGHT["text"])
    axes.set_xlabel(panel.abscissa, fontsize=8, color=LIGHT["soft"])
    axes.grid(color=LIGHT["grid"])
    axes.set_axisbelow(True)
    axes.tick_params(which="both", length=0, labelsize=8, labelcolor=LIGHT["soft"])
    axes.spines[:].set_visible(False)
    axes.margins(x=0.0)
