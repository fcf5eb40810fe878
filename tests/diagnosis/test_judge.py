"""How surely an effect helps on held-out data."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from inerter.diagnose.decision import CRITERIA
from inerter.diagnose.judge import Judge
from inerter.identify.model import Model

COUNT = 3600
SIMPLE = Model("none", {"inertance": 60.0}, ("inertance",))
RICH = SIMPLE.adding(None, series_frequency=9.0, series_loss=0.1)


def judge(before: np.ndarray, after: np.ndarray) -> Judge:
    """Held-out data that two models leave so much of [N]."""
    left = {SIMPLE.free: [before], RICH.free: [after]}
    problem = SimpleNamespace(
        masks=[np.ones(COUNT, bool)], residual=lambda model: left[model.free]
    )  # fmt: skip
    every = cast(Any, problem)
    return Judge(every, every, every, cast(Any, None), SIMPLE)


def noise(seed: int) -> np.ndarray:
    return np.random.default_rng(seed).standard_normal(COUNT)


def resonance() -> np.ndarray:
    """What a shaft adds where a sweep goes through its resonance, in a twentieth of the time."""
    time = np.arange(COUNT) / COUNT
    return 30.0 * np.exp(-(((time - 0.7) / 0.012) ** 2)) * np.sin(500.0 * time)


def test_a_shaft_is_judged_where_it_shows() -> None:
    found = judge(noise(1) + resonance(), noise(1))
    assert found.advantage(SIMPLE, RICH, "series_elasticity") > 2 * CRITERIA.confirming_advantage
    # over all blocks the few that it takes so much of would count as scatter
    everywhere = found.advantage(SIMPLE, RICH, "viscous_friction")
    assert everywhere < CRITERIA.confirming_advantage


@pytest.mark.parametrize("seed", range(20))
def test_a_shaft_that_is_none_is_not_confirmed(seed: int) -> None:
    """It adds a little of a form that the force has nothing of."""
    draw = np.random.default_rng(100 + seed)
    form = np.convolve(draw.standard_normal(COUNT), np.ones(9) / 9, mode="same")
    found = judge(noise(seed), noise(seed) + 0.3 * form)
    assert found.advantage(SIMPLE, RICH, "series_elasticity") < CRITERIA.confirming_advantage


def test_the_wrong_resonance_is_none() -> None:
    found = judge(noise(1), noise(1) + resonance())
    assert found.advantage(SIMPLE, RICH, "series_elasticity") < -2.0


def test_calm_is_all_but_blows() -> None:
    blows = np.zeros(COUNT)
    blows[700:720] = 90.0
    masks = [np.ones(COUNT, bool)]
    left = {SIMPLE.free: [2.0 + noise(1) + blows], RICH.free: [noise(1) - blows]}
    raw = SimpleNamespace(masks=masks, errors=lambda model: left[model.free])
    found = judge(noise(1), noise(1))
    found = Judge(found.band, cast(Any, raw), found.weighed, found.preparation, found.baseline)
    (calm,) = found.calm(left[RICH.free])
    assert not calm[700:720].any()
    assert calm.sum() == COUNT - 20
    assert found.taken_in_calm(SIMPLE, RICH) == pytest.approx(2.0, rel=0.02)
    assert found.left_in_calm(RICH, 0.6) == pytest.approx(0.8, rel=0.05)
