"""What changes along the stroke, relaxes, ages or warms is looked for and fitted."""

from __future__ import annotations

import numpy as np
import pytest
from inerter import Device
from inerter.catalogue.scales import Scales
from inerter.diagnose import along_stroke
from inerter.diagnose.candidates import candidates
from inerter.diagnose.composition import effects_of, submodel, without_effect
from inerter.identify.fit import Fit, Problem, parameter_errors
from inerter.identify.model import Model
from three_sines import TIME, H, N, motion, run_of

NOISE = 0.3
COULOMB = {"coulomb_force": 20.0, "transition_velocity": 2e-3}


def problem(device: Device, beside: np.ndarray | float = 0.0) -> Problem:
    x, v, a = motion()
    start = device.state_of_force(x[0], v[0], a[0], 0.0) if device.nstate else 0.0
    force = device.along(H, x, v, a, start)["total"] + beside
    force = force + NOISE * np.random.default_rng(4).standard_normal(N)
    return Problem([run_of(force, (x, v, a))], [np.ones(N, bool)])


def plain(data: Problem, friction: str = "none", **values: float) -> Fit:
    start = {"inertance": 40.0, "transition_velocity": 1e-4, **values}
    return data.fit(Model(friction, start, ("inertance", *values)))


def best(data: Problem, trials: list, effect: str, law: str | None = None) -> Fit:
    chosen = [each for each in trials if each.effect == effect and each.law == law]
    assert chosen, (effect, law)
    fits = [data.fit(start) for each in chosen for start in each.starts]
    return min(fits, key=lambda fit: fit.rmse(data.masks))


@pytest.mark.parametrize(
    ("quantity", "effect", "amplitude", "law", "values"),
    [
        ("force", "position_force", 6.0, "none", {}),
        ("inertance", "variable_inertance", 0.05, "none", {}),
        ("friction", "position_dependent_friction", 0.4, "coulomb", COULOMB),
    ],
)
def test_a_period_is_found_with_its_length(
    quantity: str, effect: str, amplitude: float, law: str, values: dict[str, float]
) -> None:
    row = (0.0113, amplitude, 0.7)
    truth = Device(inertance=50, friction=law, **values, **{f"{quantity}_periods": row})
    data = problem(truth)
    level = {name: values[name] for name in values if name == "coulomb_force"}
    first = data.fit(Model(law, {"inertance": 40.0, **values}, ("inertance", *level)))
    found = best(data, list(along_stroke.candidates(data, first)), effect, "period")
    told = parameter_errors(found)
    assert found.rmse(data.masks) == pytest.approx(NOISE, rel=0.05)
    for name, true in zip(("period", "amplitude", "phase"), row, strict=True):
        value, stderr = told[f"{quantity}_{name}_1"]
        assert abs(value - true) < max(4 * stderr, 1e-3 * abs(true)), name
        assert stderr < 0.1 * abs(true), name
    assert (effect, "period") in effects_of(found.model, first.model)
    assert submodel(found.model, [], first.model).free == first.model.free


def test_a_curve_is_found_where_no_sine_fits() -> None:
    curve = [0.0, 3.0, -2.0, 6.0, 1.0, -4.0, 0.0]
    x, _, _ = motion()
    truth = Device(
        inertance=50, force_curve=curve, curve_lower=float(x.min()), curve_upper=float(x.max())
    )
    data = problem(truth)
    first = plain(data)
    found = best(data, list(along_stroke.candidates(data, first)), "position_force", "curve")
    assert found.rmse(data.masks) == pytest.approx(NOISE, rel=0.05)
    assert ("position_force", "curve") in effects_of(found.model, first.model)
    # the device that a user takes away has it
    assert "force_curve" in found.model.device().given


def test_two_flanks_are_found_and_one_is_not_taken_for_two(effects_seed: int) -> None:
    draw = np.random.default_rng(effects_seed)
    forth = (draw.uniform(0.04, 0.1, 7) * [0, 1, -1, 0, 1, -1, 1]).tolist()
    back = (draw.uniform(0.04, 0.1, 7) * [1, -1, 1, 1, -1, 1, 0]).tolist()
    x, _, _ = motion()
    ends = {"curve_lower": float(x.min()), "curve_upper": float(x.max())}
    truth = Device(inertance=50, inertance_curve=forth, inertance_back_curve=back, **ends)
    data = problem(truth)
    first = plain(data)
    trials = list(along_stroke.candidates(data, first))
    found = best(data, trials, "variable_inertance", "flanks")
    assert found.rmse(data.masks) == pytest.approx(NOISE, rel=0.05)
    assert ("variable_inertance", "flanks") in effects_of(found.model, first.model)
    assert {"inertance_curve", "inertance_back_curve"} <= found.model.device().given.keys()
    # only what one direction alone cannot say is asked for
    alike = problem(Device(inertance=50, inertance_curve=forth, **ends))
    trials = list(along_stroke.candidates(alike, plain(alike)))
    assert {trial.law for trial in trials} & {"curve", "flanks"} == {"curve"}
    # a curve that is known already gets its other direction
    one = data.fit(best(alike, trials, "variable_inertance", "curve").model)
    (more,) = [t for t in along_stroke.candidates(data, one) if t.law == "flanks"]
    values = more.starts[0].values
    assert values["inertance_back_node_2"] == values["inertance_node_2"]


