"""Friction behind the series element in the engine: every integrator goes to the same motion."""

from typing import Any

import mujoco
import numpy as np
import pytest

MODEL = """
<mujoco>
  <extension><plugin plugin="inerter.device"/></extension>
  <option timestep="{step}" integrator="{integrator}" gravity="0 0 0"/>
  <worldbody>
    <body>
      <joint name="slide" type="slide" axis="1 0 0" stiffness="2000"/>
      <geom size="0.1" mass="10"/>
    </body>
  </worldbody>
  <actuator>
    <plugin name="strut" plugin="inerter.device" joint="slide" actdim="{states}">{keys}</plugin>
  </actuator>
</mujoco>
"""
STRUT = {"inertance": 30, "series_stiffness": 5e4, "series_damping": 100}
LAWS: dict[str, dict[str, Any]] = {
    "coulomb": {"coulomb_force": 10, "transition_velocity": 1e-2},
    "lugre": {"coulomb_force": 10, "static_force": 14, "bristle_damping": 100},
}


def run(law: str, integrator: str, step: float, side: str = "flywheel") -> np.ndarray:
    values = {**STRUT, "friction": law, "friction_side": side, **LAWS[law]}
    keys = "".join(f'<config key="{key}" value="{value}"/>' for key, value in values.items())
    states = 3 if law == "lugre" else 2
    model = mujoco.MjModel.from_xml_string(
        MODEL.format(step=step, integrator=integrator, states=states, keys=keys)
    )
    data = mujoco.MjData(model)
    data.qpos[0] = 0.02
    found = []
    for _ in range(100):
        for _ in range(round(4e-3 / step)):
            mujoco.mj_step(model, data)
        found.append(data.qpos[0])
    return np.array(found)


@pytest.mark.parametrize("law", LAWS)
def test_implicit_steps_converge_to_the_stages_of_runge_kutta(law: str) -> None:
    true = run(law, "RK4", 5e-5)
    coarse, fine = (np.max(abs(run(law, "implicitfast", h) - true)) for h in (4e-4, 1e-4))
    assert coarse < 4e-5
    assert fine == pytest.approx(coarse / 4.0, rel=0.1)
    assert np.max(abs(run(law, "Euler", 1e-4) - true)) == pytest.approx(fine, rel=1e-6)
    # and it is another motion than that of friction at the terminals
    assert np.max(abs(run(law, "RK4", 1e-4, "terminals") - true)) > 1e-5
