"""Parameters of a device from bench records: value, error, interval, and what is left open.

Every law is fitted to the runs that are not held out, from many starts; noise of the motion is
allowed for; laws are compared by their force error on the held-out data.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from inerter.catalogue.coordinates import CHANNEL_UNITS, NUISANCES, parameters_of, search_range
from inerter.catalogue.friction import FRICTION
from inerter.core import WORDS, Device, parameters
from inerter.identify.channel_filter import Filter, named
from inerter.identify.choices import moved_by_choices
from inerter.identify.correction import allowed_for
from inerter.identify.fit import Fit, Masks, Problem, parameter_correlation, parameter_errors
from inerter.identify.identifiability import identifiability
from inerter.identify.instants import at_instants, with_instants
from inerter.identify.laws import LAWS, FittedLaw, law_named
from inerter.identify.model import Model
from inerter.identify.multistart import Multistart, search
from inerter.identify.nested import contains, embedded
from inerter.identify.noise import effect_of_noise
from inerter.identify.profile import profile_interval
from inerter.identify.result import Estimate, Figures, Identification, Identified
from inerter.identify.runs import BenchRun, thin, whole
from inerter.identify.split import Split, blocks, split
from inerter.identify.turns import needs_turns, with_turns
from inerter.motion_units import one_motion, parameter_unit
from inerter.records import Record
from inerter.records.duplicates import without_copies
from inerter.records.motion import Motion as BenchMotion
from inerter.records.preparation import (
    Preparation,
    prepare,
    prepare_again,
    refuse_unusable,
)

Array = NDArray[np.float64]
Progress = Callable[[float, str], None]

LOSSES = ("linear", "soft_l1", "huber", "cauchy")
INTERVALS = ("profile", "normal")

# share of blocks drawn anew for the interval of a held-out error
_RESAMPLES = 400
# how often the cut-off is chosen anew for a fit, and how long the fit then goes on
_CUTOFFS = 3
_EVALUATIONS = 100
# how many times the error of a simpler law, on the data fitted, a law may have: what is told is the
# error of the whole force, what is minimised that in the band of the motion
WORSE = 1.1


def identify(
    records: Sequence[Record],
    laws: Sequence[str] = LAWS,
    *,
    fixed: Mapping[str, float | str] | None = None,
    filters: Mapping[str, Filter] | None = None,
    holdout: Sequence[str] = (),
    loss: str = "linear",
    intervals: str = "profile",
    starts: int | None = None,
    progress: Progress = lambda share, text: None,
) -> Identification:
    """Fit laws to bench records.

    Parameters
    ----------
    records
        One or several runs; all of them are fitted together, but for copies of another (those with
        the warning `duplicate_record`), which are left out.
    laws
        What to fit, see `inerter.identify.laws`.
    fixed
        Parameters that are known, SI units.
    filters
        Low-passes that the channels "force" and "displacement" are known to have gone through.
    holdout
        Names of runs to judge on; by default the most typical one, or blocks of a single run.
    loss
        "linear", or one that lets outliers count less: "soft_l1", "huber", "cauchy".
    intervals
        "profile", or "normal" for 1.96 standard errors, which is quicker.
    starts
        Starting points of a search.
    progress
        Told the share that is done, and what is being done.

    Raises
    ------
    DeviceError
        An unknown law or parameter, or values that do not fit together.
    ValueError
        Records that cannot be used, an unknown loss or kind of interval.
    """
    if loss not in LOSSES:
        raise ValueError(f"loss {loss!r}: choose from {', '.join(LOSSES)}")
    if intervals not in INTERVALS:
        raise ValueError(f"intervals {intervals!r}: choose from {', '.join(INTERVALS)}")
    chosen = [law_named(name) for name in laws]
    known = dict(fixed or {})
    for name in known:
        if name not in (*parameters(), *WORDS):
            # says what it may have meant
            Device(**{name: known[name]})
    for channel, low_pass in (filters or {}).items():
        known |= named(channel, low_pass)
    one_motion(records)
    given, records = records, without_copies(records, holdout)
    refuse_unusable(records)
    with threadpool_limits(limits=1, user_api="blas"):
        progress(0.0, "smoothing")
        preparation = prepare(records)
        data = prepared(records, preparation, holdout, known)
        followed = with_instants(records, preparation.motions, data.inerter, data.learnt)
        if followed is not records:
            records, preparation = followed, at_instants(followed, preparation)
            data = prepared(records, preparation, holdout, known)
        bristled = prepared(records, preparation, holdout, known, turns=True)
        found: list[_Fitted] = []
        results: list[Identified] = []
        # simple laws first: what they find is a start for others
        for law in sorted(chosen, key=lambda each: len(each.linear) + len(each.starts)):
            progress((len(found) + 0.1) / len(chosen), law.name)
            suited = bristled if needs_turns(law, known) else data
            fitted = suited.fitted(law, loss, starts, found)
            found.append(fitted)
            results.append(fitted.told(intervals, results if loss == "linear" else ()))
        progress(1.0, "done")
    results.sort(key=lambda result: result.rmse)
    return Identification(tuple(given), tuple(results), preparation, data.parted)


def prepared(
    records: Sequence[Record],
    preparation: Preparation,
    holdout: Sequence[str],
    fixed: Mapping[str, float | str],
    turns: bool = False,
) -> _Data:
    """Smoothed records as what a law is fitted to and judged on, see `needs_turns`."""
    runs = [thin(motion) for motion in preparation.motions]
    raw = [whole(motion) for motion in preparation.motions]
    if turns:
        runs, raw = [with_turns(run) for run in runs], [with_turns(run) for run in raw]
    return _Data(
        records=records,
        preparation=preparation,
        runs=runs,
        parted=split(runs, holdout),
        raw=raw,
        fixed=fixed,
        holdout=holdout,
        turns=turns,
    )


@dataclass(frozen=True, kw_only=True)
class _Data:
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
        self, law: FittedLaw, loss: str, starts: int | None, others: Sequence[_Fitted]
    ) -> _Fitted:
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
        fitted = _Fitted(law=law, data=data, found=found, fit=fit, converged=converged, begin=begin)

        # what a simpler law found at its own cut-off is the last start; robust fits are not for the
        # smallest error
        best = min(simpler, key=lambda each: each.error, default=None)
        if loss == "linear" and best and best.error * WORSE < fitted.error:
            fitted = min(fitted, fitted.from_simpler(best, loss), key=lambda each: each.error)
        return fitted

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

    def _smoothed_for(self, model: Model) -> _Data:
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

    def told(self, fitted: _Fitted, intervals: str) -> Identified:
        """What there is to say of a fit to these data."""
        problem, used = self._problem(), self._used
        law, found, fit = fitted.law, fitted.found, fitted.fit
        jacobian = problem.jacobian(fit.model)
        noise = effect_of_noise(
            problem, fit.model, jacobian, self.preparation, self.records, used,
            with_turns if self.turns else None,
        )  # fmt: skip
        choices = moved_by_choices(
            problem, fit.model, [self.records[i] for i in used], self.preparation.channels,
            with_turns if self.turns else None,
        )  # fmt: skip
        better, inflation = allowed_for(problem, fit, jacobian, noise, choices)
        estimates, correlation = self._estimates(problem, fit, better, inflation, intervals)
        typical = float(np.median(inflation)) if inflation.size else 1.0
        judge = partial(self._figures, typical)
        model = better.model
        device = model.device()
        return Identified(
            law=law.name,
            device=_bare(device),
            delay=model.delay,
            parameters=estimates,
            correlation=correlation,
            **vars(judge(model)),
            ends=found.ends,
            notes=tuple(_notes(problem, fit, found.ends)),
            converged=fitted.converged,
            seconds=time.perf_counter() - fitted.begin,
            model=model,
            cutoff=self.preparation.cutoff,
            runs=tuple(self.raw),
            judge=judge,
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
class _Fitted:
    """A law's best fit, the data as smoothed for it, and when work on it began."""

    law: FittedLaw
    data: _Data
    found: Multistart
    fit: Fit
    converged: bool
    begin: float

    @cached_property
    def error(self) -> float:
        """Force error on the data fitted [N]."""
        return self.data._raw_error(self.fit.model, self.data.parted.fit)[0]

    def from_simpler(self, other: _Fitted, loss: str) -> _Fitted:
        """A fit from what a simpler law found, at that law's cut-off."""
        data = prepared(
            self.data.records, other.data.preparation, self.data.holdout, self.data.fixed,
            self.data.turns,
        )  # fmt: skip
        problem = data._problem()
        starts = embedded(self.fit.model, [other.fit.model], problem.scales)
        fits = [problem.fit(start, _EVALUATIONS, loss) for start in starts]
        if not fits:
            return self
        fit = min(fits, key=lambda each: each.cost)
        return replace(self, data=data, fit=fit, converged=fit.evaluations < _EVALUATIONS)

    def told(self, intervals: str, others: Sequence[Identified]) -> Identified:
        """What there is to say of the fit, beside those of `others`."""
        told = self.data.told(self, intervals)
        worse = tuple(
            each.law
            for each in others
            if each.fit_rmse * WORSE < told.fit_rmse
            and contains(self.law, law_named(each.law), limits=True)
        )
        return replace(told, worse_than=worse)


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
