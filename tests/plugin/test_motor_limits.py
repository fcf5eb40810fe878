"""Limits of motors limit motors: a device is none, wherever it is attached."""

from __future__ import annotations

import itertools

import mujoco
import numpy as np
import pytest
from plugin_models import INTEGRATORS, plugin_actuator

# a motor on a hinge, and a carriage in a tree of its own
MODEL = """
<mujoco>
  <extension><plugin plugin="inerter.device"/></extension>
  <option gravity="0 0 0" integrator="{integrator}"/>
  <worldbody>
    <body><joint name="hinge" {joint}/><geom size="0.1" mass="2"/></body>
    <body pos="1 0 0"><joint name="slide" type="slide"/><geom size="0.1" mass="3"/></body>
  </worldbody>
  <tendon>
    <fixed name="both" {tendon}>
      <joint joint="hinge" coef="0.5"/><joint joint="slide" coef="1"/>
    </fixed>
  </tendon>
  <actuator>
    <motor joint="hinge"/>{device}
  </actuator>
</mujoco>"""
LIMITS = ("joint", "tendon", "actuator")
ELASTIC = {"inertance": 5, "series_stiffness": 1e4, "series_damping": 10}
DEVICES = {
    "coulomb": ({"friction": "coulomb", "coulomb_force": 3}, 0),
    "stribeck": ({"friction": "stribeck", "coulomb_force": 3, "static_force": 4}, 0),
    "dahl": ({"friction": "dahl", "coulomb_force": 3, "inertance": 2}, 1),
    "inertance": ({"inertance": 20}, 0),
    "varying": ({"inertance": 20, "inertance_gradient": 1}, 0),
    "elastic": (ELASTIC, 2),
}


def model_of(limit: str, target: str, keys: dict, states: int, integrator: str) -> mujoco.MjModel:
    """The model with a limit of 0.5 on the joint, tendon or actuator of a device, or with none."""
    attributes = f'actdim="{states}"' if states else ""
    if limit == "actuator":
        attributes += ' forcerange="-0.5 0.5"'
    return mujoco.MjModel.from_xml_string(
        MODEL.format(
            joint='actuatorfrcrange="-0.5 0.5"' if limit == "joint" else "",
            tendon='actuatorfrcrange="-0.5 0.5"' if limit == "tendon" else "",
            device=plugin_actuator(keys, target, attributes=attributes),
            integrator=integrator,
        )
    )


def run(model: mujoco.MjModel, motor: float, steps: int = 100) -> np.ndarray:
    data = mujoco.MjData(model)
    data.qvel[:] = 0.4, -0.3
    data.ctrl[0] = motor
    path = []
    for _ in range(steps):
        mujoco.mj_step(model, data)
        path.append(np.concatenate([data.qpos, data.qvel, data.act]))
    return np.array(path)


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("name", DEVICES)
def test_a_limit_that_no_motor_meets_changes_nothing(name: str, integrator: str) -> None:
    keys, states = DEVICES[name]
    for limit, target in itertools.product(LIMITS, ('joint="hinge"', 'tendon="both"')):
        if (limit == "tendon") == ("joint" in target):
            continue
        free = run(model_of("none", target, keys, states, integrator), 0.3)
        limited = run(model_of(limit, target, keys, states, integrator), 0.3)
        np.testing.assert_allclose(
            limited, free, rtol=1e-9, atol=1e-12, err_msg=f"{limit} {target}"
        )


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_friction_is_taken_from_what_the_limited_motor_gives(integrator: str) -> None:
    # a motor of 20 N m on a joint of 5 against friction of 3: 2 are left, as with frictionloss
    xml = MODEL.format(
        joint='actuatorfrcrange="-5 5"', tendon="", integrator=integrator,
        device=plugin_actuator({"friction": "coulomb", "coulomb_force": 3}, 'joint="hinge"'),
    )  # fmt: skip
    model = mujoco.MjModel.from_xml_string(xml)
    data = mujoco.MjData(model)
    data.qvel[0], data.ctrl[0] = 1.0, 20.0
    mujoco.mj_forward(model, data)
    inertia = data.M[model.M_rowadr[0] + model.M_rownnz[0] - 1]
    assert data.qacc[0] * inertia == pytest.approx(2.0, rel=1e-9)
    assert data.qfrc_actuator[0] == pytest.approx(5.0)


