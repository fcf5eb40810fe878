"""Do the plugin and MuJoCo's native elements agree?

A linear device is the engine's armature and damping: not close, but bit for bit. LuGre exists
natively in `dcmotor`.
"""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from plugin_models import (
    ENGINE,
    INERTANCE,
    INTEGRATORS,
    plugin_actuator,
    quarter_car_xml,
    simulate,
)

# an arm of two hinges and a slide, with a contact, a limit, an equality and friction loss
SCENE = """
<mujoco>
  <extension><plugin plugin="inerter.device"/></extension>
  <option timestep="2e-3" integrator="{integrator}"/>
  <worldbody>
    <geom type="plane" size="2 2 0.1"/>
    <site name="ceiling" pos="0.3 0.2 1.2"/>
    <body name="upper" pos="0 0 0.8">
      <joint name="shoulder" axis="0 1 0" range="-40 60" limited="true"/>
      <geom type="capsule" fromto="0 0 0 0.4 0 0" size="0.03" mass="1.5"/>
      <body name="lower" pos="0.4 0 0">
        <joint name="elbow" axis="1 0 1" frictionloss="0.3"/>
        <geom type="capsule" fromto="0 0 0 0.4 0 0" size="0.03" mass="1"/>
        <site name="hand" pos="0.4 0 0"/>
        <body name="slider" pos="0.4 0 0">
          <joint name="slide" type="slide" axis="1 0 0" range="-0.1 0.1" limited="true"/>
          <geom size="0.08" mass="0.7"/>
        </body>
      </body>
    </body>
    <body name="other" pos="0.5 0.5 0.5">
      <joint name="lever" axis="0 1 0"/>
      <geom type="box" size="0.1 0.02 0.02" mass="1"/>
    </body>
  </worldbody>
  <tendon>
    <spatial name="cable" frictionloss="0.5" limited="true" range="0 0.9">
      <site site="ceiling"/><site site="hand"/>
    </spatial>
    <fixed name="pair"><joint joint="elbow" coef="0.7"/><joint joint="slide" coef="-2"/></fixed>
  </tendon>
  <equality><joint joint1="lever" joint2="shoulder" polycoef="0 0.5 0 0 0"/></equality>
  <actuator>{actuator}</actuator>
</mujoco>"""

TARGETS = {
    "slide": 'joint="slide"',
    "slide, gear": 'joint="slide" gear="3"',
    "hinge": 'joint="elbow" gear="-0.5"',
    "jointinparent": 'jointinparent="shoulder"',
    "spatial tendon": 'tendon="cable"',
    "spatial tendon, gear": 'tendon="cable" gear="2"',
    "fixed tendon": 'tendon="pair"',
}


def both(xml: str, target: str, b: float, c: float) -> list[mujoco.MjModel]:
    """The scene with the plugin and with the native element."""
    plugin = plugin_actuator({"inertance": b, "viscous": c}, target)
    native = f'<general name="strut" {target} armature="{b}" damping="{c}"/>'
    return [
        mujoco.MjModel.from_xml_string(xml.replace("{actuator}", actuator))
        for actuator in (plugin, native)
    ]


def path(model: mujoco.MjModel, steps: int) -> np.ndarray:
    data = mujoco.MjData(model)
    data.qvel[:] = np.linspace(-2, 2, model.nv)
    rows = []
    for i in range(steps):
        data.ctrl[:] = np.sin(0.01 * i)
        mujoco.mj_step(model, data)
        rows.append(np.concatenate([data.qpos, data.qvel, data.qacc, data.qfrc_constraint]))
    return np.array(rows)


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("target", TARGETS.values(), ids=TARGETS)
def test_a_linear_device_is_native_armature_and_damping(target: str, integrator: str) -> None:
    xml = SCENE.replace("{integrator}", integrator)
    plugin, native = both(xml, target, 1.7, 0.9)
    a, b = path(plugin, 400), path(native, 400)
    assert np.abs(a[:, -plugin.nv :]).max() > 0, "the scene is to have active constraints"
    assert np.array_equal(a, b)


