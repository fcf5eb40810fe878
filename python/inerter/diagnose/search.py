"""The search for what a model lacks: add the effect that predicts best, repeat, prune.

Every decision is made on folds of the fit data that the model in question was not fitted to; the
held-out data are not touched here. Among candidates that do about equally well the one with the
fewest parameters is taken.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from inerter.diagnose.candidate import Candidate
from inerter.diagnose.candidates import candidates
from inerter.diagnose.composition import (
    effects_of,
    is_distinct,
    simpler_laws,
    without_effect,
)
from inerter.diagnose.parallel import parallel
from inerter.diagnose.promise import Promise
from inerter.diagnose.statistics import (
    Array,
    advantage,
    block_squares,
    where_apart,
)
from inerter.diagnose.tone import strongest_line
from inerter.identify.bench import Run, head, head_size
from inerter.identify.fit import Fit, Problem, rms
from inerter.identify.model import Model
from inerter.identify.split import Mask, Split, blocks, spread_folds

# what a richer model must win by: standard errors over paired blocks, and share of the rms error.
# 4 standard errors: about one false alarm in 30,000 candidates on noise alone. A gain many times
# the smallest one cannot come from noise; there 2 guard against one lucky stretch.
REQUIRED_ADVANTAGE = 4.0
REQUIRED_GAIN = 0.01
LARGE_ADVANTAGE = 2.0
LARGE_GAIN = 0.05
# standard errors by which an effect's own parameter must differ from none
REQUIRED_DISTINCTION = 3.0
# how much a simpler candidate may lose against the best and still be taken
TOLERATED_ADVANTAGE = 3.0
LARGE_TOLERATED_ADVANTAGE = 6.0
TOLERATED_LOSS = 0.01
# removing an effect that is worth less than this many standard errors
KEEPING_ADVANTAGE = 2.0
MOST_EFFECTS = 8
# candidates that are worth cross-validating in one round
SHORTLIST = 5
# share of the cost below which a step of a fit that is only compared changes nothing
ROUGH = 1e-5
# effects that may show in few stretches, or in one run alone
LOCAL = ("end_stop", "sensor_saturation", "gas_spring", "hardening_stiffness")
# share of the error that a candidate must have taken away after a few evaluations to be followed,
# and must be foretold to take away to be tried; and how near the second best start must come to the
# best to be followed too
HOPELESS = 0.002
LIKELY = 0.7 * REQUIRED_GAIN
FEW = 8
NEAR = 1.1
# how far above what it has to reach, or the best, a candidate may be after these to be followed
FAR = 2.0
# evaluations on part of the data after which that is asked first
FEWEST = 5
# starting points of a free play that are tried, and how far above what it has to beat a fit to part
# of the data may be to be followed
NEAREST = 3
AT_LEAST = 1.5
# errors this near belong to the same fit
SAME = 1e-5
# share of the rms error that these must take away where they show
LOCAL_GAIN = 0.5
# share of every run on which the starting points of a fit are compared
STARTING_SHARE = 0.3
# effects that a friction law cannot stand in for
UNLIKE_FRICTION = (
    *LOCAL,
    "series_elasticity",
    "backlash",
    "periodic_disturbance",
    "parallel_stiffness",
    "variable_inertance",
    "force_drift",
)
# laws that are tried only where memory is to be seen
RICH_LAWS = ("lugre", "bouc_wen")

Progress = Callable[[str], None]
Folds = list[tuple[Problem, list[Mask]]]
# errors [N] of all fit data and of the part that starting points are compared on
Limits = tuple[float, float]


def advantage_of(
    simple: Sequence[Array],
    rich: Sequence[Array],
    masks: Sequence[Mask],
    stretches: Sequence[tuple[int, NDArray]],
    effect: str,
) -> float:
    """`statistics.advantage` of residuals, over the stretches where the effect may show.

    What shows in few places has to explain most of what is missed there: peaks, where such effects
    lie, are where a slightly wrong model errs most.
    """
    if effect in LOCAL:
        stretches = where_apart(simple, rich, masks)
    before, after = block_squares(simple, stretches), block_squares(rich, stretches)
    if effect in LOCAL and after.sum() > (1 - LOCAL_GAIN) ** 2 * before.sum():
        return 0.0
    return advantage(before, after)


@dataclass(frozen=True)
class Scored:
    """A fitted candidate and its errors on left-out folds.

    Attributes
    ----------
    errors : list of ndarray
        Measured minus predicted force of every run [N].
    residual : list of ndarray
        The same as it counts against noise.
    squares : ndarray
        Squares of the residual, summed over blocks.
    """

    effect: str
    law: str | None
    fit: Fit
    errors: list[Array]
    residual: list[Array]
    squares: Array

    @property
    def model(self) -> Model:
        """The fitted model."""
        return self.fit.model


@dataclass
class Search:
    """A search over the fit data of a split."""

    runs: Sequence[Run]
    split: Split
    baseline: Model
    progress: Progress = lambda text: None
    found: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.problem = Problem(self.runs, self.split.fit)
        self.blocks = blocks(self.problem.masks)
        self._part = Problem(
            [head(run, STARTING_SHARE) for run in self.runs],
            [
                m[: head_size(run, STARTING_SHARE)]
                for m, run in zip(self.split.fit, self.runs, strict=True)
            ],
            self.problem.scales,
        )
        self._rounds: list[tuple[Fit, list[tuple[Candidate, Fit]]]] = []
        self._folds = self._problems(self.split.folds)
        self._spread = self._problems(spread_folds(self.split.fit))

    def _problems(self, folds: Sequence[list[Mask]]) -> Folds:
        """The fit data without each fold, and the fold."""
        return [
            (
                Problem(
                    self.runs,
                    [f & ~left for f, left in zip(self.split.fit, fold, strict=True)],
                    self.problem.scales,
                ),
                fold,
            )
            for fold in folds
        ]

    def run(self, start: Model | None = None, until: str | None = None) -> Scored:
        """Search from a model, by default the baseline; the extended one, fitted to all fit data.

        Where the effect `until` is found the search ends with it, and nothing is pruned.
        """
        start = start or self.baseline
        if any(effect in LOCAL for effect, _ in effects_of(start, self.baseline)):
            self._folds = self._spread
        current = self.score("baseline", None, self.problem.fit(start))
        while len(self.found) < MOST_EFFECTS:
            chosen = self._best_step(current)
            if chosen is None:
                break
            self.found.append(chosen.effect)
            if chosen.effect == until:
                return chosen
            current = self._exchange(chosen)
        return self._prune(current)

    def score(self, effect: str, law: str | None, fit: Fit, folds: Folds | None = None) -> Scored:
        """Squared errors of a fitted model on folds left out of its refits."""
        if not fit.model.free:
            return self._scored(effect, law, fit, self.problem.errors(fit.model))
        left_out = [np.zeros(run.force.size) for run in self.runs]
        for problem, fold in folds or self._folds:
            refitted = problem.fit(fit.model, evaluations=12, tolerance=ROUGH)
            for target, values, mask in zip(
                left_out, problem.errors(refitted.model), fold, strict=True
            ):
                target[mask] = values[mask]
        return self._scored(effect, law, fit, left_out)

    def _scored(self, effect: str, law: str | None, fit: Fit, errors: list[Array]) -> Scored:
        residual = self.problem.weighted(errors)
        return Scored(effect, law, fit, errors, residual, block_squares(residual, self.blocks))

    def advantage(self, simple: Scored, rich: Scored, effect: str) -> float:
        """How surely a model with an effect has smaller errors on left-out folds than without."""
        return advantage_of(simple.residual, rich.residual, self.problem.masks, self.blocks, effect)

    def score_on_blocks(self, fit: Fit) -> Scored:
        """Errors of a fitted model on blocks of every run, left out of its refits."""
        return self.score("", None, fit, self._spread)

    def fit(self, candidate: Candidate, limits: Limits = (np.inf, np.inf)) -> Fit:
        """Best fit over a candidate's starting points, which are compared on part of the data.

        What after a few steps from each of them is not below the first of the `limits` [N], or on
        that part anywhere near the second, is not followed further.
        """
        return self._followed(self._rough(candidate, limits), limits[0])

    def _rough(self, candidate: Candidate, limits: Limits) -> list[Fit]:
        """A few steps from the best starting points."""
        starts = candidate.starts
        limit, limit_of_part = limits
        if candidate.effect == "backlash":
            starts = self._nearest(starts)
        if len(starts) > 1:
            # states take time to follow; what has none is compared wherever it may show
            fast = all(not start.device().nstate for start in starts)
            part, evaluations = (self.problem, 6) if fast else (self._part, 10)

            def hopeless(done: int, error: float) -> bool:
                return not fast and done >= FEWEST and error > FAR * AT_LEAST * limit_of_part

            trials = [
                part.fit(start, evaluations, tolerance=1e-3, give_up=hopeless) for start in starts
            ]
            trials.sort(key=lambda fit: fit.rmse(part.masks))
            best = trials[0].rmse(part.masks)
            if best > (limit if fast else AT_LEAST * limit_of_part):
                residual = self.problem.residual(trials[0].model)
                return [replace(trials[0], residual=residual, evaluations=1)]
            near = [trial for trial in trials[:2] if trial.rmse(part.masks) < NEAR * best]
            starts = tuple(trial.model for trial in near or trials[:1])
        return [self.problem.fit(start, FEW, tolerance=ROUGH) for start in starts]

    def _followed(self, rough: Sequence[Fit], limit: float) -> Fit:
        """The best of them; those below a limit [N] are followed to their end first."""
        masks = self.problem.masks
        fits = [
            self.problem.fit(fit.model, tolerance=ROUGH)
            if fit.evaluations >= FEW and fit.rmse(masks) < limit
            else fit
            for fit in rough
        ]
        return min(fits, key=lambda fit: fit.rmse(masks))

    def _nearest(self, starts: Sequence[Model]) -> list[Model]:
        """The starting points whose errors are least as they are."""
        errors = [rms(self._part.residual(start), self._part.masks) for start in starts]
        return [starts[i] for i in np.argsort(errors)[:NEAREST]]

    def fit_all(
        self, trials: Sequence[Candidate], current: Fit, aim: Fit | None = None
    ) -> list[tuple[Candidate, Fit]]:
        """Fits of candidates, the best first; rough of what stays far above the best or the `aim`.

        The laws with many parameters are tried where the simple law with memory, Dahl's, does
        better than friction without memory, or is in the model already.
        """
        masks = self.problem.masks
        limits = self._limits(current, 1 - HOPELESS)
        likely = (1 - LIKELY) * current.rmse(masks)
        if aim:
            far = self._limits(aim, FAR)
            limits = min(limits[0], far[0]), min(limits[1], far[1])
            likely = min(likely, far[0])
        known = self._fitted_before(current)
        promise = Promise(self.problem, current, likely)
        rich = [t for t in trials if t.law in RICH_LAWS]
        plain = [t for t in trials if t.law not in RICH_LAWS]

        def fits(some: list[Candidate]) -> list[tuple[Candidate, Fit]]:
            new = [t for t in some if t.key not in known and promise.holds(t)]
            old = [(t, known[t.key]) for t in some if t.key in known]
            rough = parallel(lambda t: self._rough(t, limits), new)
            known_errors = [fit.rmse(masks) for _, fit in [*fitted, *old]]
            best = min([*known_errors, *(fit.rmse(masks) for each in rough for fit in each)])
            limit = min(limits[0], FAR * best)
            return [
                *zip(new, parallel(lambda r: self._followed(r, limit), rough), strict=True),
                *old,
            ]

        fitted: list[tuple[Candidate, Fit]] = []
        fitted += fits(plain)
        error = {(t.effect, t.law): fit.rmse(masks) for t, fit in fitted}
        memory = error.get(("hysteretic_friction", "dahl"))
        memoryless = ("coulomb_friction", "stribeck_friction")
        others = [current.rmse(masks), *(e for key, e in error.items() if key[0] in memoryless)]
        if memory is None or memory < (1 - REQUIRED_GAIN) * min(others):
            fitted += fits(rich)
        self._rounds.append((current, fitted))
        return sorted(fitted, key=lambda pair: pair[1].rmse(masks))

    def _limits(self, fit: Fit, share: float) -> Limits:
        """A share of a fit's errors."""
        part = rms(self._part.residual(fit.model), self._part.masks)
        return share * fit.rmse(self.problem.masks), share * part

    def _fitted_before(self, current: Fit) -> dict[object, Fit]:
        """What was fitted on top of the same model before, by candidate."""
        masks = self.problem.masks
        for base, fitted in self._rounds:
            same = (base.model.friction, set(base.model.free)) == (
                current.model.friction,
                set(current.model.free),
            )
            if same and abs(base.rmse(masks) - current.rmse(masks)) < SAME * current.rmse(masks):
                return {candidate.key: fit for candidate, fit in fitted}
        return {}

    def _best_step(self, current: Scored) -> Scored | None:
        """The effect to add next, or None."""
        masks = self.problem.masks
        self.progress(f"effect {len(self.found) + 1}: trying every candidate")
        trials = [*candidates(current.model, self.problem.scales), *self._tones(current.fit)]
        fitted = self.fit_all(trials, current.fit)
        if not fitted:
            return None
        floor = fitted[0][1].rmse(masks)
        worth = (1 - REQUIRED_GAIN) * current.fit.rmse(masks)
        worthy = [pair for pair in fitted if pair[1].rmse(masks) < worth]
        if not worthy:
            return None

        # simpler candidates that are nearly as good must have their chance
        near = floor * (1 + 5 * TOLERATED_LOSS)
        shortlist = worthy[:SHORTLIST]
        shortlist += [pair for pair in worthy[SHORTLIST:] if pair[1].rmse(masks) < near]
        names = ", ".join(dict.fromkeys(candidate.effect for candidate, _ in shortlist))
        self.progress(f"effect {len(self.found) + 1}: checking {names} on data left out")

        # what shows in one run alone cannot be foretold from the others
        if self._folds is not self._spread and any(c.effect in LOCAL for c, _ in shortlist):
            folds = self._spread
            current = self.score(current.effect, current.law, current.fit, folds)
        else:
            folds = self._folds
        scored = parallel(
            lambda pair: self.score(pair[0].effect, pair[0].law, pair[1], folds), shortlist
        )
        good = [
            s
            for s in scored
            if self._better(current, s)
            and is_distinct(s.effect, s.fit, REQUIRED_DISTINCTION, self.problem.scales)
        ]
        if not good:
            return None
        best = min(good, key=lambda s: s.squares.sum())
        equal = [s for s in good if s is best or self._as_good(s, best)]
        chosen = min(equal, key=lambda s: (s.model.complexity, s.squares.sum()))
        if chosen.effect in LOCAL:
            self._folds = folds
        elif folds is not self._folds:
            chosen = self.score(chosen.effect, chosen.law, chosen.fit)
        return replace(chosen, fit=self.problem.fit(chosen.model))

    def _tones(self, current: Fit) -> list[Candidate]:
        """The tone that a residual shows, if any."""
        if "disturbance_amplitude" in current.model.values:
            return []
        line = strongest_line(self.runs, self.problem.errors(current.model), self.problem.masks)
        if line is None:
            return []
        frequency, amplitude = line
        start = current.model.adding(
            disturbance_amplitude=amplitude, disturbance_frequency=frequency
        )
        return [Candidate("periodic_disturbance", None, (start,))]

    def _better(self, simple: Scored, rich: Scored) -> bool:
        gain = 1 - np.sqrt(rich.squares.sum() / simple.squares.sum())
        share = np.clip((gain - REQUIRED_GAIN) / (LARGE_GAIN - REQUIRED_GAIN), 0, 1)
        required = REQUIRED_ADVANTAGE + share * (LARGE_ADVANTAGE - REQUIRED_ADVANTAGE)
        return bool(gain > REQUIRED_GAIN and self.advantage(simple, rich, rich.effect) > required)

    def _as_good(self, simple: Scored, best: Scored) -> bool:
        """Whether a candidate loses so little against the best that fewer parameters decide."""
        loss = np.sqrt(simple.squares.sum() / best.squares.sum()) - 1
        return bool(
            simple.model.complexity < best.model.complexity
            and self.advantage(simple, best, best.effect)
            < (LARGE_TOLERATED_ADVANTAGE if loss < TOLERATED_LOSS else TOLERATED_ADVANTAGE)
        )

    def _exchange(self, current: Scored) -> Scored:
        """Another friction law, alone or with one more effect, where that needs fewer parameters.

        The law that is best on its own need not be the one that is best beside the effects found
        since: a rich law stands in for a simple one with, say, viscous friction.
        """
        masks = self.problem.masks
        trials = []
        for model in simpler_laws(current.model):
            trials.append(Candidate("exchange", None, (model,)))
            for candidate in candidates(model, self.problem.scales):
                same = candidate.starts[0].friction == model.friction
                if same and candidate.effect not in UNLIKE_FRICTION:
                    trials.append(candidate)
        spare = current.model.complexity
        trials = [trial for trial in trials if trial.starts[0].complexity < spare]
        limit = current.fit.rmse(masks) * (1 + TOLERATED_LOSS)
        fits = sorted(
            parallel(lambda trial: self.fit(trial, (FAR * limit, np.inf)), trials),
            key=lambda fit: fit.rmse(masks),
        )
        near = [fit for fit in fits if fit.rmse(masks) < limit][:2]
        for scored in parallel(lambda fit: self.score("exchange", None, fit), near):
            loss = np.sqrt(scored.squares.sum() / current.squares.sum()) - 1
            if loss < TOLERATED_LOSS / 2:
                return self._exchange(scored)
        return current

    def _prune(self, current: Scored) -> Scored:
        """Take away what the others have made unnecessary, the least important first."""
        while True:
            self.progress("checking that every effect is still needed")
            models = [
                (effect, model)
                for effect, _ in effects_of(current.model, self.baseline)
                for model in without_effect(current.model, effect, self.baseline)
            ]
            simpler = []
            for scored in parallel(
                lambda pair: self.score(pair[0], None, self.problem.fit(pair[1])), models
            ):
                lost = self.advantage(scored, current, scored.effect)
                ratio = np.sqrt(scored.squares.sum() / current.squares.sum()) - 1
                if lost < KEEPING_ADVANTAGE or ratio < REQUIRED_GAIN / 2:
                    simpler.append((ratio, scored))
            if not simpler:
                return current
            current = min(simpler, key=lambda pair: pair[0])[1]
