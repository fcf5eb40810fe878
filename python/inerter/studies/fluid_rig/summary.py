"""The study in rows, in the terminal and as JSON."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

from inerter.studies.fluid_rig.identify import IdentifiedRig
from inerter.studies.fluid_rig.study import Study, outside
from inerter.studies.fluid_rig.unknowns import label, published, unit, water_limit


@dataclass(frozen=True, kw_only=True)
class ParameterRow:
    """One parameter of one fit; error: relative, low and high: 95 % interval."""

    seed: int
    objective: str
    configuration: str
    name: str
    label: str
    unit: str
    true: float
    value: float
    stderr: float
    low: float
    high: float
    error: float
    undetermined: bool


def rows(study: Study) -> list[ParameterRow]:
    """Every parameter of every fit."""
    return [
        row
        for run in study.runs
        for fit in (run.dry, run.complete)
        for row in _rows(study, run.seed, run.objective, fit)
    ]


def _rows(study: Study, seed: int, objective: str, fit: IdentifiedRig) -> list[ParameterRow]:
    true = published(fit.configuration, study.measured[fit.configuration].sweeps)
    return [
        ParameterRow(
            seed=seed,
            objective=objective,
            configuration=fit.configuration,
            name=name,
            label=label(name),
            unit=unit(name),
            true=true[name],
            value=float(value),
            stderr=float(stderr),
            low=float(low),
            high=float(high),
            error=float(value) / true[name] - 1,
            undetermined=name in fit.undetermined,
        )
        for name, value, stderr, (low, high) in zip(
            fit.names, fit.values, fit.errors, fit.intervals, strict=True
        )
    ]


def recovery(study: Study) -> dict[str, dict[str, dict[str, float]]]:
    """By objective and parameter: largest and rms error over the seeds, share of intervals right.

    Errors are relative to the true value.
    """
    found: dict[str, dict[str, dict[str, float]]] = {}
    for objective in study.settings.objectives:
        mine = [row for row in rows(study) if row.objective == objective]
        found[objective] = {}
        for name in dict.fromkeys(row.name for row in mine):
            these = [row for row in mine if row.name == name]
            errors = np.array([row.error for row in these])
            right = [row.low <= row.true <= row.high for row in these]
            found[objective][name] = {
                "largest_error": float(np.abs(errors).max()),
                "rms_error": float(np.sqrt(np.mean(errors**2))),
                "intervals_right": float(np.mean(right)),
                "median_standard_error": float(np.median([r.stderr / abs(r.true) for r in these])),
            }
    return found


def print_study(study: Study, out: Console) -> None:
    """Parameters, what cannot be told apart, statements."""
    table = Table(title="recovered parameters")
    for column in ("parameter", "true", "objective", "first seed, 95 %", "worst error"):
        table.add_column(
            column, justify="left" if column in ("parameter", "objective") else "right"
        )
    worst, first = recovery(study), study.settings.seeds[0]
    shown = [row for row in rows(study) if row.seed == first]
    for row in sorted(shown, key=lambda each: [each.configuration != "dry", each.name]):
        table.add_row(
            row.label, f"{row.true:.6g} {row.unit}", row.objective,
            f"{row.value:.6g} +- {0.5 * (row.high - row.low):.3g}",
            f"{100 * worst[row.objective][row.name]['largest_error']:.2f} %",
        )  # fmt: skip
    out.print(table)
    for run in study.runs:
        if run.seed != first:
            continue
        for fit in (run.dry, run.complete):
            for name in fit.undetermined:
                out.print(f"{run.objective}, {fit.configuration}: not determined: {label(name)}")
            for one, other, value in fit.hardly_apart:
                out.print(
                    f"{run.objective}, {fit.configuration}: hardly told apart: {label(one)} and "
                    f"{label(other)} (correlation {value:.3f})"
                )
    for name, farthest in outside(study.truth).items():
        out.print(
            f"{name}: the water goes to {1e3 * farthest:.1f} mm, the law of the air to "
            f"{1e3 * water_limit():.1f} mm"
        )
    for each in study.statements:
        out.print(f"{'holds' if each.holds else 'does not hold'}: {each.text}")


def study_json(study: Study) -> dict[str, Any]:
    """Everything but the records."""
    return {
        "schema": "inerter.fluid_rig/1",
        "settings": asdict(study.settings),
        "tests": [
            {
                "configuration": configuration,
                **asdict(sweep),
                "largest_displacement_of_water": signals.farthest,
            }
            for (configuration, sweep), signals in study.truth.items()
        ],
        "outside_the_law_of_the_air": outside(study.truth),
        "recovery": recovery(study),
        "runs": [
            {
                "seed": run.seed,
                "objective": run.objective,
                "dry": _fit_json(run.dry),
                "complete": _fit_json(run.complete),
            }
            for run in study.runs
        ],
        "parameters": [asdict(row) for row in rows(study)],
        "statements": [each.json() for each in study.statements],
        "seconds": {"tests": study.seconds[0], "identification": study.seconds[1]},
    }


def _fit_json(fit: IdentifiedRig) -> dict[str, Any]:
    return {
        "names": list(fit.names),
        "values": fit.values.tolist(),
        "standard_errors": fit.errors.tolist(),
        "intervals": fit.intervals.tolist(),
        "covariance": fit.covariance.tolist(),
        "correlation": fit.correlation.tolist(),
        "standard_errors_of_noise": fit.together.tolist(),
        "standard_errors_of_parts_alone": {k: v.tolist() for k, v in fit.alone.items()},
        "undetermined": list(fit.undetermined),
        "hardly_apart": [list(each) for each in fit.hardly_apart],
        "held": dict(fit.held.values),
        "noise": asdict(fit.noise),
        "shift_by_half_the_step_in_standard_errors": fit.step_shift,
        "cost_over_noise": fit.cost_ratio,
        "start": dict(fit.start),
        "searches": fit.searches,
        "simulations": fit.simulations,
        "seconds": fit.seconds,
    }
