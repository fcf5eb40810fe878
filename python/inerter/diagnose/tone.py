"""A tone that the motion does not contain: where to look for it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import block_diag
from scipy.ndimage import median_filter

from inerter.catalogue.coordinates import LOWEST_TONE
from inerter.identify.fit import Fit, Problem
from inerter.identify.runs import BenchRun

Array = NDArray[np.float64]

# power of a bin per local median, mean over the runs: chance exceeds it once in e^15 bins and runs
_REQUIRED = 15.0
# share of power in a few bins from which on the motion has the line itself; friction along it has
# one wherever it stands out from what is beside it
_OWN_LINE = {"velocity": 0.1, "acceleration": 0.1, "friction": 1e-4}
_STANDS_OUT = 15.0
_NEIGHBOURS = 2
_PADDING = 2
_TONE = ("disturbance_amplitude", "disturbance_frequency")


def strongest_line(
    runs: Sequence[BenchRun],
    residual: Sequence[Array],
    masks: Sequence[NDArray[np.bool_]],
    lowest: float = LOWEST_TONE,
    highest: float = np.inf,
) -> tuple[float, float] | None:
    """Frequency [Hz] and amplitude [N] of the clearest line in what a model leaves, or None.

    Lines that the motion has, or friction along it, do not count.

    Parameters
    ----------
    runs
        Motions.
    residual, masks
        Of every run: measured minus predicted force [N], and the samples that count.
    lowest, highest
        Band to look in [Hz].
    """
    used = [i for i, mask in enumerate(masks) if mask.sum() > 64]
    if not used:
        return None
    longest = max(runs[i].spacing * runs[i].force.size for i in used)
    top = min(highest, *(min(0.45 / runs[i].spacing, 2 * runs[i].cutoff) for i in used))
    frequency = np.arange(lowest, top, 1 / (_PADDING * longest))
    if frequency.size < 8:
        return None
    clear, amplitude = np.zeros(frequency.size), np.zeros(frequency.size)
    free = np.zeros(frequency.size)
    for i in used:
        run, mask = runs[i], masks[i]
        window = np.hanning(mask.size) * mask
        power = _power(np.where(mask, residual[i], 0.0) * window, run.spacing, frequency, longest)
        floor = _typical(power) / np.log(2) + 1e-300
        own = np.zeros(frequency.size, bool)
        motion = {"velocity": run.velocity, "acceleration": run.acceleration,
                  "friction": np.sign(run.velocity)}  # fmt: skip
        for name, values in motion.items():
            line = _power(values * window, run.spacing, frequency, longest)
            near = np.convolve(line, np.ones(2 * _NEIGHBOURS * _PADDING + 1), "same")
            has = near > _OWN_LINE[name] * np.sum(line)
            if name == "friction":
                has &= near > _STANDS_OUT * _typical(near)
            own |= has
        clear += np.where(own, 0.0, power / floor)
        amplitude += np.where(own, 0.0, 2 * np.sqrt(power) / window.sum())
        free += ~own
    clear = np.where(2 * free >= len(used), clear / np.maximum(free, 1), 0.0)
    best = int(np.argmax(clear))
    if clear[best] < _REQUIRED:
        return None
    return float(frequency[best]), float(amplitude[best] / free[best])


def _typical(power: Array) -> Array:
    """Local median."""
    return median_filter(power, min(81, power.size))


def _power(values: Array, spacing: float, frequency: Array, longest: float) -> Array:
    """Power at frequencies that all runs share."""
    count = round(_PADDING * longest / spacing)
    power = np.abs(np.fft.rfft(values, count)) ** 2
    return np.interp(frequency, np.fft.rfftfreq(count, spacing), power)


def with_tone_above(raw: Problem, fit: Fit, lowest: float) -> Fit | None:
    """A fit with a tone at frequencies that the fits' band does not hold, or None.

    Parameters
    ----------
    raw
        The fit data at the measured rate with the force as measured.
    fit
        What is found in the band; it stays as it is.
    lowest
        From where on to look [Hz].
    """
    model = fit.model
    if _TONE[0] in model.values:
        return None
    line = strongest_line(raw.runs, raw.errors(model), raw.masks, lowest)
    if line is None:
        return None
    frequency, amplitude = line
    start = model.adding(disturbance_amplitude=amplitude, disturbance_frequency=frequency)
    tone = raw.fit(replace(start, free=_TONE))
    both = replace(start, values=tone.model.values)
    covariance = np.asarray(block_diag(fit.covariance, tone.covariance))
    return replace(fit, model=both, covariance=covariance)


def with_tone_from_raw(raw: Problem, fit: Fit) -> Fit:
    """A fit whose tone, if any, is fitted anew to the force as measured.

    Of a tone at the edge of the fits' band little is left there, hardly more than what the ends of
    a record leave.
    """
    if not all(name in fit.model.free for name in _TONE):
        return fit
    tone = raw.fit(replace(fit.model, free=_TONE))
    places = [fit.model.free.index(name) for name in _TONE]
    covariance = fit.covariance.copy()
    covariance[places, :] = covariance[:, places] = 0.0
    covariance[np.ix_(places, places)] = tone.covariance
    model = replace(fit.model, values=tone.model.values)
    return replace(fit, model=model, covariance=covariance)
