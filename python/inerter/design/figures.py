"""The panels of a design: a PNG for print, and a page that zooms and works offline."""

from __future__ import annotations

import html
import math
from typing import Any

import numpy as np
import plotly.graph_objects as go
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from plotly.subplots import make_subplots

from inerter.design.result import Design, Panel
from inerter.pictures.palette import LIGHT
from inerter.pictures.plotting import FONT
from inerter.pictures.png import png

_COLOURS = (LIGHT["after"], LIGHT["before"], "#3f8f4f", "#a63d73", "#7a5cc0")


def picture(design: Design) -> bytes:
    """The panels as a PNG."""
    rows, columns = _grid(design)
    figure = Figure(
        figsize=(5.5 * columns, 3.4 * rows), dpi=150, layout="constrained", facecolor=LIGHT["page"]
    )
    FigureCanvasAgg(figure)
    grid = figure.subplots(rows, columns, squeeze=False).ravel()
    for axes in grid[len(design.panels) :]:
        axes.set_axis_off()
    for axes, panel in zip(grid, design.panels, strict=False):
        for curve, colour in zip(panel.curves, _colours(panel), strict=True):
            style: dict[str, Any] = (
                {"ls": "", "marker": "o", "ms": 4.5}
                if curve.marks
                else {"ls": (0, (5, 2)) if curve.dashed else "-", "lw": 1.6}
            )
            axes.plot(curve.x, curve.y, color=colour, label=curve.name, **style)
        axes.set_title(panel.title, fontsize=10, loc="left", color=LIGHT["text"])
        axes.set_xlabel(panel.x_title, fontsize=9, color=LIGHT["soft"])
        axes.set_ylabel(panel.y_title, fontsize=9, color=LIGHT["soft"])
        axes.set_xscale("log" if panel.log_x else "linear")
        axes.set_yscale("log" if panel.log_y else "linear")
        axes.grid(color=LIGHT["grid"])
        axes.set_axisbelow(True)
        axes.tick_params(length=0, labelsize=9, labelcolor=LIGHT["soft"], which="both")
        axes.spines[:].set_visible(False)
        axes.margins(x=0.02)
        axes.legend(loc="best", frameon=False, fontsize=8.5, handlelength=2.4)
    return png(figure)


def page(design: Design) -> str:
    """The panels as one HTML file that needs no network."""
    rows, columns = _grid(design)
    plot = make_subplots(
        rows, columns, subplot_titles=[html.escape(panel.title) for panel in design.panels],
        vertical_spacing=0.3 / rows, horizontal_spacing=0.09,
    )  # fmt: skip
    for index, panel in enumerate(design.panels):
        row, column = index // columns + 1, index % columns + 1
        for curve, colour in zip(panel.curves, _colours(panel), strict=True):
            plot.add_trace(
                go.Scatter(
                    x=_plain(curve.x), y=_plain(curve.y),
                    mode="markers" if curve.marks else "lines",
                    name=html.escape(curve.name), legend=f"legend{index + 1}",
                    line={"color": colour, "dash": "dash" if curve.dashed else "solid"},
                    marker={"color": colour, "size": 7},
                    hovertemplate="%{x:.4g}, %{y:.5g}",
                ),
                row, column,
            )  # fmt: skip
        axis: dict[str, Any] = {"gridcolor": LIGHT["grid"], "zerolinecolor": LIGHT["line"]}
        x_type, y_type = ("log" if log else "linear" for log in (panel.log_x, panel.log_y))
        plot.update_xaxes(title=panel.x_title, type=x_type, row=row, col=column, **axis)
        plot.update_yaxes(title=panel.y_title, type=y_type, row=row, col=column, **axis)
    plot.update_layout(
        template=go.layout.Template(), height=360 * rows + 60, paper_bgcolor=LIGHT["page"],
        plot_bgcolor=LIGHT["page"], font={"family": FONT, "size": 12, "color": LIGHT["text"]},
        margin={"l": 50, "r": 20, "t": 50, "b": 40},
    )  # fmt: skip
    plot.update_annotations(font={"size": 13})
    for index, panel in enumerate(design.panels):
        row, column = index // columns + 1, index % columns + 1
        axes: Any = next(plot.select_xaxes(row=row, col=column)).domain
        sides: Any = next(plot.select_yaxes(row=row, col=column)).domain
        right, top = _corner(panel)
        place = {
            "x": axes[right], "y": sides[top], "xanchor": ("left", "right")[right],
            "yanchor": ("bottom", "top")[top], "bgcolor": "rgba(255,255,255,0.7)",
            "font": {"size": 11},
        }  # fmt: skip
        plot.update_layout({f"legend{index + 1}": place})
    return plot.to_html(include_plotlyjs=True, full_html=True)


def _grid(design: Design) -> tuple[int, int]:
    """Rows and columns of panels."""
    columns = min(2, len(design.panels))
    return math.ceil(len(design.panels) / columns), columns


def _corner(panel: Panel) -> tuple[int, int]:
    """The emptiest corner: 0 or 1 for left or right, for bottom or top."""
    x = np.concatenate([np.asarray(curve.x, float) for curve in panel.curves])
    y = np.concatenate([np.asarray(curve.y, float) for curve in panel.curves])
    with np.errstate(invalid="ignore", divide="ignore"):
        x, y = np.log(x) if panel.log_x else x, np.log(y) if panel.log_y else y
    keep = np.isfinite(x) & np.isfinite(y)
    shares = [(v[keep] - np.min(v[keep])) / (np.ptp(v[keep]) or 1.0) for v in (x, y)]

    def crowd(corner: tuple[int, int]) -> int:
        near = [
            np.abs(share - side) < reach
            for share, side, reach in zip(shares, corner, (0.45, 0.3), strict=True)
        ]
        return int(np.sum(near[0] & near[1]))

    return min(((1, 0), (1, 1), (0, 1), (0, 0)), key=crowd)


def _colours(panel: Panel) -> list[str]:
    """Measured points dark, lines in the order of the colours."""
    return [
        LIGHT["text"] if curve.marks else _COLOURS[index % len(_COLOURS)]
        for index, curve in enumerate(panel.curves)
    ]


def _plain(values: Any) -> list[float | None]:
    return [float(v) if np.isfinite(v) else None for v in values]
