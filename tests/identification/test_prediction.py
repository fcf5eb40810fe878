"""The force that a model predicts along a run: what is rough is added to what is smooth."""

from __future__ import annotations

import numpy as np
import pytest
from inerter.core import Device
from inerter.identify.model import Model
from inerter.identify.prediction import first_state, force_along, settled
from inerter.identify.runs import BenchRun, thin
from inerter.identify.transient import (
    MOST_SPEEDS,
    without_bending,
    without_relaxing,
    without_transient,
)
from inerter.records import Record
from inerter.records.motion import smooth
from inerter.records.record import Part

TIME = np.arange(0, 8, 1e-3)


@pytest.fixture(scope="module")
def run() -> BenchRun:
    random = np.random.default_rng(5)
    x = 5e-3 * np.sin(2 * np.pi * 1.3 * TIME) + 2e-3 * np.sin(2 * np.pi * 3.1 * TIME)
    force = 60 * np.gradient(np.gradient(x, TIME), TIME)
    noisy = x + 1e-7 * random.standard_normal(TIME.size)
    record = Record(name="run", time=TIME, displacement=noisy, force=force)
    return thin(smooth(record, 20.0))


PLAIN = {"inertance": 60.0, "viscous": 30.0}
DULL = {"coulomb_force": 4.0, "transition_velocity": 1e-3}
DULL_WIDTH = {"transition_velocity": 1e-4}


@pytest.mark.parametrize("friction", ["none", "coulomb"])
@pytest.mark.parametrize(
    "idle",
    [
        {"force_maximum": 1e5},
        {"force_minimum": -1e5, "force_maximum": 1e5},
        {"stop_upper": 0.1, "stop_stiffness": 1e5, "stop_damping": 1.0},
    ],
)
def test_what_is_never_reached_changes_nothing(
    run: BenchRun, friction: str, idle: dict[str, float]
) -> None:
    """A limit must not win by a smoother prediction of everything else."""
    values = PLAIN | (DULL if friction == "coulomb" else {})
    without = force_along(Model(friction, values, ()), run)
    within = force_along(Model(friction, values | idle, ()), run)
    np.testing.assert_allclose(within, without, rtol=0, atol=1e-9)


@pytest.mark.parametrize("friction", ["none", "coulomb"])
def test_a_stop_adds_its_force_in_the_band(run: BenchRun, friction: str) -> None:
    values = PLAIN | (DULL if friction == "coulomb" else {})
    stop = {"stop_upper": 4e-3, "stop_stiffness": 1e5, "stop_damping": 0.0}
    added = force_along(Model(friction, values | stop, ()), run) - force_along(
        Model(friction, values, ()), run
    )
    assert run.measured is not None
    spring = 1e5 * np.maximum(run.measured[0] - 4e-3, 0.0)
    later = run.inner & (run.elapsed > 1.0)  # the device is followed from the run's `first` on
    expected = run.in_band(spring)[later]
    np.testing.assert_allclose(added[later], expected, atol=1e-4 * np.max(spring))


def test_a_limit_cuts_what_is_beyond_it(run: BenchRun) -> None:
    assert run.measured is not None
    _, v, a = run.measured
    whole = 60.0 * a + 30.0 * v
    limit = 0.5 * float(np.max(whole))
    found = force_along(Model("none", PLAIN | {"force_maximum": limit}, ()), run)
    error = (found - run.in_band(np.minimum(whole, limit)))[run.inner]
    assert np.sqrt(np.mean(error**2)) < 0.1 * limit


def test_an_unseen_beginning_is_not_made_up() -> None:
    """Of a transient that has died where samples count, its size at the beginning is unknown."""
    device = Device(inertance=100.0, series_stiffness=4e5, series_damping=800.0)
    random = np.random.default_rng(2)
    residual = random.standard_normal(TIME.size)
    mask = TIME > 3.0  # after exp(-12)
    left = without_transient(device, residual, 1e-3, mask)
    assert np.max(np.abs(left - residual)) < 1.0
    # where it is seen it goes
    decay = np.exp(-4.0 * TIME) * np.cos(np.sqrt(4e3 - 16.0) * TIME)
    left = without_transient(device, residual + 50 * decay, 1e-3, TIME < 8.0)
    assert np.std(left - residual) < 0.1


