"""How sure a named effect is: what else could explain the same data, and how well."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from inerter.catalogue.effects import EFFECTS
from inerter.diagnose.candidate import Candidate
from inerter.diagnose.clipping import hides_nearly_all
from inerter.diagnose.composition import effects_of, is_distinct, stripped
from inerter.diagnose.decision import CRITERIA, does_as_well, plainest
from inerter.diagnose.instead import fitted_instead, others
from inerter.diagnose.promise import Known
from inerter.diagnose.result import Rival
from inerter.diagnose.search import Scored, Search
from inerter.diagnose.statistics import advantage, win_shares
from inerter.diagnose.time_limit import OverTimeError
from inerter.diagnose.trials import FAR, has_much
from inerter.identify.fit import Fit
from inerter.identify.model import Model
from inerter.parallel_steps import parallel


@dataclass(frozen=True)
class Standing:
    """An effect's confidence, its rivals, and the rival to name instead, if any.

    compared: False where there was no time to ask what else could explain the data.
    """

    confidence: float
    rivals: list[Rival]
    better: Scored | None
    compared: bool = True


def standing(search: Search, final: Scored, effect: str) -> Standing:
    """Compare a model with what it would be with another effect in the place of one of its own.

    When the search's time is over nothing says how sure the effect is.
    """
    if not search.time.is_over():
        with suppress(OverTimeError):
            return _standing(search, final, effect)
    return Standing(0.5, [], None, compared=False)


def _standing(search: Search, final: Scored, effect: str) -> Standing:
    baseline, problem = search.baseline, search.problem
    without = search.score(effect, None, problem.fit(stripped(final.model, effect, baseline)))

    search.progress(f"comparing {effect} with what else could explain the data")
    law = dict(effects_of(final.model, baseline))[effect]
    masks = problem.masks
    error = final.fit.rmse(masks)
    fitted = fitted_instead(search, final, effect, without.fit)
    fitted = _from_where_it_stands(search, effect, final, fitted)
    known = [*fitted, (Candidate(effect, law, ()), final.fit)]
    trials = [
        (candidate, fit)
        for candidate, fit in fitted
        if fit.rmse(masks) < CRITERIA.beaten * error
        and is_distinct(candidate.effect, fit, baseline)
        and not hides_nearly_all(fit.model, search.runs)
        and not search.is_blur(fit, without.fit, known)
    ]
    # a rival with more parameters has to win by more than such a one can by chance
    handicap = 1 / (1 - CRITERIA.handicap) ** 2

    def counted(fit: Fit) -> float:
        more = fit.model.complexity > final.complexity
        return fit.rmse(masks) ** 2 * (handicap if more else 1.0)

    trials.sort(key=lambda pair: counted(pair[1]))
    checked = trials[: CRITERIA.rivals_checked]
    scored = search.scores([(each.effect, each.law, fit) for each, fit in checked])
    richer = [s.complexity > final.complexity for s in scored]
    fair = [s.squares * (handicap if more else 1.0) for s, more in zip(scored, richer, strict=True)]
    shares = win_shares(
        [final.squares, without.squares, *fair],
        [0.0, 0.0, *(CRITERIA.tolerated_advantage * more for more in richer)],
    )
    pairs = sorted(zip(scored, shares[2:], strict=True), key=lambda pair: -pair[1])
    instead = [
        s
        for s, share in pairs
        if s.effect not in (effect, *search.excluded, *search.hidden)
        and (
            _takes_precedence(s, final, effect, baseline)
            or (share > CRITERIA.preferred and _is_better(s, final, baseline))
        )
    ]
    # of those that do as well as the likeliest the plainest
    equal = [s for s in instead if s is instead[0] or _does_as_well(s, instead[0])]
    better = plainest(equal) if equal else None
    # another law or form of the same effect is no doubt about the effect; a law is told
    same = float(sum(share for s, share in pairs if s.effect == effect))
    rivals = [
        Rival(s.effect, float(share), s.law if EFFECTS[s.effect].tells_law else None)
        for s, share in pairs
        if s.effect != effect or EFFECTS[effect].tells_law
    ]
    return Standing(min(float(shares[0]) + same, 1.0), rivals, better)


def _from_where_it_stands(
    search: Search,
    effect: str,
    final: Scored,
    fitted: list[tuple[Candidate, Fit]],
) -> list[tuple[Candidate, Fit]]:
    """Fits of rivals, those that an effect is taken for also from where all else stands with it.

    Without it the rest may go astray, and no step from there leads to a rival that does as well.
    """
    masks = search.problem.masks
    reach = CRITERIA.beaten * final.fit.rmse(masks)
    near = {c.effect for c, fit in fitted if fit.rmse(masks) < reach}
    kept = stripped(final.model, effect, search.baseline)
    usual = [
        candidate
        for candidate in others(search, final, effect, kept)
        if candidate.effect in {*EFFECTS[effect].rivals} - near
    ]
    known, limits = Known(search.problem, kept), (FAR * reach, np.inf)
    if usual and has_much(known):
        # worked out before it is shared out
        _ = known.columns
    fits = parallel(lambda c: search.trials.fit(c, limits, reach, known), usual)
    return [*fitted, *zip(usual, fits, strict=True)]


def _takes_precedence(rival: Scored, final: Scored, effect: str, baseline: Model) -> bool:
    """Whether a rival does as well with no more parameters, and is one cause instead of two.

    Or as many, and the more usual one.
    """
    causes = [len(effects_of(scored.model, baseline)) for scored in (rival, final)]
    usual = EFFECTS[rival.effect].rank < EFFECTS[effect].rank
    return bool(
        rival.complexity <= final.complexity
        and (causes[0] < causes[1] or (causes[0] == causes[1] and usual))
        and _does_as_well(rival, final)
    )


def _is_better(rival: Scored, final: Scored, baseline: Model) -> bool:
    """Whether a rival does better with no more parameters and no more causes.

    What a search adds is the best beside what it has; effects found later can change that. A level
    of friction that varies is a level and a cause, as a level and a constant force are: which of
    the two has to be sure.
    """
    named = [[name for name, _ in effects_of(scored.model, baseline)] for scored in (rival, final)]
    causes = [len(names) for names in named]
    if rival.complexity > final.complexity or _does_as_well(final, rival):
        return False
    if causes[0] > causes[1] and advantage(final.squares, rival.squares) > CRITERIA.equal_advantage:
        causes = [sum(1 + (EFFECTS[name].kind == "level") for name in names) for names in named]
    return causes[0] <= causes[1]


def _does_as_well(one: Scored, other: Scored) -> bool:
    return does_as_well(one, other, advantage(one.squares, other.squares))
