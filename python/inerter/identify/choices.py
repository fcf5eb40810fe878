"""What other choices, as good as those made, would move an estimate by.

A residual does not show every error: smoothing that blurs a jump of friction, a filter in front of
a card that nobody knows of, the instant between two samples at which the motion turns. Such errors
repeat with every stroke, so that residuals summed over blocks take them for certain. They show when
the choices change: with less smoothing a bias by smoothing goes down, without the slow parts, where
friction jumps, what jumps are late by goes away. A channel that is late may be so by a low-pass,
which takes amplitude away, too. One Gauss-Newton step from the fit says how far an estimate moves,
and so far it counts as unsure (Hausman, Econometrica 46(6), 1978: estimates that agree only where
the model is right).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from inerter.identify.channel_filter import Filter, filter_of, named
from inerter.identify.fit import Fit, Problem
from inerter.identify.model import Model
from inerter.identify.runs import BenchRun, on_clocks, thin
from inerter.records import Record
from inerter.records.motion import smooth

Array = NDArray[np.float64]

LESS_SMOOTHING = (1.4, 2.0)
"""Other cut-offs, per cut-off of the fit."""
SLOW = 0.3
"""Speed, per rms speed, below which samples are slow."""
KEPT = 0.05
"""Share of the fit's information that a choice keeps: what only the slow parts tell stays put."""
FILTERS = (("butterworth", 1), ("bessel", 2), ("bessel", 4))
"""Kinds and orders of low-passes that a delay may be; of order one they are all alike."""
AS_GOOD = 1.01
"""Squared residual, per that with the delay, up to which a low-pass does as well."""
TONE = ("disturbance_amplitude", "disturbance_frequency")
"""Coordinates that do not hang on how the motion is smoothed."""
HIGHEST = 0.3
"""Highest other cut-off, per sampling rate."""


def covered(
    problem: Problem, fit: Fit, records: Sequence[Record], channels: tuple[str, ...] = ()
) -> Fit:
    """A fit of a problem with what other choices would move it by in its errors, see below.

    They are those of a jackknife over blocks before, where these are larger.
    """
    units = problem.units(fit.model)
    # a tone is fitted to the force as measured, and may lie above the band
    kept = [i for i, name in enumerate(fit.model.free) if name not in TONE]
    rest = replace(fit.model, free=tuple(fit.model.free[i] for i in kept))
    moved = np.zeros((units.size, units.size))
    moved[np.ix_(kept, kept)] = moved_by_choices(problem, rest, records, channels)
    larger = np.ones(units.size)
    larger[kept] = _jackknifed(problem, rest)
    covariance = fit.covariance * np.outer(larger, larger)
    return replace(fit, covariance=covariance + moved * np.outer(units, units))


def _jackknifed(problem: Problem, model: Model) -> Array:
    """Standard errors of a jackknife over blocks per those of their scores, at least 1, (p,)."""
    if not model.free:
        return np.zeros(0)
    fit, derivatives = (
        Fit(model, problem.residual(model), np.empty(0), 1),
        problem.derivatives(model),
    )
    alone, scored = (
        np.diag(problem.told(fit, derivatives, left_out).covariance) for left_out in (True, False)
    )
    with np.errstate(invalid="ignore", divide="ignore"):
        larger = np.sqrt(alone / scored)
    return np.where(larger > 1, larger, 1.0)


