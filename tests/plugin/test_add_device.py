"""A device added with MjSpec is the device written in XML; what cannot be is refused at once."""

from __future__ import annotations

import inerter
import mujoco
import numpy as np
import pytest
from inerter import AddedDevice, Device, add_device

STRUT = {"inertance": 113.0, "stiffness": 2e4, "friction": "lugre", "coulomb_force": 40.0,
         "static_force": 60.0, "bristle_stiffness": 1e5, "bristle_damping": 20.0}  # fmt: skip
SLANTED = np.array([0.3, -0.2, 0.5])

WRITTEN = """
<mujoco>
  <option timestep="0.001" integrator="implicitfast"/>
  <extension><plugin plugin="inerter.device"><instance name="strut">{config}</instance></plugin>
  </extension>
  <worldbody>
    <site name="low" pos="0.1 0 0"/>
    <body name="box" pos="0.3 -0.2 0.5">
      <joint name="along" type="slide" axis="0 0 1"/><joint name="turn" type="hinge" axis="1 0 0"/>
      <geom size="0.1" mass="20" pos="0 0.1 0"/>
      <site name="high" pos="0 0.05 0"/>
    </body>
  </worldbody>
  <tendon><spatial name="strut"><site site="low"/><site site="high"/></spatial></tendon>
  <actuator>
    <plugin name="strut" plugin="inerter.device" instance="strut" tendon="strut" actdim="1"/>
  </actuator>
  <sensor><plugin name="strut" plugin="inerter.device" instance="strut"/></sensor>
</mujoco>"""


def bench() -> mujoco.MjSpec:
    """The model above without its device."""
    spec = mujoco.MjSpec()
    spec.option.timestep = 1e-3
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    spec.worldbody.add_site(name="low", pos=[0.1, 0, 0])
    box = spec.worldbody.add_body(name="box", pos=SLANTED)
    box.add_joint(name="along", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=[0, 0, 1])
    box.add_joint(name="turn", type=mujoco.mjtJoint.mjJNT_HINGE, axis=[1, 0, 0])
    box.add_geom(size=[0.1, 0, 0], mass=20, pos=[0, 0.1, 0])
    box.add_site(name="high", pos=[0, 0.05, 0])
    return spec


def motion(model: mujoco.MjModel, steps: int = 300) -> np.ndarray:
    data = mujoco.MjData(model)
    data.qvel[:] = 0.5, -1.0
    rows = []
    for _ in range(steps):
        mujoco.mj_step(model, data)
        rows.append(np.concatenate([data.qpos, data.qvel, data.act, data.sensordata]))
    return np.array(rows)


TERMINALS = {
    "names": lambda spec: ("low", "high"),
    "objects": lambda spec: (spec.site("low"), spec.site("high")),
    "places": lambda spec: (("world", (0.1, 0, 0)), ("box", (0, 0.05, 0))),
    "bodies": lambda spec: ((spec.worldbody, [0.1, 0, 0]), (spec.body("box"), [0, 0.05, 0])),
    "mixed": lambda spec: ("low", ("box", np.array([0, 0.05, 0]))),
}


@pytest.mark.parametrize("kind", TERMINALS)
def test_it_is_the_device_written_in_xml(kind: str) -> None:
    config = "".join(f'<config key="{key}" value="{value}"/>' for key, value in STRUT.items())
    config += '<config key="rest_length" value="0.6"/>'
    written = mujoco.MjModel.from_xml_string(WRITTEN.format(config=config))
    spec = bench()
    added = add_device(spec, "strut", between=TERMINALS[kind](spec), rest_length=0.6, **STRUT)
    assert np.array_equal(motion(spec.compile()), motion(written))
    assert (added.actuator, added.tendon, added.sensor) == ("strut", "strut", "strut")
    assert added.joint is None


def test_the_model_survives_xml() -> None:
    spec = bench()
    add_device(spec, "strut", between=("low", "high"), rest_length="initial", **STRUT)
    model = spec.compile()
    again = mujoco.MjModel.from_xml_string(spec.to_xml())
    assert np.allclose(motion(again), motion(model), rtol=1e-9, atol=1e-12)


