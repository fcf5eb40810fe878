"""Long records: searched on stretches, fitted to and judged on everything (bounds made small)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from inerter.diagnose import diagnose_bench, excerpts, rig
from inerter.diagnose.decision import CRITERIA
from inerter.diagnose.everything import followed_as
from inerter.diagnose.excerpts import Excerpts
from inerter.diagnose.other_runs import badly_missed_stretches
from inerter.diagnose.start import Given
from inerter.records import Record

RATE = 500.0


@pytest.fixture(autouse=True)
def _short_is_long(monkeypatch: pytest.MonkeyPatch) -> None:
    bounds = replace(CRITERIA, long_record=20_000, searched_samples=12_000)
    for module in (excerpts, rig):
        monkeypatch.setattr(module, "CRITERIA", bounds)
    monkeypatch.setattr(excerpts, "SHORTEST", 1200)
    monkeypatch.setattr(excerpts, "PERIODS", 6.0)
    monkeypatch.setattr(excerpts, "LEAST_RATE", RATE)


class Bench:
    """A motion between 0.5 and 8 Hz, and what a device makes of it."""

    def __init__(self, random: np.random.Generator, samples: int, rate: float = RATE) -> None:
        self.random, self.time = random, np.arange(samples) / rate
        frequency = np.fft.rfftfreq(samples, 1 / rate)
        band = (frequency > 0.5) & (frequency < 8.0)
        spectrum = np.zeros(frequency.size, complex)
        phase = random.uniform(0, 2 * np.pi, band.sum())
        spectrum[band] = np.exp(1j * phase) / (1 + (frequency[band] / 2) ** 2)
        omega = 2j * np.pi * frequency
        size = 8e-3 / np.fft.irfft(spectrum, samples).std()
        self.x, self.v, self.a = (
            size * np.fft.irfft(omega**order * spectrum, samples) for order in range(3)
        )

    def record(self, force: np.ndarray, name: str = "run") -> Record:
        """As measured, with noise."""
        return Record(
            name=name, time=self.time,
            displacement=self.x + self.random.normal(0, 1e-6, force.size),
            force=force + self.random.normal(0, 0.5, force.size),
        )  # fmt: skip


@pytest.fixture
def random(effects_seed: int) -> np.random.Generator:
    """Everything is drawn from the printed seed."""
    return np.random.default_rng([effects_seed, 41])


def stretches(records: Sequence[Record], holdout: Sequence[str] = ()) -> Excerpts | None:
    """What would be searched on."""
    return excerpts.excerpts(Given(records=records, holdout=holdout))


def test_short_records_are_searched_whole(random: np.random.Generator) -> None:
    bench = Bench(random, 19_000)
    assert stretches([bench.record(50 * bench.a)]) is None


def test_what_is_found_is_fitted_to_everything(random: np.random.Generator) -> None:
    bench = Bench(random, 60_000)
    level, damping = random.uniform(15, 40), random.uniform(40, 120)
    inertance = random.uniform(40, 80)
    # slow: the level falls all the time, which every stretch tells with its place in time
    fall = random.uniform(0.15, 0.4) / bench.time[-1]
    force = inertance * bench.a + damping * bench.v
    force = force + level * (1 - fall * bench.time) * np.sign(bench.v)
    found = diagnose_bench([bench.record(force)])
    assert {f.effect for f in found.findings} == {"friction_drift", "viscous_friction"}
    true = {"coulomb_force": level, "friction_drift": -fall, "viscous": damping}
    for name, value in true.items():
        told = found.parameters[name]
        assert abs(told.value - value) < max(4 * told.stderr, 0.02 * abs(value)), name
        assert told.stderr < 0.05 * abs(value), name
    # three blocks of ten are held out, less what the ends of the record leave unsure
    assert 0.28 < found.method["held_out_samples"] / bench.time.size < 0.31
    assert found.method["searched_samples"] < 16_000
    assert found.curves[0].time.size == bench.time.size
    # the chain of gains ends where the extended model is
    assert found.findings[-1].rmse_after == pytest.approx(found.extended.rmse, rel=1e-9)
    assert found.findings[0].rmse_before == pytest.approx(found.baseline.rmse, rel=1e-9)
    assert found.records[0].samples == bench.time.size
    assert "stretches among which" in " ".join(found.notes)


def test_what_happens_once_is_searched(random: np.random.Generator) -> None:
    bench = Bench(random, 60_000)
    # an end stop that is met in one place of the record alone
    met = int(random.integers(5_000, 15_000))
    near = slice(met - 2000, met + 2000)
    limit = 0.9 * bench.x[near].max()
    past = np.zeros_like(bench.x)
    past[near] = np.maximum(bench.x[near] - limit, 0.0)
    blow = 4e5 * past
    found = stretches([bench.record(50 * bench.a + 20 * np.sign(bench.v) + blow)])
    assert found is not None
    peak = int(np.argmax(blow))
    searched = [found.possible[i] for i in found.chosen]
    assert any(s.begin <= peak < s.end for s in searched)


def test_stretches_that_are_missed_are_added(random: np.random.Generator) -> None:
    bench = Bench(random, 60_000)
    found = stretches([bench.record(50 * bench.a)])
    assert found is not None
    errors = np.ones(bench.time.size)
    assert found.with_missed([errors]) is None
    left = [
        i for i, s in enumerate(found.possible) if i not in found.chosen and not s.held
    ]  # fmt: skip
    bad = found.possible[int(random.choice(left))]
    errors[bad.begin : bad.end] = 5.0
    more = found.with_missed([errors])
    assert more is not None
    assert [found.possible[i] for i in set(more.chosen) - set(found.chosen)] == [bad]


def test_what_is_held_out_has_no_say(random: np.random.Generator) -> None:
    bench = Bench(random, 60_000)
    found = stretches([bench.record(50 * bench.a)])
    assert found is not None
    errors = np.ones(bench.time.size)
    for stretch in found.possible:
        if stretch.held:
            errors[stretch.begin : stretch.end] = 9.0
    assert found.with_missed([errors]) is None
    given = found.given
    held = [record for record in given.records if record.name in given.holdout]
    assert 0.2 < len(held) / len(given.records) < 0.4
    # blocks 4, 7 and 9 of ten of what is known of the motion
    for record in given.records:
        block = int(10 * record.time[record.samples // 2] / bench.time[-1])
        assert (block in {3, 6, 8}) == (record.name in given.holdout)


def test_runs_are_held_out_whole(random: np.random.Generator) -> None:
    runs = []
    for i in range(4):
        bench = Bench(random, 15_000)
        force = 50 * bench.a + 20 * np.sign(bench.v) + 40 * bench.v
        runs.append(bench.record(force, f"run_{i}"))
    found = stretches(runs, ["run_2"])
    assert found is not None
    parts = {r.name for r in found.given.records if r.part and r.part.run == "run_2"}
    assert parts == set(found.given.holdout)
    diagnosis = diagnose_bench(runs, holdout=["run_2"])
    assert {f.effect for f in diagnosis.findings} == {"coulomb_friction", "viscous_friction"}
    assert [r.role for r in diagnosis.records] == ["fit", "fit", "holdout", "fit"]
    assert diagnosis.method["split"] == "held out: run_2"
    assert diagnosis.parameters["viscous"].value == pytest.approx(40, rel=0.03)


def test_dense_samples_are_averaged(random: np.random.Generator) -> None:
    bench = Bench(random, 64_000, 16 * RATE)
    found = stretches([bench.record(50 * bench.a)])
    assert found is not None
    assert found.every[0] in range(4, 17)
    (coarse,) = found.given.records
    assert coarse.samples == bench.time.size // found.every[0]
    # means at their own instants: no delay of one channel against the other
    at = np.interp(coarse.time, bench.time, bench.x)
    assert np.max(np.abs(coarse.displacement - at)) < 1e-5
    force = 50 * bench.a + 20 * np.sign(bench.v)
    diagnosis = diagnose_bench([bench.record(force)])
    assert [f.effect for f in diagnosis.findings] == ["coulomb_friction"]
    assert diagnosis.parameters["coulomb_force"].value == pytest.approx(20, rel=0.02)
    # noise of single samples, not of their means
    assert diagnosis.noise_floor > 0.45


def test_parts_keep_the_clock_of_their_run(random: np.random.Generator) -> None:
    bench = Bench(random, 60_000)
    found = stretches([bench.record(50 * bench.a)])
    assert found is not None
    assert {r.part.clock for r in found.given.records if r.part} == {0.0}
    assert max(record.time[0] for record in found.given.records) > 100.0


def test_a_stretch_in_which_something_happened_is_told(random: np.random.Generator) -> None:
    bench = Bench(random, 60_000)
    found = stretches([bench.record(50 * bench.a)])
    assert found is not None
    errors = random.normal(0, 1.0, bench.time.size)
    size = float(np.std(found.records[0].force))
    fitted = [s for s in found.possible if not s.held]
    bad = fitted[int(random.integers(len(fitted)))]
    for share, told in ((0.02, False), (0.2, True)):
        errors[bad.begin : bad.end] = share * size
        missed = badly_missed_stretches(found, [errors], 1.0, 1.0)
        assert bool(missed) == told
    ((name, error),) = missed.items()
    assert error == pytest.approx(0.2 * size)
    assert f"run from {bench.time[bad.begin]:.4g} to" in name
    # of what is held out its own errors tell
    errors[:] = 1.0
    held = next(s for s in found.possible if s.held)
    errors[held.begin : held.end] = size
    assert badly_missed_stretches(found, [errors], 1.0, 1.0) == {}


def test_a_gap_moves_no_stretch(random: np.random.Generator) -> None:
    bench = Bench(random, 60_000)
    made = bench.record(50 * bench.a)
    # 20 s were not stored
    kept = (bench.time < 30.0) | (bench.time > 50.0)
    columns = {name: values[kept] for name, values in made.channels().items()}
    found = stretches([replace(made, time=made.time[kept], **columns)])
    assert found is not None
    for stretch in found.possible:
        times = found.records[0].time[found.rows(stretch)]
        # one may reach into the gap, and has nothing there
        assert times[0] > (stretch.begin - 0.6) / RATE
        assert times[-1] < (stretch.end - 0.4) / RATE
        assert times.size > 0.5 * (stretch.end - stretch.begin)
    assert max(s.end for s in found.possible) > 55_000


@pytest.mark.parametrize(("instants", "expected"), [(1, [1, 1]), (4, [4, 1]), (8, [8, 2])])
def test_everything_is_followed_as_often_as_its_stretches(
    instants: int, expected: list[int]
) -> None:
    """Of the second run a sample of a stretch is the mean of five."""
    time = np.arange(10.0)
    records = [Record(name=n, time=time, displacement=time, force=time) for n in ("a", "b")]
    found = Excerpts(
        whole=Given(records=records), records=records, holdout=(), constants={}, contradicting={},
        clocks=[0.0, 0.0], spacings=[1.0, 1.0], every=[1, 5],
    )  # fmt: skip
    told = followed_as(found, instants).records
    assert [record.instants for record in told] == expected
