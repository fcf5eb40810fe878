"""What others have made unnecessary is taken out again."""

from __future__ import annotations

from typing import TYPE_CHECKING

from inerter.diagnose.composition import effects_of, without_effect
from inerter.diagnose.decision import CRITERIA, not_needed

if TYPE_CHECKING:
    from inerter.diagnose.search import Scored, Search


def pruned(search: Search, current: Scored) -> Scored:
    """A model without what the others have made unnecessary, the least important first."""
    masks, more, needed = search.problem.masks, True, set[str]()
    while more:
        search.progress("checking that every effect is still needed")
        models = [
            (effect, model)
            for effect, _ in effects_of(current.model, search.baseline)
            for model in without_effect(current.model, effect, search.baseline)
            if effect not in needed and search.may_be(model)
        ]
        simpler, limit = [], (1 + CRITERIA.too_much) * current.fit.rmse(masks)
        # what cannot come so near is needed, however far its refit would get
        fits = search.trials.refits([model for _, model in models], limit)
        near = [
            (effect, None, fit)
            for (effect, _), fit in zip(models, fits, strict=True)
            if fit.rmse(masks) <= limit
        ]
        # nor does it become less so when something else is taken away
        needed |= {effect for effect, _ in models} - {effect for effect, *_ in near}
        for scored in search.scores(near):
            lost = search.advantage(scored, current, scored.effect)
            if not_needed(scored, current, lost):
                simpler.append(scored)
        if simpler:
            current = min(simpler, key=lambda scored: scored.squares.sum())
        more = bool(simpler) and not search.time.is_over()
    return current
