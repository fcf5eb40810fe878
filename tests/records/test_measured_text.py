"""A value and its error stand to the same digit, with as many digits as the error tells."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.measured_text import decimals_told, measured


@pytest.mark.parametrize(
    ("value", "error", "digits", "least", "told"),
    [
        (527.2, 31.0, 1, 1, "530 ± 30"), (104.6, 9.6, 1, 1, "100 ± 10"),
        (104.6, 9.6, 2, 1, "104.6 ± 9.6"), (6.75, 0.0031, 1, 4, "6.750 ± 0.003"),
        (-0.5, 2.0, 1, 3, "-0.50 ± 2.00"), (1.23456e-7, 1e-9, 1, 3, "1.23e-07 ± 1e-09"),
        (113.0, np.nan, 1, 1, "113 ± nan"), (3.9e-13, 2.7e-4, 1, 1, "0 ± 0.0003"),
    ],
)  # fmt: skip
def test_examples(value: float, error: float, digits: int, least: int, told: str) -> None:
    assert measured(value, error, digits, least) == told


def test_what_is_told_lies_within_the_error(effects_seed: int) -> None:
    draw = np.random.default_rng(effects_seed)
    for _ in range(500):
        value = float(draw.choice([-1, 1]) * 10 ** draw.uniform(-3, 5))
        error = float(abs(value) * 10 ** draw.uniform(-4, 0.5))
        shown, spread = (float(part) for part in measured(value, error).split(" ± "))
        # half a unit of the last place, which is the first digit of the error
        assert abs(shown - value) <= 0.5 * error * (1 + 1e-9) + 1e-12, (value, error)
        assert 0.6 * error < spread < 1.6 * error, (value, error)
        assert decimals_told(10 * value, 10 * error) == decimals_told(value, error) - 1
