"""Denoising by modes: the decomposition, the law of the noise, what the rule keeps."""

from __future__ import annotations

import sys

import numpy as np
import pytest
from inerter.records import RecordError
from inerter.records.denoise.modes import decompose, noise_energy, selected

N = 2000
INNER = slice(300, -300)
STEP = np.arange(N)


def noise(seed: int, size: int = N) -> np.ndarray:
    return np.random.default_rng(seed).standard_normal(size)


def test_modes_and_residue_sum_to_the_channel() -> None:
    values = 1e3 + 40 * np.sin(0.02 * STEP) + noise(0)
    modes, residue = decompose(values)
    np.testing.assert_allclose(modes.sum(axis=0) + residue, values, rtol=1e-13)
    assert len(modes) > 4


def test_two_tones_are_two_modes() -> None:
    """Away from the ends, where envelopes have nothing to lean on."""
    step = np.arange(12000)
    inner = slice(3000, -3000)
    fast, slow = np.sin(2 * np.pi * step / 23), 3 * np.sin(2 * np.pi * step / 230 + 1)
    modes, _ = decompose(fast + slow)
    assert np.std((modes[0] - fast)[inner]) < 0.02 * np.std(fast)
    assert np.std((modes[1] - slow)[inner]) < 0.02 * np.std(slow)
    assert selected(fast + slow, 0.01).period[:2] == pytest.approx([23, 230], rel=0.03)


@pytest.mark.parametrize("size", [500, 2000, 8000])
def test_the_law_of_the_noise(size: int) -> None:
    """Mean energies over many draws; the modes whose scatter is small enough to tell."""
    draws = 40 if size < 8000 else 15
    energies = []
    for seed in range(draws):
        modes, _ = decompose(noise(seed, size))
        energies.append(np.mean(modes[:5] ** 2, axis=1))
    found, law = np.mean(energies, axis=0), noise_energy(5, 1.0)
    # the mean of chi-squared with size * law degrees of freedom, three standard errors
    error = 3 * np.sqrt(2 / (size * law) / draws)
    assert np.all(np.abs(found / law - 1) < 0.1 + error)


def test_of_noise_alone_next_to_nothing_is_kept() -> None:
    left = [np.std(selected(v := noise(seed), 1.0).denoised - v.mean()) for seed in range(60)]
    assert np.quantile(left, 0.9) < 0.2
    assert max(left) < 0.5


@pytest.mark.parametrize("size", [0.3, 1.0, 10.0])
def test_a_tone_in_noise_is_kept(size: float) -> None:
    tone = size * np.sqrt(2) * np.sin(2 * np.pi * STEP / 150)
    for seed in range(10):
        found = selected(tone + noise(seed), 1.0)
        assert not found.kept[0]
        assert np.std((found.denoised - tone)[INNER]) < 0.5
        # from the fastest one on every mode is kept
        assert found.kept[np.argmax(found.kept) :].all()


def test_without_noise_everything_is_kept() -> None:
    values = np.sin(0.05 * STEP) + np.sign(np.sin(0.011 * STEP))
    np.testing.assert_allclose(selected(values, 0.0).denoised, values, atol=1e-12)


def test_the_loudest_mode_alone() -> None:
    values = np.sin(2 * np.pi * STEP / 23) + 3 * np.sin(2 * np.pi * STEP / 230)
    found = selected(values + 0.1 * noise(0), 0.1, rule="loudest")
    assert found.kept.sum() == 1
    assert found.energy[found.kept] == np.max(found.energy)


def test_the_package_missing_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "PyEMD.EMD", None)
    with pytest.raises(RecordError, match=r"needs the package EMD-signal .*pip install EMD-signal"):
        decompose(noise(0))
