"""The fluid calculator: printed numbers, laminar and turbulent limits, cavitation, elasticity."""

import math
from pathlib import Path

import numpy as np
import pytest
from inerter.design import DesignError, design_fluid
from inerter.design.files import write_design
from inerter.design.fluid.cavitation import peak
from inerter.design.fluid.compressibility import effective_modulus, frequency
from inerter.design.fluid.inputs import read_geometry, read_liquid, with_prototype
from inerter.design.fluid.losses import Channel
from inerter.design.inputs import read_inputs
from inerter.device_file import read_device
from inerter.rig import simulate_along


def channel(**inputs: float | str) -> Channel:
    from inerter.design.fluid.inputs import INPUTS

    values = with_prototype(read_inputs(INPUTS, inputs))
    rough, ends = values.number("roughness"), values.number("minor_loss")
    return Channel(read_geometry(values), read_liquid(values), rough, ends)


def test_printed_inertance_and_mass() -> None:
    design = design_fluid(piston_area=1.649e-3, channel_area=2.827e-5, density=995.6)
    assert design.value("inertance") == pytest.approx(162.8, abs=0.05)
    assert design.value("fluid_mass") == pytest.approx(0.048, abs=5e-4)
    # the same from diameters, and water of 30 degC has the printed density
    design = design_fluid()
    assert design.value("inertance") == pytest.approx(162.8, abs=0.1)
    assert design.value("density") == pytest.approx(995.6, abs=0.06)
    assert design.device.inertance == pytest.approx(design.value("inertance"), rel=1e-14)


def test_length_of_a_helix() -> None:
    design = design_fluid(helix_radius=0.05, helix_pitch=0.01, helix_turns=6)
    turn = np.linspace(0.0, 12 * math.pi, 200_001)
    curve = np.array([0.05 * np.cos(turn), 0.05 * np.sin(turn), 0.01 * turn / (2 * math.pi)])
    length = np.sum(np.linalg.norm(np.diff(curve), axis=0))
    assert design.value("channel_length") == pytest.approx(length, rel=1e-8)


@pytest.mark.parametrize("liquid", ["water", "hydraulic_oil_46", "silicone_oil_350"])
def test_slow_flow_is_hagen_and_poiseuille(liquid: str) -> None:
    found = channel(liquid=liquid, minor_loss=0)
    speed = found.transition_speed / 10
    # pressure 128 mu l q / (pi D^4)
    flow = found.geometry.piston_area * speed
    viscosity, length = found.liquid.viscosity, found.geometry.length
    pressure = 128 * viscosity * length * flow / (math.pi * found.geometry.diameter**4)
    expected = found.geometry.piston_area * pressure
    assert found.force(speed)[0] == pytest.approx(expected, rel=1e-9)
    assert found.laminar_damping * speed == pytest.approx(expected, rel=1e-12)


def test_fast_flow_is_blasius_in_smooth_pipes() -> None:
    found = channel(minor_loss=0, roughness=0)
    speeds = np.array([1e4, 3e4, 1e5]) / found.reynolds(1.0)
    assert found.force(speeds) == pytest.approx(found.blasius(speeds), rel=0.04)


def test_ends_lose_k_dynamic_pressures() -> None:
    with_ends, without = channel(minor_loss=2.5), channel(minor_loss=0)
    loss = float((with_ends.force(0.1) - without.force(0.1))[0])
    flow = 0.1 * with_ends.geometry.ratio
    pressure = 2.5 * 0.5 * with_ends.liquid.density * flow**2
    assert loss == pytest.approx(with_ends.geometry.piston_area * pressure, rel=1e-9)


@pytest.mark.parametrize("speed", [1e-3, 0.05])
def test_device_file_in_mujoco_loses_the_calculated_pressure(tmp_path: Path, speed: float) -> None:
    design = design_fluid(speed=speed)
    write_design(design, tmp_path)
    device = read_device(tmp_path / "device.toml")
    t = 1e-3 * np.arange(20)
    run = simulate_along(device, 1e-3, speed * t, np.full(20, speed), np.zeros(20))
    lost = design.value("pressure_loss") * design.value("piston_area")
    assert run["total"] == pytest.approx(np.full(20, lost), rel=1e-6, abs=1e-6)


def test_cavitation_at_constant_speed() -> None:
    design = design_fluid(suction_share=0.5)
    speed = design.value("cavitation_speed")
    drop = float(channel().force(speed)[0]) / design.value("piston_area")
    assert 101325.0 - 0.5 * drop == pytest.approx(design.value("vapour_pressure"), rel=1e-6)


def test_cavitation_of_a_loss_free_motion() -> None:
    # no losses: (2 pi f)^2 x b = F_c
    design = design_fluid(minor_loss=0, viscosity=1e-12, amplitude="2 mm")
    rate = 2 * math.pi * design.value("cavitation_frequency")
    reached = design.value("inertance") * rate**2 * 2e-3
    assert reached == pytest.approx(design.value("cavitation_force"), rel=1e-4)
    # a chamber that is held at p_0 leaves the whole drop to the other one
    held = design_fluid(suction_share=1)
    assert held.value("cavitation_force") == pytest.approx(design.value("cavitation_force") / 2)


