"""Other effects in the place of one that was found before all else was known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from inerter import Device
from inerter.diagnose import instead as module
from inerter.diagnose.data import divided
from inerter.diagnose.decision import CRITERIA
from inerter.diagnose.instead import instead
from inerter.diagnose.search import Scored, Search
from inerter.identify.model import Model
from inerter.records import Record
from inerter.records.preparation import prepare

IDEAL = Model("none", {"inertance": 60.0, "transition_velocity": 1e-3}, ("inertance",))
COULOMB = IDEAL.adding("coulomb", coulomb_force=20.0, transition_velocity=1e-3)
PEAK = {"static_force": 45.0, "stribeck_velocity": 0.05}


def found_before(device: Device, model: Model, noise: float = 0.2) -> tuple[Search, Scored]:
    """A search along three sines, and a model that it is told to have found."""
    draw = np.random.default_rng(3)
    time, speed = np.arange(0, 8, 2e-3), 2 * np.pi * np.array([0.7, 1.9, 4.1])
    size = np.array([15e-3, 6e-3, 2e-3])
    x = size @ np.sin(np.outer(speed, time))
    v = (size * speed) @ np.cos(np.outer(speed, time))
    a = -(size * speed**2) @ np.sin(np.outer(speed, time))
    force = device.along(2e-3, x, v, a)["total"] + noise * draw.standard_normal(time.size)
    shown = x + 1e-7 * draw.standard_normal(time.size)
    record = Record(name="run", time=time, displacement=shown, force=force)
    data = divided([record], prepare([record]), ())
    search = Search(data.runs, data.split, IDEAL)
    return search, search.score("found", None, search.problem.fit(model))


def test_a_peak_takes_the_place_of_a_level() -> None:
    device = Device(inertance=60.0, friction="stribeck", coulomb_force=20.0, **PEAK)
    search, found = found_before(device, COULOMB)
    other = instead(search, found)
    assert other is not None
    assert other.effect in ("stribeck_friction", "hysteretic_friction")
    assert other.squares.sum() < 0.5 * found.squares.sum()


def test_what_stands_in_for_a_spring_that_hardens_is_exchanged() -> None:
    device = Device(inertance=60.0, stiffness=500.0, stiffness_cubic=2e7)
    search, found = found_before(device, IDEAL.adding(None, stiffness=3e3, quadratic_damping=10.0))
    other = instead(search, found)
    assert other is not None
    assert "stiffness_cubic" in other.model.free or "gas_push" in other.model.free
    assert "quadratic_damping" not in other.model.free


def test_what_may_be_none_takes_no_place(monkeypatch: pytest.MonkeyPatch) -> None:
    device = Device(inertance=60.0, friction="stribeck", coulomb_force=20.0, **PEAK)
    search, found = found_before(device, COULOMB)
    asked: list[str] = []

    def is_none(effect: str, *given: object) -> bool:
        asked.append(effect)
        return False

    monkeypatch.setattr("inerter.diagnose.search.is_distinct", is_none)
    assert instead(search, found) is None
    assert "stribeck_friction" in asked or "hysteretic_friction" in asked


def test_nothing_is_tried_where_noise_alone_is_left(monkeypatch: pytest.MonkeyPatch) -> None:
    device = Device(inertance=60.0, friction="coulomb", coulomb_force=20.0)
    search, found = found_before(device, COULOMB)
    left = found.fit.rmse(search.problem.masks)

    def tried(*args: object) -> list[object]:
        raise AssertionError("it is tried")

    monkeypatch.setattr(module, "fitted_instead", tried)
    search.runs = [replace(run, noise=1.01 * left / CRITERIA.near_noise) for run in search.runs]
    assert instead(search, found) is None
    search.runs = [replace(run, noise=0.99 * left / CRITERIA.near_noise) for run in search.runs]
    with pytest.raises(AssertionError, match="it is tried"):
        instead(search, found)


def test_of_many_effects_none_is_exchanged(monkeypatch: pytest.MonkeyPatch) -> None:
    device = Device(inertance=60.0, friction="stribeck", coulomb_force=20.0, **PEAK)
    many = {"viscous": 1.0, "stiffness": 1.0, "force_offset": 0.1, "quadratic_damping": 1.0}
    search, found = found_before(device, COULOMB.adding(None, **many))
    tried: list[object] = []
    monkeypatch.setattr(module, "fitted_instead", lambda *given: tried.append(given) or [])
    assert instead(search, found) is None
    assert not tried
    few = COULOMB.adding(None, viscous=1.0, stiffness=1.0)
    assert instead(search, search.score("few", None, search.problem.fit(few))) is None
    assert len(tried) == CRITERIA.exchanged_of == 3


def test_a_right_model_keeps_its_effects() -> None:
    device = Device(inertance=60.0, friction="coulomb", coulomb_force=20.0, viscous=100.0)
    search, found = found_before(device, COULOMB.adding(None, viscous=50.0))
    assert instead(search, found) is None
