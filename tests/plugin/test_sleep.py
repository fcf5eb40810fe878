"""Trees that fall asleep elsewhere in the model do not touch a device."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from plugin_models import FRICTION, INTEGRATORS, instance_actuator


def run(integrator: str, law: str, sleep: str, steps: int = 400) -> tuple[np.ndarray, int]:
    """Rows (x, v, act, heat) of a device that swings beside a slider; when that falls asleep."""
    keys = {"inertance": 3, "series_stiffness": 800, "series_damping": 4}
    if law != "series":
        keys = {"inertance": 3, "friction": law, **FRICTION[law]}
    instance, actuator, sensor = instance_actuator(keys, 'joint="x"')
    if law == "series":
        actuator = actuator.replace("/>", ' actdim="2"/>')
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><extension><plugin plugin="inerter.device">{instance}</plugin></extension>
        <option integrator="{integrator}" gravity="0 0 0" sleep_tolerance="1e-3">
          <flag contact="disable" sleep="{sleep}"/></option>
        <worldbody>
          <body sleep="never"><joint name="x" type="slide" stiffness="5e3"/>
            <geom size="0.1" mass="1"/></body>
          <body><joint name="y" type="slide" damping="8"/><geom size="0.1" mass="1"/></body>
        </worldbody>
        <actuator>{actuator}</actuator><sensor>{sensor}</sensor></mujoco>"""
    )
    data = mujoco.MjData(model)
    data.qvel[:] = 0.5, 0.3
    rows, asleep = [], 0
    for step in range(steps):
        mujoco.mj_step(model, data)
        rows.append([data.qpos[0], data.qvel[0], *data.act, *data.plugin_state])
        asleep = asleep or (data.tree_asleep[1] >= 0) * step
    return np.array(rows), asleep


@pytest.mark.parametrize("law", ["dahl", "lugre", "series"])
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_tree_that_falls_asleep_does_not_touch_a_device(integrator: str, law: str) -> None:
    (awake, never), (slept, when) = (run(integrator, law, flag) for flag in ("disable", "enable"))
    assert never == 0
    assert 50 < when < 390
    assert np.abs((slept - awake) / np.abs(awake).max(axis=0)).max() < 1e-9
