"""The pictures of a blind test: what was hidden by what was named, confidence by what was right."""

from __future__ import annotations

from io import BytesIO
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from inerter.pictures.palette import LIGHT


def confusion_picture(result: dict[str, Any]) -> bytes:
    """A PNG: rows hidden, columns named first; shares of a row as colour, counts as figures."""
    matrix, laws = result["confusion"], result["laws"]
    parts = [part for part in (matrix, laws) if part["hidden"]]
    wide = max(3, *(len(part["named"]) for part in parts)) if parts else 3
    rows = [len(part["hidden"]) for part in parts] or [1]
    figure = _figure(3.2 + 0.38 * wide, 2.4 + 0.34 * sum(rows) + 1.9 * (len(rows) - 1))
    axes = figure.subplots(len(rows), 1, squeeze=False, height_ratios=[r + 1 for r in rows])
    count = result["settings"]["count"]
    cases = f"{count} case{'' if count == 1 else 's'} per effect"
    noise = f"noise {100 * result['settings']['noise']:g} %"
    if matrix["hidden"]:
        title = f"first named; {cases},\n{noise}, seed {result['seed']}"
        _matrix(axes[0, 0], matrix, title)
    if laws["hidden"]:
        _matrix(axes[-1, 0], laws, "law of hysteretic friction")
    if not parts:
        axes[0, 0].set_axis_off()
        axes[0, 0].text(0.0, 0.5, "no case with one effect or none", color=LIGHT["soft"])
    return _png(figure)


def _matrix(axes: Any, matrix: dict[str, Any], title: str) -> None:
    hidden, named = matrix["hidden"], matrix["named"]
    counts = np.array(matrix["counts"], dtype=float).reshape(len(hidden), len(named))
    shares = counts / np.maximum(counts.sum(axis=1, keepdims=True), 1.0)
    axes.imshow(shares, vmin=0.0, vmax=1.0, cmap="YlGnBu", aspect="equal")
    for i, j in np.ndindex(counts.shape):
        if counts[i, j]:
            # the dark half of the colours wants light figures
            colour = "white" if shares[i, j] > 0.55 else LIGHT["text"]
            axes.text(
                j, i, f"{counts[i, j]:.0f}", ha="center", va="center", fontsize=8, color=colour
            )
        if hidden[i] == named[j]:
            frame = Rectangle((j - 0.5, i - 0.5), 1, 1, fill=False, ec=LIGHT["soft"], lw=0.8)
            axes.add_patch(frame)
    axes.set_xticks(range(len(named)), _words(named), fontsize=8, rotation=45, ha="right")
    axes.set_yticks(range(len(hidden)), _words(hidden), fontsize=8)
    axes.set_ylabel("hidden", fontsize=9)
    axes.set_title(title, fontsize=10, loc="left")
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)


def calibration_picture(result: dict[str, Any]) -> bytes:
    """A PNG: of the findings given a confidence, the share that was right, with 95 % intervals."""
    figure = _figure(5.6, 4.8)
    axes = figure.subplots()
    axes.plot([0, 1], [0, 1], color=LIGHT["soft"], lw=1, ls="--")
    axes.text(0.32, 0.345, "as it should be", color=LIGHT["soft"], fontsize=8.5, rotation=38)
    for part in result["calibration"]:
        number = part["findings"]
        if not number:
            continue
        x, y = part["confidence"], part["right"]
        lower, upper = wilson(y, number)
        axes.plot([x, x], [lower, upper], color=LIGHT["after"], lw=1.2, alpha=0.6)
        axes.plot(x, y, "o", color=LIGHT["after"], ms=4.0 + 1.6 * np.log10(number))
        axes.annotate(
            f"{number}", (x, lower), xytext=(0, -5), textcoords="offset points", fontsize=8,
            ha="center", va="top", color=LIGHT["text"],
        )  # fmt: skip
    axes.set_xlim(0.0, 1.04)
    axes.set_ylim(0.0, 1.04)
    axes.set_xlabel("confidence given, mean of the bin", fontsize=9)
    axes.set_ylabel("share of the findings that was hidden", fontsize=9)
    axes.set_title(
        "calibration (number of findings; cases without unknown effects)", fontsize=10, loc="left"
    )
    axes.grid(color=LIGHT["grid"])
    axes.set_axisbelow(True)
    axes.tick_params(length=0)
    axes.spines[:].set_visible(False)
    return _png(figure)


def wilson(share: float, number: int) -> tuple[float, float]:
    """Wilson's 95 % interval of a share [-] of `number` trials; J. Am. Stat. Assoc. 22, 1927."""
    z = 1.959964
    middle = (share + z * z / (2 * number)) / (1 + z * z / number)
    reach = z * np.sqrt(share * (1 - share) / number + z * z / (4 * number**2))
    reach /= 1 + z * z / number
    return float(middle - reach), float(middle + reach)


def _words(names: list[str]) -> list[str]:
    return [name.replace("_", " ") for name in names]


def _figure(width: float, height: float) -> Figure:
    figure = Figure(figsize=(width, height), dpi=150, layout="constrained", facecolor=LIGHT["page"])
    FigureCanvasAgg(figure)
    return figure


def _png(figure: Figure) -> bytes:
    target = BytesIO()
    figure.savefig(target, format="png")
    return target.getvalue()
