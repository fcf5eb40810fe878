"""Standard errors of a least-squares estimate cover."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.estimation.covariance import sandwich
from scipy.signal import lfilter

DRAWS = 300


def design(size: int, middle: float) -> np.ndarray:
    """A short swing somewhere in a slow one, and what a force is made of along it (n, 8)."""
    t = np.arange(size) / 200
    burst = np.exp(-(((t - middle * t[-1]) / 0.6) ** 2))
    x = np.sin(4 * np.pi * t) * burst + 0.05 * np.sin(2.6 * np.pi * t)
    v = np.gradient(x, t)
    a = np.gradient(v, t)
    x, v, a = (each / each.std() for each in (x, v, a))
    way = np.tanh(20 * v)
    stop = np.maximum(x - 1.2, 0)
    return np.column_stack([a, v, x, way, stop, v * np.abs(v), np.ones(size), way * t / t[-1]])


def shares_within_two(size: int, effects_seed: int) -> tuple[float, float]:
    """Of the scores of blocks, and of a jackknife, how often two standard errors hold the truth."""
    draw = np.random.default_rng(effects_seed)
    within = np.zeros((2, DRAWS))
    for i in range(DRAWS):
        columns = design(size, draw.uniform(0.3, 0.7))
        noise = lfilter([1.0], [1.0, -1.6, 0.7], draw.standard_normal(size))
        found = np.linalg.lstsq(columns, noise, rcond=None)[0]
        rest = noise - columns @ found
        for row, left_out in zip(within, (False, True), strict=True):
            covariance = sandwich(columns, rest, np.ones(size), left_out=left_out)
            row[i] = np.mean(np.abs(found) < 2 * np.sqrt(np.diag(covariance)))
    return float(within[0].mean()), float(within[1].mean())


def test_a_jackknife_holds_where_few_blocks_tell(effects_seed: int) -> None:
    scored, alone = shares_within_two(1500, effects_seed)
    assert scored < 0.925
    assert 0.935 < alone < 0.975


def test_of_one_coordinate_it_is_what_refits_without_a_block_tell() -> None:
    """Left out in turn: the spread of the estimates is the jackknife's, but for what is capped."""
    draw = np.random.default_rng(1)
    column, values = draw.standard_normal((400, 1)), draw.standard_normal(400)
    found = float(np.linalg.lstsq(column, values, rcond=None)[0][0])
    rest = values - column[:, 0] * found
    blocks = np.array_split(np.arange(400), 20)
    refits = []
    for block in blocks:
        kept = np.setdiff1d(np.arange(400), block)
        refits.append(np.linalg.lstsq(column[kept], values[kept], rcond=None)[0][0])
    spread = np.sum((np.array(refits) - found) ** 2) * (len(blocks) - 1) / len(blocks)
    covariance = sandwich(column, -rest, np.ones(400), left_out=True)
    np.testing.assert_allclose(covariance, [[spread]], rtol=1e-10)


def test_what_one_block_tells_alone_is_not_endless() -> None:
    """A stop that is met in one block: its error is larger, and a number."""
    draw = np.random.default_rng(1)
    columns = np.column_stack([draw.standard_normal(1200), np.zeros(1200)])
    columns[600:605, 1] = 1.0
    rest = draw.standard_normal(1200)
    rest -= columns @ np.linalg.lstsq(columns, rest, rcond=None)[0]
    scored, alone = (
        np.sqrt(np.diag(sandwich(columns, rest, np.ones(1200), left_out=each)))
        for each in (False, True)
    )
    assert np.all(np.isfinite(alone))
    assert scored[1] < alone[1] <= 10.1 * scored[1]


@pytest.mark.parametrize("memory", [0, 400])
def test_what_lasts_longer_than_a_block_widens_the_errors(memory: int) -> None:
    """Two standard errors hold where what is left wanders slowly, and are no wider else."""
    random = np.random.default_rng(3)
    n, trials = 6000, 300
    columns = np.column_stack([np.ones(n), np.sin(np.arange(n) / 900.0)])
    solve = np.linalg.pinv(columns)
    estimates, told, plain = [], [], []
    for _ in range(trials):
        rest = random.normal(size=n + memory)
        if memory:
            # blocks have 100 samples
            rest = lfilter([1.0], [1.0, -np.exp(-1.0 / memory)], random.normal(size=n + 4000))
        rest = rest[-n:]
        estimate = solve @ rest
        residual, even = rest - columns @ estimate, np.ones(n)
        estimates.append(estimate)
        told.append(np.sqrt(np.diag(sandwich(columns, residual, even, left_out=True))))
        plain.append(np.sqrt(np.diag(sandwich(columns, residual, even))))
    spread = np.std(estimates, axis=0)
    ratio, before = np.mean(told, axis=0) / spread, np.mean(plain, axis=0) / spread
    if memory:
        assert (before < 0.5).all(), "blocks alone"
        assert (ratio > 1.6 * before).all()
        assert (ratio < 1.1).all()
    else:
        assert (np.abs(ratio - 1.0) < 0.12).all()
