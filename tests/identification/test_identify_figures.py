"""The axis of errors in the picture of an identification can be read, whatever it spans."""

from __future__ import annotations

import itertools
import math

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from inerter.identify.figures import log_ticks
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure


@given(st.floats(-9, 9), st.floats(0.002, 8))
@example(0.0, 5.0)
def test_labels_are_few_round_and_apart(begin: float, span: float) -> None:
    low, high = 10**begin, 10 ** (begin + span)
    ticks = log_ticks(low, high)
    assert 1 <= len(ticks) <= 5
    assert all(low <= tick <= high for tick in ticks)
    for a, b in itertools.pairwise(ticks):
        assert math.log(b / a) > 0.12 * math.log(high / low)


@pytest.mark.parametrize(
    ("low", "high", "ticks"),
    [
        (0.22, 12.0, [1.0, 10.0]), (0.9, 1.1, [0.9, 1.0, 1.1]), (1.5, 9.0, [2.0, 8.0]),
        (0.08, 120.0, [0.1, 1.0, 10.0, 100.0]),
    ],
)  # fmt: skip
def test_ticks_are_those_one_would_choose(low: float, high: float, ticks: list[float]) -> None:
    assert set(ticks) <= set(log_ticks(low, high))


@pytest.mark.parametrize(("low", "high"), [(0.25, 11), (0.29, 0.31), (3, 8), (1e-3, 2e4)])
def test_drawn_labels_do_not_overlap(low: float, high: float) -> None:
    """As narrow as in the picture."""
    figure = Figure(figsize=(3.1, 2), dpi=150)
    canvas = FigureCanvasAgg(figure)
    axes = figure.subplots()
    axes.set_xscale("log")
    ticks = log_ticks(low, high)
    axes.set_xticks(ticks, [f"{tick:.6g}" for tick in ticks], fontsize=8)
    axes.set_xticks([], minor=True)
    axes.set_xlim(low, high)
    canvas.draw()
    boxes = [label.get_window_extent() for label in axes.get_xticklabels()]
    assert all(a.x1 < b.x0 for a, b in itertools.pairwise(boxes))
