"""Effects that are of use together, where none of them is alone.

A damper has valves that open at another speed in each direction, rounded off, and dry friction: each
of these is blurred by what stands in for the others, and the search finds no step that gains.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from inerter.diagnose.bent_damping import EFFECT, bends_each_way, is_bent
from inerter.diagnose.candidate import Candidate
from inerter.diagnose.decision import CRITERIA
from inerter.diagnose.trials import FAR

if TYPE_CHECKING:
    from inerter.diagnose.search import Scored, Search


def whole_damper(search: Search, current: Scored) -> Scored | None:
    """A damper with all that one has, where that predicts much better; what is needless is pruned."""
    masks, error = search.problem.masks, current.fit.rmse(search.problem.masks)
    noise = float(np.sqrt(np.mean([run.noise**2 for run in search.runs])))
    if not is_bent(current.model) or error < CRITERIA.near_noise * noise:
        return None
    starts = bends_each_way(current.model, search.problem.scales)
    starts = tuple(filter(search.may_be, starts))
    if not starts:
        return None
    limit = (1 - CRITERIA.large_gain) * error
    fit = search.trials.fit(Candidate(EFFECT, None, starts), (FAR * limit, np.inf), limit)
    if fit.rmse(masks) >= limit:
        return None
    scored = search.score(EFFECT, None, fit)
    return scored if search.better(current, scored) else None
