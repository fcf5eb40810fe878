"""Plain parts in the place of rich ones that do no more."""

from __future__ import annotations

from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest
from inerter.catalogue.scales import Scales
from inerter.diagnose.bent_damping import straight_bends
from inerter.diagnose.composition import effects_of
from inerter.diagnose.exchange import plain_part
from inerter.diagnose.plainer import (
    as_constant_force,
    as_law_of_long_waves,
    as_one,
    as_one_friction,
    as_plain_part,
    as_spring,
    keeps_its_start,
    swings_on,
    with_own_spring,
)
from inerter.diagnose.search import Scored, Search
from inerter.identify.model import Model

BASELINE = Model("none", {"inertance": 80.0}, ("inertance",))


def test_stops_that_meet_are_a_spring() -> None:
    stops = {"stop_lower": 0.0099, "stop_upper": 0.0101}
    stops |= {"stop_stiffness": 1e4, "stop_damping": 0.0, "force_offset": 5.0}
    model = BASELINE.adding(None, **stops)
    (spring,) = as_spring(model)
    assert spring.free == ("inertance", "force_offset", "stiffness")
    x = np.linspace(-0.05, 0.05, 101)
    one, two = (each.device().along(1e-3, x, 0 * x, 0 * x)["total"] for each in (model, spring))
    # they differ by half the gap times the stiffness at most
    np.testing.assert_allclose(one, two, atol=1.001)
    assert as_spring(BASELINE.adding(None, stop_upper=0.01, stop_stiffness=1e4)) == []


def test_a_branch_without_a_time_of_its_own_and_a_straight_curve_are_plain_parts() -> None:
    slow = Model(
        "none",
        {"inertance": 60.0, "branch_stiffness_1": 2e3, "branch_time_1": 12.0},
        ("inertance", "branch_stiffness_1", "branch_time_1"),
    )
    (spring,) = as_plain_part(slow, 20.0, 3.0)
    assert spring.values["stiffness"] == 2e3
    assert set(spring.free) == {"inertance", "stiffness", "force_offset"}
    assert as_plain_part(slow, 30.0, 3.0) == []
    quick = Model("none", {**slow.values, "branch_time_1": 0.004, "viscous": 3.0}, slow.free)
    (damper,) = as_plain_part(quick, 20.0, 3.0)
    assert damper.values["viscous"] == 3.0 + 2e3 * 0.004
    assert set(damper.free) == {"inertance", "viscous"}
    assert as_plain_part(quick, 20.0, 60.0) == []
    both = quick.adding(None, branch_stiffness_2=5e3, branch_time_2=1.0)
    (damper,) = as_plain_part(both, 20.0, 3.0)
    assert (damper.values["branch_stiffness_1"], damper.values["branch_time_1"]) == (5e3, 1.0)
    assert damper.device().branch_stiffness_1 == 5e3

    nodes = {f"force_node_{i}": 5.0 + 2.0 * i for i in range(1, 8)}
    ends = {"curve_lower": -0.03, "curve_upper": 0.03}
    curve = Model("none", {"inertance": 60.0, **ends, **nodes}, ("inertance", *nodes))
    plain, hard, _ = as_plain_part(curve, 20.0, 3.0)
    assert plain.values["stiffness"] == pytest.approx(200.0)
    assert plain.values["force_offset"] == pytest.approx(13.0)
    assert set(hard.free) - set(plain.free) == {"stiffness_cubic"}
    assert plain.values.keys().isdisjoint(nodes)


def test_a_period_longer_than_the_travel_is_a_curve_that_a_gas_may_be() -> None:
    sizes = Scales(
        force=100.0, displacement=0.03, velocity=0.3, acceleration=3.0, travel=(-0.05, 0.05)
    )
    wave = {"force_period_1": 0.287, "force_cosine_1": 0.0, "force_sine_1": 68.0}
    model = BASELINE.adding(None, **wave, stiffness_cubic=6.8e4, rest_length=0.12)
    spring, hard, gas = as_law_of_long_waves(model, sizes)
    assert set(hard.free) - set(spring.free) == {"stiffness_cubic"}
    assert "gas_push" in gas.free
    assert all(each.values.keys().isdisjoint(wave) for each in (spring, hard, gas))
    # the gas is the nearest of some to the same force over the travel
    x = np.linspace(-0.05, 0.05, 41)
    one, two = (each.device().along(1e-3, x, 0 * x, 0 * x)["total"] for each in (model, gas))
    assert np.std(one - two) < 0.05 * np.std(one)
    short = BASELINE.adding(None, **{**wave, "force_period_1": 0.03})
    assert as_law_of_long_waves(short, sizes) == []


