"""The effects of a model one after another, and whether each stands on data no fit has seen."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from inerter.catalogue.along_stroke import node_of
from inerter.diagnose.composition import effects_of, is_local, stripped, submodel
from inerter.diagnose.decision import CRITERIA
from inerter.diagnose.judge import Judge
from inerter.diagnose.search import Scored, Search
from inerter.diagnose.statistics import (
    Interval,
    advantage,
    block_squares,
    gain_interval,
    win_shares,
)
from inerter.identify.choices import TONE
from inerter.identify.fit import Fit, Problem, rms
from inerter.identify.model import Model
from inerter.parallel_steps import parallel

Trial = tuple[tuple[str, str | None], Fit]


@dataclass(frozen=True, kw_only=True)
class Link:
    """One effect of a chain: fits before and after it is added.

    Attributes
    ----------
    rmse_before, rmse_after : float
        Error [N] on held-out data, or where these do not reach the effect, on blocks left out.
    interval : tuple of float, optional
        95 % interval of the gain, 1 - rmse_after / rmse_before.
    seen_in_blocks : bool
        Whether the latter is the case.
    stands : bool
        Whether the effect helps there, surely and visibly.
    takes : float, optional
        What it takes away of the error but for blows of a play [N].
    """

    effect: str
    law: str | None
    before: Fit
    after: Fit
    rmse_before: float
    rmse_after: float
    interval: Interval | None
    seen_in_blocks: bool
    stands: bool
    takes: float | None = None

    @property
    def helps(self) -> bool:
        """Whether it stands and the plain error falls: blows out of step count little, and much."""
        return self.stands and self.rmse_after < self.rmse_before


class Scores(Protocol):
    """What tells how fits do on folds left out."""

    problem: Problem

    def scores(self, fits: Sequence[tuple[str, str | None, Fit]], /) -> list[Scored]:
        """Of each effect, its law and the fit with it."""
        ...


class Parts:
    """Fits of the effects of a model, some of them at a time; each is fitted and scored once."""

    def __init__(self, search: Search, whole: Fit) -> None:
        self.search, self.problem = search, search.problem
        self.fits = {frozenset(name for name, _ in effects_of(whole.model, search.baseline)): whole}
        # the fits are kept, so that no other is taken for one of them
        self._scored: dict[int, tuple[Fit, Scored]] = {}

    def of(self, model: Model, choices: Sequence[Collection[str]]) -> list[Fit]:
        """A model with some of its effects, fitted; of each choice of them."""
        wanted = [frozenset(names) for names in choices]
        new = [names for names in dict.fromkeys(wanted) if names not in self.fits]
        models = [submodel(model, sorted(names), self.search.baseline) for names in new]
        self.fits |= zip(new, parallel(self.search.problem.fit, models), strict=True)
        return [self.fits[names] for names in wanted]

    def scores(self, fits: Sequence[tuple[str, str | None, Fit]], /) -> list[Scored]:
        """`Search.scores`, of the same fit once."""
        new = [each for each in fits if id(each[-1]) not in self._scored]
        found = zip(new, self.search.scores(new), strict=True)
        self._scored |= {id(fit): (fit, scored) for (*_, fit), scored in found}
        return [self._scored[id(fit)][1] for *_, fit in fits]


def chain_of(search: Search, judge: Judge, model: Model, parts: Parts) -> list[Link]:
    """The effects of a model, each time the one that helps most on the fit data.

    One that does not help by then may be needed together with a later one: of it the link says what
    it adds to all others.
    """
    left = effects_of(model, search.baseline)
    fit = search.baseline_fit()
    taken: list[str] = []
    chain = []
    while left:
        fits = parts.of(model, [[*taken, effect] for effect, _ in left])
        (effect, law), after = helping_most(parts, list(zip(left, fits, strict=True)))
        chain.append(_link(search, judge, effect, law, fit, after))
        left = [pair for pair in left if pair[0] != effect]
        taken.append(effect)
        fit = after
    return [link if link.helps else _last(search, judge, link, taken, fit, parts) for link in chain]


def helping_most(search: Scores, trials: Sequence[Trial]) -> Trial:
    """What helps most; of some that do about equally well, what foretells folds left out best."""
    masks = search.problem.masks
    least = min(fit.rmse(masks) for _, fit in trials)
    near = [t for t in trials if t[1].rmse(masks) <= (1 + CRITERIA.too_much) * least]
    if len(near) == 1:
        return near[0]
    scored = search.scores([(effect, law, fit) for (effect, law), fit in near])
    return min(zip(near, scored, strict=True), key=lambda pair: pair[1].squares.sum())[0]


def _last(
    search: Search, judge: Judge, link: Link, taken: list[str], whole: Fit, parts: Parts
) -> Link:
    """A link as the last of its chain, if it stands there."""
    rest = [effect for effect in taken if effect != link.effect]
    if not rest:
        return link
    (without,) = parts.of(whole.model, [rest])
    last = _link(search, judge, link.effect, link.law, without, whole)
    return last if last.stands else link


def _link(
    search: Search, judge: Judge, effect: str, law: str | None, before: Fit, after: Fit
) -> Link:
    errors = judge.rmse(before.model), judge.rmse(after.model)
    counted = judge.counted(before.model), judge.counted(after.model)
    silent = is_local(effect) and _is_silent(search, judge, effect, before.model, after.model)
    masks = search.problem.masks
    if silent:
        # nothing held out goes there: blocks of the other runs, left out in turn, have to tell
        simple, rich = (search.score_on_blocks(fit) for fit in (before, after))
        errors = rms(simple.errors, masks), rms(rich.errors, masks)
        counted = rms(simple.residual, masks), rms(rich.residual, masks)
        squares = [block_squares(scored.errors, search.blocks) for scored in (simple, rich)]
        won = search.advantage(simple, rich, effect)
    else:
        won = judge.advantage(before.model, after.model, effect)
        squares = [judge.error_squares(fit.model) for fit in (before, after)]
    stands = (
        counted[1] < counted[0]
        and won >= CRITERIA.confirming_advantage
        and judge.visible(counted[0], counted[1], after.model)
        and not (effect == "sensor_delay" and not judge.delay_visible(after.model))
    )
    interval = gain_interval(*squares)
    has_blows = "backlash" in after.model.free
    return Link(
        effect=effect,
        law=law,
        before=before,
        after=after,
        rmse_before=errors[0],
        rmse_after=errors[1],
        interval=interval,
        seen_in_blocks=silent,
        stands=stands,
        takes=judge.taken_in_calm(before.model, after.model) if has_blows and not silent else None,
    )


def _is_silent(search: Search, judge: Judge, effect: str, before: Model, after: Model) -> bool:
    """Whether what is held out hardly reaches an effect.

    What it adds to all else as found tells: without it all else may be found wrong, as an inertance
    that makes up for a stop.
    """
    error = judge.rmse(after)
    apart = [judge.difference(m, after) for m in (before, stripped(after, effect, search.baseline))]
    return not judge.visible(float(np.hypot(error, min(apart))), error, after)


def weakest(chain: Sequence[Link], judge: Judge, model: Model) -> str | None:
    """The effect to drop next of a model with a chain, if any.

    The last one that does not stand; or a free play with which nothing is predicted better than
    with none of the chain, though each impact that comes late may be forgiven.
    """
    weak = [link.effect for link in chain if not link.stands]
    if weak:
        return weak[-1]
    play = any(link.effect == "backlash" for link in chain)
    if play and judge.rmse(model) >= judge.rmse(chain[0].before.model):
        return "backlash"
    return None


def tone_link(judge: Judge, before: Fit, after: Fit) -> tuple[Link, float]:
    """A tone beyond the fits' band, judged at the measured rate; and how sure it is."""
    squares = [judge.raw_squares(fit.model) for fit in (before, after)]
    errors = [judge.rmse(fit.model) for fit in (before, after)]
    stands = advantage(squares[0], squares[1]) >= CRITERIA.confirming_advantage and judge.visible(
        errors[0], errors[1], after.model
    )
    interval = gain_interval(*(judge.error_squares(fit.model) for fit in (before, after)))
    tone = "periodic_disturbance"
    link = Link(
        effect=tone,
        law=None,
        before=before,
        after=after,
        rmse_before=errors[0],
        rmse_after=errors[1],
        interval=interval,
        seen_in_blocks=False,
        stands=stands,
    )
    return link, float(win_shares(squares[::-1])[0])


def with_what_was_dropped(fit: Fit, before: Fit) -> Fit:
    """A fit whose errors hold what effects would move it by that are there and not confirmed.

    What the held-out data do not show may be there, and small: the fit data have shown it.
    """
    here, there = fit.model.values, before.model.values
    if fit.model.friction != before.model.friction:
        return fit

    def moved_by(name: str) -> float:
        # a node of another curve is another place, and a tone is fitted to other data
        return 0.0 if node_of(name) or name in TONE else there.get(name, here[name]) - here[name]

    moved = np.array([moved_by(name) for name in fit.model.free])
    return replace(fit, covariance=fit.covariance + np.outer(moved, moved))
