"""Steps of a converter are told with their share of the noise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from inerter.diagnose.data import divided
from inerter.diagnose.judge import Judge
from inerter.diagnose.quantisation import steps_in_words, steps_of
from inerter.identify.model import Model
from inerter.records import Record
from inerter.records.preparation import prepare
from inerter.records.steps import converter_step

MODEL = Model("none", {"inertance": 60.0}, ("inertance",))


def record(step: float, noise: float) -> Record:
    random, time = np.random.default_rng(3), np.arange(0, 8, 1 / 500)
    x, a = (
        sum(s * (2 * np.pi * f) ** k * np.sin(2 * np.pi * f * time) for f, s in PARTS)
        for k in (0, 2)
    )
    force = -60 * a + noise * random.normal(size=time.size)
    x = x + 1e-7 * random.normal(size=time.size)
    made = Record(name="run", time=time, displacement=x, force=force)
    return replace(made, force=step * np.round(force / step)) if step else made


PARTS = ((0.7, 0.01), (2.3, 0.004))


def steps(made: Record) -> dict[str, dict[str, float]]:
    prepared = prepare([made])
    data = divided([made], prepared, ())
    judge = Judge(data.band, data.raw, data.band, prepared, MODEL)
    return steps_of(data, judge, MODEL)


def test_the_share_is_that_of_the_steps() -> None:
    found = steps(record(1.0, 0.3))
    assert set(found) == {"force"}
    told = found["force"]
    assert told["step"] == pytest.approx(1.0)
    assert told["noise"] == pytest.approx(1 / np.sqrt(12))
    # 1/12 of 1/12 + 0.09
    assert told["share"] == pytest.approx(1 / 12 / (1 / 12 + 0.09), rel=0.2)
    assert "the force in steps of 1 N (" in steps_in_words(found)


def test_fine_steps_and_none_are_not_told() -> None:
    assert steps(record(0.0, 0.3)) == {}
    assert steps_in_words({}) == ""
    fine = steps(record(0.05, 0.3))
    assert fine["force"]["share"] < 0.01
    assert steps_in_words(fine) == ""


def test_a_step_is_the_smallest_of_all() -> None:
    values = 0.25 * np.round(40 * np.sin(np.arange(900)))
    assert converter_step(values) == pytest.approx(0.25)
    assert converter_step(np.sin(np.arange(900.0))) is None
