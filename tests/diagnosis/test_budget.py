"""What repeats, what more could be predicted, and the budget, on records made by hand."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import cache

import numpy as np
import pytest
from inerter.diagnose.baseline import baseline_of
from inerter.diagnose.budget.ceiling import ceiling, predictor
from inerter.diagnose.budget.remains import with_ceiling
from inerter.diagnose.budget.repeats import repeats, turning_points
from inerter.diagnose.budget.words import budget_of
from inerter.diagnose.data import Data, divided
from inerter.diagnose.result import Unexplained
from inerter.identify.fit import Problem, rms
from inerter.records import Record
from inerter.records.preparation import prepare
from threadpoolctl import threadpool_limits

Array = np.ndarray
Law = Callable[[Array, Array, Array], Array]

NOISE = 1.0
RATE = 250.0


def records(
    law: Law, *, periodic: bool = False, noise: float = NOISE, runs: int = 3
) -> list[Record]:
    """80 kg and a law of time, displacement and velocity, along several sines; force in N."""
    random, time = np.random.default_rng(4), np.arange(0, 12, 1 / RATE)
    made = []
    for number in range(runs):
        if periodic:
            # all of them multiples of 0.25 Hz: strokes repeat every 4 s
            speed, size = 2 * np.pi * np.array([0.5, 1.0, 1.75]), np.array([0.03, 0.01, 0.006])
        else:
            speed = 2 * np.pi * np.sort(random.uniform(0.3, 2.5, 5))
            size = 0.02 / np.arange(1, 6)
        phase = speed[:, None] * time + random.uniform(0, 6, speed.size)[:, None]
        x = size @ np.sin(phase)
        v = (size * speed) @ np.cos(phase)
        a = -(size * speed**2) @ np.sin(phase)
        force = 80 * a + law(time, x, v) + random.normal(0, noise, time.size)
        moved = x + random.normal(0, 2e-6, time.size)
        made.append(Record(name=f"run {number}", time=time, displacement=moved, force=force))
    return made


@pytest.fixture(autouse=True)
def one_thread() -> Iterator[None]:
    """As in a diagnosis."""
    with threadpool_limits(limits=1, user_api="blas"):
        yield


@cache
def left_of(law: Law) -> tuple[Data, list[Array]]:
    """`left` of the records of a law."""
    return left(records(law))


def left(made: Sequence[Record]) -> tuple[Data, list[Array]]:
    """The records divided, and what an inerter with viscous and Coulomb friction leaves [N]."""
    data = divided(made, prepare(made), ())
    sizes = data.band.scales
    start = baseline_of(None, sizes).adding(
        "coulomb", viscous=0.0, coulomb_force=1e-3 * sizes.force
    )
    model = Problem(data.runs, data.split.fit, sizes).fit(start).model
    return data, data.raw.errors(model)


def nothing(t: Array, x: Array, v: Array) -> Array:
    """No force."""
    return np.zeros(t.size)


def coulomb(t: Array, x: Array, v: Array) -> Array:
    """What the fitted model has."""
    return 10 * np.sign(v)


def cogging(t: Array, x: Array, v: Array) -> Array:
    """A force of the place."""
    return 4 * np.sin(2 * np.pi * x / 0.013)


def relaxing(t: Array, x: Array, v: Array) -> Array:
    """A spring behind a damper, forgotten within 0.1 s."""
    force, keep = np.zeros(t.size), np.exp(-1 / RATE / 0.1)
    for i in range(1, t.size):
        force[i] = keep * force[i - 1] + 800 * (x[i] - x[i - 1])
    return force


# --- ceiling -------------------------------------------------------------------------------------


@pytest.mark.parametrize(("law", "group"), [(cogging, "place"), (relaxing, "memory")])
def test_what_has_no_name_is_predicted_down_to_the_noise(law: Law, group: str) -> None:
    data, errors = left_of(law)
    own = rms(errors, data.raw.masks)
    assert own > 1.5 * NOISE
    found = ceiling(data.whole, data.full, errors, data.preparation.cutoff, NOISE)
    # nine tenths of the power that is no noise
    assert found.takes**2 > 0.9 * (own**2 - NOISE**2)
    assert found.rmse > 0.95 * NOISE
    # powers add up: what is taken and what is left are the whole
    assert np.hypot(found.rmse, found.takes) == pytest.approx(own, rel=1e-9)
    assert group in found.looks_at


@pytest.mark.parametrize("law", [nothing, coulomb])
def test_beside_a_right_model_nothing_more_is_predictable(law: Law) -> None:
    data, errors = left_of(law)
    found = ceiling(data.whole, data.full, errors, data.preparation.cutoff, NOISE)
    assert found.takes == 0
    assert found.rmse == pytest.approx(rms(errors, data.raw.masks), rel=1e-12)


def test_the_predictor_does_not_see_what_is_held_out() -> None:
    data, errors = left_of(cogging)
    changed = [
        np.where(out, 100.0, error) for error, out in zip(errors, data.full.holdout, strict=True)
    ]
    cutoff = data.preparation.cutoff
    one, other = (predictor(data.whole, data.full, e, cutoff)[0] for e in (errors, changed))
    for a, b in zip(one, other, strict=True):
        np.testing.assert_array_equal(a, b)


def test_too_few_samples_teach_nothing() -> None:
    data, errors = left_of(cogging)
    few = [mask & (np.arange(mask.size) < 60) for mask in data.full.fit]
    split = type(data.full)(few, data.full.holdout, data.full.folds, "")
    predicted, looks_at = predictor(data.whole, split, errors, data.preparation.cutoff)
    assert looks_at == ()
    assert not any(values.any() for values in predicted)


# --- what repeats --------------------------------------------------------------------------------


@pytest.mark.parametrize(("law", "noise"), [(nothing, 2.0), (cogging, 0.5)])
def test_strokes_that_repeat_differ_by_the_noise(law: Law, noise: float) -> None:
    """Whatever the model lacks: it repeats, too."""
    data, errors = left(records(law, periodic=True, noise=noise))
    found = repeats(data.whole, errors)
    assert found is not None
    assert found.rmse == pytest.approx(noise, rel=0.05)
    assert found.strokes > 2 * found.kinds


def test_what_changes_from_stroke_to_stroke_does_not_repeat() -> None:
    """A force that another clock sets: 3 N of a sine at 0.61 Hz, of which strokes know nothing."""
    data, errors = left(
        records(lambda t, x, v: 3 * np.sin(2 * np.pi * 0.61 * t), periodic=True, noise=0.2)
    )
    found = repeats(data.whole, errors)
    assert found is not None
    assert found.rmse == pytest.approx(3 / np.sqrt(2), rel=0.25)


def test_a_motion_that_never_repeats_has_no_repeatability() -> None:
    data, errors = left_of(nothing)
    assert repeats(data.whole, errors) is None


def test_turning_points_of_a_sine_that_trembles() -> None:
    phase = np.linspace(0, 6 * np.pi, 3001)
    x = np.sin(phase) + 0.005 * np.sin(400 * phase)
    turns = turning_points(x, 0.1)
    assert phase[turns[-6:]] == pytest.approx(np.pi * (np.arange(6) + 0.5), abs=0.15)


# --- the budget ----------------------------------------------------------------------------------


def test_the_parts_are_the_whole() -> None:
    budget = budget_of(68.8, 7.7, 5.2, 2.1)
    assert sum(size for _, _, size in budget.parts()) == pytest.approx(68.8)
    assert budget.sentence == (
        "Of 68.8 N rms, 61.1 N is named, 2.5 N more could be predicted from the motion but has no "
        "name, and 5.2 N was not predicted by anything tried. Strokes that repeat differ by 2.1 N."
    )


def test_a_predictor_that_does_worse_predicts_nothing_more() -> None:
    budget = budget_of(10.0, 1.0, 1.3, None)
    assert budget.predictable == 0
    assert budget.rest == 1.0
    assert "nothing more was predictable" in budget.sentence
    assert "Strokes" not in budget.sentence


def test_what_tests_foretell_is_not_said_to_be_unpredictable() -> None:
    budget = budget_of(10.0, 1.0, 1.0, None, foretold=0.8)
    assert "a flexible predictor took nothing more away on data left out" in budget.sentence
    assert "nothing more was predictable" not in budget.sentence


def test_what_can_be_predicted_together_is_said_to_remain() -> None:
    """Where no test alone found it, the text does not say that there is nothing."""
    quiet = Unexplained(
        significant=False, fraction=0.9, depends_on=[],
        summary="What remains (3 N rms; noise of force and motion 1 N) shows no dependence.",
    )  # fmt: skip
    data, errors = left_of(cogging)
    told = with_ceiling(data, errors, NOISE, quiet)
    assert told.significant
    assert "is not noise" in told.summary
    assert "shows no dependence" not in told.summary
    assert told.ceiling is not None
    assert told.structure > 2
    right, rest = left_of(coulomb)
    assert not with_ceiling(right, rest, NOISE, quiet).significant


def test_a_part_of_what_is_left_is_told_beside_a_large_error() -> None:
    """What tests foretell, and the predictor with them, is in the sum."""
    budget = budget_of(192.5, 5.39, 4.77, None, foretold=2.5)
    assert "0.62 N more could be predicted from the motion" in budget.sentence
    assert "took nothing more away" not in budget.sentence
