"""The stages of a diagnosis of bench records, each made of the one before and changed no more.

    Given -> Prepared -> Searched -> Settled -> Confirmed

prepare    smoothing; what is held out; the baseline
search     the effects that predict best, in the band in which the model found predicts best
settle     each effect against what else could explain the data
confirm    each effect on data that no fit has seen
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from inerter.catalogue.effects import EFFECTS
from inerter.diagnose.band import best_band, force_band, narrower_band, wider_band
from inerter.diagnose.candidates import candidates
from inerter.diagnose.chain import Link, chain_of, tone_link, weakest, with_what_was_dropped
from inerter.diagnose.composition import (
    DRIVE,
    bristle_is_known,
    effects_of,
    has_series,
    is_distinct,
    simpler_laws,
    stripped,
    submodel,
)
from inerter.diagnose.data import Data
from inerter.diagnose.decision import CRITERIA, as_good, better, loss
from inerter.diagnose.judge import Judge
from inerter.diagnose.lateness import from_delay_on
from inerter.diagnose.low_passes import filters, has_filter
from inerter.diagnose.parallel import parallel
from inerter.diagnose.play import fit_play, forgiving, jackknife, play_of
from inerter.diagnose.rivals import Standing, standing
from inerter.diagnose.search import Scored, Search
from inerter.diagnose.start import Prepared
from inerter.diagnose.tone import with_tone_above, with_tone_from_raw
from inerter.identify.channel_filter import filters_of
from inerter.identify.choices import covered
from inerter.identify.fit import Fit, Problem, rms
from inerter.identify.model import Model
from inerter.identify.runs import BenchRun, on_clocks, thin
from inerter.identify.split import split
from inerter.records.preparation import Preparation

# share of a period that a low-pass along one sine begins with, and what it may smooth
_LATE, _JUMPS = 0.03, "coulomb_friction"


@dataclass(frozen=True, kw_only=True)
class Searched:
    """What a search found, the band that it worked in, and the data that it ended with."""

    prepared: Prepared
    band: Preparation
    data: Data
    search: Search
    final: Scored

    @cached_property
    def judge(self) -> Judge:
        """The held-out data."""
        return judge_of(self.data, self.search, self.prepared.baseline)

    def covered(self, fit: Fit) -> Fit:
        """A fit whose errors hold what other choices would move it by, see `identify.choices`."""
        return covered(
            self.search.problem, fit, self.data.records, self.data.preparation.channels
        )  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Settled:
    """The same with each effect compared to its rivals; `before`: the baseline fitted."""

    searched: Searched
    final: Scored
    before: Fit
    standings: Mapping[str, Standing]


@dataclass(frozen=True, kw_only=True)
class Confirmed:
    """What stands on data that no fit has seen: the extended model, its effects one by one.

    `data` and `judge` are what its figures are of: more than was searched, where a record is long.
    """

    searched: Searched
    data: Data
    judge: Judge
    before: Fit
    fit: Fit
    chain: tuple[Link, ...]
    standings: Mapping[str, Standing]


# --- Prepared -> Searched ------------------------------------------------------------------------


def searched(start: Prepared) -> Searched:
    """The plainest model that predicts best.

    Where the model found predicts the force better in a wider band, the search goes on there.
    """
    data, band = start.data, start.weighed
    search = search_in(start, band)
    final = search.run(until="backlash")
    for _ in range(CRITERIA.more_bands):
        wider = _wider(data, band, final.model)
        if "backlash" in final.model.free or wider is None:
            break
        band, search = wider, search_in(start, wider)
        final = search.run(final.model, until="backlash")
    if calmer := _calmer(start, band, final.model):
        band, search, plainer = calmer
        final = search.run(plainer, until="backlash")
    search, final = _behind_low_pass(start, band, search, final)
    final = from_delay_on(search, final) or final
    if "backlash" in final.model.free:
        start.given.progress("free play: fitting it to the force as measured")
    elif raw := _wider(data, data.preparation, final.model):
        data = data.in_band(raw)
    found = Searched(prepared=start, band=band, data=data, search=search, final=final)
    # what a play does lies above the motion's band too, and is asked for first
    if play := _play(found):
        return _with_play(found, play)
    return _beyond_motion(found, band) or _in_narrower_band(found)


def search_in(start: Prepared, band: Preparation) -> Search:
    """A search in which errors count by the noise of the motion."""
    runs = weighed_runs(band)
    parted, progress = split(runs, start.data.held), start.given.progress
    return Search(
        runs, parted, start.baseline, progress, witness=start.data.witness,
        one_tone=start.data.band.scales.one_tone,
    )  # fmt: skip


def weighed_runs(band: Preparation) -> list[BenchRun]:
    """Runs in whose fits errors count by the noise of the motion."""
    return [
        replace(run, corner=band.corner, noise=band.noise_floor * _share_in_band(run))
        for run in on_clocks([thin(motion, force_band=band.force_band) for motion in band.motions])
    ]


def judge_of(data: Data, search: Search, baseline: Model) -> Judge:
    """The held-out data, and those of a search."""
    counted = Problem(search.runs, search.split.holdout, search.problem.scales)
    return Judge(data.band, data.raw, counted, data.preparation, baseline)


def _share_in_band(run: BenchRun) -> float:
    """Of white noise at the measured rate what a run's band has, rms."""
    return float(np.sqrt(min(2.0 * run.cutoff * run.sample_spacing, 1.0)))


