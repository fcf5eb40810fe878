"""Receptance and densities against systems whose answer is known."""

import numpy as np
import pytest
from inerter.studies.fluid_rig.spectra import spectra

RATE = 200.0


def test_a_delayed_copy_has_its_gain_and_phase() -> None:
    force = np.random.default_rng(0).standard_normal(40_000)
    late = 3
    displacement = 2e-3 * np.roll(force, late)
    found = spectra(displacement, force, RATE).between(1.0, 20.0)
    # a segment of 1600 samples loses 3 of its own to its neighbours
    np.testing.assert_allclose(found.magnitude, 2e-3, rtol=0.02)
    expected = -360.0 * found.frequency * late / RATE
    np.testing.assert_allclose(found.phase, expected, atol=1.0)
    assert found.coherence.min() > 0.99


def test_a_density_holds_the_power() -> None:
    time = np.arange(12_000) / RATE
    sine = 3e-3 * np.sin(2 * np.pi * 5.0 * time)
    noise = 0.2 * np.random.default_rng(1).standard_normal(time.size)
    found = spectra(sine, noise, RATE)
    width = found.frequency[1] - found.frequency[0]
    assert np.sum(found.displacement_density) * width == pytest.approx(3e-3**2 / 2, rel=1e-3)
    # white noise of rms s has the one-sided density 2 s^2 / rate at every frequency
    band = found.between(5.0, 95.0)
    assert np.mean(band.force_density) == pytest.approx(2 * 0.2**2 / RATE, rel=0.03)


def test_noise_of_the_displacement_does_not_bias_the_receptance() -> None:
    generator = np.random.default_rng(2)
    force = generator.standard_normal(400_000)
    noise = 1e-3 * generator.standard_normal(force.size)
    found = spectra(1e-3 * force + noise, force, RATE).between(1.0, 90.0)
    assert np.mean(found.receptance.real) == pytest.approx(1e-3, rel=0.01)
    # half of the displacement's power is noise
    assert np.mean(found.coherence) == pytest.approx(0.5, abs=0.02)


def test_records_at_once_are_records_one_by_one() -> None:
    x, force = np.random.default_rng(3).standard_normal((2, 3, 4000))
    together = spectra(x, force, RATE, segment=4.0)
    for i in range(3):
        alone = spectra(x[i], force[i], RATE, segment=4.0)
        np.testing.assert_allclose(together.receptance[i], alone.receptance, rtol=1e-12)
    assert together.segments == 9


@pytest.mark.parametrize(
    ("x", "force", "segment", "message"),
    [
        (np.zeros(100), np.zeros(101), 0.2, "differ in shape"),
        (np.zeros(100), np.zeros(100), 8.0, "longer than the record of 0.5 s"),
        (np.zeros(100), np.zeros(100), 0.01, "at least 8"),
    ],
)
def test_records_that_cannot_be(x, force, segment: float, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        spectra(x, force, RATE, segment)
