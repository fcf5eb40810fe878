"""An accelerometer that is not mounted straight, against MuJoCo with its site turned."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from inerter.diagnose.vehicle.build import UserModel, model_of_text
from inerter.diagnose.vehicle.drive import make_drive
from inerter.diagnose.vehicle.mapping import map_columns
from inerter.diagnose.vehicle.model import VehicleModel
from inerter.diagnose.vehicle.simulate import VehicleSimulator
from inerter.plugin import load_plugin
from inerter.records.free_form import FreeRecord

TIMES = np.linspace(0.0, 2.0, 501)
ROAD = 0.01 * np.sin(2 * np.pi * 3.0 * TIMES) * (1 - np.exp(-((TIMES / 0.2) ** 2)))


def _model(turned: str = "0 0 0") -> UserModel:
    """A wheel on a trailing arm that stands at 20 degrees, under gravity."""
    load_plugin()
    text = f"""<mujoco>
  <option timestep="0.002" integrator="RK4"/>
  <extension><plugin plugin="inerter.device"><instance name="strut">
    <config key="inertance" value="40"/><config key="viscous" value="1500"/>
    <config key="stiffness" value="30000"/><config key="rest_length" value="0.5"/>
  </instance></plugin></extension>
  <worldbody><site name="ground"/>
    <body name="sprung" pos="0 0 0.6"><joint type="slide" axis="0 0 1"/>
      <geom type="box" size="0.3 0.3 0.1" mass="250" contype="0" conaffinity="0"/>
      <site name="upper" pos="0 0 0.45"/>
      <body name="arm" euler="0 20 0"><joint type="hinge" axis="0 -1 0"/>
        <inertial pos="0.5 0 0" mass="35" diaginertia="2 2 2"/>
        <site name="lower" pos="0.4 0 0"/><site name="hub" pos="0.5 0 0"/>
        <site name="sensor" pos="0.45 0 0" euler="{turned}"/>
      </body>
    </body>
  </worldbody>
  <tendon><spatial name="strut"><site site="lower"/><site site="upper"/></spatial></tendon>
  <actuator>
    <position name="road" site="hub" refsite="ground" gear="0 0 1 0 0 0" kp="200000"/>
    <plugin name="strut" plugin="inerter.device" instance="strut" tendon="strut"/>
  </actuator>
  <sensor><accelerometer name="hub" site="sensor"/>
    <framelinacc name="body" objtype="body" objname="sprung"/></sensor>
</mujoco>"""
    return model_of_text(text, Path("arm.xml"))


def _simulator(user: UserModel) -> tuple[VehicleSimulator, FreeRecord]:
    zeros = np.zeros(TIMES.size)
    columns = {"road": ROAD, "hub": zeros, "body": zeros}
    channels = map_columns(user.model, list(columns), {}, {"hub": "hub.z", "body": "body.z"})
    user.with_inputs(channels.inputs.values())
    record = FreeRecord(name="run", time=TIMES, extra=columns)
    return VehicleSimulator(user, channels, 1), record


@pytest.mark.parametrize(("axis", "turned"), [("x", "0 {} 0"), ("y", "{} 0 0")])
def test_a_leaning_sensor_shows_what_mujoco_has_it_show(axis: str, turned: str) -> None:
    # a turn about y by a takes the sensor's z toward x, one about x away from y
    angle = 0.15
    sign = 1.0 if axis == "x" else -1.0
    simulator, record = _simulator(_model())
    leans = VehicleModel({f"channel:hub.angle_toward_{axis}": angle})
    drive = make_drive(record, simulator.channels, 0.002)
    own, straight = simulator.outputs([leans, VehicleModel()], drive)
    model = _model(turned.format(sign * np.degrees(angle)))
    simulator, record = _simulator(model)
    theirs = simulator.outputs([VehicleModel()], drive)[0]
    scale = np.std(theirs[:, 0])
    assert np.max(np.abs(own - theirs)) < 1e-6 * scale
    if axis == "x":
        assert np.std(own[:, 0] - straight[:, 0]) > 0.02 * scale


def test_only_axes_along_which_a_sensor_moves_are_asked() -> None:
    simulator, record = _simulator(_model())
    drive = make_drive(record, simulator.channels, 0.002)
    # the arm moves in its plane, the body along one line
    assert simulator.axes_beside(("hub", "body"), drive) == {"hub": "x", "body": ""}
