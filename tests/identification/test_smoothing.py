"""The smoother: bias, noise gain, ends, fusion, odd sampling."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from inerter.records import Record
from inerter.records.motion import (
    force_noise,
    lowpass,
    response,
    smooth,
    uniform,
    white_noise,
)

H, N = 1e-3, 8000
TIME = H * np.arange(N)


def record(x: np.ndarray, time: np.ndarray = TIME, velocity: np.ndarray | None = None) -> Record:
    return Record(name="r", time=time, displacement=x, force=np.zeros(time.size), velocity=velocity)


@pytest.mark.parametrize("frequency", [0.5, 3.0, 7.0])
def test_bias_is_the_stated_response(frequency: float) -> None:
    """A sine keeps its phase and loses the amplitude that `response` says, in every derivative."""
    omega, cutoff = 2 * np.pi * frequency, 12.0
    motion = smooth(record(np.sin(omega * TIME)), cutoff)
    kept = float(response(np.array([frequency]), cutoff)[0])
    inner = slice(1500, 6500)
    for found, true in (
        (motion.displacement, np.sin(omega * TIME)),
        (motion.velocity, omega * np.cos(omega * TIME)),
        (motion.acceleration, -(omega**2) * np.sin(omega * TIME)),
    ):
        error = found[inner] - kept * true[inner]
        assert np.max(np.abs(error)) < 2e-4 * np.max(np.abs(true))


def test_noise_gain_is_the_integral_of_the_response() -> None:
    """White noise of 1 um: var(a) = sum over frequencies of (2 pi f)^4 |H|^2 S."""
    cutoff, sigma = 20.0, 1e-6
    random = np.random.default_rng(1)
    frequency = np.linspace(0, 500, 20001)
    density = sigma**2 / 500 * response(frequency, cutoff) ** 2
    found = [[], []]
    for _ in range(20):
        motion = smooth(record(random.normal(0, sigma, N)), cutoff)
        found[0].append(np.var(motion.velocity[500:-500]))
        found[1].append(np.var(motion.acceleration[500:-500]))
    for power, values in zip((2, 4), found, strict=True):
        expected = np.trapezoid(density * (2 * np.pi * frequency) ** power, frequency)
        assert np.mean(values) == pytest.approx(expected, rel=0.05)


def test_linear_laws_are_unbiased_however_low_the_cutoff() -> None:
    """The smoothed motion gives the low-passed b a: an inertance fit has no bias."""
    phase = np.random.default_rng(2).uniform(0, 2 * np.pi, 12)
    frequency = np.arange(1, 13) * 0.6
    omega = 2 * np.pi * frequency[:, None]
    x = np.sum(1e-3 * np.sin(omega * TIME + phase[:, None]), axis=0)
    a = np.sum(-(omega**2) * 1e-3 * np.sin(omega * TIME + phase[:, None]), axis=0)
    for cutoff in (3.0, 10.0, 40.0):
        motion = smooth(record(x), cutoff)
        force = lowpass(100 * a, H, cutoff)
        m = motion.inner & (np.abs(TIME - TIME.mean()) < 2.5)
        slope = np.sum(force[m] * motion.acceleration[m]) / np.sum(motion.acceleration[m] ** 2)
        assert slope == pytest.approx(100, rel=1e-4)


def test_ends_at_rest_are_kept_and_others_left_out() -> None:
    s = np.clip((TIME - 1) / 2, 0, 1)
    stroke = 0.05 * (10 * s**3 - 15 * s**4 + 6 * s**5)
    assert smooth(record(stroke), 20.0).inner.all()
    moving = smooth(record(np.sin(TIME)), 20.0)
    assert not moving.inner[0]
    assert not moving.inner[-1]
    assert moving.inner.mean() > 0.9


@pytest.mark.parametrize("size", [7919, 7920, 7921, 8017])
def test_any_length_is_smoothed_up_to_its_end(size: int) -> None:
    """A stroke that ends at rest elsewhere; primes and fast lengths; all channels measured."""
    time = np.linspace(0, 8, size)
    s = np.clip((time - 1) / 6, 0, 1)
    x = 0.05 * (10 * s**3 - 15 * s**4 + 6 * s**5)
    v = 0.05 * (30 * s**2 - 60 * s**3 + 30 * s**4) / 6
    a = 0.05 * (60 * s - 180 * s**2 + 120 * s**3) / 36
    for channels in ({}, {"velocity": v}, {"velocity": v, "acceleration": a}):
        measured = replace(record(x, time), **channels)
        found = smooth(measured, 20.0, ("velocity", "acceleration"))
        assert found.inner.all()
        np.testing.assert_allclose(found.displacement, x, atol=1e-7)
        np.testing.assert_allclose(found.velocity, v, atol=1e-6)
        np.testing.assert_allclose(found.acceleration, a, atol=1e-4)


def test_measured_velocity_lowers_the_noise() -> None:
    random = np.random.default_rng(4)
    x, v = np.sin(3 * TIME), 3 * np.cos(3 * TIME)
    noisy = x + random.normal(0, 1e-4, N)
    alone = smooth(record(noisy), 20.0)
    fused = smooth(record(noisy, velocity=v + random.normal(0, 1e-4, N)), 20.0)
    inner = slice(500, -500)
    truth = -9 * np.sin(3 * TIME)[inner]
    errors = [np.std(m.acceleration[inner] - truth) for m in (alone, fused)]
    assert errors[1] < 0.3 * errors[0]


def test_odd_sampling_is_brought_onto_one_clock() -> None:
    random = np.random.default_rng(6)
    time = np.cumsum(np.r_[0, random.uniform(0.5e-3, 1.5e-3, N)])
    r = record(np.sin(5 * time), time)
    spacing, channels = uniform(r)
    grid = time[0] + spacing * np.arange(channels["displacement"].size)
    assert np.max(np.abs(channels["displacement"] - np.sin(5 * grid))) < 1e-6
    motion = smooth(r, 10.0)
    m = motion.inner
    assert np.max(np.abs(motion.acceleration[m] + 25 * np.sin(5 * motion.time[m]))) < 0.02


def test_drift_and_offset_pass_unchanged() -> None:
    motion = smooth(record(3.0 + 0.2 * TIME), 5.0)
    np.testing.assert_allclose(motion.displacement, 3.0 + 0.2 * TIME, atol=1e-12)
    np.testing.assert_allclose(motion.velocity, 0.2, atol=1e-10)
    np.testing.assert_allclose(motion.acceleration, 0, atol=1e-8)


def test_noise_is_seen_beneath_a_force_that_jumps() -> None:
    """0.2 N of white noise on a square wave, at two rates."""
    random = np.random.default_rng(7)
    for rate in (250, 2000):
        t = np.arange(0, 30, 1 / rate)
        force = 10 * np.sign(np.sin(2 * np.pi * 0.4 * t)) + 50 * np.sin(7 * t)
        found = white_noise(force + random.normal(0, 0.2, t.size))
        assert found == pytest.approx(0.2, rel=0.15)


def test_the_noise_of_a_force_that_jumps_in_every_segment() -> None:
    random = np.random.default_rng(7)
    t = np.arange(0, 30, 1 / 250)
    force = 40 * np.sign(np.sin(2 * np.pi * 4.0 * t)) + 50 * np.sin(7 * t)
    noisy = force + random.normal(0, 0.5, t.size)
    assert white_noise(noisy) > 2.0
    assert force_noise(noisy) == pytest.approx(0.5, rel=0.4)
    calm = random.normal(0, 0.5, t.size)
    assert force_noise(calm) == white_noise(calm)


@pytest.mark.parametrize("rate", [100, 1000])
@pytest.mark.parametrize("share", [0.36, 0.43])
def test_noise_is_told_beside_a_tone(rate: int, share: float) -> None:
    """Hum or a drive that rings stands out of white noise and is none of it."""
    random = np.random.default_rng(7)
    t = np.arange(0, 30, 1 / rate)
    tone = 2.0 * np.sin(2 * np.pi * share * rate * t)
    found = white_noise(tone + random.normal(0, 0.2, t.size))
    # with the tone it would be ten to thirty times that
    assert found == pytest.approx(0.2, rel=0.35)


@pytest.mark.parametrize("segments", [1, 2, 4, 8])
def test_noise_of_a_short_record_is_no_larger(segments: int) -> None:
    """A low quantile of few segments is that of few."""
    random = np.random.default_rng(7)
    found = [white_noise(random.normal(0, 1, 64 * segments)) for _ in range(200)]
    assert np.mean(found) == pytest.approx(1.0, abs=0.2)
