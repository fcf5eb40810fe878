"""Models with devices that are attached, edited, saved and taken apart."""

from __future__ import annotations

import re

import mujoco
import numpy as np
import pytest
from inerter import AddedDevice, add_device, device_of, remove_device

LEG = """
<mujoco>
  <worldbody>
    <site name="hip"/>
    <body name="shin" pos="0 0 0.5">
      <joint name="knee" type="slide" axis="0 0 1"/>
      <geom size="0.1" mass="2"/>
      <site name="foot"/>
    </body>
  </worldbody>
  <actuator><motor name="motor" joint="knee"/></actuator>
  <keyframe><key name="down" qpos="-0.1" ctrl="3"/></keyframe>
</mujoco>"""
KEYS = {"inertance": 5.0, "viscous": 2.0, "friction": "dahl", "coulomb_force": 3.0}


def leg(**options: object) -> tuple[mujoco.MjSpec, AddedDevice]:
    spec = mujoco.MjSpec.from_string(LEG)
    given: dict = {"between": ("hip", ("shin", (0, 0, 0.1))), "live": ("coulomb_force",), **KEYS}
    return spec, add_device(spec, "strut", rest_length=0.6, **{**given, **options})


def texts(spec: mujoco.MjSpec) -> str:
    return re.sub(r"\s+", " ", spec.to_xml())


# ------------------------------ attached ------------------------------


@pytest.mark.filterwarnings("ignore:Attaching a spec with an empty prefix")
@pytest.mark.parametrize(("prefix", "suffix"), [("front_", ""), ("", "_left"), ("a/", "/b")])
def test_a_device_is_found_under_its_new_name(prefix: str, suffix: str) -> None:
    child, added = leg()
    parent = mujoco.MjSpec()
    parent.attach(child, prefix=prefix, suffix=suffix, frame=parent.worldbody.add_frame())
    model = parent.compile()
    place = added.of(model)
    assert place.name == f"{prefix}strut{suffix}"
    assert place.device.given == added.device.given
    data = mujoco.MjData(model)
    data.qvel[:] = 0.2
    mujoco.mj_forward(model, data)
    assert place.read(data.sensordata)["total"] != 0
    remove_device(parent, added)
    parent.compile()
    assert "strut" not in parent.to_xml()


def test_a_device_attached_twice_wants_its_name() -> None:
    parent = mujoco.MjSpec()
    for prefix in ("left_", "right_"):
        child, added = leg()
        parent.attach(child, prefix=prefix, frame=parent.worldbody.add_frame())
    model = parent.compile()
    for refused in (lambda: added.of(model), lambda: remove_device(parent, added)):
        with pytest.raises(ValueError, match="more than once: 'left_strut', 'right_strut'"):
            refused()
    assert added.of(model, "right_strut").actuator == 3
    remove_device(parent, "left_strut")
    assert added.of(parent.compile()).name == "right_strut"


# ------------------------------ taken out ------------------------------


def test_what_was_added_is_taken_out() -> None:
    spec, added = leg()
    spec.compile()
    bare = mujoco.MjSpec.from_string(LEG)
    bare.activate_plugin("inerter.device")
    remove_device(spec, added)
    again = spec.compile()
    bare.compile()
    assert texts(spec) == texts(bare)
    assert (again.nactuator, again.nsensor, again.ntendon, again.nplugin) == (1, 0, 0, 0)
    assert (again.key_ctrl, again.key_qpos) == ([[3.0]], [[-0.1]])
    add_device(spec, "strut", between=("hip", ("shin", (0, 0, 0.1))), **KEYS)


def test_keyframes_lose_what_was_the_device_s() -> None:
    spec, added = leg()
    other = add_device(spec, "other", joint="knee", friction="dahl", coulomb_force=1.0)
    # a device may have a control of its own or none
    nu = spec.copy().compile().nu
    spec.key("down").act, spec.key("down").ctrl = [1e-4, 2e-4], [3.0, 4.0, 5.0][:nu]
    spec.compile()
    remove_device(spec, added)
    model = spec.compile()
    assert other.of(model).act == {"friction_state": 0}
    assert model.key_act.tolist() == [[2e-4]]
    assert model.key_ctrl.tolist() == [[3.0, 5.0] if nu == 3 else [3.0]]


def test_what_others_use_stays() -> None:
    spec, added = leg(between=("hip", "foot"))
    spec.add_actuator(name="pull", target="strut", trntype=mujoco.mjtTrn.mjTRN_TENDON)
    remove_device(spec, added)
    assert spec.tendon("strut") is not None
    assert spec.site("foot") is not None
    assert [each.name for each in spec.actuators] == ["motor", "pull"]
    spec.compile()


