"""The paper's figures redone, and those of what it leaves out; each a PNG."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator

from inerter.pictures.palette import LIGHT
from inerter.pictures.png import png
from inerter.studies.hysteresis.conclusions import held_out
from inerter.studies.hysteresis.crossing import FITTERS
from inerter.studies.hysteresis.panels import COLOURS, blank, style
from inerter.studies.hysteresis.protocol import EQUAL
from inerter.studies.hysteresis.published import (
    FREQUENCIES,
    IDEAL_INERTANCE,
    MAKERS,
    MODELS,
)
from inerter.studies.hysteresis.settings import Settings
from inerter.studies.hysteresis.study import Study
from inerter.studies.hysteresis.virtual_tests import (
    VirtualTest,
    bench_tests,
    cleaned_tests,
    virtual_tests,
)

# the device whose test is shown beside the models, for want of the paper's own
SHOWN = "bouc_wen"
_SEARCHES: dict[str, str] = {
    "sqp": LIGHT["before"],
    "sqp_scaled": "#7a5cc0",
    "least_squares": LIGHT["after"],
}


def pictures(study: Study) -> dict[str, bytes]:
    """All PNGs by file name."""
    s = study.settings
    return {
        "loops.png": loops(s),
        "forces.png": forces(s),
        "emd.png": emd(s),
        "held_out.png": crossed(study),
        "searches.png": searches(study),
    }


def published_sets(s: Settings) -> dict[str, tuple[VirtualTest, ...]]:
    """Tests without noise of the ideal inerter and of every device of Table 3."""
    found = {"ideal": bench_tests({"inertance": IDEAL_INERTANCE}, s.rate, s.duration)}
    return found | {maker: virtual_tests(maker, s.rate, s.duration) for maker in MAKERS}


def title_of(name: str) -> str:
    """What a device is called in pictures."""
    return MAKERS.get(name, "ideal inerter")


def loops(s: Settings) -> bytes:
    """Force against displacement and against velocity at each frequency (Figs. 13 to 15)."""
    figure = blank(13, 6.4)
    grid = figure.subplots(2, len(FREQUENCIES))
    for name, tests in published_sets(s).items():
        for column, test in enumerate(tests):
            last = _period(test)
            for row, (channel, scale) in enumerate((("displacement", 1e3), ("velocity", 1.0))):
                grid[row, column].plot(
                    scale * getattr(test, channel)[last], test.truth[last], lw=1.3,
                    color=COLOURS[name], label=title_of(name), ls=_dashes(name),
                )  # fmt: skip
    for column, frequency in enumerate(FREQUENCIES):
        label = "force [N]" if column == 0 else ""
        style(grid[0, column], f"{frequency:g} Hz", "displacement [mm]", label)
        style(grid[1, column], "", "velocity [m/s]", label)
    _legend(figure, grid[0, 0])
    return png(figure)


def forces(s: Settings) -> bytes:
    """Force over time: a noisy test, its EMD, the models of Table 3 (Figs. 4 to 7, 9 to 12)."""
    figure = blank(13, 7.2)
    grid = figure.subplots(2, 2).ravel()
    data = cleaned_tests(SHOWN, s.rate, s.duration, s.noise, s.seed, "emd")
    noisy = cleaned_tests(SHOWN, s.rate, s.duration, s.noise, s.seed, "none")
    for column, (axes, (test, cleaned), (_, raw)) in enumerate(zip(grid, data, noisy, strict=True)):
        part = _stretch(test)
        time = test.time[part]
        axes.plot(
            time, raw.force[part], color=LIGHT["shade"], lw=0.6,
            label=f"virtual test ({MAKERS[SHOWN]}), {s.noise:g} N noise",
        )  # fmt: skip
        axes.plot(
            time, cleaned.force[part], color=LIGHT["text"], lw=1.8, label="the same after EMD"
        )
        for name, tests in published_sets(s).items():
            if name != "ideal":
                axes.plot(
                    time, tests[column].truth[part], color=COLOURS[name], lw=1.2,
                    label=title_of(name), ls=_dashes(name),
                )  # fmt: skip
        style(axes, f"{test.frequency:g} Hz", "time [s]", "force [N]")
        axes.margins(x=0.01)
    _legend(figure, grid[0])
    return png(figure)


def emd(s: Settings) -> bytes:
    """The EMD of the 1 Hz test: every mode, which are kept, and what comes out."""
    test, cleaned = cleaned_tests(SHOWN, s.rate, s.duration, s.noise, s.seed, "emd")[0]
    raw = cleaned_tests(SHOWN, s.rate, s.duration, s.noise, s.seed, "none")[0][1].force
    modes = cleaned.modes
    assert modes is not None
    count = len(modes.modes)
    rows = (count + 2) // 2 + 1
    figure = blank(13, 1.25 * rows + 1.0)
    layout = figure.add_gridspec(rows, 2, height_ratios=[2.2, *[1.0] * (rows - 1)])
    top = figure.add_subplot(layout[0, :])
    top.plot(test.time, raw, color=LIGHT["shade"], lw=0.6, label="measured")
    top.plot(test.time, cleaned.force, color=LIGHT["after"], lw=1.6, label="modes kept and residue")
    top.plot(test.time, test.truth, color=LIGHT["text"], lw=0.9, ls="--", label="without noise")
    style(top, f"1 Hz, {MAKERS[SHOWN]}: force [N] over time [s]")
    top.legend(frameon=False, fontsize=8, ncols=3, loc="upper right", bbox_to_anchor=(1, 1.17))
    top.margins(x=0.005)
    loudest = int(np.argmax(modes.energy))
    for i in range(count + 1):
        axes = figure.add_subplot(layout[1 + i // 2, i % 2])
        values = modes.residue if i == count else modes.modes[i]
        kept = i == count or bool(modes.kept[i])
        axes.plot(test.time, values, color=LIGHT["after" if kept else "before"], lw=0.8)
        name = "residue" if i == count else f"mode {i + 1}"
        words = ", the loudest" if i == loudest else ""
        style(axes, f"{name}: {'kept' if kept else 'dropped'}{words}")
        axes.margins(x=0.005)
    return png(figure)


def crossed(study: Study) -> bytes:
    """Held-out error of every model on everyone's data: over the four ways, and each way."""
    figure = blank(13, 7.0)
    parts: Any = figure.subfigures(2, 1, height_ratios=[1.15, 1])
    above, below = parts
    s = study.settings
    shares = np.array(
        [[held_out(s, study.crossings, maker, fitter) for fitter in FITTERS] for maker in MAKERS]
    )
    whole = np.sqrt(np.mean(shares**2, axis=2))
    table, valley = above.subplots(1, 2)
    _table(table, whole, "error on the test held out, four ways [%]")
    _valley(valley, study)
    for column, (axes, frequency) in enumerate(
        zip(below.subplots(1, len(FREQUENCIES)), FREQUENCIES, strict=True)
    ):
        _table(axes, shares[:, :, column], f"{frequency:g} Hz held out [%]", column == 0, True)
    return png(figure)


