"""The common style of the page's plots, and their way into the page."""

from __future__ import annotations

import html
import json
from typing import Any

import numpy as np
import plotly.graph_objects as go
from numpy.typing import ArrayLike, NDArray

from inerter.pictures.palette import LIGHT
from inerter.printable import upright_json

FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif"
# float32 resolves 1e-7 of a value; a time axis needs more when it starts late
_SINGLE = 1e-6


def figure(x_title: str, y_title: str, **layout: Any) -> go.Figure:
    """An empty plot with titled axes; titles may name columns of a file, and stay text."""
    axis: dict[str, Any] = {
        "gridcolor": LIGHT["grid"],
        "linecolor": LIGHT["line"],
        "zerolinecolor": LIGHT["line"],
        "zerolinewidth": 1,
        "tickfont": {"size": 11, "color": LIGHT["soft"]},
        "automargin": True,
        "exponentformat": "power",
    }
    title = {"font": {"size": 12, "color": LIGHT["soft"]}, "standoff": 6}
    return go.Figure(
        layout={
            "template": go.layout.Template(),
            "paper_bgcolor": "rgba(0,0,0,0)",
            "plot_bgcolor": "rgba(0,0,0,0)",
            "font": {"family": FONT, "size": 12, "color": LIGHT["text"]},
            "margin": {"l": 8, "r": 10, "t": 8, "b": 8},
            "showlegend": False,
            "autosize": True,
            "hoverlabel": {
                "bgcolor": LIGHT["panel"],
                "bordercolor": LIGHT["line"],
                "font": {"color": LIGHT["text"]},
            },
            "xaxis": axis | {"title": title | {"text": html.escape(x_title)}},
            "yaxis": axis | {"title": title | {"text": html.escape(y_title)}},
            **layout,
        }
    )


def two_over_time(above: str, below: str) -> go.Figure:
    """Two empty plots, one above the other, on one time axis; lines of the lower: yaxis="y2"."""
    plot = figure("time [s]", above)
    style = plot.layout.yaxis.to_plotly_json()  # type: ignore[attr-defined]
    plot.update_layout(
        yaxis={"domain": [0.44, 1.0]},
        yaxis2=style | {"domain": [0.0, 0.36], "anchor": "x"},
        xaxis={"anchor": "y2"},
    )
    plot.layout.yaxis2.title.text = html.escape(below)  # type: ignore[attr-defined]
    return plot


def line(
    plot: go.Figure,
    x: ArrayLike,
    y: ArrayLike,
    color: str,
    name: str,
    width: float = 1.5,
    **options: Any,
) -> None:
    """Add a line; samples that are not finite are left out."""
    xs, ys = _finite(x, y)
    plot.add_trace(
        go.Scatter(
            x=xs,
            y=ys,
            mode="lines",
            name=html.escape(name),
            line={"color": LIGHT[color], "width": width},
            hovertemplate="%{x:.4g}, %{y:.4g}",
            **options,
        )
    )


def band(
    plot: go.Figure, x: ArrayLike, low: ArrayLike, high: ArrayLike, color: str, name: str
) -> None:
    """Fill what lies between two lines over the same places."""
    xs = np.asarray(x, float)
    plot.add_trace(
        go.Scatter(
            x=np.concatenate([xs, xs[::-1]]),
            y=np.concatenate([np.asarray(high, float), np.asarray(low, float)[::-1]]),
            mode="none",
            fill="toself",
            fillcolor=LIGHT[color],
            opacity=0.25,
            name=html.escape(name),
            hoverinfo="skip",
        )
    )


def points(
    plot: go.Figure,
    x: ArrayLike,
    y: ArrayLike,
    color: str,
    name: str,
    size: float = 3,
    opacity: float = 1.0,
    symbol: str = "circle",
    **options: Any,
) -> None:
    """Add points; samples that are not finite are left out."""
    xs, ys = _finite(x, y)
    plot.add_trace(
        go.Scatter(
            x=xs,
            y=ys,
            mode="markers",
            name=html.escape(name),
            opacity=opacity,
            marker={"color": LIGHT[color], "size": size, "symbol": symbol},
            hovertemplate="%{x:.4g}, %{y:.4g}",
            **options,
        )
    )


def positive(x: ArrayLike, y: ArrayLike) -> tuple[NDArray[Any], NDArray[Any]]:
    """The pairs that a plot with two logarithmic axes can show."""
    xs, ys = np.asarray(x, float), np.asarray(y, float)
    keep = (xs > 0) & (ys > 0)
    return xs[keep], ys[keep]


def log_axis(x: ArrayLike) -> dict[str, Any]:
    """A logarithmic axis marked at 1, 2, 5, 10, 20, ..., or in decades when those are many."""
    values = np.asarray(x, float)
    values = values[np.isfinite(values) & (values > 0)]
    if not len(values):
        return {"type": "log"}
    powers = range(int(np.floor(np.log10(values.min()))), int(np.ceil(np.log10(values.max()))) + 1)
    steps = (1, 2, 5) if len(powers) <= 4 else (1,)
    marks = [step * 10.0**power for power in powers for step in steps]
    return {"type": "log", "tickvals": marks, "ticktext": [f"{mark:g}" for mark in marks]}


def to_script(data: Any) -> str:
    """JSON of plots (or plain data) that is safe inside a <script> element.

    Raises
    ------
    ValueError
        A number is not finite: JSON has no word for it.
    """
    text = upright_json(json.dumps(_plain(data), allow_nan=False, separators=(",", ":")))
    for character in "<>&\u2028\u2029":
        text = text.replace(character, f"\\u{ord(character):04x}")
    return text


def _plain(data: Any) -> Any:
    if isinstance(data, go.Figure):
        # arrays become base64, a third of the length of digits
        made = data.to_dict()
        return _plain({"data": made["data"], "layout": made["layout"]})
    if isinstance(data, dict):
        return {key: _plain(value) for key, value in data.items()}
    if isinstance(data, (list, tuple)):
        return [_plain(value) for value in data]
    # plotly leaves empty arrays as they are
    return data.tolist() if isinstance(data, np.ndarray) else data


def _finite(x: ArrayLike, y: ArrayLike) -> tuple[NDArray[Any], NDArray[Any]]:
    xs, ys = np.asarray(x, float), np.asarray(y, float)
    keep = np.isfinite(xs) & np.isfinite(ys)
    return _compact(xs[keep]), _compact(ys[keep])


def _compact(values: NDArray[Any]) -> NDArray[Any]:
    """Single precision where a plot cannot show the difference."""
    size = float(np.max(np.abs(values))) if len(values) else 0.0
    resolved = len(values) > 1 and float(np.ptp(values)) > 1e4 * _SINGLE * size
    return values.astype(np.float32) if resolved and size < 1e30 else values
