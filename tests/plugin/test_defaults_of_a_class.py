"""What a class of defaults in MJCF gives an actuator reaches no device, or is refused."""

from __future__ import annotations

import inerter
import mujoco
import pytest
from plugin_models import INTEGRATORS

GAINS = (
    '<general biastype="affine" gainprm="2000" biasprm="0 -2000 -400"/>',
    '<position kp="100" kv="10"/>',
    '<position kp="100" dampratio="1"/>',
    '<velocity kv="10"/>',
)


def mass_with_inerter(default: str, integrator: str) -> mujoco.MjModel:
    assert inerter.__version__
    return mujoco.MjModel.from_xml_string(f"""
<mujoco>
  <extension><plugin plugin="inerter.device">
    <instance name="d"><config key="inertance" value="3"/></instance>
  </plugin></extension>
  <default>{default}</default>
  <option integrator="{integrator}" gravity="0 0 0"/>
  <worldbody>
    <body><joint name="x" type="slide"/><geom size="0.1" mass="2" contype="0"/></body>
  </worldbody>
  <actuator><plugin name="d" plugin="inerter.device" joint="x" instance="d"/></actuator>
  <sensor><plugin plugin="inerter.device" instance="d"/></sensor>
</mujoco>""")


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("default", GAINS)
def test_gains_say_nothing_to_a_device(default: str, integrator: str) -> None:
    """5 N on 2 kg and an inertance of 3 kg: 1 m/s after a second."""
    model = mass_with_inerter(default, integrator)
    data = mujoco.MjData(model)
    data.qfrc_applied[0] = 5.0
    mujoco.mj_step(model, data, 500)
    assert data.qvel[0] == pytest.approx(1.0, rel=1e-9)
    assert data.sensordata[0] == pytest.approx(3.0, rel=1e-9)


def test_a_range_of_the_control_without_0_is_refused() -> None:
    with pytest.raises(ValueError, match="ctrlrange is 1 to 2, without 0") as caught:
        mass_with_inerter('<general ctrlrange="1 2"/>', "Euler")
    assert 'ctrllimited="false"' in str(caught.value)
    assert mass_with_inerter('<general ctrlrange="-1 2"/>', "Euler").nu == 1
