"""The best law of an identification, fitted once more by simulation.

Several runs: those fitted before, judged on the one held out. A single run: its first seven tenths,
judged on the rest, for a simulation cannot leave out blocks. How a held-out run begins is read off
its own motion, as two numbers: no parameter of the device tells that.
"""

from __future__ import annotations

import math
import time
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from inerter.catalogue.coordinates import NUISANCES
from inerter.identify.channel_filter import Filter, filtered
from inerter.identify.fit import Fit, parameter_correlation, parameter_errors
from inerter.identify.model import Model
from inerter.identify.result import Estimate, Identification, Identified, SimulatedErrors
from inerter.identify.simulated import (
    SimulatedFit,
    Simulator,
    device_from,
    fit_simulated,
    start_from,
)
from inerter.motion_units import words
from inerter.records import Record

SHARE = 0.7
"""Of a single run, what is fitted."""
EXPLAINED = 0.5
"""Displacement error per variation of the displacement, above which a simulation misses it."""
TRIES = 20
"""Most steps of a search."""


def simulated(result: Identification) -> Identification:
    """The identification with its best law fitted by simulation too.

    First come the parameters whose simulation is nearer to the displacement that was held out, of
    those found by simulation and those found before.

    Raises
    ------
    ValueError
        A run that cannot be simulated (not uniform, too short, or the bench fit diverges).
    """
    begin, best, bench = time.perf_counter(), result.best, _Bench(result)
    start = start_from(best.model)
    _, there = bench.fitted(replace(start, free=()))
    fit, here = bench.fitted(start)
    before = replace(best, motion=there)
    after = replace(
        best,
        law=f"{best.law}, simulated",
        device=device_from(fit),
        **_parameters(fit, best),
        **vars(best.judge(fit.model)),
        ends=(),
        notes=() if fit.converged else (f"its search had not ended after {TRIES} steps",),
        converged=fit.converged,
        seconds=best.seconds + time.perf_counter() - begin,
        model=fit.model,
        motion=here,
        worse_than=(),
    )
    rest = result.results[1:]
    if here.relative < EXPLAINED and here.rmse < there.rmse:
        return replace(result, results=(after, before, *rest))
    metre = words(result.motion, "m")
    missed = f"{here.rmse:.3g} {metre} rms ({100 * here.relative:.2g} % of its variation)"
    if here.relative < EXPLAINED:
        note = (
            f"the simulation gave nothing better: its parameters miss the held-out displacement by "
            f"{missed}, those found along the motion by {there.rmse:.3g} {metre}, which are kept"
        )
    else:
        note = (
            f"the simulation does not follow the motion: its best parameters miss the held-out "
            f"displacement by {missed}, and those found along the motion are kept; a force that "
            "the law lacks (try +offset) lets a simulation drift away"
        )
    return replace(result, results=(replace(before, notes=(*before.notes, note)), after, *rest))


class _Bench:
    """The runs of an identification, driven by their forces."""

    def __init__(self, result: Identification) -> None:
        best = result.best
        self.runs = [
            Simulator(_unfiltered(record, best.filters), delay=best.delay) for record in result.used
        ]
        single = len(self.runs) == 1
        self.until = SHARE * result.used[0].duration if single else None
        self.used = [i for i in range(len(self.runs)) if single or result.split.fit[i].any()]
        moved = np.concatenate([record.displacement for record in result.used])
        self.variation = float(np.std(moved))

    def fitted(self, start: Model) -> tuple[SimulatedFit, SimulatedErrors]:
        """A fit to the runs that are not held out, and its displacement errors."""
        fit = fit_simulated([self.runs[i] for i in self.used], start, self.until, TRIES)
        if self.until is None:
            held = [run for i, run in enumerate(self.runs) if i not in self.used]
            begun = [fit_simulated([run], replace(fit.model, free=())) for run in held]
            error = math.sqrt(sum(each.error**2 for each in begun) / len(begun))
        else:
            (run,) = self.runs
            part = slice(round(self.until / run.spacing), run.end)
            rest = (run.record.displacement - fit.displacement[0])[part]
            error = float(np.sqrt(np.mean(rest**2)))
        relative = error / self.variation if self.variation else math.nan
        return fit, SimulatedErrors(fit.error, error, relative)


def _unfiltered(record: Record, filters: Mapping[str, Filter]) -> Record:
    """A record before the low-passes of its channels."""
    before = {
        name: filtered(getattr(record, name), record.sample_interval, by, inverse=True)
        for name, by in filters.items()
    }
    return replace(record, **before)


def _parameters(fit: SimulatedFit, best: Identified) -> dict[str, Any]:
    """Estimates of what a simulation found, of what was told before; their correlation."""
    told = Fit(fit.model, [], fit.covariance, fit.evaluations)
    found = {
        name: Estimate(
            value, error, value - 1.96 * error, value + 1.96 * error, best.parameters[name].unit
        )
        for name, (value, error) in parameter_errors(told).items()
        if name not in NUISANCES and name in best.parameters
    }
    return {"parameters": found, "correlation": parameter_correlation(told, tuple(found))}
