"""Effects that are of use together, where none of them is alone.

A damper has valves that open at another speed in each direction, rounded off, and dry friction; a
rubber mount has a spring and relaxes over decades of time. Each of these is blurred by what stands
in for the others, and the search, which adds one after another, goes astray or finds no step that
gains.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from inerter.catalogue.effects import EFFECTS
from inerter.catalogue.scales import Scales
from inerter.diagnose import bent_damping
from inerter.diagnose.candidate import Candidate
from inerter.diagnose.composition import effects_of, is_distinct
from inerter.diagnose.decision import CRITERIA
from inerter.diagnose.instead import is_near_noise
from inerter.diagnose.trials import FAR
from inerter.identify.model import Model
from inerter.identify.transient import RELAXING
from inerter.parallel_steps import parallel

if TYPE_CHECKING:
    from inerter.diagnose.search import Scored, Search

_RELAXES, _LAGS = EFFECTS["viscoelasticity"].name, EFFECTS["damper_elasticity"].name
_BRANCHES = range(1, len(RELAXING) + 1)
# time constants of a mount's branches per period of the motion, and their share of the stiffness
_TIMES, _SHARE = (0.03, 0.2, 1.5), 0.15


def whole_damper(search: Search, current: Scored) -> Scored | None:
    """A damper with all that one has where that predicts much better; the needless is pruned."""
    if not bent_damping.is_bent(current.model):
        return None
    starts = bent_damping.bends_each_way(current.model, search.problem.scales)
    return _much_better(search, current, bent_damping.EFFECT, starts)


def whole_strut(search: Search, current: Scored) -> Scored | None:
    """A damper that bends and rubs behind a spring, where that predicts much better.

    All of it has to be there: what lacks friction, say, is something else.
    """
    starts = bent_damping.struts(current.model, search.problem.scales)
    found = _much_better(search, current, bent_damping.EFFECT, starts)
    if found is None:
        return None
    known, named = (dict(effects_of(s.model, search.baseline)) for s in (current, found))
    added = [_LAGS, *(name for name in named if name not in known)]
    there = all(is_distinct(name, found.fit, search.baseline) for name in added)
    return found if there else None


def whole_mount(search: Search, current: Scored) -> Scored | None:
    """A spring and all branches for some that relax, where that predicts much better."""
    starts = mounts(current.model, search.problem.scales)
    return _much_better(search, current, _RELAXES, starts)


def mounts(model: Model, sizes: Scales) -> list[Model]:
    """A spring and all branches that a device may have in the place of two or more of them."""
    names = [(f"branch_stiffness_{i}", f"branch_time_{i}") for i in _BRANCHES]
    there = [each for each in names if each[0] in model.free]
    if len(there) < 2 or (len(there) == len(names) and "stiffness" in model.free):
        return []
    slowest = max(there, key=lambda each: model.values[each[1]])
    stiffness = model.values[slowest[0]]
    begin = {"stiffness": model.values.get("stiffness", 0.0) + (1 - _SHARE) * stiffness}
    for (branch, time), ratio in zip(names, _TIMES, strict=True):
        begin |= {branch: _SHARE * stiffness, time: ratio / sizes.frequency}
    begin["force_offset"] = model.values.get("force_offset", 0.0)
    return [model.without([name for each in there for name in each]).adding(None, **begin)]


def _much_better(
    search: Search, current: Scored, effect: str, starts: Sequence[Model]
) -> Scored | None:
    """The best fit from some starts, where the error is more than noise and falls by much."""
    masks, error = search.problem.masks, current.fit.rmse(search.problem.masks)
    if is_near_noise(search, error):
        return None
    limit = (1 - CRITERIA.large_gain) * error
    possible = [start for start in starts if start.is_possible and search.may_be(start)]
    trials = [Candidate(effect, None, (start,)) for start in possible]
    fits = parallel(lambda each: search.trials.fit(each, (FAR * limit, np.inf), limit), trials)
    fit = min(fits, key=lambda each: each.rmse(masks), default=current.fit)
    if fit.rmse(masks) >= limit:
        return None
    scored = search.score(effect, None, fit)
    return scored if search.better(current, scored) else None
