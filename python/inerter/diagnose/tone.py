"""A tone that the motion does not contain: where to look for it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

from inerter.identify.bench import Run

Array = NDArray[np.float64]

LOWEST = 0.2
"""Lowest frequency [Hz] that counts as a tone, and not as a drift."""
# power of a bin per local median, mean over the runs: chance exceeds it once in e^15 bins and runs
_REQUIRED = 15.0
# share of the motion's power in a few bins from which on the motion has the line itself
_OWN_LINE = 0.1
_NEIGHBOURS = 2
_PADDING = 2


def strongest_line(
    runs: Sequence[Run],
    residual: Sequence[Array],
    masks: Sequence[NDArray[np.bool_]],
    lowest: float = LOWEST,
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
    own = np.zeros(frequency.size, bool)
    for i in used:
        run, mask = runs[i], masks[i]
        window = np.hanning(mask.size) * mask
        power = _power(np.where(mask, residual[i], 0.0) * window, run.spacing, frequency, longest)
        floor = median_filter(power, min(81, frequency.size)) / np.log(2) + 1e-300
        clear += power / floor / len(used)
        amplitude += 2 * np.sqrt(power) / window.sum() / len(used)
        for motion in (run.velocity, np.sign(run.velocity), run.acceleration):
            line = _power(motion * window, run.spacing, frequency, longest)
            near = np.convolve(line, np.ones(2 * _NEIGHBOURS * _PADDING + 1), "same")
            own |= near > _OWN_LINE * np.sum(line)
    clear[own] = 0.0
    best = int(np.argmax(clear))
    if clear[best] < _REQUIRED:
        return None
    return float(frequency[best]), float(amplitude[best])


def _power(values: Array, spacing: float, frequency: Array, longest: float) -> Array:
    """Power at frequencies that all runs share."""
    count = round(_PADDING * longest / spacing)
    power = np.abs(np.fft.rfft(values, count)) ** 2
    return np.interp(frequency, np.fft.rfftfreq(count, spacing), power)
