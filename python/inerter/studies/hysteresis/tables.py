"""The study's tables as text: a title, column heads and rows, for terminal, page and documents."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from inerter.studies.hysteresis.bias import QUANTITIES
from inerter.studies.hysteresis.conclusions import (
    UNDETERMINED,
    force_rms,
    held_out,
    typical,
)
from inerter.studies.hysteresis.crossing import FITTERS
from inerter.studies.hysteresis.determined import UNKNOWN, Determined
from inerter.studies.hysteresis.published import FREQUENCIES, MAKERS, MODELS
from inerter.studies.hysteresis.study import Study


@dataclass(frozen=True)
class Table:
    """Plain text by cell; the first column names the row."""

    title: str
    heads: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]

    def markdown(self) -> str:
        """The table without its title."""
        lines = [self.heads, ("---",) * len(self.heads), *self.rows]
        return "\n".join("| " + " | ".join(row) + " |" for row in lines)


_HERTZ = tuple(f"{f:g} Hz" for f in FREQUENCIES)


def tables(study: Study) -> list[Table]:
    """All of them, in the order of the study."""
    return [
        peaks(study),
        equivalents(study),
        emd(study),
        at_four(study),
        crossed(study),
        searches(study),
        determined(study),
        combinations(study),
        quantities(study),
        bias(study),
    ]


def peaks(study: Study) -> Table:
    """Peak forces with the parameters of Table 3."""
    rows = tuple(
        (_title(name), *(f"{each.peak:.1f}" for each in loops))
        for name, loops in study.loops.items()
    )
    return Table("Peak force with the parameters of Table 3 [N]", ("device", *_HERTZ), rows)


def equivalents(study: Study) -> Table:
    """What the loops of Table 3 amount to."""
    rows = tuple(
        (_title(n), *(f"{e.inertance:.1f}; {abs(e.damping):.0f}; {e.rest:.1f}" for e in loops))
        for n, loops in study.loops.items()
    )
    return Table(
        "Apparent inertance [kg]; equivalent damping [N s/m]; rms of the harmonics [N]",
        ("device", *_HERTZ),
        rows,
    )


def emd(study: Study) -> Table:
    """What EMD leaves of the noise, per device and frequency."""
    rows = tuple(
        (
            MAKERS[e.maker], f"{e.frequency:g} Hz", f"{e.kept} of {e.modes}", str(e.loudest),
            f"{e.before:.1f}", f"{e.rule:.2f}", f"{e.single:.3g}", f"{e.single_ten:.3g}",
        )
        for e in study.emd
    )  # fmt: skip
    heads = (
        "device", "test", "modes kept", "loudest", "noisy", "by the rule", "loudest alone",
        "loudest of ten rounds",
    )  # fmt: skip
    return Table("EMD: rms distance from the force without noise [N]", heads, rows)


def at_four(study: Study) -> Table:
    """Fits at 4 Hz alone: what they predict."""
    rows = []
    for p in study.predictions:
        size = force_rms(study.settings, p.maker)
        name = MODELS[p.model].title + (" (b = 250 as printed)" if p.box == "printed" else "")
        shares = (short(100 * e / f) for e, f in zip(p.true_errors, size, strict=True))
        spread = "" if p.spread is None else " to ".join(map(short, p.spread))
        inertance = (
            "" if p.inertances is None else f"{p.inertances[0]:.0f} to {p.inertances[1]:.0f}"
        )
        count = f"{p.equal} of {p.starts}" if p.starts else ""
        rows.append(
            (MAKERS[p.maker], name, f"{p.end.error:.2f}", *shares, count, spread, inertance)
        )
    heads = (
        "who made the data", "who fits", "P at 4 Hz [N]", *(f"{each} [%]" for each in _HERTZ),
        "equally good", "their error at 1 Hz [N]", "their b [kg]",
    )  # fmt: skip
    return Table("Fitted at 4 Hz alone: error per rms force, by frequency", heads, tuple(rows))


def crossed(study: Study) -> Table:
    """Held-out errors: who made the data x who fits."""
    rows = []
    for maker, title in MAKERS.items():
        cells = []
        for fitter in FITTERS:
            shares = held_out(study.settings, study.crossings, maker, fitter)
            each = ", ".join(f"{100 * share:.2g}" for share in shares)
            cells.append(f"{100 * typical(shares):.2g} ({each})")
        rows.append((title, *cells))
    return Table(
        "Error on the test held out, per rms force [%]: rms of four ways (1, 2, 3, 4 Hz held out)",
        ("who made the data \\ who fits", *FITTERS.values()),
        tuple(rows),
    )


def searches(study: Study) -> Table:
    """The optimisers from the paper's start and from random ones."""
    rows = []
    for each in study.starting:
        others = [e for e in study.starting if e.model == each.model]
        best = min(end.error for other in others for end in other.ends)
        spent = np.median([end.evaluations for end in each.ends])
        seconds = np.median([end.seconds for end in each.ends])
        worst = max(end.error for end in each.ends)
        rows.append(
            (
                MODELS[each.model].title, each.optimiser, _above(each.ends[0].error, best),
                f"{each.reached(best)} of {len(each.ends)}", _above(worst, best),
                f"{spent:.0f}", f"{seconds:.2f}",
            )
        )  # fmt: skip
    heads = (
        "model", "optimiser", "from Table 2's start", "within 1 %", "worst", "evaluations",
        "seconds",
    )  # fmt: skip
    return Table(
        "Searches on own data, all four tests: error above the best one, median cost",
        heads,
        tuple(rows),
    )


