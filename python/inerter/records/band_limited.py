"""A uniformly sampled channel between its samples: resampling and shifting, both band-limited.

The channel is the line through its ends plus a sum of sines up to its Nyquist frequency, those of
the odd continuation that `motion.filtered` works on. The sum is evaluated at any evenly spaced
times by the chirp z-transform, so that the ratio of the two rates need not be a fraction. Sines
below the limit pass exactly; within a few samples of the ends the continuation is a guess.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.fft import irfft, rfft, rfftfreq
from numpy.typing import NDArray
from scipy.signal import CZT

Array = NDArray[np.float64]

# share of the new Nyquist frequency below which resampling changes nothing
PASS_BAND = 0.8


def evaluated(values: Array, spacing: float, first: float, step: float, count: int) -> Array:
    """Values (n,) at `spacing` [s], at the `count` times first, first + step, ... [s].

    Times count from the first sample. Where `step` exceeds `spacing`, what the new rate cannot hold
    is taken out first: the response is 1 up to `PASS_BAND` of the new Nyquist frequency and falls
    to 0 there as a raised cosine.

    Raises
    ------
    ValueError
        Fewer than three values, or a step or spacing that is not positive.
    """
    n = values.size
    if n < 3 or not (spacing > 0 and step > 0 and math.isfinite(first)):
        raise ValueError(
            f"{n} values, spacing {spacing:g} s, step {step:g} s; "
            "give three values or more and positive intervals"
        )
    slope = (values[-1] - values[0]) / ((n - 1) * spacing)
    rest = values - (values[0] + slope * spacing * np.arange(n))
    wave = np.r_[rest, -rest[-2:0:-1]]
    spectrum = rfft(wave) * _keep(rfftfreq(wave.size, spacing), step if step > spacing else 0.0)

    # the sum over positive frequencies, each but zero and the highest standing for two
    turn = 2 * np.pi / (wave.size * spacing)
    spectrum *= np.exp(1j * turn * first * np.arange(spectrum.size))
    if step == spacing and count == n:
        sum_ = irfft(spectrum, wave.size)[:n]
    else:
        spectrum[1:-1] *= 2
        transform = CZT(spectrum.size, m=count, w=np.exp(1j * turn * step))
        sum_ = np.real(transform(spectrum)) / wave.size
    return values[0] + slope * (first + step * np.arange(count)) + sum_


def _keep(frequency: NDArray[np.floating], step: float) -> Array:
    """Response of the anti-aliasing low-pass at frequencies [Hz]; step 0: none is needed."""
    if step == 0:
        return np.ones(frequency.size)
    over = (frequency * 2 * step - PASS_BAND) / (1 - PASS_BAND)
    return 0.5 * (1 + np.cos(np.pi * np.clip(over, 0, 1)))


def resampled(values: Array, spacing: float, rate: float) -> Array:
    """A channel at another rate [Hz], from its first sample on, as far as the last one reaches."""
    duration = (values.size - 1) * spacing
    count = int(duration * rate * (1 + 1e-12) + 1e-9) + 1
    return evaluated(values, spacing, 0.0, 1 / rate, count)


def shifted(values: Array, spacing: float, delay: float) -> Array:
    """A channel `delay` seconds later (earlier where negative), shape (n,) to (n,).

    What the record does not hold, the first (last) `abs(delay)` seconds, is continued as an odd
    function about the end point.
    """
    return evaluated(values, spacing, -delay, spacing, values.size) if delay else values.copy()
