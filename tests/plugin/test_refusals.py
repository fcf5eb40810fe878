"""Does a wrong configuration fail with words that help?

The message reaches the user as the text of the ValueError that loading the model raises.
"""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from plugin_models import plugin_actuator, quarter_car_xml

LUGRE = {"friction": "lugre", "coulomb_force": 10}

CONFIGURATIONS = {
    "not a number": ({"inertance": "abc"}, ['inertance is "abc"', "not a number", ">= 0 kg"]),
    "number and more": ({"inertance": "1e2kg"}, ['inertance is "1e2kg"', "not a number"]),
    "nan": ({"viscous": "nan"}, ['viscous is "nan"', "finite number >= 0 N*s/m"]),
    "infinite": ({"stiffness": "inf"}, ['stiffness is "inf"', "any finite number"]),
    "negative": ({"inertance": -1}, ['inertance is "-1"', "out of range", ">= 0 kg"]),
    "open bound": (
        {"friction": "dahl", "coulomb_force": 1, "bristle_stiffness": 0},
        ['bristle_stiffness is "0"', "> 0 N/m"],
    ),
    "two bounds": ({"load_friction": 1.5}, ['load_friction is "1.5"', ">= 0 and <= 1"]),
    "no such law": ({"friction": "luger"}, ['friction is "luger"', "dahl lugre bouc_wen"]),
    "key of another law": (
        {"friction": "coulomb", "coulomb_force": 1, "bristle_stiffness": 1},
        ["bristle_stiffness is given", 'friction is "coulomb"', "dahl lugre"],
    ),
    "key without a law": ({"coulomb_force": 5}, ["coulomb_force is given", 'friction is "none"']),
    "level missing": ({"friction": "lugre"}, ["coulomb_force is 0 N", "coulomb_force > 0 N"]),
    "levels crossed": (
        {**LUGRE, "static_force": 5},
        ["static_force is 5 N, below coulomb_force 10 N"],
    ),
    "stiffness missing": ({"friction": "bouc_wen"}, ["bw_stiffness is 0 N/m"]),
}


def refusal(xml: str) -> str:
    with pytest.raises(ValueError, match=r"inerter\.device") as caught:
        mujoco.MjModel.from_xml_string(xml)
    return str(caught.value)


@pytest.mark.parametrize(("keys", "words"), CONFIGURATIONS.values(), ids=CONFIGURATIONS)
def test_a_wrong_value_is_named(keys: dict, words: list[str]) -> None:
    text = refusal(quarter_car_xml(plugin_actuator({"inertance": 100, **keys})))
    for word in ['actuator "strut"', *words]:
        assert word in text


ATTRIBUTES = {
    "no actdim": (LUGRE, 'actdim="0"', ["actdim is 0", '"lugre") has 1 state', 'actdim="1"']),
    "large actdim": (LUGRE, 'actdim="3"', ["actdim is 3", 'actdim="1"']),
    "needless actdim": ({}, 'actdim="1"', ["actdim is 1", "has 0 states", 'actdim="0"']),
    "dyntype": ({}, 'dyntype="integrator"', ["dyntype", "remove"]),
    "two inertances": (
        {"inertance": 100},
        'armature="50"',
        ["inertance is 100 kg", "armature is 50"],
    ),
    "two dampings": ({"viscous": 100}, 'damping="50"', ["viscous is 100 N*s/m", "damping is 50"]),
    "polynomial damping": ({}, 'damping="1 2"', ["damping", "quadratic_damping"]),
    "negative armature": ({}, 'armature="-1"', ["armature is -1"]),
}


@pytest.mark.parametrize(
    ("keys", "attributes", "words"), ATTRIBUTES.values(), ids=ATTRIBUTES
)  # fmt: skip
def test_a_wrong_attribute_is_named(keys: dict, attributes: str, words: list[str]) -> None:
    text = refusal(quarter_car_xml(plugin_actuator(keys, attributes=attributes)))
    for word in ['actuator "strut"', *words]:
        assert word in text


def test_equal_statements_are_fine() -> None:
    keys = {"inertance": 100, "viscous": 5}
    xml = quarter_car_xml(plugin_actuator(keys, attributes='armature="100" damping="5"'))
    model = mujoco.MjModel.from_xml_string(xml)
    assert (model.actuator_armature[0], model.actuator_damping[0]) == (100, 5)
    model = mujoco.MjModel.from_xml_string(
        quarter_car_xml(plugin_actuator({}, attributes='armature="100"'))
    )
    assert model.actuator_armature[0] == 100


