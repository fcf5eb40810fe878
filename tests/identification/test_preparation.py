"""Choice of the cut-off: every one is judged on the same samples."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from inerter.diagnose.cannot_tell import hidden_by_force
from inerter.identify.runs import BenchRun
from inerter.records import Record
from inerter.records.motion import (
    Motion,
    apply_weight,
    has_one_line,
    motion_noise,
    response,
    smooth,
    weight_above,
)
from inerter.records.preparation import prepare, prepare_again, weighed

RATE = 500.0


def moving(seconds: float, noise: float = 1e-6, seed: int = 0) -> Record:
    random = np.random.default_rng(seed)
    time = np.arange(0, seconds, 1 / RATE)
    x = 5e-3 * np.cos(2 * np.pi * 1.5 * time) + 1e-3 * np.cos(2 * np.pi * 4.1 * time)
    a = np.gradient(np.gradient(x, time), time)
    force = 40 * a + 0.1 * random.standard_normal(time.size)
    noisy = x + noise * random.standard_normal(time.size)
    return Record(name=f"run{seed}", time=time, displacement=noisy, force=force)


def test_every_cutoff_is_judged_on_the_same_samples() -> None:
    records = [moving(6.0, seed=0), moving(4.0, seed=1)]
    seen: list[list[np.ndarray]] = []

    def error(motions: Sequence[Motion], masks: Sequence[np.ndarray]) -> float:
        assert all(m.inner[mask].all() for m, mask in zip(motions, masks, strict=True))
        seen.append(list(masks))
        return 1.0

    preparation = prepare(records)
    prepare_again(records, preparation, error)
    assert len(seen) > 5
    for masks in seen[1:]:
        for mask, first in zip(masks, seen[0], strict=True):
            np.testing.assert_array_equal(mask, first)
    # what the lowest one leaves of a record that begins in motion
    assert 0 < seen[0][0].sum() < records[0].samples


def test_more_noise_asks_for_a_lower_cutoff() -> None:
    cutoffs = [prepare([moving(10.0, noise)]).cutoff for noise in (1e-7, 1e-6, 1e-5, 1e-4)]
    assert cutoffs == sorted(cutoffs, reverse=True)
    assert cutoffs[0] > 2 * cutoffs[-1]


def test_a_cutoff_that_leaves_too_little_is_not_chosen() -> None:
    """Of half a second a low cut-off leaves nothing, and is no candidate for leaving that out."""
    preparation = prepare([moving(0.8)])
    assert np.isinf(preparation.errors[0])
    assert np.isfinite(preparation.errors[-1])
    assert all(motion.inner.sum() > 50 for motion in preparation.motions)


def test_a_record_too_short_for_any_cutoff_is_refused() -> None:
    with pytest.raises(ValueError, match="too few to tell motion from noise"):
        prepare([moving(0.05)])


@pytest.mark.parametrize("frequency", [1.0, 5.0, 40.0])
def test_a_weight_falls_with_the_square_above_its_corner(frequency: float) -> None:
    time = np.arange(0, 20, 1 / RATE)
    wave = np.sin(2 * np.pi * frequency * time)
    inner = slice(2000, 8000)
    left = apply_weight(wave, weight_above(wave.size, 1 / RATE, 5.0))
    share = left[inner] @ wave[inner] / (wave[inner] @ wave[inner])
    assert share == pytest.approx((1 + (frequency / 5.0) ** 4) ** -0.5, rel=0.02)


@pytest.mark.parametrize("frequency", [1.0, 8.0, 10.0, 11.0, 40.0])
def test_a_weight_heeds_what_a_shaft_makes_of_the_noise(frequency: float) -> None:
    """Near its resonance more, above no less than without it."""
    corner, resonance, damping = 5.0, 10.0, 0.05
    inertance, angular, s = 100.0, 2 * np.pi * resonance, 2j * np.pi * frequency
    stiffness, damper = inertance * angular**2, 2 * damping * inertance * angular
    series = (stiffness + damper * s) / (inertance * s**2 + damper * s + stiffness)
    expected = 1 + (frequency / corner) ** 4 * max(abs(series) ** 2, 1.0)
    found = motion_noise(np.array([frequency]), corner, (resonance, damping))
    assert found == pytest.approx([expected], rel=1e-9)


def test_no_shaft_wins_by_its_weights() -> None:
    """Along noise of the spectrum that is expected, a model's own shaft has the least error."""
    size, spacing, shaft = 2**15, 2e-3, (10.0, 0.05)
    frequency = np.fft.rfftfreq(size, spacing)
    spectrum = np.sqrt(motion_noise(frequency, 5.0, shaft)) * response(frequency, 25.0)
    white = np.random.default_rng(0).standard_normal(size)
    noise = np.fft.irfft(np.fft.rfft(white) * spectrum, size)
    silent = np.zeros(size)
    run = BenchRun(
        name="run",
        start=0.0,
        spacing=spacing,
        displacement=silent,
        velocity=silent,
        acceleration=silent,
        force=silent,
        inner=silent == 0,
        first_force=0.0,
        cutoff=25.0,
        corner=5.0,
        shaft=(12.0, 0.1),
    )
    others = [shaft, (9.5, 0.05), (10.5, 0.05), (10.0, 0.03), (10.0, 0.1), (12.0, 0.1)]
    errors = [np.std(run.weighted(noise, run.inner, other)) for other in others]
    assert np.argmin(errors) == 0


