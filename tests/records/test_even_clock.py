"""Clocks that are even though their times were rounded, and those that are not."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.inspection.facts import clock_words, facts_of
from inerter.records import Record
from inerter.records.even_clock import even_spacing
from inerter.records.quality import find_missing_samples, find_nonuniform_sampling

SPACING = 3.328e-4
TIME = SPACING * np.arange(9000)


def of_digits(time: np.ndarray, figures: int) -> np.ndarray:
    """As a program writes them with so many figures: the later, the coarser."""
    return np.array([float(f"{t:.{figures}g}") for t in time])


@pytest.mark.parametrize(
    "time",
    [TIME, np.round(TIME, 4), of_digits(TIME, 5), 12.0 + np.round(TIME, 4), np.round(TIME, 5)],
)
def test_a_rounded_clock_is_even(time: np.ndarray) -> None:
    assert even_spacing(time) == pytest.approx(SPACING, rel=1e-4)
    record = Record(name="a", time=time, displacement=np.sin(time), force=np.cos(time))
    assert record.sample_rate == pytest.approx(1 / SPACING, rel=1e-4)
    for find in (find_missing_samples, find_nonuniform_sampling):
        assert find(record).warnings == ()


@pytest.mark.parametrize("digits", [3, 4, 9])
def test_with_a_sample_missing_it_is_not(digits: int) -> None:
    time = np.array([round(1e-3 * k, digits) for k in range(3000) if k != 1500])
    assert even_spacing(time) is None
    record = Record(name="a", time=time, displacement=np.sin(time), force=np.cos(time))
    assert record.sample_interval == pytest.approx(1e-3)
    assert [w.code for w in find_missing_samples(record).warnings] == ["missing_samples"]


def test_a_clock_that_trembles_is_not() -> None:
    random = np.random.default_rng(1)
    time = 1e-3 * (np.arange(3000) + random.uniform(-0.2, 0.2, 3000))
    assert even_spacing(time) is None
    assert even_spacing(np.round(time, 6)) is None


def test_inspect_says_so() -> None:
    random = np.random.default_rng(2)

    def said(time: np.ndarray) -> str:
        x = 0.01 * np.sin(30.0 * time) + random.normal(0.0, 1e-6, time.size)
        return clock_words(facts_of(Record(name="a", time=time, displacement=x, force=-900.0 * x)))

    assert "as its times are rounded: an even clock" in said(np.round(TIME, 4))
    assert "rounded" not in said(TIME + 1e-5 * random.uniform(-1.0, 1.0, TIME.size))
