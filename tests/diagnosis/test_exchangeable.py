"""What the data cannot tell apart is one finding, and no text contradicts a figure."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from inerter import Device
from inerter.diagnose import diagnose_bench, wording
from inerter.diagnose.baseline import baseline_of
from inerter.diagnose.candidates import candidates
from inerter.diagnose.composition import bristle_is_known, effects_of
from inerter.diagnose.data import Data, divided
from inerter.diagnose.exchangeable import (
    Exchange,
    exchanges,
    with_branch,
    with_exchange,
    with_force_of_place,
)
from inerter.diagnose.other_runs import badly_missed, missed_in_words
from inerter.diagnose.rate_of_level import steady_change, with_rate_of_level
from inerter.diagnose.remainder.words import summary
from inerter.diagnose.result import Finding, ParameterValue
from inerter.diagnose.search import Search
from inerter.diagnose.stages import identified
from inerter.diagnose.unexplained import unexplained
from inerter.identify.fit import Fit, Problem, rms
from inerter.identify.model import Model
from inerter.records import Record
from inerter.records.preparation import prepare

TIME = np.arange(0, 8, 1 / 500)
IDEAL = Model("none", {"inertance": 60.0}, ("inertance",))


def record(
    frequencies: tuple[float, ...],
    viscous: float = 100.0,
    late: float = 0.0,
    noise: float = 2e-6,
    name: str = "run",
) -> Record:
    """60 kg and a damper along sines of 10 mm at the first frequency, the force late."""
    random = np.random.default_rng(1)
    speed = 2 * np.pi * np.array(frequencies)
    size = 0.01 * (speed[0] / speed) ** 1.5
    then = TIME - late
    v = (size * speed) @ np.cos(np.outer(speed, then))
    a = -(size * speed**2) @ np.sin(np.outer(speed, then))
    x = size @ np.sin(np.outer(speed, TIME)) + random.normal(0, noise, TIME.size)
    force = 60 * a + viscous * v + random.normal(0, 0.5, TIME.size)
    return Record(name=name, time=TIME, displacement=x, force=force)


def searched(made: Record, model: Model, baseline: Model = IDEAL) -> tuple[Search, Fit]:
    """A search over one record, and a model fitted to it."""
    data = divided([made], prepare([made]), ())
    search = Search(data.runs, data.split, baseline)
    return search, search.problem.fit(model)


def finding(value: float, error: float, confidence: float = 0.98) -> Finding:
    """Viscous friction."""
    return Finding(
        effect="viscous_friction", law=None, confidence=confidence,
        parameters={"viscous": ParameterValue(value, error, "N s/m")},
        rmse_before=9.0, rmse_after=0.5, evidence="It is there.", rivals=[],
    )  # fmt: skip


def test_one_sine_tells_no_delay_from_damping() -> None:
    search, fit = searched(record((2.0,), late=2e-3), IDEAL.adding(None, viscous=0.0))
    found = exchanges(search, fit, ["viscous_friction"])["viscous_friction"]
    assert not found.is_told_apart
    told = with_exchange(finding(fit.model.values["viscous"], 0.1), found)
    assert told.members == ("viscous_friction", "sensor_delay", "sensor_filter")
    assert told.json()["members"] == ["viscous_friction", "sensor_delay", "sensor_filter"]
    assert told.confidence == pytest.approx(0.49)
    assert told.rivals[0].effect == "sensor_delay"
    # the true 100 is within the error
    value = told.parameters["viscous"]
    assert abs(value.value - 100) < 2 * value.stderr
    assert wording.effect_in_words(told).startswith("viscous friction or ")
    # both amounts are said: without friction the delay is c / (b w^2)
    late = told.parameters["delay"]
    assert late.value == pytest.approx(value.value / (60 * (4 * np.pi) ** 2), rel=0.03)
    assert late.stderr >= late.value / 3 * (1 - 1e-9)
    # a Butterworth low-pass of order four is late by 2.613 / (2 pi cut-off)
    cutoff = told.parameters["force_filter"]
    assert 2 * np.pi * cutoff.value * late.value == pytest.approx(2.613, rel=1e-3)
    assert cutoff.unit == "Hz"
    assert told.evidence.startswith(f"viscous friction of {value.value:.3g} N s/m or a delay of ")
    assert "this motion cannot tell, a second frequency would" in told.evidence
    # no error beside it that says otherwise, and no rival that is a member
    assert "±" not in told.evidence
    assert "nearly as well" not in told.evidence


def test_a_damper_is_never_early() -> None:
    """Behind a low-pass of the displacement the force comes before it: no damper does that."""
    search, fit = searched(record((2.0,), viscous=0.0, late=-3e-3), IDEAL.adding(None, delay=0.0))
    assert fit.model.values["delay"] == pytest.approx(-3e-3, rel=0.02)
    assert exchanges(search, fit, ["sensor_delay"]) == {}
    both = search.problem.fit(fit.model.adding(None, stiffness_cubic=0.0))
    asked = exchanges(search, both, ["sensor_delay", "hardening_stiffness"])
    assert asked.keys() == {"hardening_stiffness"}
    # late by as much it may be one
    search, fit = searched(record((2.0,), viscous=0.0, late=3e-3), IDEAL.adding(None, delay=0.0))
    assert not exchanges(search, fit, ["sensor_delay"])["sensor_delay"].is_told_apart


@pytest.mark.parametrize("asked", ["hardening_stiffness", "variable_inertance"])
def test_one_sine_tells_no_hardening_from_an_inertance_that_varies(
    asked: str, effects_seed: int
) -> None:
    draw = np.random.default_rng(effects_seed)
    omega, size = 2 * np.pi * draw.uniform(1.5, 2.5), 0.01
    x = size * np.sin(omega * TIME)
    cubic = draw.uniform(0.2, 0.5) * 60 * omega**2 / size**2
    force = -60 * omega**2 * x + cubic * x**3 + draw.normal(0, 0.5, TIME.size)
    made = Record(
        name="run", time=TIME, displacement=x + draw.normal(0, 2e-6, TIME.size), force=force
    )
    curved = {"inertance_gradient": 0.0, "inertance_curvature": 0.0}
    begin = {"stiffness_cubic": 0.0} if asked == "hardening_stiffness" else curved
    search, fit = searched(made, IDEAL.adding(None, **begin))
    found = exchanges(search, fit, [asked])[asked]
    assert not found.is_told_apart
    # what it would be in the other's place; b takes what of x the inertance has
    left = 60 - cubic * size**2 / (2 * omega**2)
    instead = -cubic / (2 * left * omega**2) if asked == "hardening_stiffness" else cubic
    assert found.instead[0] == pytest.approx(instead, rel=0.05)


@pytest.mark.parametrize("asked", ["parallel_stiffness", "inertance_error"])
def test_one_sine_tells_no_stiffness_from_a_wrong_inertance(asked: str, effects_seed: int) -> None:
    draw = np.random.default_rng(effects_seed)
    omega = 2 * np.pi * draw.uniform(1.5, 2.5)
    x = 0.01 * np.sin(omega * TIME)
    stiffness = -draw.uniform(0.1, 0.3) * 60 * omega**2
    force = -60 * omega**2 * x + stiffness * x + draw.normal(0, 0.5, TIME.size)
    made = Record(
        name="run", time=TIME, displacement=x + draw.normal(0, 2e-6, TIME.size), force=force
    )
    stated = Model("none", IDEAL.values, ())
    begin = {"stiffness": 0.0} if asked == "parallel_stiffness" else {"inertance": 60.0}
    search, fit = searched(made, stated.adding(None, **begin), stated)
    found = exchanges(search, fit, [asked])[asked]
    assert not found.is_told_apart
    wrong = 60 - stiffness / omega**2
    instead = wrong if asked == "parallel_stiffness" else stiffness
    assert found.instead[0] == pytest.approx(instead, rel=0.02)
    name = "stiffness" if asked == "parallel_stiffness" else "inertance"
    said = Finding(
        effect=asked, law=None, confidence=0.9,
        parameters={name: ParameterValue(fit.model.values[name], 0.1, "N/m")},
        rmse_before=9.0, rmse_after=0.5, evidence="", rivals=[],
    )  # fmt: skip
    told = with_exchange(said, found)
    assert set(told.members) == {"parallel_stiffness", "inertance_error"}
    assert told.parameters["inertance"].value == pytest.approx(wrong, rel=0.02)
    assert told.parameters["stiffness"].value == pytest.approx(stiffness, rel=0.05)
    # either may be none: the stated inertance, no stiffness
    off = abs(told.parameters["inertance"].value - 60)
    assert told.parameters["inertance"].stderr >= off / 3 * (1 - 1e-9)
    assert "an inertance of" in told.evidence


def test_along_one_sine_a_damper_may_be_a_branch() -> None:
    search, fit = searched(record((2.0,)), IDEAL.adding(None, viscous=0.0))
    found = with_branch(finding(fit.model.values["viscous"], 0.1), search, fit)
    assert found.members == ("viscous_friction", "viscoelasticity")
    assert found.confidence == pytest.approx(0.49)
    assert found.rivals[0].effect == "viscoelasticity"
    assert "a spring that relaxes" in wording.effect_in_words(found)
    assert "a spring that relaxes, of 2510 N/m or more; this motion cannot" in found.evidence
    # the branch that is told is a damper of this size at 2 Hz, and the softest
    stiffness, damping = (found.parameters[f"branch_{n}_1"].value for n in ("stiffness", "damping"))
    speed = 2 * np.pi * 2.0
    complex_stiffness = 1 / (1 / stiffness + 1 / (1j * speed * damping))
    assert complex_stiffness.imag == pytest.approx(speed * 100, rel=0.02)
    for more in (0.9, 1.1):
        # with another stiffness no damper makes as much of it
        ratio = damping / stiffness
        other = 1 / (1 / stiffness + 1 / (1j * speed * stiffness * ratio * more))
        assert other.imag < complex_stiffness.imag
    # what has a member is not given another, and other motion tells them apart
    late, several = replace(finding(100.0, 0.1), members=("viscous_friction", "sensor_delay")), 0.5
    assert with_branch(late, search, fit) is late
    search, fit = searched(record((several, 2.0, 5.0)), IDEAL.adding(None, viscous=0.0))
    alone = finding(100.0, 0.1)
    assert with_branch(alone, search, fit) is alone


def test_along_one_sine_an_inertance_that_varies_may_be_any_force_of_the_place() -> None:
    baseline = replace(IDEAL, values={**IDEAL.values, "transition_velocity": 1e-3})
    varying = baseline.adding(None, inertance_gradient=0.0, inertance_curvature=0.0)
    search, fit = searched(record((2.0,), viscous=0.0), varying, baseline)
    told = Finding(
        effect="variable_inertance", law="polynomial", confidence=0.98,
        parameters={"inertance_gradient": ParameterValue(3.0, 0.1, "1/m")},
        rmse_before=9.0, rmse_after=0.5, evidence="It is there.", rivals=[],
    )  # fmt: skip
    found = with_force_of_place(told, search, fit)
    assert found.members[:3] == ("variable_inertance", "position_force", "gas_spring")
    assert found.confidence == pytest.approx(0.49)
    assert "or a force of the place that is the same along this stroke" in found.evidence
    # what goes with the speed is none, and other motion tells them apart
    fast = fit.model.adding(None, inertance_speed_gradient=0.1)
    assert with_force_of_place(told, search, replace(fit, model=fast)) is told
    # nor what differs between the directions
    back = fit.model.adding(None, inertance_back_node_1=0.1)
    assert with_force_of_place(told, search, replace(fit, model=back)) is told
    other, fit = searched(record((0.5, 2.0, 5.0), viscous=0.0), varying, baseline)
    assert with_force_of_place(told, other, fit) is told
    # strokes of different length do, too
    runs = [replace(search.runs[0], displacement=0.5 * search.runs[0].displacement)]
    search.runs = [*search.runs, *runs]
    assert with_force_of_place(told, search, fit) is told


def test_several_sines_tell_them_apart() -> None:
    search, fit = searched(record((0.5, 2.0, 5.0)), IDEAL.adding(None, viscous=0.0))
    found = exchanges(search, fit, ["viscous_friction"])["viscous_friction"]
    assert found.is_told_apart
    before = finding(fit.model.values["viscous"], 0.5)
    assert with_exchange(before, found).members == ()


def test_a_value_that_moves_has_an_error_as_large() -> None:
    told = with_exchange(finding(128.0, 0.3), Exchange("sensor_delay", 100.0, 1.0, 2.9e-3))
    assert told.members == ()
    assert told.parameters["viscous"].stderr == pytest.approx(28.0, abs=0.1)
    assert "a delay of 2.9 ms" in told.evidence
    same = finding(100.0, 0.3)
    assert with_exchange(same, Exchange("sensor_delay", 100.2, 1.0, 1e-6)) is same
    assert with_exchange(same, None) is same


def test_along_one_sine_no_shaft_is_tried() -> None:
    search, _ = searched(record((2.0,)), IDEAL)
    sizes = search.problem.scales
    start = baseline_of(None, sizes)
    tried, broad = (
        {each.effect for each in candidates(start, replace(sizes, one_tone=one))}
        for one in (sizes.one_tone, False)
    )
    assert not {"series_elasticity", "parallel_stiffness"} & tried
    assert {"series_elasticity", "parallel_stiffness"} <= broad


@pytest.mark.parametrize(("error", "known"), [(1e-6, True), (2e-4, False)])
def test_a_bristle_without_a_known_stiffness_is_none(error: float, known: bool) -> None:
    values = {"inertance": 50.0, "coulomb_force": 12.0, "presliding": 1e-5}
    model = Model("dahl", values, tuple(values))
    assert bristle_is_known(Fit(model, [], np.diag([1e-4, 1e-4, error**2]), 1)) is known


def test_an_effect_whose_own_parameters_may_be_none_goes() -> None:
    """Friction that varies along the stroke leaves its level where it does not vary."""
    made = record((0.7, 2.0), viscous=0.0)
    v = np.gradient(made.displacement, TIME)
    smooth = np.convolve(v, np.ones(25) / 25, "same")
    made = replace(made, force=made.force + 8 * np.sign(smooth))
    data = divided([made], prepare([made]), ())
    base = baseline_of(None, data.band.scales)
    search = Search(data.runs, data.split, base)
    start = base.adding("coulomb", coulomb_force=5.0, friction_gradient=0.0, friction_curvature=0.0)
    fit = search.problem.fit(start)
    assert effects_of(fit.model, base) == [("position_dependent_friction", "polynomial")]
    known = identified(search, base, search.score("", None, fit))
    assert effects_of(known.model, base) == [("coulomb_friction", None)]
    assert known.model.values["coulomb_force"] == pytest.approx(8.0, rel=0.05)
    # and what has a value stays
    assert identified(search, base, known) is known


# --- texts ---------------------------------------------------------------------------------------


def data_of(made: Record) -> tuple[Data, Model, list[np.ndarray]]:
    """Records divided, the ideal inerter fitted, and what it leaves [N]."""
    data = divided([made], prepare([made]), ())
    model = Problem(data.runs, data.split.fit, data.band.scales).fit(IDEAL).model
    return data, model, data.raw.errors(model)


def test_the_noise_of_the_motion_is_no_lack_of_the_model() -> None:
    """Along a sine the displacement tells the acceleration without its noise."""
    data, model, errors = data_of(record((2.0,), viscous=0.0, noise=2e-5))
    (motion,) = data.preparation.motions
    noise = 60 * motion.acceleration_noise
    raw = rms(errors, data.raw.masks)
    floor = float(np.hypot(0.5, noise))
    told = [
        unexplained(
            data.runs, data.split, data.band.residual(model), floor, raw, data.whole, errors, each
        )
        for each in (0.0, noise)
    ]
    assert not told[1].significant, told[1].summary
    assert told[1].proposal is None


def test_more_than_noise_is_not_said_of_less() -> None:
    less = summary([], {}, {}, 0.518, 0.579, 0.0, False, None)
    assert "more than" not in less
    more = summary([], {}, {}, 0.608, 0.246, 0.0, False, None)
    assert "is more than this noise, but shows no dependence" in more


def test_a_fitted_run_that_is_missed_is_said() -> None:
    made = [record((0.7, 2.0, 4.0), name=name) for name in ("a", "b", "c")]
    made[2] = replace(made[2], force=1.5 * made[2].force)
    data = divided(made, prepare(made), ["a"])
    model = IDEAL.adding(None, viscous=100.0)
    errors = data.raw.errors(model)
    held = rms(errors, data.raw.masks)
    found = badly_missed(data, errors, 0.5)
    assert list(found) == ["c"]
    assert f"misses c by {found['c']:.3g} N rms" in missed_in_words(found, held)
    assert missed_in_words({}, held) == ""


@pytest.mark.parametrize("play", [0.0, 2e-3])
def test_along_one_sine_a_play_has_to_do_more_than_its_shaft(
    play: float, effects_seed: int
) -> None:
    """A soft shaft with loss is a damper there, and a play of no width is that shaft.

    The contact loses enough for a flywheel that lands to be foretold: with a fifth of the damping
    it bounces, and what the fit misses, 76 to 99 N of 128, hangs on the noise.
    """
    made = record((2.0,))
    if play:
        w = 4 * np.pi
        x = 0.01 * np.sin(w * TIME)
        v, a = 0.01 * w * np.cos(w * TIME), -(w**2) * x
        device = Device(inertance=60, backlash=play, series_stiffness=2e5, series_damping=4e3)
        rough = np.random.default_rng(effects_seed).normal(0, 0.5, TIME.size)
        made = replace(made, force=device.along(TIME[1], x, v, a)["total"] + rough)
    contact = {"series_frequency": 9.19, "series_loss": 0.58 if play else 0.115}
    search, fit = searched(made, IDEAL.adding(None, backlash=play or 2e-5, **contact))
    scored = search.score("backlash", None, fit)
    assert search._is_shaft_alone(scored) is (play == 0.0)


def test_along_one_sine_no_stiffness_stands_for_the_inertance(effects_seed: int) -> None:
    """Of a fast record the acceleration has noise in the search's band, the displacement none."""
    draw = np.random.default_rng(effects_seed)
    time, omega = np.arange(0, 9.7, 5e-4), 2 * np.pi * draw.uniform(3.5, 5.0)
    x = 0.9e-3 * np.sin(omega * time + draw.uniform(0, 6))
    force = -100 * omega**2 * x + 0.45 * draw.standard_normal(time.size)
    noisy = x + 2e-6 * draw.standard_normal(time.size)
    made = Record(name="one sine", time=time, displacement=noisy, force=force)
    named = {each.effect for each in diagnose_bench([made], carry="nothing").findings}
    assert "parallel_stiffness" not in named