def _wider(data: Data, band: Preparation, model: Model) -> Preparation | None:
    return wider_band(data.records, band, data.full.fit, model, data.band.scales)


def _calmer(
    start: Prepared, band: Preparation, model: Model
) -> tuple[Preparation, Search, Model] | None:
    """A plainer friction law that predicts the fit data better in the band of the plain fits.

    In a wider band the noise of a slow motion turns its velocity about, and a law with memory
    serves as a filter of it. The search is taken back to the narrower band where there is one.
    """
    laws = [] if model.friction == start.baseline.friction else simpler_laws(model)
    if not laws or band.cutoff <= start.plain.cutoff:
        return None
    band = replace(start.plain, corner=band.corner)
    search = search_in(start, band)
    masks = search.split.fit
    best = min(map(search.problem.fit, laws), key=lambda fit: fit.rmse(masks))
    if best.rmse(masks) > (1 - CRITERIA.band_gain) * search.problem.fit(model).rmse(masks):
        return None
    return band, search, best.model


def _behind_low_pass(
    start: Prepared, band: Preparation, search: Search, final: Scored
) -> tuple[Search, Scored]:
    """Along one sine the search once more, from a low-pass of the force on, if that tells more.

    There a low-pass is no more than late at first, and what is found without it may be what it
    makes of something else: Dahl friction of a jump.
    """
    scales, model = start.data.band.scales, final.model
    named, stated = effects_of(model, start.baseline), filters_of(start.baseline.values)
    # without a jump it is no more than late
    jumps = model.friction != "none" or "damping_knee" in model.free
    if not scales.one_tone or not named or not jumps or "backlash" in model.free or stated:
        return search, final
    start.given.progress("one sine: searching once more, from a low-pass of the force on")
    again = search_in(start, band)
    begins, models = _LATE / scales.frequency, [start.baseline]
    models += [
        m for c in candidates(start.baseline, scales) if c.effect == _JUMPS for m in c.starts
    ]
    fits = parallel(again.trials.fit, [each for m in models for each in filters(m, begins)])
    begin = min(fits, key=lambda fit: fit.rmse(again.problem.masks))
    other = again.run(begin.model, until="backlash")
    late = has_filter(other.model) or "delay" in other.model.free
    # one below the only frequency makes an inertance of any size
    below = any(f.cutoff < scales.frequency for f in filters_of(other.model.values).values())
    if "backlash" in other.model.free or not late or below:
        return search, final
    plainer = other.complexity <= final.complexity and loss(other, final) < CRITERIA.exchange_loss
    plainer = plainer or as_good(other, final, again.advantage(other, final, "sensor_filter"))
    if plainer or better(final, other, again.advantage(final, other, "sensor_filter")):
        return again, other
    return search, final