def test_peak_of_a_motion_whose_losses_rule() -> None:
    found = channel(liquid="silicone_oil_1000")
    rate, x = 2 * math.pi * 0.05, 1e-3
    damping = found.laminar_damping * rate * x
    inertial = found.inertance * rate**2 * x
    ends = found.ends(rate * x)
    expected = math.hypot(damping, inertial)
    assert peak(found, 0.05, x) == pytest.approx(expected, abs=ends + 1e-3 * expected)


def test_chambers_as_springs() -> None:
    design = design_fluid(stroke="0.2 m", dead_volume="10 cm^3")
    area, modulus = design.value("piston_area"), design.value("bulk_modulus")
    chamber = area * 0.1 + 1e-5
    # the piston moves 1 nm with the channel closed: each chamber's volume changes by A 1e-9
    squeezed = modulus * -math.log1p(-area * 1e-9 / chamber)
    stretched = modulus * -math.log1p(area * 1e-9 / chamber)
    force = area * (squeezed - stretched)
    assert design.value("series_stiffness") == pytest.approx(force / 1e-9, rel=1e-6)
    assert design.device.series_stiffness == design.value("series_stiffness")


def test_bubbles_between_liquid_and_gas() -> None:
    assert effective_modulus(2e9, 0.0, 1e5, 1.4) == pytest.approx(2e9)
    assert effective_modulus(2e9, 1.0, 1e5, 1.4) == pytest.approx(1.4e5)
    # 1 % of air makes water a hundred times softer
    assert effective_modulus(2.2e9, 0.01, 101325.0, 1.4) == pytest.approx(1.41e7, rel=0.01)


def test_antiresonance() -> None:
    # the identified stiffness of the fluid inerter paper
    assert frequency(1.25e5, 162.8) == pytest.approx(4.41, abs=5e-3)
    # bubbles that would give it: about 3.7 %
    design = design_fluid(stroke=0.2, air_fraction=0.037)
    assert design.value("series_stiffness") == pytest.approx(1.25e5, rel=0.02)
    # with rigid terminals the device's own states swing at that frequency
    device = design.device.replace(fluid_viscosity=0, minor_loss=0)
    force = device.evaluate(0.0, 0.0, 0.0, [1e-5, 0.0])["total"][0]
    found = frequency(force / 1e-5, device.inertance)
    assert design.value("antiresonance") == pytest.approx(found, rel=1e-9)


def test_trapped_air_is_the_device_s_gas_spring() -> None:
    design = design_fluid(gas_volume="26 cm^3")
    step = 1e-7
    force = design.device.evaluate([-step, step], 0.0, 0.0, 0.0)["total"]
    slope = float(force[1] - force[0]) / (2 * step)
    assert design.value("gas_stiffness") == pytest.approx(slope, rel=1e-6)


def test_coil() -> None:
    straight, coil = design_fluid(), design_fluid(helix_radius=0.045, helix_turns=6)
    assert "coil_factor" not in [figure.name for figure in straight.figures]
    assert coil.value("dean") == pytest.approx(coil.value("reynolds") * math.sqrt(0.006 / 0.09))
    slow = design_fluid(helix_radius=0.045, helix_turns=6, speed=1e-6)
    assert slow.value("coil_factor") == 1.0
    # Mishra and Gupta 1979, from other measurements: 1 + 0.033 (lg De)^4
    found = channel(helix_radius=0.045, helix_turns=6)
    for dean in (100.0, 1000.0):
        expected = 1 + 0.033 * math.log10(dean) ** 4
        assert found.coil_factor(dean / found.dean(1.0)) == pytest.approx(expected, rel=0.02)


def test_a_steep_helix_bends_less() -> None:
    radius, pitch = 0.05, 0.2
    turn = np.array([-1e-4, 0.0, 1e-4])
    curve = np.array([radius * np.cos(turn), radius * np.sin(turn), pitch * turn / (2 * math.pi)])
    step = np.linalg.norm(curve[:, 1] - curve[:, 0])
    bend = np.linalg.norm(curve[:, 2] - 2 * curve[:, 1] + curve[:, 0]) / step**2
    found = channel(helix_radius=radius, helix_pitch=pitch, helix_turns=3)
    assert found.geometry.coil_diameter == pytest.approx(2 / bend, rel=1e-6)


@pytest.mark.parametrize(
    ("inputs", "words"),
    [
        ({"liquid": "watr"}, ["did you mean 'water'", "silicone_oil_100"]),
        ({"temperature": "120 degC"}, ["393.15 K", "0 to 95 degC"]),
        ({"static_pressure": 2000}, ["cavitates at rest", "raise static_pressure"]),
        ({"piston_area": 1e-3, "bore": 0.05}, ["piston_area is given and so is bore"]),
        ({"bore": 0.01, "rod": 0.02}, ["rod is 0.02 m, not below bore"]),
        ({"channel_diameter": 0.06}, ["not below the piston's"]),
        ({"roughness": 0.1}, ["roughness is 0.1 m", "radius 0.003 m"]),
        ({"helix_radius": 0.05}, ["helix is incomplete"]),
        ({"helix_radius": 0.001, "helix_turns": 5}, ["helix_radius is 0.001 m"]),
        ({"air_fraction": 0.01}, ["give stroke too"]),
    ],
)
def test_refusals(inputs: dict, words: list[str]) -> None:
    with pytest.raises(DesignError) as caught:
        design_fluid(**inputs)
    assert all(word in str(caught.value) for word in words)