@pytest.mark.parametrize("damping", [0.0, 800.0, 1.4e4])
def test_a_decay_of_any_damping_is_taken_out(damping: float) -> None:
    """Undamped, damped, overdamped: both motions of b s^2 + c s + k = 0 leave little."""
    device = Device(inertance=100.0, series_stiffness=4e5, series_damping=damping)
    roots = np.roots([100.0, damping, 4e5])
    waves = [np.exp(root * TIME).real for root in roots]
    waves.append(np.exp(roots[0] * TIME).imag)
    mask = (TIME > 0.01) & (np.arange(TIME.size) % 7 > 0)
    for wave in waves:
        left = without_transient(device, 30.0 * wave, 1e-3, mask)
        assert np.max(np.abs(left[mask])) < 0.02 * 30.0


def test_hardly_any_inertance_has_no_oscillation_of_its_own() -> None:
    """Ten newtons are carried by a flywheel of 100 kg, not by one of 0.1 g as quick."""
    wave = 10.0 * np.cos(TIME)
    mask = np.ones(TIME.size, bool)
    heavy, light = (Device(inertance=b, series_stiffness=b) for b in (100.0, 1e-4))
    left = without_transient(heavy, wave, 1e-3, mask, 0.2)
    assert np.max(np.abs(left)) < 0.01
    left = without_transient(light, wave, 1e-3, mask, 0.2)
    assert np.max(np.abs(left - wave)) == pytest.approx(MOST_SPEEDS * 0.2 * 1e-4, rel=0.01)


def test_a_twist_is_one_of_the_run(run: BenchRun) -> None:
    """What a shaft of hardly any stiffness would need to carry the first force is no twist."""
    stroke = float(np.ptp(run.displacement))
    shaft = {"inertance": 1e-9, "series_stiffness": 1e-9, "series_damping": 1e-12}
    states = np.atleast_1d(first_state(Device(**shaft), run))
    assert abs(states[0]) == pytest.approx(10 * stroke)
    assert np.max(np.abs(force_along(Model("none", shaft, ()), run))) < 1e-6
    # a shaft that carries it keeps its twist
    shaft = {"inertance": 60.0, "series_stiffness": 6e4, "series_damping": 60.0}
    states = np.atleast_1d(first_state(Device(**shaft), run))
    assert abs(states[0]) < stroke
    assert Device(**shaft).evaluate(
        run.displacement[run.first], run.velocity[run.first], run.acceleration[run.first], states
    )["total"] == pytest.approx(run.first_force)


def test_a_flywheel_that_turns_as_a_record_begins_is_settled(run: BenchRun) -> None:
    values = {"inertance": 60.0, "series_stiffness": 6e4, "series_damping": 60.0}
    model = Model("none", values, ())
    decay = np.exp(-0.5 * run.elapsed) * np.sin(np.sqrt(1e3 - 0.25) * run.elapsed)
    left = settled(model, run, 20 * decay, np.ones(run.force.size, bool))
    assert np.max(np.abs(left)) < 1.0


def test_branches_that_are_bent_as_a_record_begins_are_settled() -> None:
    """A record cut out of a longer one: the right model leaves nothing, whatever came before."""
    device = Device(
        inertance=60.0, branch_stiffness_1=2e4, branch_damping_1=6e4,
        branch_stiffness_2=5e3, branch_damping_2=1500.0,
    )  # fmt: skip
    x = 5e-3 * np.sin(2 * np.pi * 1.3 * TIME + 1.0) + 2e-3 * np.sin(2 * np.pi * 3.1 * TIME)
    v, a = np.gradient(x, TIME), np.gradient(np.gradient(x, TIME), TIME)
    force = device.along(1e-3, x, v, a)["total"]
    # from a whole second on, both branches bent
    later = Record(
        name="later", time=TIME[1000:], displacement=x[1000:], force=force[1000:]
    )  # fmt: skip
    run = thin(smooth(later, 20.0))
    values = {
        "inertance": 60.0, "branch_stiffness_1": 2e4, "branch_time_1": 3.0,
        "branch_stiffness_2": 5e3, "branch_time_2": 0.3,
    }  # fmt: skip
    model = Model("none", values, ())
    left = run.force - force_along(model, run)
    assert np.std(left[run.inner]) > 5.0
    assert np.std(settled(model, run, left, run.inner)[run.inner]) < 0.1


