"""What docs/records.md says of denoising, on a force that is known."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.records.denoise import comparison
from inerter.records.denoise.comparison import DRAWS, FRICTION, NOISE, compare

DRAWN = 10


@pytest.fixture(scope="module")
def rows():
    # all but the spline, which takes a second a draw
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(comparison, "WAYS", [w for w in comparison.WAYS if w[1] != "spline"])
        return {row.name: row for row in compare(DRAWN)}


@pytest.mark.parametrize("name", ["none", "lowpass on both sides"])
def test_friction_is_unbiased_as_measured_and_behind_one_filter_on_both_sides(rows, name) -> None:
    row = rows[name]
    assert abs(row.friction) < 4 * row.friction_error / np.sqrt(DRAWN)


@pytest.mark.parametrize("name", ["emd", "savgol", "lowpass"])
def test_denoising_the_force_alone_costs_friction(rows, name) -> None:
    row = rows[name]
    assert row.noise < 0.35 * NOISE
    assert -0.15 * FRICTION < row.friction < -4 * row.friction_error / np.sqrt(DRAWN)
    # the phase of the fundamental stays
    assert abs(row.phase) < 0.2


def test_denoising_does_not_make_friction_more_certain(rows) -> None:
    assert rows["lowpass"].friction_error > 0.7 * rows["none"].friction_error


def test_the_loudest_mode_alone_is_the_worst(rows) -> None:
    loudest = rows["emd, loudest mode"]
    assert abs(loudest.friction) > 0.2 * FRICTION
    assert loudest.error > 2 * rows["emd"].error


def test_rms_error_of_the_raw_force_is_its_noise(rows) -> None:
    assert rows["none"].error == pytest.approx(NOISE, rel=0.05)
    assert DRAWS >= DRAWN
