"""Identification from records: the truth is found, with errors that hold."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from inerter import Device, parallel_steps
from inerter.core import DeviceError
from inerter.identify.estimate import identify
from inerter.identify.fit import Problem, parameter_errors
from inerter.identify.identifiability import identifiability
from inerter.identify.laws import law_named
from inerter.identify.model import Model
from inerter.identify.multistart import search
from inerter.identify.prediction import first_state
from inerter.identify.profile import profile_interval
from inerter.identify.split import BLOCKS, HELD_OUT_BLOCKS
from inerter.records import Record, check_records
from random_devices import LAWS, drawn, found
from three_sines import H, N, motion, run_of


def problem(device: Device, noise: float, scale: float = 1.0, seed: int = 0) -> Problem:
    """One run of a device with noise on the force alone."""
    x, v, a = motion(scale)
    random = np.random.default_rng(seed)
    start = device.state_of_force(x[0], v[0], a[0], 0.0) if device.nstate else 0.0
    force = device.along(H, x, v, a, start)["total"] + noise * random.standard_normal(N)
    return Problem([run_of(force, (x, v, a))], [np.ones(N, bool)])


@pytest.mark.often("ideal", "viscous", "coulomb")
@pytest.mark.parametrize("law", LAWS)
def test_a_device_of_each_law_is_recovered(law: str) -> None:
    case = drawn(law, 3)
    result = found(case, law)
    # raw errors are the noise of the force, and of an acceleration from 1 um of noise on the
    # displacement: integral of the smoother's response, see `inerter.records.motion`
    density = 2e-12 / min(record.sample_rate for record in case.records)
    shaken = (2 * np.pi) ** 2 * np.sqrt(density * result.cutoff**5 * np.pi / 18)
    assert result.rmse < 1.3 * np.hypot(case.noise, case.parameters["inertance"] * shaken)
    for name, truth in case.parameters.items():
        each = result.parameters[name]
        assert abs(each.value - truth) < 4 * each.stderr, (name, each, truth)
    known = [p for n, p in result.parameters.items() if n in ("inertance", "coulomb_force")]
    assert all(each.stderr < 0.1 * each.value for each in known)


def test_the_right_law_has_the_smallest_error_on_data_not_seen() -> None:
    case = drawn("dahl", 5)
    result = identify(case.records, ["ideal", "viscous", "dahl"], intervals="normal")
    assert result.best.law == "dahl"
    assert [each.law for each in result.results] == ["dahl", "viscous", "ideal"]
    # what was held out is said, and was not fitted
    (held,) = [i for i, mask in enumerate(result.split.holdout) if mask.any()]
    assert not result.split.fit[held].any()
    assert result.json()["records"][held]["role"] == "holdout"


def test_every_start_of_a_hysteretic_law_leads_to_one_minimum_or_says_so() -> None:
    case = drawn("bouc_wen", 6)
    result = found(case, "bouc_wen")
    near = [end for end in result.ends if end < 1.01 * result.ends[0]]
    assert len(near) > 1 or any("only one start" in note for note in result.notes)


@pytest.mark.parametrize(
    ("device", "law"),
    [
        (Device(inertance=50, viscous=100, friction="lugre", coulomb_force=20, static_force=30,
                stribeck_velocity=0.02, bristle_stiffness=1e4, bristle_damping=50), "lugre"),
        (Device(inertance=50, viscous=100, series_stiffness=3e5, series_damping=900),
         "viscous+series"),
        (Device(inertance=50, viscous=100, friction="bouc_wen", bw_stiffness=1e4, bw_beta=3000,
                bw_gamma=2000, bw_exponent=1.4), "bouc_wen"),
    ],
)  # fmt: skip
def test_derivatives_are_those_of_the_residual(device: Device, law: str) -> None:
    """Forward differences against extrapolated central ones, a tenth of the step and more."""
    data = problem(device, 0.1)
    model = search(data, law_named(law), {}).best.model
    jacobian = data.jacobian(model)

    def residual(step: np.ndarray) -> np.ndarray:
        return data.residual(data.moved(model, step))[0]

    for i, name in enumerate(model.free):
        move = np.zeros(len(model.free))
        rows = []
        for h in (4e-4, 2e-4):
            move[i] = h
            rows.append((residual(move) - residual(-move)) / (2 * h))
        exact = (4 * rows[1] - rows[0]) / 3
        size = np.sqrt(np.mean(exact**2))
        # at the first samples a state's limit makes a corner of the derivative
        assert np.sqrt(np.mean((jacobian[:, i] - exact)[100:] ** 2)) < 2e-3 * size, name


def test_profile_of_a_linear_parameter_is_the_normal_interval() -> None:
    data = problem(Device(inertance=50, viscous=100), 0.5)
    fit = data.fit(Model("none", {"inertance": 40.0, "viscous": 50.0}, ("inertance", "viscous")))
    jacobian = data.jacobian(fit.model)
    naive = np.linalg.inv(jacobian.T @ jacobian) * np.mean(fit.residual[0] ** 2)
    for i, name in enumerate(fit.model.free):
        error = float(np.sqrt(naive[i, i]) * data.units(fit.model)[i])
        value = fit.model.values[name]
        low, high = profile_interval(data, fit.model, lambda m, n=name: m.values[n], error, 1.0)
        assert low == pytest.approx(value - 1.96 * error, abs=0.03 * error)
        assert high == pytest.approx(value + 1.96 * error, abs=0.03 * error)


@pytest.mark.parametrize("stiffness", [1e8, 1e10])
def test_an_interval_is_open_where_the_data_set_no_end(stiffness: float) -> None:
    """Bristles that yield within a fraction of the noise could be as stiff as they like."""
    truth = Device(inertance=50, viscous=100, friction="dahl", coulomb_force=20,
                   bristle_stiffness=stiffness)  # fmt: skip
    data = problem(truth, 60.0)
    fit = search(data, law_named("dahl"), {}).best
    _, error = parameter_errors(fit)["bristle_stiffness"]
    low, high = profile_interval(
        data, fit.model, lambda m: float(m.device().bristle_stiffness), error, 1.0
    )
    assert high is None
    assert low is not None
    assert low < stiffness


def test_bouc_wen_names_what_cannot_be_told_apart() -> None:
    truth = Device(inertance=50, viscous=100, friction="bouc_wen", bw_stiffness=1e4, bw_beta=300,
                   bw_gamma=200)  # fmt: skip
    data = problem(truth, 0.2)
    model = search(data, law_named("bouc_wen"), {}).best.model
    told = identifiability(data, model, 1.0)
    (group,) = [g for g in told.groups if "bw_alpha" in g]
    assert "bw_stiffness" in group
    # of the two only the product is known
    product = next(c for c in told.combinations if c.expression == "bw_stiffness bw_alpha")
    assert product.value == pytest.approx(1e4, rel=0.05)
    assert product.relative_error < 0.05


def test_lugre_far_from_sliding_is_a_spring() -> None:
    truth = Device(inertance=5, viscous=10, friction="lugre", coulomb_force=500, static_force=700,
                   stribeck_velocity=0.02, bristle_stiffness=1e4, bristle_damping=20)  # fmt: skip
    data = problem(truth, 0.2, scale=0.05)
    given = {name: float(v) for name, v in truth.given.items() if not isinstance(v, str)}
    model = Model("lugre", given, tuple(given))
    told = identifiability(data, model, 1.0)
    assert any("stribeck_velocity" in group or "static_force" in group for group in told.groups)
    lost = {name for group in told.groups for name in group}
    assert "bristle_stiffness" not in lost
    assert "inertance" not in lost


@pytest.mark.parametrize("place", [-0.8, 0.3])
def test_where_in_its_play_a_run_begins_is_found_with_the_play(place: float) -> None:
    half = 3e-3
    device = Device(inertance=50, viscous=100, friction="dahl", coulomb_force=40,
                    bristle_stiffness=4e4, friction_backlash=half)  # fmt: skip
    x, v, a = motion()
    noise = np.random.default_rng(2).standard_normal(N)
    force = device.along(H, x, v, a, place * half)["total"] + 0.3 * noise
    first = float(50 * a[0] + 100 * v[0])
    data = Problem([run_of(force, (x, v, a), first)], [np.ones(N, bool)])
    fit = search(data, law_named("dahl+play"), {}).best
    assert fit.rmse(data.masks) < 1.02 * 0.3
    assert fit.model.values["friction_place"] == pytest.approx(place, abs=0.02)
    value, error = parameter_errors(fit)["friction_backlash"]
    assert abs(value - half) < 4 * error
    assert error < 0.01 * half
    # it is no parameter of the device
    assert "friction_place" not in parameter_errors(fit)
    # pinned to the middle, the play cannot be had as exactly
    names = tuple(name for name in fit.model.free if name != "friction_place")
    pinned = Model("dahl", {**fit.model.values, "friction_place": 0.0}, names)
    assert data.fit(pinned).rmse(data.masks) > 1.3 * 0.3


def test_a_first_force_beyond_doubt_tells_the_side_of_the_play() -> None:
    device = Device(
        friction="dahl", coulomb_force=40, bristle_stiffness=4e4, friction_backlash=3e-3
    )
    none = np.zeros(3)
    for force, place, state in (
        (20.0, -1.0, 3.5e-3), (-20.0, 1.0, -3.5e-3), (0.0, 0.4, 1.2e-3), (0.0, -1.0, -3e-3),
    ):  # fmt: skip
        run = run_of(none, (none, none, none), force)
        assert first_state(device, run, place) == pytest.approx(state, abs=1e-12)


def test_outliers_count_less_with_a_robust_loss() -> None:
    truth = Device(inertance=50, viscous=100, friction="dahl", coulomb_force=20,
                   bristle_stiffness=1e4)  # fmt: skip
    data = problem(truth, 0.3)
    random = np.random.default_rng(3)
    wrong = random.choice(N, N // 50, replace=False)
    data.runs[0].force[wrong] += 300 * np.sign(data.runs[0].velocity[wrong])
    errors = {}
    for loss in ("linear", "huber", "cauchy"):
        fit = search(data, law_named("dahl"), {}, loss=loss).best
        errors[loss] = abs(fit.model.values["coulomb_force"] / 20 - 1)
    assert errors["linear"] > 0.05
    assert errors["huber"] < 0.02
    assert errors["cauchy"] < 0.005


def test_what_is_known_is_held() -> None:
    case = drawn("dahl", 3)
    fixed = {"inertance": case.parameters["inertance"], "bristle_stiffness": 1e5}
    result = identify(case.records, ["dahl"], fixed=fixed, intervals="normal").best
    assert set(result.parameters) == {"viscous", "coulomb_force"}
    assert result.device.inertance == fixed["inertance"]
    assert result.device.bristle_stiffness == 1e5


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"laws": ["dhal"]}, "did you mean dahl"),
        ({"laws": ["dahl+lugre"]}, "two friction laws"),
        ({"laws": ["viscous+asymmetry"]}, "has none"),
        ({"laws": ["coulomb+play"]}, "no bristle: add dahl, lugre or bouc_wen"),
        ({"laws": ["play+series"]}, "no bristle"),
        ({"fixed": {"inertanse": 3.0}}, "inertance"),
        ({"loss": "huge"}, "linear, soft_l1"),
        ({"intervals": "some"}, "profile, normal"),
        ({"holdout": ["nothing"]}, "nothing"),
    ],
)
def test_what_cannot_be_asked_is_refused_in_a_sentence(options: dict, message: str) -> None:
    case = drawn("ideal", 0)
    with pytest.raises((DeviceError, ValueError), match=message) as error:
        identify(case.records, **{"laws": ["ideal"], **options})
    assert "\n" not in str(error.value)


def test_a_run_that_stands_still_is_refused() -> None:
    t = np.linspace(0.0, 0.999, 1000)
    still = Record(name="still", time=t, displacement=np.zeros(1000), force=np.sin(t))
    with pytest.raises(ValueError, match="still: column 'displacement' does not move"):
        identify([still], ["ideal"])


def test_a_copy_of_a_run_is_left_out() -> None:
    """Held out as one and fitted as the other, a run would be judged on what was learnt from it."""
    case = drawn("viscous", 1)
    copy = replace(case.records[-1], name="copy")
    result = identify(check_records([*case.records, copy]), ["viscous"], intervals="normal")
    alone = identify(case.records, ["viscous"], intervals="normal")
    assert result.best.device.given == alone.best.device.given
    assert result.best.rmse == alone.best.rmse
    told = {record["name"]: record["role"] for record in result.json()["records"]}
    assert told == {r["name"]: r["role"] for r in alone.json()["records"]} | {"copy": "unused"}
    with pytest.raises(ValueError, match="--holdout copy: the same displacement and force as"):
        identify(check_records([*case.records, copy]), ["viscous"], holdout=["copy"])


def test_an_error_is_relative_to_the_force_it_was_made_in() -> None:
    """A single run that is calm where it is held out."""
    (record,) = drawn("viscous", 1).records[:1]
    size = record.samples
    calm = np.ones(size)
    for block in HELD_OUT_BLOCKS:
        calm[block * size // BLOCKS : (block + 1) * size // BLOCKS] = 0.1
    random = np.random.default_rng(0)
    force = calm * random.standard_normal(size)
    best = identify([replace(record, force=force)], ["viscous"], intervals="normal").best
    # white noise has nothing to do with the motion: the error is all of the force
    assert best.nrmse == pytest.approx(1.0, abs=0.1)


def test_the_same_on_one_processor_and_on_two(monkeypatch: pytest.MonkeyPatch) -> None:
    """Laws are shared with another process, which starts from what simpler ones found here."""
    records = drawn("coulomb", 4).records
    names = ["ideal", "coulomb", "dahl"]
    alone = identify(records, names)
    monkeypatch.setattr(parallel_steps, "cpu_count", lambda: 2)
    shared = identify(records, names)
    assert [each.law for each in shared.results] == [each.law for each in alone.results]
    for one, other in zip(alone.results, shared.results, strict=True):
        assert other.parameters == one.parameters
        assert other.rmse == one.rmse
        assert np.array_equal(other.correlation, one.correlation)
        assert other.judge(other.model) == one.judge(one.model)
