"""What a record holds and can tell, on records made here."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from inerter.inspection.channel import channel_facts
from inerter.inspection.facts import facts_of, span
from inerter.inspection.motion import motion_facts
from inerter.inspection.tells import Tell, clauses, words
from inerter.records import Record, check_records
from inerter.records.motion import smooth
from inerter.records.steps import converter_step
from numpy.typing import NDArray


@pytest.mark.parametrize("count", [2, 3, 5, 12, 33, 60, 250, 1000])
def test_a_channel_of_any_kind_and_length_has_facts(count: int) -> None:
    rng, t = np.random.default_rng(count), 2e-3 * np.arange(count)
    noise = rng.normal(size=count)
    for values in (
        np.zeros(count), np.full(count, 1e9), noise, np.sin(3 * t), np.round(np.sin(9 * t), 1),
        np.cumsum(noise), t, (t > t[-1] / 2) * 1.0, 1e-300 * noise, np.sin(50 * t) + 1e-3 * noise,
    ):  # fmt: skip
        facts = channel_facts("force", "N", np.asarray(values, dtype=np.float64), 2e-3)
        assert (facts.low, facts.high) == (values.min(), values.max())


def test_rate_and_noise_are_told(tmp_path: Path) -> None:
    """White noise of 0.5 N on the force; the record's rate, strokes and channels."""
    rng, t = np.random.default_rng(3), 1e-3 * np.arange(8000)
    x = 0.02 * np.sin(2 * np.pi * 1.5 * t)
    force = -60.0 * (2 * np.pi * 1.5) ** 2 * x + 0.5 * rng.normal(size=t.size)
    np.savetxt(
        tmp_path / "run.csv", np.column_stack([t, x, force]), delimiter=",", comments="",
        header="time,displacement,force",
    )  # fmt: skip
    done = subprocess.run(
        [sys.executable, "-m", "inerter", "inspect", tmp_path / "run.csv", "--json"],
        capture_output=True, text=True, check=True, cwd=tmp_path,
    )  # fmt: skip
    (found,) = json.loads(done.stdout)["records"]
    channels = {each["name"]: each for each in found["channels"]}
    assert found["sample_rate"] == pytest.approx(1000.0)
    assert found["samples"] == 8000
    assert channels["force"]["noise"] == pytest.approx(0.5, rel=0.1)
    assert channels["displacement"]["unit"] == "m"


@pytest.mark.parametrize("most", [np.inf, 430.0, 120.0])
def test_what_a_clipped_force_tells_is_not_told_wrong(most: float) -> None:
    """Clipped and with spikes: the errors cover as of an unspoilt record, or nothing is told."""
    rng = np.random.default_rng(3)
    t = np.asarray(1e-3 * np.arange(20_000), dtype=np.float64)

    def motion(order: int) -> NDArray[np.float64]:
        made = np.zeros(len(t))
        for size, tone in ((0.02, 1.3), (0.004, 4.1)):
            w = 2 * np.pi * tone
            made += size * w**order * np.sin(w * t + order * np.pi / 2)
        return made

    x, v, a = (motion(order) for order in range(3))
    force = np.clip(120 * a + 40 * v + 18 * np.sign(v) + rng.normal(0, 2, len(t)), -most, most)
    if np.isfinite(most):
        force[rng.integers(0, len(t), 6)] += 900
    # in steps of 20 um, as of an encoder
    steps = 2e-5 * np.round(x / 2e-5)
    record = Record(name="run", time=t, displacement=steps, force=force)
    (checked,) = check_records([record])
    assert bool(checked.warnings) == np.isfinite(most)
    found = {tell.name: tell for tell in facts_of(checked).tells}
    assert len(found) == 4
    if most == 120.0:
        assert {tell.verdict for tell in found.values()} == {"not told"}
        assert "clipped or spikes" in words(found["inertance"])
        return
    for name, true in (("inertance", 120.0), ("viscous friction", 40.0), ("dry friction", 18.0)):
        tell = found[name]
        assert abs(tell.value - true) < max(3 * tell.stderr, 0.01 * true), tell


@pytest.mark.parametrize(
    ("value", "error", "said"),
    [
        (527.2, 31.0, "530 ± 30"),
        (33.41, 0.6, "33.4 ± 0.6"),
        (104.6, 9.6, "100 ± 10"),
        (5.0, 0.0, "5"),
    ],
)
def test_a_value_has_the_digits_of_its_error(value: float, error: float, said: str) -> None:
    tell = Tell(name="stiffness", value=value, stderr=error, unit="N/m", verdict="told")
    assert words(tell) == f"stiffness {said} N/m"


