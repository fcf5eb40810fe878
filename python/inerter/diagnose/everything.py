"""What was found on stretches of long records, fitted to all of them and judged there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from inerter.diagnose.chain import Link
from inerter.diagnose.data import Data, divided
from inerter.diagnose.excerpts import Excerpts
from inerter.diagnose.judge import Judge
from inerter.diagnose.stages import Confirmed, judge_of, weighed_runs
from inerter.diagnose.statistics import gain_interval
from inerter.diagnose.tone import with_tone_from_raw
from inerter.identify.choices import covered
from inerter.identify.fit import Fit, Problem, rms
from inerter.identify.split import split
from inerter.records.motion import force_noise, smooth
from inerter.records.preparation import Preparation

Array = NDArray[np.float64]

_STEPS = 15
"""Evaluations of a fit to everything, which begins near its end."""


def on_everything(stands: Confirmed, found: Excerpts) -> Confirmed:
    """The same findings, with values and figures of all samples."""
    start = stands.searched.prepared
    start.given.progress("fitting what was found to the whole record")
    found = followed_as(found, stands.data.records[0].instants)
    data = divided(found.records, _whole(stands.data.preparation, found), found.holdout)
    play = "backlash" in stands.fit.model.free
    if play:
        data = data.with_play(stands.fit.model)
    prepared = replace(
        start, given=found.whole, constants=found.constants, contradicting=found.contradicting
    )
    judge = judge_of(data, stands.searched.search, start.baseline)
    problem = None if play else _problem(stands, data, found)
    fit, before = (_refitted(stands, each, problem, data) for each in (stands.fit, stands.before))
    return replace(
        stands,
        searched=replace(stands.searched, prepared=prepared),
        data=data,
        judge=judge,
        before=before,
        fit=fit,
        chain=tuple(_judged(judge, link, before, fit) for link in stands.chain),
    )


def followed_as(found: Excerpts, instants: int) -> Excerpts:
    """Everything followed as often as the stretches, whose samples are means of some."""
    pairs = zip(found.records, found.every, strict=True)
    records = [replace(record, instants=-(-instants // every)) for record, every in pairs]
    return replace(found, records=records)


def _whole(preparation: Preparation, found: Excerpts) -> Preparation:
    """Everything smoothed as the stretches were."""
    motions = [smooth(r, preparation.cutoff, preparation.channels) for r in found.records]
    noise = [force_noise(record.force) ** 2 for record in found.records]
    return replace(preparation, motions=motions, noise_floor=float(np.sqrt(np.mean(noise))))


def _problem(stands: Confirmed, data: Data, found: Excerpts) -> Problem:
    """All that is fitted, as it counted in the search."""
    searched = stands.searched
    band = data.preparation
    if searched.band.cutoff != band.cutoff or searched.band.force_band != band.force_band:
        band = _whole(searched.band, found)
    band = replace(band, corner=searched.band.corner)
    shaft = searched.search.runs[0].shaft
    runs = [replace(run, shaft=shaft) for run in weighed_runs(band)]
    return Problem(
        runs, split(runs, data.held, data.split.in_blocks).fit, searched.search.problem.scales
    )


def _refitted(stands: Confirmed, fit: Fit, problem: Problem | None, data: Data) -> Fit:
    """A fit to everything; as it was where that is no better."""
    if problem is None or not fit.model.free:
        return fit
    again = problem.fit(fit.model, _STEPS, tolerance=1e-7)
    if not again.rmse(problem.masks) <= rms(problem.residual(fit.model), problem.masks):
        return fit
    again = with_tone_from_raw(data.learnt, again)
    return covered(problem, again, data.records, data.preparation.channels)


def _judged(judge: Judge, link: Link, first: Fit, last: Fit) -> Link:
    """A link with the errors that its fits have on everything that is held out.

    The baseline and the extended model, `first` and `last`, are fitted to everything.
    """
    if link.seen_in_blocks:
        return link
    before = first.model if link.before.model.free == first.model.free else link.before.model
    after = last.model if link.after.model.free == last.model.free else link.after.model
    squares = [judge.error_squares(model) for model in (before, after)]
    return replace(
        link,
        rmse_before=judge.rmse(before),
        rmse_after=judge.rmse(after),
        interval=gain_interval(*squares),
    )


def errors_of(stands: Confirmed) -> Sequence[Array]:
    """Measured minus predicted force of every run where the motion is known, 0 elsewhere [N]."""
    errors = stands.data.raw.errors(stands.fit.model)
    pairs = zip(errors, stands.data.whole, strict=True)
    return [np.where(run.inner, error, 0.0) for error, run in pairs]