def test_initial_rest_length_is_the_distance_in_the_initial_pose() -> None:
    spec = bench()
    added = add_device(spec, between=("low", "high"), rest_length="initial", stiffness=1e4)
    distance = np.linalg.norm(SLANTED + np.array([-0.1, 0.05, 0]))
    assert added.rest_length == pytest.approx(distance, rel=1e-14)
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert abs(added.of(model).read(data.sensordata)["total"]) < 1e-10


def test_joints_and_tendons_that_are_there() -> None:
    spec = bench()
    spec.joint("along").ref = 0.2
    slide = add_device(spec, "slide", joint="along", gear=2, rest_length="initial", inertance=3)
    assert slide.rest_length == pytest.approx(0.4)
    hinge = add_device(spec, "hinge", joint=spec.joint("turn"), stiffness=5.0, sensor=False)
    rope = spec.add_tendon(name="rope")
    rope.wrap_joint("turn", 0.1)
    fixed = add_device(spec, "fixed", tendon=rope, viscous=7.0)
    model = spec.compile()
    assert (slide.joint, hinge.joint, fixed.tendon) == ("along", "turn", "rope")
    assert (hinge.sensor, slide.tendon) == (None, None)
    assert model.nsensor == 2
    data = mujoco.MjData(model)
    data.qvel[:] = 0, 0.5
    mujoco.mj_forward(model, data)
    # 7 N s/m at a tendon velocity of 0.1 m * 0.5 rad/s
    assert fixed.of(model).read(data.sensordata)["total"] == pytest.approx(0.35)
    # b gear^2 beside the mass
    assert mujoco_inertia(model, data)[0, 0] == pytest.approx(20 + 3 * 4)


def mujoco_inertia(model: mujoco.MjModel, data: mujoco.MjData) -> np.ndarray:
    columns = np.zeros((model.nv, model.nv))
    mujoco.mj_solveM(model, data, columns, np.eye(model.nv))
    return np.linalg.inv(columns)


def test_reading_it_back() -> None:
    spec = bench()
    add_device(spec, "other", joint="turn", friction="dahl", coulomb_force=2.0)
    added = add_device(spec, "strut", between=("low", "high"), **STRUT)
    model = spec.compile()
    place = added.of(model)
    data = mujoco.MjData(model)
    data.qvel[0] = 0.3
    data.act[place.act["friction_state"]] = 1e-4
    mujoco.mj_forward(model, data)
    read = place.read(data.sensordata)
    assert list(read) == ["total", "inertance", "friction", "friction_state", "stored_energy",
                          "dissipated_energy"]  # fmt: skip
    assert np.array_equal([*read.values()], data.sensor("strut").data)
    assert read["friction_state"] == 1e-4

    # the same from many steps at once
    rows = np.tile(data.sensordata, (4, 3, 1))
    assert place.read(rows)["total"].shape == (4, 3)
    assert (place.read(rows)["total"] == read["total"]).all()
    assert place.device.given == Device(**STRUT).given


def test_a_device_object_and_changes_to_it() -> None:
    spec = bench()
    device = Device(inertance=5, viscous=2)
    added = add_device(spec, "strut", device, joint="along", viscous=3.0)
    assert added.device.given == {"inertance": 5.0, "viscous": 3.0}
    assert added.of(spec.compile()).device.given == added.device.given
    assert device.given == {"inertance": 5.0, "viscous": 2.0}


def test_live_parameters_are_numerics() -> None:
    spec = bench()
    added = add_device(
        spec, "strut", between=("low", "high"), live=("coulomb_force", "rest_length"),
        rest_length=0.5, **STRUT,
    )  # fmt: skip
    model = spec.compile()
    assert added.numerics["coulomb_force"] == "strut.coulomb_force"
    place = added.of(model)
    assert model.numeric("strut.coulomb_force").data == [40.0]
    assert model.numeric_data[place.live["coulomb_force"]] == 40
    model.numeric_data[place.live["rest_length"]] = 0.7
    assert place.rest_length(model) == 0.7


