"""Computed torque with devices: what is asked for is what the engine answers with."""

from __future__ import annotations

import inerter
import mujoco
import numpy as np
import pytest
from plugin_models import INTEGRATORS

# an arm with two hands beside a free box on the floor, three devices
SCENE = """
<mujoco>
  <extension><plugin plugin="inerter.device">
    <instance name="hands"><config key="inertance" value="3"/>{hands}</instance>
    <instance name="box"><config key="inertance" value="1.5"/>{box}</instance>
    <instance name="elbow"><config key="inertance" value="0.2"/>{elbow}</instance>
  </plugin></extension>
  <option timestep="1e-3" integrator="{integrator}" tolerance="1e-15" iterations="500"
    ls_tolerance="1e-8" ls_iterations="100"/>
  <worldbody>
    <site name="world" pos="0 0 2"/>
    <geom type="plane" size="5 5 .1"/>
    <body pos="0 0 1">
      <joint name="shoulder" axis="0 1 0" damping="0.3"/>
      <geom type="capsule" fromto="0 0 0 .4 0 0" size=".03"/>
      <body pos=".4 0 0">
        <joint name="elbow" axis="0 1 0"/><geom type="capsule" fromto="0 0 0 .3 0 .1" size=".03"/>
        <site name="hand" pos=".3 0 .1"/>
      </body>
    </body>
    <body pos="0 .5 1">
      <joint name="other" axis="1 0 0"/><geom type="capsule" fromto="0 0 0 .1 .4 0" size=".03"/>
      <site name="other" pos=".1 .4 0"/>
    </body>
    <body pos="1 0 .099">
      <freejoint/><geom type="box" size=".1 .1 .1" mass="2"/><site name="box" pos="0 0 .1"/>
    </body>
  </worldbody>
  <tendon>
    <spatial name="hands"><site site="hand"/><site site="other"/></spatial>
    <spatial name="box"><site site="hand"/><site site="box"/></spatial>
  </tendon>
  <actuator>
    <plugin name="hands" plugin="inerter.device" instance="hands" tendon="hands"/>
    <plugin name="box" plugin="inerter.device" instance="box" tendon="box" {states}/>
    <plugin name="elbow" plugin="inerter.device" instance="elbow" joint="elbow"/>
  </actuator>
  <sensor>
    <plugin plugin="inerter.device" instance="hands"/>
    <plugin plugin="inerter.device" instance="box"/>
    <plugin plugin="inerter.device" instance="elbow"/>
  </sensor>
</mujoco>"""

PLAIN = {"hands": "", "box": "", "elbow": "", "states": ""}
RICH = {
    "hands": '<config key="friction" value="coulomb"/><config key="coulomb_force" value="2"/>'
    '<config key="viscous" value="4"/>',
    "box": '<config key="friction" value="lugre"/><config key="coulomb_force" value="1"/>'
    '<config key="bristle_stiffness" value="1e3"/>',
    "elbow": '<config key="stiffness" value="5"/><config key="quadratic_damping" value="0.5"/>'
    '<config key="load_friction" value="0.1"/>',
    "states": 'actdim="1"',
}


def moving(integrator: str, parts: dict[str, str]) -> tuple[mujoco.MjModel, mujoco.MjData]:
    model = mujoco.MjModel.from_xml_string(SCENE.format(integrator=integrator, **parts))
    data = mujoco.MjData(model)
    rng = np.random.default_rng(3)
    data.qpos[:3] = [0.3, -0.5, 0.2]
    data.qvel[:3] = rng.normal(size=3)
    data.qvel[3:] = 0.05 * rng.normal(size=6)
    data.act[:] = 1e-4
    return model, data


def answered(model: mujoco.MjModel, data: mujoco.MjData, torque: np.ndarray) -> np.ndarray:
    data.qfrc_applied[:] = torque
    mujoco.mj_forward(model, data)
    return data.qacc.copy()


