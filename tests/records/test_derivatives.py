"""Derivatives from displacement: the noise that is stated, and polynomials."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.records import Record
from inerter.records.motion import smooth, uniform_channels
from inerter.records.prepare.options import Options
from inerter.records.prepare.pipeline import prepare_records

H, N = 1e-3, 8000
TIME = H * np.arange(N, dtype=float)
NOISE = 1e-6


def record(displacement: np.ndarray) -> Record:
    return Record(name="r", time=TIME, displacement=displacement, force=np.sin(5 * TIME))


@pytest.mark.parametrize("cutoff", [8.0, 40.0])
def test_the_noise_stated_is_the_noise_observed(cutoff: float) -> None:
    """White noise of 1 um on a motion; and in closed form: int (2 pi f)^2k / (1 + (f/fc)^6)^2."""
    clean = 0.01 * np.sin(2 * np.pi * TIME)
    true = smooth(record(clean), cutoff)
    inner = slice(1000, -1000)
    found = {"velocity": [], "acceleration": []}
    stated = {"velocity": [], "acceleration": []}
    for seed in range(15):
        noisy = clean + np.random.default_rng(seed).normal(0, NOISE, N)
        motion = smooth(record(noisy), cutoff)
        for name in found:
            found[name].append(np.std((getattr(motion, name) - getattr(true, name))[inner]))
            stated[name].append(getattr(motion, f"{name}_noise"))
    frequency = np.linspace(0, 0.5 / H, 200001)
    density = 2 * H * NOISE**2 / (1 + (frequency / cutoff) ** 6) ** 2
    for name, order in (("velocity", 2), ("acceleration", 4)):
        closed = np.sqrt(np.trapezoid(density * (2 * np.pi * frequency) ** order, frequency))
        assert np.mean(found[name]) == pytest.approx(closed, rel=0.1)
        assert np.mean(stated[name]) == pytest.approx(closed, rel=0.1)


def test_a_cubic_is_exact_away_from_the_ends() -> None:
    motion = smooth(record(0.1 + 0.2 * TIME - 0.03 * TIME**2 + 0.004 * TIME**3), 10.0)
    t, inner = motion.time, slice(1500, -1500)
    velocity, acceleration = 0.2 - 0.06 * t + 0.012 * t**2, -0.06 + 0.024 * t
    assert np.max(np.abs(motion.velocity - velocity)[inner]) < 1e-6
    assert np.max(np.abs(motion.acceleration - acceleration)[inner]) < 1e-5


def test_what_would_be_a_guess_is_cut_off() -> None:
    """Beyond the cut the error is that of the response, at the ends it is not."""
    turn = 2 * np.pi * 1.3
    x = 0.01 * np.sin(turn * TIME + 0.4)
    (done,) = prepare_records([record(x)], Options(derivatives=True, cutoff=15.0))
    after = done.record
    assert isinstance(after, Record)
    assert after.acceleration is not None
    true = -(turn**2) * 0.01 * np.sin(turn * after.time + 0.4)
    assert np.max(np.abs(after.acceleration - true)) < 0.01 * np.max(np.abs(true))
    whole = smooth(record(x), 15.0)
    error = whole.acceleration + turn**2 * x
    assert np.max(np.abs(error)) > 0.1 * np.max(np.abs(true))


def test_an_even_clock_keeps_every_bit() -> None:
    values = np.random.default_rng(0).standard_normal(N)
    spacing, channels = uniform_channels(5.0 + TIME, {"a": values})
    assert spacing == pytest.approx(H)
    assert channels["a"] is values