def determined(study: Study) -> Table:
    """Relative errors of the parameters of Table 3."""
    rows = []
    for each in study.determined:
        name = f"{MODELS[each.model].title}, {_tests(each)}"
        known = [f"{s} {_percent(e)}" for s, e in each.errors.items() if e <= UNDETERMINED]
        weak = [f"{s} {_percent(e)}" for s, e in each.errors.items() if e > UNDETERMINED]
        rows.append((name, ", ".join(known) or "none", ", ".join(weak) or "none"))
    heads = ("model, tests", "known", "not known (above 50 %)")
    return Table("Relative standard errors of the parameters of Table 3", heads, tuple(rows))


def combinations(study: Study) -> Table:
    """Parameters that cannot be told apart, and what of them is known."""
    rows = []
    for each in study.determined:
        groups = "; ".join(", ".join(group) for group in each.groups)
        known = "; ".join(
            f"{c.expression} = {float(c.value):.4g} ({_percent(float(c.relative_error))})"
            for c in each.combinations
        )
        name = f"{MODELS[each.model].title}, {_tests(each)}"
        rows.append((name, groups or "none", known or "none"))
    heads = ("model, tests", "cannot be told apart", "known combinations")
    return Table("What identification says of them", heads, tuple(rows))


def quantities(study: Study) -> Table:
    """What no scaling of parameters changes, from 4 Hz alone and from all tests."""
    rows = []
    for model, paper in MODELS.items():
        alone, every = (each for each in study.determined if each.model == model)
        for name, (value, error) in every.quantities.items():
            errors = (alone.quantities[name][1], error)
            told = (short(e) if e < 3 * abs(value) else "not known" for e in errors)
            rows.append((paper.title, name, f"{value:.4g}", *told))
    heads = ("model", "quantity", "value", "± from 4 Hz alone", "± from all tests")
    return Table("What the tests do determine, with standard errors", heads, tuple(rows))


def bias(study: Study) -> Table:
    """What denoising does to estimates."""
    rows = []
    for each in study.bias:
        cells = []
        for name in QUANTITIES[:3]:
            mean, scatter = each.share(name)
            cells.append(f"{short(100 * mean)} ± {short(100 * scatter)}")
        rows.append(
            (
                MODELS[each.model].title, each.way, f"{each.left:.3g}", *cells,
                f"{each.mean['force_error']:.2g}",
            )
        )  # fmt: skip
    heads = (
        "model", "way", "noise left [N]", "inertance [%]", "work at 1 Hz [%]", "work at 4 Hz [%]",
        "force error of the fit [N]",
    )  # fmt: skip
    draws = study.bias[0].draws if study.bias else 0
    return Table(f"Bias and scatter of estimates over {draws} noises", heads, tuple(rows))


def short(value: float) -> str:
    """Two digits, without an exponent for large numbers."""
    return f"{value:.0f}" if abs(value) >= 99.5 else f"{value:.2g}"


def _above(error: float, best: float) -> str:
    share = 100 * (error / best - 1)
    return "< 0.01 %" if share < 0.01 else f"{short(share)} %"


def _tests(each: Determined) -> str:
    return "4 Hz alone" if len(each.frequencies) == 1 else "all tests"


def _percent(share: float) -> str:
    if share >= UNKNOWN / 100:
        return "unknown"
    return f"{100 * share:.2g} %" if share < 1 else f"{100 * share:.0f} %"


def _title(name: str) -> str:
    return MAKERS.get(name, "ideal inerter")