@pytest.mark.parametrize("grows", [0.05, 0.1, 0.2])
@pytest.mark.parametrize("stiffness", [8e3, 1.5e4, 3e4])
def test_errors_of_a_first_look_hold_what_no_linear_model_has(
    grows: float, stiffness: float
) -> None:
    """A swing that dies out between bumpers: each part of the record tells another inertance."""
    t = np.arange(0, 12, 0.004)
    x = 0.03 * np.exp(-0.2 * t) * np.sin(2 * np.pi * (1.5 * t + grows * t**2))
    v, a = np.gradient(x, t), np.gradient(np.gradient(x, t), t)
    bumpers = stiffness * (np.maximum(x - 0.02, 0) + np.minimum(x + 0.02, 0))
    force = 55 * a + 70 * v + bumpers + np.random.default_rng(3).normal(0, 2, t.size)
    (inertance, *_) = facts_of(Record(name="run", time=t, displacement=x, force=force)).tells
    assert inertance.name == "inertance"
    assert abs(inertance.value - 55) < 3 * inertance.stderr


def test_what_cannot_be_told_for_one_reason_is_said_once() -> None:
    told = Tell(name="inertance", value=60.0, stderr=1.0, unit="kg", verdict="told")
    stroke = {
        "value": 0.0,
        "stderr": 1.0,
        "verdict": "not told",
        "reason": "one stroke",
        "motion": "more",
    }
    first = Tell(name="dry friction", unit="N", **stroke)
    other = Tell(name="stiffness", unit="N/m", **stroke)
    slow = Tell(name="viscous friction", unit="N s/m", **{**stroke, "reason": "it goes with x"})
    assert clauses([told, first, slow, other]) == [
        words(told),
        "dry friction and stiffness not: one stroke; more would tell",
        words(slow),
    ]


@pytest.mark.parametrize("step", [1e-6, 2e-5, 1e-4])
@pytest.mark.parametrize("noise", [0.0, 1e-6, 3e-5])
@pytest.mark.parametrize("jitter", [0.0, 0.2])
def test_a_step_is_told_where_there_is_one_alone(step: float, noise: float, jitter: float) -> None:
    """As an encoder counts; also of few samples among many counts, and on an uneven clock."""
    rng, count = np.random.default_rng(7), 4000
    t = 1e-3 * (np.arange(count) + jitter * rng.uniform(-1, 1, count))
    x = 0.02 * np.sin(8 * t) + 0.004 * np.sin(26 * t) + noise * rng.normal(size=count)
    force = rng.normal(0, 2, count)
    counted = Record(name="run", time=t, displacement=step * np.round(x / step), force=force)
    told = facts_of(counted).channels[0].step
    assert told == pytest.approx(step, rel=0.01)
    assert [
        c.step for c in facts_of(Record(name="run", time=t, displacement=x, force=force)).channels
    ] == [None, None]


def test_what_looks_like_steps_and_is_none() -> None:
    """An even motion without noise, and numbers of so many digits each."""
    t = 1e-3 * np.arange(8000)
    assert converter_step(np.abs((0.1 * t + 0.01) % 0.04 - 0.02)) is None
    assert converter_step(np.array([float(f"{x:.3e}") for x in 90 * np.sin(8 * t)])) is None
    # and a slow motion in steps, a card of 16 bits whose volts a text rounds
    slow = 2e-5 * np.round(1e-3 * t / 2e-5)
    assert converter_step(slow) == pytest.approx(2e-5)
    counts = np.round(3e3 * np.sin(8 * t) + 20 * np.random.default_rng(1).normal(size=t.size))
    volts = np.round(counts * 20 / 65536, 5)
    assert converter_step(50 * volts) == pytest.approx(50 * 20 / 65536, rel=1e-3)


