"""What stands at the flywheel: varying inertance, fluid in a channel, gas spring; and end stops.

Closed forms, limits, and integrals of the force against the stored energy.
"""

import numpy as np
import pytest
from core_telling import churchill
from inerter.core import Device
from scipy.integrate import quad
from scipy.optimize import root_scalar

# the fluid inerter experiment
FLUID = {
    "piston_area": 1.649e-3, "channel_area": 2.827e-5, "channel_length": 1.7,
    "fluid_density": 995.6,
}  # fmt: skip
BORE = np.sqrt(4.0 * FLUID["channel_area"] / np.pi)
GAS = {"gas_pressure": 101325.0, "gas_area": 1.649e-3, "gas_volume": 1.649e-3 * 0.016}


def total(device: Device, x: float = 0.0, v: float = 0.0, a: float = 0.0) -> float:
    return float(device.evaluate(x, v, a, 0.0)["total"][0])


# ------------------------------ inertance ------------------------------


@pytest.mark.parametrize("g", [0.7, -0.2, -0.4])
def test_inertance_that_varies_with_speed(g: float) -> None:
    device = Device(inertance=20.0, inertance_gradient=3.0, inertance_speed_gradient=g)
    x, v, a = 0.1, -1.5, 2.0
    # V by hand, E by quadrature of u V(u)
    factor = 1.0 + g * 1.5
    moved = quad(lambda u: u * max(0.01, 1.0 + g * u), 0.0, 1.5)[0]
    expected = 20.0 * 1.3 * factor * a + 20.0 * 3.0 * moved
    found = device.evaluate(x, v, a, 0.0)
    assert found["inertance"][0] == pytest.approx(expected, rel=1e-12)
    assert found["stored_energy"][0] == pytest.approx(20.0 * 1.3 * moved, rel=1e-12)


def test_beyond_the_floor_of_the_speed_factor() -> None:
    # g = -0.4: V = 0.01 from 2.475 m/s on; work along an accelerated motion is kinetic energy
    device = Device(inertance=20.0, inertance_speed_gradient=-0.4)
    assert total(device, v=5.0, a=3.0) == pytest.approx(20.0 * 0.01 * 3.0)
    moved = quad(lambda u: u * max(0.01, 1.0 - 0.4 * u), 0.0, 5.0, points=[2.475])[0]
    assert device.evaluate(0.0, 5.0, 0.0, 0.0)["stored_energy"][0] == pytest.approx(20.0 * moved)
    v = np.linspace(0.0, 5.0, 40_001)
    force = device.evaluate(0.0, v, 1.0, 0.0)["total"]
    assert np.trapezoid(force * v, v) == pytest.approx(20.0 * moved, rel=1e-6)


def test_without_speed_gradient_it_is_half_the_slope_times_the_square_of_speed() -> None:
    device = Device(inertance=20.0, inertance_gradient=3.0, inertance_curvature=10.0)
    assert total(device, x=0.1, v=2.0) == pytest.approx(0.5 * 20.0 * (3.0 + 2.0) * 4.0)


# ------------------------------ fluid in a channel ------------------------------


def test_inertance_of_the_fluid_inerter() -> None:
    # printed: 163 kg
    device = Device(**FLUID)
    assert device.inertance == pytest.approx(162.8, abs=0.05)
    assert total(device, a=2.0) == pytest.approx(2.0 * device.inertance)
    # the mass of the fluid times the square of the ratio of speeds
    mass = 995.6 * 2.827e-5 * 1.7
    assert device.inertance == pytest.approx(mass * (1.649e-3 / 2.827e-5) ** 2, rel=1e-14)


def flow(reynolds: float, viscosity: float) -> float:
    """Velocity of the piston for a Reynolds number in the channel."""
    speed = reynolds * viscosity / FLUID["fluid_density"] / BORE
    return speed * FLUID["channel_area"] / FLUID["piston_area"]


def friction_factor(reynolds: float, roughness: float = 0.0) -> float:
    """Darcy's factor from the core's force."""
    device = Device(**FLUID, fluid_viscosity=1e-3, channel_roughness=roughness * BORE)
    v = flow(reynolds, 1e-3)
    u = v * FLUID["piston_area"] / FLUID["channel_area"]
    head = 0.5 * FLUID["fluid_density"] * u**2 * FLUID["channel_length"] / BORE
    return total(device, v=v) / FLUID["piston_area"] / head


