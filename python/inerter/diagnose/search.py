"""The search for what a model lacks: add the effect that predicts best, repeat, prune.

Every decision is made on folds of the fit data that the model in question was not fitted to; the
held-out data are not touched here. Among candidates that do about equally well the one with the
fewest parameters is taken.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace

import numpy as np

from inerter.catalogue.friction import FRICTION
from inerter.diagnose import along_stroke
from inerter.diagnose.advantage import advantage_of
from inerter.diagnose.candidate import Candidate
from inerter.diagnose.candidates import candidates
from inerter.diagnose.cannot_tell import hidden_by, is_hidden, strokes_of
from inerter.diagnose.clipping import hides_nearly_all
from inerter.diagnose.composition import (
    effects_of,
    is_blur,
    is_distinct,
    is_local,
    is_shaft,
)
from inerter.diagnose.decision import CRITERIA, as_good, better, loss, plainest
from inerter.diagnose.exchange import exchanged, other_side, plain_part
from inerter.diagnose.instead import instead
from inerter.diagnose.left_out import Folds, left_out_errors
from inerter.diagnose.low_passes import noise_taken, where_late
from inerter.diagnose.plainer import keeps_its_start
from inerter.diagnose.play import is_felt
from inerter.diagnose.prune import pruned
from inerter.diagnose.statistics import Array, block_squares
from inerter.diagnose.time_limit import OverTimeError, TimeLimit
from inerter.diagnose.together import whole_damper, whole_mount, whole_strut
from inerter.diagnose.tone import Witness, is_harmonic, tone_candidate
from inerter.diagnose.trials import Trials, plain_beside, shortlist_of
from inerter.identify.fit import Fit, Problem
from inerter.identify.model import Model
from inerter.identify.runs import BenchRun, scales
from inerter.identify.split import Mask, Split, blocks, spread_folds

Progress = Callable[[str], None]
Fitted = tuple[Candidate, Fit]


@dataclass(frozen=True, kw_only=True)
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

    @property
    def complexity(self) -> int:
        """Number of free coordinates that say something."""
        return self.model.complexity


def _silent(text: str) -> None:
    """Tell nobody."""


@dataclass
class Search:
    """A search over the fit data of a split.

    Effects `excluded`, for good `never`, are not added, those `kept` stay; one that is added takes
    at least the share `least` of the error away.
    A `witness` is asked whether a tone is of the motion, which may be known to be `one_tone`.
    It `draws` curves along the stroke, or none; it may `begin` with more than the baseline. Nothing
    is added to a model that has `most_complex` coordinates or more, nor when its `time` is over.
    """

    runs: Sequence[BenchRun]
    split: Split
    baseline: Model
    progress: Progress = _silent
    found: list[str] = field(default_factory=list)
    excluded: frozenset[str] = frozenset()
    never: frozenset[str] = frozenset()
    kept: frozenset[str] = frozenset()
    least: float = CRITERIA.gain
    witness: Witness | None = None
    one_tone: bool = False
    draws: bool = True
    most_complex: float = np.inf
    begin: Model | None = None
    time: TimeLimit = field(default_factory=TimeLimit)

    def __post_init__(self) -> None:
        self.strokes, self.hidden = strokes_of(self.runs), hidden_by(self.runs) | self.never
        self._divide()
        # what the last step without a result came upon
        self._refused: list[Scored] = []

    def _divide(self) -> None:
        """What is fitted, and the folds of it."""
        sizes = scales(self.runs)
        # noise of the acceleration may hide it in a wide band
        sizes = replace(sizes, one_tone=sizes.one_tone or self.one_tone)
        self.problem = Problem(self.runs, self.split.fit, sizes)
        self.blocks = blocks(self.problem.masks)
        self.trials = Trials(self.problem, self.time)
        self._folds = self._problems(self.split.folds)
        self._spread = self._problems(spread_folds(self.split.fit))

    def weigh_for(self, model: Model) -> None:
        """Let errors count by what a model's shaft, if it has one, makes of the motion's noise."""
        if model.shaft is None:
            return
        on_blocks = self._folds is self._spread
        self.runs = [replace(run, shaft=model.shaft) for run in self.runs]
        self._divide()
        if on_blocks:
            self._folds = self._spread

    def __getstate__(self) -> dict[str, object]:
        """What another process is told: it has nobody to report to."""
        return {**self.__dict__, "progress": _silent, "witness": None}

    def _problems(self, folds: Sequence[list[Mask]]) -> Folds:
        """The fit data without each fold, and the fold."""
        fit = self.split.fit
        return [
            (self.problem.with_masks([f & ~x for f, x in zip(fit, fold, strict=True)]), fold)
            for fold in folds
        ]

    def run(
        self,
        start: Model | None = None,
        until: str | None = None,
        most: int = CRITERIA.most_effects,
    ) -> Scored:
        """Search from a model, by default that to `begin` with; the best, fitted to all fit data.

        `most` effects are added at most; with the effect `until` it ends, and nothing is pruned.
        """
        start = start or self.begin or self.baseline
        self.weigh_for(start)
        if any(is_local(effect) for effect, _ in effects_of(start, self.baseline)):
            self._folds = self._spread
        current = self.score("baseline", None, self.problem.fit(start))
        # another band may tell that a part found before is a plain one, or on which side it acts
        while other := plain_part(self, current) or other_side(self, current):
            current = other
        current, seen = self._stepped(current, until, most), []
        # where another effect does better in the place of one, the search goes on from there
        with suppress(OverTimeError):
            while until not in current.model.free and not self.time.is_over():
                other = instead(self, current)
                if other is None or other.model.shape in seen:
                    break
                self.found.append(other.effect)
                seen.append(other.model.shape)
                current = other if other.effect == until else self._stepped(other, until, most)
        return current

    def _stepped(self, current: Scored, until: str | None, most: int) -> Scored:
        """Effects added one after another, and pruned, until neither finds anything to do."""
        seen = []
        while True:
            current = self._added(current, until, most)
            if current.effect == until:
                return current
            shape, current = current.model.shape, pruned(self, current)
            with suppress(OverTimeError):
                whole = whole_damper(self, current)
                current = pruned(self, exchanged(self, whole)) if whole else current
            # what has gone may have stood in the way of what was not there yet
            if current.model.shape in (shape, *seen) or self.time.is_over():
                return current
            seen.append(current.model.shape)
            left = dict(effects_of(current.model, self.baseline))
            self.found = [effect for effect in dict.fromkeys(self.found) if effect in left]

    def _added(self, current: Scored, until: str | None, most: int) -> Scored:
        """Effects added one after another."""
        with suppress(OverTimeError):
            while len(self.found) < most and not self.time.is_over():
                if current.complexity >= self.most_complex:
                    break
                chosen = self._best_step(current) or self._two_steps(current)
                if chosen is None:
                    break
                self.found.append(chosen.effect)
                if chosen.effect == until:
                    return chosen
                chosen = whole_mount(self, chosen) or whole_strut(self, chosen) or chosen
                before, current = current.model, exchanged(self, chosen)
                if before.shape == current.model.shape:
                    # the exchange takes back what the step has brought, and would again
                    break
        return current

    def next_effect(self, model: Model) -> str | None:
        """The effect that would be added to a model in one more step, fitted to all fit data."""
        self.weigh_for(model)
        if any(is_local(effect) for effect, _ in effects_of(model, self.baseline)):
            self._folds = self._spread
        with suppress(OverTimeError):
            found = self._best_step(self.score("", None, self.problem.fit(model)))
            # the exchange may take it back
            left = found and exchanged(self, found).model.shape
            return found.effect if found and left != model.shape else None
        return None

    def baseline_fit(self) -> Fit:
        """The baseline by least squares, whatever a play lets count less for its own model."""
        runs = [replace(run, far=np.inf) for run in self.runs]
        return Problem(runs, self.split.fit, self.problem.scales).fit(self.baseline)

    def score(self, effect: str, law: str | None, fit: Fit, folds: Folds | None = None) -> Scored:
        """Squared errors of a fitted model on folds left out of its refits."""
        return self.scores([(effect, law, fit)], folds)[0]

    def scores(
        self, fits: Sequence[tuple[str, str | None, Fit]], folds: Folds | None = None
    ) -> list[Scored]:
        """`score` of several, shared out fold by fold: effect, law and fit of each."""
        found = left_out_errors(self.problem, folds or self._folds, [fit for *_, fit in fits])
        pairs = zip(fits, found, strict=True)
        return [self._scored(effect, law, *each) for (effect, law, _), each in pairs]

    def _scored(self, effect: str, law: str | None, fit: Fit, errors: list[Array]) -> Scored:
        residual = self.problem.weighted(errors)
        squares = block_squares(residual, self.blocks)
        return Scored(
            effect=effect, law=law, fit=fit, errors=errors, residual=residual,
            squares=squares + noise_taken(fit.model, self.runs, self.blocks),
        )  # fmt: skip

    def advantage(self, simple: Scored, rich: Scored, effect: str) -> float:
        """How surely a model with an effect has smaller errors on left-out folds than without."""
        return advantage_of(simple.residual, rich.residual, self.problem.masks, self.blocks, effect)

    def score_on_blocks(self, fit: Fit) -> Scored:
        """Errors of a fitted model on blocks of every run, left out of its refits."""
        return self.score("", None, fit, self._spread)

    def _best_step(self, current: Scored) -> Scored | None:
        """The effect to add next, or None."""
        masks = self.problem.masks
        self._refused = []
        self.progress(f"effect {len(self.found) + 1}: trying every candidate")
        trials = [
            *candidates(current.model, self.problem.scales),
            *tone_candidate(self.runs, self.problem, current.fit, self.witness),
            *along_stroke.candidates(self.problem, current.fit, self.draws),
        ]
        trials = [t for t in trials if t.effect not in self.excluded and self.may_be(t.starts[0])]
        fitted = self.trials.fit_all(trials, current.fit, least=self.least)
        if not fitted:
            return None
        fitted = sorted(
            [*fitted, *where_late(self, current, fitted)], key=lambda p: p[1].rmse(masks)
        )
        worth = (1 - self.least) * current.fit.rmse(masks)
        worthy = [pair for pair in fitted if pair[1].rmse(masks) < worth]
        if not worthy:
            return None
        shortlist = shortlist_of(worthy, fitted[0][1].rmse(masks), masks)
        names = ", ".join(dict.fromkeys(candidate.effect for candidate, _ in shortlist))
        self.progress(f"effect {len(self.found) + 1}: checking {names} on data left out")

        # what shows in one run alone cannot be foretold from the others
        if self._folds is not self._spread and any(is_local(c.effect) for c, _ in shortlist):
            folds = self._spread
            current = self.score(current.effect, current.law, current.fit, folds)
        else:
            folds = self._folds
        there: list[Scored] = []
        good: list[Scored] = []
        for pairs in (shortlist, *plain_beside(shortlist, worthy, current.complexity)):
            there += self.that_are_there(pairs, folds, current.fit, fitted)
            good = [s for s in there if self.better(*self._weighed_for(s, [current, s]))]
            if good:
                break
        else:
            limit = (1 - CRITERIA.foothold) ** 2 * current.squares.sum()
            self._refused = [s for s in there if s.squares.sum() < limit]
            return None
        chosen = self._plainest(good)
        if is_shaft(chosen.effect):
            self.weigh_for(chosen.model)
            return self.score(chosen.effect, None, self.problem.fit(chosen.model))
        if is_local(chosen.effect):
            self._folds = folds
        elif folds is not self._folds:
            chosen = self.score(chosen.effect, chosen.law, chosen.fit)
        return replace(chosen, fit=self.problem.fit(chosen.model))

    def that_are_there(
        self, pairs: Sequence[Fitted], folds: Folds | None, without: Fit, fitted: Sequence[Fitted]
    ) -> list[Scored]:
        """Fitted candidates on data left out, but for those whose own values may be none.

        without: what they were added to; fitted: all that were.
        """
        sizes = self.problem.scales
        if self.found:
            # what comes first is worth waiting for
            self.time.check()
        scored = self.scores([(each.effect, each.law, fit) for each, fit in pairs], folds)
        there = [
            s
            for s in scored
            if is_distinct(s.effect, s.fit, self.baseline)
            and not self._is_shaft_alone(s)
            and not hides_nearly_all(s.model, self.runs)
            and self.is_felt(s.model)
            and self.may_be(s.model)
            and not keeps_its_start(s.effect, s.model, self.longest, sizes.frequency)
            and along_stroke.is_there(s.model, self.problem)
            and not is_harmonic(s.model, sizes, self.longest)
        ]
        # what is not there makes no peak of friction needless
        gone = [s.fit for s in scored if s not in there]
        others = [pair for pair in fitted if not any(pair[1] is fit for fit in gone)]
        return [s for s in there if not self.is_blur(s.fit, without, others)]

    @property
    def longest(self) -> float:
        """Duration of the longest run [s]."""
        return max(run.spacing * run.force.size for run in self.runs)

    @property
    def spacing(self) -> float:
        """Longest time between two samples as measured [s]."""
        return max(run.sample_spacing for run in self.runs)

    def is_felt(self, model: Model) -> bool:
        """Whether a play that is searched for can be felt; one that is stated may be none."""
        if "backlash" not in model.free or "backlash" in self.baseline.values:
            return True
        return is_felt(model, self.problem.scales, self.spacing)

    def _is_shaft_alone(self, scored: Scored) -> bool:
        """Whether a play does no more than its shaft, which is no candidate along one sine."""
        if scored.effect != "backlash" or not self.problem.scales.one_tone:
            return False
        alone, masks = self.problem.fit(scored.model.without(("backlash",))), self.problem.masks
        return scored.fit.rmse(masks) > (1 - CRITERIA.gain) * alone.rmse(masks)

    def _weighed_for(self, rich: Scored, scored: Sequence[Scored]) -> list[Scored]:
        """Models as they count where one of them brings a shaft."""
        if not is_shaft(rich.effect):
            return list(scored)
        runs = [replace(run, shaft=rich.model.shaft) for run in self.runs]
        problem = Problem(runs, self.split.fit, self.problem.scales)
        return [
            replace(s, residual=residual, squares=block_squares(residual, self.blocks))
            for s in scored
            for residual in [problem.weighted(s.errors)]
        ]

    def _plainest(self, good: Sequence[Scored]) -> Scored:
        """The best of some models, or the plainest of those that are about as good."""
        shafts = [s for s in good if is_shaft(s.effect)]
        # a richer one passes less noise of the motion, and would win by its own weights
        shaft = min(shafts, key=lambda s: s.complexity, default=good[0])
        counted = self._weighed_for(shaft, good)
        best = min(counted, key=lambda s: s.squares.sum())
        pairs = zip(good, counted, strict=True)
        equal = [pair for pair in pairs if pair[1] is best or self._as_good(pair[1], best)]
        chosen = plainest([each for _, each in equal])
        return next(s for s, each in equal if each is chosen)

    def _two_steps(self, current: Scored) -> Scored | None:
        """Two effects that are sure together, where none is alone.

        What shows in few places is not to be seen before what lies about it is explained.
        """
        first = min(self._refused, key=lambda s: s.squares.sum(), default=None)
        if first is None:
            return None
        folds = self._folds
        if is_local(first.effect):
            self._folds = self._spread
        first = replace(first, fit=self.problem.fit(first.model))
        # what it has stood in for is given up with it, or another effect comes
        plainer = exchanged(self, first)
        if plainer is not first and self._is_better_on_blocks(current, plainer):
            return plainer
        second = self._best_step(first)
        if second and self._is_better_on_blocks(current, second):
            return second
        self._folds = folds
        return None

    def _is_better_on_blocks(self, *pair: Scored) -> bool:
        return self.better(*(self.score_on_blocks(each.fit) for each in pair))

    def is_blur(self, fit: Fit, without: Fit, fitted: Sequence[tuple[Candidate, Fit]]) -> bool:
        """Whether a fit's peak of friction does little more than the laws without it."""
        if fit.model.friction == without.model.friction:
            return False
        masks = self.problem.masks
        simpler = [n for n in FRICTION[fit.model.friction].simpler if not FRICTION[n].peak]
        plain = [each.rmse(masks) for _, each in fitted if each.model.friction in simpler]
        plainest = min(plain, default=without.rmse(masks))
        return is_blur(fit.model, self.problem.scales, plainest, fit.rmse(masks))

    def may_be(self, model: Model) -> bool:
        """Whether a model has no effect excluded, all kept, and none that the motion hides."""
        names = {name for name, _ in effects_of(model, self.baseline)}
        if is_hidden(names, model, self.problem.scales, self.strokes, self.hidden):
            return False
        return self.kept <= names and not (self.excluded - self.kept) & names

    def better(self, simple: Scored, rich: Scored) -> bool:
        """Whether the richer of two models is needed."""
        return better(simple, rich, self.advantage(simple, rich, rich.effect))

    def _as_good(self, simple: Scored, best: Scored) -> bool:
        """Whether a candidate loses so little against the best that fewer parameters decide."""
        masks = self.problem.masks
        least = CRITERIA.local_gain if loss(simple, best) < CRITERIA.too_much else 0.0
        lost = advantage_of(simple.residual, best.residual, masks, self.blocks, best.effect, least)
        return as_good(simple, best, lost)