def test_along_one_slow_sine_a_delay_is_no_shaft(effects_seed: int) -> None:
    """The acceleration has more noise than size: the displacement shows that it is one sine."""
    draw = np.random.default_rng(effects_seed)
    time, omega = np.arange(0, 9.7, 1e-3), 2 * np.pi * draw.uniform(0.5, 0.7)
    late, phase = draw.uniform(4e-3, 8e-3), draw.uniform(0, 6)
    x = 0.06 * np.sin(omega * time + phase)
    a = -0.06 * omega**2 * np.sin(omega * (time - late) + phase)
    steps = np.round((x + 4e-5 * draw.standard_normal(time.size)) / 6e-5) * 6e-5
    force = 62 * a + 0.3 * draw.standard_normal(time.size)
    made = Record(name="one sine", time=time, displacement=steps, force=force)
    found = diagnose_bench([made], carry="nothing")
    assert found.parameters["inertance"].value == pytest.approx(62, rel=0.01)
    (told,) = found.findings
    assert set(told.members) == {"viscous_friction", "sensor_delay", "sensor_filter"}
    assert told.parameters["delay"].value == pytest.approx(late, rel=0.2)


@pytest.mark.parametrize("uneven", [True, False])
def test_without_rests_uneven_friction_and_a_constant_force_are_one_finding(uneven: bool) -> None:
    random = np.random.default_rng(7)
    speed = 2 * np.pi * np.array([0.7, 1.9, 3.1, 4.3])
    size, phase = 0.02 * (speed[0] / speed) ** 1.5, random.uniform(0, 6, 4)
    angle = np.outer(TIME, speed) + phase
    v, a = np.cos(angle) @ (size * speed), -np.sin(angle) @ (size * speed**2)
    way = np.sign(v)
    friction = 30.0 * way * (1 + 0.15 * way) if uneven else 30.0 * way + 4.5
    made = Record(
        name="run", time=TIME,
        displacement=np.sin(angle) @ size + random.normal(0, 1e-6, TIME.size),
        force=60 * a + friction + random.normal(0, 0.5, TIME.size),
    )  # fmt: skip
    (found,) = diagnose_bench([made]).findings
    assert found.members == ("asymmetric_friction", "force_offset")
    assert found.confidence <= 0.5
    values = found.parameters
    assert values["force_offset"].value == pytest.approx(4.5, abs=0.1)
    assert values["friction_asymmetry"].value == pytest.approx(0.15, abs=0.005)
    # each may be none
    assert 3.01 * values["friction_asymmetry"].stderr > 0.15
    assert "friction that is 15 % larger one way" in found.evidence
    assert f"a constant force of {values['force_offset'].value:.3g} N" in found.evidence
    assert "the device turned round would" in found.evidence