@pytest.mark.parametrize("target", TARGETS.values(), ids=TARGETS)
def test_constants_follow_the_inertance(target: str) -> None:
    plugin, native = both(SCENE.replace("{integrator}", "Euler"), target, 1.7, 0.9)
    for name in (
        "dof_invweight0", "body_invweight0", "tendon_invweight0", "actuator_acc0", "dof_M0",
        "jnt_actuatorid", "tendon_actuatorid", "actuator_armature", "actuator_damping",
        "tendon_lengthspring", "tree_sleep_policy", "M_colind",
    ):  # fmt: skip
        assert np.array_equal(getattr(plugin, name), getattr(native, name)), name


def test_the_inertia_matrix_contains_the_inertance() -> None:
    b = 1.7
    with_b, without = (
        mujoco.MjModel.from_xml_string(
            SCENE.replace("{integrator}", "Euler").replace(
                "{actuator}", plugin_actuator({"inertance": value}, 'tendon="cable" gear="2"')
            )
        )
        for value in (b, 0)
    )
    matrices = []
    for model in (with_b, without):
        data = mujoco.MjData(model)
        data.qpos[:] = 0.2, -0.4, 0.03, 0.1
        mujoco.mj_forward(model, data)
        full = np.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, data, full)
        matrices.append(full)
        row = np.zeros((model.nu, model.nv))
        mujoco.mju_sparse2dense(
            row, data.actuator_moment, data.moment_rownnz, data.moment_rowadr, data.moment_colind
        )
    np.testing.assert_allclose(matrices[0] - matrices[1], b * row.T @ row, atol=1e-13)
    assert np.count_nonzero(row) == 2


def test_a_statistic_of_the_user_stays() -> None:
    extra = '<statistic extent="7" meansize="0.25" center="1 2 3"/>'
    model = mujoco.MjModel.from_xml_string(
        quarter_car_xml(plugin_actuator({"inertance": 113}), extra=extra)
    )
    assert (model.stat.extent, model.stat.meansize) == (7, 0.25)
    assert model.stat.center.tolist() == [1, 2, 3]


# LuGre: sigma0, sigma1, F_c, F_s, v_s of the native motor friction
LUGRE = (5e4, 200, 80, 120, 0.05)


def lugre_pair(option: str) -> list[mujoco.MjModel]:
    s0, s1, fc, fs, vs = LUGRE
    keys = {
        "inertance": INERTANCE, "viscous": 300, "friction": "lugre", "bristle_stiffness": s0,
        "bristle_damping": s1, "coulomb_force": fc, "static_force": fs, "stribeck_velocity": vs,
    }  # fmt: skip
    native = (
        '<dcmotor tendon="strut" input="none" motorconst="0 0" resistance="1" '
        f'lugre="{s0} {s1} {fc} {fs} {vs}" armature="{INERTANCE}" damping="300"/>'
    )
    return [
        mujoco.MjModel.from_xml_string(quarter_car_xml(actuator, option=option))
        for actuator in (plugin_actuator(keys), native)
    ]


@pytest.mark.skipif(ENGINE < (4,), reason="MuJoCo 3 has no motor that is friction alone")
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_lugre_approaches_the_native_motor_friction_with_the_step(integrator: str) -> None:
    # the native bristle steps at the old velocity (under RK4 by an exponential of the mean rate),
    # ours at the new one (under RK4 by the stages): both go to one limit, in first order
    differences = []
    for k in range(3):
        h = 1e-3 / 2**k
        plugin, native = lugre_pair(f'integrator="{integrator}" timestep="{h}"')
        a, b = simulate(plugin, 0.4, 2**k), simulate(native, 0.4, 2**k)
        differences.append(np.abs(a - b)[:, :2].max() / np.abs(b[:, :2]).max())
    assert differences[0] < 1e-2
    orders = np.log2(np.divide(differences[:-1], differences[1:]))
    assert orders.min() > 0.8, (differences, orders)
