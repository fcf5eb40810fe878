"""What an identification looks like: laws compared, the best one against the measured force."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from inerter.identify.prediction import force_along
from inerter.identify.result import Identification
from inerter.report.palette import LIGHT
from inerter.report.png import png

Array = NDArray[np.float64]

# samples of a run that a picture shows, and points it draws
_POINTS = 3000


def picture(result: Identification) -> bytes:
    """Errors of the laws, force over time, against displacement and velocity, as a PNG."""
    figure = Figure(figsize=(11, 7), dpi=150, layout="constrained", facecolor=LIGHT["page"])
    FigureCanvasAgg(figure)
    errors, over_time, loop, speed = figure.subplot_mosaic(
        [["errors", "time", "time"], ["errors", "loop", "speed"]], width_ratios=[1, 1, 1]
    ).values()
    _errors(errors, result)
    run, part = _shown(result)
    predicted = force_along(result.best.model, run)
    time = run.time[part]
    _lines(
        over_time, time, run.force[part], predicted[part], f"{run.name}: force [N] over time [s]"
    )
    over_time.plot(
        time, (run.force - predicted)[part], color=LIGHT["after"], lw=0.8, label="measured - model"
    )
    over_time.legend(frameon=False, fontsize=8, ncols=3, loc="upper right")
    _lines(loop, 1e3 * run.displacement[part], run.force[part], predicted[part],
           "force [N] against displacement [mm]")  # fmt: skip
    rest = run.force - result.best.device.inertance * run.acceleration
    _lines(speed, run.velocity[part], rest[part],
           (predicted - result.best.device.inertance * run.acceleration)[part],
           "force less b a [N] against velocity [m/s]")  # fmt: skip
    return png(figure)


def _errors(axes: Axes, result: Identification) -> None:
    """Held-out force error of every law with its interval."""
    for row, each in enumerate(result.results):
        color = LIGHT["after"] if row == 0 else LIGHT["soft"]
        axes.plot([each.low, each.high], [row, row], color=color, lw=2)
        axes.plot(each.rmse, row, "o", color=color)
    axes.set_yticks(range(len(result.results)), [each.law for each in result.results], fontsize=9)
    axes.invert_yaxis()
    axes.set_xscale("log")
    _style(axes, "force error on held-out data [N, rms]")
    for axis_ticks in (axes.xaxis.set_major_formatter, axes.xaxis.set_minor_formatter):
        axis_ticks("{x:g}")
    axes.tick_params(which="both", labelsize=8, labelcolor=LIGHT["soft"])


def _shown(result: Identification) -> tuple:
    """The longest held-out run at the measured rate, and which samples are drawn."""
    held = [i for i, mask in enumerate(result.split.holdout) if mask.any()]
    run = max((result.best.runs[i] for i in held), key=lambda each: each.force.size)
    inner = np.flatnonzero(run.inner)
    begin, end = (int(inner[0]), int(inner[-1]) + 1) if inner.size else (0, run.force.size)
    return run, slice(begin, end, max(1, (end - begin) // _POINTS))


def _lines(axes: Axes, x: Array, measured: Array, predicted: Array, title: str) -> None:
    axes.plot(x, measured, color=LIGHT["measured"], lw=2.2, label="measured")
    axes.plot(x, predicted, color=LIGHT["before"], lw=1.0, label="model")
    _style(axes, title)


def _style(axes: Axes, title: str) -> None:
    axes.set_title(title, fontsize=10, loc="left", color=LIGHT["text"])
    axes.grid(color=LIGHT["grid"])
    axes.set_axisbelow(True)
    axes.tick_params(length=0, labelsize=8, labelcolor=LIGHT["soft"])
    axes.spines[:].set_visible(False)