@pytest.mark.parametrize(("stiffness", "stays"), [(3e-3, 1.0), (6e3, 0.01)])
def test_a_branch_was_bent_by_some_strokes_at_most(
    run: BenchRun, stiffness: float, stays: float
) -> None:
    """One of next to no stiffness would carry any slow force, bent by kilometres."""
    model = Model("none", {"branch_stiffness_1": stiffness, "branch_time_1": 2.0}, ())
    slow = 6.0 * np.exp(-(run.elapsed - run.elapsed[run.first]) / 2.0)
    left = settled(model, run, slow, np.ones(slow.size, np.bool_))[run.first :]
    assert np.linalg.norm(left) == pytest.approx(
        stays * np.linalg.norm(slow[run.first :]), rel=1e-3, abs=1.0
    )


def test_what_branches_were_bent_by_is_not_made_up() -> None:
    """Samples long after a branch has relaxed say nothing of what it was bent by."""
    residual = np.random.default_rng(3).standard_normal(TIME.size)
    left = without_relaxing((0.25,), residual, 1e-3, TIME > 3.0)
    assert np.max(np.abs(left - residual)) < 1.0
    wave = 40.0 * np.exp(-TIME / 0.25)
    left = without_relaxing((0.25, 1.5), residual + wave, 1e-3, TIME < 8.0)
    assert np.std(left - residual) < 0.2


def test_what_came_before_a_part_of_a_record_does_not_count() -> None:
    """Friction before the first sample is not known, and the low-pass of the force remembers it."""
    model = Model("coulomb", {"inertance": 60.0, "coulomb_force": 30.0} | DULL_WIDTH, ())
    begins, rest = [], []
    for phase in np.linspace(0.0, 3.0, 11):
        x = 5e-3 * np.sin(2 * np.pi * 1.3 * TIME + phase) + 2e-3 * np.sin(2 * np.pi * 3.1 * TIME)
        v, a = np.gradient(x, TIME), np.gradient(np.gradient(x, TIME), TIME)
        inside = slice(5, -5)
        run = thin(
            smooth(
                Record(
                    name="run", time=TIME[inside], displacement=x[inside],
                    force=(60 * a + 30 * np.sign(v))[inside], part=Part("whole", 0.0),
                ),
                20.0,
            )
        )  # fmt: skip
        left = np.abs(run.force - force_along(model, run))
        early = run.inner & (np.arange(left.size) < int(np.argmax(run.inner)) + 10)
        begins.append(left[early].max())
        rest.append(left[run.inner & ~early].max())
        # hardly anything of the run is given away
        assert np.mean(run.inner) > 0.9
    # no more than where the motion turns
    assert max(begins) < np.median(rest)


@pytest.mark.parametrize("time", [0.03, 0.25])
def test_a_beginning_that_is_left_out_is_read_off_it(time: float) -> None:
    """A fold with the beginning of a record would else count what no fit can know."""
    wave = 40.0 * np.exp(-TIME / time)
    left = without_relaxing((time,), wave, 1e-3, TIME > 3.0, cutoff=30.0)
    assert np.max(np.abs(left)) < 0.1


@pytest.mark.parametrize(
    ("losses", "root"),
    [
        # b s^2 + c s + k = 0, and behind a leak s^2 + (k / c_l) s + k / b = 0
        ({"series_damping": 1e4}, complex(-41.66666667, 39.96526269)),
        ({"leak_damping": 4000.0}, complex(-50.0, 28.86751346)),
    ],
)
def test_so_is_how_a_flywheel_turned_that_soon_follows(
    losses: dict[str, float], root: complex
) -> None:
    device = Device(inertance=120.0, series_stiffness=4e5, **losses)
    noise = np.random.default_rng(3).standard_normal(TIME.size)
    swing = np.asarray(40.0 * np.exp(root * TIME), np.complex128)
    for wave in (np.real(swing), np.imag(swing)):
        left = without_transient(device, wave, 1e-3, TIME > 3.0)
        assert np.max(np.abs(left)) < 0.1
    left = without_transient(device, noise, 1e-3, TIME > 3.0)
    assert np.max(np.abs(left - noise)) < 1.0