def _table(
    axes: Axes, shares: np.ndarray, title: str, names: bool = True, narrow: bool = False
) -> None:
    """A table of shares whose cells get darker with the error."""
    axes.imshow(np.log10(np.clip(shares, 1e-3, 1)), cmap="YlOrBr", vmin=-3, vmax=0.3, aspect="auto")
    for i, row in enumerate(shares):
        for j, share in enumerate(row):
            axes.text(
                j, i, f"{100 * share:.2g}", ha="center", va="center",
                fontsize=8 if narrow else 10, color=LIGHT["text"],
            )  # fmt: skip
    style(axes, title, "who fits", "who made the data" if names else "", grid=False)
    titles = [
        each if not narrow else each.replace("b and c alone", "b, c") for each in FITTERS.values()
    ]
    axes.set_xticks(range(len(FITTERS)), titles, fontsize=7 if narrow else 9)
    axes.set_yticks(
        range(len(MAKERS)), list(MAKERS.values()) if names else [""] * len(MAKERS), fontsize=8
    )


def _valley(axes: Axes, study: Study) -> None:
    """Errors at 1 Hz of fits at 4 Hz that are equally good there."""
    rows = [p for p in study.predictions if p.box == "mended"]
    for row, each in enumerate(rows):
        assert each.spread is not None
        colour = COLOURS[each.model if each.model != "lugre" else "lugre_printed"]
        axes.plot(each.spread, [row, row], color=colour, lw=3, solid_capstyle="butt")
        axes.plot(each.spread, [row, row], "|", color=colour, ms=7)
        # hollow where the search from Table 2's start ended at a larger error
        good = each.end.error <= (1 + EQUAL) * each.best
        fill = LIGHT["text"] if good else LIGHT["page"]
        axes.plot(each.true_errors[0], row, "o", color=LIGHT["text"], mfc=fill, ms=4.5)
    names = [f"{MODELS[p.model].title} on {MAKERS[p.maker]}" for p in rows]
    axes.set_yticks(range(len(rows)), names)
    axes.invert_yaxis()
    axes.set_xscale("log")
    axes.xaxis.set_major_formatter("{x:g}")
    style(axes, "equally good fits at 4 Hz: error at 1 Hz [N]; dot: from Table 2's start")
    axes.tick_params(axis="y", labelsize=7.5)


