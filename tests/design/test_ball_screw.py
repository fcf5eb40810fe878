"""The ball-screw calculator: limits, closed forms, the device that it gives."""

import math

import pytest
from inerter.design import DesignError, design_ball_screw
from inerter.design.ball_screw.inputs import INPUTS
from inerter.design.ball_screw.losses import Losses
from inerter.design.hertz import contact, contact_modulus
from inerter.design.inputs import read_inputs


def test_published_inertance() -> None:
    # the hysteresis paper: P = 4 mm, J = 6.43e-5 kg m^2
    design = design_ball_screw(lead="4 mm", inertia=6.43e-5)
    assert design.value("inertance") == pytest.approx(158.65, abs=5e-3)
    assert any("balls do not fit" in note for note in design.notes)


def test_no_friction_is_the_ideal_inerter() -> None:
    design = design_ball_screw(sliding_friction=0, rolling_friction=0)
    assert design.value("nonlinear_inertance") == design.value("inertance")
    assert design.device.given == {"inertance": design.value("inertance")}


def test_rolling_efficiency() -> None:
    # physics of the paper's device: lead angle 14.86 deg, about 0.985
    losses = Losses(read_inputs(INPUTS, {}))
    assert math.degrees(losses.helix.angle) == pytest.approx(14.86, abs=5e-3)
    assert losses.rolling_efficiency == pytest.approx(0.985, abs=5e-4)


@pytest.mark.parametrize("angle", ["30 deg", "60 deg"])
def test_rigid_balls_lose_mu_r_ball_per_r_sin_beta(angle: str) -> None:
    # without spin and preload: (2 pi / P) mu r_b sin al / (cos al sin be) = mu r_b / (r_o sin be)
    values = read_inputs(INPUTS, {"preload": 0, "youngs_modulus": 1e22, "contact_angle": angle})
    expected = 0.1 * 0.5 / math.sin(values.number("contact_angle"))
    for load in (1.0, 300.0):
        assert Losses(values).sliding_loss(load) == pytest.approx(expected, rel=1e-6)


def test_loss_of_spin_alone_grows_with_the_cube_root_of_the_load() -> None:
    losses = Losses(read_inputs(INPUTS, {"preload": 0, "method": "printed"}))
    assert losses.sliding_loss(80.0) == pytest.approx(2 * losses.sliding_loss(10.0), rel=1e-10)


def test_printed_ball_load_multiplies_where_the_consistent_one_divides() -> None:
    printed = Losses(read_inputs(INPUTS, {"preload": 0, "method": "printed"}))
    other = Losses(read_inputs(INPUTS, {"preload": 0}))
    # equilibrium along the axis: Z Q cos(al) sin(be) = F
    factor = math.cos(other.helix.angle) * math.sin(math.pi / 4)
    assert 18 * other.ball_load(100.0) * factor == pytest.approx(100.0, rel=1e-12)
    assert printed.ball_load(100.0) == pytest.approx(other.ball_load(100.0) * factor**2, rel=1e-12)


@pytest.mark.parametrize("preload", [0.0, 2.0])
def test_device_loses_what_was_calculated(preload: float) -> None:
    design = design_ball_screw(preload=preload, load=50.0)
    losses = Losses(design.inputs)
    force = losses.sliding_force(0.0)
    # acceleration at which the driving force is the stated load
    b, mu = design.value("inertance"), design.value("load_friction")
    a = (50.0 - force) / (b * (1 + mu))
    found = design.device.evaluate(0.0, 1.0, a, 0.0)
    assert found["total"][0] == pytest.approx(50.0, rel=1e-12)
    lost = losses.load_loss(50.0) * (50.0 - force) + force
    assert found["friction"][0] == pytest.approx(lost, rel=1e-12)
    if preload == 0.0:
        share = 1 - losses.rolling_efficiency + losses.sliding_loss(50.0)
        assert found["friction"][0] / found["total"][0] == pytest.approx(share, rel=1e-12)


@pytest.mark.parametrize(
    ("inputs", "words"),
    [
        ({"lead": -0.01}, ["lead is -0.01", "above 0 m"]),
        ({"contact_angle": 45}, ["contact_angle is 45", "45 deg"]),
        ({"ball_radius": "7 mm"}, ["ball_radius is 0.007 m", "nominal_radius 0.006 m"]),
        ({"ball_radius": "5 mm"}, ["ball_radius is 0.005 m", "0.009666 m apart"]),
        ({"sliding_friction": 1.0}, ["loses", "longer lead or lower friction"]),
        ({"measured": "paper", "inertia": 1e-4}, ["inertia is given", "measured fits it"]),
        ({"pitch": 0.01}, ["pitch is not an input", "lead"]),
    ],
)
def test_refusals(inputs: dict, words: list[str]) -> None:
    with pytest.raises(DesignError) as caught:
        design_ball_screw(**inputs)
    assert all(word in str(caught.value) for word in words)


def test_contact_stiffness_is_the_slope_of_the_deflection() -> None:
    losses = Losses(read_inputs(INPUTS, {"preload": 0}))
    along = math.cos(losses.helix.angle) * math.sin(math.pi / 4)

    def deflection(load: float) -> float:
        return sum(found.approach for found in losses.contacts(load)) / along

    slope = (deflection(50.5) - deflection(49.5)) / 1.0
    assert losses.contact_stiffness(50.0) == pytest.approx(1 / slope, rel=1e-4)


def test_pressure_that_dents_is_said() -> None:
    # pressure grows with the cube root of the load: 0.8 GPa at 100 N
    assert not any("dent" in note for note in design_ball_screw(load=1e4).notes)
    assert any("dent" in note for note in design_ball_screw(load=3e4).notes)


def test_raceways_of_a_tiny_lead_are_those_of_a_bearing() -> None:
    # rings: curvature -/+ cos(be) / (r_o +/- r_b cos(be)) along the groove
    losses = Losses(read_inputs(INPUTS, {"lead": 1e-6}))
    across = 1 / 0.003 - 1 / (2 * 0.54 * 0.003)
    reach = math.cos(math.pi / 4)
    modulus = contact_modulus(206e9, 0.3)
    nut, screw = losses.contacts(100.0)
    for found, bend in (
        (nut, -reach / (0.006 + 0.003 * reach)),
        (screw, reach / (0.006 - 0.003 * reach)),
    ):
        expected = contact(across, 1 / 0.003 + bend, losses.ball_load(100.0), modulus)
        assert (found.major, found.minor) == pytest.approx((expected.major, expected.minor))


def test_preload_adds_a_force_and_no_share() -> None:
    # rigid balls: the force of the preload is Z times that of one ball's load
    rigid = {"youngs_modulus": 1e22}
    free, loaded = (Losses(read_inputs(INPUTS, rigid | {"preload": q})) for q in (0, 3))
    assert loaded.load_loss(50.0) == pytest.approx(free.load_loss(50.0), rel=1e-9)
    equal = 3.0 / free.load_share
    assert loaded.sliding_force(0.0) == pytest.approx(free.sliding_force(equal), rel=1e-9)