@pytest.mark.parametrize(
    ("tones", "hum", "low", "high"),
    [
        ({0.5: 0.02, 1.9: 1e-3, 7.0: 1e-3}, 0.0, 7.0, 9.0),
        ({0.5: 0.02, 5.0: 1e-3}, 1e-5, 5.0, 7.0),
        ({50.0: 2e-3}, 0.0, 50.0, 52.0),
        ({}, 0.0, 0.0, 0.0),
    ],
)
def test_the_band_ends_with_the_motion(
    tones: dict[float, float], hum: float, low: float, high: float
) -> None:
    """Tones far apart are one motion; a line of the mains is none, unless nothing else moves."""
    t = 1e-3 * np.arange(20_000)
    x = 1e-6 * np.random.default_rng(2).normal(size=t.size) + hum * np.sin(100 * np.pi * t)
    for tone, size in tones.items():
        x = x + size * np.sin(2 * np.pi * tone * t)
    facts = channel_facts("displacement", "m", np.asarray(x, dtype=np.float64), 1e-3)
    assert low <= facts.band <= high
    assert [at for at, _ in facts.hum] == ([50.0] if hum else [])


def test_a_range_is_in_one_unit() -> None:
    assert span(-2.4e-6, 0.105, "m") == "0 to 105 mm"
    assert span(-0.0263, 0.105, "m") == "-26 to 105 mm"
    assert span(-710.4, 3004.0, "N") == "-710 to 3000 N"
    assert span(0.0, 0.0, "m") == "0 to 0 um"


def test_a_linear_model_that_is_astray_bounds_nothing() -> None:
    """Stops are all of the force; where noise is much of it, that is none of the model's."""
    rng = np.random.default_rng(4)
    t = np.asarray(1e-3 * np.arange(12_000), dtype=np.float64)
    x = 0.02 * np.sin(3 * t)
    stops = 5e5 * (np.maximum(x - 0.015, 0) + np.minimum(x + 0.015, 0))
    found = facts_of(Record(name="run", time=t, displacement=x, force=stops)).tells
    assert {tell.verdict for tell in found} == {"not told"}
    assert "a linear model leaves" in words(found[0])
    a = -0.02 * 9 * np.sin(3 * t)
    noisy = 60 * a + 900 * 0.06 * np.cos(3 * t) + rng.normal(0, 60, t.size)
    told = {
        x.name: x for x in facts_of(Record(name="run", time=t, displacement=x, force=noisy)).tells
    }
    viscous = told["viscous friction"]
    assert viscous.reason != found[0].reason
    assert abs(viscous.value - 900) < 4 * viscous.stderr


def test_friction_with_memory_is_no_negative_inertance() -> None:
    """60 N of Dahl friction and 5 kg along rounded triangles: a linear model tells neither."""
    rng = np.random.default_rng(8)
    t = np.asarray(2e-3 * np.arange(2500), dtype=np.float64)
    v = 0.04 * np.tanh(np.sin(2 * np.pi * t) / 0.15)
    x = np.cumsum(v) * 2e-3
    friction, steps = np.zeros(t.size), np.diff(x, prepend=x[0])
    for k in range(1, t.size):
        way = np.sign(steps[k])
        friction[k] = 60 * way + (friction[k - 1] - 60 * way) * np.exp(-4e5 / 60 * abs(steps[k]))
    force = friction + 5 * np.gradient(v, 2e-3) + rng.normal(0, 0.3, t.size)
    found = facts_of(Record(name="run", time=t, displacement=x, force=force)).tells
    told = {tell.name: tell for tell in found}
    assert told["inertance"].value < 0
    assert {tell.verdict for tell in found} == {"not told"}
    (said,) = clauses(found)
    assert "a linear model makes the inertance negative" in said


def test_a_force_repeats_where_strokes_do() -> None:
    """Strokes of one length at other places are none that repeat: a spring is bent otherwise."""
    rng = np.random.default_rng(5)
    t = np.asarray(2e-3 * np.arange(10_000), dtype=np.float64)

    def repeats(frequencies: tuple[float, ...]) -> float | None:
        angle = 2 * np.pi * np.outer(frequencies, t)
        x = np.asarray((0.02 / np.array(frequencies)) @ np.sin(angle), dtype=np.float64)
        force = np.asarray(4e3 * x + rng.normal(0.0, 0.5, t.size), dtype=np.float64)
        record = Record(name="run", time=t, displacement=x, force=force)
        return motion_facts(smooth(record, 20.0)).repeats

    assert repeats((1.3,)) == pytest.approx(0.5, rel=0.3)
    assert repeats((1.3, 1.3 / np.sqrt(7), 0.91 * np.e)) is None
