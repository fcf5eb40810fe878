"""Inertance that varies, end stops, gas and channel: closed forms, limits, energies, errors."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from inerter.reference import ReferenceDevice
from inerter.reference.laws import channel, gas, inertance
from scipy.integrate import solve_ivp

EVERYTHING = {
    "inertance": 30.0, "inertance_gradient": 6.0, "inertance_curvature": -40.0,
    "inertance_speed_gradient": -0.8, "viscous": 12.0, "quadratic_damping": 30.0,
    "stiffness": 4e3, "stiffness_cubic": 5e5, "load_friction": 0.1, "flywheel_viscous": 25.0,
    "stop_lower": -0.01, "stop_upper": 0.012, "stop_stiffness": 2e5, "stop_damping": 0.9,
    "gas_pressure": 1e5, "gas_area": 1e-3, "gas_volume": 5e-5, "rest_length": 0.003,
    "force_offset": 7.0,
}  # fmt: skip
SERIES = {"series_stiffness": 3e4, "series_damping": 150.0, "series_hardening": 20.0}
CHANNEL = {
    "piston_area": 1.649e-3, "channel_area": 2.827e-5, "channel_length": 1.7,
    "fluid_density": 995.6,
}  # fmt: skip
WATER = {"fluid_viscosity": 1e-3, "minor_loss": 1.5, "channel_roughness": 2e-5}
DEVICES = {
    "rigid": EVERYTHING,
    "series": EVERYTHING | SERIES,
    "backlash": EVERYTHING | SERIES | {"backlash": 1e-3, "friction": "dahl", "coulomb_force": 9.0},
    "fluid": {k: v for k, v in EVERYTHING.items() if k != "inertance"} | CHANNEL | WATER | SERIES
    | {"gas_law": "expanded"},
}  # fmt: skip


@pytest.mark.parametrize("name", DEVICES)
@settings(deadline=None, max_examples=60)
@given(
    st.floats(-0.02, 0.02), st.floats(-0.5, 0.5), st.floats(-5, 5),
    st.tuples(st.floats(-1e-4, 1e-4), st.floats(-4e-3, 4e-3), st.floats(-0.6, 0.6)),
    st.floats(-0.99e-3, 0.99e-3),
)  # fmt: skip
def test_power_balance(
    name: str, x: float, v: float, a: float, moving: tuple[float, ...], gap: float
) -> None:
    device = ReferenceDevice(**DEVICES[name])  # type: ignore[arg-type]
    values = {"friction_state": moving[0], "series_deflection": moving[1],
              "flywheel_velocity": moving[2], "gap_position": gap}  # fmt: skip
    z = np.array([values[state] for state in device.state_names])
    rate = np.asarray(device.state_rate(x, v, z)) if device.nstate else 0.0

    # stored energy's rate along the path, by central differences
    h = 1e-6
    after = device.stored_energy(x + h * v, v + h * a, z + h * rate)
    before = device.stored_energy(x - h * v, v - h * a, z - h * rate)
    power = (device.force(x, v, a, z) - device.force_offset) * v
    heat = float(device.dissipated_power(x, v, a, z))
    assert heat == pytest.approx(power - (after - before) / (2.0 * h), rel=2e-5, abs=2e-3)
    assert heat >= -1e-9


@pytest.mark.parametrize("gradient", [3.0, -3.0, 0.0])
def test_inertance_with_speed_under_a_constant_force(gradient: float) -> None:
    # momentum b (v + g v^2 / 2) = F t as long as no floor is reached
    device = ReferenceDevice(inertance=20.0, inertance_speed_gradient=gradient)
    run = solve_ivp(
        lambda t, y: [device.acceleration(0.0, float(y[0]), 10.0)],
        (0.0, 0.2),
        [0.0],
        rtol=1e-11,
        atol=1e-14,
    )
    speed = run.y[0, -1]
    assert 20.0 * (speed + gradient * speed**2 / 2.0) == pytest.approx(10.0 * 0.2, rel=1e-9)


@pytest.mark.parametrize("gradient", [3.0, -3.0])
def test_kinetic_energy_is_the_integral_of_v_times_the_factor(gradient: float) -> None:
    device = ReferenceDevice(inertance_speed_gradient=gradient)
    v = np.linspace(-1.0, 1.0, 40001)
    energy = np.asarray(inertance.speed_energy(device, v))
    slope = v * np.asarray(inertance.speed_factor(device, v))
    np.testing.assert_allclose(np.gradient(energy, v)[1:-1], slope[1:-1], atol=1e-4)
    assert inertance.speed_factor(device, 0.9) == pytest.approx(max(0.01, 1.0 + 0.9 * gradient))


def test_inertance_along_the_stroke_keeps_its_energy_when_coasting() -> None:
    # b(x) a + b'(x) v^2 / 2 = 0: b(x) v^2 is constant
    device = ReferenceDevice(inertance=50.0, inertance_gradient=8.0, inertance_curvature=30.0)
    run = solve_ivp(
        lambda t, y: [y[1], float(device.acceleration(float(y[0]), float(y[1]), 0.0))],
        (0.0, 0.2), [0.0, 0.4], rtol=1e-11, atol=1e-14,
    )  # fmt: skip
    x, v = run.y[:, -1]
    assert (1.0 + 8.0 * x + 30.0 * x * x) * v * v == pytest.approx(0.16, rel=1e-9)


def test_stops_by_hand() -> None:
    device = ReferenceDevice(
        stop_lower=-0.01, stop_upper=0.02, stop_stiffness=1e4, stop_damping=2.0, rest_length=0.1
    )
    for x, v, force in [
        (0.115, 5.0, 0.0), (0.121, 0.0, 10.0), (0.121, 0.25, 15.0), (0.121, -0.25, 5.0),
        (0.121, -0.75, 0.0), (0.088, 0.0, -20.0), (0.088, -0.25, -30.0), (0.088, 0.75, 0.0),
    ]:  # fmt: skip
        assert device.force(x, v, 0.0) == pytest.approx(force, abs=1e-10)
    only = ReferenceDevice(stop_upper=0.02, stop_stiffness=1e4)
    assert only.force(-5.0, 0.0, 0.0) == 0.0


def test_a_stop_of_rubber_by_hand() -> None:
    device = ReferenceDevice(
        stop_lower=-0.01, stop_upper=0.02, stop_stiffness=1e4, stop_stiffness_cubic=1e10,
        stop_damping=2.0,
    )  # fmt: skip
    assert device.force(0.021, 0.0, 0.0) == pytest.approx(20.0)
    assert device.force(0.021, 0.25, 0.0) == pytest.approx(30.0)
    assert device.force(-0.012, 0.0, 0.0) == pytest.approx(-100.0)


@pytest.mark.parametrize("speed", [0.02, 0.05])
def test_restitution_after_hunt_and_crossley(speed: float) -> None:
    # first order in the impact speed: 1 - 2/3 e v
    device = ReferenceDevice(inertance=3.0, stop_upper=0.0, stop_stiffness=1e5, stop_damping=0.5)
    leaving = lambda t, y: y[0]  # noqa: E731
    leaving.terminal, leaving.direction = True, -1.0  # type: ignore[attr-defined]
    run = solve_ivp(
        lambda t, y: [y[1], float(device.acceleration(float(y[0]), float(y[1]), 0.0))],
        (0.0, 1.0), [0.0, speed], events=leaving, rtol=1e-11, atol=1e-14,
    )  # fmt: skip
    lost = 0.5 * speed
    assert -run.y[1, -1] / speed == pytest.approx(1.0 - 2.0 / 3.0 * lost, abs=lost**2)
    assert 1.0 + run.y[1, -1] / speed > 0.6 * lost


GAS = {"gas_pressure": 101325.0, "gas_area": 1.6e-3, "gas_volume": 2.6e-5}


def test_expanded_gas_is_the_polytropic_one_to_second_order() -> None:
    polytropic = ReferenceDevice(**GAS)  # type: ignore[arg-type]
    expanded = ReferenceDevice(gas_law="expanded", **GAS)  # type: ignore[arg-type]
    errors = [
        abs(float(polytropic.force(y, 0.0, 0.0)) - float(expanded.force(y, 0.0, 0.0)))
        for y in (8e-4, 4e-4)
    ]
    assert errors[0] / errors[1] == pytest.approx(8.0, rel=0.1)  # third order is left
    slope = 1.4 * 101325.0 * 1.6e-3**2 / 2.6e-5
    assert float(polytropic.force(1e-8, 0.0, 0.0)) / 1e-8 == pytest.approx(slope, rel=1e-5)


def test_isothermal_gas_is_boyle() -> None:
    device = ReferenceDevice(gas_exponent=1.0, **GAS)  # type: ignore[arg-type]
    for y in (-0.01, 0.005):
        volume = 2.6e-5 + 1.6e-3 * y
        pressure = 101325.0 * 2.6e-5 / volume
        assert device.force(y, 0.0, 0.0) == pytest.approx((101325.0 - pressure) * 1.6e-3)
        work = 101325.0 * (1.6e-3 * y - 2.6e-5 * np.log(volume / 2.6e-5))
        assert device.stored_energy(y, 0.0) == pytest.approx(work)


@pytest.mark.parametrize("law", ["polytropic", "expanded"])
def test_gas_goes_on_smoothly_and_says_so(law: str) -> None:
    device = ReferenceDevice(gas_law=law, **GAS)  # type: ignore[arg-type]
    edge = 2.6e-5 / 1.6e-3 * (-0.95 if law == "polytropic" else 1.0 / 2.4)
    assert gas.limit(device) == pytest.approx(edge)
    inward, outward = edge * 0.99, edge * 1.01
    assert device.gas_valid(inward)
    assert not device.gas_valid(outward)

    # force and its slope are continuous, the energy is the force's integral throughout
    y = edge + np.linspace(-3e-4, 3e-4, 6001)
    force = np.asarray(device.force(y, 0.0, 0.0))
    slope = np.gradient(force, y)
    assert slope.min() > -1e-6 * slope.max()
    assert np.max(abs(np.diff(slope))) < 2e-3 * max(slope.max(), 1e5)
    energy = np.asarray(device.stored_energy(y, 0.0))
    np.testing.assert_allclose(np.gradient(energy, y)[1:-1], force[1:-1], rtol=2e-5)
    if law == "expanded":
        assert force[-1] == pytest.approx(device.force(edge, 0.0, 0.0))


def test_fluid_inertance_as_published() -> None:
    device = ReferenceDevice(**CHANNEL)  # type: ignore[arg-type]
    assert device.total_inertance == pytest.approx(162.8, abs=0.05)
    assert device.force(0.0, 0.3, 2.0) == pytest.approx(2.0 * device.total_inertance)


def test_laminar_pipe_is_poiseuille() -> None:
    device = ReferenceDevice(fluid_viscosity=1e-3, **CHANNEL)  # type: ignore[arg-type]
    width = np.sqrt(4.0 * 2.827e-5 / np.pi)
    for velocity in (1e-12, 1e-3, -2e-3):
        flow = velocity * 1.649e-3 / 2.827e-5
        exact = 32.0 * 1e-3 * 1.7 * 1.649e-3 * flow / width**2
        assert channel.force(device, velocity) == pytest.approx(exact, rel=1e-4)
    assert channel.force(device, 0.0) == 0.0


@pytest.mark.parametrize(("reynolds", "roughness"), [(1e5, 0.0), (1e6, 1e-3), (3e4, 5e-3)])
def test_turbulent_factor_is_colebrook(reynolds: float, roughness: float) -> None:
    root = 0.1
    for _ in range(50):
        root = 1.0 / (-2.0 * np.log10(roughness / 3.7 + 2.51 / (reynolds * root)))
    factor = float(channel.friction_product(reynolds, roughness)) / reynolds
    assert factor == pytest.approx(root**2, rel=0.02)


def test_ends_alone_without_viscosity() -> None:
    device = ReferenceDevice(minor_loss=2.0, **CHANNEL)  # type: ignore[arg-type]
    flow = 0.1 * 1.649e-3 / 2.827e-5
    assert channel.force(device, -0.1) == pytest.approx(-1.649e-3 * 2.0 * 995.6 * flow**2 / 2.0)


@pytest.mark.parametrize(
    ("parameters", "words"),
    [
        ({"inertance": 5.0, "series_hardening": 3.0}, "series_hardening.*series_stiffness"),
        ({"inertance": 5.0, "series_damping": 3.0, "backlash": 1e-4}, "backlash.*series_stiffness"),
        ({"series_stiffness": 1e5}, "series_stiffness.*inertance"),
        ({"series_damping": 10.0}, "series_damping.*inertance"),
        ({"stop_upper": 0.1}, "stop_stiffness > 0"),
        ({"stop_stiffness": 10.0}, "stop_stiffness.*stop_lower or stop_upper"),
        ({"stop_lower": 0.2, "stop_upper": 0.1, "stop_stiffness": 1.0}, "stop_lower.*not below"),
        ({"stop_lower": float("inf"), "stop_stiffness": 1.0}, "not finite"),
        ({"inertance": float("nan")}, "inertance.*not finite"),
        ({"gas_law": "ideal"}, "'ideal' is not one of polytropic, expanded"),
        ({"gas_law": "expanded"}, "gas_law.*gas_pressure"),
        ({"gas_exponent": 1.2}, "gas_exponent.*gas_pressure"),
        ({"gas_pressure": 1e5, "gas_area": 1e-3}, "gas_volume"),
        ({"gas_pressure": 1e5, "gas_volume": 1e-5}, "gas_area"),
        ({"gas_exponent": 6.0, **GAS}, "gas_exponent.*above 5"),
        ({"channel_area": 1e-5, "channel_length": 1.0}, "piston_area"),
        ({"minor_loss": 1.0}, "piston_area and channel_area and channel_length"),
        ({"inertance": 10.0, **CHANNEL}, "inertance.*geometry"),
    ],
)
def test_errors_name_the_parameter(parameters: dict[str, float], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        ReferenceDevice(**parameters)  # type: ignore[arg-type]


def test_gas_takes_the_piston_if_it_has_no_area() -> None:
    one = ReferenceDevice(gas_pressure=1e5, gas_volume=1e-5, piston_area=1e-3)
    other = ReferenceDevice(gas_pressure=1e5, gas_volume=1e-5, gas_area=1e-3)
    assert one.force(2e-3, 0.0, 0.0) == other.force(2e-3, 0.0, 0.0) != 0.0
