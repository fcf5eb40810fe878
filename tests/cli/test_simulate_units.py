"""Units of a control table, where what drives a length takes no force, and of a run's pictures."""

from __future__ import annotations

from pathlib import Path

import mujoco
import pytest
from inerter import Device
from inerter.engine_errors import SimulationError
from inerter.models import model_file
from inerter.plugin import load_plugin
from inerter.rig import device_mjcf
from inerter.simulate.page import render_page
from inerter.simulate.plots import device_plots, model_plots, parameter_rows
from inerter.simulate.quantities import quantity_of_control
from inerter.simulate.run import run_model
from inerter.simulate.summary import summary
from simulate_models import device, oscillator, written


def test_a_unit_for_the_joint_is_no_force_of_the_actuator_of_its_name(tmp_path: Path) -> None:
    """On the rig joint and actuator are both called `device`, and the actuator comes first."""
    path = written(tmp_path, device_mjcf(Device(inertance=100)))
    drive = tmp_path / "drive.csv"
    drive.write_text("time,device[mm]\n0,0\n0.1,5\n")
    with pytest.raises(SimulationError) as caught:
        run_model(path, control=drive)
    said = str(caught.value)
    assert "'device[mm]': the control of actuator 'device'" in said
    assert "it comes before the joint 'device'; rename one" in said
    # the control of the shaker is an acceleration, which the model does not say
    drive.write_text("time,shaker[mm/s^2],device[kN]\n0,1000,0\n0.1,1000,0\n")
    (run,) = run_model(path, control=drive).devices
    assert run.columns["acceleration"][-1] == pytest.approx(1.0, rel=1e-6)


CONTROLS = {
    '<position name="a" joint="x" kp="5"/>': "m",
    '<position name="a" joint="x" kp="5" kv="1" timeconst="0.1"/>': "m",
    '<velocity name="a" joint="x" kv="3"/>': "m/s",
    '<motor name="a" joint="x"/>': "N",
    '<motor name="a" joint="x" gear="-1"/>': "N",
    '<motor name="a" tendon="rope"/>': "N",
    '<motor name="a" joint="turn"/>': "N*m",
    '<position name="a" joint="turn" kp="5"/>': "rad",
    '<velocity name="a" joint="turn" kv="5"/>': "rad/s",
    '<motor name="a" joint="x" gear="20"/>': None,
    '<motor name="a" tendon="sum"/>': None,
    '<general name="a" joint="x" gainprm="7"/>': None,
    '<intvelocity name="a" joint="x" kp="5" actrange="-1 1"/>': None,
    device(inertance=1, name="a"): "N",
    device('joint="turn"', inertance=1, name="a"): "N*m",
}


@pytest.mark.parametrize("actuator", CONTROLS)
def test_what_a_control_is(actuator: str) -> None:
    xml = oscillator(actuator).replace("<geom ", '<joint name="turn" axis="1 0 0"/><geom ')
    xml = xml.replace("</tendon>", '<fixed name="sum"><joint joint="x" coef="3"/></fixed></tendon>')
    load_plugin()
    model = mujoco.MjModel.from_xml_string(xml)
    found = quantity_of_control(model, model.actuator("a").id)
    assert (found and found.unit) == CONTROLS[actuator]


def test_what_turns_is_pictured_in_its_units(tmp_path: Path) -> None:
    turning = oscillator(
        device('joint="turn"', states=1, inertance=0.1, friction="dahl", coulomb_force=0.2,
               bristle_stiffness=50.0),
        extra='<keyframe><key name="turned" qpos="0 0.3" qvel="0 1"/></keyframe>',
    ).replace("<geom ", '<joint name="turn" axis="1 0 0" stiffness="2"/><geom ')  # fmt: skip
    run = run_model(written(tmp_path, turning), 0.2, keyframe="turned")
    (strut,) = run.devices
    plots = device_plots(run, strut)
    assert plots["loop-displacement"].layout.xaxis.title.text == "displacement [rad]"
    assert plots["loop-velocity"].layout.xaxis.title.text == "velocity [rad/s]"
    assert plots["loop-velocity"].layout.yaxis.title.text == "torque [N·m]"
    assert plots["state-friction_state"].layout.yaxis.title.text == "friction state [rad]"
    rows = {name: value for name, value, _ in parameter_rows(run, strut)}
    assert rows["inertance"] == "0.1 kg·m²"
    assert rows["coulomb_force"] == "0.2 N·m"
    assert summary(run)["devices"][0]["motion"] == "rotation"
    page = render_page(run)
    assert "Force rms [N·m]" in page
    assert "Displacement min … max [rad]" in page


def test_a_vehicle_is_pictured_in_its_units() -> None:
    run = run_model(model_file("half_car"), 0.1, keyframe="kerb")
    units = {
        name: plot.layout.yaxis.title.text.rpartition(" ")[2]
        for name, plot in model_plots(run).items()
    }
    assert units["vehicle-tyre_force_front"] == "[N]"
    assert units["vehicle-pitch"] == "[rad]"
    assert units["vehicle-pitch_acceleration"] == "[rad/s²]"
    assert units["vehicle-body_acceleration"] == "[m/s²]"
    assert units["vehicle-strut_length_rear"] == "[m]"
    assert "<h1>half_car</h1>" in render_page(run)