@pytest.mark.parametrize(
    ("effect", "name", "value", "expected"),
    [
        ("leak", "leak_corner", 0.02, True),
        ("leak", "leak_corner", 0.03, False),
        ("viscoelasticity", "branch_time_1", 21.0, True),
        ("viscoelasticity", "branch_time_1", 19.0, False),
        # found before, and on its way: no other effect is refused for that
        ("coulomb_friction", "branch_time_1", 21.0, False),
        ("coulomb_friction", "leak_corner", 0.02, False),
    ],
)
def test_what_does_not_relax_in_the_record_keeps_its_start(
    effect: str, name: str, value: float, expected: bool
) -> None:
    values = {"inertance": 60.0, "branch_stiffness_1": 2e3, name: value}
    model = Model("none", values, tuple(values))
    assert keeps_its_start(effect, model, 20.0, 3.0) is expected
    # one that is stated, and held, is no question
    assert not keeps_its_start(effect, Model("none", values, ("inertance",)), 20.0, 3.0)


def test_a_shaft_is_rigid_or_a_spring_where_it_does_not_follow() -> None:
    values = {"inertance": 2.0, "series_frequency": 0.5, "series_loss": 0.1, "viscous": 3.0}
    soft = Model("none", values, tuple(values))
    rigid, spring = as_plain_part(soft, 20.0, 3.0)
    assert set(rigid.free) == {"inertance", "viscous"}
    assert spring.values["stiffness"] == pytest.approx(2.0 * np.pi**2)
    assert set(spring.free) == {"inertance", "viscous", "stiffness", "force_offset"}
    assert spring.values["inertance"] == 0.0
    assert len(as_plain_part(soft.holding(series_frequency=5.0), 20.0, 3.0)) == 1
    assert as_plain_part(soft.adding(None, backlash=1e-3), 20.0, 3.0) == []


def test_a_slow_shaft_that_never_settles_is_any_slow_sine() -> None:
    values = {"inertance": 2.0, "series_frequency": 2.0, "series_loss": 1e-3}
    shaft = Model("none", values, tuple(values))
    assert swings_on(shaft, 20.0, 3.0)
    assert not swings_on(shaft, 200.0, 3.0)
    assert not swings_on(shaft, 20.0, 0.5)
    assert not swings_on(shaft.holding(series_loss=0.1), 20.0, 3.0)
    assert not swings_on(shaft.adding(None, backlash=1e-3), 20.0, 3.0)
    assert not swings_on(shaft.without(("series_frequency", "series_loss")), 20.0, 3.0)


@pytest.mark.parametrize(("loss", "kept"), [(0.3, True), (1e-3, False)])
def test_a_shaft_that_lost_its_damping_goes_whatever_it_explains(loss: float, kept: bool) -> None:
    values = {"inertance": 2.0, "series_frequency": 2.0, "series_loss": loss}

    def fitted(model: Model) -> SimpleNamespace:
        error = 1.0 if "series_frequency" in model.values else 5.0
        squares = np.array([error**2])
        fit = SimpleNamespace(model=model, rmse=lambda masks: error)
        return SimpleNamespace(fit=fit, model=model, squares=squares, rmse=fit.rmse)

    search = SimpleNamespace(
        problem=SimpleNamespace(masks=[], scales=SimpleNamespace(frequency=3.0), fit=fitted),
        longest=20.0, may_be=lambda model: True, score=lambda effect, law, fit: fit,
    )  # fmt: skip
    current = fitted(Model("none", values, tuple(values)))
    found = plain_part(cast("Search", search), cast("Scored", current))
    assert (found is None) is kept
    assert found is None or "series_frequency" not in found.model.values


def test_the_spring_of_a_bouc_wen_law_stands_beside_another_law() -> None:
    own = BASELINE.adding(
        "bouc_wen", bw_level=20.0, presliding=1e-3, bw_shape=0.6, bw_exponent=1.0, bw_ratio=0.05
    )
    (beside,) = with_own_spring(own)
    assert (beside.friction, beside.complexity) == ("dahl", own.complexity - 2)
    # over long strokes both forces are a spring and a level; alike they begin
    device, other = own.device(), beside.device()
    far = np.linspace(0.05, 0.1, 101)
    one, two = (each.along(1e-3, far, 0 * far + 0.5, 0 * far) for each in (device, other))
    slopes = [np.ptp(each["total"][50:]) / np.ptp(far[50:]) for each in (one, two)]
    assert slopes[1] == pytest.approx(slopes[0], rel=1e-3)
    assert with_own_spring(BASELINE.adding("dahl", coulomb_force=20.0, presliding=1e-3)) == []


