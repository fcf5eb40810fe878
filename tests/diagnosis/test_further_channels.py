"""What remains may go with a further column of the records; what happens once is told."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from inerter.diagnose import diagnose_bench
from inerter.diagnose.remainder.further import further_channels, measured_by
from inerter.diagnose.remainder.lines import lines
from inerter.diagnose.remainder.words import summary
from inerter.identify.modulation import modulation
from inerter.identify.runs import whole
from inerter.records import Record
from inerter.records.preparation import prepare
from sines import moved

TIME = np.arange(0, 12, 1 / 400)


def motion(draw: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Displacement, velocity and acceleration of four sines."""
    return moved(draw, TIME, (0.7, 1.3, 2.2, 3.1), 4e-3)


def record(draw: np.random.Generator, name: str, **extra: np.ndarray) -> Record:
    """5 kg beside a damper of 300 N s/m per volt."""
    x, v, a = motion(draw)
    volt = np.where(np.sin(2 * np.pi * TIME / 2.9 + draw.uniform(0, 6)) > 0, 2.0, 0.5)
    return Record(
        name=name, time=TIME, displacement=x + 1e-6 * draw.standard_normal(TIME.size),
        force=5 * a + 300 * volt * v + 0.4 * draw.standard_normal(TIME.size),
        extra={"voltage[V]": volt, "room[degC]": 20 + 0 * volt, "twice": 2 * x, **extra},
    )  # fmt: skip


def test_a_voltage_that_sets_the_damping_is_named(effects_seed: int) -> None:
    draw = np.random.default_rng(effects_seed)
    found = diagnose_bench([record(draw, "one"), record(draw, "two")])
    assert found.unexplained.depends_on[0] == "the channel voltage"
    assert '--scaled-by "voltage"' in found.verdict
    assert found.budget is None or "could be predicted from the motion but" not in found.verdict


def test_channels_that_tell_nothing_of_their_own_are_left_out(effects_seed: int) -> None:
    draw = np.random.default_rng(effects_seed)
    made = [record(draw, "one"), record(draw, "two")]
    runs = [whole(each) for each in prepare(made).motions]
    # one that does not change, one that is the displacement
    found = further_channels(made, runs)
    assert list(found) == ["voltage"]
    assert all(q.min() >= 0.0 and q.max() <= 1.0 for q in found["voltage"])
    # one that a run has not
    made[1] = Record(name="two", time=TIME, displacement=made[1].displacement, force=made[1].force)
    assert further_channels(made, runs) == {}


def test_what_acts_from_elsewhere_is_looked_at(effects_seed: int) -> None:
    """Force and motion together tell it, for it is what is left of the one beside the other."""
    draw = np.random.default_rng(effects_seed)
    found = []
    for name in ("one", "two"):
        x, v, a = motion(draw)
        table, *_ = moved(draw, TIME, (0.5, 1.0, 1.7, 2.7), 1.0)
        force = 20 * a + 60 * v + 3.0 * table + 0.3 * draw.standard_normal(TIME.size)
        extra = {"table[m/s^2]": table, "second cell[N]": force + 0.2 * a}
        noisy = x + 1e-6 * draw.standard_normal(TIME.size)
        found.append(Record(name=name, time=TIME, displacement=noisy, force=force, extra=extra))
    # read as the acceleration of the device, which it is not
    taken = [
        replace(each, extra={}, acceleration=each.extra["table[m/s^2]"],
                headers={"acceleration": "table acc [g]"}) for each in found
    ]  # fmt: skip
    assert list(further_channels(taken, [whole(each) for each in prepare(taken).motions])) == [
        "table acc"
    ]
    assert modulation(taken, "table acc").unit == "m/s^2"
    runs = [whole(each) for each in prepare(found).motions]
    assert list(further_channels(found, runs)) == ["table"]
    told = diagnose_bench(found)
    assert told.unexplained.depends_on[0] == "the channel table"
    assert '--scaled-by "table"' in told.verdict


def test_a_blow_that_comes_once_is_told(effects_seed: int) -> None:
    draw = np.random.default_rng(effects_seed)
    x, v, a = motion(draw)
    blow = 500 * np.exp(-(((TIME - 3.1) / 0.02) ** 2))
    force = 20 * a + 60 * v + 0.3 * draw.standard_normal(TIME.size)
    noisy = x + 1e-6 * draw.standard_normal(TIME.size)
    quiet, struck = (
        diagnose_bench([Record(name="run", time=TIME, displacement=noisy, force=force + each)])
        for each in (0 * blow, blow)
    )
    assert not quiet.method["missed_runs"]
    # in the third of ten blocks, which is none of those that are held out
    assert list(struck.method["missed_runs"]) == ["run about 3.1 s"]
    assert "run about 3.1 s" in struck.verdict


def test_a_line_of_the_motion_is_none_of_its_own() -> None:
    rng = np.random.default_rng(3)
    model = np.sum([30 * np.sin(2 * np.pi * f * TIME + f) for f in (0.7, 1.3, 2.2)], axis=0)
    mask = [np.ones(TIME.size, dtype=bool)]
    noise = 0.1 * rng.standard_normal(TIME.size)
    for frequency, of_motion in ((1.3, True), (1.75, False)):
        rest = 5 * np.sin(2 * np.pi * frequency * TIME) + noise
        found = lines([rest], [model], [1 / 400], mask)
        assert abs(found.frequency - frequency) < 0.03
        assert found.of_motion is of_motion
        assert found.multiple == 0


def test_a_channel_that_tells_what_time_tells_is_named_beside_it() -> None:
    detail = f"and the channel oil tells 44 % too, {measured_by('the channel oil')}"
    text = summary(["time"], {"time": detail}, {"time": 0.66}, 3.0, 1.0, 2.0, False, None)
    assert "record (66 %), and the channel oil tells 44 % too, see `inerter identify" in text
    small = summary([], {}, {}, 1.1, 1.0, 0.0, False, None, too_small=("state", 0.4))
    assert "of any size (0.4 N rms of it go with position, velocity and acceleration" in small
