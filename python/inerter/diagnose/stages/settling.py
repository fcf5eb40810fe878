"""Each effect against what else could explain the data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

from inerter.catalogue.effects import EFFECTS
from inerter.diagnose.band import force_band
from inerter.diagnose.composition import (
    SMOOTH,
    bristle_is_known,
    effects_of,
    is_distinct,
    is_turned,
    simpler_laws,
    stripped,
)
from inerter.diagnose.decision import CRITERIA
from inerter.diagnose.rivals import Standing, standing
from inerter.diagnose.search import Scored, Search
from inerter.diagnose.stages.searching import Searched, search_in
from inerter.identify.fit import Fit, rms
from inerter.identify.model import Model


@dataclass(frozen=True, kw_only=True)
class Settled:
    """The same with each effect compared to its rivals; `before`: the baseline fitted."""

    searched: Searched
    final: Scored
    before: Fit
    standings: Mapping[str, Standing]


def settled(found: Searched) -> Settled:
    """Every effect compared with its rivals; where they are equal, the usual one is named."""
    search, baseline = found.search, found.prepared.baseline
    before = search.baseline_fit()
    # first the rivals: the usual cause takes the place of one that has no value of its own
    final, standings = compared(search, baseline, _plainest_law(found))
    known = identified(search, baseline, final)
    if known is not final:
        final, standings = compared(search, baseline, known)
    within = Settled(searched=found, final=final, before=before, standings=standings)
    return _beyond_motion(within) or within


def run_beyond_motion(search: Search, model: Model, most: int = CRITERIA.most_effects) -> Scored:
    """A search with forces compared above the motion's band, on top of what was found in it.

    That stays. What is linear in the motion ends with its band, and is not looked for; where a
    model is right but for the noise of the motion, any other effect takes a little away.
    """
    excluded = search.excluded
    search.kept = frozenset(name for name, _ in effects_of(model, search.baseline))
    search.excluded, search.least = excluded | SMOOTH, CRITERIA.band_gain
    final = search.run(model, until="backlash", most=most)
    search.excluded, search.least = excluded, CRITERIA.gain
    return final


def _beyond_motion(start: Settled) -> Settled | None:
    """The search gone on with forces compared above the motion's band, where that tells more.

    It does where most of what is missed is there, and a fit to it takes enough of that away. What
    was found where errors are smaller is not compared again.
    """
    found, model, baseline = start.searched, start.final.model, start.searched.prepared.baseline
    if "backlash" in model.free or found.band.force_band:
        return None
    wide = force_band(found.data.learnt, model, found.band)
    if not wide:
        return None
    found.prepared.given.progress(
        f"most of what is missed lies above {found.band.cutoff:.3g} Hz: searching there"
    )
    band = replace(found.band, force_band=wide)
    search = search_in(found.prepared, band)
    final = run_beyond_motion(search, model)
    learnt = found.data.learnt
    before, after = (rms(learnt.errors(m), learnt.masks) for m in (model, final.model))
    if "backlash" in final.model.free or after > (1 - CRITERIA.band_gain) * before:
        return None
    final, standings = compared(search, baseline, final, known=start.standings)
    known = identified(search, baseline, final)
    if known is not final:
        final, standings = compared(search, baseline, known, known=start.standings)
    search.kept = frozenset()
    data = found.data.in_band(replace(found.data.preparation, force_band=wide))
    found = replace(found, band=band, data=data, search=search, final=final)
    return Settled(searched=found, final=final, before=search.baseline_fit(), standings=standings)


def identified(search: Search, baseline: Model, final: Scored) -> Scored:
    """A model without the effects whose own parameters may be none: these are not named.

    An effect may have been sure when it was found, and lose its value to one found later. What
    varies along the stroke leaves the level that it varies about. A stiffness in the place of all
    inertance is that inertance.
    """
    if is_turned(final.model, search.problem.scales):
        turned = search.problem.fit(stripped(final.model, "parallel_stiffness", baseline))
        return identified(search, baseline, search.score("", None, turned))
    for effect, _ in effects_of(final.model, baseline):
        if effect == "backlash" and not search.is_felt(final.model):
            shaft = final.model.without(("backlash",))
            return identified(search, baseline, search.score("", None, search.problem.fit(shaft)))
        told = is_distinct(effect, final.fit, baseline, CRITERIA.keeping_advantage)
        if told or effect in search.kept:
            continue
        if EFFECTS[effect].local or EFFECTS[effect].kind in ("law", "play"):
            # their values have no normal error, or are known otherwise (`_plainest_law`)
            continue
        without = search.problem.fit(stripped(final.model, effect, baseline))
        masks = search.problem.masks
        if without.rmse(masks) > CRITERIA.needed * final.fit.rmse(masks):
            # something is there, though these data do not tell its parameters one by one
            continue
        return identified(search, baseline, search.score("", None, without))
    return final


def compared(
    search: Search,
    baseline: Model,
    final: Scored,
    exchanges: int = CRITERIA.exchanges,
    known: Mapping[str, Standing] = MappingProxyType({}),
) -> tuple[Scored, dict[str, Standing]]:
    """A model with the standing of its effects; where one's rival is to be named, with that.

    Those of `known` standing are not compared again.
    """
    standings: dict[str, Standing] = {}
    for effect, _ in effects_of(final.model, baseline):
        standings[effect] = known.get(effect) or standing(search, final, effect)
        better = standings[effect].better
        if exchanges and better is not None and effect not in known:
            return compared(search, baseline, better, exchanges - 1, known)
    return final, standings


def _plainest_law(found: Searched) -> Scored:
    """The simplest friction law from which the one found does not differ visibly."""
    final, judge = found.final, found.judge
    if final.model.friction == found.prepared.baseline.friction:
        return final
    for model in simpler_laws(final.model):
        fit = found.search.problem.fit(model)
        apart = judge.difference(fit.model, final.model)
        if not judge.visible(apart, 0.0, final.model):
            return found.search.score("", None, fit)
    if bristle_is_known(final.fit):
        return final
    stiff = [model for model in simpler_laws(final.model) if "presliding" not in model.free]
    return found.search.score("", None, found.search.problem.fit(stiff[-1])) if stiff else final
