"""One law on bench records: its best fit, and what there is to say of it."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.coordinates import CHANNEL_UNITS, NUISANCES, parameters_of, search_range
from inerter.catalogue.friction import FRICTION
from inerter.core import Device, parameters
from inerter.identify.choices import moved_by_choices
from inerter.identify.correction import allowed_for
from inerter.identify.fit import Fit, Masks, Problem, parameter_correlation, parameter_errors
from inerter.identify.identifiability import identifiability
from inerter.identify.laws import FittedLaw
from inerter.identify.model import Model
from inerter.identify.multistart import search
from inerter.identify.nested import contains, embedded
from inerter.identify.noise import effect_of_noise
from inerter.identify.profile import profile_interval
from inerter.identify.result import Estimate, Figures, Identified
from inerter.identify.runs import BenchRun, thin, whole
from inerter.identify.split import Split, blocks, split
from inerter.identify.turns import with_turns
from inerter.motion_units import parameter_unit
from inerter.records import Record
from inerter.records.motion import Motion as BenchMotion
from inerter.records.motion import smooth
from inerter.records.preparation import Preparation, prepare_again

Array = NDArray[np.float64]

# share of blocks drawn anew for the interval of a held-out error
_RESAMPLES = 400
# how often the cut-off is chosen anew for a fit, and how long the fit then goes on
_CUTOFFS = 3
_EVALUATIONS = 100
WORSE = 1.1
"""How many times the error of a simpler law, on the data fitted, a law may have: what is told is
the error of the whole force, what is minimised that in the band of the motion."""


def prepared(
    records: Sequence[Record],
    preparation: Preparation,
    holdout: Sequence[str],
    fixed: Mapping[str, float | str],
    turns: bool = False,
) -> Data:
    """Smoothed records as what a law is fitted to and judged on, see `needs_turns`."""
    runs = [thin(motion) for motion in preparation.motions]
    raw = [whole(motion) for motion in preparation.motions]
    if turns:
        runs, raw = [with_turns(run) for run in runs], [with_turns(run) for run in raw]
    return Data(
        records=records,
        preparation=preparation,
        runs=runs,
        parted=split(runs, holdout, in_blocks=False),
        raw=raw,
        fixed=fixed,
        holdout=holdout,
        turns=turns,
    )


@dataclass(frozen=True, kw_only=True)
class Data:
    """What every law is fitted to."""

    records: Sequence[Record]
    preparation: Preparation
    runs: Sequence[BenchRun]
    parted: Split
    raw: Sequence[BenchRun]
    fixed: Mapping[str, float | str]
    holdout: Sequence[str]
    turns: bool

    def fitted(
        self, law: FittedLaw, loss: str, starts: int | None, others: Sequence[LawFit]
    ) -> LawFit:
        """The best fit of a law, where `others` are laws that were fitted before."""
        begin = time.perf_counter()
        simpler = [each for each in others if contains(law, each.law, limits=True)]
        models = [each.fit.model for each in simpler]
        found = search(self._problem(), law, self.fixed, loss=loss, starts=starts, simpler=models)
        data, fit, converged = self, found.best, found.converged
        for _ in range(_CUTOFFS):
            again = data._smoothed_for(fit.model)
            if again is data:
                break
            data, fit = again, again._problem().fit(fit.model, _EVALUATIONS, loss)
            converged = fit.evaluations < _EVALUATIONS

        # what a simpler law found at its own cut-off is the last start; robust fits are not for the
        # smallest error
        error = data._fit_error(fit.model)
        best = min(simpler, key=lambda each: each.error, default=None)
        if loss == "linear" and best and best.error * WORSE < error:
            there = self.smoothed_at(best.cutoff)
            last = there._from_simpler(fit.model, best.fit.model, loss)
            if last and (less := there._fit_error(last.model)) < error:
                data, fit, error = there, last, less
                converged = fit.evaluations < _EVALUATIONS
        return LawFit(
            law=law, cutoff=data.preparation.cutoff, fit=fit, error=error, ends=found.ends,
            converged=converged, seconds=time.perf_counter() - begin,
        )  # fmt: skip

    def smoothed_at(self, cutoff: float) -> Data:
        """The same data, smoothed below a cut-off [Hz]."""
        if cutoff == self.preparation.cutoff:
            return self
        motions = [smooth(record, cutoff, self.preparation.channels) for record in self.records]
        again = replace(self.preparation, motions=motions, cutoff=cutoff)
        return prepared(self.records, again, self.holdout, self.fixed, self.turns)

    def _from_simpler(self, model: Model, simpler: Model, loss: str) -> Fit | None:
        """A fit of a model from what a simpler law found on these data."""
        problem = self._problem()
        starts = embedded(model, [simpler], problem.scales)
        fits = [problem.fit(start, _EVALUATIONS, loss) for start in starts]
        return min(fits, key=lambda each: each.cost, default=None)

    def _fit_error(self, model: Model) -> float:
        """Force error on the data fitted [N]."""
        return self._raw_error(model, self.parted.fit)[0]

    def _problem(self) -> Problem:
        """The runs that are fitted."""
        return Problem([self.runs[i] for i in self._used], [self.parted.fit[i] for i in self._used])

    @cached_property
    def inerter(self) -> Model:
        """The ideal inerter behind the channels as stated."""
        sizes = self._problem().scales
        start = {"inertance": sizes.force / sizes.acceleration, "transition_velocity": 1e-4}
        model = Model("none", start, ("inertance",))
        return model.holding(**{k: float(v) for k, v in self.fixed.items() if k in CHANNEL_UNITS})

    @property
    def learnt(self) -> list[NDArray[np.bool_]]:
        """The samples as measured that are fitted, of every run."""
        pairs = zip(self.parted.fit, self.runs, self.raw, strict=True)
        return [np.repeat(m, run.thinned)[: raw.force.size] for m, run, raw in pairs]

    @property
    def _used(self) -> list[int]:
        return [i for i, mask in enumerate(self.parted.fit) if mask.any()]

    def _smoothed_for(self, model: Model) -> Data:
        """The same data, smoothed as suits the model; itself where that changes nothing."""

        def error(motions: Sequence[BenchMotion], masks: Masks) -> float:
            # what is held out has no say
            smoothed = replace(self.preparation, motions=list(motions))
            data = prepared(self.records, smoothed, self.holdout, self.fixed, self.turns)
            parts = zip(data.parted.fit, masks, data.runs, strict=True)
            return data._raw_error(model, [f & m[:: r.thinned] for f, m, r in parts])[0]

        preparation = prepare_again(self.records, self.preparation, error)
        return (
            self
            if preparation is self.preparation
            else prepared(self.records, preparation, self.holdout, self.fixed, self.turns)
        )

    def told(self, fitted: LawFit, intervals: str) -> Told:
        """What there is to say of a fit to these data."""
        begin, data = time.perf_counter(), self.smoothed_at(fitted.cutoff)
        problem, used, fit = data._problem(), data._used, fitted.fit
        jacobian = problem.jacobian(fit.model)
        noise = effect_of_noise(
            problem, fit.model, jacobian, data.preparation, data.records, used,
            with_turns if data.turns else None,
        )  # fmt: skip
        choices = moved_by_choices(
            problem, fit.model, [data.records[i] for i in used], data.preparation.channels,
            with_turns if data.turns else None,
        )  # fmt: skip
        better, inflation = allowed_for(problem, fit, jacobian, noise, choices)
        estimates, correlation = data._estimates(problem, fit, better, inflation, intervals)
        typical = float(np.median(inflation)) if inflation.size else 1.0
        return Told(
            model=better.model,
            parameters=estimates,
            correlation=correlation,
            inflation=typical,
            figures=data._figures(typical, better.model),
            notes=tuple(_notes(problem, fit, fitted.ends)),
            seconds=time.perf_counter() - begin,
        )

    def identified(self, fitted: LawFit, told: Told) -> Identified:
        """A fit to these data and what there is to say of it, as one result."""
        data = self.smoothed_at(fitted.cutoff)
        return Identified(
            law=fitted.law.name,
            device=_bare(told.model.device()),
            delay=told.model.delay,
            parameters=told.parameters,
            correlation=told.correlation,
            **vars(told.figures),
            ends=fitted.ends,
            notes=told.notes,
            converged=fitted.converged,
            seconds=fitted.seconds + told.seconds,
            model=told.model,
            cutoff=fitted.cutoff,
            runs=tuple(data.raw),
            judge=partial(data._figures, told.inflation),
        )

    def _figures(self, inflation: float, model: Model) -> Figures:
        """What is told of a model on these data; `inflation` as in `identifiability`."""
        told = identifiability(self._problem(), model, inflation, tuple(self.fixed))
        rmse, low, high, nrmse = self._held_out(model)
        return Figures(
            undetermined=told.groups,
            combinations=told.combinations,
            fit_rmse=self._raw_error(model, self.parted.fit)[0],
            rmse=rmse,
            low=low,
            high=high,
            nrmse=nrmse,
        )

    def _estimates(
        self, problem: Problem, fit: Fit, better: Fit, inflation: Array, intervals: str
    ) -> tuple[dict[str, Estimate], Array]:
        errors = {
            name: pair for name, pair in parameter_errors(better).items() if name not in NUISANCES
        }
        typical = float(np.median(inflation)) if inflation.size else 1.0
        found = {}
        for name, (value, error) in errors.items():
            low: float | None = value - 1.96 * error
            high: float | None = value + 1.96 * error
            if intervals == "profile" and error > 0:
                low, high = _profile(problem, fit, name, value, error, typical)
            known = CHANNEL_UNITS.get(name) or parameters()[name].unit
            unit = parameter_unit(self.runs[0].motion, name, known)
            found[name] = Estimate(value, error, low, high, unit)
        return found, parameter_correlation(better, tuple(found))

    def _at_measured_rate(self, masks: Sequence[NDArray[np.bool_]]) -> Problem:
        """The runs at the measured rate, where thinned samples are masked."""
        wide = [np.zeros(run.force.size, bool) for run in self.raw]
        for target, mask, run in zip(wide, masks, self.runs, strict=True):
            full = np.repeat(mask, run.thinned)[: target.size]
            target[: full.size] = full
        return Problem(self.raw, wide)

    def _raw_error(self, model: Model, masks: Sequence[NDArray[np.bool_]]) -> tuple[float, Array]:
        """Force error [N] at the measured rate, and its squares over blocks."""
        problem = self._at_measured_rate(masks)
        residual = problem.residual(model)
        parts = blocks(problem.masks)
        squares = np.array([[np.sum(residual[i][at] ** 2), at.size] for i, at in parts])
        if not len(squares):
            return math.nan, np.zeros((0, 2))
        return float(np.sqrt(squares[:, 0].sum() / squares[:, 1].sum())), squares

    def _held_out(self, model: Model) -> tuple[float, float, float, float]:
        """Error, its interval from resampled blocks, and the error per spread of the force."""
        value, squares = self._raw_error(model, self.parted.holdout)
        if not squares.size:
            return value, math.nan, math.nan, math.nan
        random = np.random.default_rng(0)
        drawn = random.integers(0, len(squares), (_RESAMPLES, len(squares)))
        sums = squares[drawn].sum(axis=1)
        low, high = np.quantile(np.sqrt(sums[:, 0] / sums[:, 1]), (0.025, 0.975))
        masks = self._at_measured_rate(self.parted.holdout).masks
        held = np.concatenate([r.force[m] for r, m in zip(self.raw, masks, strict=True)])
        return value, float(low), float(high), value / (float(np.std(held)) or 1.0)


@dataclass(frozen=True, kw_only=True)
class LawFit:
    """A law's best fit: below which the motion was used [Hz], force error on the data fitted [N],
    where the fits from other starts ended [N], and the time that it took [s].
    """

    law: FittedLaw
    cutoff: float
    fit: Fit
    error: float
    ends: tuple[float, ...]
    converged: bool
    seconds: float


@dataclass(frozen=True, kw_only=True)
class Told:
    """What there is to say of a fit, see `Identified`; the `inflation` as in `identifiability`."""

    model: Model
    parameters: Mapping[str, Estimate]
    correlation: Array
    inflation: float
    figures: Figures
    notes: tuple[str, ...]
    seconds: float


def _profile(
    problem: Problem, fit: Fit, name: str, value: float, error: float, inflation: float
) -> tuple[float | None, float | None]:
    """Ends of the interval, moved by what the noise's bias moved the value by."""

    def quantity(model: Model) -> float:
        if name == "delay":
            return model.delay
        return float(parameters_of(model.values)[name])

    naive = parameter_errors(fit)[name][1]
    ratio = (error / naive) ** 2 if naive > 0 else 1.0
    low, high = profile_interval(problem, fit.model, quantity, error, max(inflation, ratio))
    shift = value - quantity(fit.model)
    return (None if low is None else low + shift, None if high is None else high + shift)