@pytest.mark.parametrize("rests", [False, True])
@pytest.mark.parametrize("law", ["coulomb", "dahl"])
def test_a_constant_force_beside_friction_is_told_from_uneven_one_by_rests_alone(
    law: str, rests: bool
) -> None:
    random, way = np.random.default_rng(3), 2 * np.pi * TIME
    x = 0.02 * np.sin(way * 0.7) + 0.008 * np.sin(way * 1.9)
    if rests:
        # half of the time it stands still
        x = np.where(TIME < 4.0, x, x[TIME.searchsorted(4.0)])
    v = np.gradient(x, TIME)
    force = 60 * np.gradient(v, TIME) + 30.0 * np.tanh(v / 1e-4) + 4.5
    seen = x + random.normal(0, 1e-6, TIME.size)
    force = force + random.normal(0, 0.5, TIME.size)
    made = Record(name="run", time=TIME, displacement=seen, force=force)
    memory = {"presliding": 1e-4} if law == "dahl" else {"transition_velocity": 1e-3}
    model = IDEAL.adding(law, coulomb_force=30.0, **memory).adding(force_offset=4.0)
    search, fit = searched(made, model)
    found = exchanges(search, fit, ["force_offset"])
    assert bool(found) is (law == "coulomb" and not rests)
    assert all(not each.is_told_apart for each in found.values())