# bodies in all positions to one another, and tendons between them
SPACE = """
<mujoco>
  <extension><plugin plugin="inerter.device">{instance}</plugin></extension>
  <worldbody>
    <site name="world"/><site name="west" pos="-1 0 2"/><site name="east" pos="1 0 2"/>
    <geom name="drum" type="cylinder" size="0.1 0.1" pos="1 0 0"/>
    <site name="side" pos="1 0.2 0"/>
    <body name="wheel" pos="0 0 1">
      <joint name="wheel" type="slide"/><geom size="0.1"/><site name="wheel"/>
    </body>
    <body name="body" pos="0 0 2">
      <joint name="body" type="slide"/><geom name="roll" size="0.1"/><site name="body"/>
      <site name="top" pos="0 0 0.2"/>
    </body>
    <body name="base" pos="0 0 3">
      <joint name="base" axis="0 1 0"/><geom size="0.1"/>
      <body name="left" pos="0.1 0 0.5">
        <joint name="left" axis="0 1 0"/><geom size="0.1" pos="0 0 0.2"/><site name="left"/>
      </body>
      <body name="right" pos="-0.1 0 0.5">
        <joint name="right" axis="0 1 0"/><geom size="0.1" pos="0 0 0.2"/><site name="right"/>
      </body>
    </body>
    <body name="ball" pos="0 1 1"{simple}>
      <freejoint name="ball"/><geom size="0.1"/><site name="ball" pos="0.1 0 0"/>
    </body>
    <body name="swivel" pos="0 2 1"><joint name="swivel" type="ball"/><geom size="0.1"/></body>
  </worldbody>
  <tendon>
    <spatial name="siblings"><site site="wheel"/><site site="body"/></spatial>
    <spatial name="cousins"><site site="left"/><site site="right"/></spatial>
    <spatial name="free"><site site="world"/><site site="ball"/></spatial>
    <fixed name="two"><joint joint="wheel" coef="1"/><joint joint="body" coef="-1"/></fixed>
    <spatial name="loop"><site site="west"/><geom geom="roll" sidesite="top"/>
      <site site="east"/></spatial>
    <spatial name="round"><site site="world"/><geom geom="drum" sidesite="side"/>
      <site site="wheel"/></spatial>
  </tendon>
  <actuator>{actuator}</actuator>
</mujoco>"""


def space(actuator: str, simple: str = "", instance: str = "") -> str:
    return SPACE.format(actuator=actuator, simple=simple, instance=instance)


TOPOLOGY = {
    "wrapping": ('tendon="round"', ['tendon "round"', 'geom "drum"']),
    "free joint": ('joint="ball"', ["free joint", "slide or hinge"]),
    "ball joint": ('joint="swivel"', ["ball joint", "slide or hinge"]),
    "site": ('site="ball"', ["neither a tendon nor a joint"]),
}


@pytest.mark.parametrize(("target", "words"), TOPOLOGY.values(), ids=TOPOLOGY)
def test_a_transmission_that_cannot_carry_inertance_is_refused(
    target: str, words: list[str]
) -> None:
    text = refusal(space(plugin_actuator({"inertance": 2}, target)))
    for word in ['actuator "strut"', *words]:
        assert word in text


def test_a_live_inertance_on_a_wrapping_tendon_is_refused() -> None:
    numeric = '<custom><numeric name="strut.inertance" data="5"/></custom></mujoco>'
    device = plugin_actuator({"viscous": 2}, 'tendon="round"')
    text = refusal(space(device).replace("</mujoco>", numeric))
    for word in ['actuator "strut"', "inertance is 0 kg and live", 'tendon "round"']:
        assert word in text


@pytest.mark.parametrize("target", ["siblings", "cousins", "two", "free", "round", "loop"])
def test_without_inertance_or_with_elasticity_any_tendon_will_do(target: str) -> None:
    elastic = {"inertance": 2, "series_stiffness": 1e4, "series_damping": 10}
    for keys, actdim in (({"viscous": 2, **LUGRE}, 1), (elastic, 2)):
        model = mujoco.MjModel.from_xml_string(
            space(plugin_actuator(keys, f'tendon="{target}"', attributes=f'actdim="{actdim}"'))
        )
        data = mujoco.MjData(model)
        data.qvel[:] = np.linspace(-1, 1, model.nv)
        mujoco.mj_step(model, data, nstep=20)
        assert np.isfinite(data.qpos).all()
        assert data.act.any()


@pytest.mark.parametrize("target", ["siblings", "cousins", "two", "free"])
def test_where_the_engine_cannot_hold_the_inertance_the_plugin_does(target: str) -> None:
    model = mujoco.MjModel.from_xml_string(
        space(plugin_actuator({"inertance": 2}, f'tendon="{target}"'))
    )
    assert model.actuator_armature[0] == 0
    mujoco.mj_step(model, mujoco.MjData(model))