def moved_by_choices(
    problem: Problem,
    model: Model,
    records: Sequence[Record],
    channels: tuple[str, ...] = (),
    changed: Callable[[BenchRun], BenchRun] | None = None,
) -> Array:
    """Covariance of the free search variables that other choices make, shape (p, p).

    Parameters
    ----------
    problem, model
        What was fitted, and to what.
    records
        Those of the problem's runs.
    channels
        Measured channels that were smoothed together with the displacement.
    changed
        What is done to a run before a model follows it.
    """
    if not model.free:
        return np.zeros((0, 0))
    jacobian = problem.jacobian(model)
    least = KEPT * jacobian.T @ jacobian
    # of a coordinate at its bound, or a robust fit, the first step is not none
    begin = _step(problem, model, least)
    slow = _step(_without_slow(problem), model, least) - begin
    others = [
        _step(other, model, least) - begin
        for other in _less_smoothed(problem, records, channels, changed or (lambda run: run))
    ]
    as_late = [step - begin for step in _as_filter(problem, model, least)]
    return np.outer(slow, slow) + _mean_square(others) + _mean_square(as_late)


def _mean_square(steps: Sequence[Array]) -> Array | float:
    return np.mean([np.outer(step, step) for step in steps], axis=0) if steps else 0.0


def _step(problem: Problem, model: Model, least: Array) -> Array:
    """Gauss-Newton step from a model, with `least` added to the information (p,)."""
    jacobian, residual = problem.jacobian(model), problem.masked(problem.residual(model))
    if not (np.isfinite(jacobian).all() and np.isfinite(residual).all()):
        return np.zeros(len(least))
    information = jacobian.T @ jacobian + least
    return -np.linalg.pinv(information, rcond=1e-12, hermitian=True) @ (jacobian.T @ residual)


def _as_filter(problem: Problem, model: Model, least: Array) -> Iterator[Array]:
    """Steps from the model with low-passes in the place of a free delay, where they do as well."""
    if not model.delay or "delay" not in model.free:
        return
    channel = "force" if model.delay > 0 else "displacement"
    if filter_of(model.values, channel) is not None:
        return
    here = np.sum(problem.masked(problem.residual(model)) ** 2)
    for kind, order in FILTERS:
        low_pass = Filter.as_late_as(abs(model.delay), kind, order)
        late = model.holding(delay=0.0, **named(channel, low_pass))
        step = _step(problem, late, least)
        there = np.sum(problem.masked(problem.residual(problem.moved(late, step))) ** 2)
        if there < AS_GOOD * here:
            yield step


def _without_slow(problem: Problem) -> Problem:
    limit = SLOW * problem.scales.velocity
    masks = [
        mask & (np.abs(run.velocity) > limit)
        for mask, run in zip(problem.masks, problem.runs, strict=True)
    ]
    return problem.with_masks(masks)


def _less_smoothed(
    problem: Problem,
    records: Sequence[Record],
    channels: tuple[str, ...],
    changed: Callable[[BenchRun], BenchRun],
) -> Iterator[Problem]:
    """The problem at other cut-offs, none where the force is taken as measured."""
    tried = set()
    # forces may be compared above the band of the motion, and are so with less smoothing, too
    bands = [min(run.cutoff, run.quiet) for run in problem.runs]
    above = [run.cutoff if run.quiet < run.cutoff else 0.0 for run in problem.runs]
    for factor in LESS_SMOOTHING:
        cutoffs = [
            min(factor * band, max(HIGHEST * record.sample_rate, band))
            for band, record in zip(bands, records, strict=True)
        ]
        same = cutoffs == bands
        if not np.isfinite(cutoffs).all() or same or tuple(cutoffs) in tried:
            continue
        tried.add(tuple(cutoffs))
        smoothed = [
            thin(smooth(record, cutoff, channels), force_band=wide)
            for record, cutoff, wide in zip(records, cutoffs, above, strict=True)
        ]
        runs = [
            changed(replace(new, clock=old.clock, corner=old.corner, shaft=old.shaft, far=old.far))
            for new, old in zip(on_clocks(smoothed), problem.runs, strict=True)
        ]
        # which samples count, at the instants of these runs
        masks = [
            np.interp(new.time, old.time, mask.astype(float)) > 0.99
            for new, old, mask in zip(runs, problem.runs, problem.masks, strict=True)
        ]
        yield Problem(runs, masks, problem.scales)
