"""A Gymnasium environment with a device, in a module of its own: its processes import it."""

from __future__ import annotations

from typing import Any, ClassVar

import mujoco
import numpy as np
from gymnasium.envs.mujoco import MujocoEnv
from gymnasium.spaces import Box
from inerter import add_device

LEG = """
<mujoco>
  <option timestep="0.002" integrator="implicitfast"/>
  <default><joint damping="1"/><motor ctrlrange="-1 1" gear="40"/></default>
  <worldbody>
    <geom type="plane" size="5 5 0.1"/>
    <body name="hull" pos="0 0 0.7">
      <joint name="lift" type="slide" axis="0 0 1" damping="0"/>
      <geom size="0.1" mass="4"/>
      <body name="shank" pos="0 0 -0.2">
        <joint name="knee" type="slide" axis="0 0 1" range="-0.2 0.2"/>
        <geom type="capsule" fromto="0 0 0 0 0 -0.3" size="0.04" mass="0.8"/>
      </body>
    </body>
  </worldbody>
  <actuator><motor name="knee" joint="knee"/></actuator>
</mujoco>"""


def leg_xml() -> str:
    """A leg whose knee carries an inerter with LuGre friction."""
    spec = mujoco.MjSpec.from_string(LEG)
    add_device(
        spec, "strut", between=(("hull", (0.05, 0, 0)), ("shank", (0.05, 0, -0.1))),
        rest_length="initial", inertance=1.5, friction="lugre", coulomb_force=3.0,
        bristle_stiffness=2e4, stiffness=300.0,
    )  # fmt: skip
    spec.compile()
    return spec.to_xml()


class LegEnv(MujocoEnv):
    """Hop: the action is the knee's motor, the device's own control stays 0."""

    metadata: ClassVar[dict[str, Any]] = {
        "render_modes": ["human", "rgb_array", "depth_array", "rgbd_tuple"],
        "render_fps": 100,
    }

    def __init__(self, path: str) -> None:
        super().__init__(path, 5, Box(-np.inf, np.inf, (5,), np.float64))
        self.action_space = Box(-1, 1, (1,), dtype=np.float32)

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Five steps of the engine."""
        control = np.zeros(self.model.nu)
        control[: len(action)] = action
        self.do_simulation(control, self.frame_skip)
        return self._observation(), float(self.data.qpos[0]), False, False, {}

    def reset_model(self) -> Any:
        """Start a little moved, by the seed."""
        noise = self.np_random.uniform(-0.02, 0.02, self.model.nq + self.model.nv)
        self.set_state(self.init_qpos + noise[: self.model.nq], noise[self.model.nq :])
        return self._observation()

    def _observation(self) -> Any:
        return np.concatenate([self.data.qpos, self.data.qvel, self.data.act])


class Make:
    """A maker of environments that can be sent to a process."""

    def __init__(self, path: str) -> None:
        self.path = path

    def __call__(self) -> LegEnv:
        """Make one."""
        return LegEnv(self.path)
