"""The plots of one run: force over time, loops, and what the residual goes with."""

from __future__ import annotations

from typing import Any

import numpy as np
import plotly.graph_objects as go
from scipy.signal import welch

from inerter.diagnose.result import RunCurves
from inerter.pictures import thinning
from inerter.pictures.palette import LIGHT
from inerter.pictures.plotting import figure, line, points, positive, two_over_time
from inerter.pictures.thinning import Mask
from inerter.report.runs import judged
from inerter.report.text import unit as shown

# samples per line when there are few runs
TIME_SAMPLES = 3000
LOOP_SAMPLES = 1500
CLOUD_SAMPLES = 500
LOOP_CYCLES = 6
LOOP_STRETCHES = 3
BINS = 24

BEFORE, AFTER = "before", "after"


def run_plots(run: RunCurves, crowd: int = 1) -> dict[str, go.Figure]:
    """Every plot of a run, by the name of its place in the page; `crowd`: runs on that page."""
    share = min(1.0, 8 / crowd)
    mask = judged(run)
    return {
        "time": _over_time(run, int(share * TIME_SAMPLES)),
        **_loops(run, mask, int(share * LOOP_SAMPLES)),
        **_clouds(run, mask, int(share * CLOUD_SAMPLES)),
        "spectrum": _spectrum(run, mask),
    }


def _over_time(run: RunCurves, limit: int) -> go.Figure:
    """Force above, residual below, one time axis."""
    plot = two_over_time(f"{run.quantity} [{shown(run.unit)}]", f"error [{shown(run.unit)}]")
    # where the motion is not known, near the ends, nothing is simulated
    known = slice(np.argmax(run.inner), len(run.inner) - np.argmax(run.inner[::-1]))
    before, after = (_within(known, f) for f in (run.baseline, run.extended))
    lines: list[tuple[str, np.ndarray, str, float, str]] = [
        ("measured", run.force, "measured", 3.0, "y"),
        (BEFORE, before, "before", 1.4, "y"),
        (AFTER, after, "after", 1.4, "y"),
        ("error before", run.force - before, "before", 1.2, "y2"),
        ("error after", run.force - after, "after", 1.2, "y2"),
    ]
    for name, values, color, width, axis in lines:
        real = np.flatnonzero(np.isfinite(values))
        keep = real[thinning.extremes(values[real], limit)]
        line(plot, run.time[keep], values[keep], color, name, width, yaxis=axis)
    # where only a part of the run is held out, show which
    if run.holdout.any() and not run.holdout.all():
        plot.update_layout(
            shapes=[
                {
                    "type": "rect",
                    "xref": "x",
                    "yref": "paper",
                    "y0": 0,
                    "y1": 1,
                    "x0": float(run.time[first]),
                    "x1": float(run.time[last]),
                    "fillcolor": LIGHT["shade"],
                    "opacity": 0.18,
                    "line": {"width": 0},
                    "layer": "below",
                }
                for first, last in thinning.stretches(run.holdout)[:100]
            ]
        )
    return plot


def _within(known: slice, values: np.ndarray) -> np.ndarray:
    """Values of a part, NaN elsewhere."""
    kept = np.full(len(values), np.nan)
    kept[known] = values[known]
    return kept


def _loops(run: RunCurves, mask: Mask, limit: int) -> dict[str, go.Figure]:
    parts = thinning.stretches(mask)[:LOOP_STRETCHES]
    keeps = []
    for first, last in parts:
        length = thinning.some_cycles(run.velocity[first : last + 1], LOOP_CYCLES // len(parts))
        keeps.append(first + thinning.evenly(length, limit // len(parts)))
    plots = {}
    for place, title, x in (
        ("loop-displacement", f"displacement [{run.length}]", run.displacement),
        ("loop-velocity", f"velocity [{run.length}/s]", run.velocity),
    ):
        plot = figure(title, f"{run.quantity} [{shown(run.unit)}]")
        _room(plot, np.concatenate([x[keep] for keep in keeps]))
        for name, force, width in (
            ("measured", run.force, 3.0),
            (BEFORE, run.baseline, 1.5),
            (AFTER, run.extended, 1.5),
        ):
            for keep in keeps:
                line(plot, x[keep], force[keep], name, name, width)
        plots[place] = plot
    return plots


def _room(plot: go.Figure, x: np.ndarray) -> None:
    """Some room left and right, so that a loop's turning points are not cut off."""
    size = float(np.ptp(x))
    if np.isfinite(size) and size > 0:
        plot.update_layout(
            xaxis={"range": [float(x.min()) - 0.04 * size, float(x.max()) + 0.04 * size]}
        )


def _clouds(run: RunCurves, mask: Mask, limit: int) -> dict[str, go.Figure]:
    """Residual against the motion: some samples as points, the mean in each bin as a line."""
    samples = np.flatnonzero(mask)
    some = samples[thinning.evenly(len(samples), limit)]
    plots = {}
    for place, title, x in (
        ("error-displacement", f"displacement [{run.length}]", run.displacement),
        ("error-velocity", f"velocity [{run.length}/s]", run.velocity),
        ("error-acceleration", f"acceleration [{run.length}/s²]", run.acceleration),
    ):
        plot = figure(title, f"error [{shown(run.unit)}]")
        for name, color, force in (
            (BEFORE, "before", run.baseline),
            (AFTER, "after", run.extended),
        ):
            error = run.force - force
            points(plot, x[some], error[some], color, name, 3, 0.28, hoverinfo="skip")
            real = samples[np.isfinite(error[samples])]
            middle, mean = thinning.bin_means(x[real], error[real], BINS)
            line(plot, middle, mean, color, f"{name}, mean", 2.4)
        plots[place] = plot
    return plots


def _spectrum(run: RunCurves, mask: Mask) -> go.Figure:
    plot = figure("frequency [Hz]", f"density [{shown(run.unit)}/√Hz]")
    log: dict[str, Any] = {"type": "log", "dtick": 1, "tickformat": "~g"}
    plot.update_layout(xaxis=log, yaxis=log)
    part = thinning.longest_stretch(mask)
    count = part.stop - part.start
    if count < 16:
        return plot
    rate = 1 / float(np.median(np.diff(run.time[part])))
    for name, color, values, width in (
        (f"measured {run.quantity}", "measured", run.force, 3.0),
        ("error before", "before", run.force - run.baseline, 1.5),
        ("error after", "after", run.force - run.extended, 1.5),
    ):
        if not np.isfinite(values[part]).all():
            continue
        size = min(count, max(256, count // 4), 2048)
        frequency, power = welch(values[part], rate, nperseg=size)
        line(plot, *positive(frequency, np.sqrt(power)), color, name, width)
    return plot
