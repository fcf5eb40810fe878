"""What the plugin refuses or says once, because the engine would carry it wrongly in silence."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from plugin_models import plugin_actuator, quarter_car_xml

SERIES = {"inertance": 2, "series_stiffness": 1e9}

# two bodies that fall in two trees, their sites apart
PAIR = """
<mujoco>
  <extension><plugin plugin="inerter.device"/></extension>
  <option gravity="0 0 0">{flag}</option>
  <worldbody>
    <body name="a" {sleep}>
      <joint name="a" type="slide" axis="0 0 1" {joint}/><geom size="0.1" mass="10"/>
      <site name="a"/><site name="b" pos="0.1 0 0"/>
    </body>
    <body name="c" pos="0 0 1" {sleep}>
      <joint name="c" type="slide" axis="0 0 1"/><geom size="0.1" mass="10"/>
      <site name="c" pos="0 0 {c}"/>
    </body>
  </worldbody>
  <tendon>
    <spatial name="pair" {tendon}><site site="a"/><site site="c"/></spatial>
    <spatial name="same"><site site="a"/><site site="b"/></spatial>
  </tendon>
  <actuator>{actuator}</actuator>
</mujoco>"""


def pair(
    target: str = 'tendon="pair"', attributes: str = "", actdim: int = 0, keys: dict | None = None,
    **texts: str,
) -> str:  # fmt: skip
    """A device on the pair of bodies."""
    blanks = {"flag": "", "sleep": "", "joint": "", "tendon": "", "c": "0"}
    if actdim:
        attributes += f' actdim="{actdim}"'
    device = plugin_actuator(keys or {"inertance": 5}, target, attributes=attributes)
    return PAIR.format(actuator=device, **{**blanks, **texts})


REFUSED = {
    "friction of no load": (
        pair(keys={"load_friction": 0.5}), ["load_friction is given", "inertance is 0"]),
    "variation of nothing": (
        pair(keys={"viscous": 1, "inertance_gradient": 1}), ["variation", "inertance is 0"]),
    "no gear": (pair(attributes='gear="0"'), ["gear is 0"]),
    "one body": (pair('tendon="same"'), ['tendon "same"', "do nothing", "two bodies"]),
    "armature of the tendon": (
        pair(tendon='armature="3"'), ['armature of tendon "pair" is 3', "inertance"]),
    "slip in a numeric": (
        pair().replace(
            "</mujoco>", '<custom><numeric name="strut.inertence" data="1"/></custom></mujoco>'),
        ['"strut.inertence"', "not a parameter", "inerter parameters"]),
}  # fmt: skip


@pytest.mark.parametrize(("xml", "words"), REFUSED.values(), ids=REFUSED)
def test_a_model_that_would_lie_is_refused(xml: str, words: list[str]) -> None:
    with pytest.raises(ValueError, match='actuator "strut"') as error:
        mujoco.MjModel.from_xml_string(xml)
    for word in words:
        assert word in str(error.value)


def test_trees_that_sleep_one_by_one_are_refused(capfd: pytest.CaptureFixture) -> None:
    # the compiler decides who may sleep after the plugins are made: it shows in the first MjData
    xml = pair(flag='<flag sleep="enable"/>', sleep='sleep="allowed"')
    model = mujoco.MjModel.from_xml_string(xml)
    with pytest.raises(mujoco.FatalError, match="plugin->init failed"):
        mujoco.MjData(model)
    text = said(capfd)
    for word in ("sleep is enabled", 'body "c"', 'sleep="never"'):
        assert word in text


def test_what_is_not_a_lie_is_taken() -> None:
    for xml in (
        pair(flag='<flag sleep="enable"/>', sleep='sleep="never"'),
        pair(tendon='armature="3"', keys={"viscous": 5}).replace("armature", "stiffness"),
    ):
        mujoco.mj_step(model := mujoco.MjModel.from_xml_string(xml), mujoco.MjData(model))


def test_an_armature_that_the_engine_cannot_hold_stops_the_run() -> None:
    model = mujoco.MjModel.from_xml_string(pair())
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data)
    model.actuator_armature[0] = 50
    with pytest.raises(mujoco.FatalError, match=r"actuator_armature is 50.*strut.inertance"):
        mujoco.mj_step(model, data)


def run(model: mujoco.MjModel, steps: int = 5) -> mujoco.MjData:
    data = mujoco.MjData(model)
    data.qvel[:] = np.linspace(1e-3, -1e-3, model.nv)
    mujoco.mj_step(model, data, steps)
    return data


def said(capfd: pytest.CaptureFixture) -> str:
    text = capfd.readouterr()
    return text.err + text.out


@pytest.mark.parametrize(
    ("keys", "actdim", "cause"),
    [
        ({"inertance": 2, "series_stiffness": 1e9}, 2, "series_stiffness is too stiff"),
        ({"viscous": 1e7}, 0, "viscous is too stiff"),
        ({"stop_upper": 1.0, "stop_stiffness": 1e10}, 0, "stop_stiffness is too stiff"),
        ({"friction": "coulomb", "coulomb_force": 1e4}, 0, "transition_velocity"),
        ({"friction": "brown_mcphee", "coulomb_force": 1e6}, 0, "within stribeck_velocity"),
        ({"stiffness": 1e9}, 0, "stiffness is too stiff"),
    ],
)
def test_what_is_too_stiff_is_said_once(
    capfd: pytest.CaptureFixture, keys: dict, actdim: int, cause: str
) -> None:
    attributes = f'actdim="{actdim}"' if actdim else ""
    xml = quarter_car_xml(plugin_actuator(keys, attributes=attributes), option='integrator="RK4"')
    model = mujoco.MjModel.from_xml_string(xml)
    said(capfd)
    run(model, 1)
    text = said(capfd)
    assert text.count(cause) == 1
    assert "RK4 with a timestep of 0.002 s" in text

    # the step that it names is short enough
    model.opt.timestep = 0.99 * float(text.split("set timestep <= ")[1].split(",")[0])
    run(model)
    assert cause not in said(capfd)


@pytest.mark.parametrize("where", ['joint="j"', 'tendon="t"'])
def test_an_inertance_on_a_light_carriage_counts_as_its_mass(
    capfd: pytest.CaptureFixture, where: str
) -> None:
    """100 N s/m on 60 kg are slow, whatever the engine takes for the weight of a sliding body."""
    model = mujoco.MjModel.from_xml_string(
        f"""<mujoco><extension><plugin plugin="inerter.device"/></extension>
        <option integrator="RK4" timestep="0.001"/>
        <worldbody><body><joint name="j" type="slide"/>
        <inertial pos="0 0 0" mass="1e-3" diaginertia="1e-6 1e-6 1e-6"/></body></worldbody>
        <tendon><fixed name="t"><joint joint="j" coef="1"/></fixed></tendon>
        <actuator><plugin plugin="inerter.device" {where}>
        <config key="inertance" value="60"/><config key="viscous" value="100"/></plugin></actuator>
        </mujoco>"""
    )
    run(model)
    assert "too stiff" not in said(capfd)


@pytest.mark.parametrize(
    ("integrator", "where", "flag", "most"),
    [
        # the engine takes the damping of a tendon at the start of a step: h c / m < 2
        ("Euler", "tendon", "", 500.0),
        ("Euler", "joint", "", np.inf),
        ("Euler", "joint", '<flag eulerdamp="disable"/>', 500.0),
        ("implicitfast", "tendon", "", np.inf),
        ("discrete", "tendon", "", np.inf),
    ],
)
def test_damping_that_a_step_does_not_resolve_is_said(
    capfd: pytest.CaptureFixture, integrator: str, where: str, flag: str, most: float
) -> None:
    """On the engine's own damping of a slide of 1 kg, step of 4 ms."""
    for damping in (0.95 * 500.0, 1.1 * 500.0):
        model = mujoco.MjModel.from_xml_string(
            f"""<mujoco><extension><plugin plugin="inerter.device"/></extension>
            <option integrator="{integrator}" timestep="4e-3" gravity="0 0 0">{flag}</option>
            <worldbody><body><joint name="j" type="slide"/>
            <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body></worldbody>
            <tendon><fixed name="t"><joint joint="j" coef="1"/></fixed></tendon>
            <actuator><plugin plugin="inerter.device" {where}="{where[0]}">
            <config key="viscous" value="{damping}"/></plugin></actuator></mujoco>"""
        )
        data = run(model, 30)
        assert ("viscous is too stiff" in said(capfd)) == (damping > most)
        assert (np.abs(data.qvel).max() < 1e-3) == (damping < most)


