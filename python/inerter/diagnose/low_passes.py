"""Low-passes of a channel in a search: tried where a delay shows, each order and kind.

A filter is first of all late, so that where no delay shows nothing is tried, and no time is lost.
What order it has shows better once the other effects are known: it is asked again after each. Of a
delay that is found it is asked whether a filter would do as well.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from inerter.catalogue.along_stroke import node_of
from inerter.catalogue.effects import EFFECTS
from inerter.diagnose import wording
from inerter.diagnose.candidate import Candidate
from inerter.diagnose.composition import PLAYS
from inerter.diagnose.decision import CRITERIA, loss, visible
from inerter.diagnose.result import Finding, ParameterValue
from inerter.diagnose.statistics import advantage, block_squares
from inerter.diagnose.trials import FAR, FEW, within_shortlist
from inerter.identify.channel_filter import CHANNELS, KINDS, ORDERS, Filter, filter_of, named
from inerter.identify.fit import Fit, parameter_errors, rms
from inerter.identify.model import Model
from inerter.identify.runs import BenchRun
from inerter.identify.split import blocks
from inerter.parallel_steps import parallel
from inerter.records.motion import motion_noise, through_shaft

if TYPE_CHECKING:
    from inerter.diagnose.search import Scored, Search

Array = NDArray[np.float64]
Fitted = Sequence[tuple[Candidate, Fit]]

_TONE = EFFECTS["periodic_disturbance"].coordinates


def has_filter(model: Model) -> bool:
    """Whether a fit of a model may change the low-pass of a channel."""
    return any(f"{channel}_filter" in model.free for channel in CHANNELS)


def filters(model: Model, delay: float = 0.0) -> Iterator[Candidate]:
    """Low-passes of every order and kind in the place of a delay of the force channel [s].

    The displacement's, where the force seems to come too early. A low-pass that is free in a model
    is replaced by the others, and a free delay with it; one that is stated stays alone.
    """
    stated = any(f"{each}_filter" in model.values for each in CHANNELS)
    if stated and not has_filter(model):
        return
    late, channel = delay, "force" if delay > 0 else "displacement"
    for each in CHANNELS:
        if (there := filter_of(model.values, each)) is not None:
            sign = 1.0 if each == "force" else -1.0
            late = sign * there.lateness + (model.delay if "delay" in model.free else 0.0)
            channel = each
    if not late:
        return
    dropped = EFFECTS["sensor_filter"].coordinates
    bare = model.without((*dropped, "delay") if "delay" in model.free else dropped)
    shapes = [(kind, order) for order in ORDERS for kind in KINDS if order > 1 or kind == KINDS[0]]
    for kind, order in shapes:
        found = named(channel, Filter.as_late_as(abs(late), kind, order))
        cutoff = {f"{channel}_filter": found.pop(f"{channel}_filter")}
        law = f"{channel} {kind} {order}"
        yield Candidate("sensor_filter", law, (bare.adding(None, **cutoff).holding(**found),))


def noise_taken(
    model: Model, runs: Sequence[BenchRun], blocks: Sequence[tuple[int, NDArray[np.intp]]]
) -> Array:
    """What a model takes of the noise that it foretells [N^2], by block.

    Noise of the displacement is one of b a in what is foretold, and goes through a low-pass of the
    force or a shaft with much damping: a model with one misses less for that alone, and would win
    by it over a delay. Where errors count by the noise of the motion, as much of what is expected
    is added to them again.
    """
    found = np.zeros(len(blocks))
    low_pass, shaft = filter_of(model.values, "force"), model.shaft
    if low_pass is None and shaft is None:
        return found
    for i, (number, index) in enumerate(blocks):
        run = runs[number]
        if run.noise and np.isfinite(run.corner):
            frequency = np.linspace(0.0, run.cutoff, 65)
            expected = motion_noise(frequency, run.corner, run.shaft, run.quiet)
            passed = motion_noise(frequency, run.corner, None, run.quiet) - 1.0
            if low_pass is not None:
                passed = passed * np.abs(low_pass.response(frequency)) ** 2
            if shaft is not None:
                passed = passed * through_shaft(frequency, shaft)
            left = np.mean(np.minimum((1.0 + passed) / expected, 1.0))
            found[i] = index.size * run.noise**2 * (1.0 - float(left))
    return found


def where_late(search: Search, current: Scored, fitted: Fitted) -> list[tuple[Candidate, Fit]]:
    """The best low-passes where a delay helps nearly as much as anything else, or has been found.

    What strikes behind a play is rounded by a low-pass of any cut-off, and no delay tells of it: it
    is asked for there too. fitted: the other candidates, the best first.
    """
    masks, here = search.problem.masks, current.fit
    if has_filter(here.model) or "sensor_filter" in search.excluded:
        return []
    delay = here.model.delay if "delay" in here.model.free else 0.0
    late = next((fit for trial, fit in fitted if trial.effect == "sensor_delay"), None)
    if late is not None and not delay:
        near = late.rmse(masks) < CRITERIA.late_enough * fitted[0][1].rmse(masks)
        gains = late.rmse(masks) < (1 - CRITERIA.gain) * here.rmse(masks)
        delay = late.model.delay if near and gains else 0.0
    if not delay and not PLAYS.isdisjoint(here.model.free):
        delay = search.spacing
    return _best(search, here, within_shortlist([fit.rmse(masks) for _, fit in fitted]), delay)


def as_delay(model: Model) -> Model:
    """The model with a delay in the place of its low-pass, as late as that is."""
    late = model.delay
    for channel, sign in (("force", 1.0), ("displacement", -1.0)):
        if (there := filter_of(model.values, channel)) is not None:
            late += sign * there.lateness
    return model.without(EFFECTS["sensor_filter"].coordinates).adding(None, delay=late)


def _best(
    search: Search, here: Fit, reach: float, delay: float = 0.0
) -> list[tuple[Candidate, Fit]]:
    """The best fits of low-passes; what comes nowhere near a `reach` [N] is left as it is."""
    masks = search.problem.masks
    trials = likeliest(search, list(filters(here.model, delay)))
    limit = (here.rmse(masks), np.inf)
    fits = parallel(lambda trial: search.trials.fit(trial, limit, reach), trials)
    pairs = sorted(zip(trials, fits, strict=True), key=lambda pair: pair[1].rmse(masks))
    return pairs[: CRITERIA.filters_kept]


def likeliest(search: Search, trials: list[Candidate]) -> list[Candidate]:
    """Low-passes that do best while curves along the stroke stay as they are, where there are some.

    Behind a low-pass of the displacement nothing is linear, and each node costs a prediction.
    """
    if not any(node_of(name) for trial in trials for name in trial.starts[0].free):
        return trials

    def error(trial: Candidate) -> float:
        start = trial.starts[0]
        held = replace(start, free=tuple(name for name in start.free if not node_of(name)))
        return search.problem.fit(held, FEW, rough=True).rmse(search.problem.masks)

    errors = parallel(error, trials)
    return [trials[i] for i in np.argsort(errors)[: CRITERIA.filters_kept]]


def _nearest_as_measured(search: Search, fits: list[Fit]) -> list[Fit]:
    """Fits with a low-pass each, the nearest to the force as measured first.

    In the band they are alike; which order makes the jumps that were measured is told above it.
    """
    problem = search.witness.raw if search.witness else search.problem
    return sorted(fits, key=lambda fit: rms(problem.errors(fit.model), problem.masks))


def jumps_late(search: Search, delayed: Scored, filtered: Scored) -> bool:
    """Whether the force as measured jumps, late, where a low-pass would have smoothed it.

    Friction that jumps tells the two apart above the band in which a search compares them.
    """
    jumps = delayed.model.friction != "none" or "backlash" in delayed.model.values
    if search.witness is None or not jumps or loss(delayed, filtered) > CRITERIA.too_much:
        return False
    raw = search.witness.raw
    counted = blocks(raw.masks)
    late, smooth = (block_squares(raw.errors(s.model), counted) for s in (delayed, filtered))
    gain = 1.0 - float(np.sqrt(late.sum() / smooth.sum()))
    return gain > CRITERIA.gain and advantage(smooth, late) > CRITERIA.advantage


def other_filter(search: Search, current: Scored) -> Scored | None:
    """A delay in the place of the low-pass found, where that does as well; else a better low-pass.

    Of another order or kind. A delay beside it is tried without.
    """
    if not has_filter(current.model):
        return None
    delayed = search.score("exchange", None, search.problem.fit(as_delay(current.model)))
    masks, force = search.problem.masks, search.problem.scales.force
    errors = rms(delayed.residual, masks), rms(current.residual, masks)
    # also where the two differ by no more than what interpolation between samples leaves
    if loss(delayed, current) < CRITERIA.gain or not visible(*errors, 0.0, force):
        return delayed
    if jumps_late(search, delayed, current):
        return delayed
    for _, fit in _best(search, current.fit, current.fit.rmse(masks)):
        scored = search.score("exchange", None, fit)
        least = CRITERIA.gain if scored.complexity == current.complexity else 0.0
        if loss(current, scored) > least:
            return scored
    return None


def with_low_pass(finding: Finding, search: Search, fit: Fit) -> Finding:
    """A delay that is found, and the low-passes that are as late and do as well.

    Where friction jumps late in the force as measured it is a delay.
    """
    model, late = fit.model, fit.model.values.get("delay", 0.0)
    known = any(f"{each}_filter" in model.values for each in CHANNELS)
    if finding.effect != "sensor_delay" or finding.members or known or "delay" not in model.free:
        return finding
    masks = search.problem.masks
    here = replace(fit, residual=search.problem.residual(model))
    limit = here.rmse(masks) * (1 + CRITERIA.tolerated_loss)
    # a tone is told above the band of the search, in which it would go astray
    told = replace(model, free=tuple(name for name in model.free if name not in _TONE))
    tried = likeliest(search, list(filters(told, late)))
    fits = parallel(lambda each: search.trials.fit(each, (FAR * limit, np.inf), limit), tried)
    near = _nearest_as_measured(search, [f for f in fits if f.rmse(masks) < limit])
    if not near:
        return finding
    # in the band a low-pass and a delay may do as well, and not where friction jumps
    if jumps_late(search, *(search.score("", None, each) for each in (here, near[0]))):
        return finding
    name = f"{'force' if late > 0 else 'displacement'}_filter"
    cutoffs = [each.model.values[name] for each in near]
    error = max(parameter_errors(near[0])[name][1], 0.5 * float(np.ptp(cutoffs)))
    found = replace(
        finding, members=("sensor_delay", "sensor_filter"),
        parameters={**finding.parameters, name: ParameterValue(cutoffs[0], error, "Hz")},
        rivals=[rival for rival in finding.rivals if rival.effect != "sensor_filter"],
    )  # fmt: skip
    return replace(found, evidence=wording.evidence(found))