def test_a_level_and_a_constant_force_may_be_friction_that_differs_between_directions() -> None:
    both = BASELINE.adding("coulomb", coulomb_force=20.0, force_offset=-4.0, stiffness=1e3)
    (one,) = as_one(both)
    assert one.values["friction_asymmetry"] == -0.2
    assert one.values["coulomb_force"] == 20.0
    assert one.values["stiffness"] == 1e3
    assert "force_offset" not in one.values
    assert one.complexity == both.complexity
    assert [name for name, _ in effects_of(one, BASELINE)] == [
        "asymmetric_friction",
        "parallel_stiffness",
    ]
    # there has to be a level, and a constant force that is not stated
    assert as_one(BASELINE.adding(force_offset=-4.0)) == []
    assert as_one(one) == []


def test_a_curve_of_a_force_may_be_a_gas_and_a_constant_force() -> None:
    gas = {"gas_push": 20.0, "gas_reach": 0.07, "gas_exponent": 1.3}
    truth = Model("none", {"inertance": 60.0, **gas, "force_offset": -6.0}, tuple(gas))
    places = np.linspace(-0.03, 0.02, 9)
    forces = truth.device().along(1e-3, places, 0 * places, 0 * places)["total"]
    nodes = {f"force_node_{i}": force for i, force in enumerate(forces, start=1)}
    ends = {"curve_lower": places[0], "curve_upper": places[-1]}
    curve = Model("none", {"inertance": 60.0, **ends, **nodes}, ("inertance", *nodes))
    *_, found = as_plain_part(curve, 20.0, 3.0)
    assert set(found.free) == {"inertance", *gas, "force_offset"}
    along = found.device().along(1e-3, places, 0 * places, 0 * places)["total"]
    np.testing.assert_allclose(along, forces, atol=0.02 * np.ptp(forces))
    # one that pulls as it is pressed is none, and beside a gas there is no second
    pulling = Model("none", {**curve.values, **{n: -f for n, f in nodes.items()}}, curve.free)
    assert len(as_plain_part(pulling, 20.0, 3.0)) == 2
    assert len(as_plain_part(curve.adding(None, **gas), 20.0, 3.0)) == 2


def test_damping_that_bends_at_once_is_friction() -> None:
    bends = {"viscous": 4000.0, "damping_knee": 2e-3, "damping_beyond": 0.01}
    model = BASELINE.adding(None, **bends)
    friction, damped = as_plain_part(model, 20.0, 3.0)
    assert friction.friction == damped.friction == "coulomb"
    assert set(damped.free) - set(friction.free) == {"viscous"}
    v = np.array([-0.3, -0.1, 0.1, 0.3])
    one, two = (each.device().evaluate(0.0, v, 0.0, 0.0)["total"] for each in (model, damped))
    np.testing.assert_allclose(one, two, rtol=1e-3)
    # beside a law there is a level already
    assert as_plain_part(model.adding("coulomb", coulomb_force=3.0), 20.0, 3.0) == []


@pytest.mark.parametrize(("law", "peaked"), [("coulomb", "stribeck"), ("dahl", "lugre")])
def test_damping_with_a_tiny_knee_and_friction_are_one_friction(law: str, peaked: str) -> None:
    bends = {"viscous": 6000.0, "damping_knee": 2e-3, "damping_beyond": 0.0}
    own = {"coulomb_force": 15.0, **({"presliding": 1e-5} if law == "dahl" else {})}
    model = BASELINE.adding(None, **bends).adding(law, **own)
    found = as_one_friction(model, 0.2)
    assert [each.friction for each in found] == [law, law, peaked, peaked]
    # at any speed of the motion the force of both
    assert all(each.values["coulomb_force"] == pytest.approx(27.0) for each in found)
    assert all("damping_knee" not in each.values and each.is_possible for each in found)
    assert "viscous" in found[1].free
    assert "viscous" not in found[0].free
    # a knee among the speeds of the motion is a damper's
    assert as_one_friction(model, 0.02) == []
    # nor is a level that varies put into another one
    assert as_one_friction(model.adding(None, friction_asymmetry=0.1), 0.2) == []