def _bare(device: Device) -> Device:
    """Without parameters that its friction law does not read, and without zeros."""
    known = parameters()
    kept = {
        name: value
        for name, value in device.given.items()
        if name not in known
        or (
            value != 0
            and (not known[name].laws or device.friction in known[name].laws)
            and not (name in NUISANCES and not FRICTION[device.friction].smoothed)
        )
    }
    return Device(**kept)


def _notes(problem: Problem, fit: Fit, ends: tuple[float, ...]) -> list[str]:
    notes = []
    for name in fit.model.free:
        if name in NUISANCES:
            continue
        how, value = search_range(name, problem.scales), fit.model.values[name]
        words = name.replace("_", " ")
        if math.isfinite(how.upper) and value >= how.upper * (1 - 1e-4):
            notes.append(f"{words} is at the upper end of its range, {how.upper:.4g}")
        elif value <= how.lower * (1 + 1e-4) and (how.lower != 0 or value <= 1e-6 * how.size):
            notes.append(f"{words} is at the lower end of its range, {how.lower:.4g}")
    if len(ends) > 1 and ends[0] > 0:
        other = sum(end > 1.01 * ends[0] for end in ends)
        if other == len(ends) - 1:
            notes.append("only one start led to this fit: more starts may find a better one")
    return notes
