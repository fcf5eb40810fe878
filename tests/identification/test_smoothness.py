"""A curve along the stroke is smooth where the data leave it open, and theirs where they do not."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.catalogue.along_stroke import QUANTITIES, curves_of_nodes
from inerter.identify import columns as columns_module
from inerter.identify import fit as fit_module
from inerter.identify.fit import Problem
from inerter.identify.model import Model
from inerter.identify.smoothness import smoothness
from three_sines import motion, run_of

FORCE, INERTANCE = QUANTITIES[0], QUANTITIES[1]
NODES = 17


def given(effects_seed: int) -> tuple[Problem, Model, np.ndarray]:
    """A force of the place over a fifth more than is travelled, and where to begin."""
    x, v, a = motion()
    low, high = 1.2 * float(x.min()), 1.2 * float(x.max())
    draw = np.random.default_rng(effects_seed)
    places = np.linspace(low, high, NODES)
    true = 8 * np.sin(places / (0.15 * (high - low)) + draw.uniform(0, 6))
    force = 50 * a + curves_of_nodes(low, high, NODES)(x) @ true
    run = run_of(force + 0.5 * draw.standard_normal(x.size), (x, v, a))
    nodes = dict.fromkeys(FORCE.nodes[:NODES], 0.0)
    ends = {"curve_lower": low, "curve_upper": high}
    model = Model("none", {"inertance": 40.0, **ends, **nodes}, ("inertance", *nodes))
    return Problem([run], [np.ones(x.size, bool)]), model, true


def test_where_nothing_was_travelled_the_curve_goes_on(
    effects_seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    data, model, true = given(effects_seed)
    found = data.fit(model)
    values = np.array([found.model.values[name] for name in FORCE.nodes[:NODES]])
    errors = np.sqrt(np.diag(found.covariance))[1:]
    seen = errors < 2 * np.median(errors)
    assert 10 <= seen.sum() < NODES
    assert np.all(np.abs(values - true)[seen] < 5 * errors[seen] + 0.05)
    # nodes beyond the travel are no farther from their neighbours than others are
    steps = np.abs(np.diff(values))
    assert steps.max() < 1.5 * np.abs(np.diff(true)).max()

    for each in (fit_module, columns_module):
        monkeypatch.setattr(each, "smoothness", lambda model: np.zeros((0, len(model.free))))
    plain = Problem(data.runs, data.masks).fit(model)
    there = np.array([plain.model.values[name] for name in FORCE.nodes[:NODES]])
    # a curve that bends as here: what it is held to moves no node that data see by its error
    np.testing.assert_array_less(np.abs(values - there)[seen], 0.5 * errors[seen])


def test_rows_are_second_differences_of_free_nodes() -> None:
    nodes = dict.fromkeys((*FORCE.nodes[:5], *INERTANCE.nodes[:4], *INERTANCE.back_nodes[:4]), 0.0)
    free = ("inertance", *(name for name in nodes if name != FORCE.nodes[2]))
    rows = smoothness(Model("none", {"inertance": 1.0, **nodes}, free))
    assert rows.shape == (3 + 2 + 2, len(free))
    assert not rows[:, 0].any()
    # a straight line counts nothing, one that bends does
    inertance = [free.index(name) for name in INERTANCE.nodes[:4]]
    point = np.zeros(len(free))
    point[inertance] = [1.0, 2.0, 3.0, 4.0]
    np.testing.assert_allclose(rows @ point, 0, atol=1e-15)
    point[inertance] = [1.0, 4.0, 9.0, 16.0]
    counted = np.sort(np.abs(rows @ point))
    np.testing.assert_allclose(counted[-2:], 2 * np.abs(rows).max() / 2)
    assert not counted[:-2].any()
    assert smoothness(Model("none", {"inertance": 1.0}, ("inertance",))).shape == (0, 1)