@pytest.mark.parametrize("reynolds", [1e-9, 1e-3, 1.0, 300.0, 699.9])
@pytest.mark.parametrize("roughness", [0.0, 0.05])
def test_laminar_flow_is_hagen_poiseuille(reynolds: float, roughness: float) -> None:
    assert friction_factor(reynolds, roughness) * reynolds == pytest.approx(64.0, rel=1e-13)
    # by its own formula: 32 mu l A1 u / D^2
    device = Device(**FLUID, fluid_viscosity=1e-3)
    v = flow(reynolds, 1e-3)
    u = v * FLUID["piston_area"] / FLUID["channel_area"]
    expected = 32.0 * 1e-3 * 1.7 * FLUID["piston_area"] * u / BORE**2
    assert total(device, v=v) == pytest.approx(expected, rel=1e-13)
    assert total(device, v=-v) == -total(device, v=v)


@pytest.mark.parametrize("roughness", [0.0, 1e-4, 1e-2])
def test_all_regimes_are_churchill(roughness: float) -> None:
    for reynolds in np.geomspace(10.0, 1e8, 50):
        expected = churchill(np.array([reynolds]), roughness)[0]
        assert friction_factor(reynolds, roughness) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("roughness", [0.0, 1e-5, 1e-3, 1e-2, 0.05])
def test_turbulent_flow_is_near_colebrook(roughness: float) -> None:
    def colebrook(reynolds: float) -> float:
        def rest(f: float) -> float:
            inner = roughness / 3.7 + 2.51 / reynolds / np.sqrt(f)
            return 1.0 / np.sqrt(f) + 2.0 * np.log10(inner)

        return root_scalar(rest, bracket=(1e-3, 1.0)).root

    for reynolds in np.geomspace(1e4, 1e7, 25):
        found = friction_factor(reynolds, roughness)
        # the worst is near Re = 1e4
        allowed = 0.025 if reynolds < 3e4 else 0.02
        assert found == pytest.approx(colebrook(reynolds), rel=allowed)


def test_the_loss_rises_with_speed_through_transition_and_is_smooth() -> None:
    device = Device(**FLUID, fluid_viscosity=1e-3)
    v = np.linspace(0.0, flow(6e3, 1e-3), 200_001)
    force = device.evaluate(0.0, v, 0.0, 0.0)["total"]
    slope = np.diff(force)
    assert np.all(slope > 0.0)
    # no jump of the slope at the laminar end of the formula either
    bend = abs(np.diff(slope)) / slope[1:]
    assert np.max(bend) < 2e-3


def test_without_viscosity_only_the_minor_loss_is_left() -> None:
    bare = Device(**FLUID, minor_loss=1.5)
    u = 0.02 * FLUID["piston_area"] / FLUID["channel_area"]
    expected = FLUID["piston_area"] * 1.5 * FLUID["fluid_density"] * u**2 / 2.0
    assert total(bare, v=0.02) == pytest.approx(expected, rel=1e-14)
    assert total(bare, v=-0.02) == -total(bare, v=0.02)
    # and the limit is approached: the laminar loss falls with the viscosity, f stays finite
    near = Device(**FLUID, minor_loss=1.5, fluid_viscosity=1e-30)
    smooth = total(near, v=0.02) - expected
    assert 0.0 <= smooth < 0.2 * expected
    tiny = Device(**FLUID, minor_loss=1.5, fluid_viscosity=1e-30)
    assert total(tiny, v=1e-40) == pytest.approx(0.0, abs=1e-60)


def test_flow_loss_is_heat() -> None:
    device = Device(**FLUID, fluid_viscosity=1e-3, minor_loss=0.5, flywheel_viscous=3.0)
    found = device.evaluate(0.0, [-0.1, 1e-4, 0.03], 0.0, 0.0)
    np.testing.assert_allclose(found["dissipated_power"], found["total"] * [-0.1, 1e-4, 0.03])
    assert np.all(found["dissipated_power"] > 0.0)


# ------------------------------ gas spring ------------------------------