def _beyond_motion(found: Searched, band: Preparation) -> Searched | None:
    """The search gone on with forces compared above the motion's band, where that tells more.

    It does where most of what is missed is there, and an effect more takes enough of it away.
    """
    data, model = found.data, found.final.model
    wide = force_band(data.learnt, model, band)
    if "backlash" in model.free or not wide:
        return None
    start = found.prepared
    start.given.progress(f"most of what is missed lies above {band.cutoff:.3g} Hz: searching there")
    band = replace(band, force_band=wide)
    search = search_in(start, band)
    final = search.run(model, until="backlash")
    learnt = data.learnt
    before, after = (rms(learnt.errors(m), learnt.masks) for m in (model, final.model))
    if "backlash" in final.model.free or after > (1 - CRITERIA.band_gain) * before:
        return None
    data = data.in_band(replace(data.preparation, force_band=wide))
    return replace(found, band=band, data=data, search=search, final=final)


def _play(found: Searched) -> Model | None:
    """The model with free play fitted to the force as measured, if it has one or needs one."""
    baseline, model = found.prepared.baseline, found.final.model
    starts: list[Model] = []
    if not has_series(baseline):
        kept = [name for name, _ in effects_of(model, baseline) if name not in DRIVE]
        rigid = submodel(model, kept, baseline)
        starts = [rigid] if rigid.free == baseline.free else [rigid, baseline]
    return play_of(found.data.followed, model, starts, found.judge.noise_floor(model))


def _with_play(found: Searched, play: Model) -> Searched:
    """The search from a model with free play on, with the force as measured."""
    data, start = found.data, found.prepared
    for _ in range(CRITERIA.more_bands):
        far = forgiving(data.followed, play).runs[0].far
        band = best_band(
            data.records, data.preparation, data.full.fit, play, data.band.scales, far
        )  # fmt: skip
        if band is data.preparation:
            break
        data = data.in_band(band)
        play = fit_play(data.followed, play)
    data = data.with_play(play)
    learnt = forgiving(data.learnt, play)
    told = start.given.progress
    search = Search(
        learnt.runs, data.full, start.baseline, told, witness=data.witness,
        one_tone=start.data.band.scales.one_tone,
    )  # fmt: skip
    return replace(found, data=data, search=search, final=search.run(play))


def _in_narrower_band(found: Searched) -> Searched:
    """Judged in the band in which the held-out data tell more of a shaft, if any."""
    data, before = found.data, found.search.baseline_fit().model
    narrow = narrower_band(
        data.records, data.preparation, data.full.holdout, before, found.final.model,
        data.band.scales,
    )  # fmt: skip
    return replace(found, data=data.in_band(narrow)) if narrow else found


# --- Searched -> Settled -------------------------------------------------------------------------


def settled(found: Searched) -> Settled:
    """Every effect compared with its rivals; where they are equal, the usual one is named."""
    search, baseline = found.search, found.prepared.baseline
    before = search.baseline_fit()
    # first the rivals: the usual cause takes the place of one that has no value of its own
    final, standings = compared(search, baseline, _plainest_law(found))
    known = identified(search, baseline, final)
    if known is not final:
        final, standings = compared(search, baseline, known)
    return Settled(searched=found, final=final, before=before, standings=standings)


def identified(search: Search, baseline: Model, final: Scored) -> Scored:
    """A model without the effects whose own parameters may be none: these are not named.

    An effect may have been sure when it was found, and lose its value to one found later. What
    varies along the stroke leaves the level that it varies about.
    """
    for effect, _ in effects_of(final.model, baseline):
        if effect == "backlash" and not search.is_felt(final.model):
            shaft = final.model.without(("backlash",))
            return identified(search, baseline, search.score("", None, search.problem.fit(shaft)))
        if is_distinct(effect, final.fit, baseline, CRITERIA.keeping_advantage):
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
    search: Search, baseline: Model, final: Scored, exchanges: int = CRITERIA.exchanges
) -> tuple[Scored, dict[str, Standing]]:
    """A model with the standing of its effects; where one's rival is to be named, with that."""
    standings: dict[str, Standing] = {}
    for effect, _ in effects_of(final.model, baseline):
        standings[effect] = standing(search, final, effect)
        better = standings[effect].better
        if exchanges and better is not None:
            return compared(search, baseline, better, exchanges - 1)
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


