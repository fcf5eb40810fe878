"""Channel delay: recovered to a fraction of a sample, with an error that means what it says."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from inerter.core import Device
from inerter.records import Record, RecordError
from inerter.records.delay import Delay, delay_between, force_delay, pooled
from inerter.records.motion import smooth

H, N = 1e-3, 8000
TIME = H * np.arange(N, dtype=float)


def motion(random: np.random.Generator) -> Callable[[int, np.ndarray], np.ndarray]:
    """Derivative k of 24 sines up to 8 Hz at times [s]."""
    frequency = np.arange(1, 25) / 3.0
    turn, phase = 2 * np.pi * frequency[:, None], random.uniform(0, 2 * np.pi, (24, 1))
    size = 3e-3 / np.sqrt(frequency)[:, None]

    def derivative(k: int, time: np.ndarray) -> np.ndarray:
        return np.sum(np.real(size * (1j * turn) ** k * np.exp(1j * (turn * time + phase))), axis=0)

    return derivative


def bench(seed: int, friction: str = "none", noise: float = 3.0) -> tuple[Record, float]:
    """A device with everything linear, and friction of 20 N; the force late by up to 5 ms."""
    random = np.random.default_rng(seed)
    g, tau = motion(random), float(random.uniform(-5e-3, 5e-3))
    force = 60 * g(2, TIME - tau) + 200 * g(1, TIME - tau) + 3000 * g(0, TIME - tau)
    if friction == "coulomb":
        force += 20 * np.sign(g(1, TIME - tau))
    if friction == "lugre":
        fine = np.arange(-0.1, 8.1, 1e-4)
        device = Device(
            friction="lugre", coulomb_force=20.0, static_force=25.0, stribeck_velocity=0.01,
            bristle_stiffness=1e5, bristle_damping=50.0,
        )  # fmt: skip
        states = device.along(1e-4, g(0, fine), g(1, fine), g(2, fine))
        force += np.interp(TIME - tau, fine, states["friction"])
    measured = g(0, TIME) + random.normal(0, 1e-6, N)
    force = force + random.normal(0, noise, N)
    return Record(name="r", time=TIME, displacement=measured, force=force), tau


@pytest.mark.long
def test_two_channels_of_one_shape() -> None:
    """100 draws: 95 % intervals hold the truth, and the error is the least there can be."""
    time = TIME[:4000]
    scores, ratios = [], []
    for seed in range(100):
        random = np.random.default_rng(seed)
        g, tau = motion(random), random.uniform(-5e-3, 5e-3)
        late = 60 * g(2, time - tau) + random.normal(0, 5.0, time.size)
        found = delay_between([g(2, time)], late, H, largest=0.01)
        scores.append((found.value - tau) / found.stderr)
        # Cramer-Rao: noise over the root of the sum of squared slopes
        ratios.append(found.stderr / (5.0 / np.sqrt(np.sum((60 * g(3, time)) ** 2))))
    assert 0.88 <= np.mean(np.abs(scores) < 1.96) <= 1.0
    assert abs(np.mean(scores)) < 0.35
    assert 1.0 < np.mean(ratios) < 1.4


def test_without_noise_it_is_exact() -> None:
    for seed in range(3):
        g = motion(np.random.default_rng(seed))
        for tau in (0.0, 0.123e-3, -4.56e-3):
            found = delay_between([g(2, TIME)], g(2, TIME - tau), H)
            assert found.value == pytest.approx(tau, abs=1e-3 * H)


def test_samples_may_lie_further_apart_than_any_delay() -> None:
    g, time, tau = motion(np.random.default_rng(0)), np.arange(2000) / 18.0, 0.02
    # tones up to 1.6 Hz
    found = delay_between([g(2, 0.2 * time)], g(2, 0.2 * (time - tau)), 1 / 18.0)
    assert found.value == pytest.approx(tau, abs=1e-3 / 18.0)


@pytest.mark.parametrize("friction", ["none", "coulomb"])
def test_force_behind_motion(friction: str) -> None:
    """25 devices with inertance, damping, spring and friction, all of them unknown."""
    scores = []
    for seed in range(25):
        record, tau = bench(seed, friction)
        found = force_delay(smooth(record, 30.0), largest=0.01)
        assert found.stderr < 0.05 * H
        scores.append((found.value - tau) / found.stderr)
    assert np.mean(np.abs(scores) < 1.96) > 0.8
    assert np.std(scores) < 1.4


def test_memory_of_friction_is_hardly_taken_for_a_delay() -> None:
    errors = []
    for seed in range(5):
        record, tau = bench(seed, "lugre")
        errors.append(force_delay(smooth(record, 30.0)).value - tau)
    assert np.max(np.abs(errors)) < 0.05 * H


def test_one_tone_tells_no_delay_from_damping() -> None:
    random = np.random.default_rng(0)
    turn = 2 * np.pi * 2
    record = Record(
        name="r",
        time=TIME,
        displacement=0.01 * np.sin(turn * TIME) + random.normal(0, 1e-6, N),
        force=-60 * turn**2 * 0.01 * np.sin(turn * (TIME - 2e-3)) + random.normal(0, 3, N),
    )
    found = force_delay(smooth(record, 20.0))
    assert not found.significant
    assert found.stderr > 0.3 * H


def test_a_soft_shaft_is_no_significant_delay() -> None:
    """An unmodelled resonance: parts of the band disagree, and the error says so."""
    g = motion(np.random.default_rng(3))
    frequency = np.fft.rfftfreq(N, H)
    # second-order lag at 12 Hz, weakly damped: late by more the higher the frequency
    u = frequency / 12.0
    force = np.fft.irfft(np.fft.rfft(60 * g(2, TIME)) / (1 - u**2 + 0.04j * u), N)
    found = delay_between([g(2, TIME)], force, H)
    rigid = delay_between([g(2, TIME)], 60 * g(2, TIME - found.value), H)
    assert found.stderr > 100 * rigid.stderr


@pytest.mark.parametrize(
    ("columns", "target", "said"),
    [
        ([np.sin(TIME[:100])], np.sin(TIME[:100]), "100 samples are too few"),
        ([np.ones(500)], np.sin(TIME[:500]), "does not change"),
        ([np.sin(TIME[:500])], np.ones(500), "does not change"),
    ],
)
def test_refusals(columns: list[np.ndarray], target: np.ndarray, said: str) -> None:
    with pytest.raises(RecordError, match=said):
        delay_between(columns, target, H)


def test_a_delay_beyond_the_range_is_refused() -> None:
    g = motion(np.random.default_rng(0))
    with pytest.raises(RecordError, match=r"no delay within 0\.05 s"):
        delay_between([g(2, TIME)], g(2, TIME - 0.058), H)


def test_pooled() -> None:
    """By hand: weights 1 and 1/4; and runs that disagree make the error larger."""
    both = pooled([Delay(1.0, 1.0), Delay(2.0, 2.0)])
    assert both.value == pytest.approx(1.2)
    assert both.stderr == pytest.approx(np.sqrt(0.8))
    assert pooled([Delay(0.0, 1.0), Delay(10.0, 1.0)]).stderr == pytest.approx(5.0)