@pytest.mark.parametrize("first", [0, 40])
@pytest.mark.parametrize("later", [0.6, 2.0, 5.0])
def test_so_is_what_a_bristle_was_bent_by(first: int, later: float) -> None:
    """Where the samples that count lie a few lengths on, their errors say nothing of it."""
    path, reach = np.maximum(0.05 * (TIME - TIME[first]), 0.0), 0.01
    wave = 40.0 * np.exp(-path / reach)
    left = without_bending(path, reach, wave, later < TIME, first)
    assert np.max(np.abs(left)) < 0.1
    noise = np.random.default_rng(3).standard_normal(TIME.size)
    left = without_bending(path, reach, noise, later < TIME, first)
    assert np.max(np.abs(left - noise)) < 1.0


def test_what_is_seen_of_a_beginning_alone_tells_how_a_bristle_was_bent() -> None:
    path, reach = 0.05 * TIME, 0.01
    residual = 40.0 * np.exp(-path / reach)
    residual[TIME < 0.1] += 300.0
    left = without_bending(path, reach, residual, TIME >= 0.1)
    assert np.max(np.abs(left[TIME >= 0.1])) < 0.1


def test_what_is_taken_out_of_a_beginning_follows_the_length_of_its_decay() -> None:
    """At a jump of it the search for a shaft, a branch or a bristle would end."""
    seen = TIME >= 0.1
    residual = np.random.default_rng(3).standard_normal(TIME.size)
    residual[~seen] += 50.0

    def left(time: float) -> np.ndarray:
        # b lambda^2 + c_s lambda + k_s = 0 decays in 2 b / c_s
        shaft = Device(inertance=40.0, series_stiffness=1e6, series_damping=80.0 / time)
        return np.array(
            [
                without_transient(shaft, residual, 1e-3, seen),
                without_relaxing([time], residual, 1e-3, seen),
                without_relaxing([time], residual, 1e-3, seen, cutoff=5.0),
                without_bending(0.02 * TIME, 0.02 * time, residual, seen),
            ]
        )[:, seen]

    # about every whole number of samples
    for time in 1e-3 * np.arange(10, 300):
        change = left(time * (1.0 + 1e-6)) - left(time * (1.0 - 1e-6))
        assert np.max(np.abs(change)) < 2e-3


@pytest.mark.parametrize(
    ("law", "own"),
    [
        ("dahl", {"coulomb_force": 20.0, "presliding": 5e-3}),
        ("lugre", {"coulomb_force": 20.0, "presliding": 5e-3}),
        # as of Dahl's law
        ("bouc_wen", {"bw_stiffness": 4e3, "bw_beta": 200.0, "bw_gamma": 0.0}),
    ],
)
@pytest.mark.parametrize("load", [{"load_friction": 0.4}, {"mu_forward": 0.2, "mu_backward": 0.8}])
def test_under_a_load_a_bristle_forgets_more_slowly(
    run: BenchRun, law: str, own: dict[str, float], load: dict[str, float]
) -> None:
    """The force through the inertance is up to five times what the bristle holds without it."""
    model = Model(law, {"inertance": 60.0, **own, **load}, ())
    begun = (0.0, 1e-4)
    forces = [run.along(model.device(), state)["total"] for state in begun]
    change = forces[1] - forces[0]
    left = settled(model, run, change, np.ones(change.size, np.bool_))
    assert np.linalg.norm(left) < 0.03 * np.linalg.norm(change)


def test_the_first_force_is_read_as_late_as_it_is_shown(run: BenchRun) -> None:
    """A bristle 4 ms late begins as the same one in time does."""
    values = {"inertance": 60.0, "coulomb_force": 400.0, "presliding": 0.05}
    soft = Model("dahl", values, ()).device()
    state = {late: float(first_state(soft, run, late=late)) for late in (0.0, 4e-3)}
    there = run.first_force + 4e-3 * float(np.gradient(run.force, run.spacing)[run.first])
    i = run.first
    expected = soft.state_of_force(run.displacement[i], run.velocity[i], run.acceleration[i], there)
    assert state[4e-3] != state[0.0]
    assert state[4e-3] == pytest.approx(float(expected), abs=0.15 * abs(state[4e-3] - state[0.0]))
