"""Records that are short and fast, have pauses, wrong channels or very unequal lengths."""

from __future__ import annotations

from dataclasses import replace
from unittest.mock import Mock

import numpy as np
import pytest
from inerter.diagnose import diagnose_bench
from inerter.diagnose.composition import is_distinct
from inerter.diagnose.remainder.words import summary
from inerter.diagnose.result import ParameterValue
from inerter.diagnose.rivals import Standing
from inerter.diagnose.search import Search
from inerter.diagnose.stages import settling as stages
from inerter.diagnose.start import Given, prepared
from inerter.diagnose.wording import quantity
from inerter.identify.fit import Fit
from inerter.identify.model import Model
from inerter.identify.runs import scales, thin
from inerter.identify.split import split
from inerter.records import Record, check_records
from inerter.records.preparation import prepare


def inerter(
    name: str,
    frequency: float,
    duration: float = 8.0,
    rate: float = 250.0,
    amplitude: float = 3e-3,
    noise: float = 0.2,
    pause: float = 0.0,
    seed: int = 0,
) -> Record:
    """50 kg along two sines, with a pause of some seconds in the middle."""
    random, time = np.random.default_rng(seed), np.arange(0, duration, 1 / rate)
    time = time + np.where(time >= duration / 2, pause, 0.0)
    x, a = np.zeros(time.size), np.zeros(time.size)
    for share, times in ((1.0, 1.0), (0.3, 1.6)):
        w = 2 * np.pi * frequency * times
        x += share * amplitude * np.sin(w * time)
        a -= share * amplitude * w * w * np.sin(w * time)
    x += random.normal(0, 1e-3 * noise * amplitude, time.size)
    force = 50 * a + random.normal(0, noise, time.size)
    return Record(name=name, time=time, displacement=x, force=force)


@pytest.mark.long
def test_several_short_fast_runs() -> None:
    """Of 50 ms not one cell of loudness is away from the ends."""
    runs = [
        inerter(f"run {f}", f, 0.05, 20e3, 1e-4, noise=2.0, seed=int(f))
        for f in (60.0, 75.0, 90.0, 105.0)
    ]
    diagnosis = diagnose_bench(runs)
    assert diagnosis.baseline.device["inertance"] == pytest.approx(50, rel=0.02)


@pytest.mark.parametrize("pause", [1.13, 60.0])
def test_a_pause_moves_no_scale(pause: float) -> None:
    """Across it the motion is a guess that swings far out."""
    without, with_it = (
        scales([thin(motion) for motion in prepare([inerter("run", 2.0, pause=p)]).motions])
        for p in (0.0, pause)
    )
    for name in ("displacement", "velocity", "acceleration", "force"):
        assert getattr(with_it, name) == pytest.approx(getattr(without, name), rel=0.1), name


@pytest.mark.long
def test_a_pause_leaves_the_noise_as_it_is() -> None:
    floors = []
    for pause in (0.0, 3.132):
        diagnosis = diagnose_bench([inerter("run", 2.0, pause=pause)])
        floors.append(diagnosis.noise_floor)
        assert not diagnosis.findings
    assert floors[1] == pytest.approx(floors[0], rel=0.2)


@pytest.mark.parametrize("pause", [5.0, 120.0])
def test_blocks_are_held_out_of_what_was_measured(pause: float) -> None:
    runs = [thin(motion) for motion in prepare([inerter("run", 2.0, 20.0, pause=pause)]).motions]
    found = split(runs)
    held, learnt = (int((m[0] & runs[0].inner).sum()) for m in (found.holdout, found.fit))
    assert 0.25 < held / (held + learnt) < 0.35


@pytest.mark.long
def test_motions_faster_than_the_usual_band() -> None:
    """A smoother that ends at 200 Hz takes most of a motion at 200 Hz away."""
    diagnosis = diagnose_bench([inerter("fast", 200.0, 1.0, 20e3, 1e-5, noise=1.0)])
    assert diagnosis.baseline.device["inertance"] == pytest.approx(50, rel=0.01)
    assert diagnosis.baseline.rmse < 2 * diagnosis.noise_floor
    assert not diagnosis.findings


def test_a_channel_found_wrong_is_left_out() -> None:
    record = inerter("run", 2.0)
    rate = np.gradient(record.displacement, record.time)
    smooth = np.convolve(rate, np.ones(9) / 9, "same")
    flipped = check_records([replace(record, velocity=-smooth)])
    assert "sign_flip" in [warning.code for warning in flipped[0].warnings]
    assert prepare(flipped).channels == ()


