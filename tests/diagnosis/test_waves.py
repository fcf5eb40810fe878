"""What waves of the place take of a residual, all at once, against one regression for each."""

import numpy as np
import pytest
from inerter.diagnose.waves import shares_taken, shortest, wave_sums


@pytest.mark.parametrize(("path", "share"), [(1e-6, 1 / 400), (1e-3, 1 / 125), (1e-2, 1 / 60)])
def test_quick_motion_does_not_ask_for_less_than_usual(path: float, share: float) -> None:
    assert shortest(1.0, path) == pytest.approx(share)
    assert shortest(0.05, 0.05 * path) == pytest.approx(0.05 * share)


def test_sums_are_those_of_each_wave() -> None:
    rng = np.random.default_rng(5)
    x, weights = rng.uniform(-3.0, 9.0, 4000), rng.normal(size=(2, 4000))
    step, count = 1 / 48, 400
    found = wave_sums(x, weights, step, count)
    exact = weights @ np.exp(2j * np.pi * step * np.outer(x, np.arange(count)))
    # a sum of as many random phases as samples, each off by a tenth of a radian at most
    assert np.max(np.abs(found - exact)) < 0.1 * np.sqrt(4000)
    assert np.max(np.abs(found - exact)[:, :40]) < 0.01 * np.sqrt(4000)


@pytest.mark.parametrize("kind", ["force", "friction", "inertance"])
def test_shares_are_those_of_regressions(kind: str) -> None:
    """Of a force, of a level times the direction, of b(x) a + b'(x) v^2 / 2."""
    rng, t = np.random.default_rng(8), np.linspace(0, 20, 8000)
    x = 0.05 * np.sin(2 * np.pi * 0.7 * t) + 0.02 * np.sin(2 * np.pi * 1.9 * t + 1)
    v = np.gradient(x, t)
    a = np.gradient(v, t)
    level = {"force": np.ones(t.size), "friction": np.sign(v), "inertance": 60 * a}[kind]
    rise = 30 * v**2 if kind == "inertance" else np.zeros(t.size)
    values = rng.normal(size=t.size)
    length, step = 0.02, 1 / (4 * np.ptp(x))
    wave, slope = (
        np.cos(2 * np.pi * x / length),
        -np.sin(2 * np.pi * x / length) * 2 * np.pi / length,
    )
    shape = level * wave + rise * slope
    values += shape / np.std(shape)
    shares = shares_taken(x, values, level, rise, step, 160)
    for j in (*range(8, 160, 19), int(np.argmax(shares))):
        angle, rate = 2 * np.pi * j * step * x, 2 * np.pi * j * step
        c, s = np.cos(angle), np.sin(angle)
        columns = np.column_stack([level * c - rise * rate * s, level * s + rise * rate * c])
        left = values - columns @ np.linalg.lstsq(columns, values, rcond=None)[0]
        assert shares[j] == pytest.approx(1 - left @ left / (values @ values), abs=2e-3)
    assert 1 / (np.argmax(shares) * step) == pytest.approx(length, rel=0.03)
