"""The linear denoisers: other implementations, exactness, noise gain, choice of strength."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.records.denoise import METHODS, denoise, noise_level
from inerter.records.denoise.filters import (
    lowpass_gain,
    lowpassed,
    savgol,
    savgol_gain,
    spline,
)
from scipy.signal import butter, filtfilt

H, N = 1e-3, 6000
TIME = H * np.arange(N, dtype=float)
INNER = slice(800, -800)
SIGNAL = 50 * np.sin(2 * np.pi * 1.3 * TIME) + 20 * np.sin(2 * np.pi * 5.1 * TIME + 1)
LINEAR = ("savgol", "lowpass", "spline")


def draw(seed: int, noise: float = 1.0) -> np.ndarray:
    return np.random.default_rng(seed).normal(0, noise, N)


def test_lowpass_is_a_third_order_butterworth_run_both_ways() -> None:
    """Against SciPy's filtfilt, far below the Nyquist frequency, where its warping is small."""
    measured = SIGNAL + draw(0, 5.0)
    b, a = butter(3, 12.0, fs=1 / H)  # type: ignore[misc]
    other = filtfilt(b, a, measured)
    found, cutoff = lowpassed(measured, H, 5.0, cutoff=12.0)
    assert cutoff == 12.0
    assert np.max(np.abs(found - other)[INNER]) < 2e-3 * np.max(np.abs(SIGNAL))


def test_savgol_is_exact_on_cubics_to_the_very_ends() -> None:
    cubic = 2 - TIME + 0.5 * TIME**2 + 0.1 * TIME**3
    found, window = savgol(cubic, 0.0, window=401)
    assert window == 401
    np.testing.assert_allclose(found, cubic, atol=1e-10)


def test_spline_is_exact_on_lines() -> None:
    np.testing.assert_allclose(spline(3 - 0.4 * TIME), 3 - 0.4 * TIME, atol=1e-8)


@pytest.mark.parametrize("method", ["savgol", "lowpass"])
def test_noise_gain_is_the_one_stated(method: str) -> None:
    """White noise through the very filter that was chosen for the signal."""
    chosen = denoise(SIGNAL + draw(1), H, method)
    (strength,) = chosen.strength.values()
    left = []
    for seed in range(20):
        if method == "savgol":
            values, _ = savgol(draw(seed), 1.0, window=int(strength))
        else:
            values, _ = lowpassed(draw(seed), H, 1.0, cutoff=strength)
        left.append(np.mean(values[INNER] ** 2))
    assert chosen.noise_gain is not None
    assert np.sqrt(np.mean(left)) == pytest.approx(chosen.noise_gain, rel=0.05)


def test_noise_gain_in_closed_form() -> None:
    """Savgol: the middle coefficient; low-pass: the integral of 1 / (1 + u^6)^2, 5 pi / 18."""
    window, cutoff = 101, 20.0
    middle = 3 * (3 * window**2 - 7) / (4 * window * (window**2 - 4))
    assert savgol_gain(window) ** 2 == pytest.approx(middle, rel=1e-9)
    assert lowpass_gain(H, cutoff) ** 2 == pytest.approx(5 * np.pi / 18 * cutoff * 2 * H, rel=1e-3)


@pytest.mark.parametrize("method", ["savgol", "lowpass"])
def test_the_strength_chosen_is_nearly_the_best_there_is(method: str) -> None:
    """Mean square error of the choice against that of the best of many, with the truth known."""
    regret = []
    for seed in range(10):
        measured = SIGNAL + draw(seed, 3.0)
        found = denoise(measured, H, method).values
        if method == "savgol":
            tried = [savgol(measured, 0.0, w)[0] for w in range(5, 400, 6)]
        else:
            tried = [lowpassed(measured, H, 0.0, f)[0] for f in np.geomspace(3, 300, 60)]
        best = min(np.mean((t - SIGNAL)[INNER] ** 2) for t in tried)
        regret.append(np.mean((found - SIGNAL)[INNER] ** 2) / best)
    assert np.mean(regret) < 1.25


@pytest.mark.rarely("spline")
@pytest.mark.parametrize("method", LINEAR)
def test_noise_goes_and_the_signal_stays(method: str) -> None:
    found = denoise(SIGNAL + draw(2, 3.0), H, method)
    assert np.std((found.values - SIGNAL)[INNER]) < 0.25 * 3.0
    assert found.noise == pytest.approx(3.0, rel=0.15)


@pytest.mark.parametrize("method", METHODS)
def test_the_unit_of_the_channel_does_not_matter(method: str) -> None:
    measured = (SIGNAL + draw(3, 2.0))[:1500]
    one = denoise(measured, H, method)
    for factor in (1e-6, 1e6):
        other = denoise(factor * measured, H, method)
        np.testing.assert_allclose(
            other.values, factor * one.values, rtol=0, atol=1e-6 * factor * 50
        )
    again = denoise(measured, H, method)
    np.testing.assert_array_equal(again.values, one.values)


@pytest.mark.parametrize("method", METHODS)
def test_a_constant_channel_stays(method: str) -> None:
    np.testing.assert_allclose(denoise(np.full(300, 4.2), H, method).values, 4.2, rtol=1e-12)


def test_noise_level() -> None:
    """White noise, and the rounding of a quantised channel: a step over the root of twelve."""
    assert noise_level(SIGNAL + draw(4, 0.7)) == pytest.approx(0.7, rel=0.15)
    assert noise_level(0.5 * np.round(SIGNAL / 0.5)) >= 0.5 / np.sqrt(12) * (1 - 1e-9)
    assert noise_level(np.zeros(300)) == 0


def test_another_method_is_refused() -> None:
    with pytest.raises(ValueError, match=r"'wavelet'.*take one of emd, savgol"):
        denoise(SIGNAL, H, "wavelet")
