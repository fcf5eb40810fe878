"""Changing a device while its model runs: loops, sliders, live values, another law."""

from __future__ import annotations

from pathlib import Path

import mujoco
import numpy as np
import pytest
from inerter import Device, DeviceError
from inerter.core import friction_laws, parameters
from inerter.engine_errors import SimulationError
from inerter.models import model_names, model_path
from inerter.view.loop import Axes, Loop
from inerter.view.session import Session
from inerter.view.shake import Shake, read_shake, usual_shake
from inerter.view.sliders import keys_of, slider, value_of

STATE = mujoco.mjtState.mjSTATE_INTEGRATION
BOX = """
<mujoco>
  <option timestep="1e-3" integrator="implicitfast" gravity="0 0 0"/>
  <extension><plugin plugin="inerter.device"/></extension>
  <worldbody>
    <body><joint name="lift" type="slide" axis="0 0 1"/><geom size="0.1" mass="20"/></body>
  </worldbody>
  <actuator>
    <plugin name="strut" plugin="inerter.device" joint="lift" {actdim}>{config}</plugin>
    <general name="late" joint="lift" dyntype="integrator" gainprm="3"/>
  </actuator>
  <keyframe><key name="moving" qvel="0.1"/></keyframe>
</mujoco>
"""


def box(folder: Path, actdim: str = "", **values: object) -> Path:
    """A box on a device and on an actuator with a state."""
    config = "".join(f'<config key="{key}" value="{value}"/>' for key, value in values.items())
    path = folder / "box.xml"
    path.write_text(BOX.format(config=config, actdim=actdim), encoding="utf-8")
    return path


def state(model: mujoco.MjModel, data: mujoco.MjData) -> np.ndarray:
    found = np.empty(mujoco.mj_stateSize(model, STATE))
    mujoco.mj_getState(model, data, found, STATE)
    return found


def steps(session: Session, count: int) -> None:
    for _ in range(count):
        mujoco.mj_step(session.model, session.data)


# --- loops and sliders ----------------------------------------------------------------------------


def test_a_loop_keeps_the_newest_in_order() -> None:
    loop = Loop(capacity=5)
    for i in range(8):
        loop.append(float(i), 10.0 + i, 20.0 + i, 30.0 + i)
    found = loop.last(np.inf)
    np.testing.assert_array_equal(found, np.add.outer([0.0, 10, 20, 30], np.arange(3.0, 8.0)))
    np.testing.assert_array_equal(loop.last(2.0)[0], [5, 6, 7])


def test_a_loop_knows_a_pause_and_a_new_start() -> None:
    loop = Loop()
    assert loop.last(1.0).shape == (4, 0)
    for time in (0.0, 0.5, 0.5, 1.0):
        loop.append(time, 0, 0, 0)
    assert len(loop) == 3
    loop.append(0.1, 0, 0, 0)
    np.testing.assert_array_equal(loop.last(9.0)[0], [0.1])


@pytest.mark.parametrize("law", friction_laws())
def test_sliders_stay_within_what_a_parameter_may_be(law: str) -> None:
    device = Device(inertance=50, friction=law, **needed(law))
    for key in keys_of(device):
        found, may = slider(key, value_of(device, key), value_of(device, key)), parameters()[key]
        assert may.lower <= found.low <= found.value <= found.high <= may.upper, key
        assert found.low < found.high, key
        assert not (may.lower_open and found.low == may.lower), key
        if not (law == "none" or key in ("coulomb_force", "static_force", "bw_stiffness")):
            device.replace(**{key: found.high})


def needed(law: str) -> dict[str, float]:
    if law in parameters()["coulomb_force"].laws:
        return {"coulomb_force": 20.0}
    more = {"bouc_wen": {"bw_stiffness": 1e4},
            "maxwell_slip": {"slip_stiffness_1": 1e4, "slip_force_1": 20.0}}  # fmt: skip
    return more.get(law, {})


# --- live values ----------------------------------------------------------------------------------


@pytest.mark.parametrize("name", model_names())
def test_a_session_runs_as_the_file_does(name: str) -> None:
    """To the last bit: live parameters at their stated values change nothing."""
    path = model_path(name, "scene.xml")
    session = Session(path, "0")
    model = mujoco.MjModel.from_xml_path(str(path.absolute()))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    for _ in range(100):
        mujoco.mj_step(model, data)
    steps(session, 100)
    np.testing.assert_array_equal(state(session.model, session.data), state(model, data))


