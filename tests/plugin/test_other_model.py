"""Data that is stepped with another model than it was made for, as rollouts over models do."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from mujoco import rollout

STEPS = 300
KEYS = {"inertance": 5, "viscous": 3, "friction": "lugre", "coulomb_force": 4,
        "bristle_stiffness": 2e3}  # fmt: skip


def model(custom: str = "", swapped: bool = False, **changed: float | str) -> mujoco.MjModel:
    """Two masses, the device between them, a force on one; numerics; the actuators' order."""
    config = "".join(f'<config key="{k}" value="{v}"/>' for k, v in (KEYS | changed).items())
    actuators = [
        '<motor joint="left"/>',
        f'<plugin name="strut" plugin="inerter.device" tendon="strut" actdim="1">{config}</plugin>',
    ]
    return mujoco.MjModel.from_xml_string(
        f"""<mujoco><extension><plugin plugin="inerter.device"/></extension>
        <option integrator="RK4" timestep="0.002" gravity="0 0 0"/>
        <default><geom size="0.1" mass="2" contype="0" conaffinity="0"/></default>
        <worldbody>
          <body><joint name="left" type="slide" axis="1 0 0"/><geom/></body>
          <body><joint name="right" type="slide" axis="1 0 0"/><geom/></body>
        </worldbody>
        <tendon><fixed name="strut"><joint joint="left" coef="-1"/><joint joint="right" coef="1"/>
        </fixed></tendon>
        <actuator>{"".join(actuators[::-1] if swapped else actuators)}</actuator>
        <custom>{custom}</custom></mujoco>"""
    )


CONTROL = np.column_stack([30 * np.sin(2 * np.pi * 2 * 0.002 * np.arange(STEPS)), np.zeros(STEPS)])


def alone(one: mujoco.MjModel) -> np.ndarray:
    """Motion with data of its own, shape (steps, nq)."""
    data = mujoco.MjData(one)
    found = []
    for control in CONTROL:
        data.ctrl[:] = control
        mujoco.mj_step(one, data)
        found.append(data.qpos.copy())
    return np.array(found)


@pytest.mark.parametrize("count", [1, 2])
def test_a_rollout_over_models_has_each_ones_device(count: int) -> None:
    models = [model(coulomb_force=f, inertance=b) for f in (1, 4, 9) for b in (2, 8)]
    data = [mujoco.MjData(models[0]) for _ in range(count)]
    size = mujoco.mj_stateSize(models[0], mujoco.mjtState.mjSTATE_FULLPHYSICS)
    start = np.zeros((len(models), size))
    states, _ = rollout.rollout(models, data, start, np.repeat(CONTROL[None], len(models), axis=0))
    for one, state in zip(models, states, strict=True):
        np.testing.assert_array_equal(state[:, 1 : 1 + one.nq], alone(one))


def handed_over(first: mujoco.MjModel, second: mujoco.MjModel) -> np.ndarray:
    """Where data of the first model end that are stepped with the second."""
    data = mujoco.MjData(first)
    mujoco.mj_step(first, data, 5)
    mujoco.mj_resetData(second, data)
    for control in CONTROL:
        data.ctrl[:] = control
        mujoco.mj_step(second, data)
    return data.qpos


def test_data_that_are_handed_to_another_model_follow_it() -> None:
    first, second = model(), model(coulomb_force=20)
    np.testing.assert_array_equal(handed_over(first, second), alone(second)[-1])


LIVE = '<numeric name="{}" data="{}"/>'
PLACES = {
    "where": {"custom": LIVE.format("other", 3) + LIVE.format("strut.coulomb_force", 7)},
    "none": {},
    "actuators": {"swapped": True},
    "both": {"swapped": True, "custom": LIVE.format("strut.viscous", 30)},
}


@pytest.mark.parametrize("changed", PLACES.values(), ids=PLACES)
def test_the_same_device_may_be_elsewhere_in_another_model(changed: dict) -> None:
    """Its configuration is the same; its actuator and what holds its live parameters is not."""
    first, second = model(LIVE.format("strut.coulomb_force", 10)), model(**changed)
    np.testing.assert_array_equal(handed_over(first, second), alone(second)[-1])
