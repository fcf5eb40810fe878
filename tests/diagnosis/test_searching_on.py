"""Where the held-out data do not confirm an effect, what its place hid is looked for."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from inerter.diagnose.composition import effects_of
from inerter.diagnose.result import Rival
from inerter.diagnose.rivals import Standing
from inerter.diagnose.search import Search
from inerter.diagnose.stages import Confirmed, Searched, Settled, compared, confirmed, searched
from inerter.diagnose.stages.confirming import stands_in
from inerter.diagnose.start import Given, prepared
from inerter.diagnose.vehicle.search import VehicleSearch
from inerter.identify.model import Model
from inerter.records import Record


def bench(viscous: float, coulomb: float, seed: int) -> Record:
    """60 kg with friction along two sines."""
    random = np.random.default_rng(seed)
    time = np.arange(0, 8, 1 / 500)
    size, speed = np.array([[0.01], [0.004]]), 2 * np.pi * np.array([[1.0], [2.7]])
    x = (size * np.sin(speed * time)).sum(0)
    v = (size * speed * np.cos(speed * time)).sum(0)
    a = -(size * speed**2 * np.sin(speed * time)).sum(0)
    force = 60 * a + viscous * v + coulomb * np.sign(v)
    return Record(
        name="run",
        time=time,
        displacement=x + random.normal(0, 1e-6, time.size),
        force=force + random.normal(0, 0.3, time.size),
    )


def confirmed_from(record: Record, **said: float) -> tuple[Confirmed, list[str]]:
    """What stands of a search that ended with some effects, and what was told on the way."""
    told: list[str] = []
    found = searched(prepared(Given(records=[record], progress=told.append)))
    search = found.search
    fit = search.problem.fit(search.baseline.adding(None, **said))
    final = search.score("", None, fit)
    start = Settled(
        searched=replace(found, final=final), final=final, before=search.baseline_fit(),
        standings={},
    )  # fmt: skip
    return confirmed(start), told


def names(found: Confirmed) -> set[str]:
    """Effects that stand."""
    return {name for name, _ in effects_of(found.fit.model, found.searched.prepared.baseline)}


@pytest.mark.parametrize(
    ("confidence", "rivals", "told"),
    [
        (0.0, {"force_drift": 1.0}, True),
        (0.3, {"force_offset": 0.4, "force_drift": 0.31}, True),
        (0.4, {"force_offset": 0.5, "force_drift": 0.1}, False),
        (0.9, {"force_drift": 0.1}, False),
        (1.0, {}, False),
    ],
)
def test_what_was_dropped_and_is_likelier_is_not_replaced(
    confidence: float, rivals: dict[str, float], told: bool
) -> None:
    standing = Standing(confidence, [Rival(*each) for each in rivals.items()], None)
    assert stands_in(standing, {"force_drift", "viscous_drift"}) is told
    assert not stands_in(standing, set())
    assert not stands_in(None, {"force_drift"})


def test_search_goes_on_without_what_was_dropped(effects_seed: int) -> None:
    found, told = confirmed_from(bench(100.0, 8.0, effects_seed), viscous=0.0, force_drift=0.0)
    assert "force_drift is not confirmed on held-out data: dropped" in told
    assert "searching on without force_drift" in told
    assert names(found) == {"viscous_friction", "coulomb_friction"}
    assert {link.effect for link in found.chain} == names(found)
    assert set(found.standings) == names(found)


def test_nothing_is_added_where_nothing_is_left(effects_seed: int) -> None:
    found, told = confirmed_from(bench(100.0, 0.0, effects_seed), viscous=0.0, force_drift=0.0)
    assert "searching on without force_drift" in told
    assert names(found) == {"viscous_friction"}
    assert [link.effect for link in found.chain] == ["viscous_friction"]


@pytest.mark.long
def test_what_is_excluded_comes_back_on_no_way(effects_seed: int) -> None:
    found = searched(prepared(Given(records=[bench(100.0, 8.0, effects_seed)])))
    baseline = found.prepared.baseline
    assert "coulomb_friction" in dict(effects_of(found.final.model, baseline))
    # every law of friction, and what stands in for one
    excluded = {"coulomb_friction", "hysteretic_friction", "position_dependent_friction"}
    excluded.add("digressive_damping")
    search = replace(found.search, found=[], excluded=frozenset(excluded))
    model, _ = compared(search, baseline, search.run())
    there = {name for name, _ in effects_of(model.model, baseline)}
    assert "viscous_friction" in there
    assert not there & excluded


def test_a_play_that_goes_leaves_the_whole_record(
    monkeypatch: pytest.MonkeyPatch, effects_seed: int
) -> None:
    """While there is a play a run is followed from a contact on; without it nothing is left out."""
    record = bench(100.0, 8.0, effects_seed)
    start = prepared(Given(records=[record]))
    plain = searched(start)

    def play_is_needless(found: Searched, play: Model) -> Searched:
        return replace(plain, data=plain.data.with_play(play))

    shaft = {"series_frequency": 30.0, "series_loss": 0.1, "backlash": 1e-5}
    monkeypatch.setattr(
        "inerter.diagnose.stages.searching._play",
        lambda found: found.final.model.adding(None, **shaft),
    )
    monkeypatch.setattr("inerter.diagnose.stages.searching._with_play", play_is_needless)
    found = searched(start)
    assert {name for name, _ in effects_of(found.final.model, start.baseline)} == {
        "viscous_friction", "coulomb_friction",
    }  # fmt: skip
    for run, before in zip(found.data.whole, plain.data.whole, strict=True):
        assert run.inner.sum() == before.inner.sum()
    assert "backlash" not in found.search.excluded


def test_a_vehicle_is_searched_on_where_something_went(monkeypatch: pytest.MonkeyPatch) -> None:
    """What had to go first may have stood in the way."""
    told: list[int] = []

    def scored(count: int) -> SimpleNamespace:
        return SimpleNamespace(model=SimpleNamespace(effects=[None] * count))

    def added(search: VehicleSearch, current: SimpleNamespace) -> SimpleNamespace:
        told.append(len(current.model.effects))
        return scored(3) if len(told) == 1 else current

    monkeypatch.setattr(VehicleSearch, "_added", added)
    monkeypatch.setattr(VehicleSearch, "_prune", lambda search, current: scored(2))
    monkeypatch.setattr(VehicleSearch, "_score", lambda search, fit: scored(0))
    monkeypatch.setattr("inerter.diagnose.vehicle.search.fit_all", lambda problem, trials: [None])
    search = object.__new__(VehicleSearch)
    search.problem = cast(Any, None)
    found = search.run()
    assert len(found.model.effects) == 2
    assert told == [0, 2]


@pytest.mark.parametrize(("most", "asked"), [(4, False), (5, True), (np.inf, True)])
def test_nothing_is_added_to_a_model_of_many_coordinates(most: float, asked: bool) -> None:
    steps = []
    search = SimpleNamespace(
        found=[], most_complex=most, time=SimpleNamespace(is_over=lambda: False),
        _best_step=steps.append, _two_steps=lambda current: None,
    )  # fmt: skip
    current = SimpleNamespace(complexity=4)
    assert Search._added(cast(Any, search), cast(Any, current), None, 8) is current
    assert bool(steps) == asked
