"""A device whose control nobody asks for adds none, and moves as the one that has it."""

from __future__ import annotations

from pathlib import Path
from typing import Any, ClassVar

import inerter
import mujoco
import numpy as np
import pytest
from plugin_models import FRICTION, INTEGRATORS, instance_actuator, plugin_actuator

MODEL = """
<mujoco>
  <extension><plugin plugin="inerter.device">{instance}</plugin></extension>
  <option timestep="1e-3" integrator="{integrator}"/>
  <worldbody>
    <body name="low"><joint name="low" type="slide" axis="0 0 1" stiffness="500"/>
      <geom size=".1" mass="2"/></body>
    <body name="high" pos="0 0 1"><joint name="high" type="slide" axis="0 0 1" stiffness="300"/>
      <geom size=".1" mass="3"/></body>
  </worldbody>
  <tendon><fixed name="strut"><joint joint="low" coef="-1"/><joint joint="high" coef="1"/></fixed>
  </tendon>
  <actuator>
    <motor name="first" joint="low"/>{actuators}<motor name="last" joint="high" gear="2"/>
  </actuator>
  <sensor>{sensor}</sensor>
</mujoco>"""


def spec_of(integrator: str, law: str) -> mujoco.MjSpec:
    keys = {"inertance": 2, "friction": law, **FRICTION[law]}
    instance, strut, sensor = instance_actuator(keys)
    wheel = plugin_actuator({"inertance": 1}, 'joint="low"', "wheel")
    return mujoco.MjSpec.from_string(
        MODEL.format(
            integrator=integrator, instance=instance, actuators=strut + wheel, sensor=sensor
        )
    )


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("law", ["none", "coulomb", "dahl"])
def test_the_motion_is_the_same(integrator: str, law: str) -> None:
    whole, motors = spec_of(integrator, law), spec_of(integrator, law)
    assert inerter.without_controls(motors) == ["strut", "wheel"]
    models = [whole.compile(), motors.compile()]
    assert [model.nu for model in models] == [4, 2]
    assert [model.nactuator for model in models] == [4, 4]
    assert [inerter.device_controls(model) for model in models] == [[1, 2], []]
    rows = []
    for model, places in zip(models, ([0, 3], [0, 1]), strict=True):
        data = mujoco.MjData(model)
        seen = []
        for i in range(200):
            data.ctrl[places] = 5 * np.sin(0.1 * i), 3 * np.cos(0.07 * i)
            mujoco.mj_step(model, data)
            seen.append(np.concatenate([data.qpos, data.qvel, data.act, data.sensordata]))
        rows.append(np.array(seen))
    np.testing.assert_array_equal(*rows)
    assert np.abs(rows[0][:, 2:4]).max() > 0.1


def test_an_added_device_has_a_control_only_where_it_is_asked_for() -> None:
    for control in (False, True):
        spec = spec_of("Euler", "none")
        inerter.add_device(spec, "more", joint="high", inertance=1, control=control)
        assert spec.compile().nu == 4 + control


def test_the_actions_of_an_environment_are_those_of_its_motors(tmp_path: Path) -> None:
    gymnasium = pytest.importorskip("gymnasium")
    mujoco_env = pytest.importorskip("gymnasium.envs.mujoco")
    from inerter.gymnasium import WithoutDeviceControls

    path = tmp_path / "model.xml"
    path.write_text(spec_of("Euler", "none").to_xml())

    class Environment(mujoco_env.MujocoEnv):
        metadata: ClassVar = {"render_modes": ["human", "rgb_array", "depth_array", "rgbd_tuple"]}

        def __init__(self) -> None:
            space = gymnasium.spaces.Box(-np.inf, np.inf, (4,))
            super().__init__(str(path), 1, observation_space=space)

        def step(self, action: np.ndarray) -> tuple:
            self.do_simulation(action, self.frame_skip)
            return np.concatenate([self.data.qpos, self.data.qvel]), 0.0, False, False, {}

        def reset_model(self) -> np.ndarray:
            return np.concatenate([self.data.qpos, self.data.qvel])

    env = WithoutDeviceControls(Environment())
    env.reset(seed=0)
    assert env.action_space.shape == (2,)
    env.step(np.array([0.25, 0.5], dtype=np.float32))
    unwrapped: Any = env.unwrapped
    assert unwrapped.data.ctrl.tolist() == [0.25, 0, 0, 0.5]
    with pytest.raises(ValueError, match="the model has 4 controls"):
        WithoutDeviceControls(env)
    env.close()
