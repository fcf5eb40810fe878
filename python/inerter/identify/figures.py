"""What an identification looks like: laws compared, the best one against the measured force."""

from __future__ import annotations

import itertools
import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from inerter.identify.prediction import force_along
from inerter.identify.result import Identification
from inerter.motion_units import force_word, unit, words
from inerter.pictures.palette import LIGHT
from inerter.pictures.png import png

Array = NDArray[np.float64]

# samples of a run that a picture shows, and points it draws
_POINTS = 3000
# labels on the axis of errors, and their least distance per length of the axis
_MOST = 5
_GAP = 0.12


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
    force = f"{force_word(run.motion)} [{words(run.motion, 'N')}]"
    time = run.time[part]
    _lines(over_time, time, run.force[part], predicted[part], f"{run.name}: {force} over time [s]")
    over_time.plot(
        time, (run.force - predicted)[part], color=LIGHT["after"], lw=0.8, label="measured - model"
    )
    over_time.legend(frameon=False, fontsize=8, ncols=3, loc="upper right")
    _lines(loop, 1e3 * run.displacement[part], run.force[part], predicted[part],
           f"{force} against displacement [{unit(run.motion, 'mm')}]")  # fmt: skip
    rest = run.force - result.best.device.inertance * run.acceleration
    _lines(speed, run.velocity[part], rest[part],
           (predicted - result.best.device.inertance * run.acceleration)[part],
           f"{force_word(run.motion)} less b a [{words(run.motion, 'N')}] against velocity "
           f"[{unit(run.motion, 'm')}/s]")  # fmt: skip
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
    motion = result.motion
    _style(axes, f"{force_word(motion)} error on held-out data [{words(motion, 'N')}, rms]")
    low, high = axes.get_xlim()
    ticks = log_ticks(low, high)
    axes.set_xticks(ticks, [f"{tick:.6g}" for tick in ticks])
    axes.set_xticks([], minor=True)
    axes.set_xlim(low, high)


def log_ticks(low: float, high: float) -> list[float]:
    """Round numbers that can be read side by side on a narrow logarithmic axis: five at most."""
    first, last = math.floor(math.log10(low)), math.ceil(math.log10(high))
    for digits in ((1, 2, 3, 4, 5, 6, 7, 8, 9), (1, 2, 5), (1, 3), (1,)):
        decades = range(first, last + 1)
        ticks = [float(f"{digit}e{decade}") for decade in decades for digit in digits]
        seen = [tick for tick in ticks if low <= tick <= high]
        gaps = [math.log(b / a) / math.log(high / low) for a, b in itertools.pairwise(seen)]
        if 3 <= len(seen) <= _MOST and min(gaps) > _GAP:
            return seen
    if last - first >= _MOST:
        return [10.0**decade for decade in range(first + 1, last, -(-(last - first) // _MOST))]
    # within less than a decade the scale is all but even
    for count in range(_MOST, 0, -1):
        ticks = MaxNLocator(count, steps=[1, 2, 5, 10]).tick_values(low, high)
        seen = [float(f"{tick:.12g}") for tick in ticks if low <= tick <= high]
        gaps = [math.log(b / a) / math.log(high / low) for a, b in itertools.pairwise(seen)]
        if len(seen) <= _MOST and min(gaps, default=1.0) > _GAP:
            break
    return seen


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
