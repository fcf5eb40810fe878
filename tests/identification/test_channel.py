"""What the force channel does to a force, against what it says it does."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from inerter.catalogue.coordinates import LOWEST_TONE
from inerter.identify.channel import through_channel, without_tone
from inerter.identify.fit import Problem
from inerter.identify.model import Model
from inerter.identify.prediction import force_along
from inerter.identify.runs import BenchRun, on_clocks, thin
from inerter.records import Record
from inerter.records.preparation import prepare

TIME = np.arange(0, 8, 1e-3)
INERTANCE = 50.0


def record(name: str = "run", start: float = 0.0, **channel: float) -> Record:
    """A device with Coulomb friction along two sines, its force through a channel."""
    wave = [(8e-3, 1.3), (2e-3, 3.7)]
    x, v, a = (
        sum(size * (2 * np.pi * f) ** k * turn(2 * np.pi * f * TIME) for size, f in wave)
        for k, turn in ((0, np.sin), (1, np.cos), (2, lambda angle: -np.sin(angle)))
    )
    elapsed = TIME + start
    level = 6.0 * (1 + channel.get("friction_drift", 0.0) * elapsed)
    force = INERTANCE * a + level * np.tanh(v / 1e-4)
    if amplitude := channel.get("disturbance_amplitude"):
        force = force + amplitude * np.sin(2 * np.pi * channel["disturbance_frequency"] * TIME + 1)
    force = through_channel(channel, force, elapsed, 1e-3)
    return Record(name=name, time=TIME + start, displacement=np.asarray(x), force=force)


def test_what_drifts_counts_from_where_the_channel_was_zeroed() -> None:
    plain = record("two", 300.0)
    drifting = replace(plain, force=plain.force + 0.8 * TIME, zeroed=300.0)
    data = runs(record("one"), drifting)
    model = Model("none", {"inertance": INERTANCE, "force_drift": 0.8}, ("inertance",))
    bare = model.holding(force_drift=0.0)
    more = [force_along(model, run) - force_along(bare, run) for run in data]
    assert more[0][-1] == pytest.approx(0.8 * data[0].elapsed[-1])
    assert more[1] == pytest.approx(0.8 * (data[1].time - 300.0))
    # what else changes slowly goes on through the pause
    assert data[1].elapsed[0] == pytest.approx(300.0)


def runs(*records: Record) -> list[BenchRun]:
    return on_clocks([thin(motion) for motion in prepare(records).motions])


def test_a_drift_is_nothing_at_the_beginning_and_its_rate_later() -> None:
    force = through_channel({"force_drift": 0.5}, np.zeros(5), np.arange(5.0), 1.0)
    assert force == pytest.approx(0.5 * np.arange(5))


def test_a_coupled_channel_lets_a_step_die_away_and_passes_what_is_fast() -> None:
    step = through_channel({"force_coupling": 0.2}, np.ones(TIME.size), TIME, 1e-3)
    assert step == pytest.approx(np.exp(-2 * np.pi * 0.2 * TIME), abs=1e-3)
    for frequency in (0.1, 0.2, 5.0):
        angle = 2 * np.pi * frequency * np.arange(0, 60, 1e-3)
        shown = through_channel({"force_coupling": 0.2}, np.cos(angle), np.zeros(angle.size), 1e-3)
        late = slice(angle.size // 2, None)
        seen = 2 * np.mean(shown[late] * np.exp(-1j * angle[late]))
        assert seen == pytest.approx(1 / (1 - 0.2j / frequency), abs=1e-3)


def test_a_limit_cuts_what_is_beyond_it_and_nothing_else() -> None:
    force = np.linspace(-3, 3, 7)
    values = {"force_maximum": 2.0, "force_minimum": -1.0}
    assert through_channel(values, force, force, 1.0) == pytest.approx([-1, -1, -1, 0, 1, 2, 2])


def test_a_tone_is_taken_out_whatever_its_phase() -> None:
    time = np.arange(0, 3, 1e-3)
    mask = time > 1
    for phase in (0.0, 1.0, 4.0):
        tone = 2.5 * np.cos(2 * np.pi * 7 * time + phase)
        assert without_tone(tone, time, mask, 2.5, 7.0) == pytest.approx(0 * time, abs=2e-2)


def test_runs_share_a_clock_unless_their_times_overlap() -> None:
    after = runs(record("one"), record("two", start=10.0))
    assert [run.clock for run in after] == [0.0, 0.0]
    beside = runs(record("one"), record("two", start=3.0))
    assert [run.clock for run in beside] == [0.0, 3.0]
    assert beside[1].elapsed[0] == 0.0


@pytest.mark.parametrize(
    "hidden",
    [
        {"friction_drift": 0.08},
        {"force_drift": -1.7},
        {"delay": 3e-3},
        {"force_maximum": 24.0, "force_minimum": -27.0},
        {"disturbance_amplitude": 3.0, "disturbance_frequency": 5.3},
    ],
    ids=lambda hidden: next(iter(hidden)),
)
def test_a_fit_finds_what_the_channel_did(hidden: dict[str, float]) -> None:
    data = runs(record("run", 0.0, **hidden))
    problem = Problem(data, [np.ones(run.force.size, bool) for run in data])
    known = {"inertance": INERTANCE, "coulomb_force": 6.0, "transition_velocity": 1e-4}
    start = {name: 0.0 if "drift" in name or name == "delay" else 0.9 * value
             for name, value in hidden.items()}  # fmt: skip
    if "disturbance_frequency" in start:
        start["disturbance_frequency"] = 5.25
    model = Model("coulomb", {**known, **start}, ("inertance", "coulomb_force", *start))
    found = problem.fit(model).model
    for name, value in hidden.items():
        assert found.values[name] == pytest.approx(value, rel=0.02), name
    assert found.values["inertance"] == pytest.approx(INERTANCE, rel=2e-3)
    without = replace(model, values=known)
    inner = problem.masks[0]
    before = np.std((data[0].force - force_along(without, data[0]))[inner])
    assert np.std(problem.residual(found)[0][inner]) < 0.25 * before


@pytest.mark.parametrize("banded", [True, False])
@pytest.mark.parametrize("backlash", [0.0, 1e-3])
def test_a_drift_is_the_laws_and_not_the_loads(banded: bool, backlash: float) -> None:
    (run,) = runs(record())
    if not banded:
        run = replace(run, cutoff=np.inf, measured=None)
    values = {"inertance": INERTANCE, "coulomb_force": 6.0, "transition_velocity": 1e-4}
    if backlash:
        values |= {"backlash": backlash, "series_stiffness": 1e6, "series_damping": 5e3}

    def added(**more: float) -> np.ndarray:
        plain = Model("coulomb", {**values, **more}, ())
        drifting = replace(plain, values={**plain.values, "friction_drift": 0.08})
        return force_along(drifting, run) - force_along(plain, run)

    assert np.max(np.abs(added())) > 2.0
    # what the load adds jumps too, by far more
    assert added(load_friction=0.3) == pytest.approx(added(), abs=1e-6)


def test_a_tone_is_no_offset() -> None:
    (run,) = runs(record())
    shifted = replace(run, force=run.force + 5.0)
    known = {"inertance": INERTANCE, "coulomb_force": 6.0, "transition_velocity": 1e-4}
    tone = {"disturbance_amplitude": 1.0, "disturbance_frequency": 0.3}
    problem = Problem([shifted], [run.inner])
    found = problem.fit(Model("coulomb", {**known, **tone}, tuple(tone))).model
    assert found.values["disturbance_frequency"] >= LOWEST_TONE
    assert abs(np.mean(problem.residual(found)[0][run.inner])) > 4.0


@pytest.mark.parametrize("delay", [0.4e-3, 3.7e-3, -1.5e-3])
def test_a_delay_between_samples_keeps_impacts_whole(delay: float) -> None:
    """Against the same device along the motion as it was that much earlier."""

    def moved(late: float) -> BenchRun:
        angle = 2 * np.pi * 1.3 * (TIME - late)
        rate = 2 * np.pi * 1.3
        waves = np.sin(angle), rate * np.cos(angle), -(rate**2) * np.sin(angle)
        (run,) = runs(record())
        channels = {
            name: 8e-3 * wave
            for name, wave in zip(("displacement", "velocity", "acceleration"), waves, strict=True)
        }
        still = np.zeros(TIME.size)
        every = {"spacing": 1e-3, "thinned": 1, "inner": still == 0, "measured": None}
        return replace(run, **every, **channels, force=still, cutoff=np.inf, first=0)

    play = {"inertance": INERTANCE, "backlash": 1e-3, "series_stiffness": 1e6,
            "series_damping": 5e3, "transition_velocity": 1e-4}  # fmt: skip
    expected = force_along(Model("none", play, ()), moved(delay))
    found = force_along(Model("none", {**play, "delay": delay}, ()), moved(0.0))
    # nothing is known of the motion beyond its ends
    inner = slice(10, -10)
    assert np.max(np.abs(expected)) > 100.0
    assert found[inner] == pytest.approx(expected[inner], abs=1e-3 * np.max(np.abs(expected)))
