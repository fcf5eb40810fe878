"""Constants of runs are no cause; a run that contradicts the others is named. Records by hand."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from bench_runs import measured
from inerter.diagnose.clipping import apart_from, limits_of
from inerter.diagnose.run_constants import (
    constants,
    constants_in_words,
    contradicting,
    explained,
    without_constants,
    zeros_of,
)
from inerter.diagnose.start import Given, prepared
from inerter.identify.runs import BenchRun, thin
from inerter.records import Record
from inerter.records.preparation import prepare
from inerter.reference import ReferenceDevice, sine_motion, sum_of_sines

TIME = np.arange(0, 12, 1 / 200)


def record(
    number: int,
    inertance: float = 50.0,
    offset: float = 0.0,
    drift: float = 0.0,
    centre: float = 0.0,
    start: float = 0.0,
    uneven: float = 0.0,
    pace: float = 1.0,
) -> Record:
    """An inerter with Coulomb and viscous friction and a hardening spring along three sines."""
    random = np.random.default_rng(number)
    speed = 2 * np.pi * np.array([0.4, 0.9, 1.7]) * (1 + 0.1 * number) * pace
    size = np.array([0.02, 0.01, 0.005])
    phase = speed[:, None] * TIME + random.uniform(0, 6, 3)[:, None]
    x = centre + size @ np.sin(phase)
    v, a = (size * speed) @ np.cos(phase), -(size * speed**2) @ np.sin(phase)
    force = inertance * a + 30 * v + 8 * np.sign(v) + 2e5 * x**3 + offset + drift * TIME
    force += uneven * np.abs(v)
    return Record(
        name=f"run {number}", time=start + TIME,
        displacement=x + random.normal(0, 2e-6, x.size),
        force=force + random.normal(0, 0.3, x.size),
    )  # fmt: skip


def thinned(records: Sequence[Record]) -> list[BenchRun]:
    """In the band."""
    return [thin(motion) for motion in prepare(records).motions]


def test_what_a_channel_cuts_off_is_no_constant() -> None:
    """Of faster runs it hides more, and all on one side."""
    runs = [record(i, pace=0.6 + 0.3 * i) for i in range(4)]
    cut = [replace(each, force=np.maximum(each.force, -40.0)) for each in runs]
    assert all(float(np.mean(each.force == -40.0)) > 0.02 for each in cut[1:])
    smoothed = thinned(cut)
    limits = limits_of(cut)
    assert limits["force_minimum"] == pytest.approx(-40.0, abs=2.0)
    assert constants(smoothed)
    assert constants(apart_from(limits, smoothed)) == {}
    # a constant that is there is still told
    anew = [replace(cut[0], force=np.maximum(runs[0].force + 25.0, -40.0)), *cut[1:]]
    found = constants(apart_from(limits, thinned(anew)))
    assert found["run 0"] - found["run 1"] == pytest.approx(25.0, abs=2.0)


@pytest.mark.parametrize(("through", "anew"), [(True, False), (False, True)])
def test_a_drift_goes_on_through_the_pauses_or_begins_anew(through: bool, anew: bool) -> None:
    """Of a cell that was zeroed anew there are no constants of 300 s times its drift."""
    runs = []
    for i in range(3):
        one = record(i, start=300.0 * i)
        since = one.time if through else TIME
        runs.append(replace(one, force=one.force + 0.4 * since))
    zeros = zeros_of(thinned(runs))
    assert zeros.anew is anew
    assert zeros.constants == {}
    taken = zeros.taken_off(runs)
    assert [each.zeroed for each in taken] == [300.0 * i if anew else None for i in range(3)]
    assert all(new.force is old.force for new, old in zip(taken, runs, strict=True))


def test_a_drift_anew_beside_constants() -> None:
    """Each run has its own zero, and drifts from there."""
    runs = []
    for i, zero in enumerate((12.0, -5.0, -7.0)):
        one = record(i, start=300.0 * i)
        runs.append(replace(one, force=one.force + 0.4 * TIME + zero))
    zeros = zeros_of(thinned(runs))
    assert zeros.anew
    assert list(zeros.constants.values()) == pytest.approx([12.0, -5.0, -7.0], abs=1.0)
    taken = zeros.taken_off(runs)
    left = [float(np.mean(t.force - r.force)) for t, r in zip(taken, runs, strict=True)]
    assert left == pytest.approx([-12.0, 5.0, 7.0], abs=1.0)


def test_where_nothing_is_within_the_limits_there_is_no_constant() -> None:
    smoothed = thinned([record(0), record(1)])
    assert constants(apart_from({"force_minimum": 1e9}, smoothed)) == {}


def test_a_stop_that_some_runs_reach_is_no_constant() -> None:
    """It pushes one way, and so moves the mean force of those that reach it."""
    random = np.random.default_rng(5)

    def stopped(number: int, reach: float, offset: float = 0.0) -> Record:
        speed = 2 * np.pi * np.array([0.5, 1.3]) * (1 + 0.2 * number)
        size = reach * np.array([0.7, 0.3])
        phase = speed[:, None] * TIME + random.uniform(0, 6, 2)[:, None]
        x, a = size @ np.sin(phase), -(size * speed**2) @ np.sin(phase)
        force = 30 * a + 7e3 * np.maximum(x - 0.028, 0.0) + offset
        return Record(
            name=f"run {number}", time=TIME, displacement=x + random.normal(0, 1e-6, x.size),
            force=force + random.normal(0, 0.3, x.size),
        )  # fmt: skip

    reaches = [0.06, 0.05, 0.015]
    assert constants(thinned([stopped(i, reach) for i, reach in enumerate(reaches)])) == {}
    # and those that there are, are found beside it
    offsets = [-20.0, 5.0, 15.0]
    pairs = enumerate(zip(reaches, offsets, strict=True))
    found = constants(thinned([stopped(i, reach, offset) for i, (reach, offset) in pairs]))
    assert list(found.values()) == pytest.approx(offsets, abs=0.5)


def test_an_inertance_along_the_stroke_is_no_constant() -> None:
    """b(x) a + b'(x) v^2 / 2 is the rate of b(x) v less b'(x) v^2 / 2, which has a mean."""
    random = np.random.default_rng(6)

    def uneven(number: int, size: float) -> Record:
        speed = 2 * np.pi * np.array([0.5, 1.7]) * (1 + number)
        sizes = size * np.array([0.7, 0.3])
        phase = speed[:, None] * TIME + random.uniform(0, 6, 2)[:, None]
        x, v = sizes @ np.sin(phase), (sizes * speed) @ np.cos(phase)
        a = -(sizes * speed**2) @ np.sin(phase)
        b, slope = 60 * (1 + 6 * x + 100 * x**2), 60 * (6 + 200 * x)
        force = b * a + 0.5 * slope * v**2
        return Record(
            name=f"run {number}", time=TIME, displacement=x + random.normal(0, 1e-6, x.size),
            force=force + random.normal(0, 0.3, x.size),
        )  # fmt: skip

    assert constants(thinned([uneven(i, size) for i, size in enumerate([0.05, 0.03, 0.01])])) == {}


def test_constants_are_found_and_taken_off() -> None:
    offsets = [-4.0, 6.0, -2.0]
    records = [record(i, offset=offset) for i, offset in enumerate(offsets)]
    found = constants(thinned(records))
    assert list(found.values()) == pytest.approx(offsets, abs=0.4)
    assert constants(thinned(without_constants(records, found))) == {}
    assert "run 1 +6" in constants_in_words(found).replace("+5.9", "+6").replace("+6.0", "+6")


@pytest.mark.parametrize(
    "changes",
    [
        [{}, {}, {}],
        [{"offset": 5.0}] * 3,
        # an offset that grows: a cause, whether the runs share a clock or not
        [{"drift": 0.2}] * 3,
        [{"drift": 0.2, "offset": 0.2 * s, "start": s} for s in (0.0, 20.0, 40.0)],
        # damping that differs between the directions has a mean that grows with the speed
        [{"uneven": 120.0, "pace": pace} for pace in (0.5, 1.0, 2.0)],
        # strokes about other places
        [{"centre": c} for c in (-0.01, 0.0, 0.012)],
    ],
    ids=["none", "common", "drift", "drift through all", "uneven", "places"],
)
def test_what_is_a_cause_is_left_alone(changes: list[dict[str, float]]) -> None:
    assert constants(thinned([record(i, **change) for i, change in enumerate(changes)])) == {}


def test_a_search_does_not_see_the_constants() -> None:
    records = [record(i, offset=offset) for i, offset in enumerate([-4.0, 6.0, -2.0])]
    start = prepared(Given(records=records))
    assert set(start.constants) == {"run 0", "run 1", "run 2"}
    moving = [np.abs(run.velocity) > 0.01 for run in start.data.whole]
    left = [
        np.mean((run.force - 50 * run.acceleration - 30 * run.velocity - 8 * np.sign(run.velocity)
                 - 2e5 * run.displacement**3)[mask & run.inner])
        for run, mask in zip(start.data.whole, moving, strict=True)
    ]  # fmt: skip
    assert left == pytest.approx([0.0] * 3, abs=0.4)


def test_a_run_of_another_device_is_named() -> None:
    records = [record(i, inertance=80.0 if i == 2 else 50.0) for i in range(4)]
    found = contradicting(thinned(records))
    assert list(found) == ["run 2"]
    mine, theirs = (float(part) for part in re.findall(r"([0-9.]+) kg", found["run 2"]))
    assert mine == pytest.approx(80, rel=0.03)
    assert theirs == pytest.approx(50, rel=0.03)


def test_a_contradiction_stands_where_nothing_that_is_found_explains_it() -> None:
    runs = thinned([record(i) for i in range(4)])
    size = [np.sqrt(np.mean(run.force**2)) for run in runs]
    errors = [np.full(run.force.size, 0.05 * each) for run, each in zip(runs, size, strict=True)]
    assert explained(runs, errors, "run 2")
    assert not explained(runs, [3.0 * e if i == 2 else e for i, e in enumerate(errors)], "run 2")
    # more than the others, and next to nothing
    few = [(0.6 if i == 2 else 0.1) * e for i, e in enumerate(errors)]
    assert explained(runs, few, "run 2")


def test_runs_that_agree_contradict_nobody() -> None:
    assert contradicting(thinned([record(i) for i in range(4)])) == {}
    assert contradicting(thinned([record(i, offset=5.0 * i) for i in range(4)])) == {}
    # of two runs nobody knows which one is wrong
    assert contradicting(thinned([record(0), record(1, inertance=80.0)])) == {}


def test_friction_of_runs_that_go_one_way_is_no_constant() -> None:
    """Spin-ups: of one that turns forward and one that turns back friction is all that differs."""
    random = np.random.default_rng(8)

    def spun(name: str, push: float) -> Record:
        speed = push * 20.0 * (1.0 - np.exp(-TIME / 3.0)) + 0.4 * push * np.sin(3.0 * TIME)
        x = np.cumsum(speed) / 200
        force = 0.5 * np.gradient(speed, TIME) + 0.2 * speed + 3.0 * np.sign(speed)
        noise = random.normal(0, 0.02, x.size)
        return Record(name=name, time=TIME, displacement=x, force=force + noise)

    assert constants(thinned([spun("forward", 1.0), spun("back", -1.0)])) == {}


def test_a_run_that_is_met_as_well_as_another_contradicts_none() -> None:
    # of little force, so that its noise is much of it
    runs = thinned([record(i) for i in range(4)])
    errors = [0.02 * r.force for r in runs]
    errors[2] = np.full(runs[2].force.size, 0.9 * float(np.sqrt(np.mean(errors[1] ** 2))))
    assert explained(runs, errors, "run 2")


def test_runs_at_places_apart_have_no_constants() -> None:
    """A force of the place would be one of the run there; where both go, it is told."""
    apart = [record(1, centre=-0.1), record(2, centre=0.1, offset=20.0)]
    assert constants(thinned(apart)) == {}
    here = constants(thinned([record(1), record(2, offset=20.0)]))
    assert here["run 2"] - here["run 1"] == pytest.approx(20.0, abs=1.0)


def loaded(seconds: float, offset: float = 0.0) -> Record:
    """A spring that relaxes, pulled and let go again within some seconds, from one rest."""
    random = np.random.default_rng(round(seconds))
    time = np.linspace(0, 1, 4000) * seconds
    x = 0.08 * np.sin(np.pi * time / seconds) ** 2
    relaxed, steps = np.zeros(time.size), np.diff(x)
    decay = np.exp(-(time[1] - time[0]) / 20.0)
    for i, step in enumerate(steps):
        relaxed[i + 1] = decay * (relaxed[i] + step)
    force = 10 * x + 12 * relaxed + offset + random.normal(0, 1e-3, x.size)
    return Record(
        name=f"{seconds:g} s", time=time, force=force,
        displacement=x + random.normal(0, 1e-6, x.size),
    )  # fmt: skip


@pytest.mark.parametrize("offset", [0.0, 2.0])
def test_runs_that_begin_alike_have_no_constants(offset: float) -> None:
    """What the rate makes of the force is a cause; a cell that shows another zero begins there."""
    found = constants(thinned([loaded(160.0), loaded(54.0), loaded(32.0, offset)]))
    assert bool(found) == bool(offset)


def test_an_uneven_valve_behind_a_spring_has_no_constants_along_sines() -> None:
    """Each run has one frequency, and the mean of its force goes with it."""
    valve = ReferenceDevice(
        inertance=4.0, viscous=2200.0, damping_asymmetry=0.3, damping_knee=0.12,
        damping_beyond=0.25, damper_stiffness=4e5, friction="coulomb", coulomb_force=50.0,
        transition_velocity=1e-3,
    )  # fmt: skip
    runs = measured(
        valve,
        [sine_motion(size, frequency) for size, frequency in ((0.02, 1.5), (0.02, 4), (0.012, 9))],
        np.arange(0, 3, 2e-3),
    )
    assert not constants(thinned(runs))
    # beside a true one each is found
    off = {"run_0": 60.0, "run_1": -60.0, "run_2": 0.0}
    moved = [replace(each, force=each.force + off[each.name]) for each in dampers_alike()]
    found = constants(thinned(moved))
    assert found == pytest.approx(off, abs=3.0)


def dampers_alike() -> list[Record]:
    """Three runs of a damper along motions of several frequencies."""
    damper = ReferenceDevice(inertance=4.0, viscous=2200.0, damping_asymmetry=0.3)
    motions = [
        sum_of_sines([0.01, 0.004, 0.002], [0.7 + i, 2.1, 4.3], [0.0, 1.0, i]) for i in range(3)
    ]
    return measured(damper, motions, np.arange(0, 6, 4e-3))