def test_a_curve_leaves_offset_and_spring_what_is_theirs() -> None:
    data = problem(Device(inertance=50, stiffness=800, force_offset=5, force_periods=(0.02, 4, 0)))
    first = plain(data, stiffness=1.0, force_offset=1.0)
    trials = [c for c in along_stroke.candidates(data, first) if c.law == "curve"]
    (start, *_) = trials[0].starts
    assert {"stiffness", "force_offset"} <= set(start.free)
    columns = data.jacobian(start)
    columns /= np.linalg.norm(columns, axis=0)
    assert np.linalg.cond(columns) < 1e3


def test_noise_has_nothing_along_the_stroke() -> None:
    data = problem(Device(inertance=50, friction="coulomb", **COULOMB))
    first = data.fit(
        Model("coulomb", {"inertance": 40.0, **COULOMB}, ("inertance", "coulomb_force"))
    )
    assert list(along_stroke.candidates(data, first)) == []


def test_a_branch_that_relaxes_is_found() -> None:
    truth = {"branch_stiffness_1": 3e3, "branch_damping_1": 240.0}
    data = problem(Device(inertance=50, **truth))
    first = plain(data)
    found = best(data, list(candidates(first.model, data.scales)), "viscoelasticity")
    for name, (value, stderr) in parameter_errors(found).items():
        if name in truth:
            assert abs(value - truth[name]) < max(4 * stderr, 0.01 * truth[name]), name
    assert found.rmse(data.masks) == pytest.approx(NOISE, rel=0.05)
    # a second one is offered, and taken away again first
    more = next(c for c in candidates(found.model, data.scales) if c.effect == "viscoelasticity")
    simpler = without_effect(more.starts[0], "viscoelasticity", first.model)
    assert simpler[0].free == found.model.free


def test_damping_that_changes_with_time_is_found() -> None:
    _, v, _ = motion()
    data = problem(Device(inertance=50, viscous=120), -0.03 * TIME * 120 * v)
    first = plain(data, viscous=50.0)
    found = best(data, list(candidates(first.model, data.scales)), "viscous_drift")
    value, stderr = parameter_errors(found)["viscous_drift"]
    assert value == pytest.approx(-0.03, abs=4 * stderr)
    assert stderr < 1e-3


def test_a_play_before_the_friction_is_found() -> None:
    truth = Device(inertance=50, friction="dahl", coulomb_force=30, bristle_stiffness=3e4,
                   friction_backlash=2e-3)  # fmt: skip
    data = problem(truth)
    values = {"inertance": 50.0, "coulomb_force": 30.0, "presliding": 2e-3}
    first = data.fit(Model("dahl", {"transition_velocity": 1e-4, **values}, tuple(values)))
    found = best(data, list(candidates(first.model, data.scales)), "friction_play")
    value, _ = parameter_errors(found)["friction_backlash"]
    assert value == pytest.approx(2e-3, rel=0.02)
    names = effects_of(found.model, Model("none", {"inertance": 50.0}, ("inertance",)))
    assert names == [("hysteretic_friction", "dahl"), ("friction_play", None)]
    # no law without a bristle keeps it
    assert all(
        "friction_backlash" not in model.values
        for model in without_effect(found.model, "hysteretic_friction", first.model)
        if model.friction in ("none", "coulomb")
    )


def test_a_period_longer_than_the_travel_repeats_nowhere() -> None:
    sizes = Scales(
        force=10.0, displacement=0.02, velocity=0.1, acceleration=2.0, travel=(-0.03, 0.02)
    )
    plain = Model("none", {"inertance": 80.0}, ("inertance",))
    names = ("force_period_1", "force_cosine_1", "force_sine_1")
    for length, is_one in ((0.04, True), (0.06, False)):
        model = plain.adding(None, **dict(zip(names, (length, 1.0, 0.0), strict=True)))
        assert along_stroke.repeats(model, sizes) is is_one
    assert along_stroke.repeats(plain, sizes)
