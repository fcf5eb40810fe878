"""Devices in models that are put together as trees of XML, as robosuite does.

Such a merge takes bodies, tendons, actuators and sensors of each part, and leaves <extension> out:
the device's instance would be lost. A device whose configuration stands in its actuator comes
along; in the whole, `add_device` adds one.
"""

from __future__ import annotations

from xml.etree import ElementTree

import mujoco
import pytest
from inerter import add_device, device_of

WORLD = """
<mujoco>
  <extension><plugin plugin="inerter.device"/></extension>
  <worldbody><geom type="plane" size="2 2 0.1"/><site name="anchor" pos="0 0 1.5"/></worldbody>
</mujoco>"""
ROBOT = """
<mujoco>
  <worldbody>
    <body name="base" pos="0 0 0.6">
      <joint name="turn" axis="0 0 1"/><geom size="0.1" mass="3"/>
      <body name="arm" pos="0.1 0 0">
        <joint name="lift" axis="0 1 0"/>
        <geom type="capsule" fromto="0 0 0 0.4 0 0" size="0.04" mass="1.5" contype="0"/>
        <site name="flange" pos="0.4 0 0"/>
      </body>
    </body>
  </worldbody>
  <actuator>
    <plugin name="lift" plugin="inerter.device" joint="lift" actdim="1">
      <config key="inertance" value="0.3"/>
      <config key="friction" value="dahl"/><config key="coulomb_force" value="0.5"/>
    </plugin>
  </actuator>
</mujoco>"""
# what names something, and is given the robot's prefix
NAMING = ("name", "joint", "site", "tendon", "body", "instance")


def merged(*robots: tuple[str, str]) -> str:
    """The world with robots, each by its prefix; only what robosuite's merge takes."""
    world = ElementTree.fromstring(WORLD)
    for prefix, text in robots:
        robot = ElementTree.fromstring(text)
        for element in robot.iter():
            for key in NAMING:
                if key in element.attrib:
                    element.set(key, prefix + element.attrib[key])
        for kind in ("worldbody", "actuator", "sensor", "tendon", "equality", "contact"):
            part = robot.find(kind)
            if part is None:
                continue
            whole = world.find(kind)
            if whole is None:
                whole = ElementTree.SubElement(world, kind)
            whole.extend(list(part))
    return ElementTree.tostring(world, encoding="unicode")


def test_devices_of_the_parts_come_along() -> None:
    model = mujoco.MjModel.from_xml_string(merged(("left_", ROBOT), ("right_", ROBOT)))
    for prefix in ("left_", "right_"):
        place = device_of(model, f"{prefix}lift")
        assert place.device.inertance == 0.3
        assert model.actuator_armature[place.actuator] == 0.3


def test_a_device_is_added_to_the_whole() -> None:
    spec = mujoco.MjSpec.from_string(merged(("left_", ROBOT), ("right_", ROBOT)))
    strut = add_device(
        spec, "strut", between=("anchor", "right_flange"), inertance=2.0, rest_length="initial"
    )
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 10)
    read = strut.of(model).read(data.sensordata)
    assert read["total"] == pytest.approx(read["inertance"])
    assert read["inertance"] != 0
    assert [device_of(model, name).name for name in ("left_lift", "right_lift", "strut")]
