"""Contacts beside strong joint damping, under integrators that solve constraints without it.

Euler with joint damping, implicit and implicitfast answer contacts with the plain inertia and step
with the damped one. An inertance of the engine's own matrix is felt in both; one that the plugin
carries has to be felt alike, in every step.
"""

from __future__ import annotations

import inerter
import mujoco
import numpy as np
import pytest
from numpy.typing import NDArray
from plugin_models import plugin_actuator

DAMPED = ("Euler", "implicit", "implicitfast")

# a finger of two links that presses a ball onto the floor, and a body of its own that is not moved
FINGER = """
<mujoco>
  <extension><plugin plugin="inerter.device"/></extension>
  <option timestep="2e-3" tolerance="1e-14" iterations="300" {option}/>
  <worldbody>
    <geom type="plane" size="2 2 0.1"/>
    <body pos="-0.05 0 0.15">
      <joint name="knuckle" axis="0 1 0" damping="0.02"/>
      <geom type="capsule" fromto="0 0 0 0.02 0 -0.06" size="0.011" mass="0.05"/>
      <body pos="0.02 0 -0.06">
        <joint name="middle" axis="0 1 0" damping="0.3" frictionloss="0.01"/>
        <geom type="capsule" fromto="0 0 0 0.03 0 -0.05" size="0.011" mass="0.05"/>
      </body>
    </body>
    <body pos="0.01 0 0.0345"><freejoint/><geom size="0.035" mass="0.1"/></body>
    <body pos="1 0 1">
      <joint name="far" type="slide" axis="1 0 0"/><geom size="0.05" mass="1"/>
    </body>
  </worldbody>
  <tendon>
    <fixed name="strut"><joint joint="knuckle" coef="1"/><joint joint="middle" coef="-0.7"/>
      {far}</fixed>
  </tendon>
  <actuator>{device}<motor name="push" joint="knuckle"/></actuator>
</mujoco>"""
FAR = '<joint joint="far" coef="1e-9"/>'


@pytest.mark.parametrize("cone", ["pyramidal", "elliptic"])
@pytest.mark.parametrize("integrator", DAMPED)
def test_contacts_feel_it_as_they_feel_the_engines_own(integrator: str, cone: str) -> None:
    """A joint elsewhere, along 1e-9 of its way, is all that leaves the inertance to the plugin."""
    paths, device, weights = [], plugin_actuator({"inertance": 0.01}), None
    for far in ("", FAR):
        option = f'integrator="{integrator}" cone="{cone}" gravity="0 0 -9.81"'
        xml = FINGER.format(option=option, far=far, device=device)
        model = mujoco.MjModel.from_xml_string(xml)
        assert (model.actuator_armature[0] > 0) == (not far)
        if weights:
            # the softness of constraints goes by the inertia that the engine knows
            model.dof_invweight0[:], model.body_invweight0[:] = weights
        weights = model.dof_invweight0.copy(), model.body_invweight0.copy()
        data = mujoco.MjData(model)
        rows, touched = [], 0
        for k in range(250):
            data.ctrl[-1] = 0.3 * np.sin(0.05 * k)
            mujoco.mj_step(model, data)
            rows.append(data.qpos[:9].copy())
            touched = max(touched, data.ncon)
        assert touched >= 2, "the finger presses the ball onto the floor"
        paths.append(np.array(rows))
    native, carried = paths
    assert np.ptp(native[:, 0]) > 0.02
    np.testing.assert_allclose(carried, native, atol=1e-6 * np.ptp(native, axis=0).max(), rtol=0)


# --------------------------- two fingers and a ball -----------------------------------------------

LINKS = """
  <body pos="{x} 0 0.25">
    <joint name="knuckle{k}" axis="0 {y} 0" damping="0.03"/>
    <geom type="capsule" fromto="0 0 0 0 0 -0.06" size="0.011" mass="0.05"/>
    <body pos="0 0 -0.06">
      <joint axis="0 {y} 0" damping="0.3"/>
      <geom type="capsule" fromto="0 0 0 {tip} 0 -0.06" size="0.011" mass="0.05"/>
      <site name="tip{k}" pos="{tip} 0 -0.06"/>
    </body>
  </body>"""
FINGERS = "".join(LINKS.format(k=k, x=-0.07 * s, y=-s, tip=0.01 * s) for k, s in ((0, 1), (1, -1)))
B = 1.0


def hand(option: str) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """Fingers that press a ball between them, an inerter from tip to tip."""
    model = mujoco.MjModel.from_xml_string(f"""
<mujoco>
  <extension><plugin plugin="inerter.device"/></extension>
  <option {option}/>
  <worldbody>
    <geom type="plane" size="2 2 0.1"/>{FINGERS}
    <geom type="box" pos="0 0 0.0575" size="0.05 0.05 0.0575"/>
    <body pos="0.002 0 0.15"><freejoint/><geom size="0.035" mass="0.1"/></body>
  </worldbody>
  <tendon><spatial name="strut"><site site="tip0"/><site site="tip1"/></spatial></tendon>
  <actuator>
    {plugin_actuator({"inertance": B})}
    <position joint="knuckle0" kp="3"/><position joint="knuckle1" kp="3"/>
  </actuator>
</mujoco>""")
    return model, mujoco.MjData(model)


def grip(model: mujoco.MjModel, data: mujoco.MjData) -> None:
    data.ctrl[1:] = 0.5 + 0.4 * np.sin(2 * np.pi * 3 * data.time + np.arange(2))
    mujoco.mj_step(model, data)


def angles(option: str, step: float) -> NDArray[np.float64]:
    """Of the fingers, every 0.01 s."""
    model, data = hand(option)
    model.opt.timestep = step
    rows, each = [], round(0.01 / step)
    for k in range(1, round(0.25 / step) + 1):
        grip(model, data)
        if k % each == 0:
            rows.append(data.qpos[:4].copy())
    counts = inerter.solve_counts(model, data)["strut"]
    assert (counts.solves, counts.stops, counts.misfits) == (round(0.25 / step), 0, 0)
    return np.array(rows)


@pytest.mark.parametrize("integrator", DAMPED)
def test_a_grip_goes_to_the_fine_motion(integrator: str) -> None:
    truth = angles('integrator="discrete"', 4e-5)
    errors = [
        np.abs(angles(f'integrator="{integrator}"', step) - truth).max()
        for step in (2e-3, 1e-3, 5e-4)
    ]
    assert np.ptp(truth, axis=0).max() > 0.3
    assert errors[0] < 0.03, errors
    assert errors[-1] < 0.012, errors


# --------------------------- what is counted ------------------------------------------------------


@pytest.mark.parametrize("integrator", [*DAMPED, "discrete"])
@pytest.mark.parametrize("disabled", [False, True], ids=["enabled", "disabled"])
def test_a_step_that_does_not_fit_is_counted_and_told(
    integrator: str, disabled: bool, capfd: pytest.CaptureFixture[str]
) -> None:
    # with all actuation disabled the plugin is asked before the engine knows its constraints
    model, data = hand(f'integrator="{integrator}" cone="elliptic"')
    if disabled:
        model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_ACTUATION
    data.qvel[:4] = [8, 2, 7, 2]
    touched = 0
    for _ in range(100):
        grip(model, data)
        touched = max(touched, data.ncon)
    assert touched >= 2
    counts = inerter.solve_counts(model, data)["strut"]
    assert (counts.solves, counts.stops) == (100, 0)
    assert (counts.misfits > 0) == disabled
    assert ("did not fit each other" in capfd.readouterr().err) == disabled
