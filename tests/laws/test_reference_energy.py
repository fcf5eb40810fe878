"""What goes in is stored or dissipated: pointwise, for every law; symmetry and passivity."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from inerter.reference import FRICTION_LAWS, ReferenceDevice, response, sine_motion


def device_with(friction: str, **changes: float) -> ReferenceDevice:
    parameters = {
        "inertance": 80.0,
        "viscous": 12.0,
        "quadratic_damping": 30.0,
        "stiffness": 4e3,
        "stiffness_cubic": 5e5,
        "load_friction": 0.1,
        "coulomb_force": 10.0,
        "static_force": 14.0,
        "bristle_stiffness": 2e4,
        "bristle_damping": 15.0,
        "bw_alpha": 1.3,
        "bw_beta": 900.0,
        "bw_gamma": 300.0,
        "bw_exponent": 1.4,
        "bw_stiffness": 3e3,
        "bw_ratio": 0.2,
        "slip_stiffness_1": 2e4,
        "slip_force_1": 10.0,
    }
    return ReferenceDevice(friction=friction, **(parameters | changes))  # type: ignore[arg-type]


POINT = st.tuples(
    st.floats(-0.02, 0.02), st.floats(-0.3, 0.3), st.floats(-5, 5), st.floats(-4e-4, 4e-4)
)


@pytest.mark.parametrize("friction", FRICTION_LAWS)
@settings(deadline=None, max_examples=40)
@given(POINT)
def test_power_balance(friction: str, point: tuple[float, float, float, float]) -> None:
    x, v, a, z = point
    device = device_with(
        friction, rest_length=0.003, force_offset=7.0, friction_asymmetry=0.2, friction_gradient=8.0
    )
    rate = float(device.state_rate(x, v, z, a=a))

    # stored energy's rate along the path, by central differences
    h = 1e-5
    after = device.stored_energy(x + h * v, v + h * a, z + h * rate)
    before = device.stored_energy(x - h * v, v - h * a, z - h * rate)
    stored = (after - before) / (2.0 * h)
    power = (device.force(x, v, a, z) - device.force_offset) * v
    assert device.dissipated_power(x, v, a, z) == pytest.approx(power - stored, rel=1e-6, abs=1e-6)


@pytest.mark.parametrize("friction", FRICTION_LAWS)
@settings(deadline=None, max_examples=40)
@given(POINT)
def test_mirror_symmetry(friction: str, point: tuple[float, float, float, float]) -> None:
    x, v, a, z = point
    device = device_with(friction)
    # an age is the same in the mirror
    side = 1.0 if friction == "rate_state" else -1.0
    assert device.force(-x, -v, -a, side * z) == -device.force(x, v, a, z)
    assert device.state_rate(-x, -v, side * z) == side * device.state_rate(x, v, z)


@pytest.mark.parametrize("friction", [law for law in FRICTION_LAWS if law != "lugre"])
@settings(deadline=None, max_examples=60)
@given(POINT)
def test_passive_at_every_moment(friction: str, point: tuple[float, float, float, float]) -> None:
    x, v, a, z = point
    assert device_with(friction).dissipated_power(x, v, a, z) >= -1e-12


@pytest.mark.parametrize("frequency", [0.5, 2.0, 8.0])
def test_lugre_is_passive_over_a_loop(frequency: float) -> None:
    device = device_with("lugre", inertance=0.0, viscous=0.0, quadratic_damping=0.0)
    times = np.linspace(0.0, 3.0 / frequency, 6001)
    run = response(device, sine_motion(2e-3, frequency), times)
    work = np.trapezoid((run.force * run.velocity)[4000:], times[4000:])
    assert work > 0.0


@pytest.mark.parametrize("friction", ["dahl", "lugre", "bouc_wen"])
def test_energy_balance_along_a_run(friction: str) -> None:
    device = device_with(friction)
    times = np.linspace(0.0, 1.3, 26001)
    run = response(device, sine_motion(6e-3, 1.7, 0.4), times)
    heat = device.dissipated_power(run.displacement, run.velocity, run.acceleration, run.state)
    energy = np.asarray(device.stored_energy(run.displacement, run.velocity, run.state))
    work = np.trapezoid(run.force * run.velocity, times)
    assert work == pytest.approx(energy[-1] - energy[0] + np.trapezoid(heat, times), rel=1e-6)
