"""How cost grows with the size of a task: fitted exponents.

    cost ~ size^p,   p the slope of log cost over log size

Every round goes through all sizes and gives a slope; the median of the rounds is told. The sizes
are large enough that what is paid once counts little. Time is what the process computes. Rows
without an aim are there to compare with: what the engine does by itself, and work that is not in
proportion to its size.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from inerter.benchmark.rows import Row, aimed, spread_of
from inerter.benchmark.timing import Spread, Timing, Work, interleaved
from matplotlib.ticker import NullFormatter

from benchmarks import growth_lab, growth_models
from benchmarks.picture import COLOURS, figure, save

AIM = "<= 1.10"


@dataclass(frozen=True)
class Subject:
    """A task of any size.

    `sizes` are the full run's; `aim` is None where the work is the engine's alone or is not linear
    by its nature.
    """

    name: str
    unit: str
    sizes: Sequence[int]
    make: Callable[[int], Work]
    aim: str | None = AIM


_CARS = (32, 64, 128, 256)
SUBJECTS = (
    Subject("step, no device", "cars", _CARS, growth_models.bare, None),
    Subject("step, devices in a branch", "cars", _CARS, growth_models.nested),
    Subject("step, devices between branches", "cars", _CARS, growth_models.branches),
    Subject("step, no device, stops", "cars", _CARS, growth_models.bare_stops, None),
    Subject("step, devices between branches, stops", "cars", _CARS, growth_models.stops),
    Subject("step, one device", "bodies", (64, 128, 256, 512), growth_models.bodies),
    Subject(
        "step, floors of one building", "floors", (16, 32, 64, 128), growth_models.floors, None
    ),
    Subject("compile, no device", "cars", _CARS, growth_models.compile_bare, None),
    Subject("compile, devices in a branch", "cars", _CARS, growth_models.compile_nested, None),
    Subject("simulations of a batch", "simulations", (256, 1024, 4096, 16384), growth_models.batch),
    Subject("LuGre along a motion", "samples", (4000, 16000, 64000, 256000), growth_lab.along),
    Subject("records smoothed", "samples", (10000, 20000, 40000, 80000), growth_lab.smoothing),
    Subject("derivatives of a fit", "samples", (10000, 20000, 40000, 80000), growth_lab.jacobian),
    Subject("candidates of a fit", "starts", (48, 96, 192, 384), growth_lab.starts),
)


def run(
    quick: bool = False, subjects: Sequence[Subject] = SUBJECTS, share: float = 1.0
) -> list[Row]:
    """Time every task at every size.

    Parameters
    ----------
    quick
        Fewer rounds of the smaller sizes.
    subjects
        What is timed.
    share
        Of the sizes.

    Returns
    -------
    list of dict
        `question`, `subject`, `of` (what the size counts), `sizes` and `seconds` (lists),
        `exponent` with quartiles, `aim`, `met`.
    """
    rows = []
    for subject in subjects:
        sizes = [max(1, round(share * size)) for size in subject.sizes[: 3 if quick else None]]
        works = {str(size): subject.make(size) for size in sizes}
        times = interleaved(works, 3 if quick else 9, clock=time.process_time)
        spread = exponent(sizes, [times[str(size)] for size in sizes])
        rows.append(
            {
                "question": "growth of linear work" if subject.aim else "growth of other work",
                "subject": subject.name, "of": subject.unit, "sizes": sizes,
                "seconds": [times[str(size)].spread.median for size in sizes],
                **spread_of("exponent", spread), **aimed(spread.median, subject.aim),
            }
        )  # fmt: skip
    return rows


def exponent(sizes: Sequence[int], times: Sequence[Timing]) -> Spread:
    """Slope of log cost over log size, with quartiles over the rounds."""
    costs = np.log(np.array([timing.seconds for timing in times]))
    return Spread.of(np.polyfit(np.log(sizes), costs, 1)[0])


def summary(rows: list[Row]) -> dict[str, list[Row]]:
    """What is printed: the ends of the sizes instead of all of them."""
    short = [
        {
            "subject": row["subject"],
            "sizes": f"{row['sizes'][0]} to {row['sizes'][-1]} {row['of']}",
            "milliseconds": 1e3 * row["seconds"][-1],
            **{key: row[key] for key in row if key.startswith(("exponent", "aim", "met"))},
        }
        for row in rows
    ]
    return {"cost ~ size^exponent": short}


def picture(rows: list[Row], path: Path) -> None:
    """Cost over size, both by logarithm, with the fitted slopes."""
    made = figure(11.0, 6.6)
    panels = made.subplots(1, 2)
    of_models = {row["subject"]: row["subject"].startswith(("step", "compile")) for row in rows}
    for axes, title, side in zip(
        panels, ("models", "batches and fits"), (True, False), strict=True
    ):
        part = [row for row in rows if of_models[row["subject"]] is side]
        for k, row in enumerate(part):
            sizes, cost = np.array(row["sizes"]), np.array(row["seconds"])
            turn, place = divmod(k, len(COLOURS["set"]))
            colour, marker = COLOURS["set"][place], "s^D"[turn] if row["aim"] is None else "o"
            line = ":" if row["aim"] is None else "-"
            middle = np.exp(np.mean(np.log(cost)) - row["exponent"] * np.mean(np.log(sizes)))
            axes.loglog(sizes, cost, marker, color=colour, ms=4)
            axes.loglog(sizes, middle * sizes ** row["exponent"], line, lw=1.2, color=colour)
            text = f"{row['subject']}: {row['exponent']:.2f}"
            axes.loglog([], [], line + marker, lw=1.2, ms=4, color=colour, label=text)
        axes.xaxis.set_minor_formatter(NullFormatter())
        axes.set_title(title, fontsize=9.5, loc="left")
        axes.set_xlabel("size")
        axes.legend(fontsize=7.5, frameon=False, loc="upper center", bbox_to_anchor=(0.5, -0.14))
    panels[0].set_ylabel("seconds")
    save(made, path)