def test_where_the_engine_can_hold_the_inertance_it_does() -> None:
    for target, simple in (('tendon="free"', ' simple="false"'), ('joint="left"', "")):
        model = mujoco.MjModel.from_xml_string(
            space(plugin_actuator({"inertance": 2}, target), simple)
        )
        assert model.actuator_armature[0] == 2


TWICE = {
    "armature": ('armature="3"', ["armature is 3", "two branches", "inertance"]),
    "damping": ('damping="3"', ["damping is 3", "viscous"]),
}


@pytest.mark.parametrize(("attribute", "words"), TWICE.values(), ids=TWICE)
def test_what_the_engine_cannot_hold_is_refused(attribute: str, words: list[str]) -> None:
    device = plugin_actuator({"inertance": 2}, 'tendon="two"', attributes=attribute)
    text = refusal(space(device))
    for word in ['actuator "strut"', *words]:
        assert word in text


LIVE = {
    "two values": ('name="strut.viscous" data="1 2"', ["strut.viscous", "one number"]),
    "out of range": ('name="strut.viscous" data="-1"', ["viscous is -1", ">= 0"]),
}


@pytest.mark.parametrize(("numeric", "words"), LIVE.values(), ids=LIVE)
def test_a_wrong_live_parameter_is_named(numeric: str, words: list[str]) -> None:
    xml = quarter_car_xml(plugin_actuator({}), extra=f"<custom><numeric {numeric}/></custom>")
    text = refusal(xml)
    for word in ['actuator "strut"', *words]:
        assert word in text


def test_a_live_parameter_that_turns_wrong_stops_the_run() -> None:
    numeric = '<custom><numeric name="strut.viscous" data="1"/></custom>'
    model = mujoco.MjModel.from_xml_string(quarter_car_xml(plugin_actuator({}), extra=numeric))
    data = mujoco.MjData(model)
    for value in (-1.0, np.nan, np.inf):
        model.numeric_data[0] = value
        with pytest.raises(mujoco.FatalError, match=r'actuator "strut": .*viscous is'):
            mujoco.mj_step(model, data)
        model.numeric_data[0] = 2.0
        mujoco.mj_step(model, data)


def test_an_instance_needs_one_actuator() -> None:
    instance = '<instance name="shared"><config key="inertance" value="1"/></instance>'
    use = '<plugin plugin="inerter.device" instance="shared" joint="{}"/>'
    text = refusal(space(use.format("wheel") + use.format("body"), instance=instance))
    assert 'instance "shared"' in text
    assert "2 actuators" in text
    sensor = '<plugin name="s" plugin="inerter.device" instance="shared"/>'
    xml = space("", instance=instance).replace("</mujoco>", f"<sensor>{sensor}</sensor></mujoco>")
    assert "no actuator refers to it" in refusal(xml)


def test_a_plugin_of_a_body_is_told_what_it_is() -> None:
    body = '<plugin plugin="inerter.device"><config key="inertance" value="2"/></plugin></body>'
    text = refusal(space("").replace("</body>", body, 1))
    assert "refers to it, but a device acts between two points" in text


@pytest.mark.parametrize("gear", ["nan", "inf"])
def test_a_gear_that_is_no_number_is_refused(gear: str) -> None:
    device = plugin_actuator({"inertance": 2}, 'joint="wheel"', attributes=f'gear="{gear}"')
    assert f"gear is {gear}" in refusal(space(device))


def test_sleep_that_is_enabled_later_is_refused() -> None:
    xml = f"""<mujoco><extension><plugin plugin="inerter.device"/></extension>
      <worldbody>
        <body sleep="allowed"><freejoint/><geom size="0.1"/><site name="a"/></body>
        <body sleep="allowed" pos="1 0 0"><freejoint/><geom size="0.1"/><site name="b"/></body>
      </worldbody>
      <tendon><spatial name="strut"><site site="a"/><site site="b"/></spatial></tendon>
      <actuator>{plugin_actuator({"inertance": 2})}</actuator></mujoco>"""
    model = mujoco.MjModel.from_xml_string(xml)
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data)
    model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_SLEEP
    with pytest.raises(mujoco.FatalError, match=r'actuator "strut": sleep is enabled and body'):
        mujoco.mj_step(model, data)


def test_an_unknown_key_is_the_compilers_error() -> None:
    with pytest.raises(ValueError, match="inertence"):
        mujoco.MjModel.from_xml_string(quarter_car_xml(plugin_actuator({"inertence": 1})))
