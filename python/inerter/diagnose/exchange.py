"""What needs fewer parameters in the place of what a search has found.

The law that is best on its own need not be the one that is best beside the effects found since: a
rich law stands in for a simple one with, say, viscous friction.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from copy import copy
from typing import TYPE_CHECKING

import numpy as np

from inerter.catalogue.effects import EFFECTS
from inerter.diagnose.bent_damping import straight_bends
from inerter.diagnose.candidate import Candidate
from inerter.diagnose.candidates import candidates
from inerter.diagnose.composition import simpler_laws, within_blur
from inerter.diagnose.decision import CRITERIA, loss, plainest
from inerter.diagnose.leak_or_filter import leak_for_low_pass
from inerter.diagnose.low_passes import other_filter
from inerter.diagnose.plainer import (
    as_constant_force,
    as_dampers_that_lag,
    as_law_of_long_waves,
    as_one,
    as_one_friction,
    as_plain_part,
    as_spring,
    as_weight,
    has_plain_shaft,
    swings_on,
    with_own_spring,
)
from inerter.diagnose.trials import FAR
from inerter.diagnose.where_losses_act import damped_on_the_other_side, rubbing_on_the_other_side
from inerter.identify.fit import Fit, rms
from inerter.identify.model import Model
from inerter.motion_units import ROTATION
from inerter.parallel_steps import parallel

if TYPE_CHECKING:
    from inerter.diagnose.search import Scored, Search


def exchanged(search: Search, current: Scored) -> Scored:
    """A model that says about as much with fewer parameters, as long as there is one."""
    for other in (
        _shaft_alone, other_side, other_filter, leak_for_low_pass, _dampers_that_lag,
        _straight_bend, _one_friction, blurred_bristle, _plainer_law, _spring_beside, plain_part,
        _weight, _one_cause,
    ):  # fmt: skip
        if found := other(search, current):
            return found if other is _one_cause else exchanged(search, found)
    return current


def _shaft_alone(search: Search, current: Scored) -> Scored | None:
    """A shaft without a mass before it, where by its own weights it does as well.

    Errors count by the noise of the motion that a shaft passes on: near its resonance the shaft
    that is there misses more for that alone, and one behind a mass, whose resonance is another,
    would win.
    """
    if "grip_mass" not in current.model.free or not has_plain_shaft(current.model):
        return None
    own = (*EFFECTS["series_elasticity"].coordinates, "grip_mass")
    mass, bare = current.model.values["grip_mass"], current.model.without(own)
    bare = bare.holding(inertance=current.model.values["inertance"] + mass)
    trials = [
        each
        for each in candidates(bare, search.problem.scales)
        if each.effect == "series_elasticity" and each.law is None
    ]
    fits = [search.trials.fit(each) for each in trials]
    alone = min(fits, key=lambda fit: fit.rmse(search.problem.masks), default=None)
    if alone is None or not search.may_be(alone.model):
        return None
    weighed = copy(search)
    weighed.weigh_for(alone.model)
    plain = weighed.score("exchange", None, weighed.problem.fit(alone.model))
    rich = weighed.score("grip_mass", None, weighed.problem.fit(current.model))
    if weighed.better(plain, rich):
        return None
    search.weigh_for(alone.model)
    return plain


def other_side(search: Search, current: Scored) -> Scored | None:
    """The same loss on the other side of the shaft, where that is nearer to the data, or plainer.

    Behind the shaft a step of friction has to be solved for: a fit takes long, and where friction
    is on the wrong side one prediction tells.
    """
    masks, error = search.problem.masks, current.fit.rmse(search.problem.masks)
    nearer, plainer = (1 - CRITERIA.gain) * error, (1 + CRITERIA.tolerated_loss) * error
    rubbing = [
        model
        for model in rubbing_on_the_other_side(current.model, search.baseline)
        if rms(search.problem.residual(model), masks) <= nearer
    ]
    for model in (*rubbing, *damped_on_the_other_side(current.model, search.baseline)):
        fewer = model.complexity < current.model.complexity
        limit = plainer if fewer else nearer
        trial = Candidate("exchange", None, (model,))
        fit = search.trials.fit(trial, (FAR * limit, np.inf), limit)
        if fit.rmse(masks) < limit and search.may_be(fit.model):
            scored = search.score("exchange", None, fit)
            if loss(scored, current) < (CRITERIA.exchange_loss if fewer else -CRITERIA.gain):
                return scored
    return None


def blurred_bristle(search: Search, current: Scored) -> Scored | None:
    """Friction without memory for a bristle that yields far within what a reversal is known to."""
    masks, model = search.problem.masks, current.model
    least = CRITERIA.bristle_seen * search.problem.scales.place_resolution
    if "presliding" not in model.free or not model.values["presliding"] < least:
        return None
    error = current.fit.rmse(masks)
    plain = (each for each in simpler_laws(model) if "presliding" not in each.values)
    for each in filter(search.may_be, plain):
        # about as fast as the motion is told to turn
        width = 0.1 * search.problem.scales.speed_resolution
        fit = search.problem.fit(each.holding(transition_velocity=width))
        if within_blur(fit.model, fit.rmse(masks), error):
            return search.score("exchange", None, fit)
    return None


def _plainer_law(search: Search, current: Scored) -> Scored | None:
    """Another friction law, alone or with one more effect."""
    masks = search.problem.masks
    limit = current.fit.rmse(masks) * (1 + CRITERIA.tolerated_loss)

    def fit(model: Model) -> Fit:
        return search.trials.fit(
            Candidate("exchange", None, (model,)), (FAR * limit, np.inf), limit
        )

    def is_plainer(model: Model) -> bool:
        return model.complexity < current.model.complexity and search.may_be(model)

    def with_one_more(base: Fit) -> Sequence[Candidate]:
        own = "bw_ratio" in current.model.free
        more = [c for c in _beside(base.model, search, own) if is_plainer(c.starts[0])]
        return search.trials.within_reach(more, base, limit)

    # alone a law may be far off, and right beside one more effect
    plainer = list(filter(is_plainer, simpler_laws(current.model)))
    laws = parallel(lambda model: search.trials.fit(Candidate("exchange", None, (model,))), plainer)
    trials = [trial for each in parallel(with_one_more, laws) for trial in each]
    fits = parallel(lambda t: search.trials.fit(t, (FAR * limit, np.inf), limit), trials)
    fits += [*laws, *map(fit, filter(is_plainer, as_spring(current.model)))]
    near = sorted((f for f in fits if f.rmse(masks) < limit), key=lambda f: f.rmse(masks))[:2]
    for scored in search.scores([("exchange", None, fit) for fit in near]):
        if loss(scored, current) < CRITERIA.exchange_loss:
            return scored
    return None


def _beside(model: Model, search: Search, has_spring: bool) -> Iterator[Candidate]:
    """Effects that may act beside a friction law in the place of a richer one."""
    for candidate in candidates(model, search.problem.scales):
        # a Bouc-Wen law has a stiffness of its own
        stiffens = candidate.effect == "parallel_stiffness" and has_spring
        same = candidate.starts[0].friction == model.friction
        if same and (stiffens or not EFFECTS[candidate.effect].unlike_friction):
            yield candidate


def _spring_beside(search: Search, current: Scored) -> Scored | None:
    """LuGre friction and a spring in the place of Bouc-Wen friction, which has one of its own.

    Neither explains as much alone, and so they are not found one after the other.
    """
    trials = [
        candidate
        for model in with_own_spring(current.model)
        for candidate in candidates(model, search.problem.scales)
        if candidate.law == "lugre" and search.may_be(candidate.starts[0])
    ]
    for candidate in trials:
        scored = search.score("exchange", None, search.trials.fit(candidate))
        if search.better(current, scored):
            return scored
    return None


def plain_part(search: Search, current: Scored) -> Scored | None:
    """A plain part in the place of a rich one, or of a shaft that stands for any slow sine.

    Of some that do for it the plainest of those that the best is better than by chance alone.
    """
    masks, frequency = search.problem.masks, search.problem.scales.frequency
    none = swings_on(current.model, search.longest, frequency)
    good = []
    plain = [
        *as_plain_part(current.model, search.longest, frequency),
        *as_law_of_long_waves(current.model, search.problem.scales),
        *as_constant_force(current.model),
    ]
    for model in filter(search.may_be, plain):
        fit = search.problem.fit(model)
        if none or fit.rmse(masks) < (1 + CRITERIA.too_much) * current.fit.rmse(masks):
            scored = search.score("exchange", None, fit)
            if none:
                return scored
            if loss(scored, current) < CRITERIA.gain:
                good.append(scored)
    best = min(good, key=lambda s: s.squares.sum(), default=None)
    return best and plainest([s for s in good if s is best or not search.better(s, best)])


def _dampers_that_lag(search: Search, current: Scored) -> Scored | None:
    """Dampers behind a spring in the place of a late channel, where they are nearer to the data.

    A channel that is late is so for every force, dampers behind a spring for theirs alone; the
    search meets the delay before it knows how the damping bends.
    """
    masks = search.problem.masks
    limit = current.fit.rmse(masks)
    for model in filter(search.may_be, as_dampers_that_lag(current.model)):
        trial = Candidate("exchange", None, (model,))
        fit = search.trials.fit(trial, (FAR * limit, np.inf), limit)
        if fit.rmse(masks) < limit:
            scored = search.score("exchange", None, fit)
            return scored if loss(scored, current) < 0.0 else None
    return None


def _straight_bend(search: Search, current: Scored) -> Scored | None:
    """Damping that bends to a straight line for a power of the speed, where that is nearer.

    Which of the two it is shows better once what else there is has been found.
    """
    masks = search.problem.masks
    limit = (1 - CRITERIA.gain) * current.fit.rmse(masks)
    starts = tuple(filter(search.may_be, straight_bends(current.model, search.problem.scales)))
    if not starts:
        return None
    fit = search.trials.fit(Candidate("exchange", None, starts), (FAR * limit, np.inf), limit)
    if fit.rmse(masks) >= limit:
        return None
    scored = search.score("exchange", None, fit)
    much = loss(scored, current) < -CRITERIA.large_gain
    return scored if much or search.better(current, scored) else None


def _one_friction(search: Search, current: Scored) -> Scored | None:
    """One friction in the place of one and of damping that is another, the nearest to the data."""
    masks, error = search.problem.masks, current.fit.rmse(search.problem.masks)
    models = as_one_friction(current.model, search.problem.scales.velocity)
    fits = [search.problem.fit(model) for model in filter(search.may_be, models)]
    near = [
        fit
        for fit in fits
        if fit.rmse(masks) < (1 + CRITERIA.too_much) * error
        or within_blur(fit.model, fit.rmse(masks), error)
    ]
    good = [
        scored
        for scored in search.scores([("exchange", None, fit) for fit in near])
        if loss(scored, current) < CRITERIA.gain
        or within_blur(scored.model, scored.fit.rmse(masks), error)
    ]
    best = min(good, key=lambda s: s.squares.sum(), default=None)
    return best and plainest([s for s in good if s is best or not search.better(s, best)])


def _weight(search: Search, current: Scored) -> Scored | None:
    """A weight out of balance in the place of a torque that bends with the angle."""
    if search.runs[0].motion != ROTATION:
        return None
    masks = search.problem.masks
    for model in filter(search.may_be, as_weight(current.model)):
        fit = search.problem.fit(model)
        if fit.rmse(masks) < (1 + CRITERIA.too_much) * current.fit.rmse(masks):
            scored = search.score("exchange", None, fit)
            if loss(scored, current) < CRITERIA.gain:
                return scored
    return None


def _one_cause(search: Search, current: Scored) -> Scored | None:
    """One cause in the place of two that do the same."""
    masks = search.problem.masks
    for model in filter(search.may_be, as_one(current.model)):
        fit = search.problem.fit(model)
        if within_blur(model, fit.rmse(masks), current.fit.rmse(masks)):
            return search.score("exchange", None, fit)
    return None
