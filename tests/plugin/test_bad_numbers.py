"""A number that is none never travels in silence: the plugin names it and goes on without it."""

from __future__ import annotations

import copy

import mujoco
import numpy as np
import pytest
from plugin_models import FRICTION, INTEGRATORS, plugin_actuator, quarter_car_xml

CASES: dict[str, tuple[dict, str]] = {
    "dahl": ({"friction": "dahl", **FRICTION["dahl"]}, "friction_state"),
    "lugre": ({"friction": "lugre", **FRICTION["lugre"]}, "friction_state"),
    "bouc_wen": ({"friction": "bouc_wen", **FRICTION["bouc_wen"]}, "friction_state"),
    "series": (
        {"series_stiffness": 1e4, "series_damping": 10, "backlash": 1e-3}, "series_deflection"),
}  # fmt: skip


def started(keys: dict, integrator: str) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """A quarter-car with a sensed device, after some steps."""
    states = 3 if "backlash" in keys else 1
    instance = f'<instance name="strut">{config({"inertance": 20, **keys})}</instance>'
    actuator = (
        '<plugin name="strut" instance="strut" plugin="inerter.device" tendon="strut" '
        f'actdim="{states}"/>'
    )
    sensor = '<plugin name="strut" instance="strut" plugin="inerter.device"/>'
    option = f'timestep="1e-4" integrator="{integrator}"'
    xml = quarter_car_xml(actuator, instance=instance, sensor=sensor, option=option)
    model = mujoco.MjModel.from_xml_string(xml)
    data = mujoco.MjData(model)
    data.qvel[:] = 0.3, -0.3
    mujoco.mj_step(model, data, 5)
    return model, data


def config(keys: dict) -> str:
    return "".join(f'<config key="{key}" value="{value}"/>' for key, value in keys.items())


def said(capfd: pytest.CaptureFixture) -> str:
    text = capfd.readouterr()
    return text.err + text.out


def all_finite(data: mujoco.MjData) -> bool:
    rows = (data.qpos, data.qvel, data.act, data.sensordata, data.plugin_state)
    return all(np.all(np.isfinite(row)) for row in rows)


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_state_that_is_no_number(
    capfd: pytest.CaptureFixture, case: str, integrator: str, value: float
) -> None:
    keys, name = CASES[case]
    model, data = started(keys, integrator)
    moving = data.qvel.copy()
    said(capfd)
    data.act[0] = value
    mujoco.mj_forward(model, data)
    assert not data.act.any(), "unloaded"
    mujoco.mj_step(model, data, 3)
    text = said(capfd)
    assert text.count(f'instance "strut": {name} is {value}, no finite number') == 1
    assert "shorten the timestep" in text
    assert "relaxes within" not in text
    assert all_finite(data)
    # the car goes on: the engine has had no reason to start anew
    np.testing.assert_allclose(data.qvel, moving, atol=0.05)
    assert np.all(np.abs(data.qvel) > 0.1)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_heat_that_is_no_number(capfd: pytest.CaptureFixture, integrator: str) -> None:
    model, data = started(CASES["dahl"][0], integrator)
    sound = copy.copy(data)
    data.plugin_state[0] = np.nan
    for each in (data, sound):
        mujoco.mj_step(model, each)
    assert np.isfinite(data.sensordata).all()
    assert said(capfd).count("its dissipated energy is nan J") == 1
    assert data.plugin_state[0] == 0
    counted = sound.plugin_state[0]
    for each in (data, sound):
        mujoco.mj_step(model, each)
    assert data.plugin_state[0] == pytest.approx(sound.plugin_state[0] - counted, rel=1e-9)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_force_that_overflows_is_named(capfd: pytest.CaptureFixture, integrator: str) -> None:
    # the engine's discrete integrator drops such a force without a word
    xml = quarter_car_xml(
        plugin_actuator({"inertance": 20, "stiffness": 1e305, "stiffness_cubic": -1e305}),
        option=f'integrator="{integrator}"',
    )
    model = mujoco.MjModel.from_xml_string(xml)
    data = mujoco.MjData(model)
    data.qpos[1] = 1e4
    said(capfd)
    mujoco.mj_forward(model, data)
    text = said(capfd)
    assert text.count('actuator "strut": its force is') == 1
    assert "at displacement 10000 m" in text