@pytest.mark.parametrize(
    ("key", "value"), [("inertance", 55.0), ("viscous", 90.0), ("coulomb_force", 3.0)]
)
def test_a_moved_slider_is_the_device_of_that_value(tmp_path: Path, key: str, value: float) -> None:
    values = {"inertance": 30, "viscous": 40, "friction": "coulomb", "coulomb_force": 8}
    session = Session(box(tmp_path, **values), "moving")
    session.set("strut", key, value)
    steps(session, 200)
    other = Session(box(tmp_path, **{**values, key: value}), "moving")
    steps(other, 200)
    np.testing.assert_allclose(session.data.qpos, other.data.qpos, rtol=1e-12)
    assert getattr(session.device("strut"), key) == value
    assert session.changes() == {"strut": {key: value}}
    assert {each.key: each.value for each in session.sliders("strut")}[key] == value


def test_what_turns_is_shown_in_its_units(tmp_path: Path) -> None:
    path = box(tmp_path, inertance=0.1, viscous=2.0)
    path.write_text(path.read_text().replace('type="slide"', 'type="hinge"'))
    session = Session(path)
    units = {each.key: each.unit for each in session.sliders("strut")}
    assert units["inertance"] == "kg*m^2"
    assert units["viscous"] == "N*m*s/rad"
    turning = Axes.of(session.motion("strut"))
    assert (turning.length, turning.speed, turning.force) == ("rad", "rad/s", "torque")
    assert Axes.of("translation").newton == "N"


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("inertance", -1.0, "inertance"),
        ("coulomb_force", 0.0, "coulomb_force"),
        ("viscous", float("nan"), "viscous"),
        ("series_stiffness", 1e5, "no slider"),
    ],
)
def test_what_cannot_be_is_refused_and_nothing_changes(
    tmp_path: Path, key: str, value: float, said: str
) -> None:
    session = Session(box(tmp_path, inertance=30, friction="coulomb", coulomb_force=8))
    before = session.model.numeric_data.copy()
    with pytest.raises(DeviceError, match=said):
        session.set("strut", key, value)
    np.testing.assert_array_equal(session.model.numeric_data, before)
    assert session.changes() == {}


def test_a_series_element_cannot_be_taken_away_live(tmp_path: Path) -> None:
    path = box(tmp_path, 'actdim="2"', inertance=30, series_stiffness=1e4, series_damping=0)
    session = Session(path)
    with pytest.raises(DeviceError, match="needs 0 states, the model has 2"):
        session.set("strut", "series_stiffness", 0.0)


# --- another law ----------------------------------------------------------------------------------


@pytest.mark.parametrize("law", friction_laws())
def test_a_run_goes_on_under_another_law(tmp_path: Path, law: str) -> None:
    values = {"inertance": 30, "friction": "dahl", "coulomb_force": 8, "bristle_stiffness": 1e4}
    session = Session(box(tmp_path, 'actdim="1"', **values), "moving")
    session.data.ctrl[1] = 2.0
    session.set("strut", "viscous", 12.0)
    steps(session, 37)
    mujoco.mj_forward(session.model, session.data)
    before, data = session.devices["strut"], session.data
    friction = float(data.sensordata[before.sensor["friction"]])
    late = float(data.act[int(session.model.actuator("late").actadr[0])])

    session.set_law("strut", law)
    new, place = session.data, session.devices["strut"]
    assert session.device("strut").friction == law
    assert session.device("strut").viscous == 12
    for name in ("time", "qpos", "qvel", "ctrl"):
        np.testing.assert_array_equal(getattr(new, name), getattr(data, name))
    assert late != 0
    assert new.act[int(session.model.actuator("late").actadr[0])] == late
    if "friction_state" in place.act and law != "rate_state":  # whose state is an age
        # the bristle begins with the force that there was
        kept = 8.0 if law != "bouc_wen" else np.inf
        found = float(new.sensordata[place.sensor["friction"]])
        assert abs(found) <= kept * (1 + 1e-9)
        assert found == pytest.approx(friction, rel=1e-6)
    steps(session, 100)
    assert np.isfinite(new.qpos).all()


