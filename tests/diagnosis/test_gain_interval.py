"""The interval of a gain, against cases in which the true gain is known."""

from __future__ import annotations

import numpy as np
from inerter.diagnose.statistics import gain_interval


def test_it_closes_where_all_blocks_agree() -> None:
    before = np.random.default_rng(1).uniform(0.1, 9.0, 40)
    low, high = gain_interval(before, 0.25 * before) or (0.0, 0.0)
    np.testing.assert_allclose([low, high], 0.5, rtol=1e-12)


def test_it_holds_the_true_gain_as_often_as_it_says() -> None:
    # mean squares 4 and 1: half of the rms error is taken away
    random = np.random.default_rng(2)
    held = []
    for _ in range(400):
        before, after = 4 * random.gamma(3.0, 1 / 3, 48), random.gamma(3.0, 1 / 3, 48)
        low, high = gain_interval(before, after, draws=500) or (0.0, 0.0)
        held.append(low < 0.5 < high)
    # a bootstrap of 48 blocks is a little narrow: 6000 draws held it in 93.3 %, 373 of 400; these
    # bounds are four standard errors off
    assert 355 <= sum(held) <= 393


def test_it_is_negative_where_nothing_is_won() -> None:
    before = np.random.default_rng(3).uniform(1.0, 2.0, 40)
    low, high = gain_interval(before, 1.21 * before) or (0.0, 0.0)
    np.testing.assert_allclose([low, high], -0.1, rtol=1e-12)


def test_too_few_blocks_have_none() -> None:
    assert gain_interval(np.ones(7), np.full(7, 0.5)) is None
    assert gain_interval(np.ones(8), np.full(8, 0.25)) is not None
    assert gain_interval(np.zeros(20), np.zeros(20)) is None
