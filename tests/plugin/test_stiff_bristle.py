"""Does a bristle stiffer than the step can resolve stay bounded?"""

from __future__ import annotations

import inerter
import mujoco
import numpy as np
import pytest
from plugin_models import INERTANCE, INTEGRATORS, plugin_actuator, quarter_car_xml, simulate

LEVEL, STEP = 50.0, 2e-3


@pytest.mark.parametrize("integrator", INTEGRATORS[:-1])
@pytest.mark.parametrize("law", ["dahl", "lugre", "bouc_wen"])
def test_the_force_never_leaves_the_level(law: str, integrator: str) -> None:
    # sigma0 = 1e8 N/m: a time constant of half a microsecond at 1 m/s, 4000 times below the step
    keys: dict[str, float | str] = {"inertance": INERTANCE, "friction": law}
    if law == "bouc_wen":
        yield_length = LEVEL / 1e8
        keys |= {
            "bw_stiffness": 1e8, "bw_beta": 0.5 / yield_length, "bw_gamma": 0.5 / yield_length,
        }  # fmt: skip
    else:
        keys |= {"bristle_stiffness": 1e8, "coulomb_force": LEVEL}
    xml = quarter_car_xml(
        plugin_actuator(keys), option=f'timestep="{STEP}" integrator="{integrator}"'
    )
    path = simulate(mujoco.MjModel.from_xml_string(xml), 4.0)
    assert np.isfinite(path).all()
    assert 1e8 * np.abs(path[:, 4]).max() <= LEVEL * (1 + 1e-9)
    # the motion dies out as it should: 0.3 m/s moves the car by millimetres, then it rests
    assert np.abs(path[:, :2]).max() < 0.01
    assert np.abs(path[-200:, :2]).max() < 1e-3


def held_by_a_strut(law: str, integrator: str, reference: float) -> mujoco.MjModel:
    """An arm that hangs at an angle [deg] from its reference pose, a bristle to the world."""
    actuator = plugin_actuator(
        {"inertance": 0.5, "friction": law, "coulomb_force": 40.0, "bristle_stiffness": 1e7,
         "rest_length": 0.3},
    )  # fmt: skip
    return mujoco.MjModel.from_xml_string(
        f"""<mujoco><option integrator="{integrator}" timestep="{STEP}"/>
        <extension><plugin plugin="inerter.device"/></extension>
        <worldbody><site name="wall" pos="0.6 0 0"/>
        <body euler="0 {reference} 0"><joint type="hinge" axis="0 1 0"/>
        <geom type="capsule" fromto="0 0 0 0.3 0 0" size="0.02" mass="0.5" contype="0"/>
        <site name="tip" pos="0.3 0 0"/></body></worldbody>
        <tendon><spatial name="strut"><site site="wall"/><site site="tip"/></spatial></tendon>
        <actuator>{actuator}</actuator></mujoco>"""
    )


@pytest.mark.parametrize("integrator", INTEGRATORS[:-1])
@pytest.mark.parametrize("law", ["dahl", "lugre"])
@pytest.mark.parametrize("reference", [0.0, 1.0, 40.0])
def test_it_holds_whatever_the_reference_pose(law: str, integrator: str, reference: float) -> None:
    """Along the arm, as at 0 degrees, the strut has no lever: no force there moves anything."""
    model = held_by_a_strut(law, integrator, reference)
    data = mujoco.MjData(model)
    begin = np.deg2rad(40.0 - reference)
    data.qpos[0] = begin
    mujoco.mj_step(model, data, 500)
    rest = data.qpos[0]
    mujoco.mj_step(model, data, 500)
    assert abs(rest - begin) < 1e-5
    assert abs(data.qpos[0] - rest) < 1e-7
    assert abs(data.qvel[0]) < 1e-6
    assert 1.0 < abs(data.actuator_force[0]) < 4.0


@pytest.mark.parametrize("law", ["dahl", "lugre"])
def test_the_inverse_takes_it_as_the_step_does(law: str) -> None:
    torques = []
    for reference in (0.0, 40.0):
        model = held_by_a_strut(law, "implicitfast", reference)
        data = mujoco.MjData(model)
        data.qpos[0], data.qvel[0] = np.deg2rad(40.0 - reference), 1e-3
        mujoco.mj_forward(model, data)
        torques.append(inerter.inverse_dynamics(model, data, np.zeros(1))[0])
    assert torques[0] == pytest.approx(torques[1], rel=1e-6)
