"""A step by `mj_step1` and `mj_step2`, where the engine turns RK4 into Euler."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from plugin_models import instance_actuator

SERIES = {"inertance": 1, "series_stiffness": 1e5, "series_damping": 100}
DAHL = {"inertance": 1, "friction": "dahl", "coulomb_force": 3, "bristle_stiffness": 1e4}


def swing(keys: dict, integrator: str, step: float, *, halves: bool) -> np.ndarray:
    """Position, velocity and heat of 2 kg on a spring after a second, the device beside it."""
    instance, actuator, sensor = instance_actuator(keys, 'joint="x"')
    if "series_stiffness" in keys:
        actuator = actuator.replace("/>", ' actdim="2"/>')
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><extension><plugin plugin="inerter.device">{instance}</plugin></extension>
        <option integrator="{integrator}" gravity="0 0 0" timestep="{step}"/>
        <worldbody><body><joint name="x" type="slide" stiffness="500"/>
          <geom size="0.1" mass="2"/></body></worldbody>
        <actuator>{actuator}</actuator><sensor>{sensor}</sensor></mujoco>"""
    )
    data = mujoco.MjData(model)
    data.qvel[0] = 0.5
    for _ in range(round(1 / step)):
        if halves:
            mujoco.mj_step1(model, data)
            mujoco.mj_step2(model, data)
        else:
            mujoco.mj_step(model, data)
    return np.array([data.qpos[0], data.qvel[0], data.plugin_state[0]])


@pytest.mark.parametrize("keys", [SERIES, DAHL], ids=["series", "dahl"])
@pytest.mark.parametrize("integrator", ["Euler", "implicit", "implicitfast", "discrete"])
def test_two_halves_are_a_step(integrator: str, keys: dict) -> None:
    whole = swing(keys, integrator, 2e-3, halves=False)
    np.testing.assert_array_equal(swing(keys, integrator, 2e-3, halves=True), whole)


def test_halves_of_rk4_are_euler() -> None:
    euler = swing(DAHL, "Euler", 2e-3, halves=False)
    np.testing.assert_array_equal(swing(DAHL, "RK4", 2e-3, halves=True), euler)


def test_halves_of_rk4_converge_with_a_series_element() -> None:
    """In first order."""
    truth = swing(SERIES, "RK4", 2e-4, halves=False)
    steps = 2e-3 / 2 ** np.arange(4)
    errors = [np.abs(swing(SERIES, "RK4", h, halves=True) - truth)[:2].max() for h in steps]
    assert errors[0] < 0.1 * 0.5
    assert np.log2(np.divide(errors[:-1], errors[1:])).min() > 0.8