def test_forcerange_limits_the_command_of_the_device() -> None:
    model = model_of("actuator", 'joint="hinge"', {"viscous": 2.0, "stiffness": 7.0}, 0, "Euler")
    data = mujoco.MjData(model)
    data.qpos[0], data.ctrl[1] = 1.0, 30.0
    mujoco.mj_forward(model, data)
    assert data.actuator_force[1] == 0.5
    assert data.qfrc_passive[0] == pytest.approx(-7.0)


def test_a_step_in_halves_and_a_repeated_pass_count_the_force_once() -> None:
    model = model_of("joint", 'tendon="both"', {"inertance": 20, "viscous": 3}, 0, "Euler")
    data = mujoco.MjData(model)
    data.qvel[:], data.ctrl[0] = (0.4, -0.3), 0.2
    mujoco.mj_forward(model, data)
    first = data.qacc.copy()
    for skip in (
        mujoco.mjtStage.mjSTAGE_NONE,
        mujoco.mjtStage.mjSTAGE_POS,
        mujoco.mjtStage.mjSTAGE_VEL,
    ):
        mujoco.mj_forwardSkip(model, data, skip, 0)
        np.testing.assert_allclose(data.qacc, first, rtol=1e-12)
    mujoco.mj_step1(model, data)
    mujoco.mj_step2(model, data)
    other = mujoco.MjData(model)
    other.qvel[:], other.ctrl[0] = (0.4, -0.3), 0.2
    mujoco.mj_step(model, other)
    np.testing.assert_allclose(data.qvel, other.qvel, rtol=1e-12)


@pytest.mark.parametrize("flags", ["spring", "damper", "both"])
def test_without_springs_and_dampers_too(flags: str) -> None:
    disabled = {
        "spring": mujoco.mjtDisableBit.mjDSBL_SPRING,
        "damper": mujoco.mjtDisableBit.mjDSBL_DAMPER,
        "both": mujoco.mjtDisableBit.mjDSBL_SPRING | mujoco.mjtDisableBit.mjDSBL_DAMPER,
    }[flags]
    paths = []
    for limit in ("none", "joint"):
        model = model_of(limit, 'tendon="both"', {"inertance": 20, "friction": "coulomb",
                                                  "coulomb_force": 0.1}, 0, "Euler")  # fmt: skip
        model.opt.disableflags |= int(disabled)
        data = mujoco.MjData(model)
        data.qvel[:] = 0.4, -0.3
        mujoco.mj_forward(model, data)
        mujoco.mj_forwardSkip(model, data, mujoco.mjtStage.mjSTAGE_VEL, 0)
        paths.append(data.qacc.copy())
        paths.append(run(model, 0.3)[-1])
    np.testing.assert_allclose(paths[2], paths[0], rtol=1e-10)
    np.testing.assert_allclose(paths[3], paths[1], rtol=1e-9)


@pytest.mark.parametrize("limit", LIMITS)
def test_a_limit_that_is_set_later_is_none_of_a_device_either(limit: str) -> None:
    free = model_of("none", 'tendon="both"', {"inertance": 5, "stiffness": 1e3}, 0, "Euler")
    data = mujoco.MjData(free)
    data.qpos[1] = 0.2
    mujoco.mj_forward(free, data)
    expected = data.qacc.copy()
    limited = {
        "joint": (free.jnt_actfrclimited, free.jnt_actfrcrange),
        "tendon": (free.tendon_actfrclimited, free.tendon_actfrcrange),
        "actuator": (free.actuator_forcelimited[1:], free.actuator_forcerange[1:]),
    }
    flags, ranges = limited[limit]
    flags[:], ranges[:] = True, [-0.5, 0.5]
    mujoco.mj_forward(free, data)
    np.testing.assert_allclose(data.qacc, expected, rtol=1e-12)
