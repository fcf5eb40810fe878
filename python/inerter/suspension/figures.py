"""Index values and improvement over S1 against stiffness, in the manner of Wang and Su's Fig. 11.

One row of two panels for each index: a PNG for print, and a page that zooms and works offline.
"""

from __future__ import annotations

import html
from typing import Any

import plotly.graph_objects as go
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from plotly.subplots import make_subplots

from inerter.pictures.palette import LIGHT
from inerter.pictures.plotting import FONT
from inerter.pictures.png import png
from inerter.suspension.indices import INDICES
from inerter.suspension.layouts import LAYOUTS
from inerter.suspension.results import Curve, curves, improvements
from inerter.suspension.sweep import SweepRow

# colour is the layout, dashes are the series pair
_COLOURS = {
    "S1": LIGHT["text"],
    "S2": LIGHT["before"],
    "S3": LIGHT["after"],
    "S4": "#a63d73",
    "S5": "#3f8f4f",
    "S6": "#7a5cc0",
    "SR": "#8a8a8a",
    "SW7": "#c98a1b",
    "SW8": "#2f8fa3",
}
_DASHES: dict[str, tuple[str, Any]] = {
    "none": ("solid", "-"),
    "hard": ("dash", (0, (5, 2))),
    "soft": ("dot", (0, (1, 1.3))),
}
_OTHER_DASHES: tuple[str, Any] = ("dashdot", "-.")
_SCALES = {"J5": (1e5, "1e-5 m/N")}


def picture(rows: list[SweepRow]) -> bytes:
    """The panels as a PNG."""
    indices = _indices(rows)
    figure = Figure(
        figsize=(11, 3.5 * len(indices) + 0.6), dpi=150, layout="constrained",
        facecolor=LIGHT["page"],
    )  # fmt: skip
    FigureCanvasAgg(figure)
    grid = figure.subplots(len(indices), 2, squeeze=False)
    for index, (left, right) in zip(indices, grid, strict=True):
        for axes, lines, title in (
            (left, _values(rows, index), f"{index} [{_unit(index)}], {_meaning(index)}"),
            (right, improvements(rows, index), f"improvement of {index} over S1 [%]"),
        ):
            for (layout, series), (k, values) in lines.items():
                axes.plot(
                    [x / 1e3 for x in k], values, color=colour(layout),
                    ls=_dashes(series)[1], lw=1.6, label=_label(layout, series),
                )  # fmt: skip
            axes.set_title(title, fontsize=10, loc="left", color=LIGHT["text"])
            axes.grid(color=LIGHT["grid"])
            axes.set_axisbelow(True)
            axes.tick_params(length=0, labelsize=9, labelcolor=LIGHT["soft"])
            axes.spines[:].set_visible(False)
            axes.margins(x=0.0)
        right.axhline(0.0, color=LIGHT["soft"], lw=0.8)
    for axes in grid[-1]:
        axes.set_xlabel(_abscissa(rows), fontsize=9, color=LIGHT["soft"])
    handles, labels = grid[0][0].get_legend_handles_labels()
    figure.legend(
        handles, labels, loc="outside lower center", ncols=min(len(labels), 7), frameon=False,
        fontsize=9, handlelength=2.6,
    )  # fmt: skip
    return png(figure)


def page(rows: list[SweepRow]) -> str:
    """The panels as one HTML file that needs no network."""
    indices = _indices(rows)
    titles = [
        title
        for index in indices
        for title in (f"{index} [{_unit(index)}], {_meaning(index)}",
                      f"improvement of {index} over S1 [%]")
    ]  # fmt: skip
    plot = make_subplots(
        len(indices), 2, subplot_titles=titles,
        vertical_spacing=0.22 / (len(indices) + 1), horizontal_spacing=0.08,
    )  # fmt: skip
    for row, index in enumerate(indices, 1):
        for column, lines in ((1, _values(rows, index)), (2, improvements(rows, index))):
            for (layout, series), (k, values) in lines.items():
                plot.add_trace(
                    go.Scatter(
                        x=[x / 1e3 for x in k], y=values, mode="lines",
                        name=html.escape(_label(layout, series)),
                        legendgroup=html.escape(_label(layout, series)),
                        showlegend=row == 1 and column == 1,
                        line={"color": colour(layout), "dash": _dashes(series)[0], "width": 1.8},
                        hovertemplate="k = %{x:.4g} kN/m: %{y:.5g}",
                    ),
                    row, column,
                )  # fmt: skip
    plot.update_layout(
        template=go.layout.Template(), height=330 * len(indices) + 90, paper_bgcolor=LIGHT["page"],
        plot_bgcolor=LIGHT["page"], font={"family": FONT, "size": 12, "color": LIGHT["text"]},
        margin={"l": 50, "r": 20, "t": 50, "b": 40}, legend={"orientation": "h", "y": -0.08},
    )  # fmt: skip
    plot.update_annotations(font={"size": 13})
    plot.update_xaxes(gridcolor=LIGHT["grid"], showticklabels=True)
    plot.update_yaxes(gridcolor=LIGHT["grid"], zerolinecolor=LIGHT["line"])
    plot.update_xaxes(title=_abscissa(rows), row=len(indices))
    return plot.to_html(include_plotlyjs=True, full_html=True)


def colour(layout: str) -> str:
    """Of a layout, whichever name it goes by."""
    return _COLOURS[LAYOUTS[layout].own]


def _abscissa(rows: list[SweepRow]) -> str:
    if all(row.case.rear is None for row in rows):
        return "stiffness k [kN/m]"
    return "front stiffness k [kN/m], the rear in proportion"


def _indices(rows: list[SweepRow]) -> list[str]:
    return list(dict.fromkeys(row.case.index for row in rows))


def _values(rows: list[SweepRow], index: str) -> dict[tuple[str, str], Curve]:
    scale = _SCALES.get(index, (1.0, ""))[0]
    lines = curves(rows, index).items()
    return {name: (k, [scale * value for value in values]) for name, (k, values) in lines}


def _unit(index: str) -> str:
    return _SCALES[index][1] if index in _SCALES else INDICES[index].unit


def _meaning(index: str) -> str:
    return INDICES[index].meaning.split(":")[0]


def _label(layout: str, series: str) -> str:
    if layout == "S1":
        return layout
    return f"{layout} {'ideal' if series == 'none' else series}"


def _dashes(series: str) -> tuple[str, Any]:
    return _DASHES.get(series, _OTHER_DASHES)
