"""The engine steps mjData that it made without plugins, for ranges of lengths: nothing may crash.

The compiler does so for every muscle without `lengthrange` and with `<lengthrange mode="all">`.
"""

from __future__ import annotations

import subprocess
import sys

import mujoco
import numpy as np
import pytest
from plugin_models import plugin_actuator

MODEL = """
<mujoco>
  <extension><plugin plugin="inerter.device"/></extension>
  <option gravity="0 0 0"/>
  <compiler><lengthrange {mode} inttotal="10"/></compiler>
  <worldbody>
    <body><joint name="a" type="slide" range="-1 1" limited="true" damping="2"/>
      <geom size="0.1"/></body>
    <body name="leg" pos="1 0 0">
      <joint name="b" range="-90 90" limited="true" damping="1"/><geom size="0.1" pos="0.1 0 0"/>
      <site name="end" pos="0.2 0 0"/>
    </body>
    <site name="ground" pos="1.5 0.6 0.3"/>
  </worldbody>
  <tendon>
    <fixed name="two"><joint joint="a" coef="1"/><joint joint="b" coef="-0.3"/></fixed>
    <spatial name="strut"><site site="ground"/><site site="end"/></spatial>
  </tendon>
  <actuator>{actuators}</actuator>
</mujoco>"""
MUSCLE = '<muscle name="muscle" joint="b"/>'
DEVICES = {
    "native": plugin_actuator({"inertance": 2}, 'joint="a"'),
    "coupled": plugin_actuator({"inertance": 2}, 'tendon="two"'),
    "between points": plugin_actuator({"inertance": 2}, 'tendon="strut"'),
    "with a state": plugin_actuator(
        {"inertance": 2, "friction": "lugre", "coulomb_force": 1}, 'joint="a"',
        attributes='actdim="1"',
    ),
    "elastic": plugin_actuator(
        {"inertance": 2, "series_stiffness": 1e3}, 'tendon="two"', attributes='actdim="2"'
    ),
}  # fmt: skip


@pytest.mark.parametrize("mode", ["", 'mode="all"'], ids=["muscle", "all"])
@pytest.mark.parametrize("name", DEVICES)
def test_the_compiler_finds_ranges_of_lengths(name: str, mode: str) -> None:
    # in a process of its own, so that a crash is a failure and not the end
    code = """
import inerter, mujoco
inerter.load_plugin()
for actuators in ({0!r} + {1!r}, {1!r} + {0!r}):
    model = mujoco.MjModel.from_xml_string({2!r}.replace("ACTUATORS", actuators))
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 5)
    span = model.actuator("muscle").lengthrange
    assert span[0] < -1.5 and span[1] > 1.5, span
""".format(DEVICES[name], MUSCLE, MODEL.format(mode=mode, actuators="ACTUATORS"))
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-2000:]


def test_a_range_of_lengths_can_be_asked_for() -> None:
    model = mujoco.MjModel.from_xml_string(
        MODEL.format(mode="", actuators=DEVICES["coupled"] + MUSCLE)
    )
    data, option = mujoco.MjData(model), mujoco.MjLROpt()
    option.mode, option.accel, option.timeconst = mujoco.mjtLRMode.mjLRMODE_ALL, 20, 1
    option.timestep, option.inttotal, option.interval, option.tolrange = 0.01, 10, 2, 0.05
    mujoco.mj_setLengthRange(model, data, 0, option)
    assert np.isfinite(model.actuator_lengthrange).all()
    assert model.actuator_lengthrange[0, 0] < -1 < 1 < model.actuator_lengthrange[0, 1]


def test_specs_compile_again_and_again() -> None:
    spec = mujoco.MjSpec.from_string(MODEL.format(mode="", actuators=DEVICES["coupled"] + MUSCLE))
    for mass in (1.0, 2.0, 3.0):
        spec.body("leg").geoms[0].mass = mass
        model = spec.compile()
        data = mujoco.MjData(model)
        mujoco.mj_step(model, data, 5)
        assert np.isfinite(data.qpos).all()
