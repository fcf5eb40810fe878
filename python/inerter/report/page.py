"""The HTML report: one file with everything in it, which loads nothing from anywhere."""

from __future__ import annotations

import math
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup
from plotly.offline import get_plotlyjs

from inerter.diagnose.doubt import about_its_value, by_weight, reason
from inerter.diagnose.guesses import what_it_could_be
from inerter.diagnose.remainder.words import WORDS
from inerter.diagnose.result import (
    Diagnosis,
    Finding,
    ParameterValue,
    RecordSummary,
    RunCurves,
    TablePoints,
)
from inerter.diagnose.wording import (
    curves_in_words,
    departure,
    how_surely,
    is_doubtful,
    is_right,
)
from inerter.motion_units import force_word
from inerter.pictures.palette import DARK, LIGHT
from inerter.pictures.plotting import to_script
from inerter.printable import in_digits, upright
from inerter.report import text
from inerter.report.other_plots import carried_plots, cutoff_plot, table_plots
from inerter.report.run_plots import LOOP_CYCLES, run_plots
from inerter.report.runs import part_held_out, pictured, rmse, role
from inerter.report.stroke_plots import stroke_plot
from inerter.report.subject import subject

# share of what remains below which a quantity it goes with is not shown
LEAST_SHOWN = 0.05
# times the extended model's error from which an engine's is another
STRAYS = 1.1
# from this confidence on it is said that nothing else explains the data
SURE = 0.9
# entries of `method` that have a place of their own on the page
_PLACED = (
    "cutoffs_tried", "force_error_at_cutoffs", "missed_runs", "other_split", "run_constants",
    "run_scales", "run_inertances", "run_levels", "run_dampings", "steps",
)  # fmt: skip
_METHOD_WORDS = {
    "cutoff": "smoothing cut-off [Hz]",
    "channels": "motion taken from",
    "split": "split",
    "held_out_samples": "held-out samples",
    "one_tone": "nearly one sine",
}
ENGINES = {"mujoco": "MuJoCo", "exudyn": "Exudyn", "reference": "reference (SciPy)"}


def render_report(diagnosis: Diagnosis, device_toml: str, model_xml: str) -> str:
    """The report as HTML text.

    Parameters
    ----------
    diagnosis : Diagnosis
        With `curves` (time records) or `points` (tables) where pictures are wanted.
    device_toml, model_xml : str
        The extended device, to copy from the page.
    """
    about = subject(diagnosis)
    runs = pictured(diagnosis.curves)
    table = _table(diagnosis)
    single = table_plots(table) if table else {}
    kept = diagnosis.unexplained.carried
    if kept is not None:
        single |= carried_plots(kept["parameters"], diagnosis.motion)
    strokes = {f"stroke-{f.effect}": stroke_plot(f, diagnosis) for f in diagnosis.findings}
    single |= {place: plot for place, plot in strokes.items() if plot is not None}
    cutoff = cutoff_plot(diagnosis.method, diagnosis.motion)
    if cutoff is not None:
        single["cutoff"] = cutoff
    plots = {"runs": [run_plots(run, len(runs)) for run in runs], "single": single}
    return _template().render(
        d=diagnosis,
        subject=about,
        split_figure=lambda value, digits=3: about.figure(value, digits).rsplit(" ", 1),
        headline=headline(diagnosis),
        budget=_budget(diagnosis),
        findings=[_finding(finding, diagnosis) for finding in by_weight(diagnosis.findings)],
        strokes=[place for place, plot in strokes.items() if plot is not None],
        runs=[_run_label(run) for run in runs],
        unpictured=len(diagnosis.curves) - len(runs),
        partly=any(run.holdout.any() and not run.holdout.all() for run in runs),
        loop_cycles=LOOP_CYCLES,
        table=table is not None,
        cutoff=cutoff is not None,
        parameters=_parameters(diagnosis),
        friction=(
            diagnosis.baseline.device.get("friction", "none"),
            diagnosis.extended.device.get("friction", "none"),
        ),
        records=[_record(record, diagnosis) for record in diagnosis.records],
        warned=any(record.warnings for record in diagnosis.records),
        remains=_remains(diagnosis),
        carried=kept,
        proposed=_proposed(diagnosis),
        engines=_engines(diagnosis),
        strays=_strays(diagnosis),
        method=_method(diagnosis.method),
        device_toml=device_toml,
        model_xml=model_xml,
        light=LIGHT,
        dark=DARK,
        palette=Markup(to_script({"light": LIGHT, "dark": DARK})),
        plots=Markup(to_script(plots)),
        plotly=Markup(plotly_script()),
        number=text.number,
        unit=text.unit,
        tidy=text.tidy,
        count=text.count,
        percent=text.percent,
        between=text.between,
    )