@pytest.mark.parametrize("law", ["polytropic", "expanded"])
@pytest.mark.parametrize("exponent", [1.0, 1.4, 3.0])
def test_gas_energy_is_the_work_done(law: str, exponent: float) -> None:
    device = Device(**GAS, gas_law=law, gas_exponent=exponent)
    # from deep in the tangent below 5 % of the volume to far beyond the expanded law's end
    edges = [-0.95 * 0.016, 0.016 / (exponent + 1.0)]
    for y in (-0.02, -0.0155, -0.01, -1e-5, 1e-4, 0.005, 0.03):
        work = quad(lambda s: total(device, x=s), 0.0, y, points=edges, limit=200)[0]
        stored = device.evaluate(y, 0.0, 0.0, 0.0)["stored_energy"][0]
        assert stored == pytest.approx(work, rel=1e-9), y
        assert stored > 0.0


def test_gas_by_hand() -> None:
    device = Device(gas_pressure=1e5, gas_area=1e-3, gas_volume=1e-4)
    # half the volume, isothermal would be twice the pressure; 2^1.4 here, outside pushes with p0
    assert total(device, x=-0.05) == pytest.approx(100.0 * (1.0 - 2.0**1.4))
    assert total(device, x=0.1) == pytest.approx(100.0 * (1.0 - 2.0**-1.4))
    # the printed second order: k = 1.4 * 1e5 * 1e-6 / 1e-4 = 1400 N/m, factor 1 - 12 y
    expanded = Device(gas_pressure=1e5, gas_area=1e-3, gas_volume=1e-4, gas_law="expanded")
    assert total(expanded, x=0.01) == pytest.approx(1400.0 * 0.88 * 0.01)
    assert total(expanded, x=-0.01) == pytest.approx(-1400.0 * 1.12 * 0.01)
    # beyond 1 / 24 m it stays
    assert total(expanded, x=1.0) == pytest.approx(1400.0 / 48.0)


def test_gas_laws_agree_to_second_order() -> None:
    polytropic, expanded = Device(**GAS), Device(**GAS, gas_law="expanded")
    gaps = [abs(total(polytropic, x=y) - total(expanded, x=y)) for y in (1e-3, 5e-4, 2.5e-4)]
    np.testing.assert_allclose(np.log2(np.divide(gaps[:-1], gaps[1:])), 3.0, atol=0.15)


@pytest.mark.parametrize("law", ["polytropic", "expanded"])
def test_gas_is_a_spring_everywhere(law: str) -> None:
    y = np.linspace(-0.02, 0.05, 20_001)
    force = Device(**GAS, gas_law=law).evaluate(y, 0.0, 0.0, 0.0)["total"]
    assert np.all(np.diff(force) >= 0.0)
    # no corner where the tangent takes over
    assert np.max(abs(np.diff(force, 2))) < 0.02 * np.max(np.diff(force))


def test_gas_takes_the_piston_area_when_it_has_none() -> None:
    own = Device(**GAS, **{**FLUID, "fluid_viscosity": 1e-3})
    shared = Device(**{**GAS, "gas_area": FLUID["piston_area"]}, **FLUID, fluid_viscosity=1e-3)
    stated = {name: value for name, value in GAS.items() if name != "gas_area"}
    assert total(Device(**stated, **FLUID), x=5e-3) == total(shared, x=5e-3) == total(own, x=5e-3)
    assert Device(**stated, **FLUID).gas_area == FLUID["piston_area"]


# ------------------------------ end stops ------------------------------


def test_stops_by_hand() -> None:
    device = Device(stop_lower=-0.1, stop_upper=0.2, stop_stiffness=1e4, stop_damping=0.5)
    assert total(device, x=0.19, v=9.0) == total(device, x=-0.09, v=-9.0) == 0.0
    assert total(device, x=0.21, v=1.0) == pytest.approx(150.0)
    assert total(device, x=0.21, v=-1.0) == pytest.approx(50.0)
    assert total(device, x=0.21, v=-3.0) == 0.0
    assert total(device, x=-0.11, v=-1.0) == pytest.approx(-150.0)
    found = device.evaluate(0.21, [1.0, -1.0, -3.0], 0.0, 0.0)
    np.testing.assert_allclose(found["stored_energy"], 0.5)
    # F v - k depth v
    np.testing.assert_allclose(found["dissipated_power"], [50.0, 50.0, 300.0], rtol=1e-10)


