"""The effects that predict best, in the band in which the model found predicts best."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from inerter.diagnose.along_stroke import is_drawn
from inerter.diagnose.band import best_band, force_band, narrower_band, wider_band
from inerter.diagnose.bent_damping import is_bent
from inerter.diagnose.candidates import candidates
from inerter.diagnose.cannot_tell import hidden_by_force
from inerter.diagnose.clipping import SATURATION, begun_clipped
from inerter.diagnose.composition import (
    DRIVE,
    effects_of,
    simpler_laws,
    submodel,
)
from inerter.diagnose.data import Data
from inerter.diagnose.decision import CRITERIA, as_good, better, loss
from inerter.diagnose.judge import Judge
from inerter.diagnose.lateness import from_delay_on
from inerter.diagnose.low_passes import filters, has_filter
from inerter.diagnose.play import fit_play, forgiving, play_of
from inerter.diagnose.search import Scored, Search
from inerter.diagnose.start import Prepared
from inerter.identify.channel_filter import filters_of
from inerter.identify.choices import covered
from inerter.identify.fit import Fit, Problem
from inerter.identify.model import Model
from inerter.identify.runs import BenchRun, on_clocks, thin
from inerter.identify.split import split
from inerter.parallel_steps import parallel
from inerter.records.preparation import Preparation

# share of a period that a low-pass along one sine begins with, and what it may smooth
_LATE, _JUMPS = 0.03, "coulomb_friction"
_PLAY = frozenset({"backlash"})


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


def searched(start: Prepared) -> Searched:
    """The plainest model that predicts best.

    Where the model found predicts the force better in a wider band, the search goes on there.
    """
    data, band = start.data, start.weighed
    if wide := _harmonics(start):
        band = replace(band, force_band=wide)
        data = data.in_band(replace(data.preparation, force_band=wide))
    search = search_in(start, band)
    final = search.run(until="backlash")
    band, search, final = _in_wider_bands(start, data, band, search, final)
    if calmer := _calmer(start, band, final.model):
        band, search, plainer = calmer
        final = search.run(plainer, until="backlash")
    search, final = without_curves(start, band, search, final)
    search, final = _behind_low_pass(start, band, search, final)
    final = from_delay_on(search, final) or final
    if "backlash" in final.model.free:
        start.given.progress("free play: fitting it to the force as measured")
    elif raw := _wider(data, data.preparation, final.model):
        data = data.in_band(raw)
    found = Searched(prepared=start, band=band, data=data, search=search, final=final)
    # what a play does lies above the motion's band too, and is asked for first
    if play := _play(found):
        followed = _with_play(found, play)
        if _PLAY.issubset(followed.final.model.free):
            return followed
        found = _without_play(found, followed.final.model)
    return _in_narrower_band(found)


def _harmonics(start: Prepared) -> float:
    """Band [Hz] of the force's harmonics along one sine, where most of them are above the motion's.

    In them alone most friction laws and dampers differ; 0 where there are none.
    """
    scales, model = start.data.band.scales, start.baseline
    if not scales.one_tone:
        return 0.0
    # what is linear in the motion, and takes all else along one sine
    linear = ["viscous", "force_offset", "inertance"]
    begin = {name: model.values.get(name, 0.0) for name in linear if name not in model.free}
    fit = search_in(start, start.weighed).problem.fit(model.adding(None, **begin))
    return force_band(start.data.learnt, fit.model, start.weighed)


def search_in(start: Prepared, band: Preparation) -> Search:
    """A search in which errors count by the noise of the motion."""
    runs = weighed_runs(band)
    parted = split(runs, start.data.held, start.data.split.in_blocks)
    records = start.data.records
    never = hidden_by_force(records)
    return Search(
        runs, parted, start.baseline, start.given.progress, witness=start.data.witness,
        one_tone=start.data.band.scales.one_tone, time=start.given.time, never=never,
        begin=None if SATURATION in never else begun_clipped(records, start.baseline),
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


def _in_wider_bands(
    start: Prepared, data: Data, band: Preparation, search: Search, final: Scored
) -> tuple[Preparation, Search, Scored]:
    """The search gone on in the bands in which the model found predicts the force better."""
    excluded = search.excluded
    for _ in range(CRITERIA.more_bands):
        wider = _wider(data, band, final.model)
        if "backlash" in final.model.free or wider is None:
            break
        band, search = wider, search_in(start, wider)
        search.excluded = excluded
        final = search.run(final.model, until="backlash")
    return band, search, final


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


def without_curves(
    start: Prepared, band: Preparation, search: Search, final: Scored
) -> tuple[Search, Scored]:
    """The search once more without curves along the stroke, if that says as much with less.

    A curve is near to many causes at once: it is the best to add where each of them alone leaves
    far more, though two or three of them together leave less.
    """
    few = len(effects_of(final.model, start.baseline)) <= 1 + CRITERIA.drawn_beside
    if not (few and is_drawn(final.model)):
        return search, final
    start.given.progress("searching once more, without curves along the stroke")
    again = search_in(start, band)
    again.draws = False
    other = again.run(until="backlash")
    again.draws = True
    # on the same blocks, and as errors count for whichever has a shaft
    judge = again if other.model.shaft else search
    told, drawn = (judge.score_on_blocks(each.fit) for each in (other, final))
    plain, curved = (dict(effects_of(each.model, start.baseline)) for each in (other, final))
    # a curve may have drawn two causes, beside which all others stay
    beside = {name for name, law in curved.items() if law not in ("curve", "flanks")}
    most = len(curved) + (beside <= plain.keys())
    less = other.complexity < final.complexity and len(plain) <= most
    return (again, other) if less and loss(told, drawn) < CRITERIA.gain else (search, final)


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
    jumps = model.friction != "none" or is_bent(model)
    if not scales.one_tone or not named or not jumps or "backlash" in model.free or stated:
        return search, final
    start.given.progress("one sine: searching once more, from a low-pass of the force on")
    again = search_in(start, band)
    # of more it would have to tell more than by chance, and each step takes longer
    again.most_complex = final.complexity + 1
    begins, models = _LATE / scales.frequency, [start.baseline]
    models += [
        m for c in candidates(start.baseline, scales) if c.effect == _JUMPS for m in c.starts
    ]
    fits = parallel(again.trials.fit, [each for m in models for each in filters(m, begins)])
    begin = min(fits, key=lambda fit: fit.rmse(again.problem.masks))
    other = again.run(begin.model, until="backlash")
    again.most_complex = np.inf
    late = has_filter(other.model) or "delay" in other.model.free
    if "backlash" in other.model.free or not again.may_be(other.model):
        return search, final
    plainer = other.complexity <= final.complexity and loss(other, final) < CRITERIA.exchange_loss
    plainer = plainer or as_good(other, final, again.advantage(other, final, "sensor_filter"))
    if not late:
        # the way led elsewhere, and the low-pass was not needed there
        return (
            (again, other) if plainer and other.complexity < final.complexity else (search, final)
        )
    if plainer or better(final, other, again.advantage(final, other, "sensor_filter")):
        return again, other
    return search, final


def _play(found: Searched) -> Model | None:
    """The model with free play fitted to the force as measured, if it has one or needs one."""
    baseline, model = found.prepared.baseline, found.final.model
    starts: list[Model] = []
    if not baseline.has_series:
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
        one_tone=start.data.band.scales.one_tone, time=start.given.time,
        never=found.search.never,
    )  # fmt: skip
    return replace(found, data=data, search=search, final=search.run(play))


def _without_play(found: Searched, model: Model) -> Searched:
    """The search from what has done the work of a play on, along all of the runs again."""
    start, data, search = found.prepared, found.data, found.search
    search.excluded |= _PLAY
    final = search.run(model)
    band, search, final = _in_wider_bands(start, data, found.band, search, final)
    search.excluded -= _PLAY
    if raw := _wider(data, data.preparation, final.model):
        data = data.in_band(raw)
    return replace(found, band=band, data=data, search=search, final=final)


def _in_narrower_band(found: Searched) -> Searched:
    """Judged in the band in which the held-out data tell more of a shaft, if any."""
    data, before = found.data, found.search.baseline_fit().model
    narrow = narrower_band(
        data.records, data.preparation, data.full.holdout, before, found.final.model,
        data.band.scales,
    )  # fmt: skip
    return replace(found, data=data.in_band(narrow)) if narrow else found