def headline(diagnosis: Diagnosis) -> str:
    """The outcome in one sentence."""
    if not diagnosis.findings and diagnosis.unexplained.significant:
        return "The simulation lacks something that no known effect explains"
    if not diagnosis.findings and not is_right(diagnosis):
        force = force_word(diagnosis.motion)
        return f"The simulation misses the {force}, and no known effect explains it"
    if not diagnosis.findings:
        return "No lack of the simulation is to be seen in these data"
    found = by_weight(diagnosis.findings)
    if diagnosis.unexplained.significant and all(map(is_doubtful, found)):
        return "The simulation lacks something that no known effect explains"
    names = [how_surely(finding) + text.finding_name(finding) for finding in found]
    return f"The simulation lacks {text.listed(names)}"


@cache
def _template() -> Any:
    folder = Path(__file__).parent
    environment = Environment(
        loader=FileSystemLoader(folder),
        autoescape=True,
        finalize=upright,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return environment.get_template("page.html.j2")


@cache
def plotly_script() -> str:
    """Plotly's JavaScript, fit to stand inside a script element."""
    # the end of a script element must not stand inside it
    return get_plotlyjs().replace("</script", "<\\/script").replace("<!--", "<\\!--")


def _table(diagnosis: Diagnosis) -> TablePoints | None:
    return diagnosis.points if diagnosis.points and len(diagnosis.points.frequency) else None


def _finding(finding: Finding, diagnosis: Diagnosis) -> dict[str, Any]:
    def width(value: float) -> float:
        # bars of all findings share the scale of the error before the first
        full = max(diagnosis.baseline.rmse, finding.rmse_before)
        return round(min(100.0, max(0.0, 100 * value / full)), 2) if full > 0 else 0.0

    curves, others = curves_in_words(text.told_values(finding))
    return {
        "name": text.finding_name(finding),
        "key": finding.effect,
        "looks_like": finding.looks_like,
        "sure": finding.confidence >= SURE and not finding.members,
        "both_ways": finding.law == "flanks",
        "confidence": text.confidence(finding.confidence),
        "parameters": [
            *(
                (name, text.parameter_meaning(name), text.with_error(value), _vague(name, value))
                for name, value in others.items()
            ),
            *((name, "", words, False) for name, words in curves.items()),
        ],
        "before": finding.rmse_before,
        "after": finding.rmse_after,
        "before_width": width(finding.rmse_before),
        "after_width": width(finding.rmse_after),
        "gain": finding.gain,
        "gain_interval": finding.gain_interval,
        "compared": finding.compared,
        "rivals": [
            (text.effect_name(r.effect), r.law, text.confidence(r.confidence))
            for r in finding.other_rivals
        ],
        "notes": _notes(finding),
        "guess": in_digits(what_it_could_be(finding).removeprefix("; ")),
        "remark": finding.remark,
        "doubt": reason(finding, diagnosis.unexplained.structure),
        "own_value": about_its_value(finding),
        "evidence": finding.evidence,
    }


def _budget(diagnosis: Diagnosis) -> list[dict[str, Any]]:
    """The parts of the held-out error; none where that is not known or nothing."""
    budget = diagnosis.budget
    if budget is None or not budget.baseline > 0 or not math.isfinite(budget.baseline):
        return []
    return [
        {
            "key": key,
            "words": words,
            "size": size,
            "width": round(100 * max(size, 0.0) / budget.baseline, 2),
        }
        for key, words, size in budget.parts()
    ]


def _notes(finding: Finding) -> dict[str, str]:
    notes = text.effect_notes(finding)
    said = text.finding_name(finding).lower().split()
    # a meaning that only repeats the name is not worth a line
    if all(word in (*said, "level") for word in notes.get("meaning", "").lower().split()):
        notes.pop("meaning", None)
    return notes


def _vague(name: str, value: ParameterValue) -> str:
    """Why a value tells little; empty where it tells."""
    if value.at_limit:
        return "at the limit of what is searched"
    return "poorly determined" if value.stderr > 0.5 * text.size_told(name, value) else ""


def _run_label(run: RunCurves) -> dict[str, Any]:
    return {
        "name": run.name,
        "part": part_held_out(run),
        "before": rmse(run, run.baseline),
        "after": rmse(run, run.extended),
        "unit": run.unit,
    }


def _parameters(diagnosis: Diagnosis) -> list[dict[str, Any]]:
    """Every parameter that either device has: before, after, and whether it was identified."""
    before: dict[str, Any] = {"delay": diagnosis.baseline.delay, **diagnosis.baseline.device}
    after: dict[str, Any] = {"delay": diagnosis.extended.delay, **diagnosis.extended.device}
    rows = []
    # of a curve what it is as a whole: its places are in diagnosis.json
    curves, single = curves_in_words(diagnosis.parameters)
    for name in dict.fromkeys([*single, *curves, *after, *before]):
        new, found = after.get(name), single.get(name)
        old = before.get(name, getattr(found, "stated", None))
        if name == "friction" or (name == "delay" and not (old or new or found)):
            continue
        suffix = text.unit(found.unit if found else text.parameter_unit(name, diagnosis.motion))
        rows.append(
            {
                "name": name,
                "meaning": text.parameter_meaning(name),
                "before": _value(old, suffix),
                "after": curves.get(name)
                or (text.with_error(found) if found else _value(new, suffix)),
                "words": name in curves,
                "off": departure(found) if found else "",
                "how": "identified"
                if found or name in curves
                else "as set"
                if new is not None
                else "left out",
                "vague": _vague(name, found) if found else "",
            }
        )
    return rows


def _value(value: float | str | None, suffix: str) -> str:
    if isinstance(value, str) and len(numbers := value.split()) > 1:
        return f"{len(numbers)} values"
    if value is None or isinstance(value, str):
        return value or text.UNKNOWN
    return f"{text.number(value)} {suffix}".rstrip()


def _record(record: RecordSummary, diagnosis: Diagnosis) -> dict[str, Any]:
    row: dict[str, Any] = asdict(record) | {"before": None, "after": None}
    for run in diagnosis.curves:
        if run.name == record.name:
            row |= {"before": rmse(run, run.baseline), "after": rmse(run, run.extended)}
    row["role"] = role(record, diagnosis)
    return row


def _remains(diagnosis: Diagnosis) -> list[dict[str, Any]]:
    """What the remaining error goes with, where that is more than noise; the strongest first."""
    if not diagnosis.unexplained.significant:
        return []
    known = {**WORDS, "frequency": "a line of its spectrum"}
    return [
        {
            "name": known.get(test["goes_with"], test["goes_with"]),
            "share": test["share"],
            "width": round(100 * min(test["share"], 1.0), 1),
        }
        for test in sorted(diagnosis.unexplained.tests, key=lambda test: -test["share"])
        if test["share"] >= LEAST_SHOWN
        and test["p"] < diagnosis.unexplained.false_alarm_rate
        # how loud a residual is changes with much that is large
        and (test["goes_with"] != "bursts" or "bursts" in diagnosis.unexplained.depends_on)
    ]


def _proposed(diagnosis: Diagnosis) -> list[dict[str, str]]:
    proposal = diagnosis.unexplained.proposal or {"terms": []}
    return [
        {
            "term": term["term"],
            "value": text.with_error(
                ParameterValue(term["coefficient"], term["stderr"], term["unit"])
            ),
        }
        for term in proposal["terms"]
    ]


def _engines(diagnosis: Diagnosis) -> list[tuple[str, float | None]]:
    names = dict.fromkeys([*ENGINES, *diagnosis.engines])
    return [(ENGINES.get(name, name), diagnosis.engines.get(name)) for name in names]


def _strays(diagnosis: Diagnosis) -> list[str]:
    """Engines whose figure is another one than that of the extended model."""
    own = diagnosis.extended.rmse
    return [
        name
        for name, value in _engines(diagnosis)
        if value is not None and not 1 / STRAYS < value / max(own, 1e-300) < STRAYS
    ]


def _method(method: dict[str, Any]) -> list[tuple[str, str]]:
    rows = []
    for key, value in method.items():
        if key in _PLACED or value is None:
            continue
        if isinstance(value, bool):
            shown = "yes" if value else "no"
        elif isinstance(value, (list, tuple)):
            shown = ", ".join(str(item) for item in value)
        elif isinstance(value, int):
            shown = text.count(value)
        elif isinstance(value, float):
            shown = text.number(value)
        else:
            shown = str(value)
        rows.append((_METHOD_WORDS.get(key, key.replace("_", " ")), shown))
    return rows