def test_the_same_law_again_changes_nothing_of_the_run(tmp_path: Path) -> None:
    values = {"inertance": 30, "friction": "dahl", "coulomb_force": 8, "bristle_stiffness": 1e4}
    path = box(tmp_path, 'actdim="1"', **values)
    session, other = Session(path, "moving"), Session(path, "moving")
    for each in (session, other):
        steps(each, 20)
    session.set_law("strut", "dahl")
    for each in (session, other):
        steps(each, 50)
    np.testing.assert_allclose(session.data.qpos, other.data.qpos, rtol=1e-12)
    np.testing.assert_allclose(session.data.act, other.data.act, rtol=1e-12)


def test_a_law_that_is_not_there_is_refused(tmp_path: Path) -> None:
    session = Session(box(tmp_path, inertance=30))
    model = session.model
    with pytest.raises(DeviceError, match="choose one of none, coulomb"):
        session.set_law("strut", "sticky")
    assert session.model is model


def test_changes_rebuild_the_device(tmp_path: Path) -> None:
    """What is printed at the end, put into the file, is the device that was looked at."""
    session = Session(box(tmp_path, inertance=30))
    session.set_law("strut", "lugre")
    session.set("strut", "bristle_stiffness", 2e4)
    session.set("strut", "inertance", 44.0)
    changed = session.changes()["strut"]
    again = Session(box(tmp_path, 'actdim="1"', **{"inertance": 30, **changed}))
    before, after = session.device("strut"), again.device("strut")
    assert after.friction == before.friction
    for key in keys_of(before):
        assert value_of(after, key) == value_of(before, key), key


# --- for who has no plugin ------------------------------------------------------------------------


@pytest.mark.parametrize("name", model_names())
def test_the_shown_model_needs_no_plugin_and_takes_the_state(name: str) -> None:
    session = Session(model_path(name, "scene.xml"), "0")
    steps(session, 50)
    assert session.shown.nplugin == 0
    now = state(session.model, session.data)
    assert mujoco.mj_stateSize(session.shown, STATE) == now.size
    data = mujoco.MjData(session.shown)
    mujoco.mj_setState(session.shown, data, now, STATE)
    mujoco.mj_kinematics(session.shown, data)
    mujoco.mj_kinematics(session.model, session.data)
    np.testing.assert_array_equal(data.geom_xpos, session.data.geom_xpos)
    np.testing.assert_array_equal(data.ctrl, session.data.ctrl)
    np.testing.assert_array_equal(data.act, session.data.act)


# --- shaking, and what cannot be shown ------------------------------------------------------------


def test_a_shake_is_a_sine(tmp_path: Path) -> None:
    session = Session(model_path("quarter_car", "scene.xml"))
    assert usual_shake(session.model) == Shake("road", 0.01, 1.5)
    shake = read_shake("road=0.02@2", session.model)
    session.data.time = 1 / 16
    shake.apply(session.model, session.data)
    assert session.data.ctrl[0] == pytest.approx(0.02 * np.sin(np.pi / 4))


@pytest.mark.parametrize("text", ["road", "road=1", "road=a@1", "road=1@-1", "=1@1", "rod=1@1"])
def test_a_shake_that_cannot_be_is_refused(text: str) -> None:
    session = Session(model_path("quarter_car", "scene.xml"))
    with pytest.raises(SimulationError, match="--shake"):
        read_shake(text, session.model)


@pytest.mark.parametrize(
    ("xml", "said"),
    [
        (None, "give a model file"),
        ("<mujoco/>", "has no inerter.device"),
        ("<mujoco><oops/></mujoco>", "oops"),
    ],
)
def test_a_file_without_a_device_is_refused(tmp_path: Path, xml: str | None, said: str) -> None:
    path = tmp_path / "model.xml"
    if xml:
        path.write_text(xml, encoding="utf-8")
    with pytest.raises(SimulationError, match=said):
        Session(path)


def test_a_file_of_another_kind_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "README.md"
    path.write_text("# a page", encoding="utf-8")
    with pytest.raises(SimulationError, match=r"no model; give a model, \.xml$"):
        Session(path)
