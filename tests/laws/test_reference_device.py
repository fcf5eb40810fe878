"""The device's terms by hand, its inversion, its level and its errors."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from inerter.reference import ReferenceDevice, friction_level


@pytest.mark.parametrize(
    ("parameters", "force"),
    [
        # x = 2 m, v = 3 m/s, a = 5 m/s^2: sums to do by hand
        ({"inertance": 7.0}, 35.0),
        ({"viscous": 2.0}, 6.0),
        ({"quadratic_damping": 2.0}, 18.0),
        ({"stiffness": 4.0, "rest_length": 0.5}, 6.0),
        ({"stiffness_cubic": 4.0, "rest_length": 1.0}, 4.0),
        ({"force_offset": -1.5}, -1.5),
        ({"inertance": 7.0, "load_friction": 0.2}, 42.0),
        ({"friction": "coulomb", "coulomb_force": 10.0}, 10.0),
        ({"friction": "coulomb", "coulomb_force": 10.0, "friction_asymmetry": 0.25}, 12.5),
        ({"friction": "coulomb", "coulomb_force": 10.0, "friction_gradient": 0.25}, 15.0),
        ({"friction": "coulomb", "coulomb_force": 10.0, "friction_curvature": 0.25}, 20.0),
        ({"friction": "coulomb", "coulomb_force": 10.0, "friction_gradient": -1.0}, 0.01),  # floor
        ({"friction": "bouc_wen", "bw_stiffness": 8.0, "bw_ratio": 0.25}, 4.0),
    ],
)
def test_terms_by_hand(parameters: dict[str, float], force: float) -> None:
    device = ReferenceDevice(**parameters)  # type: ignore[arg-type]
    assert device.force(2.0, 3.0, 5.0) == pytest.approx(force, rel=1e-14)


def test_load_friction_opposes_the_velocity_whatever_the_acceleration() -> None:
    device = ReferenceDevice(inertance=10.0, load_friction=0.1)
    for v, a, force in [(1, 2, 22), (1, -2, -18), (-1, 2, 18), (-1, -2, -22)]:
        assert device.force(0.0, float(v), float(a)) == pytest.approx(force)


@settings(deadline=None, max_examples=100)
@given(
    st.floats(-0.1, 0.1), st.floats(-1, 1), st.floats(-50, 50), st.floats(0, 0.9), st.floats(1, 400)
)
def test_acceleration_inverts_force(x: float, v: float, a: float, mu: float, b: float) -> None:
    device = ReferenceDevice(
        inertance=b, load_friction=mu, viscous=3.0, stiffness=100.0, friction="coulomb",
        coulomb_force=5.0,
    )  # fmt: skip
    force = device.force(x, v, a)
    assert device.acceleration(x, v, force) == pytest.approx(a, rel=1e-9, abs=1e-10)


def test_level_separates_direction_and_position() -> None:
    device = ReferenceDevice(
        friction_asymmetry=0.3, friction_gradient=10.0, friction_curvature=-200.0
    )
    assert friction_level(device, 0.02, 1.0) == pytest.approx(1.3 * 1.12)
    assert friction_level(device, 0.02, -1.0) == pytest.approx(0.7 * 1.12)
    assert friction_level(device, -0.02, 0.0) == pytest.approx(0.72)
    assert friction_level(device, 1.0, 1.0) == pytest.approx(1.3e-3)  # the floor


def test_arrays_and_numbers_agree() -> None:
    rng = np.random.default_rng(1)
    x, v, a, z = rng.normal(size=(4, 20)) * [[0.01], [0.1], [3.0], [1e-4]]
    for friction in ("none", "coulomb", "stribeck", "dahl", "lugre", "bouc_wen", "brown_mcphee"):
        device = ReferenceDevice(
            inertance=50.0, friction=friction, coulomb_force=10.0, static_force=14.0,
            bristle_damping=30.0, bw_stiffness=1e3, bw_exponent=1.5, friction_asymmetry=0.2,
            friction_gradient=5.0, load_friction=0.1,
        )  # fmt: skip
        together = np.asarray(device.force(x, v, a, z))
        alone = [float(device.force(*map(float, point))) for point in zip(x, v, a, z, strict=True)]
        np.testing.assert_allclose(together, alone, rtol=1e-13)
        rates = np.broadcast_to(device.state_rate(x, v, z), x.shape)
        alone = [
            float(device.state_rate(*map(float, point))) for point in zip(x, v, z, strict=True)
        ]
        np.testing.assert_allclose(rates, alone, rtol=1e-13)


@pytest.mark.parametrize(
    ("parameters", "words"),
    [
        ({"friction": "luger"}, "did you mean 'lugre'"),
        ({"inertance": -1.0}, "inertance: -1.0 kg is below 0"),
        ({"transition_velocity": 0.0}, "transition_velocity"),
        ({"bw_exponent": 0.5}, "bw_exponent"),
        ({"friction": "dahl"}, "coulomb_force"),
        ({"load_friction": 1.5}, "load_friction"),
        ({"stiffness": float("nan")}, "not finite"),
        ({"friction_asymmetry": 1.5}, "friction_asymmetry"),
    ],
)
def test_errors_name_the_parameter(parameters: dict[str, float], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        ReferenceDevice(**parameters)  # type: ignore[arg-type]
