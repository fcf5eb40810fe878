"""Values between samples: exact below the limit, gone above it, whatever the ratio of rates."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from inerter.records.band_limited import PASS_BAND, evaluated, resampled, shifted
from scipy.signal import resample_poly

H, N = 1e-3, 4000
TIME = H * np.arange(N, dtype=float)


def tone(frequency: float, time: np.ndarray) -> np.ndarray:
    return np.sin(2 * np.pi * frequency * time + 0.7)


@settings(max_examples=40, deadline=None)
@given(rate=st.floats(60.0, 5000.0), share=st.floats(0.02, 0.95))
def test_a_tone_below_the_limit_is_exact(rate: float, share: float) -> None:
    frequency = share * min(PASS_BAND * rate, 0.9 / H) / 2
    found = resampled(tone(frequency, TIME), H, rate)
    time = np.arange(found.size, dtype=float) / rate
    assert time[-1] <= TIME[-1] + 1e-9
    inner = (time > 1) & (time < 3)
    assert np.max(np.abs(found - tone(frequency, time))[inner]) < 1e-4


@pytest.mark.parametrize("frequency", [105.0, 180.0, 333.0])
def test_a_tone_above_the_limit_is_gone_and_not_folded(frequency: float) -> None:
    found = resampled(tone(frequency, TIME), H, 200.0)
    assert np.max(np.abs(found[200:-200])) < 1e-4


def test_against_a_polyphase_filter() -> None:
    values = tone(3.0, TIME) + 0.5 * tone(11.0, TIME)
    found, other = resampled(values, H, 400.0), resample_poly(values, 2, 5)
    assert found.size == other.size
    # its filter has a ripple of about 1e-3
    assert np.max(np.abs(found - other)[100:-100]) < 3e-3


@pytest.mark.parametrize("rate", [123.4, 1000.0, 2048.0])
def test_lines_are_exact_to_the_very_ends(rate: float) -> None:
    found = resampled(3 - 0.7 * TIME, H, rate)
    np.testing.assert_allclose(
        found, 3 - 0.7 * np.arange(found.size, dtype=float) / rate, atol=1e-10
    )


def test_the_samples_themselves_come_back() -> None:
    values = np.random.default_rng(0).standard_normal(500)
    np.testing.assert_allclose(resampled(values, H, 1 / H), values, atol=1e-10)
    np.testing.assert_allclose(resampled(values, H, 3 / H)[::3], values, atol=1e-10)


@pytest.mark.parametrize("delay", [1e-3, -7e-3, 0.37e-3, -4.21e-3])
def test_a_shift(delay: float) -> None:
    found = shifted(tone(23.0, TIME), H, delay)
    assert np.max(np.abs(found - tone(23.0, TIME - delay))[200:-200]) < 1e-6
    np.testing.assert_allclose(
        shifted(found, H, -delay)[200:-200], tone(23.0, TIME)[200:-200], atol=1e-6
    )
    np.testing.assert_array_equal(shifted(found, H, 0.0), found)


@pytest.mark.parametrize(("n", "spacing", "step"), [(2, H, H), (50, 0.0, H), (50, H, -1.0)])
def test_what_cannot_be_is_refused(n: int, spacing: float, step: float) -> None:
    with pytest.raises(ValueError, match=f"{n} values"):
        evaluated(np.zeros(n), spacing, 0.0, step, 5)
