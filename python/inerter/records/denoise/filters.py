"""Three linear denoisers, each with a strength chosen from the data.

The strength of low-pass and Savgol filter is the one of least expected mean square error (Stein's
unbiased estimate, SURE; for linear filters Mallows' C_p): over the frequencies f,

    risk = mean( (1 - H(f))^2 (P(f) - s^2) + H(f)^2 s^2 )

H response, P power of the measured channel, s rms of its white noise. The first term is what the
filter takes off the signal, the second what it leaves of the noise. The spline's strength is by
generalised cross-validation, which SciPy brings and which needs no s.

Sources: C. Stein, Annals of Statistics 9 (1981) 1135; A. Savitzky and M. Golay, Analytical
Chemistry 36 (1964) 1627; G. Wahba, Spline Models for Observational Data (1990), ch. 4.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.fft import rfft, rfftfreq
from numpy.typing import NDArray
from scipy.interpolate import make_smoothing_spline
from scipy.signal import detrend, savgol_coeffs, savgol_filter

from inerter.records.motion import lowpass, response

Array = NDArray[np.float64]

# ratio of neighbouring strengths that are tried
STEP = 1.1
# degree of the Savgol filter's polynomial: phase free, and exact on cubics
DEGREE = 3


def least_risk(
    values: Array, noise: float, strengths: Sequence[float], transfer: Callable[[float], Array]
) -> float:
    """The strength of least estimated mean square error.

    values: channel (n,); noise: rms of its white noise; transfer: real response (n // 2 + 1,) of a
    strength at the frequencies of `numpy.fft.rfft`.
    """
    # a taper whose side lobes fall fast: ends that do not meet must not look like signal
    taper = np.hanning(values.size) ** 2
    power = np.abs(rfft(detrend(values) * taper)) ** 2 / np.sum(taper**2)
    risks = []
    for strength in strengths:
        kept = transfer(strength)
        risks.append(np.mean((1 - kept) ** 2 * (power - noise**2) + (kept * noise) ** 2))
    return float(strengths[int(np.argmin(risks))])


def lowpassed(
    values: Array, spacing: float, noise: float, cutoff: float | None = None
) -> tuple[Array, float]:
    """Zero-phase low-pass, and its cut-off [Hz], where half of the amplitude is left.

    It is the low-pass of `motion`: the response 1 / (1 + (f / f_c)^6) of a third-order Butterworth
    filter run forward and backward.
    """
    frequency = rfftfreq(values.size, spacing)
    if cutoff is None:
        highest = 0.45 / spacing
        lowest = min(4 / (values.size * spacing), highest)
        tried = np.geomspace(lowest, highest, 1 + int(np.log(highest / lowest) / np.log(STEP)))
        cutoff = least_risk(values, noise, tried.tolist(), lambda f: response(frequency, f))
    return lowpass(values, spacing, cutoff), cutoff


def lowpass_gain(spacing: float, cutoff: float) -> float:
    """Share of the rms of white noise that the low-pass leaves."""
    frequency = np.linspace(0, 0.5 / spacing, 4097)
    return float(np.sqrt(np.trapezoid(response(frequency, cutoff) ** 2, dx=1 / 4096)))


def savgol(values: Array, noise: float, window: int | None = None) -> tuple[Array, int]:
    """Cubic Savgol filter and its window [samples]; the ends are the end windows' polynomials."""
    if window is None:
        longest = max(5, min(values.size // 4, 4001))
        count = 2 + int(np.log(longest / 5) / np.log(STEP))
        tried = {2 * int(w / 2) + 1 for w in np.geomspace(5, longest, count)}
        angle = 2 * np.pi * rfftfreq(values.size)
        chosen = least_risk(values, noise, sorted(tried), lambda w: _savgol_response(int(w), angle))
        window = int(chosen)
    return np.asarray(savgol_filter(values, window, DEGREE, mode="interp"), float), window


def _savgol_response(window: int, angle: NDArray[np.floating]) -> Array:
    """Real response of the symmetric filter at angles [rad per sample]."""
    # the transform of the kernel on a dense grid, read off at the angles
    size = 1 << int(np.ceil(np.log2(16 * window)))
    kernel = np.zeros(size)
    kernel[: window // 2 + 1] = (coefficients := savgol_coeffs(window, DEGREE))[window // 2 :]
    kernel[-(window // 2) :] = coefficients[: window // 2]
    return np.interp(angle, np.linspace(0, np.pi, size // 2 + 1), rfft(kernel).real)


def savgol_gain(window: int) -> float:
    """Share of the rms of white noise that the Savgol filter leaves away from the ends."""
    return float(np.sqrt(np.sum(savgol_coeffs(window, DEGREE) ** 2)))


def spline(values: Array) -> Array:
    """Cubic smoothing spline with the penalty of least generalised cross-validation."""
    # in units of samples and standard deviations: the search is not scale-free
    size = float(np.std(values))
    if size == 0:
        return values.copy()
    return size * make_smoothing_spline(np.arange(values.size, dtype=float), values / size)(
        np.arange(values.size, dtype=float)
    )
