"""One picture of records: over time, as loops, and as spectra."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from inerter.inspection.channel import spectrum
from inerter.inspection.facts import Facts, scale, size
from inerter.motion_units import force_word, unit, words
from inerter.pictures.palette import LIGHT
from inerter.pictures.png import png
from inerter.pictures.thinning import extremes
from inerter.records import TimeRecord
from inerter.records.motion import uniform_channels

MOST = 4  # records in the picture
_THIN = 3000  # points of a line
_LOOP = 6000  # samples of a loop


def picture(facts: Sequence[Facts]) -> bytes:
    """A PNG with a row for each of the first records over time."""
    shown = [each for each in facts if isinstance(each.record, TimeRecord)][:MOST]
    rows = max(1, len(shown))
    figure = Figure(
        figsize=(14, 4.2 * rows + 0.5), dpi=100, layout="constrained", facecolor=LIGHT["page"]
    )
    FigureCanvasAgg(figure)
    grid = figure.add_gridspec(2 * rows, 3, width_ratios=[1.5, 1, 1.2])
    for k, each in enumerate(shown):
        _over_time(figure, grid, 2 * k, each)
        _loops(figure, grid, 2 * k, each)
        _spectra(figure, grid, 2 * k, each)
    if not shown:
        figure.text(0.02, 0.5, "a table of amplitudes: no signal to draw", color=LIGHT["text"])
    return png(figure)


def _over_time(figure: Figure, grid: Any, row: int, facts: Facts) -> None:
    record = facts.record
    assert isinstance(record, TimeRecord)
    time = record.time[: facts.looked_at] - record.time[0]
    for k, channel in enumerate(facts.channels[:2]):
        axes = figure.add_subplot(grid[row + k, 0])
        values = record.channels()[channel.name][: facts.looked_at]
        at = extremes(values, _THIN)
        factor, name = scale(max(abs(channel.low), abs(channel.high)), channel.unit)
        axes.plot(time[at], factor * values[at], color=LIGHT["measured"], lw=0.8)
        _style(axes, f"{channel.name} [{name}]")
        if k == 0:
            axes.set_title(
                f"{record.name}: {record.samples} samples, {facts.rate:.5g} per second",
                loc="left", fontsize=11, color=LIGHT["text"],
            )  # fmt: skip
        if k == 1 or len(facts.channels) == 1:
            axes.set_xlabel("time from the start [s]", fontsize=9, color=LIGHT["soft"])


def _loops(figure: Figure, grid: Any, row: int, facts: Facts) -> None:
    motion = facts.smoothed
    if motion is None:
        return
    kind = motion.motion
    inner = np.flatnonzero(motion.inner)[:: max(1, int(motion.inner.sum()) // _LOOP)]
    pairs = (
        (1e3 * motion.displacement, f"displacement [{unit(kind, 'mm')}]"),
        (motion.velocity, f"velocity [{unit(kind, 'm')}/s]"),
    )  # fmt: skip
    for k, (x, title) in enumerate(pairs):
        axes = figure.add_subplot(grid[row + k, 1])
        axes.plot(x[inner], motion.force[inner], color=LIGHT["measured"], lw=0.5)
        _style(axes, f"{force_word(kind)} [{words(kind, 'N')}]")
        axes.set_xlabel(title, fontsize=9, color=LIGHT["soft"])


def _spectra(figure: Figure, grid: Any, row: int, facts: Facts) -> None:
    record = facts.record
    assert isinstance(record, TimeRecord)
    part = {c.name: record.channels()[c.name][: facts.looked_at] for c in facts.channels[:2]}
    spacing, even = uniform_channels(record.time[: facts.looked_at], part)
    for k, channel in enumerate(facts.channels[:2]):
        axes = figure.add_subplot(grid[row + k, 2])
        frequency, power = spectrum(even[channel.name], spacing)
        axes.loglog(frequency[1:], np.sqrt(power[1:]), color=LIGHT["measured"], lw=0.8)
        _style(axes, f"{channel.name} [{channel.unit.replace('*', ' ')}/√Hz]")
        marks = [(channel.band, f"above its noise up to {channel.band:.3g} Hz")]
        if channel.corner is not None:
            marks.append((channel.corner, f"bends down at {channel.corner:.3g} Hz"))
        for place, text in marks:
            if place > 0:
                axes.axvline(place, color=LIGHT["soft"], lw=0.8, ls="--")
                axes.text(
                    place, 0.04 if text[0] == "a" else 0.14, f" {text}",
                    transform=axes.get_xaxis_transform(), fontsize=8, color=LIGHT["text"],
                    ha="right" if place > frequency[-1] / 30 else "left",
                )  # fmt: skip
        for place, level in channel.hum:
            axes.text(
                place, 0.95, f"{place:.0f} Hz: {size(level, channel.unit)}", rotation=90, va="top",
                transform=axes.get_xaxis_transform(), fontsize=8, color=LIGHT["text"],
            )  # fmt: skip
        axes.set_xlabel("frequency [Hz]", fontsize=9, color=LIGHT["soft"])


def _style(axes: Any, title: str) -> None:
    axes.set_ylabel(title, fontsize=9, color=LIGHT["soft"])
    axes.tick_params(labelsize=8, colors=LIGHT["soft"])
    axes.set_facecolor(LIGHT["page"])
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
