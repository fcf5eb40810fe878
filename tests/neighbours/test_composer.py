"""Devices in entities of dm_control's Composer: their own, and one between two of them.

dm_control 1.0.50 does not run on MuJoCo 4: `make versions` runs this with 3.17.
"""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
import pytest
from inerter import device_of

pytestmark = pytest.mark.filterwarnings("ignore")
if int(mujoco.mj_versionString().split(".")[0]) > 3:
    pytest.skip("dm_control 1.0.50 asks MuJoCo 4 for what it has no more", allow_module_level=True)
composer: Any = pytest.importorskip("dm_control.composer")
mjcf: Any = pytest.importorskip("dm_control.mjcf")

LEG = """
<mujoco>
  <extension><plugin plugin="inerter.device"><instance name="strut">
    <config key="inertance" value="1.5"/><config key="friction" value="lugre"/>
    <config key="coulomb_force" value="3"/><config key="bristle_stiffness" value="2e4"/>
  </instance></plugin></extension>
  <custom><numeric name="strut.coulomb_force" data="3"/></custom>
  <worldbody><body name="shank">
    <joint name="knee" type="slide" axis="0 0 1"/>
    <geom type="capsule" fromto="0 0 0 0 0 -0.3" size="0.04" mass="0.8"/>
    <site name="foot" pos="0 0 -0.3"/>
  </body></worldbody>
  <actuator>
    <plugin name="strut" plugin="inerter.device" instance="strut" joint="knee" actdim="1"/>
  </actuator>
  <sensor><plugin name="strut" plugin="inerter.device" instance="strut"/></sensor>
</mujoco>"""
STEPS, TIMESTEP, EACH = 20, 0.001, 20


class Leg(composer.Entity):
    """A part with a device of its own."""

    def _build(self, name: str) -> None:
        self._root = mjcf.from_xml_string(LEG)
        self._root.model = name

    @property
    def mjcf_model(self) -> Any:
        """The part's tree."""
        return self._root


class TwoLegs(composer.Task):
    """Two legs in one arena, 40 kg of inertance between their feet."""

    def __init__(self) -> None:
        self._arena = composer.Arena()
        self._legs = [Leg("left"), Leg("right")]
        root = self._arena.mjcf_model
        root.option.integrator = "implicitfast"
        across = root.tendon.add("spatial", name="across")
        for x, leg in enumerate(self._legs):
            self._arena.attach(leg, root.worldbody.add("site", pos=(x, 0, 1)))
            across.add("site", site=leg.mjcf_model.find("site", "foot"))
        device = root.actuator.add(
            "plugin", name="across", plugin="inerter.device", tendon=across
        )  # fmt: skip
        device.add("config", key="inertance", value="40")
        self.set_timesteps(TIMESTEP * EACH, TIMESTEP)

    @property
    def root_entity(self) -> Any:
        """The arena."""
        return self._arena

    def initialize_episode(self, physics: Any, random_state: Any) -> None:
        """A push, by the seed."""
        physics.bind(self._legs[0].mjcf_model.find_all("joint")).qvel = random_state.uniform(0.2, 1)

    def get_reward(self, physics: Any) -> float:
        """None."""
        return 0.0


def environment() -> Any:
    return composer.Environment(TwoLegs(), time_limit=1.0, random_state=4)


def episode(env: Any) -> np.ndarray:
    env.reset()
    rows = []
    for _ in range(STEPS):
        env.step(np.zeros(env.action_spec().shape))
        rows.append(np.concatenate([env.physics.data.qpos, env.physics.data.act]))
    return np.array(rows)


def test_an_episode_is_the_engine() -> None:
    """The tree's XML, compiled and stepped by MuJoCo alone, and a second environment."""
    env = environment()
    env.reset()
    model = mujoco.MjModel.from_xml_string(env.task.root_entity.mjcf_model.to_xml_string())
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = env.physics.data.qpos, env.physics.data.qvel
    assert np.abs(data.qvel).max() > 0.1
    bare = []
    for _ in range(STEPS):
        mujoco.mj_step(model, data, EACH)
        bare.append(np.concatenate([data.qpos, data.act]))
    assert data.act.all(), "the bristles have moved"
    assert np.array_equal(episode(environment()), bare)


def test_names_with_the_entity_in_front() -> None:
    env = environment()
    env.reset()
    model = env.physics.model.ptr
    assert device_of(model, "left/strut").device.inertance == 1.5
    assert device_of(model, "across").device.inertance == 40
    model.numeric("right/strut.coulomb_force").data[0] = -1
    with pytest.raises(mujoco.FatalError, match='"right/strut": live parameters: coulomb_force'):
        env.step(np.zeros(env.action_spec().shape))
