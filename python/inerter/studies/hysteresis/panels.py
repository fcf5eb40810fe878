"""Axes in the house's style, shared by the pictures of the study."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from inerter.pictures.palette import LIGHT

COLOURS = {
    "ideal": LIGHT["measured"],
    "dahl": LIGHT["before"],
    "lugre_printed": LIGHT["after"],
    "lugre": "#7a5cc0",
    "bouc_wen": "#3f8f4f",
}
"""Of the devices of Table 3."""


def blank(width: float, height: float) -> Figure:
    """An empty figure of a size [inches]."""
    figure = Figure(figsize=(width, height), dpi=130, layout="constrained", facecolor=LIGHT["page"])
    FigureCanvasAgg(figure)
    return figure


def style(axes: Axes, title: str, x: str = "", y: str = "", grid: bool = True) -> None:
    """Title above, labels, a light grid and no frame."""
    axes.set_title(title, fontsize=10, loc="left", color=LIGHT["text"])
    axes.set_xlabel(x, fontsize=9, color=LIGHT["soft"])
    axes.set_ylabel(y, fontsize=9, color=LIGHT["soft"])
    if grid:
        axes.grid(color=LIGHT["grid"])
        axes.set_axisbelow(True)
    axes.tick_params(length=0, labelsize=8, labelcolor=LIGHT["soft"], which="both")
    axes.spines[:].set_visible(False)