def test_a_live_parameter_acts_without_compiling_again() -> None:
    spec = bench()
    added = add_device(
        spec, "strut", joint="along", friction="coulomb", coulomb_force=3.0, stiffness=10.0,
        live=("coulomb_force", "stiffness"),
    )  # fmt: skip
    model = spec.compile()
    place, data = added.of(model), mujoco.MjData(model)
    data.qpos[0], data.qvel[0] = 0.2, 1.0
    for force, stiffness in ((3.0, 10.0), (50.0, 10.0), (50.0, 40.0)):
        model.numeric_data[place.live["coulomb_force"]] = force
        model.numeric_data[place.live["stiffness"]] = stiffness
        mujoco.mj_forward(model, data)
        read = place.read(data.sensordata)
        assert read["friction"] == pytest.approx(force)
        assert read["total"] == pytest.approx(force + 0.2 * stiffness)


def test_every_state_of_a_series_element_has_its_place() -> None:
    spec = bench()
    add_device(spec, "other", joint="turn", friction="dahl", coulomb_force=2.0)
    series = {"series_stiffness": 1e4, "series_damping": 20.0, "backlash": 1e-3}
    added = add_device(spec, "strut", between=("low", "high"), **STRUT, **series)  # type: ignore[arg-type]
    model = spec.compile()
    place = added.of(model)
    names = ["friction_state", "series_deflection", "flywheel_velocity", "gap_position"]
    assert list(place.act) == names
    assert [*place.act.values()] == [1, 2, 3, 4]
    data = mujoco.MjData(model)
    data.act[:] = np.arange(model.na) * 1e-4
    mujoco.mj_forward(model, data)
    read = place.read(data.sensordata)
    assert [float(read[name]) for name in names] == pytest.approx([1e-4, 2e-4, 3e-4, 4e-4])


def test_between_two_free_bodies() -> None:
    """M qacc = f with the inertance between both: closed form."""
    spec = mujoco.MjSpec()
    spec.option.gravity = [0, 0, 0]
    for name, place in (("left", -1), ("right", 1)):
        body = spec.worldbody.add_body(name=name, pos=[place, 0, 0])
        body.add_freejoint()
        body.add_geom(size=[0.1, 0, 0], mass=2, contype=0, conaffinity=0)
    origin = (0, 0, 0)
    added = add_device(spec, between=(("left", origin), ("right", origin)), inertance=3)
    model = spec.compile()
    data = mujoco.MjData(model)
    data.xfrc_applied[2, 0] = 7.0
    mujoco.mj_forward(model, data)
    # m a1 = b (a2 - a1), m a2 = 7 - b (a2 - a1)
    relative = 7.0 / (2 + 2 * 3)
    assert added.of(model).read(data.sensordata)["total"] == pytest.approx(3 * relative)
    assert data.qacc[6] - data.qacc[0] == pytest.approx(relative)


# ------------------------------ mistakes ------------------------------


def two(spec: mujoco.MjSpec, **options: object) -> AddedDevice:
    return add_device(spec, "strut", **{"between": ("low", "high"), "inertance": 1.0, **options})


MISTAKES = {
    "nothing to act on": ({"between": None}, "give one of between"),
    "two targets": ({"joint": "along"}, "give one of between"),
    "unknown site": ({"between": ("low", "hihg")}, "no site 'hihg'; did you mean 'high'"),
    "same site": ({"between": ("low", "low")}, "both terminals are site 'low'"),
    "same place": ({"between": (("box", (0, 0, 1)),) * 2}, r"both terminals are the point \[0.0"),
    "one terminal": ({"between": ("low",)}, "between has 1 terminals"),
    "unknown body": ({"between": ("low", ("bax", (0, 0, 0)))}, "no body 'bax'; did you mean 'box'"),
    "no position": ({"between": ("low", ("box", (0, 0)))}, "is not three numbers"),
    "not finite": ({"between": ("low", ("box", (0, 0, np.nan)))}, "is not three numbers"),
    "no name": ({"between": ("low", 7)}, "site is 7: give a name"),
    "unknown joint": ({"between": None, "joint": "alogn"}, "did you mean 'along'"),
    "free joint": ({"between": None, "joint": "float"}, "'float' is a free joint"),
    "ball joint": ({"between": None, "joint": "ball"}, "'ball' is a ball joint"),
    "unknown tendon": ({"between": None, "tendon": "rope"}, "no tendon 'rope'; there is none yet"),
    "gear": ({"gear": 0}, "gear is 0"),
    "rest length": ({"rest_length": "inital"}, "give a length"),
    "coincident": ({"between": ("low", "low_too"), "rest_length": "initial"}, "at the same place"),
    "parameter": ({"inertanc": 1}, "did you mean inertance"),
    "value": ({"inertance": -1}, "inertance is"),
    "live": ({"live": ("coulomb",)}, "did you mean 'coulomb_force'"),
    "live text": ({"live": ("friction",)}, "not a number of a device"),
    "live word": ({"live": "inertance"}, "sequence of names"),
    "live taken": ({"live": ("stiffness",)}, "numeric strut.stiffness is there already"),
    "device": ({"device": {"inertance": 2}}, "give an inerter.Device"),
}


