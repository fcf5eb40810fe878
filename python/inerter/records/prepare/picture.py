"""The picture page of a prepared record: each denoised channel, its spectrum, its modes."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy.signal import welch

from inerter.motion_units import Kind, words
from inerter.pictures.palette import LIGHT
from inerter.pictures.png import png
from inerter.pictures.thinning import extremes
from inerter.records.denoise import Denoised
from inerter.records.denoise.modes import Modes
from inerter.records.prepare.pipeline import PreparedRecord

Array = NDArray[np.float64]

_UNITS = {"force": "N", "displacement": "m", "velocity": "m/s", "acceleration": "m/s²"}
_MOST_SAMPLES = 4000
# samples in the close view, in periods of the fastest thing that was kept
_CLOSE = 400


def picture(prepared: PreparedRecord) -> bytes:
    """A PNG: denoised channels before and after, their modes, and the derivatives."""
    denoised = prepared.denoised
    derived = (prepared.found["derivatives"] or {}).get("columns", [])
    plain = [] if denoised else ["displacement", "force", "road"]
    record = prepared.record
    channels = record.channels()
    shown = [name for name in [*plain, *derived] if name in channels]
    heights = []
    for d in denoised.values():
        heights += [2.3, 2.3]
        if d.modes is not None:
            heights += [2.3] + [0.95] * (len(d.modes.modes) + 1)
    heights += [1.9] * len(shown)
    figure = Figure(
        figsize=(12, sum(heights) + 0.6), dpi=110, layout="constrained", facecolor=LIGHT["page"]
    )
    FigureCanvasAgg(figure)
    grid = figure.add_gridspec(len(heights), 2, height_ratios=heights)
    row = 0
    count = next(iter(prepared.before.values())).size
    clock = prepared.spacing * np.arange(count, dtype=np.float64)
    for name, d in denoised.items():
        before, unit = prepared.before[name], _unit(name, record.motion)
        close = _close(before)
        _compare(
            figure.add_subplot(grid[row, :]),
            clock,
            before,
            d.values,
            name,
            record.motion,
            slice(None),
        )
        axes = figure.add_subplot(grid[row + 1, 0])
        _compare(axes, clock, before, d.values, name, unit, close)
        axes.set_title("a closer look", loc="left", fontsize=9, color=LIGHT["soft"])
        _below(axes, "time from the start [s]")
        _spectra(figure.add_subplot(grid[row + 1, 1]), before, d, prepared.spacing, name, unit)
        row += 2
        if d.modes is not None:
            _rule(figure.add_subplot(grid[row, :]), d.modes, prepared.spacing, name, unit)
            row = _modes(figure, grid, row + 1, d.modes, clock, name, unit)
    for name in shown:
        axes = figure.add_subplot(grid[row, :])
        _line(axes, record.time - record.time[0], channels[name], "after")
        _style(axes, f"{name} [{_unit(name, record.motion)}]")
        _below(axes, "time from the start [s]")
        if name in derived:
            axes.set_title("from displacement", loc="left", fontsize=9, color=LIGHT["soft"])
        row += 1
    figure.suptitle(_title(prepared), x=0.01, ha="left", fontsize=11, color=LIGHT["text"])
    return png(figure)


def _title(prepared: PreparedRecord) -> str:
    found = prepared.found
    parts = [prepared.source.name]
    for name, said in found["denoised"].items():
        unit = _unit(name, prepared.source.motion)
        parts.append(f"{name}: {said['method']}, noise {said['noise']:.3g} {unit} rms")
    if found["delay"]:
        parts.append(f"force moved by {-1e3 * found['delay']['applied']:.3g} ms")
    return "   |   ".join(parts)


def _compare(
    axes: Any, clock: Array, before: Array, after: Array, name: str, unit: str, part: slice
) -> None:
    _line(axes, clock[part], before[part], "measured", "before", 1.0)
    _line(axes, clock[part], after[part], "after", "after", 1.3)
    _style(axes, f"{name} [{unit}]")
    axes.legend(fontsize=8, frameon=False, loc="lower right", bbox_to_anchor=(1, 0.97), ncols=2)


def _spectra(
    axes: Any, before: Array, denoised: Denoised, spacing: float, name: str, unit: str
) -> None:
    """Power spectral densities before and after, and the noise that was assumed."""
    length = min(before.size, 4096)
    for values, color, label in (
        (before, "measured", "before"),
        (denoised.values, "after", "after"),
    ):
        frequency, density = welch(values, 1 / spacing, nperseg=length)
        axes.loglog(frequency[1:], density[1:], color=LIGHT[color], lw=1.2, label=label)
    if denoised.noise > 0:
        level = 2 * spacing * denoised.noise**2
        axes.axhline(level, color=LIGHT["before"], lw=1, ls="--", label="noise")
        # what lies far below the noise is rounding
        bottom, top = axes.get_ylim()
        axes.set_ylim(max(bottom, 1e-7 * level), top)
    if "cutoff" in denoised.strength:
        axes.axvline(denoised.strength["cutoff"], color=LIGHT["soft"], lw=0.8, ls=":")
    _style(axes, f"density [{unit}²/Hz]")
    axes.set_title("spectrum", loc="left", fontsize=9, color=LIGHT["soft"])
    _below(axes, "frequency [Hz]")
    axes.legend(fontsize=8, frameon=False, loc="lower left")


def _rule(axes: Any, modes: Modes, spacing: float, name: str, unit: str) -> None:
    """Energy of every mode over its period, beside the noise law and the limit."""
    shown = np.isfinite(modes.period)
    period, order = modes.period[shown] * spacing, np.argsort(modes.period[shown])
    for values, color, style, label in (
        (modes.expected, "soft", ":", "noise alone"),
        (modes.threshold, "before", "--", "limit"),
    ):
        if np.any(values > 0):
            axes.loglog(
                period[order], values[shown][order], color=LIGHT[color], ls=style, lw=1, label=label
            )
    for kept, color, label in ((True, "after", "kept"), (False, "before", "dropped")):
        part = modes.kept[shown] == kept
        axes.loglog(
            period[part], modes.energy[shown][part], "o", color=LIGHT[color], ms=6, label=label
        )
    _style(axes, f"energy [{unit}²]")
    axes.margins(x=0.05)
    axes.set_title(
        "the rule: the first mode whose energy is above the limit and all slower ones are kept",
        loc="left", fontsize=9, color=LIGHT["soft"],
    )  # fmt: skip
    _below(axes, "mean period [s]")
    axes.legend(fontsize=8, frameon=False, loc="lower right", bbox_to_anchor=(1, 0.97), ncols=4)


def _modes(
    figure: Figure, grid: Any, row: int, modes: Modes, clock: Array, name: str, unit: str
) -> int:
    """One row each: left over time, right what the rule saw."""
    close = _close(modes.modes.sum(axis=0) + modes.residue)
    for i, mode in enumerate(modes.modes):
        color = "after" if modes.kept[i] else "before"
        left, right = (figure.add_subplot(grid[row + i, k]) for k in (0, 1))
        _line(left, clock, mode, color)
        _style(left, f"mode {i + 1}")
        _line(right, clock[close], mode[close], color)
        _style(right, "")
        ratio = modes.energy[i] / modes.threshold[i] if modes.threshold[i] > 0 else np.inf
        period = modes.period[i] * (clock[1] - clock[0])
        right.set_title(
            f"{'kept' if modes.kept[i] else 'dropped'}: {np.sqrt(modes.energy[i]):.3g} "
            f"{unit} rms, noise would have {np.sqrt(modes.expected[i]):.3g}; "
            f"energy {ratio:.3g} of the limit; period {period:.3g} s",
            loc="left", fontsize=8, color=LIGHT["soft"], pad=2,
        )  # fmt: skip
    row += len(modes.modes)
    left, right = (figure.add_subplot(grid[row, k]) for k in (0, 1))
    _line(left, clock, modes.residue, "after")
    _style(left, "residue")
    _line(right, clock[close], modes.residue[close], "after")
    _style(right, "")
    right.set_title("kept: the residue", loc="left", fontsize=8, color=LIGHT["soft"], pad=2)
    return row + 1


def _close(values: Array) -> slice:
    """A short stretch around the largest value."""
    length = min(values.size, max(_CLOSE, values.size // 20))
    centre = int(np.argmax(np.abs(values - np.mean(values))))
    first = int(np.clip(centre - length // 2, 0, values.size - length))
    return slice(first, first + length)


def _line(
    axes: Any, x: Array, y: Array, color: str, label: str | None = None, width: float = 1.0
) -> None:
    keep = extremes(y, _MOST_SAMPLES)
    axes.plot(x[keep], y[keep], color=LIGHT[color], lw=width, label=label)


def _style(axes: Any, label: str) -> None:
    axes.set_ylabel(label, fontsize=9, color=LIGHT["text"])
    axes.tick_params(labelsize=8, colors=LIGHT["soft"])
    axes.grid(color=LIGHT["grid"], lw=0.6)
    axes.margins(x=0.005)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    for side in ("left", "bottom"):
        axes.spines[side].set_color(LIGHT["line"])


def _below(axes: Any, label: str) -> None:
    axes.set_xlabel(label, fontsize=8, color=LIGHT["soft"], labelpad=2)


def _unit(name: str, motion: Kind) -> str:
    own = "N" if name.endswith("force") else _UNITS.get(name.rsplit("_", 1)[-1], "m")
    return words(motion, own)
