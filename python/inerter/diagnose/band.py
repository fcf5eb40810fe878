"""The band of the motion: whether a model that was found predicts the force better in another.

The cut-offs were chosen with a linear model, which knows neither contacts nor a resonance. What
friction does where the motion turns, and what goes with the place along a fast stroke, is quicker
than the motion: a force may show more of it above the motion's cut-off than below.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter, median_filter

from inerter.catalogue.scales import Scales
from inerter.diagnose.decision import CRITERIA
from inerter.identify.fit import Masks, Problem, rms
from inerter.identify.model import Model
from inerter.identify.runs import on_clocks, whole
from inerter.records import Record
from inerter.records.motion import Motion
from inerter.records.preparation import Preparation, prepare_again

Array = NDArray[np.float64]
Error = Callable[[Problem], float]

# lines of a spectrum of errors, at most; how far one of a tone is above the median of those about;
# lines of one sine's harmonic
_LINES, _TONE, _BESIDE, _PARTED = 250, 4.0, 21, 8


def best_band(
    records: Sequence[Record],
    preparation: Preparation,
    learnt: Masks,
    model: Model,
    sizes: Scales,
    far: float = np.inf,
) -> Preparation:
    """The records in the band in which a model predicts the samples `learnt` best.

    Errors count as in fits of that preparation, beyond `far` [N] little.
    """

    def error(problem: Problem) -> float:
        return rms(problem.residual(model), problem.masks)

    return _smoothed(records, preparation, learnt, model, sizes, error, far)


def wider_band(
    records: Sequence[Record],
    preparation: Preparation,
    learnt: Masks,
    model: Model,
    sizes: Scales,
) -> Preparation | None:
    """The records in the wider band in which a model predicts `learnt` better, if any."""
    again = best_band(records, preparation, learnt, model, sizes)
    return again if _lowered(preparation, again, 1) else None


def narrower_band(
    records: Sequence[Record],
    preparation: Preparation,
    held_out: Masks,
    baseline: Model,
    model: Model,
    sizes: Scales,
) -> Preparation | None:
    """The records in the narrower band in which `held_out` tells more of a shaft, if any.

    Near its resonance a shaft amplifies the motion's noise. Runs that are fitted may be loud enough
    there, and the one held out not. The geometric mean of the two models' errors decides, which
    favours neither.
    """
    if model.shaft is None:
        return None

    def error(problem: Problem) -> float:
        one, other = (rms(problem.errors(m), problem.masks) for m in (baseline, model))
        return float(np.sqrt(one * other))

    again = _smoothed(records, preparation, held_out, model, sizes, error)
    return again if _lowered(preparation, again, -1) else None


def force_band(learnt: Problem, model: Model, preparation: Preparation) -> float:
    """Band [Hz] that has what a model misses of the force, where most of that is above the motion.

    0 where most is within the motion's band, or is the force's noise, or tones. `learnt` has the
    force as measured.
    """
    cutoff = preparation.cutoff
    power, frequency = _power_missed(learnt, model)
    harmonic = _of_motion(frequency, learnt.scales)
    # along one sine all that the motion makes is in its harmonics
    above = 1.0 if learnt.scales.one_tone else _TONE
    apart = np.minimum(power, above * median_filter(power, _BESIDE))
    # a line beside a larger one of a tone is what leaks of that
    largest = harmonic & (power == maximum_filter(power, 5))
    power = np.where(maximum_filter(largest, 3), power, apart)
    noise = preparation.noise_floor**2 / power.size
    missed = np.maximum(power - noise, 0.0)
    beyond = float(missed[frequency > cutoff].sum())
    # of the noise what is in the lines that may show something
    heard = np.sqrt(harmonic.mean()) if harmonic.any() else 1.0
    loud = max(
        CRITERIA.loud_beyond * heard * preparation.noise_floor,
        CRITERIA.force_share * learnt.scales.force,
    )
    if not beyond or beyond < max(CRITERIA.share_beyond * float(missed.sum()), loud**2):
        return 0.0
    share = np.cumsum(missed) / missed.sum()
    widest = float(frequency[np.searchsorted(share, CRITERIA.kept_beyond)])
    return float(np.clip(widest, cutoff, CRITERIA.widest_force_band * cutoff))


def _of_motion(frequency: Array, sizes: Scales) -> NDArray[np.bool_]:
    """Lines that end at these frequencies [Hz] and may be harmonics of one sine, so no tones."""
    if not sizes.one_tone:
        return np.zeros(frequency.size, bool)
    width = frequency[0] / sizes.frequency
    middle = frequency / sizes.frequency - 0.5 * width
    # half a line, and half as much for what leaks into the next one
    return np.abs(middle - np.round(middle)) <= 0.75 * width


def _power_missed(learnt: Problem, model: Model) -> tuple[Array, Array]:
    """Power of a model's error at frequencies [Hz] up to the lowest Nyquist's, summing to it."""
    errors = learnt.errors(model, counted=True)
    used = [
        (np.where(mask, error, 0.0), run.spacing)
        for run, mask, error in zip(learnt.runs, learnt.masks, errors, strict=True)
        if mask.any()
    ]
    highest = min(0.5 / spacing for _, spacing in used)
    # each with some lines of every run; along one sine so narrow that they part its harmonics
    sizes = learnt.scales
    most = max(_LINES, int(_PARTED * highest / sizes.frequency)) if sizes.one_tone else _LINES
    lines = int(np.clip(min(error.size for error, _ in used) // 8, 1, most))
    edges = np.linspace(0.0, highest, lines + 1)
    power = np.zeros(lines)
    for error, spacing in used:
        squares = np.abs(np.fft.rfft(error)) ** 2 / (0.5 * error.size)
        power += np.histogram(np.fft.rfftfreq(error.size, spacing), edges, weights=squares)[0]
    samples = sum(int(mask.sum()) for mask in learnt.masks)
    return power / samples, edges[1:]


def _smoothed(
    records: Sequence[Record],
    preparation: Preparation,
    judged: Masks,
    model: Model,
    sizes: Scales,
    error: Error,
    far: float = np.inf,
) -> Preparation:
    """The records at the cut-off at which the error over the samples `judged` is smallest."""

    def along(motions: Sequence[Motion], masks: Masks) -> float:
        runs = [
            replace(run, corner=preparation.corner, shaft=model.shaft, far=far)
            for run in on_clocks([whole(motion) for motion in motions])
        ]
        both = [mask & other for mask, other in zip(masks, judged, strict=True)]
        return error(Problem(runs, both, sizes))

    return prepare_again(records, preparation, along)


def _lowered(before: Preparation, after: Preparation, way: int) -> bool:
    """Whether another band, wider (1) or narrower (-1), takes enough of the error away."""
    here, there = (
        float(after.errors[np.searchsorted(after.cutoffs, 0.999 * p.cutoff)])
        for p in (before, after)
    )
    return way * (after.cutoff - before.cutoff) > 0 and there < (1 - CRITERIA.band_gain) * here