def test_stiffness_is_looked_at_again_when_the_options_change(
    capfd: pytest.CaptureFixture,
) -> None:
    xml = quarter_car_xml(plugin_actuator(SERIES, attributes='actdim="2"'))
    model = mujoco.MjModel.from_xml_string(xml)
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data)
    assert "too stiff" not in said(capfd)
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_RK4
    mujoco.mj_step(model, data)
    assert "too stiff for RK4" in said(capfd)


def test_sites_that_meet_are_said_once(capfd: pytest.CaptureFixture) -> None:
    model = mujoco.MjModel.from_xml_string(pair(c="-1"))
    run(model)
    assert said(capfd).count("the sites of its tendon meet") == 1


def test_where_a_position_is_no_number_sites_do_not_meet(capfd: pytest.CaptureFixture) -> None:
    model = mujoco.MjModel.from_xml_string(pair())
    data = mujoco.MjData(model)
    data.qpos[:] = np.nan
    mujoco.mj_forward(model, data)
    assert not np.isfinite(data.ten_length).any()
    assert "sites of its tendon meet" not in said(capfd)


def test_a_law_that_leaves_its_range_is_said_once(capfd: pytest.CaptureFixture) -> None:
    keys = {"inertance": 5, "inertance_gradient": -10}
    model = mujoco.MjModel.from_xml_string(pair('joint="a"', keys=keys))
    data = mujoco.MjData(model)
    data.qpos[0] = 0.2
    mujoco.mj_step(model, data, 3)
    assert said(capfd).count("inertance_gradient -10 1/m") == 1


