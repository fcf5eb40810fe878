"""MuJoCo's own least squares finds a device by its live parameters."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from mujoco import minimize

SLIDER = """
<mujoco>
  <extension><plugin plugin="inerter.device"/></extension>
  <option timestep="0.001" integrator="implicitfast"/>
  <custom>
    <numeric name="strut.inertance" data="1"/><numeric name="strut.coulomb_force" data="0.5"/>
  </custom>
  <worldbody>
    <body><joint name="a" type="slide" stiffness="50"/><geom size="0.1" mass="1"/></body>
  </worldbody>
  <actuator>
    <plugin name="strut" plugin="inerter.device" joint="a">
      <config key="inertance" value="1"/>
      <config key="friction" value="coulomb"/><config key="coulomb_force" value="0.5"/>
    </plugin>
  </actuator>
</mujoco>"""
TRUTH = np.array([2.5, 1.7])


def test_live_parameters_are_fitted() -> None:
    """From another device the one that made the motion, to the solver's tolerance."""
    model = mujoco.MjModel.from_xml_string(SLIDER)
    data = mujoco.MjData(model)

    def motion(values: np.ndarray) -> np.ndarray:
        for name, value in zip(("strut.inertance", "strut.coulomb_force"), values, strict=True):
            model.numeric(name).data[0] = value
        mujoco.mj_resetData(model, data)
        data.qvel[0] = 1
        found = []
        for _ in range(200):
            mujoco.mj_step(model, data)
            found.append(data.qpos[0])
        return np.array(found)

    measured = motion(TRUTH)

    def residual(columns: np.ndarray) -> np.ndarray:
        """Of each column of values a column, as `minimize` asks."""
        return np.stack([motion(column) - measured for column in columns.T], axis=-1)

    found, _ = minimize.least_squares(
        np.array([1.0, 0.5]), residual, bounds=[np.array([0.1, 0]), np.array([10.0, 10])], verbose=0
    )
    assert found == pytest.approx(TRUTH, rel=1e-5)