@pytest.mark.parametrize("case", MISTAKES)
def test_mistakes_are_one_line_and_change_nothing(case: str) -> None:
    spec = bench()
    spec.worldbody.add_body(name="ball").add_geom(size=[0.1, 0, 0])
    spec.body("ball").add_joint(name="ball", type=mujoco.mjtJoint.mjJNT_BALL)
    spec.worldbody.add_body(name="float").add_geom(size=[0.1, 0, 0])
    spec.body("float").add_freejoint(name="float")
    spec.worldbody.add_site(name="low_too", pos=[0.1, 0, 0])
    spec.add_numeric(name="strut.stiffness", data=[1.0], size=1)
    before = counts(spec)
    options, words = MISTAKES[case]
    with pytest.raises(ValueError, match=words) as caught:
        two(spec, **options)
    assert "\n" not in str(caught.value)
    assert counts(spec) == before
    spec.compile()


def counts(spec: mujoco.MjSpec) -> list[int]:
    lists = (spec.sites, spec.tendons, spec.actuators, spec.sensors, spec.plugins, spec.numerics)
    return [len(elements) for elements in lists]


@pytest.mark.parametrize("kind", ["actuator", "tendon", "sensor", "site"])
def test_a_taken_name_is_refused(kind: str) -> None:
    spec = bench()
    if kind == "actuator":
        spec.add_actuator(name="strut", target="along", trntype=mujoco.mjtTrn.mjTRN_JOINT)
    elif kind == "tendon":
        spec.add_tendon(name="strut").wrap_joint("along", 1.0)
    elif kind == "sensor":
        spec.add_sensor(name="strut", type=mujoco.mjtSensor.mjSENS_CLOCK)
    else:
        spec.worldbody.add_site(name="strut_2")
    with pytest.raises(ValueError, match=r"is taken by|is there already"):
        two(spec, between=("low", ("box", (0, 0, 0.1))))


def test_the_second_device_of_a_name_is_refused() -> None:
    spec = bench()
    two(spec)
    with pytest.raises(ValueError, match="name 'strut' is taken by an actuator"):
        two(spec, between=("low", "high"))


def test_elements_of_another_spec_are_refused() -> None:
    with pytest.raises(ValueError, match="site 'low' belongs to another spec"):
        two(bench(), between=(bench().site("low"), "high"))


def test_a_model_that_does_not_compile_says_why() -> None:
    spec = bench()
    spec.worldbody.add_geom(size=[0, 0, 0])
    with pytest.raises(ValueError, match=r"compiles as it is: .*geom") as caught:
        two(spec, rest_length="initial")
    assert "\n" not in str(caught.value)


def test_a_model_from_before_has_no_device() -> None:
    spec = bench()
    model = spec.compile()
    added = two(spec)
    with pytest.raises(ValueError, match="no device 'strut' in the model; its devices: none"):
        added.of(model)


def test_without_a_sensor_there_is_nothing_to_read() -> None:
    spec = bench()
    model_device = two(spec, sensor=False)
    model = spec.compile()
    with pytest.raises(ValueError, match="no sensor reads device 'strut'"):
        model_device.of(model).read(np.zeros(model.nsensordata))


def test_it_is_exported() -> None:
    assert inerter.add_device is add_device
    assert "add_device" in dir(inerter)
    with pytest.raises(AttributeError, match="no attribute 'add_devices'"):
        inerter.add_devices  # noqa: B018
