"""Drawings of the layouts of a strut: springs, dampers and inerters as networks."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

# beside one another (tuples), one after another from the body down (lists)
STRUTS: Mapping[str, Any] = {
    "S1": ("k", "c"), "SR": ("k", ["k_b", "c"]), "S2": ("k", "c", "I"), "S3": ("k", ["c", "I"]),
    "S4": ("k", ["k_b", ("c", "I")]), "S5": ("k", ["k_b", "c", "I"]),
    "S6": ("k", [("k_b", "c"), "I"]), "SW7": ("k'", [("k_1", "c"), ("k_2", "I")]),
    "SW8": ("k'", ["k_b", ("k_1", "c"), ("k_2", "I")]),
}  # fmt: skip


def drawn_struts() -> Figure:
    """Layouts of a strut between body (above) and wheel: k springs, c damper, I inerter."""
    figure = Figure(figsize=(9, 3.2), layout="constrained")
    for axes, (name, strut) in zip(figure.subplots(1, len(STRUTS)), STRUTS.items(), strict=True):
        _draw_strut(axes, strut, 0.0, 1.0, 0.0)
        for end in (0.0, 1.0):
            axes.plot([-1.1, 1.1], [end, end], color="0.2", linewidth=3)
        axes.set(title=name, xlim=(-1.5, 1.5), ylim=(-0.05, 1.05))
        axes.set_axis_off()
    return figure


def _width(part: Any) -> float:
    if isinstance(part, tuple):
        return float(sum(map(_width, part)))
    return max(map(_width, part)) if isinstance(part, list) else 0.85


def _draw_strut(axes: Axes, part: Any, low: float, high: float, x: float) -> None:
    """A part of a network from `low` to `high` about `x`."""
    if isinstance(part, list):
        ends = np.linspace(high, low, len(part) + 1)
        for each, (top, bottom) in zip(part, pairwise(ends), strict=True):
            _draw_strut(axes, each, bottom, top, x)
    elif isinstance(part, tuple):
        left = x - _width(part) / 2.0
        places = []
        for each in part:
            places.append(left + _width(each) / 2.0)
            _draw_strut(axes, each, low, high, places[-1])
            left += _width(each)
        for end in (low, high):
            axes.plot(places[:: len(places) - 1], [end, end], color="0.2", linewidth=1.2)
    else:
        _draw_element(axes, part, low, high, x)


def _draw_element(axes: Axes, name: str, low: float, high: float, x: float) -> None:
    middle, half, w = 0.5 * (low + high), 0.07, 0.14
    ink = {"color": "0.2", "linewidth": 1.2}
    for a, b in ((low, middle - half), (middle + half, high)):
        axes.plot([x, x], [a, b], **ink)
    if name.startswith("k"):
        zigzag = np.append(np.append(0.0, np.tile([w, -w], 3)), 0.0)
        axes.plot(x + zigzag, np.linspace(middle - half, middle + half, 8), **ink)
    elif name == "c":
        axes.plot(
            x + w * np.array([-1, -1, 1, 1]), middle + half * np.array([0.8, -1, -1, 0.8]), **ink
        )
        axes.plot(x + w * np.array([-0.7, 0.7]), [middle + 0.2 * half] * 2, **ink)
        axes.plot([x, x], [middle + 0.2 * half, middle + half], **ink)
    else:
        axes.fill(
            x + w * np.array([-1, 1, 1, -1]), middle + half * np.array([-1, -1, 1, 1]),
            facecolor="tab:orange", edgecolor="0.2", alpha=0.7,
        )  # fmt: skip
    axes.text(x + w + 0.03, middle, f"${name}$", fontsize=8, va="center")