def test_the_corner_is_where_the_noises_are_equal() -> None:
    record = moving(10.0, noise=4e-6)
    preparation = weighed([record], prepare([record]))
    # 0.1 N = 40 kg (2 pi f)^2 4e-6 m
    assert preparation.corner == pytest.approx(np.sqrt(0.1 / (40 * 4e-6)) / (2 * np.pi), rel=0.1)
    fused = replace(preparation, channels=("velocity",))
    assert weighed([record], fused) is fused


def test_a_run_at_rest_chooses_no_cutoff() -> None:
    """It tells the noise; its own "dominant frequency" is that of noise."""
    records = [moving(4.0, seed=0), moving(4.0, seed=1)]
    random, time = np.random.default_rng(9), np.arange(0, 3, 1 / RATE)
    rest = Record(
        name="rest",
        time=time,
        displacement=1e-6 * random.standard_normal(time.size),
        force=0.1 * random.standard_normal(time.size),
    )
    without, beside = prepare(records), prepare([*records, rest])
    assert beside.cutoffs[0] == pytest.approx(without.cutoffs[0])
    assert beside.cutoff == pytest.approx(without.cutoff, rel=0.5)


def along(sines: Sequence[float], noise: float, draw: np.random.Generator) -> Record:
    """62 kg along sines of equal speeds, the displacement in steps of 60 um."""
    time = np.arange(0, 9.7, 1e-3)
    waves = [(2 * np.pi * f, draw.uniform(0, 6)) for f in sines]
    x = sum(0.15 / w * np.sin(w * time + p) for w, p in waves)
    a = sum(-0.15 * w * np.sin(w * time + p) for w, p in waves)
    steps = np.round((x + noise * draw.standard_normal(time.size)) / 6e-5) * 6e-5
    force = 62 * a + 0.3 * draw.standard_normal(time.size)
    return Record(name=f"{sines}", time=time, displacement=steps, force=force)


@pytest.mark.parametrize(
    ("runs", "one"),
    [([[0.6]], True), ([[0.6], [0.6]], True), ([[0.6, 1.4]], False), ([[0.6], [1.1]], False)],
)
def test_one_line_is_told_whatever_the_noise(
    runs: list[list[float]], one: bool, effects_seed: int
) -> None:
    draw = np.random.default_rng(effects_seed)
    records = [along(sines, 4e-5, draw) for sines in runs]
    for cutoff in (5.0, 60.0):
        motions = [smooth(record, cutoff, ()) for record in records]
        assert has_one_line(motions, [motion.velocity_noise for motion in motions]) == one


def test_along_one_sine_the_acceleration_chooses_the_cutoff(effects_seed: int) -> None:
    """The displacement would foretell the force at any cut-off, and has no noise to speak of."""
    record = along([0.6], 4e-5, np.random.default_rng(effects_seed))
    (motion,) = prepare([record]).motions
    acceleration, force = motion.acceleration[motion.inner], motion.force[motion.inner]
    assert np.std(force - 62 * acceleration) < 1.0


def test_a_motion_that_fills_what_the_rate_leaves() -> None:
    """An oscillator driven up to a third of the sample rate: the cut-off goes on up to there."""
    rate = 600.0
    time = np.arange(0, 8, 1 / rate)
    random = np.random.default_rng(3)
    frequencies = np.linspace(3.0, 0.33 * rate, 60)
    ratio = frequencies / 60.0
    sizes = 2e-4 / np.abs(1 - ratio**2 + 0.06j * ratio)
    angles = 2 * np.pi * frequencies[:, None] * time + random.uniform(0, 6, 60)[:, None]
    x, v, a = (
        (size @ wave(angles))
        for size, wave in (
            (sizes, np.sin),
            (2 * np.pi * frequencies * sizes, np.cos),
            (-((2 * np.pi * frequencies) ** 2) * sizes, np.sin),
        )
    )
    force = 2.0 * a + 40.0 * v + 1e5 * x + random.normal(0, 1.0, time.size)
    fast = Record(
        name="fast", time=time, displacement=x + random.normal(0, 1e-7, time.size), force=force
    )
    found = prepare([fast])
    assert found.cutoff > 0.3 * rate
    assert found.cutoffs.size == found.errors.size
    inner = found.motions[0].inner
    missed = found.motions[0].acceleration[inner] - a[inner]
    assert np.std(missed) < 0.1 * np.std(a)
    # a slow one is tried up to a fifth of the rate alone
    noise, whine = random.normal(0, 1.0, (2, time.size))
    calm = Record(
        name="calm", time=time, displacement=0.01 * np.sin(5.0 * time) + 2e-6 * noise,
        force=-12.5 * np.sin(5.0 * time) + whine,
    )  # fmt: skip
    assert prepare([calm]).cutoffs[-1] <= 0.2 * rate * 1.001


def test_a_force_that_is_switched_is_no_channel_that_clips() -> None:
    """A cart that is pushed to and fro by the same force each way."""
    time = np.arange(0, 10, 1 / 200)
    force = 13.0 * np.sign(np.sin(2 * np.pi * 1.3 * time + 0.1))
    velocity = np.cumsum(force) / 200 / 6.0
    x = np.cumsum(velocity - velocity.mean()) / 200
    pushed = Record(name="cart", time=time, displacement=x, force=force)
    assert np.isfinite(prepare([pushed]).errors).all()
    assert hidden_by_force([pushed]) == {"sensor_saturation"}
    noisy = replace(pushed, force=force + np.random.default_rng(1).normal(0, 0.1, time.size))
    assert hidden_by_force([noisy]) == set()