def searches(study: Study) -> bytes:
    """How far above the best error the optimisers end from their starts, and what it costs."""
    figure = blank(13, 6.2)
    grid = figure.subplots(2, len(MODELS))
    for column, (model, paper) in enumerate(MODELS.items()):
        above, below = grid[:, column]
        part = [each for each in study.starting if each.model == model]
        best = min(end.error for each in part for end in each.ends)
        for each in part:
            # what is nearer than 0.01 % is drawn there
            excess = [max(100 * (end.error / best - 1), 0.01) for end in each.ends]
            style_of: dict[str, Any] = {"color": _SEARCHES[each.optimiser], "ms": 4}
            name = each.optimiser.replace("_", " ")
            above.plot(
                range(1, len(excess) + 1), sorted(excess), "o-", lw=1, label=name, **style_of
            )
            spent = [end.evaluations for end in each.ends]
            below.plot(spent, excess, "o", alpha=0.7, **style_of)
        label = "above the best error [%]" if column == 0 else ""
        for axes in (above, below):
            axes.set_yscale("log")
            axes.set_ylim(0.007, None)
            axes.yaxis.set_major_formatter("{x:g}")
        above.xaxis.get_major_locator().set_params(integer=True)
        below.set_xscale("log")
        below.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        below.xaxis.set_major_formatter("{x:g}")
        below.xaxis.set_minor_formatter("")
        style(above, f"{paper.title}: best {best:.3g} N", "searches, sorted", label)
        style(below, "", "sets of tests simulated", label)
    _legend(figure, grid[0, 0])
    return png(figure)


def _legend(figure: Figure, axes: Axes) -> None:
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(
        handles, labels, loc="outside upper center", ncols=len(labels), frameon=False, fontsize=9
    )


def _dashes(name: str) -> str:
    return "--" if name == "lugre" else "-"


def _period(test: VirtualTest) -> slice:
    """The last whole period that counts, closed."""
    last = int(np.flatnonzero(test.settled)[-1])
    return slice(last - round(1 / (test.frequency * test.spacing)), last + 1)


def _stretch(test: VirtualTest) -> slice:
    """Two periods of the part that counts."""
    first = int(np.flatnonzero(test.settled)[0])
    return slice(first, first + round(2 / (test.frequency * test.spacing)) + 1)
