"""Pictures of benchmarks: one look for all."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from inerter.benchmark.laws import LAWS
from inerter.pictures.palette import LIGHT
from matplotlib import colormaps
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

COLOURS: dict[str, Any] = LIGHT | {
    "laws": [to_hex(shade) for shade in colormaps["viridis"](np.linspace(0, 0.9, len(LAWS)))],
    "set": ["#0a6fa0", "#d4641c", "#3a8f4d", "#8a4fa3", "#b8860b", "#c23b5a", "#5b6571", "#17a2a2"],
}
"""The report's colours, and those of things that stand beside one another."""


def figure(width: float, height: float) -> Figure:
    """A figure of a size [inch], without axes."""
    made = Figure(figsize=(width, height), dpi=150, layout="constrained", facecolor=COLOURS["page"])
    FigureCanvasAgg(made)
    return made


def save(made: Figure, path: Path) -> None:
    """Write as PNG, with the look that all share."""
    for axes in made.axes:
        axes.grid(color=COLOURS["grid"], lw=0.8)
        axes.set_axisbelow(True)
        axes.tick_params(length=0, labelsize=8.5)
        axes.spines[:].set_visible(False)
    made.savefig(path, format="png")