def test_a_stop_of_rubber_by_hand() -> None:
    device = Device(
        stop_lower=-0.1, stop_upper=0.2, stop_stiffness=1e4, stop_stiffness_cubic=1e8,
        stop_damping=0.5,
    )  # fmt: skip
    assert total(device, x=0.21) == pytest.approx(200.0)
    assert total(device, x=0.21, v=1.0) == pytest.approx(300.0)
    assert total(device, x=-0.12) == pytest.approx(-1000.0)
    found = device.evaluate(0.21, [1.0, -3.0], 0.0, 0.0)
    np.testing.assert_allclose(found["stored_energy"], 0.75)
    np.testing.assert_allclose(found["dissipated_power"], [100.0, 600.0], rtol=1e-10)


def test_one_stop_alone() -> None:
    upper = Device(stop_upper=0.2, stop_stiffness=1e4)
    lower = Device(stop_lower=0.2, stop_stiffness=1e4)
    assert total(upper, x=-50.0) == 0.0 != total(upper, x=0.3)
    assert total(lower, x=50.0) == 0.0 != total(lower, x=0.1)


def test_stops_count_from_the_rest_length() -> None:
    device = Device(stop_upper=0.2, stop_stiffness=1e4, rest_length=1.0)
    assert total(device, x=1.19) == 0.0
    assert total(device, x=1.21) == pytest.approx(100.0)


@pytest.mark.parametrize("cubic", [0.0, 1e9])
@pytest.mark.parametrize("damping", [0.05, 0.2])
def test_restitution_of_a_stop_is_that_of_hunt_and_crossley(damping: float, cubic: float) -> None:
    # a mass against the stop: 1 - 2 / 3 e v for any elastic force times 1 + e v, to first order
    device = Device(
        stop_upper=0.0, stop_stiffness=1e4, stop_stiffness_cubic=cubic, stop_damping=damping
    )
    x, v, h = 0.0, 1.0, 1e-5
    while x >= 0.0:
        v -= h * total(device, x=x, v=v)
        x += h * v
    assert -v == pytest.approx(1.0 - 2.0 / 3.0 * damping, abs=0.6 * damping**2 + 1e-3)


# ------------------------------ validity ------------------------------


def test_validity_of_the_gas() -> None:
    device = Device(**GAS)
    assert device.validity(-0.0151) is None
    assert device.validity(5.0) is None
    message = device.validity(-0.0153)
    assert message is not None
    assert message.startswith("gas spring: its volume is 0.0437 of gas_volume")
    assert "limit 0.05" in message
    expanded = Device(**GAS, gas_law="expanded")
    assert expanded.validity(0.0066) is None
    message = expanded.validity(0.0067)
    assert message is not None
    assert "0.0067 m is beyond 0.00666667 m" in message
    assert 'gas_law "polytropic"' in message


def test_validity_of_the_series_spring() -> None:
    device = Device(
        inertance=10.0, series_stiffness=1e5, series_hardening=50.0, backlash=1e-3, **GAS
    )
    assert device.validity(0.0, [-0.0109, 0.0, -1e-3]) is None
    message = device.validity(0.0, [-0.0111, 0.0, -1e-3])
    assert message is not None
    assert message.startswith("series spring: deflection -0.0101 m is beyond -0.01 m")
    # the gas lies behind the element: y = x - s
    assert device.validity(-0.02, [-0.009, 0.0, -1e-3]) is None
    assert "gas spring" in str(device.validity(-0.02, [0.0, 0.0, 0.0]))
    assert Device(inertance=10.0).validity(1e9) is None


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_what_is_no_number_is_not_valid(value: float) -> None:
    device = Device(inertance=10.0, series_stiffness=1e5, backlash=1e-3)
    assert device.validity(value) == f"displacement is {value} m: give a finite number"
    for i, name in enumerate(device.state_names):
        states = np.zeros(3)
        states[i] = value
        assert device.validity(0.0, states) == f"{name} is {value}: give a finite number"