# --- Settled -> Confirmed ------------------------------------------------------------------------


def confirmed(start: Settled) -> Confirmed:
    """What helps on data that no fit has seen; the rest is dropped."""
    found, final = start.searched, start.final
    search, judge = found.search, found.judge
    progress = found.prepared.given.progress
    progress("measuring the gain of each effect")
    before_held_out = final.fit
    final, chain, dropped = _standing_on_held_out(found, final)
    standings = dict(start.standings)
    if dropped and chain and (further := _searched_on(found, final, dropped)):
        progress("measuring the gain of each effect")
        more, links, _ = _standing_on_held_out(found, further[0])
        new = {link.effect for link in links} - {link.effect for link in chain}
        if new and judge.rmse(more.model) < judge.rmse(final.model):
            final, chain, standings = more, links, further[1]
    # where nothing stands the baseline is left, fitted as it was
    fit, tone = _with_tone(found, final.fit if chain else start.before)
    if tone:
        link, confidence = tone
        chain.append(link)
        standings[link.effect] = Standing(confidence, [], None)
    if "backlash" in fit.model.free:
        progress("free play: how far other data would lead")
        spread = jackknife(search.problem, found.data.full.folds, fit.model)
        fit = replace(fit, covariance=fit.covariance + spread)
    else:
        progress("asking how far other choices of the analysis would lead")
        fit = with_what_was_dropped(found.covered(fit), before_held_out)
    return Confirmed(
        searched=found, data=found.data, judge=found.judge, before=start.before, fit=fit,
        chain=tuple(chain), standings=standings,
    )  # fmt: skip


def _standing_on_held_out(found: Searched, final: Scored) -> tuple[Scored, list[Link], set[str]]:
    """A model without the effects that the held-out data do not confirm; their chain; the others.

    What is left is fitted anew each time that one is dropped.
    """
    search, judge, baseline = found.search, found.judge, found.prepared.baseline
    chain = chain_of(search, judge, final.model)
    dropped: set[str] = set()
    while weak := weakest(chain, judge, final.model):
        search.progress(f"{weak} is not confirmed on held-out data: dropped")
        dropped.add(weak)
        rest = [name for name, _ in effects_of(final.model, baseline) if name != weak]
        fit = search.problem.fit(submodel(final.model, rest, baseline))
        final = search.score("", None, fit)
        chain = chain_of(search, judge, final.model)
    return final, chain, dropped


def _searched_on(
    found: Searched, final: Scored, dropped: set[str]
) -> tuple[Scored, dict[str, Standing]] | None:
    """A model with further effects in the place of those dropped, compared with their rivals.

    None where there are none. What has a shaft or a play was searched for with weights and data of
    its own, and is not taken further.
    """
    baseline = found.prepared.baseline
    if has_series(final.model):
        return None
    search = replace(found.search, found=[], excluded=frozenset({*dropped, *DRIVE}))
    search.progress(f"searching on without {', '.join(sorted(dropped))}")
    more = identified(search, baseline, search.run(final.model, most=len(dropped)))
    if not dict(effects_of(more.model, baseline)).keys() - dict(effects_of(final.model, baseline)):
        return None
    return compared(search, baseline, more)


def _with_tone(found: Searched, fit: Fit) -> tuple[Fit, tuple[Link, float] | None]:
    """The fit with its tone as the raw force has it, and one that the low-pass hides, if any."""
    learnt = found.data.learnt
    fit = with_tone_from_raw(learnt, fit)
    lowest = CRITERIA.tones_from * found.data.preparation.cutoff
    after = with_tone_above(found.data.witness, fit, lowest)
    if after is None:
        return fit, None
    link, confidence = tone_link(found.judge, fit, after)
    return (after, (link, confidence)) if link.stands else (fit, None)
