"""Other effects in the place of one that was found.

What was the best to add when less was known need not be the best beside what was found since.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from inerter.diagnose.candidate import Candidate
from inerter.diagnose.candidates import candidates
from inerter.diagnose.composition import effects_of, stripped
from inerter.diagnose.decision import CRITERIA, loss
from inerter.identify.fit import Fit
from inerter.identify.model import Model

if TYPE_CHECKING:
    from inerter.diagnose.search import Scored, Search

Fitted = list[tuple[Candidate, Fit]]

# effects that another, which is there, may do in one of its forms: valves that open at other speeds
_BY_FORM = {"asymmetric_damping": "digressive_damping"}
# of those that do better, the best, which are checked on data left out
_CHECKED = 2


def others(search: Search, found: Scored, effect: str, model: Model) -> list[Candidate]:
    """What may stand beside a model in the place of an effect that was found."""
    effects, sizes = dict(effects_of(found.model, search.baseline)), search.problem.scales
    law = effects[effect]
    # along one sine the shaft of a play is a damper and an inertance of another size
    blind = ("backlash",) if sizes.one_tone and "inertance" in found.model.free else ()
    rest = [name for name in effects if name not in (effect, _BY_FORM.get(effect))]
    return [
        candidate
        for candidate in candidates(model, sizes)
        if (candidate.effect, candidate.law) != (effect, law)
        and candidate.effect not in (*rest, *blind, *search.never)
        and (law is not None or not candidate.is_rich)
    ]


def fitted_instead(search: Search, found: Scored, effect: str, without: Fit) -> Fitted:
    """Their fits beside a model `without` the effect, the best first."""
    trials = others(search, found, effect, without.model)
    return search.trials.fit_all(trials, without, found.fit)


def is_near_noise(search: Search, error: float) -> bool:
    """Whether an rms error [N] is so small that no more is tried in the place of what was found."""
    noise = float(np.sqrt(np.mean([run.noise**2 for run in search.runs])))
    return error < CRITERIA.near_noise * noise


def instead(search: Search, found: Scored) -> Scored | None:
    """A model with another effect in the place of one, where that predicts better; or None."""
    masks, error = search.problem.masks, found.fit.rmse(search.problem.masks)
    effects = [effect for effect, _ in effects_of(found.model, search.baseline)]
    if is_near_noise(search, error) or len(effects) > CRITERIA.exchanged_of:
        return None
    limit = (1 - search.least) * error
    near: list[tuple[Candidate, Fit, Fit, Fitted]] = []
    for effect in effects:
        if effect in search.kept:
            continue
        search.progress(f"trying others in the place of {effect}")
        without = search.problem.fit(stripped(found.model, effect, search.baseline))
        fitted = fitted_instead(search, found, effect, without)
        near += [
            (candidate, fit, without, fitted)
            for candidate, fit in fitted
            if fit.rmse(masks) < limit and search.may_be(fit.model)
        ]
    near.sort(key=lambda each: each[1].rmse(masks))
    for candidate, fit, without, fitted in near[:_CHECKED]:
        scored = search.score(candidate.effect, candidate.law, fit)
        if scored.complexity < found.complexity and loss(scored, found) < 0.0:
            # beside what it makes needless its own value may be none: that is pruned next
            return scored
        one = [(candidate, fit)]
        if search.better(found, scored) and search.that_are_there(one, None, without, fitted):
            return scored
    return None