def test_damping_that_bends_upwards_may_be_quadratic() -> None:
    bends = {"viscous": 40.0, "damping_knee": 0.1, "damping_beyond": 3.0}
    model = BASELINE.adding(None, **bends)
    quadratic, both = as_plain_part(model, 20.0, 3.0)
    assert quadratic.free == ("inertance", "quadratic_damping")
    assert both.free == ("inertance", "quadratic_damping", "viscous")
    # at twice the knee it has the slope of the damping beyond
    assert quadratic.values["quadratic_damping"] == pytest.approx(40.0 * 3.0 / (2 * 0.1))
    # beside friction, too, and beside quadratic damping not once more
    assert len(as_plain_part(model.adding("coulomb", coulomb_force=5.0), 20.0, 3.0)) == 2
    assert as_plain_part(model.adding(None, quadratic_damping=3.0), 20.0, 3.0) == []


@pytest.mark.parametrize(("power", "stribeck"), [(-0.03, True), (0.5, False), (-1.0, False)])
def test_a_power_of_the_speed_that_is_none_may_be_stribeck_friction(
    power: float, stribeck: bool
) -> None:
    bent = BASELINE.holding(damping_beyond=0.0).adding(
        None, viscous=2e5, damping_power_knee=1.3e-4, damping_exponent=power
    )
    plain = as_plain_part(bent, 20.0, 3.0)
    assert "coulomb" in {each.friction for each in plain}
    peaks = [each for each in plain if each.friction == "stribeck"]
    assert bool(peaks) is stribeck
    for each in peaks:
        # about the force that the power has far beyond its knee
        assert each.values["coulomb_force"] < 2e5 * 1.3e-4 < each.values["coulomb_force"] * 1.3
        assert "damping_exponent" not in each.values


def test_a_power_of_the_speed_may_be_two_straight_lines() -> None:
    sizes = Scales(force=100.0, displacement=0.01, velocity=0.1, acceleration=3.0)
    power = {"viscous": 1300.0, "damping_power_knee": 0.5, "damping_exponent": -1.0}
    model = BASELINE.holding(damping_beyond=0.0).adding(None, **power)
    found = straight_bends(model, sizes)
    assert len(found) == 2
    for each in found:
        assert {"damping_knee", "damping_beyond", "damping_sharpness"} <= set(each.free)
        assert "damping_power_knee" not in each.values
        assert "damping_exponent" not in each.values
        assert each.is_possible
    assert straight_bends(found[0], sizes) == []


def test_a_curve_of_the_force_that_is_level_may_be_a_constant_force() -> None:
    nodes = {f"force_node_{i}": 39.0 + 0.5 * (-1) ** i for i in range(1, 8)}
    ends = {"curve_lower": -0.03, "curve_upper": 0.03}
    held = {"inertance": 60.0, "force_offset": 1.0}
    curve = Model("none", {**held, **ends, **nodes}, ("inertance", *nodes))
    (constant,) = as_constant_force(curve)
    assert constant.values["force_offset"] == pytest.approx(39.93, abs=0.01)
    assert set(constant.free) == {"inertance", "force_offset"}
    assert nodes.keys().isdisjoint(constant.values)
    # one that is stated stays
    assert as_constant_force(Model("none", {**held, **ends, **nodes}, ("inertance",))) == []


def test_what_leaks_past_a_flywheel_that_hardly_turns_is_a_damper() -> None:
    """Of 4000 kg behind 1200 N s/m all but what is slower than 0.05 Hz is the leak's."""
    values = {"inertance": 4000.0, "leak_corner": 0.05, "viscous": 30.0, "grip_mass": 2.0}
    leaking = Model("none", values, tuple(values))
    (damper,) = as_plain_part(leaking, 20.0, 1.0)
    assert set(damper.free) == {"inertance", "viscous"}
    assert damper.values["viscous"] == pytest.approx(30.0 + 2 * np.pi * 0.05 * 4000.0)
    # what was felt before the leak is all the inertance that is left
    assert damper.values["inertance"] == 2.0
    both = leaking.adding(None, leak_quadratic_damping=500.0)
    (damper,) = as_plain_part(both, 20.0, 1.0)
    assert damper.values["quadratic_damping"] == 500.0
    # one that turns with the motion is an inertance behind its leak
    assert as_plain_part(leaking, 20.0, 0.08) == []
    stated = Model("none", values, ("leak_corner",))
    assert as_plain_part(stated, 20.0, 1.0) == []