@pytest.mark.parametrize("parts", [PLAIN, RICH], ids=["inertance", "laws"])
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_the_torque_gives_the_acceleration(integrator: str, parts: dict[str, str]) -> None:
    model, data = moving(integrator, parts)
    mujoco.mj_forward(model, data)
    assert data.ncon == 4, "the box lies on the floor"
    wanted = np.array([3.0, -7.0, 5.0, 0.2, -0.1, 0.05, 0.1, 0.2, -0.1])
    wanted += [0, 0, 0, *data.qacc[3:]]
    torque = inerter.inverse_dynamics(model, data, wanted)
    scale = np.abs(wanted).max()
    np.testing.assert_allclose(answered(model, data, torque), wanted, atol=1e-9 * scale, rtol=0)

    # the engine's own inverse leaves the devices out, by much
    data.qacc[:] = wanted
    mujoco.mj_inverse(model, data)
    assert np.abs(data.qfrc_inverse - torque).max() > 0.2


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_the_forces_are_those_of_the_sensors(integrator: str) -> None:
    model, data = moving(integrator, RICH)
    mujoco.mj_forward(model, data)
    state = data.qacc.copy(), data.sensordata.copy()
    found = inerter.device_force(model, data, data.qacc)
    devices = inerter.devices_of(model)
    shown = {each.name: float(each.read(data.sensordata)["total"]) for each in devices}
    # what the engine holds goes with qacc, the rest with the acceleration of the step: where both
    # meet in one device (elbow), its sensor takes one for the other
    loose = 1e-7 if integrator in ("RK4", "discrete") else 1e-3
    assert found.force.pop("elbow") == pytest.approx(shown.pop("elbow"), rel=loose)
    assert found.force == pytest.approx(shown, rel=1e-7, abs=1e-8)
    # nothing has changed
    np.testing.assert_array_equal(state[0], data.qacc)
    np.testing.assert_array_equal(state[1], data.sensordata)


def test_a_wrong_acceleration_is_named() -> None:
    model, data = moving("Euler", PLAIN)
    mujoco.mj_forward(model, data)
    for wrong in (np.zeros(3), np.full(model.nv, np.nan)):
        with pytest.raises(ValueError, match=f"give {model.nv} finite numbers"):
            inerter.device_force(model, data, wrong)


@pytest.mark.parametrize(
    ("device", "states"),
    [
        ({"series_stiffness": 4413.0}, 2),
        ({"branch_stiffness_1": 1e4, "branch_damping_1": 100.0}, 1),
        ({"friction": "dahl", "coulomb_force": 5.0, "bristle_stiffness": 1e5}, 1),
    ],
)
@pytest.mark.parametrize("integrator", INTEGRATORS[:-1])
def test_springs_that_a_step_does_not_resolve(
    device: dict[str, float | str], states: int, integrator: str
) -> None:
    """Nothing but the state is looked at: no forward pass has run there."""
    keys = {"inertance": 11.0, **device}
    config = "".join(f'<config key="{name}" value="{value}"/>' for name, value in keys.items())
    model = mujoco.MjModel.from_xml_string(f"""
<mujoco>
  <extension><plugin plugin="inerter.device"/></extension>
  <option timestep="0.01" integrator="{integrator}" gravity="0 0 0"/>
  <worldbody>
    <body>
      <freejoint/><geom type="box" size=".1 .05 .03" mass="2"/><site name="a" pos=".1 0 0"/>
    </body>
    <body pos="1 .2 .3">
      <freejoint/><geom type="box" size=".1 .1 .1" mass="3"/><site name="b"/>
    </body>
  </worldbody>
  <tendon><spatial name="t"><site site="a"/><site site="b"/></spatial></tendon>
  <actuator>
    <plugin name="d" plugin="inerter.device" tendon="t" actdim="{states}">{config}</plugin>
  </actuator>
</mujoco>""")
    rng = np.random.default_rng(2)
    for _ in range(5):
        data = mujoco.MjData(model)
        mujoco.mj_integratePos(model, data.qpos, 0.2 * rng.normal(size=12), 1.0)
        data.qvel[:] = rng.normal(size=12)
        wanted = 5.0 * rng.normal(size=12)
        data.qfrc_applied[:] = inerter.inverse_dynamics(model, data, wanted)
        mujoco.mj_forward(model, data)
        # of free bodies under `discrete` the engine is asked until it fits, to 1e-6
        assert data.qacc == pytest.approx(wanted, abs=1e-5 if integrator == "discrete" else 1e-8)
