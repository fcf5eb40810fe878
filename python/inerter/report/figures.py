"""The one picture for a README: measured force, simulation before and after."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from inerter.diagnose.result import Diagnosis, RunCurves
from inerter.folder import write_files
from inerter.motion_units import unit
from inerter.pictures import thinning
from inerter.pictures.palette import LIGHT
from inerter.report import text
from inerter.report.runs import judged, pictured

# cycles of the motion that the picture shows
CYCLES = 3
_LINES = {
    "measured": ("measured", 3.6),
    "before": ("simulation before", 1.7),
    "after": ("simulation after", 1.7),
}


def loop_figure(diagnosis: Diagnosis, path_png: Path) -> None:
    """Write a picture of a held-out stretch: force over time, and against velocity.

    Parameters
    ----------
    diagnosis : Diagnosis
        With `curves`.
    path_png : Path
        Replaced as a whole or not at all, its folder is made; 1800 pixels wide, for display at 900.

    Raises
    ------
    ValueError
        The diagnosis has no time records to draw.
    OSError
        The file cannot be written.
    """
    if not diagnosis.curves:
        raise ValueError("no curves to draw: the records are tables, see the report's pictures")
    run = pictured(diagnosis.curves)[0]
    figure = Figure(figsize=(9, 3.5), dpi=200, layout="constrained", facecolor=LIGHT["page"])
    left, right = figure.subplots(1, 2, width_ratios=[1.55, 1])
    part = _stretch(run)
    time = run.time[part] - run.time[part][0]
    forces = {"measured": run.force, "before": run.baseline, "after": run.extended}
    for color, (name, width) in _LINES.items():
        style: dict[str, Any] = {
            "color": LIGHT[color],
            "linewidth": width,
            "label": name,
            "solid_joinstyle": "round",
        }
        left.plot(time, forces[color][part], **style)
        right.plot(run.velocity[part], forces[color][part], **style)
    left.set_xlabel("time [s]")
    left.set_ylabel(f"{run.quantity} [{text.unit(run.unit)}]")
    left.margins(x=0.01)
    right.set_xlabel(f"velocity [{run.length}/s]")
    for axes in (left, right):
        _clean(axes)
    right.tick_params(labelleft=False)
    right.set_ylim(left.get_ylim())
    figure.legend(
        *left.get_legend_handles_labels(),
        loc="outside upper left",
        ncols=3,
        frameon=False,
        fontsize=10,
        handlelength=1.6,
        borderaxespad=0.3,
    )
    newton = text.unit(unit(diagnosis.motion, "N"))
    figure.suptitle(
        f"rms error on held-out data: {text.number(diagnosis.baseline.rmse)} {newton}"
        f" → {text.number(diagnosis.extended.rmse)} {newton}",
        x=0.99,
        ha="right",
        fontsize=10.5,
        color=LIGHT["text"],
    )
    picture = BytesIO()
    FigureCanvasAgg(figure).print_png(picture, metadata={"Software": None})
    path = Path(path_png)
    write_files(path.parent, {path.name: picture.getvalue()})


def _stretch(run: RunCurves) -> slice:
    """A few cycles of the longest judged stretch, from its first motion on."""
    part = thinning.longest_stretch(judged(run))
    speed = np.abs(run.velocity[part])
    moving = np.flatnonzero(speed > 0.02 * speed.max())
    start = part.start + (max(0, int(moving[0]) - 5) if len(moving) else 0)
    length = thinning.some_cycles(run.velocity[start : part.stop], CYCLES)
    return slice(start, start + length)


def _clean(axes: Any) -> None:
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_color(LIGHT["line"])
    axes.grid(color=LIGHT["grid"], linewidth=0.8)
    axes.set_axisbelow(True)
    axes.tick_params(colors=LIGHT["soft"], labelsize=9.5, length=0)
    for label in (axes.xaxis.label, axes.yaxis.label):
        label.set_color(LIGHT["soft"])
        label.set_fontsize(10)