def test_a_steady_speed_shows_the_difference_of_two_effects_alone() -> None:
    """Each may be anything, and what makes them up is known: 3 % with an error of 1 %."""
    values = {"rate_effect": 0.05, "coulomb_force": 9.0, "age_effect": 0.02}
    shared = np.array([1.0, 0.0, 1.0])
    covariance = 0.5**2 * np.outer(shared, shared) + np.diag([3e-5, 4.0, 7e-5])
    change, error = steady_change(
        Fit(Model("rate_state", values, tuple(values)), [], covariance, 1)
    )
    assert change == pytest.approx(0.03)
    assert error == pytest.approx(0.01)


@pytest.mark.parametrize(
    ("rate", "noise", "told"), [(0.0, 0.05, True), (0.0, 5.0, False), (0.04, 0.05, False)]
)
def test_noise_hides_whether_a_friction_level_goes_with_the_speed(
    rate: float, noise: float, told: bool, effects_seed: int
) -> None:
    made = record((0.7, 2.0), viscous=0.0, noise=1e-7)
    speed = 2 * np.pi * np.array([0.7, 2.0])
    v = (0.01 * speed * (0.7 / np.array([0.7, 2.0])) ** 1.5) @ np.cos(np.outer(speed, TIME))
    a = np.gradient(v, TIME)
    error = noise * np.random.default_rng(effects_seed).standard_normal(TIME.size)
    level = 8 * (1 + rate * np.log(np.maximum(np.abs(v), 1e-6) / 1e-2))
    made = replace(made, force=60 * a + level * np.tanh(v / 1e-4) + error)
    begin = {"coulomb_force": 7.0, "transition_velocity": 1e-4}
    search, fit = searched(made, IDEAL.adding("coulomb", **begin))
    known = {"coulomb_force": ParameterValue(8.0, 0.1, "N")}
    named = replace(finding(8.0, 0.1), effect="coulomb_friction", parameters=known)
    found = with_rate_of_level(named, search, fit)
    if told:
        assert found is named
        return
    assert found.members == ("coulomb_friction", "rate_state_friction")
    assert found.confidence == named.confidence
    assert found.parameters["rate_effect"].unit == ""
    assert "cannot tell" in found.evidence
    if rate:
        told_by_text = float(found.evidence.split("up to ")[1].split(" %")[0])
        assert 4.0 <= told_by_text < 6.0
