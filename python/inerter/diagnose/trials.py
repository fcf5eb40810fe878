"""Fits of candidates on top of a model: many are tried, few are followed to their end."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial
from typing import Any, TypeGuard

import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.friction import FRICTION
from inerter.diagnose.candidate import Candidate
from inerter.diagnose.decision import CRITERIA
from inerter.diagnose.promise import Known, Promise
from inerter.diagnose.sized import Sized
from inerter.diagnose.time_limit import TimeLimit
from inerter.estimation.solution import NotFiniteError
from inerter.identify.fit import Fit, Masks, Problem, rms
from inerter.identify.model import Model
from inerter.parallel_steps import parallel

Array = NDArray[np.float64]

# share of the cost below which a step of a fit that is only compared changes nothing
ROUGH = 1e-5
# share of the error that it must have taken away after a few evaluations to be followed, and how
# near the second best start must come to the best to be followed too
HOPELESS = 0.002
FEW = 8
NEAR = 1.1
# how far above that limit another friction law, which begins elsewhere, is followed as long again
ON_ITS_WAY = 1.5
# how far above what it has to reach, or the best, a candidate may be after these to be followed
FAR = 2.0
# evaluations of a fit at most, and steps that tell its pace
MOST = 40
STEPS = 3
# evaluations on part of the data after which that is asked first
FEWEST = 5
# how far above what it has to beat a fit to part of the data may be to be followed
AT_LEAST = 1.5
# share of the way to the error that a rival needs which a step of Gauss and Newton has to foretell
FORETOLD = 0.5
# how many times what a step foretells a candidate may take of the square of an error
AT_BEST = 3.0
# plain effects that are asked where nothing of a shortlist is there
PLAIN = 3
# coordinates of a model from which on starting points are compared beside it
MANY = 10
# errors this near belong to the same fit
SAME = 1e-5
# sizes of a play that are followed; between two that are five times apart a fit goes astray
SIZES = 4
# share of every run on which the starting points of a fit are compared
STARTING_SHARE = 0.3

# effects that a friction law without memory is named as
MEMORYLESS = {law.effect for law in FRICTION.values() if law.effect and not law.memory}

# errors [N] of all fit data and of the part that starting points are compared on
Limits = tuple[float, float]


class Pace:
    """Whether a fit still comes down to a limit [N] at the pace of its last steps.

    It slows down as it comes near its end: at a steady pace it would be there sooner.
    """

    def __init__(self, limit: float) -> None:
        self.limit = limit
        self._last: list[tuple[int, float]] = []

    def hopeless(self, done: int, error: float) -> bool:
        """Told evaluations so far and error [N]: not even twice as fast in all that are left."""
        self._last.append((done, error))
        if len(self._last) <= STEPS or error < self.limit:
            return False
        before, was = self._last[-1 - STEPS]
        pace = (was - error) / max(done - before, 1)
        return 2 * pace * (MOST - done) < error - self.limit


def within_shortlist(errors: Sequence[float]) -> float:
    """The largest error of candidates that would be checked, if none came down any more."""
    near = (1 + 5 * CRITERIA.tolerated_loss) * min(errors, default=np.inf)
    return max(sorted(errors)[: CRITERIA.shortlist][-1], near) if errors else np.inf


def shortlist_of(
    worthy: Sequence[tuple[Candidate, Fit]], floor: float, masks: Masks
) -> list[tuple[Candidate, Fit]]:
    """The best of fitted candidates, and those that come near the least error of all [N].

    Simpler ones that are nearly as good must have their chance.
    """
    near = floor * (1 + 5 * CRITERIA.tolerated_loss)
    best, rest = worthy[: CRITERIA.shortlist], worthy[CRITERIA.shortlist :]
    return [*best, *(pair for pair in rest if pair[1].rmse(masks) < near)]


def plain_beside(
    shortlist: Sequence[tuple[Candidate, Fit]],
    worthy: Sequence[tuple[Candidate, Fit]],
    complexity: int,
) -> tuple[list[tuple[Candidate, Fit]], list[tuple[Candidate, Fit]]]:
    """What is asked where nothing of a shortlist is there: plain effects that it has kept out.

    First the friction level alone, on which others stand; then the best of those that add one
    coordinate to a model of this complexity: that a curve is not there says nothing of a damper.
    """
    rest = [pair for pair in worthy if not any(pair is each for each in shortlist)]
    level = [pair for pair in rest if pair[0].effect == "coulomb_friction"]
    one = [pair for pair in rest if pair[1].model.complexity == complexity + 1]
    return level, [pair for pair in one if not any(pair is each for each in level)][:PLAIN]


def _at_best(foretold: float, current: float) -> float:
    """Error [N] of a candidate that takes several times what a step foretells of the square."""
    return float(np.sqrt(max(current**2 - AT_BEST * (current**2 - foretold**2), 0.0)))


def of_each_size(starts: Sequence[Model], errors: Sequence[float]) -> list[Model]:
    """Of each size of play the starting point with the least error, the best few first.

    A play that does next to nothing is never far off, and need not be the nearest when fitted.
    """
    best: dict[float, Model] = {}
    for i in np.argsort(errors):
        best.setdefault(starts[i].values["backlash"], starts[i])
    return list(best.values())[:SIZES]


def has_much(known: Known | None) -> TypeGuard[Known]:
    """Whether what is known is of a model that takes long: much is free, or rubs behind a shaft.

    There what a candidate adds is fitted beside it, and not all of it at once.
    """
    return known is not None and (len(known.model.free) >= MANY or known.model.rubs_behind)


def _asked_for(candidate: Candidate, model: Model) -> bool:
    """Whether other candidates are judged by it: another friction law, a delay."""
    return candidate.effect == "sensor_delay" or candidate.starts[0].friction != model.friction


def _cost(candidate: Candidate) -> float:
    """Of what order the time is that starting points take: a flywheel on a spring is slow."""
    first = candidate.starts[0]
    slow = 4 if "backlash" in first.values or first.shaft else 1
    return slow * len(candidate.starts) * (1 + len(first.free))


class Trials:
    """The candidates of a search fitted to its data; what was fitted before is remembered."""

    def __init__(self, problem: Problem, time: TimeLimit | None = None) -> None:
        self.problem = problem
        self._time = time or TimeLimit()
        self._part = problem.head(STARTING_SHARE)
        self._rounds: list[tuple[Fit, list[tuple[Candidate, Fit]]]] = []

    def __getstate__(self) -> dict[str, object]:
        """What another process is told: it looks nothing up."""
        return {**self.__dict__, "_rounds": []}

    def fit(
        self,
        candidate: Candidate,
        limits: Limits = (np.inf, np.inf),
        reach: float = np.inf,
        known: Known | None = None,
    ) -> Fit:
        """Best fit over a candidate's starting points, which are compared on part of the data.

        What after a few steps from each of them is not below the first of the `limits` [N], or on
        that part anywhere near the second, is not followed further; nor what does not come down to
        what is within `reach` [N] at its pace. Derivatives `known` of a model with much that is
        free, which the candidate adds to, are begun with.
        """
        known = known if has_much(known) else None
        return self._followed(self._rough(candidate, limits, known), limits[0], reach, known)

    def _rough(self, candidate: Candidate, limits: Limits, known: Known | None = None) -> list[Fit]:
        """A few steps from the best starting points, with derivatives `known` of most of it."""
        starts = candidate.starts
        if candidate.effect == "backlash":
            errors = [rms(self._part.residual(start), self._part.masks) for start in starts]
            starts = of_each_size(starts, errors)
        if len(starts) > 1:
            best = self._compared(starts, limits, known)
            if isinstance(best, Fit):
                return [best]
            starts = best
        fits = []
        for start in starts:
            near = known.near(self.problem, start, has_much(known)) if known else None
            try:
                fit = self.problem.fit(start, FEW, tolerance=ROUGH, rough=True, near=near)
            except NotFiniteError:
                # the part that starting points are compared on did not show it
                continue
            elsewhere = known and start.friction != known.model.friction
            on_its_way = limits[0] <= fit.rmse(self.problem.masks) < ON_ITS_WAY * limits[0]
            if elsewhere and on_its_way and fit.evaluations >= FEW:
                fit = self.problem.fit(fit.model, FEW, tolerance=ROUGH, rough=True)
            fits.append(fit)
        return fits or [self._as_is(self.problem, candidate.starts[0])]

    def _compared(
        self, starts: Sequence[Model], limits: Limits, known: Known | None
    ) -> Sequence[Model] | Fit:
        """Where the best starting points lead in a few steps; the fit of one that is hopeless."""
        # states take time to follow; what has none is compared wherever it may show
        fast = all(not start.device().nstate for start in starts)
        part, evaluations = (self.problem, 6) if fast else (self._part, 10)
        limit, limit_of_part = limits

        def hopeless(done: int, error: float) -> bool:
            return not fast and done >= FEWEST and error > FAR * AT_LEAST * limit_of_part

        trials: list[Fit] = []
        for start in starts:
            beside = known.beside(part, start, evaluations, 1e-3) if has_much(known) else None
            if beside:
                trials.append(self._as_is(part, beside))
                continue
            near = known.near(part, start) if known else None
            with suppress(NotFiniteError):
                fit = part.fit(
                    start, evaluations, tolerance=1e-3, give_up=hopeless, rough=True, near=near
                )
                trials.append(fit)
        if not trials:
            return self._as_is(self.problem, starts[0])
        trials.sort(key=lambda fit: fit.rmse(part.masks))
        best = trials[0].rmse(part.masks)
        if best > (limit if fast else AT_LEAST * limit_of_part):
            residual = self.problem.residual(trials[0].model)
            return replace(trials[0], residual=residual, evaluations=1)
        near_best = [fit.model for fit in trials[:2] if fit.rmse(part.masks) < NEAR * best]
        return near_best or [trials[0].model]

    @staticmethod
    def _as_is(problem: Problem, model: Model) -> Fit:
        """A model as it is, whose errors nobody asks for."""
        size = len(model.free)
        return Fit(model, problem.residual(model), np.zeros((size, size)), 1, rough=True)

    def _followed(
        self,
        rough: Sequence[Fit],
        limit: float,
        reach: float = np.inf,
        known: Known | None = None,
    ) -> Fit:
        """The best of them; those below a limit [N] are followed to their end first.

        What cannot come down to what is within `reach` [N] at its pace is followed no further.
        Derivatives that are `known` of most of a model with much that is free are begun with.
        """
        masks = self.problem.masks

        def followed(fit: Fit) -> Fit:
            how: dict[str, Any] = {"tolerance": ROUGH, "give_up": Pace(reach).hopeless}
            if has_much(known):
                how["near"] = known.near(self.problem, fit.model, loosely=True)
            return self.problem.fit(fit.model, MOST, **how)

        fits = [
            followed(fit) if fit.evaluations >= FEW and fit.rmse(masks) < limit else fit
            for fit in rough
        ]
        return min(fits, key=lambda fit: fit.rmse(masks))

    def refits(self, models: Sequence[Model], limit: float) -> list[Fit]:
        """Fits of models, each given up where it cannot come down to a limit [N] at its pace."""
        return parallel(lambda m: self.problem.fit(m, give_up=Pace(limit).hopeless), models)

    def fit_all(
        self,
        candidates: Sequence[Candidate],
        current: Fit,
        aim: Fit | None = None,
        least: float = CRITERIA.gain,
    ) -> list[tuple[Candidate, Fit]]:
        """Fits of candidates, the best first; rough of what stays far above the best or the `aim`.

        None of what will not take the share `least` of the error away.
        Raises OverTimeError where the time of the search ends meanwhile.

        The laws with many parameters are tried where the simple law with memory, Dahl's, does
        better than friction without memory and not far worse than what does best, or is in the
        model already.
        """
        masks = self.problem.masks
        limits = self._limits(current, 1 - HOPELESS)
        likely = (1 - CRITERIA.likely * least) * current.rmse(masks)
        if aim:
            far = self._limits(aim, FAR)
            limits = min(limits[0], far[0]), min(limits[1], far[1])
            # a step is to foretell some of the way to where a rival is looked at further
            reach, error = CRITERIA.beaten * aim.rmse(masks), current.rmse(masks)
            likely = min(likely, far[0], error - FORETOLD * max(error - reach, 0.0))
        known = self._fitted_before(current)
        at_current = Known(self.problem, current.model)
        promise, sized = Promise(self.problem, at_current), Sized(self.problem, at_current)
        rich = [t for t in candidates if t.is_rich]
        plain = [t for t in candidates if not t.is_rich]

        def fits(some: list[Candidate]) -> list[tuple[Candidate, Fit]]:
            new = [sized.of(t) for t in some if t.key not in known]
            found = [(t, known[t.key]) for t in some if t.key in known]
            foretold = {t.key: promise.foretold(t) for t in new}
            new = sorted(
                (t for t in new if foretold[t.key] < likely), key=lambda t: foretold[t.key]
            )
            # in a second turn what may come so near as to be looked at further
            told = [t for t in new if foretold[t.key] and not _asked_for(t, current.model)]
            later = told[CRITERIA.shortlist :]
            for part in ([t for t in new if t not in later], later):
                so_far = [fit.rmse(masks) for _, fit in [*fitted, *found]]
                reach = CRITERIA.beaten * aim.rmse(masks) if aim else within_shortlist(so_far)
                error = current.rmse(masks)
                likely_enough = [
                    t for t in part
                    if part is not later or _at_best(foretold[t.key], error) < reach
                ]  # fmt: skip

                def begun(trial: Candidate) -> list[Fit]:
                    self._time.check()
                    return self._rough(trial, limits, at_current)

                def ended(rough: Sequence[Fit], limit: float, reach: float) -> Fit:
                    self._time.check()
                    return self._followed(rough, limit, reach, at_current)

                rough = parallel(begun, likely_enough, _cost)
                so_far += [min(fit.rmse(masks) for fit in each) for each in rough]
                limit = min([limits[0], *(FAR * error for error in so_far)])
                if not aim:
                    reach = within_shortlist(so_far)
                followed = parallel(partial(ended, limit=limit, reach=reach), rough)
                found += zip(likely_enough, followed, strict=True)
            return found

        fitted: list[tuple[Candidate, Fit]] = []
        fitted += fits(plain)
        error = {(t.effect, t.law): fit.rmse(masks) for t, fit in fitted}
        memory = error.get(("hysteretic_friction", "dahl"))
        others = [current.rmse(masks), *(e for key, e in error.items() if key[0] in MEMORYLESS)]
        near = FAR * min((fit.rmse(masks) for _, fit in fitted), default=np.inf)
        if memory is None or memory < min((1 - CRITERIA.gain) * min(others), near):
            fitted += fits(rich)
        self._rounds.append((current, fitted))
        return sorted(fitted, key=lambda pair: pair[1].rmse(masks))

    def within_reach(
        self, candidates: Sequence[Candidate], fit: Fit, limit: float
    ) -> list[Candidate]:
        """Those that a step from a fitted model tells may come down to an error [N]."""
        promise = Promise(self.problem, Known(self.problem, fit.model))
        error = fit.rmse(self.problem.masks)
        return [c for c in candidates if _at_best(promise.foretold(c), error) < limit]

    def _limits(self, fit: Fit, share: float) -> Limits:
        """A share of a fit's errors."""
        part = rms(self._part.residual(fit.model), self._part.masks)
        return share * fit.rmse(self.problem.masks), share * part

    def _fitted_before(self, current: Fit) -> dict[object, Fit]:
        """What was fitted on top of the same model before, by candidate."""
        masks = self.problem.masks
        for base, fitted in self._rounds:
            same = base.model.shape == current.model.shape
            if same and abs(base.rmse(masks) - current.rmse(masks)) < SAME * current.rmse(masks):
                return {candidate.key: fit for candidate, fit in fitted}
        return {}
