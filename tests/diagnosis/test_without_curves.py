"""What a search finds without curves along the stroke is taken where it says as much."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from inerter.diagnose.along_stroke import is_drawn
from inerter.diagnose.composition import effects_of
from inerter.diagnose.search import Scored, Search
from inerter.diagnose.stages.searching import search_in, without_curves
from inerter.diagnose.start import Given, Prepared, prepared
from inerter.identify.model import Model
from inerter.records import Record

Array = np.ndarray
ENDS = {"curve_lower": -0.022, "curve_upper": 0.022}


def start_of(force: Callable[[Array], Array], told: list[str]) -> Prepared:
    """60 kg with a force of the place, along three sines."""
    draw = np.random.default_rng(5)
    time, speed = np.arange(0, 6, 4e-3), 2 * np.pi * np.array([0.7, 1.9, 4.1])
    size = np.array([15e-3, 6e-3, 2e-3])
    x = size @ np.sin(np.outer(speed, time))
    a = -(size * speed**2) @ np.sin(np.outer(speed, time))
    shown = x + 1e-7 * draw.standard_normal(time.size)
    measured = 60 * a + force(x) + 0.3 * draw.standard_normal(time.size)
    record = Record(name="run", time=time, displacement=shown, force=measured)
    return prepared(Given(records=[record], progress=told.append))


def drawn(start: Prepared, **more: float) -> tuple[Search, Scored]:
    """A search that is told to have found a curve of the force, and more."""
    search = search_in(start, start.weighed)
    curve = {f"force_node_{i}": 0.0 for i in range(1, 18)}
    model = search.baseline.holding(**ENDS).adding(None, **curve, **more)
    return search, search.score("position_force", "curve", search.problem.fit(model))


def again(force: Callable[[Array], Array], **more: float) -> tuple[Scored, Scored, list[str]]:
    """What was found, what is taken, and what was told."""
    told: list[str] = []
    start = start_of(force, told)
    search, final = drawn(start, **more)
    _, taken = without_curves(start, start.weighed, search, final)
    return final, taken, told


def effects(model: Model) -> list[str]:
    """Effects beyond an inertance."""
    return [name for name, _ in effects_of(model, Model("none", {}, ("inertance",)))]


def test_a_spring_takes_the_place_of_a_curve_that_draws_one() -> None:
    final, taken, told = again(lambda x: 400 * x + 2e6 * x**3)
    assert is_drawn(final.model)
    assert not is_drawn(taken.model)
    assert set(effects(taken.model)) == {"parallel_stiffness", "hardening_stiffness"}
    assert taken.complexity < final.complexity
    assert any("without curves" in each for each in told)


def bumps(x: Array) -> Array:
    """A force that nothing but a curve draws."""
    places = ((1, -0.014), (-1, -0.003), (1, 0.004), (1, 0.017))
    return sum((s * 12.0 * np.exp(-(((x - at) / 1.5e-3) ** 2)) for s, at in places), 0 * x)


def test_a_force_that_nothing_else_draws_stays_a_curve() -> None:
    final, taken, _ = again(bumps)
    assert taken is final


def test_beside_many_effects_a_curve_is_not_asked_for() -> None:
    more = {"viscous": 0.0, "quadratic_damping": 0.0, "force_offset": 0.0, "force_drift": 0.0}
    final, taken, told = again(lambda x: 400 * x, **more)
    assert taken is final
    assert not any("without curves" in each for each in told)


def test_a_search_may_draw_none(monkeypatch: pytest.MonkeyPatch) -> None:
    start = start_of(bumps, [])
    tried: list[str | None] = []
    for draws in (True, False):
        search = replace(search_in(start, start.weighed), draws=draws)
        monkeypatch.setattr(
            search.trials, "fit_all", lambda each, *_, **__: tried.extend(c.law for c in each) or []
        )
        search.run()
        assert ("curve" in tried) is draws
        tried.clear()


@pytest.mark.parametrize("name", ["force_node_3", "inertance_back_node_2", "friction_node_1"])
def test_a_curve_of_any_quantity_is_one(name: str) -> None:
    plain = Model("none", {"inertance": 60.0}, ("inertance",))
    assert not is_drawn(plain)
    assert is_drawn(plain.adding(None, **{name: 0.0}))
    assert not is_drawn(plain.holding(**{name: 0.0}))