def test_a_dead_channel_does_not_cost_the_good_one() -> None:
    record = inerter("run", 2.0, noise=0.5)
    w, t = 2 * np.pi * 2.0, record.time
    a = -3e-3 * (w**2 * np.sin(w * t) + 0.3 * (1.6 * w) ** 2 * np.sin(1.6 * w * t))
    dead = check_records([replace(record, velocity=np.zeros(t.size), acceleration=a)])
    assert prepare(dead).channels == ("acceleration",)


def test_what_is_held_out_does_not_choose_the_smoothing_of_what_is_fitted() -> None:
    runs = [inerter(f"run {i}", f, seed=i) for i, f in enumerate((1.5, 1.8, 2.2))]
    walk = np.cumsum(np.random.default_rng(3).normal(0, 3.0, runs[1].samples))
    changed = [runs[0], replace(runs[1], force=runs[1].force + walk), runs[2]]
    found = [prepared(Given(records=each, holdout=["run 1"])) for each in (runs, changed)]
    assert found[0].plain.cutoff == found[1].plain.cutoff
    assert found[0].weighed.cutoff == found[1].weighed.cutoff


def test_a_baseline_is_fitted_by_least_squares() -> None:
    """Whatever a play lets count less: that is the size of what the play leaves."""
    runs = [thin(motion) for motion in prepare([inerter("run", 2.0)]).motions]
    ideal = Model("none", {"inertance": 10.0}, ("inertance",))
    plain, forgiving = (
        Search([replace(run, far=far) for run in runs], split(runs), ideal).baseline_fit()
        for far in (np.inf, 0.1)
    )
    assert forgiving.model.values == plain.model.values


def test_a_model_named_in_the_end_is_compared_itself(monkeypatch: pytest.MonkeyPatch) -> None:
    """Rivals that take each other's place in turn: the last one's confidence is its own."""

    class Named:
        def __init__(self, turn: int) -> None:
            self.turn, self.model = turn, turn

    def effects(turn: int, baseline: object) -> list[tuple[str, None]]:
        return [(f"first of {turn}", None), (f"second of {turn}", None)]

    def stand(search: object, final: Named, effect: str) -> Standing:
        other = Named(final.turn + 1) if effect.startswith("first") else None
        return Standing(0.9, [], other)  # pyright: ignore[reportArgumentType]

    monkeypatch.setattr(stages, "effects_of", effects)
    monkeypatch.setattr(stages, "standing", stand)
    search, baseline, start = Mock(), Mock(), Named(0)
    final, standings = stages.compared(search, baseline, start)  # pyright: ignore
    assert set(standings) == {name for name, _ in effects(final.model, None)}  # pyright: ignore


IDEAL = Model("none", {"inertance": 1.0}, ("inertance",))


def test_a_shaft_of_a_stiffness_that_is_not_known_is_none() -> None:
    values = {"inertance": 1e-9, "series_frequency": 30.0, "series_loss": 0.1}
    model = Model("none", values, tuple(values))
    sure = Fit(replace(model, values={**values, "inertance": 50.0}), [], np.diag([1, 0.1, 0.01]), 1)
    unsure = Fit(model, [], np.diag([1, 0.1, 0.01]), 1)
    assert is_distinct("series_elasticity", sure, IDEAL)
    assert not is_distinct("series_elasticity", unsure, IDEAL)


# words


@pytest.mark.parametrize(
    ("value", "error", "text"),
    [
        (113.42, 0.002, "113.420 ± 0.002 N"),
        (65634.0, 12.0, "65630 ± 10 N"),
        (15812.0, 3123.0, "15800 ± 3100 N"),
        (9.9964, 0.0057, "9.996 ± 0.006 N"),
        (-0.5, 2.0, "-0.50 ± 2.00 N"),
        (1.23456e-7, 1e-9, "1.23e-07 ± 1e-09 N"),
        (0.0, 5200.0, "0 ± 5e+03 N"),
        (50.0, 1e-9, "50.0000 ± 1e-09 N"),
    ],
)
def test_a_value_has_the_digits_that_its_error_leaves(
    value: float, error: float, text: str
) -> None:
    assert quantity(ParameterValue(value, error, "N")) == text


def test_what_can_be_predicted_and_what_it_leaves_are_one_sum() -> None:
    text = summary(
        ["force", "bursts"], {}, {"force": 0.08, "bursts": 0.21}, 85.3, 1.9, 46.0, False, None,
        predicted=24.1,
    )  # fmt: skip
    assert "24.1 N rms can be predicted from the other data, which leaves 81.8 N; 39.2 N" in text
    assert "(8 %)" in text


def test_of_bursts_it_is_known_when_they_come() -> None:
    text = summary(["bursts"], {}, {"bursts": 0.94}, 1.7, 0.2, 1.66, False, None)
    assert "1.66 N rms come and go as the other data tell" in text
    assert "(94 %)" in text