def test_bodies_at_rest_on_the_ground_are_quiet(capfd: pytest.CaptureFixture) -> None:
    # forces near zero, where a relative fit means nothing
    device = plugin_actuator({"inertance": 10})
    xml = f"""
    <mujoco>
      <extension><plugin plugin="inerter.device"/></extension>
      <worldbody>
        <geom type="plane" size="3 3 0.1"/>
        <body pos="0 0 0.1"><freejoint/><geom type="box" size="0.1 0.1 0.1"/><site name="a"/></body>
        <body pos="1 0 0.1"><freejoint/><geom type="box" size="0.1 0.1 0.1"/><site name="b"/></body>
      </worldbody>
      <tendon><spatial name="strut"><site site="a"/><site site="b"/></spatial></tendon>
      <actuator>{device}</actuator>
    </mujoco>"""
    model = mujoco.MjModel.from_xml_string(xml)
    mujoco.mj_step(model, mujoco.MjData(model), 200)
    assert "fit" not in said(capfd)


@pytest.mark.parametrize("stiffness", [1e8, 1e10, 1e12])
def test_a_stiff_series_element_is_quiet(capfd: pytest.CaptureFixture, stiffness: float) -> None:
    keys = {"inertance": 20, "series_stiffness": stiffness}
    model = mujoco.MjModel.from_xml_string(
        pair(keys=keys, actdim=2).replace("<option ", '<option integrator="implicitfast" ')
    )
    data = run(model, 300)
    assert "WARNING" not in said(capfd)
    assert np.isfinite(data.qpos).all()


def test_damping_can_be_disabled_wherever_it_lives() -> None:
    for target in ('joint="a"', 'tendon="pair"'):
        xml = pair(target, keys={"viscous": 1e4}, flag='<flag damper="disable"/>')
        model = mujoco.MjModel.from_xml_string(xml)
        data = mujoco.MjData(model)
        data.qvel[:] = 1, -1
        mujoco.mj_step(model, data, 50)
        np.testing.assert_allclose(data.qvel, [1, -1], atol=1e-12)


def test_red_is_tension_in_a_viewer() -> None:
    # native inertance: the force is the engine's, not the actuator's
    model = mujoco.MjModel.from_xml_string(pair('joint="a"', keys={"viscous": 1e4}))
    data, scene = mujoco.MjData(model), mujoco.MjvScene(model, 100)
    for speed, red in ((1.0, True), (-1.0, False)):
        data.qvel[0] = speed
        mujoco.mj_forward(model, data)
        mujoco.mjv_updateScene(model, data, mujoco.MjvOption(), None, mujoco.MjvCamera(), 7, scene)
        barrels = [
            geom.rgba.copy()
            for geom in scene.geoms[: scene.ngeom]
            if geom.type == mujoco.mjtGeom.mjGEOM_CYLINDER and geom.category == 4
        ]
        assert (barrels[0][0] > barrels[0][2]) == red
