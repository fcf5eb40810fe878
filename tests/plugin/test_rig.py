"""Does a device on the simulated test rig give the force that the core gives along a motion?"""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
import pytest
from inerter import Device
from inerter.reference import ReferenceDevice, response, sine_motion
from inerter.rig import device_mjcf, simulate_along
from plugin_models import FRICTION

H = 1e-3
T = np.arange(3000) * H
# two tones, so that reversals have many amplitudes
W1, W2 = 2 * np.pi * 2, 2 * np.pi * 5.3
X = 5e-3 * np.sin(W1 * T) + 1e-3 * np.sin(W2 * T)
V = 5e-3 * W1 * np.cos(W1 * T) + 1e-3 * W2 * np.cos(W2 * T)
A = -5e-3 * W1**2 * np.sin(W1 * T) - 1e-3 * W2**2 * np.sin(W2 * T)


def device(law: str) -> Device:
    return Device(
        inertance=113,
        viscous=40,
        stiffness=500,
        # the level of a bristle that follows the load is stepped with the acceleration of the step
        load_friction=0.0 if Device(friction=law, **FRICTION[law]).nstate else 0.03,
        inertance_gradient=20,
        friction=law,
        **FRICTION[law],
    )


@pytest.mark.parametrize("law", FRICTION)
def test_the_rig_and_the_core_agree(law: str) -> None:
    state = 1e-4 if device(law).nstate else 0.0
    rig = simulate_along(device(law), H, X, V, A, state)
    core = device(law).along(H, X, V, A, state)
    for channel in ("total", "friction", "state"):
        scale = np.abs(core[channel]).max() or 1.0
        assert np.abs(rig[channel] - core[channel]).max() < 1e-8 * scale, channel


@pytest.mark.parametrize("series", [{}, {"series_stiffness": 4e5, "series_damping": 3e3}])
def test_every_so_many_samples_are_the_same(series: dict[str, Any]) -> None:
    given = Device(
        inertance=113, friction="dahl", coulomb_force=20, bristle_stiffness=1e5, **series
    )
    count = 2801
    all_of_them = simulate_along(given, H, X[:count], V[:count], A[:count])
    some = simulate_along(given, H, X[:count], V[:count], A[:count], every=7)
    assert {name: len(values) for name, values in some.items()} == dict.fromkeys(some, 401)
    for name, values in some.items():
        assert np.array_equal(values, all_of_them[name][::7]), name


def test_a_short_step_behind_a_play_is_one() -> None:
    """A flywheel that flies, between samples 20 us apart, against the reference."""
    given: dict[str, Any] = {
        "inertance": 30.0, "series_stiffness": 5e5, "series_damping": 6e3, "backlash": 3e-4,
    }  # fmt: skip
    times = 2e-5 * np.arange(10_001)
    w = 2 * np.pi * 9
    motion = sine_motion(2e-3, 9.0)
    x, v, a = (
        2e-3 * np.sin(w * times),
        2e-3 * w * np.cos(w * times),
        -2e-3 * w**2 * np.sin(w * times),
    )
    state = np.zeros(Device(**given).nstate)
    truth = response(ReferenceDevice(**given), motion, times, initial_state=state, rtol=1e-10).force
    found = simulate_along(Device(**given), 2e-5, x, v, a, state, every=10)["total"]
    error = np.sqrt(np.mean((found - truth[::10]) ** 2)) / np.std(truth)
    assert error < 1e-3


@pytest.mark.parametrize("law", FRICTION)
def test_the_written_model_is_the_device(law: str) -> None:
    text = device_mjcf(device(law), "bench")
    assert '<mujoco model="bench">' in text
    model = mujoco.MjModel.from_xml_string(text)
    assert model.actuator_armature[1] == 113
    assert model.na == device(law).nstate
    data = mujoco.MjData(model)
    data.qpos[0], data.qvel[0], data.ctrl[0] = X[100], V[100], A[100]

    # the stages of RK4 feel the force of the instant; other integrators that of the end of the step
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
    mujoco.mj_forward(model, data)
    expected = device(law).evaluate(X[100], V[100], A[100], 0.0)["total"][0]
    assert data.sensordata[0] == pytest.approx(expected, rel=1e-8)


def test_wrong_input_is_named() -> None:
    with pytest.raises(ValueError, match="one length"):
        simulate_along(device("none"), H, X, V[:-1], A)
    with pytest.raises(ValueError, match="every is 7: give a divisor of the 2999 sample spacings"):
        simulate_along(Device(inertance=1), H, X, V, A, every=7)
    with pytest.raises(ValueError, match="h is 0"):
        simulate_along(device("none"), 0, X, V, A)
