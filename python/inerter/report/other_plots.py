"""Plots that do not belong to one run: bench tables, and how the cut-off was chosen."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import plotly.graph_objects as go

from inerter.core import Device
from inerter.diagnose.result import TablePoints
from inerter.motion_units import TRANSLATION, Kind, force_word, unit
from inerter.pictures.palette import LIGHT
from inerter.pictures.plotting import figure, line, log_axis, points, positive
from inerter.report.text import unit as shown


def table_plots(table: TablePoints) -> dict[str, go.Figure]:
    """Amplitude, ratio of force to acceleration, and residual, each against frequency."""

    def ratio(force: np.ndarray) -> np.ndarray:
        with np.errstate(divide="ignore", invalid="ignore"):
            return force / table.acceleration

    force, newton = force_word(table.motion), shown(unit(table.motion, "N"))
    kilogram = shown(unit(table.motion, "kg"))
    return {
        "table-force": _against_frequency(
            table, f"{force} amplitude [{newton}]", lambda force: force
        ),
        "table-ratio": _against_frequency(table, f"{force} / acceleration [{kilogram}]", ratio),
        "table-error": _against_frequency(
            table, f"error [{newton}]", lambda force: table.force - force, measured=False
        ),
    }


def _against_frequency(
    table: TablePoints,
    title: str,
    value: Callable[[np.ndarray], np.ndarray],
    measured: bool = True,
) -> go.Figure:
    plot = figure("frequency [Hz]", title)
    f = table.frequency
    if len(f) and np.min(f) > 0 and np.max(f) / np.min(f) > 20:
        plot.update_layout(xaxis=log_axis(f))
    if measured:
        points(
            plot, f[~table.holdout], value(table.force)[~table.holdout], "measured", "measured", 9
        )
        points(
            plot,
            f[table.holdout],
            value(table.force)[table.holdout],
            "measured",
            "measured, held out",
            10,
            symbol="circle-open",
            marker_line_width=2.5,
        )
    # a line through a model's values has a meaning only with one value per frequency
    order = np.argsort(f, kind="stable")
    joined = len(np.unique(f)) == len(f)
    for name, color, force in (
        ("before", "before", table.baseline),
        ("after", "after", table.extended),
    ):
        if joined:
            line(plot, f[order], value(force)[order], color, name)
        points(plot, f, value(force), color, name, 5)
    return plot


# lines of a map that a picture shows
MAP_LINES = 5
SAMPLES = 121


def carried_plots(parameters: dict[str, Any], motion: Kind = TRANSLATION) -> dict[str, go.Figure]:
    """The map that a device carries: force over velocity at some places, and the other way.

    Lines from the first to the last place or velocity, ever darker.
    """
    device = Device(**parameters)
    lower, upper = device.force_map_lower, device.force_map_upper
    fastest = device.force_map_speed
    metre, force = unit(motion, "m"), f"{force_word(motion)} [{shown(unit(motion, 'N'))}]"
    names = (f"displacement [{metre}]", f"velocity [{metre}/s]")
    reach = (np.linspace(lower, upper, SAMPLES), np.linspace(-fastest, fastest, SAMPLES))
    plots = {}
    for place, over in (("carried-velocity", 1), ("carried-displacement", 0)):
        plot = figure(names[over], force)
        for k, each in enumerate(reach[1 - over][:: (SAMPLES - 1) // (MAP_LINES - 1)]):
            both = (reach[0], each) if over == 0 else (each, reach[1])
            values = device.evaluate(*both, 0.0, 0.0)["total"]
            said = f"{names[1 - over].split(' ')[0]} {each:.3g} {names[1 - over].split(' ')[1]}"
            line(plot, reach[over], values, "after", said, 1.2 + 0.3 * k, opacity=0.35 + 0.16 * k)
        plots[place] = plot
    return plots


def cutoff_plot(method: dict[str, Any], motion: Kind = TRANSLATION) -> go.Figure | None:
    """Force error against the smoothing cut-offs tried, the chosen one marked; None without."""
    tried = np.asarray(method.get("cutoffs_tried") or [], float)
    errors = np.asarray(method.get("force_error_at_cutoffs") or [], float)
    if not len(tried) or len(tried) != len(errors):
        return None
    error = f"{force_word(motion)} error of the trial [{shown(unit(motion, 'N'))}]"
    plot = figure("smoothing cut-off [Hz]", error)
    plot.update_layout(xaxis=log_axis(tried), yaxis={"rangemode": "tozero"})
    x, y = positive(tried, errors)
    line(plot, x, y, "measured", "error", 1.5)
    points(plot, x, y, "measured", "error", 6)
    chosen = method.get("cutoff")
    if chosen is not None and np.isfinite(chosen) and len(x):
        nearest = int(np.argmin(np.abs(np.log(x / chosen)))) if chosen > 0 else 0
        points(plot, x[nearest : nearest + 1], y[nearest : nearest + 1], "after", "chosen", 12)
        plot.add_annotation(
            x=float(np.log10(x[nearest])),
            y=float(y[nearest]),
            text="chosen",
            showarrow=False,
            yshift=-16,
            font={"color": LIGHT["after"], "size": 12},
        )
    return plot
