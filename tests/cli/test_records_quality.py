"""Doubtful records: each warning appears when its cause is planted, and only then."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from inerter.records import Record, VehicleRecord, check_records, read_records
from inerter.records.quality import find_inconsistent_motion, outlier_rows

RATE = 1000.0
INERTANCE = 60.0


def bench(
    seed: int = 0,
    samples: int = 4000,
    *,
    motion: str = "multisine",
    viscous: float = 80.0,
    coulomb: float = 0.0,
    stiffness: float = 0.0,
    inertance: float = INERTANCE,
    noise: float = 1.0,
    x_noise: float = 1e-6,
    extra: bool = False,
) -> Record:
    """A device moved by sines of known derivatives; noise: standard deviations, N and m."""
    rng = np.random.default_rng(seed)
    time = np.arange(samples) / RATE
    tones = {"multisine": (1.0, 2.3, 3.7, 5.9), "sine": (2.0,), "slow": (0.3,)}[motion]
    x, v, a = np.zeros((3, samples))
    for frequency in tones:
        w, phase = 2 * np.pi * frequency, rng.uniform(0, 2 * np.pi)
        size = 0.03 / frequency
        x += size * np.sin(w * time + phase)
        v += size * w * np.cos(w * time + phase)
        a -= size * w**2 * np.sin(w * time + phase)
    force = inertance * a + viscous * v + stiffness * x + coulomb * np.tanh(v / 1e-3)
    measured = {"velocity": v + 1e-4 * rng.standard_normal(samples), "acceleration": a}
    return Record(
        name="bench",
        time=time,
        displacement=x + x_noise * rng.standard_normal(samples),
        force=force + noise * rng.standard_normal(samples),
        **(measured if extra else {}),  # type: ignore[arg-type]
    )


def codes(record: Record) -> list[str]:
    (checked,) = check_records([record])
    return [warning.code for warning in checked.warnings]


def with_force(record: Record, force: np.ndarray) -> Record:
    return dataclasses.replace(record, force=force)


CLEAN = {
    "multisine": {},
    "measured velocity and acceleration": {"extra": True},
    "one sine": {"motion": "sine"},
    "friction": {"coulomb": 200.0},
    "friction without noise": {"coulomb": 200.0, "noise": 0.0, "x_noise": 0.0},
    "a spring that wins": {"stiffness": 1e5, "viscous": 2.0},
    "a spring alone": {"stiffness": 1e5, "inertance": 0.0, "viscous": 0.0},
    "a damper alone": {"inertance": 0.0},
    "friction alone": {"inertance": 0.0, "viscous": 0.0, "coulomb": 300.0},
    "ideal": {"viscous": 0.0},
    "noisy force": {"noise": 100.0},
    "noisy displacement": {"x_noise": 3e-4},
    "slow": {"motion": "slow", "samples": 20000},
}


@pytest.mark.parametrize("name", CLEAN)
@pytest.mark.parametrize("seed", range(5))
def test_no_warning_on_a_clean_record(name: str, seed: int) -> None:
    assert codes(bench(seed, **CLEAN[name])) == []


@settings(max_examples=60, deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1),
    viscous=st.floats(0.0, 500.0),
    coulomb=st.floats(0.0, 500.0),
    stiffness=st.floats(0.0, 2e4),
    noise=st.floats(0.0, 50.0),
    motion=st.sampled_from(["multisine", "sine"]),
)
def test_no_warning_on_any_passive_device(
    seed: int, viscous: float, coulomb: float, stiffness: float, noise: float, motion: str
) -> None:
    # one sine cannot tell a spring from an inerter of the wrong sign: keep damping there
    if motion == "sine":
        stiffness, viscous = 0.0, viscous + 20.0
    record = bench(
        seed, viscous=viscous, coulomb=coulomb, stiffness=stiffness, noise=noise, motion=motion
    )
    assert codes(record) == []


@pytest.mark.parametrize("counts", [4, 40])
def test_no_warning_on_quantised_channels(counts: int) -> None:
    # steps of 1/2000 and 1/200 of the force range, and a slow motion with rounded tops
    record = bench(motion="slow", samples=20000, noise=0.0)
    step = np.ptp(record.force) / (8000 / counts)
    assert codes(with_force(record, np.round(record.force / step) * step)) == []


def test_dips_of_friction_at_a_standstill_are_no_outliers() -> None:
    # forward for four seconds, then back; in between the velocity just touches zero and the
    # force dips for two samples to the level it has the other way
    time = np.arange(8000) / RATE
    way = np.where(time < 4.0, 1.0, -1.0)
    velocity = way * (0.02 * (1.0 - np.cos(2 * np.pi * time)) - 1e-6)
    x = np.cumsum(velocity) / RATE
    force = 100.0 * np.tanh(velocity / 1e-7) + np.random.default_rng(0).standard_normal(8000)
    record = Record(name="creep", time=time, displacement=x, force=force)
    assert len(outlier_rows(force)) > 0
    assert codes(record) == []


def test_a_spring_at_rest_at_the_ends_of_strokes_is_not_clipping() -> None:
    time = np.arange(6000) / RATE
    x = 0.05 * np.interp(time % 1.0, [0.0, 0.4, 0.5, 0.9, 1.0], [0.0, 1.0, 1.0, 0.0, 0.0])
    record = Record(name="strokes", time=time, displacement=x, force=8000.0 * x)
    assert "clipping" not in codes(record)


def test_part_of_a_stroke_tells_no_sign() -> None:
    record = bench(stiffness=2e4, motion="slow", samples=2000)
    assert codes(with_force(record, -record.force)) == []


def test_plateaus_of_dry_friction_are_not_clipping() -> None:
    # strokes at constant speed with dwells, force from friction alone, no noise
    time = np.arange(6000) / RATE
    phase = (time % 1.0) / 1.0
    x = 0.05 * np.interp(phase, [0.0, 0.4, 0.5, 0.9, 1.0], [0.0, 1.0, 1.0, 0.0, 0.0])
    force = 50.0 * np.sign(np.gradient(x))
    record = Record(name="strokes", time=time, displacement=x, force=force)
    assert codes(record) == []


# --- planted causes ----------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["displacement", "force", "velocity", "acceleration"])
def test_constant_channel(name: str) -> None:
    record = bench(extra=True)
    record = dataclasses.replace(record, **{name: np.full(record.samples, 4.2)})
    (checked,) = check_records([record])
    found = [w.text for w in checked.warnings if w.code == "constant_channel"]
    assert len(found) == 1
    assert repr(name) in found[0]
    assert "4.2" in found[0]


def test_lost_rows() -> None:
    record = bench()
    keep = np.ones(record.samples, dtype=bool)
    keep[[500, 501, 502, 900, 2000]] = False
    part = Record(
        name="r", time=record.time[keep], displacement=record.displacement[keep],
        force=record.force[keep],
    )  # fmt: skip
    (checked,) = check_records([part])
    assert [w.code for w in checked.warnings] == ["missing_samples"]
    assert "about 5 samples" in checked.warnings[0].text
    assert "3 gaps" in checked.warnings[0].text


@pytest.mark.parametrize("jitter", [0.1, 0.3])
def test_nonuniform_sampling(jitter: float) -> None:
    record = bench()
    rng = np.random.default_rng(1)
    time = record.time + jitter / RATE * rng.uniform(-1, 1, record.samples)
    assert codes(dataclasses.replace(record, time=time)) == ["nonuniform_sampling"]


def test_times_with_few_digits_are_uniform() -> None:
    record = bench()
    assert codes(dataclasses.replace(record, time=np.round(record.time / 1.024, 6))) == []


@settings(max_examples=40, deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1),
    name=st.sampled_from(["force", "displacement"]),
    size=st.floats(0.3, 5.0),
    width=st.integers(1, 3),
    count=st.integers(1, 8),
)
def test_outliers(seed: int, name: str, size: float, width: int, count: int) -> None:
    record = bench(seed % 7)
    # a spike of the force that stays in the usual range may be friction at a standstill
    size = max(size, 1.2) if name == "force" else size
    values = getattr(record, name).copy()
    rng = np.random.default_rng(seed)
    places = 40 + 400 * rng.choice(9, count, replace=False)
    spike = size * np.ptp(values)
    planted = [p + k for p in places for k in range(width)]
    for p in places:
        values[p : p + width] += spike * rng.choice([-1.0, 1.0])
    assert sorted(outlier_rows(values)) == sorted(planted)
    found = codes(dataclasses.replace(record, **{name: values}))
    assert "outliers" in found
    assert not {"clipping", "sign_flip", "constant_channel"} & set(found)


@pytest.mark.parametrize(("level", "noise"), [(0.5, 0.0), (0.8, 0.0), (0.95, 0.0), (0.98, 0.0),
                                              (0.5, 5.0), (0.8, 5.0)])  # fmt: skip
@pytest.mark.parametrize("sides", ["both", "upper", "lower"])
def test_clipping(level: float, sides: str, noise: float) -> None:
    record = bench(motion="sine", noise=noise)
    limit = level * np.max(np.abs(record.force))
    low = -np.inf if sides == "upper" else -limit
    high = np.inf if sides == "lower" else limit
    assert codes(with_force(record, np.clip(record.force, low, high))) == ["clipping"]


def test_clipping_of_a_quantised_channel() -> None:
    record = bench(motion="sine", noise=0.0)
    limit = 0.8 * np.max(np.abs(record.force))
    force = np.round(np.clip(record.force, -limit, limit) / (limit / 2048)) * (limit / 2048)
    assert codes(with_force(record, force)) == ["clipping"]


@pytest.mark.parametrize("motion", ["multisine", "sine"])
@pytest.mark.parametrize("options", [{}, {"coulomb": 100.0}, {"viscous": 0.0}, {"noise": 30.0}])
@pytest.mark.parametrize("name", ["force", "displacement"])
def test_sign_flip(motion: str, options: dict[str, float], name: str) -> None:
    record = bench(motion=motion, **options)  # type: ignore[arg-type]
    flipped = dataclasses.replace(record, **{name: -getattr(record, name)})
    assert codes(flipped) == ["sign_flip"]


def test_sign_flip_of_a_device_without_inertance() -> None:
    record = bench(inertance=0.0, coulomb=200.0)
    assert codes(with_force(record, -record.force)) == ["sign_flip"]


@pytest.mark.parametrize("name", ["velocity", "acceleration"])
def test_sign_flip_of_a_derivative(name: str) -> None:
    record = bench(extra=True)
    record = dataclasses.replace(record, **{name: -getattr(record, name)})
    (checked,) = check_records([record])
    assert [w.code for w in checked.warnings] == ["sign_flip"]
    assert repr(name) in checked.warnings[0].text


def test_time_in_milliseconds_without_unit() -> None:
    record = bench()
    (checked,) = check_records([dataclasses.replace(record, time=1e3 * record.time)])
    assert [w.code for w in checked.warnings] == ["unit_suspect"]
    assert "time[ms]" in checked.warnings[0].text


def test_time_far_too_fast() -> None:
    record = bench()
    assert "unit_suspect" in codes(dataclasses.replace(record, time=1e-6 * record.time))


def test_displacement_in_millimetres_without_unit() -> None:
    record = bench()
    record = dataclasses.replace(record, displacement=1e3 * record.displacement)
    (checked,) = check_records([record])
    assert [w.code for w in checked.warnings] == ["unit_suspect"]
    assert "displacement[mm]" in checked.warnings[0].text


@pytest.mark.parametrize(
    ("name", "factor"),
    [("acceleration", 1 / 9.80665), ("velocity", 1e3), ("displacement", 1e-3)],
)
def test_channels_in_different_units(name: str, factor: float) -> None:
    record = bench(extra=True)
    record = dataclasses.replace(record, **{name: factor * getattr(record, name)})
    assert set(codes(record)) == {"unit_suspect"}


def test_duplicate_records() -> None:
    first, second = bench(1), bench(2)
    shifted = dataclasses.replace(first, name="copy", time=first.time + 100.0)
    rounded = with_force(second, np.round(second.force, 4))
    checked = check_records([first, second, shifted, bench(3), rounded])
    assert [[w.code for w in r.warnings] for r in checked] == [
        [], [], ["duplicate_record"], [], ["duplicate_record"],
    ]  # fmt: skip
    assert "'bench'" in checked[2].warnings[0].text


def test_copies_of_vehicle_records_are_told() -> None:
    random = np.random.default_rng(4)
    time, road, body = np.arange(500) / 100.0, *random.standard_normal((2, 500))
    drive = VehicleRecord(name="drive", time=time, road=road, body_acceleration=body)
    copy = dataclasses.replace(drive, name="copy")
    other = dataclasses.replace(drive, name="other", body_acceleration=-body)
    found = [[w.code for w in r.warnings] for r in check_records([drive, copy, other])]
    assert found == [[], ["duplicate_record"], []]


def test_repeated_motion_with_another_force_is_no_duplicate() -> None:
    first = bench(1)
    again = with_force(first, first.force + np.random.default_rng(0).standard_normal(4000))
    assert all(r.warnings == () for r in check_records([first, again]))


def test_records_are_returned_and_never_changed() -> None:
    record = bench()
    flipped = with_force(record, -record.force)
    (checked,) = check_records([flipped])
    assert flipped.warnings == ()
    np.testing.assert_array_equal(checked.force, flipped.force)


def test_reading_warns(tmp_path: Path) -> None:
    record = bench()
    text = "time,displacement,force\n" + "\n".join(
        f"{t:.3f},{x:.9f},{-f:.6f}"
        for t, x, f in zip(record.time, record.displacement, record.force, strict=True)
    )
    for name in ("a", "b"):
        (tmp_path / f"{name}.csv").write_text(text)
    found = [[w.code for w in r.warnings] for r in read_records(tmp_path)]
    assert found == [["sign_flip"], ["sign_flip", "duplicate_record"]]
    assert all(r.warnings == () for r in read_records(tmp_path, check=False))


@pytest.mark.parametrize("rate", [500.0, 1370.0, 10000.0])
def test_a_right_acceleration_is_not_doubted_at_any_rate(rate: float) -> None:
    """A slow motion sampled fast: 40 mm in steps of 3 um, noise of 2.4 um."""
    time = np.arange(0, 10, 1 / rate)
    turn = 2 * np.pi * 1.18
    random = np.random.default_rng(1)
    x = 0.04 * np.sin(turn * time) + random.normal(0, 2.4e-6, time.size)
    x = np.round(x / 3.05e-6) * 3.05e-6
    a = -(turn**2) * 0.04 * np.sin(turn * time) + random.normal(0, 0.02, time.size)
    record = Record(name="a", time=time, displacement=x, force=400 * a, acceleration=a)
    assert not find_inconsistent_motion(record).warnings
    wrong = dataclasses.replace(record, acceleration=a / 9.81)
    assert [w.code for w in find_inconsistent_motion(wrong).warnings] == ["unit_suspect"]


@pytest.mark.parametrize(("header", "asked"), [("time", True), ("time [s]", False)])
def test_a_slow_clock_is_doubted_where_its_unit_was_not_given(
    tmp_path: Path, header: str, asked: bool
) -> None:
    path = tmp_path / "slow.csv"
    angle = np.arange(200) / 9.0
    table = np.column_stack([np.arange(200.0), 5e-3 * np.sin(angle), 40.0 * np.cos(angle)])
    np.savetxt(path, table, "%.6g", ",", header=f"{header},displacement,force", comments="")
    (record,) = read_records(path)
    told = [each.text for each in record.warnings if each.code == "unit_suspect"]
    assert bool(told) is asked, told
    assert all("is 'time' in ms?" in each for each in told)