def test_a_device_written_in_xml_is_taken_out_by_name() -> None:
    spec, _ = leg()
    written = mujoco.MjSpec.from_string(spec.to_xml())
    remove_device(written, "strut")
    assert written.tendon("strut") is not None
    model = written.compile()
    assert (model.nactuator, model.nsensor, model.nnumeric, model.nplugin) == (1, 0, 0, 0)


@pytest.mark.parametrize("deleted", ["actuator", "body"])
def test_the_rest_of_a_deleted_device_is_taken_along(deleted: str) -> None:
    spec, added = leg()
    element = spec.body("shin") if deleted == "body" else spec.actuator("strut")
    if deleted == "body":
        spec.delete(spec.actuator("motor"))
        spec.delete(spec.key("down"))
    spec.delete(element)
    with pytest.raises(ValueError, match=r'instance "strut": no actuator refers to it'):
        spec.copy().compile()
    remove_device(spec, added)
    model = spec.compile()
    assert (model.nplugin, model.nsensor, model.nnumeric, model.ntendon) == (0, 0, 0, 0)


def test_mistakes_are_one_line() -> None:
    spec, _ = leg()
    before = texts(spec)
    with pytest.raises(ValueError, match="no device 'strat' in the spec; its devices: 'strut'"):
        remove_device(spec, "strat")
    with pytest.raises(ValueError, match=r"actuator 'motor' is no inerter\.device"):
        remove_device(spec, "motor")
    with pytest.raises(ValueError, match="give what add_device returned"):
        remove_device(spec, 3)  # type: ignore[arg-type]
    assert texts(spec) == before


# ------------------------------ saved and edited ------------------------------


def held(model: mujoco.MjModel) -> tuple[float, float]:
    """Inertance and viscous damping that the engine integrates."""
    actuator = model.actuator("strut").id
    return float(model.actuator_armature[actuator]), float(model.actuator_damping[actuator])


def edited(xml: str, key: str, value: str) -> str:
    found, count = re.subn(rf'(key="{key}" value=)"[^"]*"', rf'\1"{value}"', xml)
    assert count == 1
    return found


def saved(**options: object) -> str:
    spec, _ = leg(**options)
    spec.compile()
    return spec.to_xml()


def test_saved_xml_states_the_same() -> None:
    xml = saved(inertance=1 / 3)
    again = mujoco.MjSpec.from_string(xml)
    assert held(again.compile()) == (1 / 3, 2.0)
    assert held(mujoco.MjModel.from_xml_string(again.to_xml())) == (1 / 3, 2.0)


def test_the_configuration_of_saved_xml_can_be_edited() -> None:
    xml = edited(edited(saved(), "inertance", "7.5"), "viscous", "0.5")
    model = mujoco.MjModel.from_xml_string(xml)
    assert held(model) == (7.5, 0.5)
    assert device_of(model, "strut").device.inertance == 7.5


def test_the_attribute_of_saved_xml_can_be_edited() -> None:
    xml = saved().replace('armature="5"', 'armature="8"')
    spec = mujoco.MjSpec.from_string(xml)
    model = spec.compile()
    assert held(model) == (8.0, 2.0)
    # and it stays so when it is saved again
    again = mujoco.MjModel.from_xml_string(spec.to_xml())
    assert held(again) == (8.0, 2.0)
    assert device_of(again, "strut").now(again).inertance == 8.0


def test_both_edited_is_said() -> None:
    xml = edited(saved(), "inertance", "7.5").replace('armature="5"', 'armature="8"')
    with pytest.raises(ValueError, match=r"inertance is 7.5 kg, but the actuator's armature is 8"):
        mujoco.MjModel.from_xml_string(xml)


def test_a_key_taken_out_of_saved_xml_is_gone() -> None:
    xml = re.sub(r'<config key="viscous"[^>]*/>', "", saved())
    assert held(mujoco.MjModel.from_xml_string(xml)) == (5.0, 0.0)


def test_saved_xml_whose_device_moves_between_branches_runs() -> None:
    """There the plugin carries what the file states as armature."""
    spec = mujoco.MjSpec.from_string(saved(live=()))
    crate = spec.worldbody.add_body(name="crate", pos=[0, 0, 0.1])
    crate.add_joint(type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[0, 0, 1])
    crate.add_geom(size=[0.1, 0, 0], mass=1, contype=0, conaffinity=0)
    spec.delete(spec.key("down"))
    spec.delete(spec.site("hip"))
    crate.add_site(name="hip")
    tendon = spec.tendon("strut")
    if tendon is None:
        tendon = spec.add_tendon(name="strut")
        tendon.wrap_site("hip")
        tendon.wrap_site("strut_2")
    model = spec.compile()
    assert held(model) == (0.0, 0.0)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    read = device_of(model, "strut").read(data.sensordata)
    np.testing.assert_allclose(read["inertance"], 0, atol=1e-9)  # both fall alike
