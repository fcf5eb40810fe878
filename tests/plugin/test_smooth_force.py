"""The smooth force that coupled devices are solved with: put together, or by a second forward pass.

A model without limits lets the plugin add up the smooth force itself. A force limit that is never
reached makes it ask the engine instead: both motions are the same.
"""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from plugin_models import INTEGRATORS

MODEL = """
<mujoco>
  <extension><plugin plugin="inerter.device"/></extension>
  <option timestep="1e-3" integrator="{integrator}"/>
  <worldbody>
    <body pos="0 0 1">
      <joint name="arm" type="hinge" axis="0 1 0" damping="0.2"/>
      <geom type="capsule" size="0.03" fromto="0 0 0 0.6 0 0" mass="2"/>
      <site name="a" pos="0.6 0 0"/>
    </body>
    <body name="free" pos="0.7 0.1 0.4"><freejoint/>
      <geom type="box" size="0.1 0.07 0.05" mass="3" contype="0" conaffinity="0"/>
      <site name="b" pos="0 0 0.05"/>
    </body>
    <body pos="0.2 0 0">
      <joint name="slide" type="slide" axis="0 0 1" stiffness="300"/>
      <geom size="0.05" mass="1" contype="0" conaffinity="0"/>
      <site name="c"/>
    </body>
  </worldbody>
  <tendon>
    <spatial name="ab" stiffness="100" damping="2"><site site="a"/><site site="b"/></spatial>
    <spatial name="bc"><site site="b"/><site site="c"/></spatial>
  </tendon>
  <actuator>
    <position joint="slide" kp="50" {limit}/>
    <general tendon="bc" dyntype="filter" dynprm="0.05" gainprm="4"/>
    {motor}
    <plugin plugin="inerter.device" tendon="ab">
      <config key="inertance" value="4"/><config key="quadratic_damping" value="3"/>
    </plugin>
    <plugin plugin="inerter.device" tendon="bc">
      <config key="inertance" value="2"/><config key="friction" value="coulomb"/>
      <config key="coulomb_force" value="1"/><config key="transition_velocity" value="0.1"/>
    </plugin>
  </actuator>
</mujoco>
"""

# what a motor adds after the plugins have been asked
MOTORS = {
    "no motor": None,
    "motor": "",
    "cogging": 'cogging="5 3 1"',
    "friction": 'lugre="1e4 100 5 6 0.01"',
}


def moved(integrator: str, motor: str | None, limit: str) -> np.ndarray:
    """Positions and velocities under controls and forces of all kinds."""
    if motor is not None:
        motor = f'<dcmotor joint="arm" motorconst="0.3 0.3" resistance="0.5" {motor}/>'
    xml = MODEL.format(integrator=integrator, motor=motor or "", limit=limit)
    model = mujoco.MjModel.from_xml_string(xml)
    assert model.actuator_forcelimited.any() == bool(limit)
    data, rng, path = mujoco.MjData(model), np.random.default_rng(1), []
    for k in range(40):
        data.ctrl[:] = rng.uniform(-1, 1, model.nu)
        data.qfrc_applied[:] = rng.normal(size=model.nv)
        data.xfrc_applied[:] = 0
        if k >= 20:
            data.xfrc_applied[2, :3] = rng.normal(size=3)
        mujoco.mj_step(model, data, 3)
        path.append(np.concatenate([data.qpos, data.qvel]))
    return np.array(path)


@pytest.mark.parametrize("motor", MOTORS.values(), ids=MOTORS)
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_the_smooth_force_is_the_engine_s(integrator: str, motor: str | None) -> None:
    own = moved(integrator, motor, "")
    engine = moved(integrator, motor, 'forcelimited="true" forcerange="-1e6 1e6"')
    assert np.abs(own - engine).max() < 1e-10 * np.abs(engine).max()
    assert np.ptp(own, axis=0).max() > 0.1


@pytest.mark.parametrize("integrator", ["Euler", "implicit", "implicitfast", "discrete"])
def test_friction_holds_a_motor_that_cogs(integrator: str) -> None:
    """20 N of friction against 5 N of cogging, the inertance being the engine's."""
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><extension><plugin plugin="inerter.device"/></extension>
        <option integrator="{integrator}" gravity="0 0 0"/>
        <worldbody><body><joint name="x" type="slide"/><geom size="0.1" mass="1"/></body>
        </worldbody>
        <actuator>
          <dcmotor joint="x" motorconst="1 1" resistance="1" cogging="5 3 1"/>
          <plugin plugin="inerter.device" joint="x"><config key="inertance" value="3"/>
            <config key="friction" value="coulomb"/><config key="coulomb_force" value="20"/>
          </plugin>
        </actuator></mujoco>"""
    )
    assert model.actuator_armature[1] == 3
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 500)
    # what is left is the creep of tanh(v / transition_velocity)
    assert 0 < data.qvel[0] < 1e-4
